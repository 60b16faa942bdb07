// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

#include "media/media.h"
#include "media/table_phase.h"
#include "tests/helpers/triples.h"

namespace fogbow::testing {

/// Of the directions in which a phase function sends what comes from `from`.
inline Triple phase_triple(std::shared_ptr<const PhaseFunction> phase, const Vec3& from) {
  return {
      3, [=](const Vec3& u) -> std::optional<Vec3> { return phase->sample(from, u); },
      [=](const Vec3& to) { return phase->pdf_sigma(from, to); },
      [=](const Vec3& to, const Vec3& auxiliary) { return phase->invert(from, to, auxiliary); }};
}

}  // namespace fogbow::testing
