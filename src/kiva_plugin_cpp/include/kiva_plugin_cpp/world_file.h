// SPDX-License-Identifier: Apache-2.0
//
// Reads SDF (1.0 to 1.11) and URDF into descriptions. A document is checked whole before anything
// is built from it. Any thread may call.
#pragma once

#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Folders that are searched for names such as `model://name`. They hold `name/model.config` or the
/// path of a mesh; the first match wins.
using ModelPaths = std::vector<std::string>;

/// Returns the folders of models that ROS packages export to Gazebo: `gazebo_model_path` of the
/// element `<gazebo_ros>` in their package.xml. Searches all packages below the folders of `a:b`,
/// the format of ROS_PACKAGE_PATH.
ModelPaths exportedModelPaths(const std::string& ros_package_path);

/// Returns all folders that the environment names: GAZEBO_MODEL_PATH, exports of packages on
/// ROS_PACKAGE_PATH, and the folders of GAZEBO_RESOURCE_PATH with their `models`.
ModelPaths environmentModelPaths();

/// Returns the folder of a world file and the two above it, each with its `models`: the usual
/// places in a package.
ModelPaths modelPathsAround(const std::string& world_file);

/// Returns the world in the file at `path`.
///
/// Faulty parts are left out, as small as possible. `warnings`, if given, gets a line for each:
/// file, line, entity and cause. Throws DescriptionError if no world would be left: the file is not
/// XML, not SDF, larger than 20 MB, or nested deeper than 100 elements.
WorldDescription loadWorld(const std::string& path, const ModelPaths& model_paths,
                           std::vector<std::string>* warnings = nullptr);

/// Returns the world in an SDF text; `where` stands in for the file's name in errors.
WorldDescription parseWorld(const std::string& xml, const ModelPaths& model_paths,
                            const std::string& where, std::vector<std::string>* warnings = nullptr);

/// Returns the models of a spawn request: `<sdf><model>`, or `<sdf><world>` with one or more models
/// or includes, or a URDF `<robot>`, each with the name and pose that the document gives it. Throws
/// DescriptionError. Equal texts share their descriptions through a cache, so that a thousand equal
/// robots are parsed once. `lights`, if given, receives the document's lights, which then need no
/// model beside them.
std::vector<ModelInstance> parseModels(const std::string& xml, const ModelPaths& model_paths,
                                       const std::string& where,
                                       std::vector<std::string>* warnings = nullptr,
                                       std::vector<Light>* lights = nullptr);

/// Returns whether a text is URDF: its root is a `<robot>`.
bool isUrdf(const std::string& xml);

}  // namespace kiva
