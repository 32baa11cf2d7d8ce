// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/replace_service.h"

#include <algorithm>
#include <utility>

#include "ros/services/base/service_answer.h"
#include "ros/transport/service_caller.h"

namespace kiva_ros {
namespace {

constexpr std::size_t kBatch = 500;  // models that are taken away between two looks at the caller

/// Keeps the messages of all objects back for as long as it lives.
class Hold {
 public:
  explicit Hold(SimulationThread& simulation) : simulation_(simulation) {
    simulation_.run([&simulation](kiva::World&) { simulation.holdObjects(true); });
  }
  ~Hold() {
    simulation_.post([&simulation = simulation_](kiva::World&) { simulation.holdObjects(false); });
  }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

 private:
  SimulationThread& simulation_;
};

constexpr std::size_t kToldNames = 20;

/// Returns a request as it is published: it may hold a whole warehouse.
warehouse_msgs::ReplaceModels::Request toTell(
    const warehouse_msgs::ReplaceModels::Request& request) {
  warehouse_msgs::ReplaceModels::Request summary;
  summary.kinds = request.kinds;
  const std::size_t count = std::min(request.names.size(), kToldNames);
  summary.names.assign(request.names.begin(), request.names.begin() + count);
  if (count < request.names.size()) {
    summary.names.push_back("… and " + std::to_string(request.names.size() - count) + " more");
  }
  for (const std::string& text : request.documents) {
    summary.documents.push_back("SDF of " + std::to_string(text.size()) + " bytes");
  }
  return summary;
}

void checkCaller(const std::function<bool()>& is_abandoned) {
  if (is_abandoned()) throw ServiceRefusal("the client has gone, or the world ends");
}

}  // namespace

ReplaceService::ReplaceService(ros::NodeHandle& node, SimulationThread& simulation,
                               kiva::ModelPaths model_paths, ModelSources& sources)
    : simulation_(simulation),
      model_paths_(std::move(model_paths)),
      sources_(sources),
      calls_(node.resolveName("replace_models")),
      heap_trim_(node),
      server_(node.advertiseService("replace_models", &ReplaceService::replace, this)) {}

bool ReplaceService::replace(ros::ServiceEvent<Request, Response>& event) {
  calls_.tell(event.getCallerName(), toTell(event.getRequest()));
  const ServiceCaller caller(server_.getService(), event.getConnectionHeader());
  Response& response = event.getResponse();
  bool changed = false;
  Call call{event.getRequest(), [&caller] { return caller.isGone() || !ros::ok(); },
            Progress([](const std::string& text) { ROS_INFO("%s", text.c_str()); }), &changed};
  reply(response, [&] { return replace(call); });
  response.changed = changed;
  if (changed) heap_trim_.whenSteady();
  return true;
}

std::string ReplaceService::replace(Call& call) {
  const Documents documents = read(call);
  const std::vector<std::string> leaving = check(call, documents);
  const Hold hold(simulation_);
  try {
    change(call, leaving, documents);
  } catch (const std::exception&) {
    if (*call.changed) undo(call.request);
    throw;
  }
  return std::to_string(leaving.size()) + " models taken away, " +
         std::to_string(modelCount(documents)) + " added";
}

/// Parses off the step thread, since a large document takes longer than a step may.
ReplaceService::Documents ReplaceService::read(Call& call) const {
  const std::vector<std::string>& texts = call.request.documents;
  std::vector<std::string> warnings;
  Documents out;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    checkCaller(call.is_abandoned);
    out.push_back(
        readDocument(texts[i], "documents[" + std::to_string(i) + "]", model_paths_, &warnings));
  }
  for (const std::string& warning : warnings) ROS_WARN("replace_models: %s", warning.c_str());
  return out;
}

std::vector<std::string> ReplaceService::check(const Call& call, const Documents& documents) {
  if (!simulation_.paused()) {
    throw ServiceRefusal("physics runs; pause it first by /gazebo/pause_physics");
  }
  return simulation_.run([&](kiva::World& world) {
    const auto leaving = leavingModels(world, call.request.kinds, call.request.names);
    checkNames(world, leaving, documents);
    return leaving;
  });
}

void ReplaceService::change(Call& call, const std::vector<std::string>& leaving,
                            const Documents& documents) {
  checkCaller(call.is_abandoned);
  *call.changed = true;
  remove(call, leaving);
  spawn(call, documents);
}

void ReplaceService::remove(Call& call, const std::vector<std::string>& leaving) {
  for (std::size_t done = 0; done < leaving.size(); done += kBatch) {
    checkCaller(call.is_abandoned);
    call.progress.at("taken away", done, leaving.size());
    const std::size_t end = std::min(done + kBatch, leaving.size());
    simulation_.run([&](kiva::World& world) {
      // Some may have gone already, with the model that they lay on.
      for (std::size_t i = done; i < end; ++i) world.remove(leaving[i]);
    });
  }
}

void ReplaceService::spawn(Call& call, const Documents& documents) {
  std::size_t done = 0;
  const std::size_t all = modelCount(documents);
  for (const ReplacementDocument& document : documents) {
    checkCaller(call.is_abandoned);
    call.progress.at("built", done, all);
    simulation_.run([&](kiva::World& world) {
      world.spawn(document.models);
      sources_.note(world, *document.text, document.models, document.written);
    });
    done += document.models.size();
  }
}

/// Takes away all models of the request's kinds.
void ReplaceService::undo(const Request& request) {
  simulation_.run([&](kiva::World& world) {
    for (const std::string& name : leavingModels(world, request.kinds, {})) world.remove(name);
  });
}

}  // namespace kiva_ros
