// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"
#include "ros/publishing/reporter.h"

namespace kiva_ros {

/// The node's private parameters, each checked.
///
///   ~world                   SDF file: its path, or its name in a world folder, with or without
///                            .sdf; empty: an empty floor
///   ~world_paths             folders of worlds, a:b; default: those of package warehouse_layout
///   ~model_paths             folders of models, a:b; default: the same package's. Those that
///                            GAZEBO_MODEL_PATH lists, those that packages export to Gazebo,
///                            those of GAZEBO_RESOURCE_PATH and those around a world file are
///                            searched before them for a world, after them for requests
///   ~rtf                     simulated seconds a wall second; 0: as fast as possible; not set:
///   what
///                            the world file says
///   ~seed                    of everything random, default 1
///   ~drive                   traction or jointed; empty (default): what the robots' files say
///   ~realism                 sections of the real world, each with its numbers, as in a YAML file
///                            (doc/explanation/realism.md); not set: what the robots' files say
///   ~threads                 on which a large fleet is stepped, looks ahead and scans; default 0:
///                            the machine's cores but one. The result is the same
///   ~awaits                  nodes, with blanks between, for which fast time waits at its start, a
///                            minute at most, until each has published on /warehouse/pace; empty
///                            (default): none
///   ~lockstep                true: time advances by ~step alone; default false
///   ~autosave                how many checkpoints to keep for /warehouse/undo, one a simulated
///                            second; default 0: only that before the last reset
///   ~checkpoint_folder       of checkpoints that are files; default: warehouse/checkpoints in
///                            ROS_HOME, or in ~/.ros
///   ~checkpoint_limit        [MB] of checkpoints in memory, of those in that folder, and of those
///                            for undo, each; default 1000
///   ~record                  bag file to write a recording to; empty (default): none
///   ~replay                  recording to run again, in place of ~world; empty (default): none
///   ~replay_stays            false: it ends, with 0, when the recording has been reproduced;
///                            true (default): the world stays for inspection
///   ~pub_clock_frequency     [Hz] of simulated time, default 100; 0: every step
///   ~model_states_frequency  [Hz] of simulated time, default 50; 0: every step
///   ~fleet_rate              [Hz] of simulated time, of /warehouse/fleet; default 10, at most 100
///   ~cmd_vel                 robots that take velocities as soon as they are spawned: names or
///                            numbers with blanks between; empty (default): none
///   ~map_to_odom             true (default): map -> kiva<id>/odom of these robots is published;
///                            false: that is left to a localisation of the user's own
///   ~map_resolution          [m], edge of a cell of /map, 0.01 to 1; default 0.05
struct Settings {
  std::string world_file;
  kiva::ModelPaths model_paths;        ///< For spawn requests; ours come first.
  kiva::ModelPaths world_model_paths;  ///< For the world file; its author's come first.
  std::optional<double> rtf;
  kiva::WorldOptions world;
  std::vector<std::string> awaits;  ///< Full names of nodes.
  bool lockstep = false;
  int autosave = 0;
  std::string checkpoint_folder;
  std::uintmax_t checkpoint_limit = 0;  ///< [bytes]
  std::string record, replay;           ///< Paths, or empty.
  bool replay_stays = true;
  std::vector<int> cmd_vel;  ///< Ids of robots.
  bool map_to_odom = true;
  double map_resolution = 0.05;  ///< [m]
  Reporter::Rates rates;
};

/// Throws std::runtime_error that names the parameter, its value and what was expected.
Settings readSettings(const ros::NodeHandle& node);

}  // namespace kiva_ros
