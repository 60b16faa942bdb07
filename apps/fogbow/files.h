// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace fogbow::cli {

/// Throws Error(InputOutput) unless a file can be put at `path`: its folder exists and takes new
/// files, and nothing but a regular file is in the way.
void require_writable(const std::string& path);

/// Under a temporary name, fsynced, then renamed to `path`; throws Error(InputOutput).
void write_text_file(const std::string& path, std::string_view text);

/// `path` with `extension` (".png") in place of its last one.
std::string with_extension(const std::string& path, const std::string& extension);

/// Whether the name ends in `extension` (lower case), in any case.
bool has_extension(const std::string& path, std::string_view extension);

/// scenes/pool/scene.xml → pool.exr, pool.xml → pool.exr; in the current folder.
std::string default_output(const std::string& scene_path);

}  // namespace fogbow::cli
