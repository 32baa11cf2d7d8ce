// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/spawn_services.h"

#include <utility>

#include "ros/messages/convert.h"
#include "ros/messages/reference_frames.h"
#include "ros/services/base/service_answer.h"
#include "ros/services/models/package_uris.h"

namespace kiva_ros {
namespace {

/// Throws ServiceRefusal for a document that is too large; parsing takes many times its size.
void checkBytes(const std::string& xml) {
  constexpr std::size_t kMost = 10'000'000;
  if (xml.size() <= kMost) return;
  throw ServiceRefusal("SpawnModel: Failure - model_xml has " + std::to_string(xml.size()) +
                       " bytes; at most " + std::to_string(kMost) + " are read");
}

/// Places a document's models and lights in world. Its poses are relative to `initial_pose`, which
/// is relative to the frame.
void place(const kiva::World& world, const std::string& frame_name, const kiva::Pose& initial_pose,
           SpawnServices::Document* document) {
  const auto frame = frameState(world, frame_name);
  if (!frame) {
    throw ServiceRefusal(
        "SpawnModel: reference reference_frame not found, did you forget to scope the link by "
        "model name?");
  }
  const kiva::Pose origin = frame->pose * initial_pose;
  for (kiva::ModelInstance& model : document->models) model.pose = origin * model.pose;
  for (kiva::Light& light : document->lights) light.pose = origin * light.pose;
}

bool hasLight(const kiva::World& world, const kiva::Light& light) {
  return world.externalInputs().lights.count(light.name) > 0;
}

void checkNames(const kiva::World& world, const SpawnServices::Document& document) {
  const auto check = [&](const std::string& name, bool is_taken) {
    if (!is_taken) return;
    const bool several = document.models.size() + document.lights.size() > 1;
    const std::string which = several ? " (" + name + ")" : "";
    throw ServiceRefusal("SpawnModel: Failure - entity already exists." + which);
  };
  for (const kiva::ModelInstance& model : document.models) check(model.name, world.has(model.name));
  if (!document.models.empty()) return;  // beside models, an existing light stays unchanged
  for (const kiva::Light& light : document.lights) check(light.name, hasLight(world, light));
}

}  // namespace

SpawnServices::SpawnServices(ros::NodeHandle& node, SimulationThread& simulation,
                             kiva::ModelPaths model_paths, ModelSources& sources)
    : simulation_(simulation), model_paths_(std::move(model_paths)), sources_(sources) {
  using gazebo_msgs::SpawnModel;
  servers_.push_back(
      serveChange<SpawnModel>(node, "spawn_sdf_model", "SpawnModel", [this](auto& request, auto&) {
        checkBytes(request.model_xml);
        return spawn(request, request.model_xml);
      }));
  servers_.push_back(
      serveChange<SpawnModel>(node, "spawn_urdf_model", "SpawnModel", [this](auto& request, auto&) {
        checkBytes(request.model_xml);
        if (!kiva::isUrdf(request.model_xml)) {
          throw ServiceRefusal("SpawnModel: Failure - model format is not URDF.");
        }
        return spawn(request, resolvePackageUris(request.model_xml));
      }));
  servers_.push_back(serveCommand(node, "delete_model", &SpawnServices::remove, this));
}

std::string SpawnServices::spawn(const gazebo_msgs::SpawnModel::Request& request,
                                 const std::string& xml) {
  const kiva::Pose initial_pose = fromMessage(request.initial_pose);
  Document document = parse(request, xml);
  simulation_.run([&](kiva::World& world) {
    place(world, request.reference_frame, initial_pose, &document);
    checkNames(world, document);
    world.spawn(document.models);
    sources_.note(world, xml, document.models, document.written);
    for (const kiva::Light& light : document.lights) {
      if (!hasLight(world, light)) world.setLight(light);
    }
  });
  return "SpawnModel: Successfully spawned entity";
}

/// Parses off the step thread, since a large document takes longer than a step may.
SpawnServices::Document SpawnServices::parse(const gazebo_msgs::SpawnModel::Request& request,
                                             const std::string& xml) {
  std::vector<std::string> warnings;
  Document out;
  std::unique_lock<std::mutex> lock(parsing_);
  out.models = kiva::parseModels(xml, model_paths_, "model_xml", &warnings, &out.lights);
  lock.unlock();
  for (const std::string& warning : warnings) {
    ROS_WARN("SpawnModel '%s': %s", request.model_name.c_str(), warning.c_str());
  }
  for (kiva::ModelInstance& model : out.models) {
    model.robot_namespace = request.robot_namespace;
    out.written.push_back({model.name, model.pose});
  }
  // Models of a world file keep their names.
  if (request.model_name.empty() && xml.find("<world") != std::string::npos) return out;
  // A single model gets the requested name; several keep those of their document.
  if (out.models.size() == 1) {
    out.models.front().name = request.model_name;
  } else if (out.models.empty() && out.lights.size() == 1) {
    out.lights.front().name = request.model_name;
  }
  return out;
}

bool SpawnServices::remove(const gazebo_msgs::DeleteModel::Request& request,
                           gazebo_msgs::DeleteModel::Response& response) {
  return answer("DeleteModel", response, [&] {
    const auto remove = [&](kiva::World& world) { return world.remove(request.model_name); };
    if (!simulation_.run(remove)) throw ServiceRefusal("DeleteModel: model does not exist");
    return "DeleteModel: successfully deleted model";
  });
}

}  // namespace kiva_ros
