// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/transform.h"

#include <stdexcept>

#include "core/math/frame.h"

namespace fogbow {

Transform::Transform(const Mat4& m) : m_(m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) throw std::domain_error("transform has a non-finite entry");
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
    throw std::domain_error("transform is not affine: its last row must be 0 0 0 1");
  const Mat3 linear(m);
  const double scale = length(linear[0]) * length(linear[1]) * length(linear[2]);
  if (!(std::abs(glm::determinant(linear)) > 1e-12 * scale))
    throw std::domain_error("transform is singular");
  const Mat3 inverse = glm::inverse(linear);
  inverse_ = Mat4(inverse);
  inverse_[3] = Vec4(-(inverse * Vec3(m[3])), 1.0);
}

Transform Transform::translate(const Vec3& d) {
  Mat4 m(1.0);
  m[3] = Vec4(d, 1.0);
  return Transform(m);
}

Transform Transform::scale(const Vec3& s) {
  Mat4 m(1.0);
  for (int i = 0; i < 3; ++i) m[i][i] = s[i];
  return Transform(m);
}

Transform Transform::rotate(const Vec3& axis, double degrees) {
  if (!(length(axis) > 0)) throw std::domain_error("rotation axis is zero");
  const Vec3 a = normalize(axis);
  const double angle = degrees * kPi / 180, c = std::cos(angle), s = std::sin(angle);
  const Mat3 k(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
  const Mat3 r = Mat3(c) + s * k + (1 - c) * glm::outerProduct(a, a);
  return Transform(Mat4(r));
}

Transform Transform::look_at(const Vec3& origin, const Vec3& target, const Vec3& up) {
  const Vec3 view = target - origin;
  if (!(length(view) > 0)) throw std::domain_error("lookat origin and target coincide");
  const Vec3 d = normalize(view);
  const Vec3 side = cross(up, d);
  if (!(length(side) > 1e-12 * length(up)))
    throw std::domain_error("lookat up is parallel to the viewing direction");
  const Vec3 left = normalize(side);
  Mat4 m(1.0);
  m[0] = Vec4(left, 0);
  m[1] = Vec4(cross(d, left), 0);
  m[2] = Vec4(d, 0);
  m[3] = Vec4(origin, 1);
  return Transform(m);
}

Transform Transform::inverse() const { return Transform(inverse_, m_); }

bool Transform::flips_orientation() const { return glm::determinant(Mat3(m_)) < 0; }

double Transform::similarity_scale() const {
  const Mat3 gram = glm::transpose(Mat3(m_)) * Mat3(m_);
  const double s2 = (gram[0][0] + gram[1][1] + gram[2][2]) / 3;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (std::abs(gram[c][r] - (c == r ? s2 : 0.0)) > 1e-6 * s2)
        return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(s2);
}

Transform operator*(const Transform& a, const Transform& b) {
  return Transform(a.m_ * b.m_, b.inverse_ * a.inverse_);
}

}  // namespace fogbow
