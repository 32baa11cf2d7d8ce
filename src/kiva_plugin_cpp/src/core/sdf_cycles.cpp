// SPDX-License-Identifier: Apache-2.0
#include "core/sdf_cycles.h"

#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "core/model_paths.h"
#include "core/sdf_errors.h"
#include "core/sdf_parser.h"
#include "core/xml_parts.h"

namespace kiva {
namespace {

/// The uris of all includes, wherever they stand.
std::set<std::string> urisOf(const std::string& xml) {
  std::set<std::string> uris;
  TagScanner scanner(xml);
  std::vector<std::string_view> path;
  while (scanner.next()) {
    if (!scanner.opens) {
      if (!path.empty()) path.pop_back();
      continue;
    }
    if (scanner.name == "uri" && !path.empty() && path.back() == "include" && !scanner.closes) {
      const std::size_t begin = scanner.end;
      if (!scanner.next()) break;
      uris.insert(trimmed(std::string_view(xml).substr(begin, scanner.begin - begin)));
      continue;
    }
    if (!scanner.closes) path.push_back(scanner.name);
  }
  return uris;
}

/// Walks from model to model, each once.
class Walk {
 public:
  explicit Walk(const ModelPaths& model_paths) : model_paths_(model_paths) {}

  void visit(const std::string& xml) {
    for (const std::string& uri : urisOf(xml)) {
      const std::string folder = findModel(uri, model_paths_);
      if (folder.empty() || finished_.count(folder)) continue;  // The first is told elsewhere.
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
