// SPDX-License-Identifier: Apache-2.0
//
// The node /gazebo: a warehouse world behind Gazebo's ROS 1 names.
#include <ros/ros.h>

#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "audience.h"
#include "broadcaster.h"
#include "checkpoints.h"
#include "commands.h"
#include "engine.h"
#include "farewell.h"
#include "gazebo_plugins/table.h"
#include "joint_services.h"
#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"
#include "light_services.h"
#include "link_services.h"
#include "mail.h"
#include "map_service.h"
#include "outbox.h"
#include "performance.h"
#include "physics_services.h"
#include "recorder.h"
#include "replayer.h"
#include "reporter.h"
#include "settings.h"
#include "showcase.h"
#include "simulation_services.h"
#include "sockets.h"
#include "spawn_services.h"
#include "state_services.h"
#include "step_service.h"

namespace {

using namespace kiva_ros;

constexpr int kCallbackThreads = 4;  // each may wait for the step thread

volatile std::sig_atomic_t serving = 0, asked_to_stop = 0;

/// roscpp sees to SIGINT alone, and tells nobody before it takes its connections down.
void onSignal(int) {
  asked_to_stop = 1;
  if (!serving) ros::requestShutdown();
}

void serveUntilStopped() {
  serving = 1;
  while (ros::ok() && !asked_to_stop) ros::WallDuration(0.05).sleep();
}

kiva::WorldDescription load(const Settings& settings) {
  std::vector<std::string> warnings;
  const auto out = kiva::loadWorld(settings.world_file, settings.world_model_paths, &warnings);
  for (const std::string& warning : warnings) ROS_WARN("%s", warning.c_str());
  return out;
}

void announce(const kiva::World& world, const Settings& settings, double rtf) {
  ROS_INFO("World '%s' from %s: %d robots, %zu storage units, %zu items; steps of %g s, %s",
           world.name().c_str(), settings.world_file.c_str(), world.fleet().size(),
           world.storageUnits().size(), world.items().size(), world.stepSize(),
           rtf > 0 ? ("real-time factor " + std::to_string(rtf)).c_str() : "as fast as it goes");
}

int run(ros::NodeHandle& root, ros::NodeHandle& node) {
  widenListenQueues();
  if (!ros::param::has("/use_sim_time")) ros::param::set("/use_sim_time", true);
  Settings settings = readSettings(node);
  const kiva::WorldDescription description = load(settings);
  Mail mail;  // outlives the plugins
  settings.world.plugins = pluginTable(root, mail);
  kiva::World world(description, settings.world);
  std::optional<Replayer> replayer;
  if (!settings.replay.empty()) replayer.emplace(settings.replay).begin(world);
  const double rtf = settings.rtf < 0 ? description.real_time_factor : settings.rtf;

  Audience audience;
  Outbox outbox;
  Reporter reporter(world, settings.rates, rtf, audience, mail, outbox);
  Engine engine(world, reporter, rtf, settings.lockstep);
  audience.onArrival([&engine] { engine.post([](kiva::World&) {}); });
  Broadcaster broadcaster(root, node, audience, outbox);
  std::optional<Commands> commands;
  if (!replayer) commands.emplace(root, engine);  // a replay has its own
  StepService step_service(node, engine);
  SimulationServices simulation_services(node, engine);
  StateServices state_services(root, node, engine);
  LinkServices link_services(node, engine);
  JointServices joint_services(node, engine);
  LightServices light_services(node, engine);
  PhysicsServices physics_services(node, world, engine);
  Performance performance(node, engine);
  Showcase showcase(root, engine);
  SpawnServices spawn_services(node, engine, settings.model_paths);
  MapService map_service(root, engine);
  // A replay takes the checkpoints that were taken when it was recorded, and no others.
  Checkpoints checkpoints(root, engine, replayer ? 0 : settings.autosave);
  engine.add(checkpoints);
  if (replayer) {
    replayer->onKeyframe([&engine](kiva::World& w, const std::string& checkpoint) {
      engine.restoreHere(w, checkpoint);
    });
    engine.add(*replayer);
  }
  std::optional<Recorder> recorder;
  if (!settings.record.empty()) engine.add(recorder.emplace(settings.record));

  announce(world, settings, rtf);
  engine.start();
  ros::AsyncSpinner spinner(kCallbackThreads);
  spinner.start();
  serveUntilStopped();
  spinner.stop();
  engine.stop();
  if (recorder) recorder->finish(world);
  broadcaster.stop();
  if (ros::ok()) withdrawTopics();
  ros::shutdown();
  return engine.failed() ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // that a log file has each line at once
  ros::init(argc, argv, "gazebo", ros::init_options::NoSigintHandler);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, onSignal);
  ros::NodeHandle root, node("~");
  try {
    return run(root, node);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
