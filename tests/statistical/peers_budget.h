// SPDX-License-Identifier: GPL-3.0-or-later
// What a comparison of pictures is to find, and the samples that this takes.
#pragma once
#include <string>
#include <vector>

#include "tests/statistical/peers_rendering.h"

namespace fogbow::testing {

/// What is to be found with 99% probability, in parts of the value: of the mean, and of a block or
/// class (0: of none) that is not dark.
struct Bias {
  double mean, part;
};
inline constexpr double kDark = 0.5;             // of the mean
inline constexpr double kNotableClass = 0.05;    // of all light
inline constexpr double kComparedClass = 0.002;  // the others are one

std::vector<std::size_t> all_tiles(const Tiles& like);
/// The tiles of each block.
std::vector<std::vector<std::size_t>> blocks_of(const Tiles& like,
                                                const std::vector<std::size_t>& tiles);

/// What is to be known so well: the picture's mean, blocks and classes that are not dark.
struct Demand {
  std::string name;
  Estimate pilot;
  double growth;                   ///< times the pilot's samples that it takes
  std::vector<std::size_t> tiles;  ///< empty: of a class
};

/// At a level of significance and a power.
struct Rigour {
  double level, power;
};
std::vector<Demand> demands(const Tiles& pilot, const Bias& bias, const Rigour& rigour);

/// Times the pilot's samples for each block, that all demands are met.
std::vector<double> shares(const Tiles& pilot, const std::vector<Demand>& demands);

}  // namespace fogbow::testing
