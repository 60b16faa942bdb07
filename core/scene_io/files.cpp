// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/files.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "core/scene_io/diagnostics.h"

namespace fogbow {

namespace fs = std::filesystem;

LineIndex::LineIndex(std::string_view text) : starts_{0} {
  for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1))
    starts_.push_back(at + 1);
}

SourceLocation LineIndex::locate(const std::string& file, std::size_t offset) const {
  const auto next = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const auto line = static_cast<std::size_t>(next - starts_.begin());
  return {file, static_cast<int>(line), static_cast<int>(offset - starts_[line - 1] + 1)};
}

FileResolver::FileResolver(const std::string& scene_path, bool sandbox)
    : scene_folder_(fs::path(scene_path).parent_path()), sandbox_(sandbox) {}

void FileResolver::add_folder(const std::string& folder, const SourceLocation& where) {
  const fs::path beside_file = fs::path(where.file).parent_path() / folder;
  for (const fs::path& path : {beside_file, scene_folder_ / folder}) {
    std::error_code status;
    if (!fs::is_directory(path, status)) continue;
    check_inside(path, where);
    folders_.push_back(path);
    return;
  }
  throw Error(ErrorKind::InputOutput, where, "there is no folder " + quote(beside_file.string()));
}

fs::path FileResolver::resolve(const std::string& name, const SourceLocation& where) const {
  if (name.empty() || name.find('\0') != std::string::npos)
    throw Error(ErrorKind::InputOutput, where, "a file name is empty or holds a null byte");
  std::vector<fs::path> candidates{fs::path(where.file).parent_path() / name, scene_folder_ / name};
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder)
    candidates.push_back(*folder / name);
  for (const fs::path& candidate : candidates) {
    std::error_code status;
    if (!fs::exists(candidate, status)) continue;
    check_inside(candidate, where);
    return candidate;
  }
  throw Error(
      ErrorKind::InputOutput, where,
      "file not found: " + quote(name) + ", looked for at " + quote(candidates.front().string()));
}

void FileResolver::check_inside(const fs::path& path, const SourceLocation& where) const {
  if (!sandbox_) return;
  std::error_code status;
  const fs::path root = fs::canonical(scene_folder_.empty() ? "." : scene_folder_, status);
  const fs::path file = status ? fs::path() : fs::canonical(path, status);
  const auto [end, unused] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  if (status || end != root.end())
    throw Error(ErrorKind::InputOutput, where,
                quote(path.string()) + " lies outside the scene's folder (paths are sandboxed)");
}

std::string read_file(const fs::path& path, std::uint64_t max_bytes, const SourceLocation& where) {
  const std::string name = quote(path.string());
  std::error_code status;
  if (!fs::is_regular_file(path, status))
    throw Error(ErrorKind::InputOutput, where,
                name + (fs::exists(path, status) ? " is no regular file" : " does not exist"));
  const std::uintmax_t size = fs::file_size(path, status);
  if (status) throw Error(ErrorKind::InputOutput, where, "cannot tell the size of " + name);
  if (size > max_bytes)
    throw Error(ErrorKind::InputOutput, where,
                name + " has " + std::to_string(size) + " bytes, more than the limit of " +
                    std::to_string(max_bytes));
  std::ifstream in(path, std::ios::binary);
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in) throw Error(ErrorKind::InputOutput, where, "cannot read " + name);
  return bytes;
}

}  // namespace fogbow
