// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/vec.h"

namespace fogbow {

/// Affine transform with its inverse; column vectors, p' = M p.
class Transform {
 public:
  Transform() : m_(1.0), inverse_(1.0) {}
  /// Throws std::domain_error if `m` is singular or not finite.
  explicit Transform(const Mat4& m);

  static Transform translate(const Vec3& d);
  static Transform scale(const Vec3& s);
  static Transform rotate(const Vec3& axis, double degrees);
  /// Camera-to-world of a viewer at `origin` that looks along +z at `target` (Mitsuba's convention:
  /// +x is to the left of the picture).
  static Transform look_at(const Vec3& origin, const Vec3& target, const Vec3& up);

  const Mat4& matrix() const { return m_; }
  const Mat4& inverse_matrix() const { return inverse_; }
  Transform inverse() const;
  Vec3 point(const Vec3& p) const { return Vec3(m_ * Vec4(p, 1.0)); }
  Vec3 vector(const Vec3& v) const { return Vec3(m_ * Vec4(v, 0.0)); }
  /// Normals transform by the inverse transpose; not normalized.
  Vec3 normal(const Vec3& n) const { return glm::transpose(Mat3(inverse_)) * n; }
  bool flips_orientation() const;
  /// Uniform scale factor if the linear part is a similarity (relative tolerance 1e-6), else
  /// nothing (NaN).
  double similarity_scale() const;

  /// (a * b)(p) = a(b(p)).
  friend Transform operator*(const Transform& a, const Transform& b);

 private:
  Transform(const Mat4& m, const Mat4& inverse) : m_(m), inverse_(inverse) {}
  Mat4 m_, inverse_;
};

}  // namespace fogbow
