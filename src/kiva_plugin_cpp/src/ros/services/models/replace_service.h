// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/ReplaceModels.h>

#include <functional>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world_file.h"
#include "ros/services/base/command_service.h"
#include "ros/services/base/progress.h"
#include "ros/services/models/model_sources.h"
#include "ros/services/models/replacement.h"
#include "ros/simulation/simulation_thread.h"
#include "ros/transport/heap_trim.h"

namespace kiva_ros {

/// Serves ~replace_models: replaces a whole warehouse in one request.
///
/// Built model by model or batch by batch by a client, each batch makes the world publish all
/// objects so far, and each node read them: for 200,000 models that was nine tenths of the CPU
/// time. Here objects are published once, at the end. The step thread is free between two batches,
/// for other requests. A call takes long: `node` is that of a thread of its own, the one which
/// parses other models.
class ReplaceService {
 public:
  ReplaceService(ros::NodeHandle& node, SimulationThread& simulation, kiva::ModelPaths model_paths,
                 ModelSources& sources);

 private:
  using Request = warehouse_msgs::ReplaceModels::Request;
  using Response = warehouse_msgs::ReplaceModels::Response;
  using Documents = std::vector<ReplacementDocument>;

  /// A call in progress.
  struct Call {
    const Request& request;
    std::function<bool()> is_abandoned;
    Progress progress;
    bool* changed;  ///< Of the response.
  };

  bool replace(ros::ServiceEvent<Request, Response>& event);
  std::string replace(Call& call);
  Documents read(Call& call) const;
  std::vector<std::string> check(const Call& call, const Documents& documents);
  void change(Call& call, const std::vector<std::string>& leaving, const Documents& documents);
  void remove(Call& call, const std::vector<std::string>& leaving);
  void spawn(Call& call, const Documents& documents);
  void undo(const Request& request);

  SimulationThread& simulation_;
  const kiva::ModelPaths model_paths_;
  ModelSources& sources_;
  CallTopic calls_;
  HeapTrim heap_trim_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
