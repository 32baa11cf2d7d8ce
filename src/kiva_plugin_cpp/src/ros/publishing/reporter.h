// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "ros/transport/publish_queue.h"
#include "ros/transport/subscriber_counts.h"
#include "ros/transport/wall_clock.h"
#include "snapshot_queue.h"

namespace kiva_ros {

/// Samples, on the step thread, the data that are due and queues them for the broadcaster.
/// Rates are in simulated time and counted in steps. Only the two latched messages of objects and
/// units are throttled by the wall clock, since models come and go while time stands still.
class Reporter {
 public:
  struct Rates {
    double clock = 100;        ///< [Hz], 0 = every step.
    double model_states = 50;  ///< [Hz], 0 = every step.
    double fleet = 10;         ///< Rate of FleetState [Hz].
  };

  /// `rtf`: the target real-time factor; at 0, as fast as possible, /clock is throttled by the wall
  /// clock.
  Reporter(const kiva::World& world, const Rates& rates, double rtf, SubscriberCounts& subscribers,
           PublishQueue& publish_queue, SnapshotQueue& snapshots);
  void retime(double step_size, double rtf);

  /// Reports a step. `reliable`: nothing is dropped, however slow a subscriber is.
  void afterStep(kiva::World& world, bool reliable = false);
  /// Reports requests that were served between steps. `stands`: time stands still; `moved`: models
  /// may have been moved.
  void afterRequests(kiva::World& world, bool stands, bool moved);
  /// Reports the clock and the fleet, whatever is due and however slow a subscriber is: time waits
  /// for subscribers, which would wait for these.
  void held(const kiva::World& world);
  /// Reports a command that was refused before it reached the world.
  void refused(const kiva::World& world, int kiva_id, const std::string& text);
  /// Begins a new timeline, since the world was reset or restored: orders of the old one are void.
  void beginTimeline();
  /// Returns the number of the timeline, counted from 1.
  std::uint32_t timeline() const { return timeline_; }
  /// Reports a restored world; `before` are the names of the models before it.
  void restored(const kiva::World& world, const std::vector<std::string>& before);
  /// Keeps the messages of all objects and units back, while many models come and go, or no longer.
  void holdObjects(bool held) { are_objects_held_ = held; }
  bool areObjectsHeld() const { return are_objects_held_; }
  /// Calls `done`, on another thread, when everything reported so far has been written to sockets.
  void whenPublished(const kiva::World& world, std::function<void()> done);
  /// Returns the time by which afterRequests must be called even without a request.
  WallClock::time_point nextDue() const { return next_due_; }

 private:
  void send(Snapshot snapshot, bool reliable = false);
  void addNews(kiva::World& world, Snapshot* out);
  bool isAboutRobot(const kiva::World& world, const kiva::Event& event) const;
  void addStatuses(const kiva::World& world, Snapshot* out) const;
  void addClock(const kiva::World& world, bool reliable, Snapshot* out);
  void addReliableClock(const kiva::World& world, Snapshot* out);
  void addHeartbeats(const kiva::World& world, Snapshot* out);
  void addPeriodic(const kiva::World& world, bool reliable, Snapshot* out);
  void updateSubscribedRobots();
  void addFleet(const kiva::World& world, Snapshot* out) const;
  void addPeople(const kiva::World& world, Snapshot* out);
  void addOdometry(const kiva::World& world, Snapshot* out) const;
  void addTransforms(const kiva::World& world, Snapshot* out) const;
  void addForNewcomers(const kiva::World& world, Snapshot* out);
  void addScans(const kiva::World& world, Snapshot* out) const;
  void addModelStates(const kiva::World& world, Snapshot* out);
  void addLinkStates(const kiva::World& world, Snapshot* out);
  void addObjects(const kiva::World& world, Snapshot* out, bool at_once = false);

  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  const Rates rates_;
  SubscriberCounts& subscribers_;
  PublishQueue& publish_queue_;
  SnapshotQueue& snapshots_;
  WallClock::duration clock_gap_{0};  ///< Minimum wall time between two /clock messages.
  std::uint64_t clock_every_, models_every_, fleet_every_, robots_every_, heartbeat_every_,
      hash_every_;  // steps

  std::uint32_t timeline_ = 1;
  bool people_were_there_ = false;           ///< Whether the last People message had any.
  std::uint64_t clock_sent_steps_ = kNever;  ///< At the last reliable clock.
  WallClock::time_point clock_sent_;
  std::uint64_t last_steps_ = kNever;
  std::vector<kiva::Event> extra_events_;  ///< Events that the world does not report itself.
  std::set<std::string> robots_;           ///< Names of the robots last reported.
  std::shared_ptr<const std::vector<std::string>> names_;  ///< All models',
  std::uint64_t names_revision_ = kNever;                  ///< at that revision.
  std::shared_ptr<const std::vector<std::string>> link_names_;
  std::uint64_t link_names_revision_ = kNever;

  static constexpr int kHeartbeatSlots = 10;  ///< Each robot has one, which spreads the load.
  std::array<WallClock::time_point, kHeartbeatSlots> heartbeat_sent_;
  std::vector<int> status_ids_, scan_ids_, odometry_ids_;  ///< Robots with subscribers,
  std::uint64_t subscribed_revision_ = kNever;             ///< at that revision of their counts.

  std::uint64_t objects_revision_ = kNever, units_revision_ = kNever;  ///< Last sent.
  bool are_objects_held_ = false;
  WallClock::time_point objects_sent_, next_due_;
};

}  // namespace kiva_ros
