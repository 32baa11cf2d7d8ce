// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/people_services.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

constexpr char kPerson[] =
    R"(<sdf version="1.9"><world name="w"><include><uri>model://person</uri></include></world></sdf>)";

kiva::Walk walkOf(const warehouse_msgs::Person::Request& request) {
  if (request.x.size() != request.y.size()) {
    throw std::invalid_argument(std::to_string(request.x.size()) + " x and " +
                                std::to_string(request.y.size()) +
                                " y: as many of both were expected");
  }
  kiva::Walk walk;
  walk.loops = request.loop;
  for (std::size_t i = 0; i < request.x.size(); ++i) {
    kiva::Waypoint to{request.x[i], request.y[i]};
    if (request.speed != 0) to.speed = request.speed;
    walk.waypoints.push_back(to);
  }
  return walk;
}

/// Adds a person where the walk begins, and removes it again if the walk is refused.
void come(kiva::World& world, kiva::ModelInstance person, const kiva::Walk& walk) {
  if (walk.waypoints.empty()) {
    throw std::invalid_argument("there is no '" + person.name + "', and no place to come to");
  }
  const kiva::Waypoint& first = walk.waypoints.front();
  person.pose = kiva::Pose(first.x, first.y, world.floor().z, 0, 0, 0);
  world.spawn(person);
  try {
    world.walk(person.name, walk);
  } catch (const std::invalid_argument&) {
    world.remove(person.name);
    throw;
  }
}

}  // namespace

PeopleServices::PeopleServices(ros::NodeHandle& root, SimulationThread& simulation,
                               kiva::ModelPaths model_paths)
    : simulation_(simulation),
      model_paths_(std::move(model_paths)),
      person_(serveCommand(root, "warehouse/person", &PeopleServices::walk, this)),
      light_curtain_(
          serveCommand(root, "warehouse/light_curtain", &PeopleServices::setCurtain, this)) {}

bool PeopleServices::walk(const warehouse_msgs::Person::Request& request,
                          warehouse_msgs::Person::Response& response) {
  return reply(response, [&] {
    const kiva::Walk walk = walkOf(request);
    kiva::ModelInstance person =
        kiva::parseModels(kPerson, model_paths_, "/warehouse/person").front();
    person.name = request.name;
    simulation_.change([&](kiva::World& world) {
      if (world.has(person.name)) {
        world.walk(person.name, walk);
      } else {
        come(world, person, walk);
      }
    });
    return std::string();
  });
}

bool PeopleServices::setCurtain(const warehouse_msgs::LightCurtain::Request& request,
                                warehouse_msgs::LightCurtain::Response& response) {
  return reply(response, [&] {
    const kiva::LightCurtain curtain{request.name, request.min_x, request.max_x, request.min_y,
                                     request.max_y};
    const bool is_removal =
        curtain.min_x == 0 && curtain.max_x == 0 && curtain.min_y == 0 && curtain.max_y == 0;
    simulation_.change([&](kiva::World& world) {
      if (!is_removal) return world.setLightCurtain(curtain);
      if (!world.removeLightCurtain(curtain.name)) {
        throw std::invalid_argument("there is no light curtain '" + curtain.name + "'");
      }
    });
    return std::string();
  });
}

}  // namespace kiva_ros
