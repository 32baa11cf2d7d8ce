// SPDX-License-Identifier: Apache-2.0
#include "core/models/models.h"

#include <algorithm>
#include <cmath>

#include "core/contact/collisions.h"
#include "core/contact/external_wrenches.h"
#include "core/models/items.h"
#include "core/models/robots.h"
#include "core/models/storage_units.h"
#include "core/models/user_plugins.h"
#include "core/motion/dynamics.h"
#include "core/motion/joints/joints.h"
#include "core/motion/wheels/ground.h"
#include "core/state/people/people.h"
#include "core/state/places/floors.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/progress/tasks.h"
#include "core/state/views/fleet_plugin.h"

namespace kiva {
namespace {

constexpr double kMaxCoordinate = 1e5;  // [m]; beyond, doubles are too coarse for contacts
constexpr double kMaxSpeed = 1e4;       // [m/s, rad/s]; bodies beyond pass through each other

[[noreturn]] void refuse(const ModelInstance& instance, const std::string& why) {
  throw DescriptionError("model '" + instance.name + "': " + why);
}

void checkPose(const std::string& name, const Pose& pose) {
  if (pose.IsFinite() && pose.Pos().Abs().Max() <= kMaxCoordinate) return;
  throw DescriptionError("model '" + name +
                         "': its pose must be finite and within 100 km of the origin");
}

void checkTwist(const std::string& name, const Twist& twist) {
  const bool is_finite = twist.linear.IsFinite() && twist.angular.IsFinite();
  if (is_finite && std::max(twist.linear.Length(), twist.angular.Length()) <= kMaxSpeed) return;
  throw DescriptionError("model '" + name +
                         "': its velocity must be finite and at most 10 km/s and 10,000 rad/s");
}

void checkInstance(const ModelTable& models, const ModelInstance& instance) {
  const std::string& name = instance.name;
  if (name.empty()) throw DescriptionError("a model needs a name");
  if (name.size() > 200) refuse(instance, "a name may have up to 200 characters");
  if (name.find("::") != std::string::npos) refuse(instance, "'::' can't be part of a name");
  if (models.find(name)) refuse(instance, "entity already exists");
  checkPose(name, instance.pose);
}

ModelKind classify(const ModelInstance& instance) {
  const ModelDescription& description = *instance.description;
  if (isRobot(description)) return ModelKind::kRobot;
  if (isFloor(instance)) return ModelKind::kFloor;
  if (instance.name.rfind("conveyor_belt", 0) == 0) return ModelKind::kBelt;
  if (description.is_static) return ModelKind::kOther;
  if (numberIn(instance.name, "storage_unit")) return ModelKind::kStorageUnit;
  if (numberIn(instance.name, "item")) return ModelKind::kItem;
  return ModelKind::kOther;
}

Model& addModel(ModelTable& models, const ModelInstance& instance) {
  auto model = std::make_unique<Model>();
  model->name = instance.name;
  model->description = instance.description;
  model->kind = classify(instance);
  model->owner = &ownerOf(model->kind);
  model->spawn_pose = model->pose = instance.pose;
  model->robot_namespace = instance.robot_namespace;
  return models.add(std::move(model));
}

/// Returns whether a plugin of that file comes with the world and is loaded elsewhere.
bool isOurs(const Plugins& plugins, const Model& model, const PluginDescription& plugin) {
  const std::string& where = plugin.parameters.where();
  if (const FleetPlugin* ours = findFleetPlugin(plugins, plugin.filename)) {
    if (isRobot(*model.description)) return true;
    throw DescriptionError(where + ": " + ours->filename() +
                           " works on a model that has libkiva_motion.so too");
  }
  if (plugin.filename == kGridPlugin || plugin.filename == kLightCurtainPlugin ||
      plugin.filename == kFloorPatchPlugin) {
    throw DescriptionError(where + ": " + plugin.filename +
                           " is a plugin of a world, not of a model");
  }
  return false;
}

void loadPlugin(TaskView& world, Model& model, const PluginDescription& description,
                const SensorDescription* sensor) {
  if (isOurs(world.plugins, model, description)) return;
  Parameters parameters = description.parameters;
  if (!model.robot_namespace.empty() && !parameters.has("robotNamespace")) {
    parameters.set("robotNamespace", model.robot_namespace);
  }
  if (auto plugin = loadPlugin(world, model.name, description.filename, parameters, sensor)) {
    model.plugins.push_back(std::move(plugin));
  }
}

void dismantle(ModelView& world, Model& model) {
  forgetContacts(world, world.contact_log, world.log, model.slot);
  model.plugins.clear();
  forgetExternalInputs(world.external_inputs, model.name);
  world.people.forget(model.slot);
  forgetFallen(world.fallen, model.slot);
  if (model.in_physics) world.physics.remove(model.bodies);
  model.in_physics = false;
  for (auto* slots : {&world.models.activated, &world.models.with_plugins}) {
    slots->erase(std::remove(slots->begin(), slots->end(), model.slot), slots->end());
  }
  model.owner->remove(world, model);
  hideFootprints(world.obstacles, model);
  world.models.remove(model.slot);
  wakeBodies(world.models);  // sleeping bodies on top of it fall once it is gone
}

void loadAllPlugins(ContactView& world, Model& model) {
  loadPlugins(world, model);
  if (!model.plugins.empty()) world.models.with_plugins.push_back(model.slot);
}

/// Updates all that depends on a model's place.
void placed(MotionView& world, Model& model) {
  moved(world, model);
  invalidateClearance(world.fleet);
  wakeBodies(world.models);
}

/// Returns `model::link::collision` of a part. A body with parts of several links only has their
/// names.
std::string collisionName(const ModelTable& models, const btCollisionObject* body,
                          const BodyPart* part) {
  const Model& model = *models[part ? part->model : body->getUserIndex()];
  const auto& links = model.description->links;
  const std::string name = part ? part->collision : "";
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool own = model.owner->followsBodies(model) || model.isStatic();
    const bool is_body =
        own && i < model.bodies.links.size() && model.bodies.links[i].body.get() == body;
    const bool has = std::any_of(links[i].collisions.begin(), links[i].collisions.end(),
                                 [&](const Collision& c) { return c.name == name; });
    if (own ? is_body : has) return model.name + "::" + links[i].name + "::" + name;
  }
  return model.name + "::" + (links.empty() ? "" : links.front().name) + "::" + name;
}

}  // namespace

const ModelOwner& ownerOf(ModelKind kind) {
  static const Robots robots;
  static const StorageUnits storage_units;
  static const Items items;
  static const ConveyorBelts belts;
  static const Floors floors;
  static const OrdinaryModels others;
  switch (kind) {
    case ModelKind::kRobot:
      return robots;
    case ModelKind::kStorageUnit:
      return storage_units;
    case ModelKind::kItem:
      return items;
    case ModelKind::kBelt:
      return belts;
    case ModelKind::kFloor:
      return floors;
    case ModelKind::kOther:
      break;
  }
  return others;
}

void loadPlugins(TaskView& world, Model& model) {
  const auto description = model.description;  // a copy, since a plugin may replace it
  for (const PluginDescription& plugin : description->plugins) {
    loadPlugin(world, model, plugin, nullptr);
  }
  for (const SensorDescription& sensor : description->sensors) {
    for (const PluginDescription& plugin : sensor.plugins) {
      loadPlugin(world, model, plugin, &sensor);
    }
  }
}

void spawnModel(ModelView& world, const ModelInstance& instance) {
  checkInstance(world.models, instance);
  Model& model = addModel(world.models, instance);
  try {
    model.owner->add(world, model);
    moved(world, model);
    loadAllPlugins(world, model);
  } catch (const DescriptionError&) {
    dismantle(world, model);
    throw;
  } catch (const std::exception& error) {
    dismantle(world, model);
    refuse(instance, error.what());
  }
  const int robot = model.owner->robot(world, model);
  if (robot >= 0) setStatus(world, robot, Status::kIdle, State::kIdle);
  invalidateClearance(world.fleet);
  ++world.models.revision;
  world.log.report(Event::Kind::kSpawned, instance.name, "", instance.name + " has come");
}

void removeModel(ModelView& world, int slot) {
  Model& model = *world.models[slot];
  const std::string name = model.name;
  for (int passenger : model.owner->passengers(world, model)) removeModel(world, passenger);
  dismantle(world, model);
  ++world.models.revision;
  world.log.report(Event::Kind::kDeleted, name, "", name + " is gone");
}

void placeModel(ModelView& world, Model& model, const EntityState& state) {
  checkPose(model.name, state.pose);
  checkTwist(model.name, state.twist);
  model.owner->place(world, model, state);
  placed(world, model);
}

void placeLink(ModelView& world, Model& model, int link, const EntityState& state) {
  const Pose way = state.pose * linkPose(world, model, link).Inverse();
  if (!model.owner->followsBodies(model) || model.upright) {
    return placeModel(world, model, {way * modelState(world, model).pose, state.twist});
  }
  checkPose(model.name, state.pose);
  checkTwist(model.name, state.twist);
  for (int held : linksHeldTo(*model.description, link)) {
    LinkBody& body = model.bodies.links[held];
    body.place(toBullet(way) * body.linkPose());
    body.body->activate(true);
  }
  setBodyState(model.bodies.links[link], state);
  placed(world, model);
}

void reweighLink(ContactView& world, Model& model, int link, const Link& like) {
  auto changed = std::make_shared<ModelDescription>(*model.description);
  Link& to = changed->links[link];
  const double added = like.mass - to.mass;
  to.mass = like.mass;
  to.inertial_pose_in_link = like.inertial_pose_in_link;
  to.principal_moments = like.principal_moments;
  to.gravity = like.gravity;
  model.description = changed;
  if (!model.isStatic()) model.owner->reweigh(world, model, added);
  moved(world, model);
}

void resetModel(ModelView& world, Model& model) {
  model.owner->reset(world, model);
  placed(world, model);
}

std::vector<ContactPoint> contactsOf(const Scene& world, int slot) {
  std::vector<ContactPoint> out;
  for (const TouchPoint& touch : world.physics.touchPoints(slot)) {
    out.push_back({collisionName(world.models, touch.body_a, touch.part_a),
                   collisionName(world.models, touch.body_b, touch.part_b), touch.point,
                   touch.normal, touch.depth, touch.impulse / world.clock.dt});
  }
  return out;
}

}  // namespace kiva
