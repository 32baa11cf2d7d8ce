// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/visualization_topics.h"

#include <exception>
#include <utility>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr double kDrawnRate = 5;  // [Hz]
constexpr int kLatestOnly = 1;

}  // namespace

VisualizationTopics::VisualizationTopics(ros::NodeHandle& root, SimulationThread& simulation)
    : simulation_(simulation),
      scenery_topic_(root.advertise<warehouse_msgs::Scenery>(
          "warehouse/scenery", kLatestOnly,
          [this](const ros::SingleSubscriberPublisher&) { newcomer_ = true; })),
      paths_topic_(root.advertise<warehouse_msgs::FleetPaths>("warehouse/paths", kLatestOnly)),
      timer_(root.createWallTimer(ros::WallDuration(1 / kDrawnRate),
                                  [this](const ros::WallTimerEvent&) { publish(); })) {}

void VisualizationTopics::publish() {
  try {
    if (scenery_topic_.getNumSubscribers() > 0) publishScenery();
    if (paths_topic_.getNumSubscribers() > 0) publishPaths();
  } catch (const std::exception&) {  // the node is shutting down
  }
}

void VisualizationTopics::publishScenery() {
  bool changed = newcomer_.exchange(false);
  simulation_.run([this, &changed](const kiva::World& world) {
    if (simulation_.areObjectsHeld()) {
      newcomer_ = newcomer_ || changed;
      changed = false;
      return;
    }
    const bool others = world.modelsRevision() != models_revision_;
    if (others) scenery_ = sceneryOf(world);
    changed |= others || updatePoses(world, &scenery_);
    models_revision_ = world.modelsRevision();
  });
  if (changed) scenery_topic_.publish(scenery_);
}

void VisualizationTopics::publishPaths() {
  paths_topic_.publish(simulation_.run([](const kiva::World& world) { return pathsOf(world); }));
}

}  // namespace kiva_ros
