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

/// On the step thread: samples what is due to be published and queues it for the broadcaster.
///
/// Rates are of simulated time and counted in steps; only the two latched messages of objects and
/// units are throttled by the wall clock, since models come and go while time stands still.
class Reporter {
 public:
  struct Rates {
    double clock = 100;        ///< [Hz], 0 = every step.
    double model_states = 50;  ///< [Hz], 0 = every step.
    double fleet = 10;         ///< [Hz], of FleetState.
  };

  /// `rtf`: the target real-time factor; unpaced, /clock is throttled by the wall clock.
  Reporter(const kiva::World& world, const Rates& rates, double rtf, SubscriberCounts& subscribers,
           PublishQueue& publish_queue, SnapshotQueue& snapshots);
  void retime(double step_size, double rtf);

  /// `reliable`: nothing is dropped because a subscriber is slow.
  void afterStep(kiva::World& world, bool reliable = false);
  /// After requests were served between steps. `moved`: models may stand elsewhere than before.
  void afterRequests(kiva::World& world, bool paused, bool moved);
  /// A command that the world never got.
  void refused(const kiva::World& world, int kiva_id, const std::string& text);
  /// The world is reset, or another one than before: what was decided upon holds no more.
  void beginTimeline();
  /// Counts those, from 1.
  std::uint32_t timeline() const { return timeline_; }
  /// The world is another one than before, whose models were these.
  void restored(const kiva::World& world, const std::vector<std::string>& before);
  /// Calls `done`, on another thread, when all that was reported so far is with the sockets.
  void whenPublished(const kiva::World& world, std::function<void()> done);
  /// When afterRequests should be called even if there was no request.
  WallClock::time_point nextDue() const { return next_due_; }

 private:
  void send(Snapshot snapshot, bool reliable = false);
  void addNews(kiva::World& world, Snapshot* out);
  bool isAboutRobot(const kiva::World& world, const kiva::Event& event) const;
  void addStatuses(const kiva::World& world, Snapshot* out) const;
  void addClock(const kiva::World& world, bool reliable, Snapshot* out);
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
  WallClock::duration clock_gap_{0};  ///< Least wall time between two clocks.
  std::uint64_t clock_every_, models_every_, fleet_every_, robots_every_, heartbeat_every_,
      hash_every_;  // steps

  std::uint32_t timeline_ = 1;
  bool somebody_there_ = false;              ///< When people were told last.
  std::uint64_t clock_sent_steps_ = kNever;  ///< Of the last reliable clock.
  WallClock::time_point clock_sent_;
  std::uint64_t last_steps_ = kNever;
  std::vector<kiva::Event> extra_events_;                  ///< That are none of the world's.
  std::set<std::string> robots_;                           ///< Names of those last told.
  std::shared_ptr<const std::vector<std::string>> names_;  ///< All models',
  std::uint64_t names_revision_ = kNever;                  ///< at that revision.
  std::shared_ptr<const std::vector<std::string>> link_names_;
  std::uint64_t link_names_revision_ = kNever;

  static constexpr int kHeartbeatSlots = 10;  ///< Each robot has one, so that load is level.
  std::array<WallClock::time_point, kHeartbeatSlots> heartbeat_sent_;
  std::vector<int> status_ids_, scan_ids_, odometry_ids_;  ///< Robots with subscribers,
  std::uint64_t subscribed_revision_ = kNever;             ///< at that revision of their counts.

  std::uint64_t objects_revision_ = kNever, units_revision_ = kNever;  ///< Last sent.
  WallClock::time_point objects_sent_, next_due_;
};

}  // namespace kiva_ros
