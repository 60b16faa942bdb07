// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/util/error.h"

namespace fogbow {

/// Lines and columns (in bytes, from 1) of offsets into a text.
class LineIndex {
 public:
  explicit LineIndex(std::string_view text);
  SourceLocation locate(const std::string& file, std::size_t offset) const;

 private:
  std::vector<std::size_t> starts_;
};

/// Finds the files that a scene names, and reads them whole.
class FileResolver {
 public:
  /// With `sandbox`, nothing outside the scene's folder is read, symbolic links included.
  FileResolver(const std::string& scene_path, bool sandbox);

  /// One more folder to look into, relative to that of the file at `where`.
  void add_folder(const std::string& folder, const SourceLocation& where);
  /// Looks next to the file at `where`, in the scene's folder, then in the folders added, the last
  /// first. Throws Error(InputOutput).
  std::filesystem::path resolve(const std::string& name, const SourceLocation& where) const;

 private:
  void check_inside(const std::filesystem::path& path, const SourceLocation& where) const;

  std::filesystem::path scene_folder_;
  std::vector<std::filesystem::path> folders_;
  bool sandbox_;
};

/// Throws Error(InputOutput) at `where` if this is no regular file, cannot be read, or is longer
/// than `max_bytes`.
std::string read_file(const std::filesystem::path& path, std::uint64_t max_bytes,
                      const SourceLocation& where);

}  // namespace fogbow
