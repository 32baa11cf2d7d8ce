// SPDX-License-Identifier: Apache-2.0
#include "showcase.h"

#include <exception>
#include <utility>

#include "convert.h"

namespace kiva_ros {
namespace {

constexpr double kRate = 5;  // [Hz]
constexpr int kQueue = 1;

}  // namespace

Showcase::Showcase(ros::NodeHandle& root, Engine& engine)
    : engine_(engine),
      scenery_topic_(root.advertise<warehouse_msgs::Scenery>(
          "/warehouse/scenery", kQueue,
          [this](const ros::SingleSubscriberPublisher&) { newcomer_ = true; })),
      paths_topic_(root.advertise<warehouse_msgs::FleetPaths>("/warehouse/paths", kQueue)),
      timer_(root.createWallTimer(ros::WallDuration(1 / kRate),
                                  [this](const ros::WallTimerEvent&) { publish(); })) {}

void Showcase::publish() {
  try {
    if (scenery_topic_.getNumSubscribers() > 0) publishScenery();
    if (paths_topic_.getNumSubscribers() > 0) publishPaths();
  } catch (const std::exception&) {  // it is shutting down
  }
}

void Showcase::publishScenery() {
  bool changed = newcomer_.exchange(false);
  engine_.run([this, &changed](const kiva::World& world) {
    const bool others = world.modelsRevision() != models_revision_;
    if (others) scenery_ = sceneryOf(world);
    changed |= others || updatePoses(world, &scenery_);
    models_revision_ = world.modelsRevision();
  });
  if (changed) scenery_topic_.publish(scenery_);
}

void Showcase::publishPaths() {
  paths_topic_.publish(engine_.run([](const kiva::World& world) { return pathsOf(world); }));
}

}  // namespace kiva_ros
