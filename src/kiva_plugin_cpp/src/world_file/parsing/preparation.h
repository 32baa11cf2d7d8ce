// SPDX-License-Identifier: Apache-2.0
//
// Preparation of a world's text: takes out elements beyond SDF, and elements in great numbers. A
// world of 5000 shelves includes the same model 5000 times. Most includes only name a model and its
// pose: they are taken out of the text, and the model is read once. The same holds for repeated
// models, the clones of populations, and people.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world_file.h"
#include "world_file/files/xml.h"

namespace kiva {

/// An `<include>` of a world with a uri and at most a name, a pose and a static flag; or a
/// `<model>` that differs from an earlier one in name and pose alone.
struct Include {
  std::string uri;
  std::string copy_of;            ///< Name of a model in the rest, instead of a uri.
  std::string name;               ///< Name of a model in the rest, in place of a uri.
  std::optional<Pose> pose;       ///< Pose in world; default: the model's. That of a copy is
                                  ///< relative to the original, along the world's axes.
  std::optional<bool> is_static;  ///< Default: the model's flag.
  std::optional<Walk> walk;       ///< An actor's walk.
  int line = 0;
};

struct PreparedText {
  std::string rest;  ///< The rest of the text, on its original lines.
  std::vector<Include> includes;
  /// The world's models in the order of the text: index of an include, or kOfRest.
  std::vector<int> order;
  static constexpr int kOfRest = -1;
  Faults warnings;
  /// The world's name, if SDF reserves it and another one replaces it.
  std::optional<std::string> world_name;
  /// Poses of models by name, in a world's `<state>` as Gazebo saves it.
  std::map<std::string, Pose> poses;
};

/// Takes includes, copies and people out of a world's text. Keeps elements that it does not know,
/// and everything if parts of the world refer to each other. Throws SdfError.
PreparedText prepare(const std::string& xml);

/// Removes `<pose frame="">` and the like, which newer versions of SDF don't have.
void modernizePoses(XmlDocument* document);

}  // namespace kiva
