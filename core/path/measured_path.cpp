// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/measured_path.h"

#include <algorithm>

#include "core/util/binary_io.h"

namespace fogbow {

MeasuredPath& MeasuredPath::operator=(const MeasuredPath& x) {
  if (capacity() < x.capacity()) reserve(x.capacity());
  vertices_ = x.vertices_;
  edges_ = x.edges_;
  transport_ = x.transport_;
  scattering_ = x.scattering_;
  f_ = x.f_;
  raster_ = x.raster_;
  return *this;
}

void MeasuredPath::reserve(int vertices) {
  vertices_.reserve(vertices);
  edges_.reserve(vertices);
  transport_.reserve(vertices);
  scattering_.reserve(vertices);
}

void MeasuredPath::resize(int k) {
  vertices_.resize(k);
  edges_.resize(k - 1);
  transport_.resize(k - 1);
  scattering_.resize(k);
}

void MeasuredPath::copy(const MeasuredPath& x, int first, int to, int n) {
  std::copy_n(x.vertices_.begin() + first, n, vertices_.begin() + to);
  std::copy_n(x.scattering_.begin() + first, n, scattering_.begin() + to);
  const int edges = std::max(n - 1, 0);
  std::copy_n(x.edges_.begin() + first, edges, edges_.begin() + to);
  std::copy_n(x.transport_.begin() + first, edges, transport_.begin() + to);
}

void MeasuredPath::aim(const Scene& scene, int i) {
  Edge& e = edges_[i];
  if (vertices_[i].infinite()) {
    e.w = vertices_[i].point.n_g;
    e.length = kInfinity;
    return;
  }
  look_at(scene, vertices_[i + 1], vertices_[i].position());
  const Vec3 d = vertices_[i + 1].position() - vertices_[i].position();
  e.length = length(d);
  e.w = vertices_[i + 1].parallel() ? -vertices_[i + 1].point.n_g : d / e.length;
}

bool MeasuredPath::measure_vertex(const Scene& scene, int i) {
  const Vertex& x = vertices_[i];
  Scattering& s = scattering_[i];
  if (i == 0) {
    s = {};
    s.f_hat = L_e(scene, x, to_eye(0));
    s.pdf_to_eye = scene.emitter(x.emitter).pdf_direction(emitter_point(x), to_eye(0));
  } else if (i == last()) {
    s = {};
    s.f_hat = RGB(W_e(scene, x, to_light(i)));
    s.pdf_to_light = pdf_importance(scene, x, to_light(i));
  } else {
    s = scatter(scene, x, to_light(i), to_eye(i), x.degenerate, vertices_[i + 1].degenerate);
  }
  return !is_black(s.f_hat);
}

bool MeasuredPath::connect(const Scene& scene, int i) {
  const auto edge = fogbow::connect(scene, vertices_[i], vertices_[i + 1]);
  if (!edge) return false;
  edges_[i] = *edge;
  return true;
}

void MeasuredPath::measure_edge(const Scene& scene, int i) {
  transport_[i] = edges_[i].tau * geometric_term(scene, vertices_[i], vertices_[i + 1], edges_[i]);
}

bool MeasuredPath::evaluate(const Scene& scene) {
  f_ = ScaledProduct<RGB>(scattering_[0].f_hat);
  for (int i = 0; i < last(); ++i) {
    f_ *= transport_[i] * scattering_[i + 1].f_hat;
  }
  const auto seen = scene.sensor().raster(vertices_.back().position(), to_light(last()));
  if (seen) raster_ = *seen;
  return seen.has_value();
}

bool MeasuredPath::is_seen_light(const Scene& scene) const {
  for (int i = 1; i < last(); ++i)
    if (!vertices_[i].degenerate) return false;
  return hittable(scene, vertices_[0]);
}

double MeasuredPath::pdf_from_light(const Scene& scene, int i) const {
  if (i == 0) return pdf_emitter_position(scene, vertices_[0]);
  const Edge& e = edges_[i - 1];
  return to_measure(scene, vertices_[i - 1], vertices_[i], e, scattering_[i - 1].pdf_to_eye) *
         pdf_distance(scene, e, vertices_[i]);
}

double MeasuredPath::pdf_from_eye(const Scene& scene, int i) const {
  if (i == last()) return scene.sensor().pdf_A(vertices_[i].position());
  const Edge e = reversed(edges_[i]);
  return to_measure(scene, vertices_[i + 1], vertices_[i], e, scattering_[i + 1].pdf_to_light) *
         pdf_distance(scene, e, vertices_[i]);
}

bool MeasuredPath::measure(const Scene& scene, const Path& path) {
  resize(static_cast<int>(path.size()));
  vertices_ = path;
  for (int i = 0; i < last(); ++i) {
    if (!connect(scene, i)) return false;
    measure_edge(scene, i);
  }
  for (int i = 0; i < size(); ++i)
    if (!measure_vertex(scene, i)) return false;
  return evaluate(scene);
}

// Pointers to media are written as places in the scene's list of them, those to shapes follow from
// the primitive.
void MeasuredPath::serialize(std::ostream& out, const Scene& scene) const {
  write_binary(out, static_cast<std::int32_t>(size()));
  for (Vertex x : vertices_) {
    const auto& media = scene.media();
    const auto found =
        std::ranges::find_if(media, [&](const auto& m) { return m.get() == x.medium; });
    write_binary(out, static_cast<std::int32_t>(found - media.begin()));
    x.medium = nullptr;
    x.point.shape = nullptr;
    write_binary(out, x);
  }
  write_binary_vector(out, edges_);
  write_binary_vector(out, transport_);
  write_binary_vector(out, scattering_);
  write_binary(out, f_);
  write_binary(out, raster_);
}

MeasuredPath MeasuredPath::deserialize(std::istream& in, const Scene& scene) {
  const auto broken = [](bool wrong) {
    if (wrong) throw Error(ErrorKind::InputOutput, "a saved path does not belong to this scene");
  };
  MeasuredPath path;
  const auto k = read_binary<std::int32_t>(in);
  broken(k < 2 || k > kMaxVertices);
  for (int i = 0; i < k; ++i) {
    const auto medium = read_binary<std::int32_t>(in);
    const auto media = static_cast<std::int32_t>(scene.media().size());
    Vertex x = read_binary<Vertex>(in);
    broken(medium < 0 || medium > media || x.emitter >= static_cast<int>(scene.emitter_count()) ||
           (x.on_surface() && x.id.shape >= scene.surfaces().size()) ||
           (x.in_medium() && medium == media));
    x.medium = medium < media ? scene.media()[medium].get() : nullptr;
    x.point.shape = x.on_surface() ? scene.surface(x.id.shape).shape.get() : nullptr;
    path.vertices_.push_back(x);
  }
  path.edges_ = read_binary_vector<Edge>(in, kMaxVertices);
  path.transport_ = read_binary_vector<RGB>(in, kMaxVertices);
  path.scattering_ = read_binary_vector<Scattering>(in, kMaxVertices);
  const auto n = static_cast<std::size_t>(k);
  broken(path.edges_.size() != n - 1 || path.transport_.size() != n - 1 ||
         path.scattering_.size() != n);
  path.f_ = read_binary<ScaledProduct<RGB>>(in);
  path.raster_ = read_binary<Vec2>(in);
  return path;
}

}  // namespace fogbow
