// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/geometry/shapes.h"
#include "core/scene/scene.h"
#include "core/util/check.h"

/// What libFuzzer calls, one definition a target: reads the bytes, which has to end in an object
/// that keeps its promises or in an Error with a place.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fogbow::testing {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Calls `read`; an Error is an answer if it says where.
template <class Read>
void read_or_refuse(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    FOGBOW_CHECK(error.kind() == ErrorKind::Scene || error.kind() == ErrorKind::InputOutput);
    FOGBOW_CHECK(!error.where().file.empty());
  }
}

/// Of what mesh_file.h promises, and make_mesh() would not let pass.
inline void check_mesh(const TriangleMeshData& mesh) {
  for (const Vec3& p : mesh.positions) FOGBOW_CHECK(is_finite(p));
  for (const Vec3& n : mesh.normals) FOGBOW_CHECK(is_finite(n));
  FOGBOW_CHECK(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  FOGBOW_CHECK(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle) FOGBOW_CHECK(index < mesh.positions.size());
}

}  // namespace fogbow::testing
