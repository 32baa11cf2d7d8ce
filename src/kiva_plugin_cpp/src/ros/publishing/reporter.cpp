// SPDX-License-Identifier: Apache-2.0
#include "reporter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ros/messages/convert.h"
#include "ros/messages/step_rate.h"
#include "warehouse_messages.h"

namespace kiva_ros {
namespace {

constexpr double kRobotsRate = 20;  // [Hz], odometry and transforms
// Least gap between clocks without pacing. A client that receives a thousand clocks a second does
// little else.
constexpr auto kClockGap = std::chrono::milliseconds(4);
constexpr double kStatusRate = 10;  // [Hz], while there are subscribers
constexpr double kHashRate = 1;     // [Hz]
constexpr auto kObjectsInterval = std::chrono::milliseconds(100);
constexpr auto kLatchedStatusInterval = std::chrono::milliseconds(400);

kiva::Pose poseOfLink(const kiva::ModelDescription& model, const char* link) {
  const kiva::Link* description = model.findLink(link);
  return description ? description->pose_in_model : kiva::Pose();
}

RobotInfos robotInfos(const kiva::World& world) {
  RobotInfos out;
  for (const kiva::Robot& robot : world.fleet().robots) {
    const auto model = world.description(robot.name);
    out.push_back({robot.id, robot.laser, poseOfLink(*model, "left_wheel"),
                   poseOfLink(*model, "right_wheel"), poseOfLink(*model, "tower")});
  }
  return out;
}

RobotPose poseOf(const kiva::World& world, int i) {
  const kiva::Fleet& f = world.fleet();
  RobotPose out;
  out.kiva_id = f.robots[i].id;
  out.base = world.basePose(i);
  const kiva::PlanarTwist moves{f.vx[i], f.vy[i], f.yaw_rate[i]};
  const kiva::PlanarTwist twist = world.shadowTwist(i).value_or(moves);
  out.twist.linear = out.base.Rot().RotateVectorReverse({twist.vx, twist.vy, 0});
  out.twist.angular = {0, 0, twist.yaw_rate};
  for (int wheel = 0; wheel < 2; ++wheel) out.wheel_angle[wheel] = f.wheel_angle[wheel][i];
  out.tower = f.tower[i];
  if (!world.isSteered(i)) return out;
  const kiva::Vector3 at = world.odometry(i).pose;
  out.counted = kiva::Pose(at.X(), at.Y(), 0, 0, 0, at.Z());
  return out;
}

/// Returns whether a robot's radio is lost, so that it reports nothing.
bool isSilent(const kiva::World& world, int robot) {
  return (world.fleet().failures[robot] & kiva::bitOf(kiva::Failure::kRadio)) != 0;
}

/// Returns a robot's pose and twist by its own odometry.
RobotPose believedOf(const kiva::World& world, int i) {
  RobotPose out = poseOf(world, i);
  if (out.counted) out.base = *out.counted;
  if (!world.realism().localisation.enabled) return out;
  const kiva::Odometry odometry = world.odometry(i);
  const kiva::Vector3& at = odometry.pose;
  out.base = kiva::Pose(at.X(), at.Y(), out.base.Z(), 0, 0, at.Z());
  out.twist = {{odometry.speed, 0, 0}, {0, 0, odometry.turn_rate}};
  out.is_exact = false;
  out.pose_covariance = odometry.pose_covariance;
  out.twist_covariance = odometry.twist_covariance;
  return out;
}

}  // namespace

Reporter::Reporter(const kiva::World& world, const Rates& rates, double rtf,
                   SubscriberCounts& subscribers, PublishQueue& publish_queue,
                   SnapshotQueue& snapshots)
    : rates_(rates),
      subscribers_(subscribers),
      publish_queue_(publish_queue),
      snapshots_(snapshots) {
  retime(world.stepSize(), rtf);
}

void Reporter::retime(double step_size, double rtf) {
  clock_gap_ = rtf == 0 ? kClockGap : WallClock::duration(0);
  clock_every_ = stepsPer(rates_.clock, step_size);
  models_every_ = stepsPer(rates_.model_states, step_size);
  fleet_every_ = stepsPer(rates_.fleet, step_size);
  robots_every_ = stepsPer(kRobotsRate, step_size);
  heartbeat_every_ = stepsPer(kStatusRate * kHeartbeatSlots, step_size);
  hash_every_ = stepsPer(kHashRate, step_size);
}

void Reporter::afterStep(kiva::World& world, bool reliable) {
  Snapshot out;
  out.time = world.time();
  addNews(world, &out);
  addPeriodic(world, reliable, &out);
  addObjects(world, &out);
  out.publications = publish_queue_.take();
  last_steps_ = world.steps();
  send(std::move(out), reliable);
}

void Reporter::refused(const kiva::World& world, int kiva_id, const std::string& text) {
  const std::string robot = "kiva" + std::to_string(kiva_id);
  extra_events_.push_back({world.time(), kiva::Event::Kind::kRefused, robot, "", text});
}

void Reporter::beginTimeline() {
  ++timeline_;
  units_revision_ = kNever;  // publishes the units' places of the new timeline
}

void Reporter::restored(const kiva::World& world, const std::vector<std::string>& before) {
  using Kind = kiva::Event::Kind;
  const std::vector<std::string> now = world.modelNames();
  const std::set<std::string> old_names(before.begin(), before.end());
  const std::set<std::string> new_names(now.begin(), now.end());
  const auto report = [&](Kind kind, const std::string& name) {
    extra_events_.push_back({world.time(), kind, name, "", "by going back to a checkpoint"});
  };
  for (const std::string& name : before) {
    if (!new_names.count(name)) report(Kind::kDeleted, name);
  }
  for (const std::string& name : now) {
    if (!old_names.count(name)) report(Kind::kSpawned, name);
  }
  last_steps_ = clock_sent_steps_ = kNever;  // time jumped
}

void Reporter::whenPublished(const kiva::World& world, std::function<void()> done) {
  Snapshot out;
  out.time = world.time();
  addObjects(world, &out, true);
  addReliableClock(world, &out);
  out.published = std::move(done);
  send(std::move(out));
}

void Reporter::afterRequests(kiva::World& world, bool stands, bool moved) {
  Snapshot out;
  out.time = world.time();
  addNews(world, &out);
  updateSubscribedRobots();
  // Subscribers get the clock at once while time stands still, or after it jumped.
  const bool reset = world.steps() < last_steps_;
  if (stands || reset) addReliableClock(world, &out);
  if (moved && (stands || reset)) {
    addStatuses(world, &out);
    addFleet(world, &out);
    addOdometry(world, &out);
    if (reset) addTransforms(world, &out);  // tf ignores a second one with the same time
  }
  if (stands) addForNewcomers(world, &out);
  addObjects(world, &out);
  last_steps_ = world.steps();
  send(std::move(out));
}

void Reporter::held(const kiva::World& world) {
  Snapshot out;
  out.time = world.time();
  addReliableClock(world, &out);
  addFleet(world, &out);
  send(std::move(out), true);
}

void Reporter::addForNewcomers(const kiva::World& world, Snapshot* out) {
  if (subscribers_.takeNewSubscriber(SubscriberCounts::Topic::kFleet)) addFleet(world, out);
  if (subscribers_.takeNewSubscriber(SubscriberCounts::Topic::kTransforms))
    addTransforms(world, out);
  if (subscribers_.takeNewSubscriber(SubscriberCounts::RobotTopic::kOdometry))
    addOdometry(world, out);
}

void Reporter::send(Snapshot snapshot, bool reliable) {
  if (snapshot.hasReliable() || snapshot.hasBestEffort())
    snapshots_.push(std::move(snapshot), reliable);
}

void Reporter::addNews(kiva::World& world, Snapshot* out) {
  for (const std::string& warning : world.takeWarnings()) ROS_WARN("%s", warning.c_str());
  out->events = world.takeEvents();
  out->statuses = world.takeStatusChanges();
  out->events.insert(out->events.end(), extra_events_.begin(), extra_events_.end());
  extra_events_.clear();
  for (const kiva::Event& event : out->events) {
    if (!isAboutRobot(world, event)) continue;
    out->robots = robotInfos(world);
    robots_.clear();
    for (const kiva::Robot& robot : world.fleet().robots) robots_.insert(robot.name);
    addStatuses(world, out);
    return;
  }
}

/// Returns whether an event is about a robot that was added or removed.
bool Reporter::isAboutRobot(const kiva::World& world, const kiva::Event& event) const {
  if (event.kind == kiva::Event::Kind::kDeleted) return robots_.count(event.model) != 0;
  return event.kind == kiva::Event::Kind::kSpawned &&
         world.kind(event.model) == kiva::ModelKind::kRobot;
}

void Reporter::addStatuses(const kiva::World& world, Snapshot* out) const {
  for (int i = 0; i < world.fleet().size(); ++i) out->statuses.push_back(statusOf(world, i));
}

void Reporter::addClock(const kiva::World& world, bool reliable, Snapshot* out) {
  if (world.steps() % clock_every_ != 0) return;
  if (clock_gap_.count() > 0) {
    const auto now = WallClock::now();
    if (now < clock_sent_ + clock_gap_) return;
    clock_sent_ = now;
  }
  out->clock = true;
  if (reliable) clock_sent_steps_ = world.steps();
}

/// Adds the clock, whatever its rate, unless it was sent so at this step already.
void Reporter::addReliableClock(const kiva::World& world, Snapshot* out) {
  out->reliable_clock = world.steps() != clock_sent_steps_;
  clock_sent_steps_ = world.steps();
}

/// Adds the status of robots with subscribers at kStatusRate. Adds the status of every robot once a
/// simulated second, to refresh latched messages, or less often if the wall clock requires it.
void Reporter::addHeartbeats(const kiva::World& world, Snapshot* out) {
  const std::uint64_t beat = world.steps() / heartbeat_every_;
  const int slot = static_cast<int>(beat % kHeartbeatSlots);
  const bool second = beat / kHeartbeatSlots % static_cast<int>(kStatusRate) == 0;
  const auto now = WallClock::now();
  const bool all = second && now >= heartbeat_sent_[slot] + kLatchedStatusInterval;
  if (all) heartbeat_sent_[slot] = now;
  if (all) {
    for (int i = 0; i < world.fleet().size(); ++i) {
      const bool is_due = world.fleet().robots[i].id % kHeartbeatSlots == slot;
      if (is_due && !isSilent(world, i)) out->statuses.push_back(statusOf(world, i));
    }
    return;
  }
  for (int id : status_ids_) {
    if (id % kHeartbeatSlots != slot) continue;
    const int i = world.fleet().find(id);
    if (i >= 0 && !isSilent(world, i)) out->heartbeats.push_back(statusOf(world, i));
  }
}

void Reporter::addPeriodic(const kiva::World& world, bool reliable, Snapshot* out) {
  const std::uint64_t steps = world.steps();
  updateSubscribedRobots();
  addClock(world, reliable, out);
  if (steps % heartbeat_every_ == 0) addHeartbeats(world, out);
  if (steps % fleet_every_ == 0) {
    addPeople(world, out);
    addFleet(world, out);
  }
  if (steps % robots_every_ == 0) {
    addOdometry(world, out);
    addTransforms(world, out);
  }
  if (steps % models_every_ == 0) {
    addModelStates(world, out);
    addLinkStates(world, out);
  }
  if (!scan_ids_.empty()) addScans(world, out);
  if (steps % hash_every_ == 0 &&
      subscribers_.hasSubscribers(SubscriberCounts::Topic::kStateHash)) {
    out->state_hash = hashText(world);
  }
}

void Reporter::updateSubscribedRobots() {
  const std::uint64_t revision = subscribers_.robotsRevision();
  if (revision == subscribed_revision_) return;
  subscribed_revision_ = revision;
  status_ids_ = subscribers_.subscribedRobots(SubscriberCounts::RobotTopic::kStatus);
  scan_ids_ = subscribers_.subscribedRobots(SubscriberCounts::RobotTopic::kScan);
  odometry_ids_ = subscribers_.subscribedRobots(SubscriberCounts::RobotTopic::kOdometry);
}

void Reporter::addFleet(const kiva::World& world, Snapshot* out) const {
  if (!subscribers_.hasSubscribers(SubscriberCounts::Topic::kFleet)) return;
  out->fleet = fleetState(world);
  out->fleet->timeline = timeline_;
}

void Reporter::addPeople(const kiva::World& world, Snapshot* out) {
  warehouse_msgs::People people = peopleMessage(world);
  if (!people.name.empty() || people_were_there_) out->people = people;
  people_were_there_ = !people.name.empty();
}

void Reporter::addOdometry(const kiva::World& world, Snapshot* out) const {
  out->odometry.clear();
  for (int id : odometry_ids_) {
    const int i = world.fleet().find(id);
    if (i >= 0 && !isSilent(world, i)) out->odometry.push_back(believedOf(world, i));
  }
}

void Reporter::addTransforms(const kiva::World& world, Snapshot* out) const {
  if (!subscribers_.hasSubscribers(SubscriberCounts::Topic::kTransforms)) return;
  out->transforms.clear();
  for (int i = 0; i < world.fleet().size(); ++i) out->transforms.push_back(poseOf(world, i));
}

void Reporter::addScans(const kiva::World& world, Snapshot* out) const {
  std::vector<int> heard;
  for (int i : world.scansDue()) {
    const int id = world.fleet().robots[i].id;
    const bool is_heard = std::binary_search(scan_ids_.begin(), scan_ids_.end(), id);
    if (is_heard && !isSilent(world, i)) heard.push_back(i);
  }
  std::vector<std::vector<float>> ranges;
  world.scan(heard, &ranges);
  for (std::size_t k = 0; k < heard.size(); ++k) {
    out->scans.push_back({world.fleet().robots[heard[k]].id, std::move(ranges[k])});
  }
}

void Reporter::addModelStates(const kiva::World& world, Snapshot* out) {
  if (!subscribers_.hasSubscribers(SubscriberCounts::Topic::kModelStates)) return;
  if (names_revision_ != world.modelsRevision()) {
    names_ = std::make_shared<const std::vector<std::string>>(world.modelNames());
    names_revision_ = world.modelsRevision();
  }
  out->models.emplace();
  out->models->names = names_;
  world.states(&out->models->states);
}

void Reporter::addLinkStates(const kiva::World& world, Snapshot* out) {
  if (!subscribers_.hasSubscribers(SubscriberCounts::Topic::kLinkStates)) return;
  std::vector<std::string> names;
  out->links.emplace();
  world.linkStates(&names, &out->links->states);
  if (link_names_revision_ != world.modelsRevision()) {
    link_names_ = std::make_shared<const std::vector<std::string>>(std::move(names));
    link_names_revision_ = world.modelsRevision();
  }
  out->links->names = link_names_;
}

void Reporter::addObjects(const kiva::World& world, Snapshot* out, bool at_once) {
  const bool models = world.modelsRevision() != objects_revision_;
  next_due_ = WallClock::time_point::max();
  if (are_objects_held_ && !at_once) return;
  if (!models && world.unitsRevision() == units_revision_) return;
  const auto now = WallClock::now();
  if (!at_once && now < objects_sent_ + kObjectsInterval) {
    next_due_ = objects_sent_ + kObjectsInterval;
    return;
  }
  // Published together, since units refer to the order of objects.
  if (models) out->objects = warehouseObjects(world);
  out->units = unitStates(world);
  out->units->timeline = timeline_;
  objects_revision_ = world.modelsRevision();
  units_revision_ = world.unitsRevision();
  objects_sent_ = now;
}

}  // namespace kiva_ros
