// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"

namespace kiva_ros {

/// Maps common plugins of gazebo_ros without a stand-in, by file name, to advice: what is missing,
/// and what to do instead.
const std::map<std::string, std::string>& lackingPlugins();

/// A plugin without a stand-in: load() refuses it with that advice.
class Lacking : public GazeboPlugin {
 public:
  Lacking(const PluginContext& context, std::string advice)
      : GazeboPlugin(context), advice_(std::move(advice)) {}
  void load(kiva::World&, const std::string&, const kiva::Parameters&) override {
    throw kiva::DescriptionError(advice_);
  }

 private:
  const std::string advice_;
};

}  // namespace kiva_ros
