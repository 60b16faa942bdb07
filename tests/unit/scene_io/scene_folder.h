// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_io/load.h"
#include "core/util/log.h"
#include "media/registry.h"

namespace fogbow::testing {

/// A temporary folder with scene files in it, and what reading them gave.
class SceneFolder {
 public:
  SceneFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fogbow-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    folder_ = pattern;
    set_log_sink([](LogLevel, std::string_view) {});
  }
  ~SceneFolder() {
    set_log_sink({});
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  SceneFolder(const SceneFolder&) = delete;

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::string write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories(path(name).parent_path());
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name).string();
  }

  SceneDescription load_file(const std::string& name) {
    warnings.clear();
    return load_mitsuba_xml(path(name).string(), builtin_media(), options, warnings);
  }
  /// `text` is the whole file.
  SceneDescription load_text(const std::string& text, const std::string& name = "scene.xml") {
    write(name, text);
    return load_file(name);
  }
  /// `body` starts on line 2, between <scene> and a sensor.
  SceneDescription load(const std::string& body) { return load_text(wrap(body)); }
  static std::string wrap(const std::string& body) {
    return "<scene version=\"3.0.0\">\n" + body + "\n<sensor type=\"perspective\"/></scene>\n";
  }

  /// The error that a file must end in; what() without the folder.
  std::string error_of_file(const std::string& name) {
    try {
      load_file(name);
    } catch (const Error& error) {
      where = error.where();
      kind = error.kind();
      std::string text = error.what();
      const std::string prefix = folder_.string() + "/";
      for (std::size_t at; (at = text.find(prefix)) != std::string::npos;)
        text.erase(at, prefix.size());
      return text;
    }
    ADD_FAILURE() << name << " was read without an error";
    return {};
  }
  std::string error(const std::string& body) {
    write("scene.xml", wrap(body));
    return error_of_file("scene.xml");
  }

  LoadOptions options;
  std::vector<std::string> warnings;
  SourceLocation where;
  std::optional<ErrorKind> kind;

 private:
  std::filesystem::path folder_;
};

}  // namespace fogbow::testing
