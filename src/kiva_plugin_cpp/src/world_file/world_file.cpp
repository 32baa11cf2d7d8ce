// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/world_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "world_file/elements/elements.h"
#include "world_file/elements/frames.h"
#include "world_file/elements/values.h"
#include "world_file/files/bounded_cache.h"
#include "world_file/files/errors.h"
#include "world_file/files/model_paths.h"
#include "world_file/files/text_file.h"
#include "world_file/model_library.h"
#include "world_file/parsing/parser.h"
#include "world_file/parsing/preparation.h"
#include "world_file/sdf/models.h"
#include "world_file/sdf/sensors.h"
#include "world_file/sdf/stand_in.h"
#include "world_file/urdf/urdf.h"

namespace kiva {
namespace {

/// The result of parsing a text without its includes.
struct ParsedText {
  bool is_world = false;
  WorldDescription world;
  Faults warnings;
  FileStamps stamps;
};

void addModel(const XmlElement& model, const Origin& origin, std::vector<ModelInstance>* models,
              Faults* warnings) {
  buildOrLeaveOut("model", warnings, [&] {
    ModelInstance instance;
    instance.name = attributeOf(model, "name");
    instance.pose = poseAround(model);
    instance.description =
        std::make_shared<ModelDescription>(describeModel(model, origin, warnings));
    models->push_back(std::move(instance));
  });
}

/// Returns the <physics> that is marked as the default, else the first.
const XmlElement* physicsOf(const XmlElement& world) {
  const XmlElement* physics_element = nullptr;
  forEach(world, "physics", [&](const XmlElement& physics) {
    const bool is_default = readFlag(attributeOf(physics, "default")).value_or(false);
    if (!physics_element || is_default) physics_element = &physics;
  });
  return physics_element;
}

void setPhysics(const XmlElement& from, WorldDescription* world) {
  const double step = numberIn(from, "max_step_size", 0.001);
  const double factor = numberIn(from, "real_time_factor", 1);
  if (!(step >= kLeastStep && step <= kMostStep)) {
    failAt(from, "expected a max_step_size from 1e-6 to 1 s");
  }
  if (!std::isfinite(factor) || factor < 0) {
    failAt(from, "expected a real_time_factor of 0 or above");
  }
  world->step_size = step;
  world->real_time_factor = factor;
}

void setGravity(const XmlElement& from, WorldDescription* world) {
  constexpr double kUsual = -9.8;  // SDF's default [m/s²]
  const Vector3 gravity = vectorIn(from, "gravity", Vector3(0, 0, kUsual));
  if (!(gravity.Length() <= kMostGravity)) {
    failAt(*from.FirstChildElement("gravity"), "expected a gravity of 1000 m/s² at most");
  }
  world->gravity = gravity;
}

void describeWorld(const XmlElement& from, const Origin& origin, WorldDescription* world,
                   Faults* warnings) {
  world->name = attributeOf(from, "name");
  buildOrLeaveOut("gravity", warnings, [&] { setGravity(from, world); });
  if (const XmlElement* const physics = physicsOf(from)) {
    buildOrLeaveOut("physics", warnings, [&] { setPhysics(*physics, world); });
  }
  world->plugins = readPlugins(from, origin.where);
  forEach(from, "model",
          [&](const XmlElement& model) { addModel(model, origin, &world->models, warnings); });
  forEach(from, "light", [&](const XmlElement& light) {
    buildOrLeaveOut("light", warnings,
                    [&] { world->lights.push_back(describeLight(light, poseAround(light))); });
  });
}

ParsedText parseRest(const std::string& text, const ModelPaths& model_paths,
                     const std::string& where) {
  SdfDocument document = parseSdf(text, model_paths);
  const XmlElement& root = document.root();
  const Origin origin{where, model_paths};
  ParsedText parsed;
  const XmlElement* const world = root.FirstChildElement("world");
  parsed.is_world = world != nullptr;
  if (world && world->NextSiblingElement("world")) {
    failAt(root, "expected one <world>, found several");
  }
  if (world) {
    describeWorld(*world, origin, &parsed.world, &document.warnings);
  } else if (const XmlElement* const model = root.FirstChildElement("model")) {
    addModel(*model, origin, &parsed.world.models, &document.warnings);
  } else if (const XmlElement* const light = root.FirstChildElement("light")) {
    parsed.world.lights.push_back(
        describeLight(*light, valueOfPose(light->FirstChildElement("pose"))));
  }
  parsed.warnings = std::move(document.warnings);
  for (const ModelInstance& model : parsed.world.models) {
    addMeshFiles(*model.description, &document.files);
  }
  parsed.stamps = FileStamps(document.files);
  return parsed;
}

/// Returns the parsed text from a cache: a thousand requests for one model differ only in its
/// includes, names and poses.
std::shared_ptr<const ParsedText> cachedRest(const std::string& text,
                                             const ModelPaths& model_paths) {
  static BoundedCache<ParsedText> cache(256);
  std::string key = text;
  for (const std::string& path : model_paths) key += '\n' + path;
  auto parsed = cache.find(key);
  if (parsed && parsed->stamps.areCurrent()) return parsed;
  parsed = std::make_shared<const ParsedText>(parseRest(text, model_paths, ""));
  cache.put(key, parsed);
  return parsed;
}

/// The reading of one text: knows the text's name and collects its warnings, each once.
class Reading {
 public:
  Reading(const ModelPaths& model_paths, const std::string& where,
          std::vector<std::string>* warnings)
      : model_paths_(model_paths), where_(where), warnings_(warnings) {}

  /// `parse` receives the text without its includes. Throws DescriptionError.
  template <typename Parse>
  ParsedText read(const std::string& xml, Parse parse) {
    try {
      const PreparedText prepared = prepare(xml);
      ParsedText parsed = *parse(prepared.rest);
      for (const Fault& warning : prepared.warnings) warn(describe(warning, where_));
      for (const Fault& warning : parsed.warnings) warn(describe(warning, where_));
      if (prepared.world_name) parsed.world.name = *prepared.world_name;
      parsed.world.models = merge(prepared, std::move(parsed.world.models));
      std::move(lights_.begin(), lights_.end(), std::back_inserter(parsed.world.lights));
      for (ModelInstance& model : parsed.world.models) {
        const auto saved = prepared.poses.find(model.name);
        if (saved != prepared.poses.end()) model.pose = saved->second;
      }
      return parsed;
    } catch (const SdfError& error) {
      throw DescriptionError(describe(error.error(), where_));
    }
  }

  /// Returns the first warning, the most likely reason why nothing is left of a text.
  const std::string& firstWarning() const { return first_warning_; }
  /// Returns the number of models that stand in for others.
  std::size_t standIns() const { return stand_ins_; }

 private:
  void warn(const std::string& text) {
    if (first_warning_.empty()) first_warning_ = text;
    if (warnings_ && warned_.insert(text).second) warnings_->push_back(text);
  }

  /// Returns the models in the order of the text.
  std::vector<ModelInstance> merge(const PreparedText& split, std::vector<ModelInstance> rest) {
    if (split.includes.empty()) return rest;
    std::map<std::string, ModelInstance> originals;
    for (const ModelInstance& model : rest) originals[model.name] = model;
    for (const auto& [name, model] : originals) names_.insert(name);
    std::vector<ModelInstance> models;
    models.reserve(split.includes.size() + rest.size());
    auto of_rest = rest.begin();
    for (const int index : split.order) {
      if (index != PreparedText::kOfRest) {
        const Include& include = split.includes[index];
        if (include.copy_of.empty()) {
          addInclude(include, &models);
        } else {
          addCopy(include, originals, &models);
        }
      } else if (of_rest != rest.end()) {
        models.push_back(std::move(*of_rest++));
      }
    }
    std::move(of_rest, rest.end(), std::back_inserter(models));
    return models;
  }

  void addCopy(const Include& include, const std::map<std::string, ModelInstance>& originals,
               std::vector<ModelInstance>* models) {
    const auto original = originals.find(include.copy_of);
    if (original != originals.end()) return add(include, copyOf(original->second, include), models);
    warn(at(include) + "this model is left out, as is '" + include.copy_of + "', which is like it");
  }

  void addLight(const Include& include, Light light) {
    if (!include.name.empty()) light.name = include.name;
    if (include.pose) light.pose = *include.pose;
    lights_.push_back(std::move(light));
  }

  void addInclude(const Include& include, std::vector<ModelInstance>* models) {
    const LibraryModel* model = nullptr;
    try {
      model = library(include.uri);
    } catch (const DescriptionError& error) {
      return addStandIn(include, std::string("this include is left out: ") + error.what(), models);
    }
    if (!model) return addStandIn(include, leftOut(include.uri, model_paths_), models);
    if (model->light) return addLight(include, *model->light);
    if (!model->description) {
      warn(at(include) + "'" + include.uri + "' holds no model and is left out");
      return;
    }
    add(include, instance(include, *model), models);
  }

  void addStandIn(Include include, const std::string& why, std::vector<ModelInstance>* models) {
    const LibraryModel* const model = library(kUnknownObstacle);
    warn(at(include) + why + (model ? kStandsIn : ""));
    if (!model) return;
    if (include.name.empty()) include.name = nameIn(include.uri);
    include.is_static.reset();
    include.walk.reset();
    ++stand_ins_;
    add(include, instance(include, *model), models);
  }

  void add(const Include& include, ModelInstance model, std::vector<ModelInstance>* models) {
    if (names_.insert(model.name).second) return models->push_back(std::move(model));
    warn(at(include) + "it is left out: the name '" + model.name +
         "' is taken; expected every <model> in <world> to have a name of its own");
  }

  /// Returns the model at a uri, searched for once a reading: five thousand shelves share one
  /// model. Null if there is none.
  const LibraryModel* library(const std::string& uri) {
    auto [entry, is_new] = models_.try_emplace(uri);
    if (!is_new) return entry->second.get();
    const std::string folder = findModel(uri, model_paths_);
    if (folder.empty()) return nullptr;
    entry->second = libraryModel(folder, model_paths_);
    for (const std::string& warning : entry->second->warnings) warn(warning);
    return entry->second.get();
  }

  std::string at(const Include& include) const {
    const std::string what = include.copy_of.empty() ? "include" : "model";
    return where_ + ":" + std::to_string(include.line) + ": " + what + ": ";
  }

  static ModelInstance copyOf(const ModelInstance& original, const Include& include) {
    return {include.name, *include.pose * original.pose, original.description};
  }

  static ModelInstance instance(const Include& include, const LibraryModel& model) {
    ModelInstance result{model.name, model.pose, model.description};
    if (!include.name.empty()) result.name = include.name;
    if (include.pose) result.pose = *include.pose * model.placement;
    result.walk = include.walk;
    if (include.is_static && *include.is_static != model.description->is_static) {
      auto changed = std::make_shared<ModelDescription>(*model.description);
      changed->is_static = *include.is_static;
      result.description = std::move(changed);
    }
    return result;
  }

  const ModelPaths& model_paths_;
  const std::string& where_;
  std::vector<std::string>* warnings_;
  std::string first_warning_;
  std::size_t stand_ins_ = 0;
  std::set<std::string> warned_;
  std::set<std::string> names_;
  std::vector<Light> lights_;  ///< Lights of includes.
  std::map<std::string, std::shared_ptr<const LibraryModel>> models_;
};

}  // namespace

WorldDescription loadWorld(const std::string& path, const ModelPaths& model_paths,
                           std::vector<std::string>* warnings) {
  return parseWorld(readText(path, kMostBytes), model_paths, path, warnings);
}

WorldDescription parseWorld(const std::string& xml, const ModelPaths& model_paths,
                            const std::string& where, std::vector<std::string>* warnings) {
  const bool is_urdf = isUrdf(xml);
  const std::string text = is_urdf ? withInertias(xml) : xml;
  ParsedText parsed =
      Reading(model_paths, where, warnings).read(text, [&](const std::string& rest) {
        return std::make_shared<const ParsedText>(parseRest(rest, model_paths, where));
      });
  if (is_urdf) {
    for (ModelInstance& model : parsed.world.models) letStand(&model);
  } else if (!parsed.is_world) {
    throw DescriptionError(where + ": expected a <world> in <sdf>, or a URDF <robot>");
  }
  return std::move(parsed.world);
}

std::vector<ModelInstance> parseModels(const std::string& xml, const ModelPaths& model_paths,
                                       const std::string& where, std::vector<std::string>* warnings,
                                       std::vector<Light>* lights) {
  Reading reading(model_paths, where, warnings);
  ParsedText parsed =
      reading.read(xml, [&](const std::string& rest) { return cachedRest(rest, model_paths); });
  const bool has_lights = lights && !parsed.world.lights.empty();
  if (has_lights) *lights = std::move(parsed.world.lights);
  if (parsed.world.models.size() == reading.standIns() && !has_lights) {
    const std::string& why = reading.firstWarning();
    throw DescriptionError(why.empty() ? where + ": expected a <model> in <sdf>" : why);
  }
  return std::move(parsed.world.models);
}

}  // namespace kiva
