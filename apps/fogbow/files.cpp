// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/util/error.h"

namespace fogbow::cli {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error = 0) {
  throw Error(ErrorKind::InputOutput,
              path + ": " + what + (error ? std::string(": ") + std::strerror(error) : ""));
}

/// A new file beside `path`, gone again unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path)
      : path_(path), name_(path + ".tmp" + std::to_string(::getpid())) {
    descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(path_, "cannot be written", errno);
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path_, "cannot be written", errno);
      text.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  void commit() {
    if (::fsync(descriptor_) != 0) fail(path_, "cannot be written", errno);
    const int status = ::close(descriptor_);
    descriptor_ = -1;
    if (status != 0 || ::rename(name_.c_str(), path_.c_str()) != 0)
      fail(path_, "cannot be written", errno);
    renamed_ = true;
    sync_folder();
  }

 private:
  /// So that the new name outlives a power cut; not every file system can.
  void sync_folder() const {
    const std::string folder = fs::absolute(path_).parent_path().string();
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
  }

  std::string path_, name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

}  // namespace

void require_writable(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;
  if (!folder.empty() && !fs::is_directory(folder, error))
    fail(path, "the folder '" + folder.string() + "' does not exist");
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    fail(path, "is there already and is no regular file");
  TemporaryFile probe(path);
}

void write_text_file(const std::string& path, std::string_view text) {
  TemporaryFile file(path);
  file.write(text);
  file.commit();
}

std::string with_extension(const std::string& path, const std::string& extension) {
  return fs::path(path).replace_extension(extension).string();
}

bool has_extension(const std::string& path, std::string_view extension) {
  std::string found = fs::path(path).extension().string();
  std::transform(found.begin(), found.end(), found.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return found == extension;
}

std::string default_output(const std::string& scene_path) {
  const fs::path path = fs::absolute(scene_path);
  const bool named_by_folder = path.stem() == "scene" && path.parent_path().has_filename();
  return (named_by_folder ? path.parent_path().filename() : path.stem()).string() + ".exr";
}

}  // namespace fogbow::cli
