// SPDX-License-Identifier: Apache-2.0
#include "broadcaster.h"

#include <std_msgs/String.h>

#include <chrono>

#include "ros/messages/convert.h"
#include "warehouse_messages.h"

namespace kiva_ros {
namespace {

/// Queue size for a slow subscriber: several times the commands that may be pending in a step, with
/// an event each.
constexpr int kEventQueue = 1000000;

constexpr std::size_t kCrowd = 10;  // messages at once
constexpr auto kBatch = std::chrono::milliseconds(1);

std_msgs::String hashMessage(const std::string& hash) {
  std_msgs::String out;
  out.data = hash;
  return out;
}

void uncounted(int) {}

}  // namespace

Broadcaster::Broadcaster(ros::NodeHandle& root, ros::NodeHandle& node,
                         SubscriberCounts& subscribers, SnapshotQueue& snapshots,
                         bool locates_steered)
    : snapshots_(snapshots),
      robots_(root, subscribers),
      transforms_(root, subscribers, locates_steered),
      clock_(root, "clock", kStreamQueue, uncounted),
      events_(root.advertise<warehouse_msgs::Event>("warehouse/events", kEventQueue)),
      objects_(root, "warehouse/objects", kStreamQueue, uncounted),
      units_(root, "warehouse/unit_states", kStreamQueue, uncounted),
      people_(root, "warehouse/people", kStreamQueue, uncounted),
      collisions_(root.advertise<warehouse_msgs::Collision>("warehouse/collisions", kEventQueue)) {
  fleet_ = advertiseCounted<warehouse_msgs::FleetState>(
      root, "warehouse/fleet", kStreamQueue,
      [&subscribers](int change) { subscribers.count(SubscriberCounts::Topic::kFleet, change); });
  hash_ = advertiseCounted<std_msgs::String>(
      root, "warehouse/state_hash", kStreamQueue, [&subscribers](int change) {
        subscribers.count(SubscriberCounts::Topic::kStateHash, change);
      });
  const auto count_models = [&subscribers](int change) {
    subscribers.count(SubscriberCounts::Topic::kModelStates, change);
  };
  model_states_ =
      advertiseCounted<gazebo_msgs::ModelStates>(root, "model_states", kStreamQueue, count_models);
  gazebo_model_states_ =
      advertiseCounted<gazebo_msgs::ModelStates>(node, "model_states", kStreamQueue, count_models);
  link_states_ = advertiseCounted<gazebo_msgs::LinkStates>(
      node, "link_states", kStreamQueue, [&subscribers](int change) {
        subscribers.count(SubscriberCounts::Topic::kLinkStates, change);
      });
  thread_ = std::thread(&Broadcaster::run, this);
}

void Broadcaster::run() {
  for (auto batch = snapshots_.take(); !batch.empty(); batch = snapshots_.take()) {
    std::size_t bulk = 0;
    for (const Snapshot& snapshot : batch) {
      publish(snapshot);
      bulk += snapshot.bulk();
    }
    events_.flush();
    // Sends many messages together, so that this thread and those of clients wake less often.
    if (bulk >= kCrowd && !batch.back().reliable) std::this_thread::sleep_for(kBatch);
  }
}

void Broadcaster::stop() {
  snapshots_.close();
  if (thread_.joinable()) thread_.join();
}

void Broadcaster::publish(const Snapshot& s) {
  if (s.clock || s.reliable_clock) {
    rosgraph_msgs::Clock clock;
    clock.clock = ros::Time(s.time);
    clock_.publish(clock);
  }
  if (s.robots) {
    robots_.update(*s.robots);
    transforms_.update(*s.robots);
  }
  for (const kiva::Event& event : s.events) publishEvent(event);
  for (const kiva::StatusChange& status : s.statuses) robots_.publish(status);
  for (const kiva::StatusChange& status : s.heartbeats) robots_.publish(status);
  for (const Scan& scan : s.scans) robots_.publish(scan, s.time);
  for (const RobotPose& robot : s.odometry) robots_.publishOdometry(robot, s.time);
  if (!s.transforms.empty()) transforms_.publish(s.transforms, s.time);
  if (s.objects) objects_.publish(*s.objects);
  if (s.units) units_.publish(*s.units);
  if (s.people) people_.publish(*s.people);
  if (s.fleet) fleet_.publish(*s.fleet);
  if (s.models) publishModels(*s.models);
  if (s.links) publishLinks(*s.links);
  for (const PublishQueue::Publication& publication : s.publications) publication();
  if (!s.state_hash.empty()) hash_.publish(hashMessage(s.state_hash));
  // roscpp's queues are short: the next message could displace this one.
  if (s.reliable || s.published) {
    events_.flush();
    poll_thread_.flush();
  }
  if (s.published) s.published();
}

void Broadcaster::publishEvent(const kiva::Event& event) {
  warehouse_msgs::Event message = toMessage(event);
  events_.add(message);
  if (event.kind == kiva::Event::Kind::kCollision) {
    collisions_.publish(toCollision(event));
    ROS_WARN("Collision: %s", event.text.c_str());
  } else if (event.kind == kiva::Event::Kind::kRefused) {
    ROS_DEBUG("%s: refused: %s", event.model.c_str(), event.text.c_str());
  }
}

namespace {

/// Publishes the states of models; their names are copied only after a change.
template <typename Message>
void fill(const ModelStates& from, std::shared_ptr<const std::vector<std::string>>* names,
          Message* out) {
  if (*names != from.names) {
    *names = from.names;
    out->name = *from.names;
  }
  out->pose.clear();
  out->twist.clear();
  for (const kiva::EntityState& state : from.states) {
    out->pose.push_back(toMessage(state.pose));
    out->twist.push_back(toMessage(state.twist));
  }
}

}  // namespace

void Broadcaster::publishModels(const ModelStates& models) {
  fill(models, &names_, &models_);
  model_states_.publish(models_);
  gazebo_model_states_.publish(models_);
}

void Broadcaster::publishLinks(const ModelStates& links) {
  fill(links, &link_names_, &links_);
  link_states_.publish(links_);
}

}  // namespace kiva_ros
