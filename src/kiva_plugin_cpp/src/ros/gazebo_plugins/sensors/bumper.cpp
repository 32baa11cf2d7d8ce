// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/sensors/bumper.h"

#include <map>
#include <sstream>
#include <utility>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

/// Returns the contacts of each pair of collisions, one state a pair.
class States {
 public:
  States(double time, gazebo_msgs::ContactsState* out) : time_(time), out_(out) {}

  void add(const kiva::ContactPoint& point) {
    gazebo_msgs::ContactState& state = stateOf(point);
    geometry_msgs::Wrench wrench;
    wrench.force = toMessage(point.force);
    state.wrenches.push_back(wrench);
    state.contact_positions.push_back(toMessage(point.position));
    state.contact_normals.push_back(toMessage(point.normal));
    state.depths.push_back(point.depth);
    state.total_wrench.force.x += wrench.force.x;
    state.total_wrench.force.y += wrench.force.y;
    state.total_wrench.force.z += wrench.force.z;
  }

 private:
  gazebo_msgs::ContactState& stateOf(const kiva::ContactPoint& point) {
    const auto [at, is_new] =
        index_.try_emplace({point.collision1, point.collision2}, index_.size());
    if (is_new) {
      std::ostringstream info;
      info << "my geom:" << point.collision1 << "   other geom:" << point.collision2
           << "         time:" << time_;
      out_->states.emplace_back();
      out_->states.back().info = info.str();
      out_->states.back().collision1_name = point.collision1;
      out_->states.back().collision2_name = point.collision2;
    }
    return out_->states[at->second];
  }

  double time_;
  gazebo_msgs::ContactsState* out_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;
};

}  // namespace

void Bumper::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  const kiva::SensorDescription& from = sensor(p, "contact");
  const std::string prefix = model + "::" + from.link + "::";
  const kiva::Link& link = *description().findLink(from.link);
  for (const auto& [key, name] : from.parameters.values()) {
    if (key.rfind("contact/collision", 0) != 0) continue;
    for (const kiva::Collision& collision : link.collisions) {
      const std::string scoped = prefix + collision.name;
      if (name == collision.name || name == scoped) collisions_.insert(scoped);
    }
  }
  if (collisions_.empty()) {
    throw kiva::DescriptionError("<contact><collision> names no collision of link '" + from.link +
                                 "'");
  }
  schedule_ = Schedule(from.update_rate);
  frame_ = frame(p.text("frameName", "world"));
  skip(p, {"alwaysOn", "updateRate"});
  publisher_ = advertise<gazebo_msgs::ContactsState>(p.text("bumperTopicName", "bumper_states"));
}

void Bumper::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  gazebo_msgs::ContactsState out;
  out.header = header(world.time(), frame_);
  States states(world.time(), &out);
  for (const kiva::ContactPoint& point : world.contacts(model())) {
    if (collisions_.count(point.collision1) > 0) states.add(point);
  }
  publish(publisher_, std::move(out));
}

}  // namespace kiva_ros
