// SPDX-License-Identifier: Apache-2.0
#include "spawn_services.h"

#include <utility>

#include "answer.h"
#include "convert.h"
#include "frames.h"

namespace kiva_ros {
namespace {

/// The frame composes with `initial_pose`, and that with the poses of the document.
void place(const kiva::World& world, const std::string& frame_name, const kiva::Pose& initial_pose,
           std::vector<kiva::ModelInstance>* models) {
  const auto frame = frameState(world, frame_name);
  if (!frame) {
    throw Refusal(
        "SpawnModel: reference reference_frame not found, did you forget to scope the link by "
        "model name?");
  }
  for (kiva::ModelInstance& model : *models) model.pose = frame->pose * initial_pose * model.pose;
}

void checkNames(const kiva::World& world, const std::vector<kiva::ModelInstance>& models) {
  for (const kiva::ModelInstance& model : models) {
    if (!world.has(model.name)) continue;
    const std::string which = models.size() > 1 ? " (" + model.name + ")" : "";
    throw Refusal("SpawnModel: Failure - entity already exists." + which);
  }
}

}  // namespace

SpawnServices::SpawnServices(ros::NodeHandle& node, Engine& engine, kiva::ModelPaths model_paths)
    : engine_(engine), model_paths_(std::move(model_paths)) {
  servers_.push_back(node.advertiseService("spawn_sdf_model", &SpawnServices::spawn, this));
  servers_.push_back(node.advertiseService("delete_model", &SpawnServices::remove, this));
}

bool SpawnServices::spawn(gazebo_msgs::SpawnModel::Request& request,
                          gazebo_msgs::SpawnModel::Response& response) {
  return answer("SpawnModel", response, [&] {
    const kiva::Pose initial_pose = fromMessage(request.initial_pose);
    std::vector<kiva::ModelInstance> models = parse(request);
    engine_.run([&](kiva::World& world) {
      place(world, request.reference_frame, initial_pose, &models);
      checkNames(world, models);
      world.spawn(models);
    });
    return "SpawnModel: Successfully spawned entity";
  });
}

/// Off the step thread, since a large document takes longer than a step may.
std::vector<kiva::ModelInstance> SpawnServices::parse(
    const gazebo_msgs::SpawnModel::Request& request) {
  std::vector<std::string> warnings;
  std::unique_lock<std::mutex> lock(parsing_);
  std::vector<kiva::ModelInstance> models =
      kiva::parseModels(request.model_xml, model_paths_, "model_xml", &warnings);
  lock.unlock();
  for (const std::string& warning : warnings) {
    ROS_WARN("SpawnModel '%s': %s", request.model_name.c_str(), warning.c_str());
  }
  if (models.empty()) throw Refusal("SpawnModel: Failure - model_xml holds no model");
  // One model goes by the name that was asked for; several keep those of their document.
  if (models.size() == 1) models.front().name = request.model_name;
  return models;
}

bool SpawnServices::remove(gazebo_msgs::DeleteModel::Request& request,
                           gazebo_msgs::DeleteModel::Response& response) {
  return answer("DeleteModel", response, [&] {
    const auto remove = [&](kiva::World& world) { return world.remove(request.model_name); };
    if (!engine_.run(remove)) throw Refusal("DeleteModel: model does not exist");
    return "DeleteModel: successfully deleted model";
  });
}

}  // namespace kiva_ros
