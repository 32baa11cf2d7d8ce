// SPDX-License-Identifier: Apache-2.0
#include "world_file/cycles.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "world_file/errors.h"
#include "world_file/model_paths.h"
#include "world_file/parser.h"

namespace kiva {
namespace {

/// All that may be the uri of an include. Not by way of the tags: libsdformat reads on behind what
/// we take for no XML.
std::set<std::string> urisOf(const std::string& xml) {
  std::set<std::string> uris;
  for (std::size_t at = 0; (at = xml.find("model://", at)) != std::string::npos;) {
    const std::size_t end = std::min(xml.find_first_of("<>[]\"' \t\r\n", at), xml.size());
    uris.insert(xml.substr(at, end - at));
    at = end;
  }
  return uris;
}

/// Meshes and such are files of another kind.
bool isSdf(const std::string& path) {
  const std::filesystem::path file(path);
  return std::filesystem::is_directory(file) || file.extension() == ".sdf";
}

/// Walks from model to model, each once.
class Walk {
 public:
  explicit Walk(const ModelPaths& model_paths) : model_paths_(model_paths) {}

  void visit(const std::string& xml) {
    for (const std::string& uri : urisOf(xml)) {
      const std::string folder = findModel(uri, model_paths_);
      if (folder.empty() || !isSdf(folder) || finished_.count(folder))
        continue;  // The first is told elsewhere.
      if (!open_.insert(folder).second) fail(uri);
      std::ifstream file(modelFile(folder), std::ios::binary);
      std::ostringstream text;
      text << file.rdbuf();
      visit(text.str());
      open_.erase(folder);
      finished_.insert(folder);
    }
  }

 private:
  [[noreturn]] static void fail(const std::string& uri) {
    throw SdfError(sdf::Error(sdf::ErrorCode::URI_INVALID,
                              "the model '" + uri + "' includes itself, perhaps by way of others"));
  }

  const ModelPaths& model_paths_;
  std::set<std::string> open_, finished_;
};

}  // namespace

void checkCycles(const std::string& xml, const ModelPaths& model_paths) {
  Walk(model_paths).visit(xml);
}

}  // namespace kiva
