// SPDX-License-Identifier: GPL-3.0-or-later
// Chains as walks see them, against the constraints of [Jakob2013] in automatic differentiation:
// half vectors, in the frames of the shading normals, are functions of the vertices' places, and
// the implicit function theorem gives what ray differentials give in core/path.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/path/specular_chain.h"
#include "tests/helpers/test_scenes.h"
#include "tests/unit/path/eye_chains.h"

namespace fogbow {
namespace {

/// Derivatives by the coordinates of three neighbouring vertices.
using Jet = ceres::Jet<double, 6>;
using JetVec = Eigen::Matrix<Jet, 3, 1>;
using Eigen::Matrix2d;
using Eigen::MatrixXd;

Eigen::Vector3d eigen(const Vec3& v) { return {v.x, v.y, v.z}; }
JetVec constant(const Vec3& v) { return eigen(v).cast<Jet>(); }

/// A surface around one point, made of what the shape says of points alone.
class Patch {
 public:
  Patch(const Shape& shape, const SurfacePoint& x) : x_(x.position), kind_(shape.primitive_kind()) {
    const auto corner = [&](double u, double v) {
      return shape.surface_point(x.primitive, {u, v});
    };
    if (kind_ == PrimitiveKind::Analytic && same_normal(corner(0.1, 0.2), corner(0.1, 0.7))) {
      // A disk, or a cylinder, whose normals turn around its axis.
      const SurfacePoint p = corner(0.1, 0.2), q = corner(0.4, 0.2);
      if (same_normal(p, q))
        kind_ = PrimitiveKind::Quads;
      else
        axis_ = normalize(corner(0.1, 0.7).position - p.position);
    }
    if (kind_ == PrimitiveKind::Analytic) {
      const SurfacePoint p = corner(0.1, 0.2), q = corner(0.4, axis_ ? 0.2 : 0.4);
      const Vec3 n = p.n_g - q.n_g;
      signed_radius_ = dot(p.position - q.position, n) / dot(n, n);
      center_ = p.position - signed_radius_ * p.n_g;
      if (axis_) center_ += dot(x.position - center_, *axis_) * *axis_;
      const Frame across(x.n_g);
      du_ = across.s, dv_ = across.t;
      return;
    }
    const SurfacePoint a = corner(0, 0), b = corner(1, 0), c = corner(0, 1);
    du_ = b.position - a.position, dv_ = c.position - a.position;
    const bool smooth = kind_ == PrimitiveKind::Triangles;
    normal_ = x.shading.n;
    if (!smooth) return;
    dn_du_ = b.shading.n - a.shading.n, dn_dv_ = c.shading.n - a.shading.n;
    normal_ = a.shading.n + x.local.x * dn_du_ + x.local.y * dn_dv_;
  }

  /// At coordinates (u, v), 0 being the point.
  JetVec position(const Jet& u, const Jet& v) const {
    const JetVec moved = constant(x_) + constant(du_) * u + constant(dv_) * v;
    if (kind_ != PrimitiveKind::Analytic) return moved;
    const JetVec out = moved - constant(center_), along = along_axis(out);
    return constant(center_) + along + (out - along).normalized() * Jet(std::abs(signed_radius_));
  }
  /// Unit shading normal.
  JetVec normal(const Jet& u, const Jet& v) const {
    if (kind_ == PrimitiveKind::Analytic) {
      const JetVec out = position(u, v) - constant(center_);
      return (out - along_axis(out)) / Jet(signed_radius_);
    }
    return (constant(normal_) + constant(dn_du_) * u + constant(dn_dv_) * v).normalized();
  }

 private:
  static bool same_normal(const SurfacePoint& p, const SurfacePoint& q) {
    return length(p.n_g - q.n_g) < 1e-9;
  }
  JetVec along_axis(const JetVec& out) const {
    if (!axis_) return JetVec(Jet(0.0), Jet(0.0), Jet(0.0));
    return constant(*axis_) * out.dot(constant(*axis_));
  }

  Vec3 x_;
  PrimitiveKind kind_;
  Vec3 du_{0}, dv_{0}, normal_{0}, dn_du_{0}, dn_dv_{0};
  Vec3 center_{0};
  std::optional<Vec3> axis_;  ///< of a cylinder
  double signed_radius_ = 0;
};

/// Frame(n) of core/math/frame.h, by which facets are held.
std::pair<JetVec, JetVec> tangents(const JetVec& n) {
  const Jet sign(std::copysign(1.0, n.z().a)), a = Jet(-1.0) / (sign + n.z()),
                                               b = n.x() * n.y() * a;
  return {JetVec(Jet(1.0) + sign * n.x() * n.x() * a, sign * b, -sign * n.x()),
          JetVec(b, sign + n.y() * n.y() * a, -n.y())};
}

/// The half vector's two tangential components at x between its neighbours.
Eigen::Matrix<Jet, 2, 1> constraint(const JetVec& before, double n_before, const JetVec& x,
                                    const JetVec& n, const JetVec& after, double n_after) {
  const JetVec half =
      ((before - x).normalized() * Jet(n_before) + (after - x).normalized() * Jet(n_after))
          .normalized();
  const auto [s, t] = tangents(n);
  return {half.dot(s), half.dot(t)};
}

Matrix2d derivatives_by(const Eigen::Matrix<Jet, 2, 1>& c, int first) {
  Matrix2d m;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column) m(row, column) = c(row).v[first + column];
  return m;
}

/// Relative indices on the two sides of a chain's vertex; one of both where it reflects.
std::pair<double, double> indices(const Scene& scene, const Path& path, int i, int step) {
  const Vec3 back = direction(path, i, i - step), on = direction(path, i, i + step);
  return {relative_index(scene, path[i], back), relative_index(scene, path[i], on)};
}

/// |dσ_a/dA⊥_b| of the chain between path[a] and path[b].
double jacobian_by_constraints(const Scene& scene, const Path& path, int a, int b) {
  const int step = a < b ? 1 : -1, n = std::abs(b - a) - 1;
  std::vector<Patch> patches;
  for (int i = a + step; i != b; i += step)
    patches.emplace_back(*scene.surface(path[i].id.shape).shape, path[i].point);
  const Frame across_end(direction(path, b - step, b));
  const auto at = [&](int j, int variable) -> JetVec {  // j = 0 is path[a], n + 1 path[b]
    const Jet u(0, variable), v(0, variable + 1);
    if (j == 0) return constant(path[a].position());
    if (j <= n) return patches[j - 1].position(u, v);
    return constant(path[b].position()) + constant(across_end.s) * u + constant(across_end.t) * v;
  };
  MatrixXd by_chain = MatrixXd::Zero(2 * n, 2 * n), by_end = MatrixXd::Zero(2 * n, 2);
  for (int j = 1; j <= n; ++j) {
    const auto [n_back, n_on] = indices(scene, path, a + j * step, step);
    const auto c = constraint(at(j - 1, 0), n_back, at(j, 2),
                              patches[j - 1].normal(Jet(0, 2), Jet(0, 3)), at(j + 1, 4), n_on);
    if (j > 1) by_chain.block<2, 2>(2 * j - 2, 2 * j - 4) = derivatives_by(c, 0);
    by_chain.block<2, 2>(2 * j - 2, 2 * j - 2) = derivatives_by(c, 2);
    if (j < n)
      by_chain.block<2, 2>(2 * j - 2, 2 * j) = derivatives_by(c, 4);
    else
      by_end.bottomRows<2>() = derivatives_by(c, 4);
  }
  const MatrixXd chain_by_end = -by_chain.fullPivLu().solve(by_end);
  const JetVec w = (at(1, 0) - at(0, 0)).normalized();
  const Frame across(direction(path, a, a + step));
  const Eigen::Matrix<Jet, 2, 1> turn(w.dot(constant(across.s)), w.dot(constant(across.t)));
  return std::abs((derivatives_by(turn, 0) * chain_by_end.topRows<2>()).determinant());
}

/// Calls check(path, a, b) for so many chains of specular or glossy vertices, both ways.
template <class Check>
void for_chains(const Scene& scene, int chains, Check&& check) {
  const auto in_chain = [&](const Vertex& x) {
    return x.degenerate || (x.on_surface() && is_glossy(scene, x));
  };
  for (int i = 0; chains > 0; ++i)
    testing::for_each_chain(scene, 4, i, in_chain, [&](const Path& path, int a, int b) {
      check(path, a, b);
      check(path, b, a);
      --chains;
    });
}

/// A scene, its longest chains at least, and whether some lead through glossy vertices.
struct Case {
  const char* scene;
  int longest;
  bool glossy, curved;
};

std::string test_name(const ::testing::TestParamInfo<Case>& info) {
  std::string name = info.param.scene;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class SpecularConstraint : public ::testing::TestWithParam<Case> {};

TEST_P(SpecularConstraint, GivesTheJacobianOfRayDifferentials) {
  const Scene scene(testing::make_test_scene(GetParam().scene));
  std::vector<double> errors;
  int longest = 0, glossy = 0;
  for_chains(scene, 3000, [&](const Path& path, int a, int b) {
    const double expected = jacobian_by_constraints(scene, path, a, b);
    errors.push_back(std::abs(chain_jacobian(scene, path, a, b) / expected - 1));
    longest = std::max(longest, std::abs(b - a) - 1);
    for (int i = std::min(a, b) + 1; i < std::max(a, b); ++i) glossy += !path[i].degenerate;
  });
  std::ranges::sort(errors);
  std::printf("%-18s %zu chains, longest %d, %d glossy vertices; error median %.1e, 99%% %.1e\n",
              GetParam().scene, errors.size(), longest, glossy, errors[errors.size() / 2],
              errors[errors.size() * 99 / 100]);
  // Close to a caustic, or where a ray grazes, both lose digits.
  EXPECT_LT(errors[errors.size() * 99 / 100], 1e-6);
  EXPECT_GE(longest, GetParam().longest);
  EXPECT_EQ(glossy > 1000, GetParam().glossy);
}

TEST_P(SpecularConstraint, GivesTheDerivativesOfNormals) {
  const Scene scene(testing::make_test_scene(GetParam().scene));
  int compared = 0, curved = 0;
  for_chains(scene, 1000, [&](const Path& path, int a, int b) {
    for (int i = std::min(a, b) + 1; i < std::max(a, b); ++i) {
      const Shape& shape = *scene.surface(path[i].id.shape).shape;
      const SurfaceDerivatives d = shape.derivatives(path[i].point);
      const Patch patch(shape, path[i].point);
      const JetVec x = patch.position(Jet(0, 0), Jet(0, 1)), n = patch.normal(Jet(0, 0), Jet(0, 1));
      Eigen::Matrix<double, 3, 2> tangents;
      tangents << eigen(d.dp_du), eigen(d.dp_dv);
      for (int variable = 0; variable < 2; ++variable) {
        const Eigen::Vector3d dx(x(0).v[variable], x(1).v[variable], x(2).v[variable]),
            dn(n(0).v[variable], n(1).v[variable], n(2).v[variable]);
        const Eigen::Vector2d part =
            (tangents.transpose() * tangents).inverse() * (tangents.transpose() * dx);
        const Eigen::Vector3d expected = part(0) * eigen(d.dn_du) + part(1) * eigen(d.dn_dv);
        // Normals of meshes are of length one in single precision alone.
        ASSERT_LT((dn - expected).norm(), 1e-6 * dn.norm() + 1e-12);
        curved += dn.norm() > 0;
        ++compared;
      }
    }
  });
  EXPECT_GT(compared, 1000);
  EXPECT_EQ(curved > 500, GetParam().curved);
}

TEST_P(SpecularConstraint, GivesTheFacetsJacobian) {
  const Scene scene(testing::make_test_scene(GetParam().scene));
  int compared = 0;
  for_chains(scene, 1000, [&](const Path& path, int a, int b) {
    const int step = a < b ? 1 : -1;
    for (int i = a + step; i != b; i += step) {
      if (path[i].degenerate) continue;
      const Vec3 from = direction(path, i, i - step), to = direction(path, i, i + step);
      const auto [n_back, n_on] = indices(scene, path, i, step);
      const Frame across(to);
      const JetVec turned =
          constant(to) + constant(across.s) * Jet(0, 0) + constant(across.t) * Jet(0, 1);
      const auto o = constraint(constant(from), n_back, constant(Vec3(0)),
                                constant(path[i].point.shading.n), turned, n_on);
      const double expected = std::abs(derivatives_by(o, 0).determinant());
      ASSERT_NEAR(facet_jacobian(scene, path[i], from, to) / expected, 1, 1e-9);
      const Vec3 facet = facet_normal(scene, path[i], from, to);
      ASSERT_NEAR(std::abs(o(0).a), std::abs(facet.x), 1e-12);
      ASSERT_NEAR(std::abs(o(1).a), std::abs(facet.y), 1e-12);
      ++compared;
    }
  });
  EXPECT_EQ(compared > 500, GetParam().glossy);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SpecularConstraint,
    ::testing::Values(Case{"glass-sphere-fog", 4, false, true}, Case{"mirror-fog", 1, false, false},
                      Case{"water", 2, false, true}, Case{"fog-in-glass", 3, false, true},
                      Case{"two-kinds-of-glass", 3, false, true}, Case{"sky-lens", 2, true, true},
                      Case{"surfaces", 1, true, true}, Case{"sun-and-can", 2, false, true}),
    test_name);

}  // namespace
}  // namespace fogbow
