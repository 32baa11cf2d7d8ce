// SPDX-License-Identifier: Apache-2.0
//
// The node /gazebo: a warehouse world behind Gazebo's ROS 1 names.
#include <malloc.h>
#include <ros/ros.h>

#include <clocale>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"
#include "ros/gazebo_plugins/base/plugin_inputs.h"
#include "ros/gazebo_plugins/plugin_table.h"
#include "ros/publishing/broadcaster.h"
#include "ros/publishing/reporter.h"
#include "ros/publishing/snapshot_queue.h"
#include "ros/recording/bag_check.h"
#include "ros/recording/recorder.h"
#include "ros/recording/replayer.h"
#include "ros/services/models/joint_services.h"
#include "ros/services/models/light_services.h"
#include "ros/services/models/link_services.h"
#include "ros/services/models/model_sources.h"
#include "ros/services/models/replace_service.h"
#include "ros/services/models/source_service.h"
#include "ros/services/models/spawn_services.h"
#include "ros/services/models/state_services.h"
#include "ros/services/simulation/checkpoint_services.h"
#include "ros/services/simulation/pace_topic.h"
#include "ros/services/simulation/performance_topic.h"
#include "ros/services/simulation/physics_services.h"
#include "ros/services/simulation/simulation_services.h"
#include "ros/services/simulation/step_service.h"
#include "ros/services/warehouse/command_topics.h"
#include "ros/services/warehouse/failure_service.h"
#include "ros/services/warehouse/map_service.h"
#include "ros/services/warehouse/map_topic.h"
#include "ros/services/warehouse/mode_service.h"
#include "ros/services/warehouse/people_services.h"
#include "ros/services/warehouse/pick_up_service.h"
#include "ros/services/warehouse/shadow_topic.h"
#include "ros/services/warehouse/velocity_drive.h"
#include "ros/services/warehouse/visualization_topics.h"
#include "ros/simulation/simulation_thread.h"
#include "ros/transport/callback_thread.h"
#include "ros/transport/publish_queue.h"
#include "ros/transport/server_socket.h"
#include "ros/transport/subscriber_counts.h"
#include "ros/transport/unadvertise.h"
#include "settings.h"

namespace {

using namespace kiva_ros;

constexpr int kCallbackThreads = 4;  // each may block on the step thread

// Number of heaps for all threads. What one thread allocates another one frees: with a heap for
// each thread, memory grew by four fifths while a large warehouse was created again and again.
constexpr int kHeaps = 1;

// Passes before fast time waits for the nodes that it awaits, so that there is a clock [s].
constexpr double kFirstTime = 0.1;

volatile std::sig_atomic_t serving = 0, asked_to_stop = 0;

/// Handles signals. roscpp handles SIGINT alone, and closes its connections abruptly.
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
           rtf > 0 ? ("real-time factor " + std::to_string(rtf)).c_str() : "as fast as possible");
  const kiva::FloorExtent& floor = world.floor();
  if (floor.min_x < floor.max_x) return;
  ROS_WARN(
      "%s has no floor: nothing in it that stands still is level within 10 cm of z = 0, so that "
      "no cell is free; add a model of a plane or a box there",
      settings.world_file.c_str());
}

int run(ros::NodeHandle& root, ros::NodeHandle& node) {
  tuneServerSocket();
  if (!ros::param::has("/use_sim_time")) ros::param::set("/use_sim_time", true);
  Settings settings = readSettings(node);
  const kiva::WorldDescription description = load(settings);
  PublishQueue publish_queue;  // outlives the plugins, like their inputs
  PluginInputs inputs(settings.replay.empty());
  settings.world.plugins = pluginTable(root, publish_queue, inputs);
  kiva::World world(description, settings.world);
  std::optional<Replayer> replayer;
  if (!settings.replay.empty()) replayer.emplace(settings.replay).begin(world);
  const double rtf = settings.rtf.value_or(description.real_time_factor);

  SubscriberCounts subscribers;
  SnapshotQueue snapshots;
  Reporter reporter(world, settings.rates, rtf, subscribers, publish_queue, snapshots);
  SimulationThread simulation(world, reporter, rtf, settings.lockstep);
  subscribers.onSubscribe([&simulation] { simulation.post([](kiva::World&) {}); });
  Broadcaster broadcaster(root, node, subscribers, snapshots, settings.map_to_odom);
  std::optional<CommandTopics> commands;
  if (!replayer) commands.emplace(root, simulation);  // a replay has its own
  ShadowTopic shadows(root, inputs);
  VelocityDrive velocity_drive(root, simulation, reporter, inputs, world,
                               replayer ? std::vector<int>() : settings.cmd_vel);
  CallbackThread stepping(node), spawning(node), saving(root);
  StepService step_service(stepping.node(), simulation);
  SimulationServices simulation_services(node, simulation);
  StateServices state_services(root, node, simulation);
  LinkServices link_services(node, simulation);
  JointServices joint_services(node, simulation);
  LightServices light_services(node, simulation);
  PhysicsServices physics_services(node, world, simulation);
  PaceTopic pace_topic(root, simulation);
  PerformanceTopic performance_topic(node, simulation);
  VisualizationTopics visualization_topics(root, simulation);
  ModelSources sources(settings.world_file, description);
  // Before the spawn services, for which clients wait until the world is up.
  ReplaceService replace_service(spawning.node(), simulation, settings.model_paths, sources);
  SpawnServices spawn_services(spawning.node(), simulation, settings.model_paths, sources);
  SourceService source_service(root, simulation, sources);
  MapService map_service(root, simulation);
  MapTopic map_topic(root, simulation, settings.map_resolution);
  simulation.add(map_topic);
  FailureService failure_service(root, simulation);
  ModeService mode_service(node, simulation);
  PeopleServices people_services(root, simulation, settings.model_paths);
  PickUpService pick_up_service(root, simulation);
  // A replay repeats the checkpoints of its recording, and takes no others.
  CheckpointServices checkpoints(
      saving.node(), simulation,
      {!replayer, settings.autosave, settings.checkpoint_folder, settings.checkpoint_limit});
  simulation.add(checkpoints);
  if (replayer) {
    replayer->onKeyframe([&simulation](kiva::World& w, const std::string& checkpoint) {
      simulation.restoreHere(w, checkpoint);
    });
    replayer->onInput([&inputs](const rosbag::MessageInstance& m) { inputs.replay(m); });
    replayer->onEnd([stays = settings.replay_stays] {
      ROS_INFO("The recording was reproduced; %s",
               stays ? "what stands there now may be looked at, and Ctrl-C ends it" : "it ends");
      if (!stays) asked_to_stop = 1;
    });
    simulation.add(*replayer);
  }
  simulation.add(inputs);
  simulation.add(velocity_drive);
  std::optional<Recorder> recorder;
  if (!settings.record.empty()) {
    simulation.add(recorder.emplace(settings.record));
    inputs.onMessage([&recorder](const std::shared_ptr<const InputTopic>& topic) {
      recorder->onInput([topic](rosbag::Bag& bag, const ros::Time& t) { topic->write(bag, t); });
    });
  }
  simulation.add(shadows);  // follows the recorder, whose keyframes precede its changes

  announce(world, settings, rtf);
  for (const std::string& name : settings.awaits) {
    simulation.awaitNode(name, world.time() + kFirstTime);
  }
  simulation.start();
  ros::AsyncSpinner spinner(kCallbackThreads);
  spinner.start();
  for (CallbackThread* thread : {&stepping, &spawning, &saving}) thread->start();
  serveUntilStopped();
  simulation.stop();  // first, so that no callback waits for it
  spinner.stop();
  if (recorder) recorder->finish(world);
  broadcaster.stop();
  if (ros::ok()) unadvertiseTopics();
  // The last to stop, since they may hold a large document.
  for (CallbackThread* thread : {&stepping, &spawning, &saving}) thread->stop();
  ros::shutdown();
  return simulation.failed() ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  mallopt(M_ARENA_MAX, kHeaps);
  std::setlocale(LC_CTYPE, "C.UTF-8");  // else the log has `?` for each letter that is not ASCII
  setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // so that a log file gets each line at once
  if (argc == 3 && std::string(argv[1]) == kCheckBagOption) return checkBagHere(argv[2]);
  std::vector<char*> arguments = {argv, argv + argc};
  // roscpp's default name is absolute; a world in a namespace has a clock of its own.
  std::string clock = "/clock:=clock";
  arguments.push_back(clock.data());
  argc = static_cast<int>(arguments.size());
  ros::init(argc, arguments.data(), "gazebo", ros::init_options::NoSigintHandler);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, onSignal);
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit fails instead
  ros::NodeHandle root, node("~");
  try {
    return run(root, node);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
