// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/subpath_inverse.h"

#include "core/math/random.h"

namespace fogbow {

namespace {

/// One subpath's primary samples, vertex by vertex from its end.
class Inverse {
 public:
  Inverse(const Scene& scene, const MeasuredPath& x, Side side, Rng& auxiliaries,
          std::vector<double>& u)
      : scene_(scene), x_(x), eye_(side == Side::Eye), auxiliaries_(auxiliaries), u_(u) {}

  /// Of the edge by which the walk leaves x[i].
  void add_distance(int i) {
    const Edge edge = eye_ ? reversed(x_.edge(i - 1)) : x_.edge(i);
    add(invert_distance(scene_, edge, x_[eye_ ? i - 1 : i + 1], uniform2(auxiliaries_)));
  }
  /// What leave_vertex() takes at x[i].
  bool add_vertex(int i) {
    const Vec3 from = eye_ ? x_.to_eye(i) : x_.to_light(i);
    const Vec3 to = eye_ ? x_.to_light(i) : x_.to_eye(i);
    const auto direction = invert_direction(x_[i], from, to);
    if (!direction) return false;
    const Scattering& s = x_.scattering(i);
    add(*direction);
    add(auxiliaries_.uniform() * (eye_ ? s.survival_to_light : s.survival_to_eye));
    add_distance(i);
    return true;
  }
  void add(double value) { u_.push_back(value); }
  void add(const Vec2& value) { u_.insert(u_.end(), {value.x, value.y}); }
  void add(const Vec3& value) { u_.insert(u_.end(), {value.x, value.y, value.z}); }
  /// Numbers that the subpath's vertices do not depend on.
  void add_free(int n) {
    for (int i = 0; i < n; ++i) add(auxiliaries_.uniform());
  }

 private:
  std::optional<Vec3> invert_direction(const Vertex& x, const Vec3& from, const Vec3& to) {
    const Vec3 auxiliary = uniform3(auxiliaries_);
    if (x.in_medium()) return x.medium->phase().invert(from, to, auxiliary);
    const Frame& shading = x.point.shading;
    return scene_.surface(x.id.shape)
        .bsdf->invert(x.point, shading.to_local(from), shading.to_local(to), x.degenerate,
                      auxiliary);
  }

  const Scene& scene_;
  const MeasuredPath& x_;
  bool eye_;
  Rng& auxiliaries_;
  std::vector<double>& u_;
};

}  // namespace

bool invert_light_subpath(const Scene& scene, const MeasuredPath& x, int s, Rng& auxiliaries,
                          std::vector<double>& u) {
  if (s < 1) return true;
  Inverse inverse(scene, x, Side::Light, auxiliaries, u);
  const auto index = static_cast<std::size_t>(x[0].emitter);
  const Emitter& emitter = scene.emitter(index);
  const EmitterPoint start = emitter_point(x[0]);
  inverse.add(scene.emitter_distribution().invert(index, auxiliaries.uniform()));
  const auto position = emitter.invert_position(start, uniform3(auxiliaries));
  if (!position) return false;
  inverse.add(*position);
  if (s < 2) {
    inverse.add_free(4);
    return true;
  }
  // Any point on a ray of parallel light tells where on the disk it starts.
  const auto direction = emitter.invert_direction(
      start, {x.to_eye(0), x[x[0].infinite() ? 1 : 0].position(), x.scattering(0).pdf_to_eye});
  if (!direction) return false;
  inverse.add(*direction);
  inverse.add_distance(0);
  for (int i = 1; i + 1 < s; ++i)
    if (!inverse.add_vertex(i)) return false;
  return true;
}

bool invert_eye_subpath(const Scene& scene, const MeasuredPath& x, int t, Rng& auxiliaries,
                        std::vector<double>& u) {
  Inverse inverse(scene, x, Side::Eye, auxiliaries, u);
  const int last = x.last();
  if (t > 1)
    inverse.add(x.raster());
  else
    inverse.add_free(2);
  inverse.add(scene.sensor().invert_position(x[last].position(), uniform2(auxiliaries)));
  if (t < 2) {
    inverse.add_free(2);
    return true;
  }
  inverse.add_distance(last);
  for (int i = last - 1; i > last + 1 - t; --i)
    if (!inverse.add_vertex(i)) return false;
  return true;
}

}  // namespace fogbow
