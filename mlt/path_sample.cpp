// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/path_sample.h"

#include "core/math/discrete_distribution.h"
#include "core/path/techniques.h"
#include "core/util/binary_io.h"

namespace fogbow {

std::optional<PathSample> PathSample::choose(const Scene& scene, int max_vertices,
                                             const PrimarySample& sample, double u) {
  const auto& all = sample.contributions();
  std::vector<double> weights;
  for (const Contribution& c : all)
    weights.push_back(luminance(c.value) * sample.importance()(c.raster));
  const Contribution& c = all[DiscreteDistribution(weights).sample(u)];
  Subpath eye = sample.workspace().eye;
  if (c.infinite_emitter >= 0) eye[c.t - 1].x.emitter = c.infinite_emitter;
  PathSample x(scene, max_vertices, sample.importance());
  if (x.assemble(sample.workspace().light, c.s, eye, c.t)) return std::nullopt;
  return x;
}

bool PathSample::settle() {
  const bool seen = path_.evaluate(*scene_);
  const ScaledProduct<RGB>& f = path_.f();
  contribution_ = {path_.raster(), f.mantissa(), path_.size(), 0, 0};
  const double mantissa = luminance(f.mantissa()) * (*importance_)(path_.raster());
  log_f_star_ = path_.is_seen_light(*scene_)
                    ? -std::numeric_limits<double>::infinity()
                    : log(ScaledProduct<double>(mantissa)) + f.exponent() * std::numbers::ln2;
  selection_key_ = key();
  return seen;
}

std::uint64_t PathSample::key() const {
  constexpr int kBits = 12;  // a vertex or edge each
  if (path_.size() > kBits) return 0;
  std::uint64_t degenerate = 0, glossy = 0, in_medium = 0, attenuated = 0;
  for (int i = 0; i < path_.size(); ++i) {
    degenerate |= std::uint64_t{path_[i].degenerate} << i;
    glossy |= std::uint64_t{is_glossy(*scene_, path_[i])} << i;
    in_medium |= std::uint64_t{path_[i].in_medium()} << i;
    if (i < path_.last()) attenuated |= std::uint64_t{path_.sees_medium(i)} << i;
  }
  // Of lights at infinity, some are run into and some are not.
  const auto ends = static_cast<std::uint64_t>(path_.size()) |
                    static_cast<std::uint64_t>(path_[0].kind) << 8 |
                    std::uint64_t{hittable(*scene_, path_[0])} << 12;
  return ends << 4 * kBits | attenuated << 3 * kBits | in_medium << 2 * kBits | glossy << kBits |
         degenerate;
}

std::optional<Rejection> PathSample::assemble(const Subpath& light, int s, const Subpath& eye,
                                              int t) {
  MeasuredPath& y = path_;
  const int k = s + t;
  y.resize(k);
  for (int i = 0; i < s; ++i) {
    y.vertex(i) = light[i].x;
    if (i > 0) y.set_edge(i - 1, light[i].edge);
  }
  for (int i = 0; i < t; ++i) {
    y.vertex(k - 1 - i) = eye[i].x;
    if (i > 0) y.set_edge(k - 1 - i, reversed(eye[i].edge));
  }
  // The ends scatter smoothly, whatever their walks went on with.
  y.vertex(s).degenerate = false;
  if (s > 0) {
    y.vertex(s - 1).degenerate = false;
    y.aim(*scene_, s - 1);
  }
  for (int i = 0; i < k; ++i)
    if (!y.measure_vertex(*scene_, i)) return Rejection::NoLight;
  if (!joinable(*scene_, y, s)) return Rejection::WrongConfiguration;
  if (s > 0 && !y.connect(*scene_, s - 1)) return Rejection::Occluded;
  for (int i = 0; i + 1 < k; ++i) y.measure_edge(*scene_, i);
  return settle() ? std::nullopt : std::optional(Rejection::OffFilm);
}

void PathSample::serialize(std::ostream& out) const {
  path_.serialize(out, *scene_);
  write_binary(out, contribution_);
  write_binary(out, log_f_star_);
  write_binary(out, selection_key_);
}

PathSample PathSample::deserialize(std::istream& in, const Scene& scene, int max_vertices,
                                   const PictureImportance& importance) {
  PathSample x(scene, max_vertices, importance);
  x.path_ = MeasuredPath::deserialize(in, scene);
  x.path_.reserve(max_vertices);
  x.contribution_ = read_binary<Contribution>(in);
  x.log_f_star_ = read_binary<double>(in);
  x.selection_key_ = read_binary<std::uint64_t>(in);
  return x;
}

}  // namespace fogbow
