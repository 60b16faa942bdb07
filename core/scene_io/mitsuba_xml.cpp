// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <new>

#include "core/scene_io/load.h"
#include "core/scene_io/scene_builder.h"

namespace fogbow {

SceneDescription load_mitsuba_xml(const std::string& path, const MediaRegistry& media,
                                  const LoadOptions& options, std::vector<std::string>& warnings) {
  try {
    Diagnostics diagnostics(warnings, options.strict);
    FileResolver files(path, options.sandbox_paths);
    const SceneDocument document(path, options.definitions, files, diagnostics);
    return SceneBuilder(document, files, media, options, diagnostics).build();
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::Memory, SourceLocation{path, 0, 0},
                "the scene does not fit into memory");
  } catch (const std::filesystem::filesystem_error& error) {
    throw Error(ErrorKind::InputOutput, SourceLocation{path, 0, 0}, error.what());
  }
}

}  // namespace fogbow
