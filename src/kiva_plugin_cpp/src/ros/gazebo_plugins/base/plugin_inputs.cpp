// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/base/plugin_inputs.h"

namespace kiva_ros {

std::string withoutNamespace(const std::string& resolved) {
  const std::string& own = ros::this_node::getNamespace();  // "/" at the root
  const bool is_within = own != "/" && resolved.rfind(own + "/", 0) == 0;
  return is_within ? resolved.substr(own.size()) : resolved;
}

void PluginInputs::forEach(const std::function<void(const std::shared_ptr<InputTopic>&)>& act) {
  for (auto at = topics_.begin(); at != topics_.end();) {
    const auto topic = at->second.lock();
    if (topic) act(topic);
    at = topic ? std::next(at) : topics_.erase(at);
  }
}

bool PluginInputs::beforeStep(kiva::World&) {
  forEach([this](const std::shared_ptr<InputTopic>& topic) {
    if (topic->advance() && on_message_) on_message_(topic);
  });
  return true;
}

void PluginInputs::beforeReset(kiva::World&) {
  forEach([](const std::shared_ptr<InputTopic>& topic) { topic->discard(); });
}

void PluginInputs::replay(const rosbag::MessageInstance& recorded) {
  const auto at = topics_.find(recorded.getTopic());
  if (at == topics_.end()) return;
  if (const auto topic = at->second.lock()) topic->replay(recorded);
}

}  // namespace kiva_ros
