// SPDX-License-Identifier: Apache-2.0
//
// The plugins that come with the world. A user's plugin is an object a model; these serve the
// whole fleet with one object each, so that a step is a loop over arrays.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/state/views/contact_view.h"
#include "core/state/world/plugins.h"

namespace kiva {

class FleetPlugin {
 public:
  virtual ~FleetPlugin() = default;
  /// Returns the file name by which an SDF asks for it.
  virtual const char* filename() const = 0;
  /// Reads one robot's parameters, before the robot joins the fleet. Throws DescriptionError.
  virtual void configure(Robot& robot, const Parameters& parameters) const = 0;
  /// Decides upon what was seen in the last step, before robots take new commands. `sighted`: the
  /// robots whose lasers looked ahead in it.
  virtual void react(MotionView& /*world*/, const std::vector<int>& /*sighted*/) const {}
  /// Says what motors and towers are to do in this step.
  virtual void control(ContactView& /*world*/) const {}
};

/// Returns the plugin with that file name, or null.
const FleetPlugin* findFleetPlugin(const Plugins& plugins, const std::string& filename);

/// The file name by which a world asks for its grid.
constexpr char kGridPlugin[] = "libkiva_grid.so";
constexpr char kLightCurtainPlugin[] = "libkiva_light_curtain.so";

}  // namespace kiva
