// SPDX-License-Identifier: Apache-2.0
#include "world_file/model_library.h"

#include "world_file/elements/frames.h"
#include "world_file/elements/values.h"
#include "world_file/files/bounded_cache.h"
#include "world_file/files/model_paths.h"
#include "world_file/files/text_file.h"
#include "world_file/parsing/parser.h"
#include "world_file/sdf/models.h"
#include "world_file/sdf/sensors.h"

namespace kiva {
namespace {

void readModel(const XmlElement& model, const Origin& origin, Faults* warnings,
               LibraryModel* result) {
  result->name = attributeOf(model, "name");
  result->pose = poseAround(model);
  result->placement = valueOfPose(model.FirstChildElement("pose")).Inverse() * result->pose;
  result->description =
      std::make_shared<const ModelDescription>(describeModel(model, origin, warnings));
}

LibraryModel readFile(const std::string& folder, const std::string& file,
                      const ModelPaths& model_paths) {
  LibraryModel result;
  SdfDocument document = parseSdf(readText(file, kMostBytes), model_paths);
  if (const XmlElement* const model = document.root().FirstChildElement("model")) {
    readModel(*model, {file, model_paths}, &document.warnings, &result);
    addMeshFiles(*result.description, &document.files);
  } else if (const XmlElement* const light = document.root().FirstChildElement("light")) {
    result.light = describeLight(*light, valueOfPose(light->FirstChildElement("pose")));
  }
  for (const Fault& warning : document.warnings) {
    result.warnings.push_back(describe(warning, file));
  }
  document.files.insert(file);
  document.files.insert(folder + "/model.config");
  result.stamps = FileStamps(document.files);
  return result;
}

LibraryModel read(const std::string& folder, const ModelPaths& model_paths) {
  std::string file = folder + "/model.config";
  try {
    file = modelFile(folder);
    return readFile(folder, file, model_paths);
  } catch (const SdfError& error) {
    throw DescriptionError(describe(error.error(), file));
  }
}

}  // namespace

std::shared_ptr<const LibraryModel> libraryModel(const std::string& folder,
                                                 const ModelPaths& model_paths) {
  static BoundedCache<LibraryModel> cache(256);
  // The same text may include other models if the paths differ.
  std::string key = folder;
  for (const std::string& path : model_paths) key += '\n' + path;
  auto model = cache.find(key);
  if (model && model->stamps.areCurrent()) return model;
  model = std::make_shared<const LibraryModel>(read(folder, model_paths));
  cache.put(key, model);
  return model;
}

void addMeshFiles(const ModelDescription& description, std::set<std::string>* files) {
  for (const Link& link : description.links) {
    for (const Collision& collision : link.collisions) {
      if (!collision.shape.mesh_file.empty()) files->insert(collision.shape.mesh_file);
    }
  }
}

}  // namespace kiva
