// SPDX-License-Identifier: Apache-2.0
//
// What a world file may hold beyond what libsdformat makes models of.
#pragma once

#include <map>
#include <sdf/Types.hh>
#include <string>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

struct PreparedText {
  std::string xml;  ///< On the lines where it was: without actors and states, populations
                    ///< written out.
  sdf::Errors warnings;
  /// Where a world's `<state>`, as Gazebo saves it, has its models; by name.
  std::map<std::string, Pose> poses;
};

PreparedText prepare(const std::string& xml);

}  // namespace kiva
