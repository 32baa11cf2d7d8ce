// SPDX-License-Identifier: Apache-2.0
//
// What a world file may hold beyond SDF, and what it holds in great numbers: a world of 5000
// shelves includes the same model 5000 times. Most includes say no more than which model stands
// where: those are taken out of the text here, and the model they name is read once. So are models
// whose text has been there before, the clones of populations, and people.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world_file.h"
#include "world_file/files/xml.h"

namespace kiva {

/// An `<include>` of a world that gives a uri and at most a name, a pose and a static flag; or a
/// `<model>` that differs from one before it in name and pose alone.
struct Include {
  std::string uri;
  std::string copy_of;            ///< Instead of a uri: the name of a model in the rest.
  std::string name;               ///< Empty: that of the model.
  std::optional<Pose> pose;       ///< In world; none: that of the model. A copy's is relative to
                                  ///< what it is a copy of, seen from the world.
  std::optional<bool> is_static;  ///< None: as the model has it.
  std::optional<Walk> walk;       ///< Of an actor.
  int line = 0;
};

struct PreparedText {
  std::string rest;  ///< On the lines where it was.
  std::vector<Include> includes;
  /// The world's models in the order of the text: index of an include, or kOfRest.
  std::vector<int> order;
  static constexpr int kOfRest = -1;
  Faults warnings;
  /// The world's name, where SDF keeps it for itself and another was put there.
  std::optional<std::string> world_name;
  /// Where a world's `<state>`, as Gazebo saves it, has its models; by name.
  std::map<std::string, Pose> poses;
};

/// Leaves in place what it does not understand, and all includes and models if parts of the world
/// refer to each other. Throws SdfError.
PreparedText prepare(const std::string& xml);

/// `<pose frame="">` and the like, which is not in newer versions of SDF.
void modernizePoses(XmlDocument* document);

}  // namespace kiva
