// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/source_service.h"

#include <map>

#include "ros/messages/convert.h"
#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

using Response = warehouse_msgs::WorldSources::Response;

void describe(const kiva::World& world, const ModelSources& sources, Response* response) {
  std::map<const std::string*, int> indices;
  const auto indexOf = [&](const std::shared_ptr<const std::string>& text) {
    const auto [at, is_new] = indices.try_emplace(text.get(), response->documents.size());
    if (is_new) response->documents.push_back(*text);
    return at->second;
  };
  indexOf(sources.worldText());
  response->world_file = sources.worldFile();
  for (const std::string& name : world.modelNames()) {
    const ModelSource* const source = sources.find(name);
    const kiva::Pose pose = world.state(name)->pose;
    response->models.push_back(name);
    response->document.push_back(source ? indexOf(source->text) : -1);
    response->original.push_back(source ? source->written.name : "");
    response->written.push_back(toMessage(source ? source->written.pose : pose));
    response->pose.push_back(toMessage(pose));
  }
}

}  // namespace

SourceService::SourceService(ros::NodeHandle& root, SimulationThread& simulation,
                             const ModelSources& sources)
    : simulation_(simulation),
      sources_(sources),
      server_(root.advertiseService("warehouse/sources", &SourceService::get, this)) {}

bool SourceService::get(warehouse_msgs::WorldSources::Request&, Response& response) {
  return reply(response, [&] {
    simulation_.run([&](kiva::World& world) { describe(world, sources_, &response); });
    return std::to_string(response.models.size()) + " models from " +
           std::to_string(response.documents.size()) + " texts";
  });
}

}  // namespace kiva_ros
