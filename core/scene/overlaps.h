// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>

#include "core/scene/enclosed_volume.h"

namespace fogbow {

/// Pairs of indices into a list of volumes; a volume with itself where its pieces overlap.
using OverlappingPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Decides what medium and what index of refraction lie on each side of a surface where volumes
/// overlap, by the priorities of [SchmidtBudge2002]: a function of the place alone, whatever way
/// light takes. A boundary with one and the same on both sides is not there; of those that lie upon
/// each other one is.
class Overlaps final : public HitNames {
 public:
  /// Appends to `surfaces` those that some of them are where volumes overlap. Throws
  /// std::domain_error with the reason where that cannot be done.
  Overlaps(std::vector<Surface>& surfaces, std::vector<EnclosedVolume> volumes,
           const OverlappingPairs& pairs);
  ~Overlaps() override;

  /// What rays are to meet in place of a surface of the scene.
  const std::shared_ptr<const Shape>& shape_of(std::uint32_t surface) const {
    return shapes_[surface];
  }
  std::uint32_t name(const Hit& hit) const override;
  std::uint32_t shape(std::uint32_t name) const override { return origins_[name]; }

  /// The medium at a point off all boundaries; nothing outside of all volumes.
  std::optional<const Medium*> medium_at(const Vec3& p) const;
  /// Which of two volumes holds where both are.
  bool outranks(std::size_t a, std::size_t b) const { return rank_[a] < rank_[b]; }

 private:
  struct Volume;
  struct Place {
    const Medium* medium;
    double n;
    bool operator==(const Place&) const = default;
  };
  /// A surface as it is between two places.
  struct Variant {
    Place interior, exterior;
    std::uint32_t name;
  };
  /// How a surface takes part: only the volumes around it are asked about.
  struct Part {
    std::size_t own = 0;
    std::vector<std::size_t> around;  ///< highest rank first
    Place outside;                    ///< where there is none of these
    std::vector<Variant> variants;    ///< empty: the surface is what it was declared to be
  };
  using Mask = std::uint64_t;  ///< of the volumes around

  void rank(const OverlappingPairs& pairs);
  void check_winding(std::size_t volume) const;
  void take_part(std::vector<Surface>& surfaces, std::uint32_t surface);
  std::vector<Place> places(const Part& part, bool interior, bool refracting) const;
  void add_variants(std::vector<Surface>& surfaces, std::uint32_t surface, Part& part);
  std::uint32_t variant(std::vector<Surface>& surfaces, std::uint32_t surface,
                        const Place& interior, const Place& exterior);
  std::shared_ptr<const Bsdf> bsdf_between(const Surface& surface, const Place& interior,
                                           const Place& exterior);
  Place place(const Part& part, Mask inside, bool refracting) const;
  Place outside(const Surface& surface, std::size_t own) const;
  Mask beside(const Part& part, const SurfacePoint& x, bool interior) const;
  bool replaced(const Part& part, Mask flips) const;
  std::uint32_t find(std::uint32_t surface, const SurfacePoint& x) const;

  double touch_;  ///< distance over which surfaces touch
  std::vector<Volume> volumes_;
  std::vector<std::size_t> rank_;  ///< of each volume, 0 the highest
  std::vector<std::shared_ptr<const Medium>> media_;
  std::vector<std::shared_ptr<const Shape>> whole_, shapes_;
  std::vector<bool> refracting_;
  std::vector<std::uint32_t> origins_;
  std::vector<Part> parts_;
  std::map<std::tuple<const Bsdf*, double, double>, std::shared_ptr<const Bsdf>> bsdfs_;
};

}  // namespace fogbow
