// SPDX-License-Identifier: Apache-2.0
#include "core/models/models.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include "core/contact/activation.h"
#include "core/contact/collisions.h"
#include "core/contact/external_wrenches.h"
#include "core/contact/joints.h"
#include "core/control/commands.h"
#include "core/geometry/footprint.h"
#include "core/geometry/triangle_footprint.h"
#include "core/models/floors.h"
#include "core/models/load.h"
#include "core/models/robots.h"
#include "core/models/user_plugins.h"
#include "core/motion/cruise.h"
#include "plugins/fleet_plugin.h"

namespace kiva {
namespace {

constexpr double kMaxCoordinate = 1e5;  // [m]; beyond, a double grows too coarse for contacts
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

void checkInstance(const WorldState& world, const ModelInstance& instance) {
  const std::string& name = instance.name;
  if (name.empty()) throw DescriptionError("a model needs a name");
  if (name.size() > 200) refuse(instance, "a name may have 200 characters at the most");
  if (name.find("::") != std::string::npos) refuse(instance, "'::' can't be part of a name");
  if (world.find(name)) refuse(instance, "entity already exists");
  checkPose(name, instance.pose);
}

/// The number behind `prefix`, 0 if the name is not of that form.
int numberIn(const std::string& name, const std::string& prefix) {
  if (name.rfind(prefix, 0) != 0) return 0;
  const std::string digits = name.substr(prefix.size());
  if (digits.empty() || digits.size() > 7 || digits[0] == '0' ||
      digits.find_first_not_of("0123456789") != std::string::npos) {
    return 0;
  }
  return std::stoi(digits);
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

int takeSlot(WorldState& world, const ModelInstance& instance) {
  int slot = static_cast<int>(world.models.size());
  if (world.free_slots.empty()) {
    world.models.emplace_back();
  } else {
    slot = world.free_slots.back();
    world.free_slots.pop_back();
  }
  auto model = std::make_unique<Model>();
  model->name = instance.name;
  model->description = instance.description;
  model->kind = classify(instance);
  model->serial = world.next_serial++;
  model->spawn_pose = model->pose = instance.pose;
  model->robot_namespace = instance.robot_namespace;
  world.models[slot] = std::move(model);
  world.slot_of_name[instance.name] = slot;
  return slot;
}

void freeSlot(WorldState& world, int slot) {
  world.slot_of_name.erase(world.models[slot]->name);
  world.models[slot].reset();
  world.free_slots.push_back(slot);
}

/// What belongs to the floor, in the mesh of a building say, is in nobody's way.
void addTriangles(const Floor& floor, Model& model, CollisionGeometry geometry) {
  const Mesh& mesh = *geometry.shape.mesh;
  const Pose pose =
      model.pose * model.description->links[geometry.link].pose_in_model * geometry.pose_in_link;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    geometry.triangle = static_cast<int>(i);
    geometry.corners = std::make_shared<Triangle>(cornersOf(mesh, geometry.triangle, pose));
    const Footprint flat = makeFootprint(*geometry.corners);
    if (!isLow(floor, flat.z_max)) model.geometries.push_back(geometry);
  }
}

/// In world [m].
double topOf(const Model& model, const CollisionGeometry& geometry) {
  const Pose link = model.pose * model.description->links[geometry.link].pose_in_model;
  return bounds(geometry.shape, link * geometry.pose_in_link).max.Z();
}

/// Bodies that are in Bullet for as long as the model stands.
void addBodies(WorldState& world, int slot) {
  Model& model = *world.models[slot];
  model.bodies = buildBodies(world, slot);
  world.physics.insert(model.bodies);
  model.in_physics = true;
  if (!model.isStatic()) {
    world.bodies.push_back(slot);
    initJoints(model);
  }
  addCollisionGeometry(world, model);
  if (model.isStatic()) measureFloor(world);
}

double massOf(const ModelDescription& description) {
  double mass = 0;
  for (const Link& link : description.links) mass += link.mass;
  return mass;
}

void addUnit(WorldState& world, int slot) {
  Model& model = *world.models[slot];
  StorageUnit unit;
  unit.name = model.name;
  unit.id = numberIn(model.name, "storage_unit");
  unit.model = slot;
  unit.mass = massOf(*model.description);
  raiseToFloor(world, &unit, &model);
  model.index = static_cast<int>(world.units.size());
  world.units.push_back(unit);
  world.unit_of_id[unit.id] = model.index;
  addCollisionGeometry(world, model);
  if (!standsUpright(world, model.index)) letFall(world, model);
  ++world.units_revision;
}

/// The unit that an item lies on. One that was raised onto the floor takes along what would lie on
/// it had the floor been where it was thought to be.
int findUnit(const WorldState& world, Model& item) {
  const Vector3 lift(0, 0, std::max(0.0, world.floor.z));
  const int raised = unitAt(world, item.pose.Pos() + lift);
  if (raised < 0 || world.units[raised].raised == 0) return unitAt(world, item.pose.Pos());
  item.pose.Pos().Z() += world.units[raised].raised;
  return raised;
}

void addItem(WorldState& world, int slot) {
  Model& model = *world.models[slot];
  Item item;
  item.name = model.name;
  item.id = numberIn(model.name, "item");
  item.model = slot;
  item.mass = massOf(*model.description);
  item.unit = findUnit(world, model);
  if (item.unit >= 0) item.pose_in_unit = unitPose(world, item.unit).Inverse() * model.pose;
  item.spawn_pose_in_unit = item.pose_in_unit;
  model.index = static_cast<int>(world.items.size());
  world.items.push_back(item);
  if (item.unit >= 0) {
    addMass(world, item.unit, item.mass);
  } else {
    addBodies(world, slot);
  }
}

void addByKind(WorldState& world, int slot) {
  switch (world.models[slot]->kind) {
    case ModelKind::kRobot:
      return addRobot(world, slot);
    case ModelKind::kStorageUnit:
      return addUnit(world, slot);
    case ModelKind::kItem:
      return addItem(world, slot);
    default:
      return addBodies(world, slot);
  }
}

/// Whether a plugin of that file comes with the world and is dealt with elsewhere.
bool isOurs(const WorldState& world, const Model& model, const PluginDescription& plugin) {
  const std::string& where = plugin.parameters.where();
  if (const FleetPlugin* ours = findFleetPlugin(world, plugin.filename)) {
    if (model.kind == ModelKind::kRobot) return true;
    throw DescriptionError(where + ": " + ours->filename() +
                           " works on a model that has libkiva_motion.so too");
  }
  if (isGridPlugin(plugin.filename)) {
    throw DescriptionError(where + ": libkiva_grid.so is a plugin of a world, not of a model");
  }
  return false;
}

void loadPlugin(WorldState& world, Model& model, const PluginDescription& description,
                const SensorDescription* sensor) {
  if (isOurs(world, model, description)) return;
  Parameters parameters = description.parameters;
  if (!model.robot_namespace.empty() && !parameters.has("robotNamespace")) {
    parameters.set("robotNamespace", model.robot_namespace);
  }
  if (auto plugin = loadPlugin(world, model.name, description.filename, parameters, sensor)) {
    model.plugins.push_back(std::move(plugin));
  }
}

void hideFootprints(WorldState& world, Model& model) {
  for (CollisionGeometry& geometry : model.geometries) {
    if (geometry.handle >= 0) world.obstacles.remove(geometry.handle);
    geometry.handle = -1;
  }
}

void dropFootprints(WorldState& world, Model& model) {
  hideFootprints(world, model);
  model.geometries.clear();
}

/// Takes entry `index` out of the units; the last one takes its place.
void dropUnit(WorldState& world, int index) {
  const StorageUnit& unit = world.units[index];
  if (unit.carrier >= 0) unload(world, unit.carrier);
  world.unit_of_id.erase(unit.id);
  const int last = static_cast<int>(world.units.size()) - 1;
  if (index != last) {
    StorageUnit& moved = world.units[index] = std::move(world.units[last]);
    world.unit_of_id[moved.id] = index;
    world.models[moved.model]->index = index;
    if (moved.carrier >= 0) world.fleet.unit[moved.carrier] = index;
    for (Item& item : world.items) {
      if (item.unit == last) item.unit = index;
    }
  }
  for (Robot& robot : world.fleet.robots) {
    for (MotionSegment& segment : robot.segments) {
      if (segment.unit == index) {
        segment.unit = -1;
      } else if (segment.unit == last) {
        segment.unit = index;
      }
    }
  }
  world.units.pop_back();
  ++world.units_revision;
}

void dropItem(WorldState& world, int index) {
  const Item gone = world.items[index];
  const int last = static_cast<int>(world.items.size()) - 1;
  if (index != last) {
    world.items[index] = std::move(world.items[last]);
    world.models[world.items[index].model]->index = index;
  }
  world.items.pop_back();
  if (gone.unit >= 0) addMass(world, gone.unit, -gone.mass);
  ++world.units_revision;
}

/// Slots of the items that lie on a unit.
std::vector<int> itemsOn(const WorldState& world, int unit) {
  std::vector<int> slots;
  for (const Item& item : world.items) {
    if (item.unit == unit) slots.push_back(item.model);
  }
  return slots;
}

void dropByKind(WorldState& world, int slot) {
  Model& model = *world.models[slot];
  if (model.index < 0) return;
  if (model.kind == ModelKind::kRobot) removeRobot(world, model.index);
  if (model.kind == ModelKind::kItem) dropItem(world, model.index);
  if (model.kind == ModelKind::kStorageUnit) {
    for (int item : itemsOn(world, model.index)) removeModel(world, item);
    dropUnit(world, model.index);
  }
}

void eraseFrom(std::vector<int>& slots, int slot) {
  slots.erase(std::remove(slots.begin(), slots.end(), slot), slots.end());
}

void dismantle(WorldState& world, int slot) {
  Model& model = *world.models[slot];
  forgetContacts(world, slot);
  model.plugins.clear();
  forgetExternalInputs(world, model.name);
  if (model.in_physics) world.physics.remove(model.bodies);
  model.in_physics = false;
  for (auto* slots : {&world.bodies, &world.activated, &world.models_with_plugins}) {
    eraseFrom(*slots, slot);
  }
  dropByKind(world, slot);
  dropFootprints(world, model);
  const bool may_be_floor = !model.level_surfaces.empty();
  freeSlot(world, slot);
  if (may_be_floor) measureFloor(world);
  wakeBodies(world);  // what sleeps on something falls once that is gone
}

EntityState bodyState(const LinkBody& link) {
  return {fromBullet(link.linkPose()),
          {fromBullet(link.velocityAtOrigin()), fromBullet(link.body->getAngularVelocity())}};
}

/// State of the model frame, from that of its canonical link.
EntityState canonicalState(const Model& model) {
  EntityState state = bodyState(model.bodies.links.front());
  state.pose = state.pose * model.description->links.front().pose_in_model.Inverse();
  return state;
}

Twist robotTwist(const Fleet& fleet, int i) {
  return {Vector3(fleet.vx[i], fleet.vy[i], 0), Vector3(0, 0, fleet.yaw_rate[i])};
}

/// Twist of a point that moves with something.
Twist twistAt(const EntityState& base, const Vector3& point) {
  return {base.twist.linear + base.twist.angular.Cross(point - base.pose.Pos()),
          base.twist.angular};
}

/// Whether the model's own bodies say where it is.
bool hasFreeBodies(const Model& model) {
  return model.in_physics && !model.isStatic() && !model.bodies.links.empty() &&
         model.kind != ModelKind::kRobot;
}

void setBodyState(LinkBody& link, const EntityState& to) {
  link.place(toBullet(to.pose));
  const Vector3 arm = fromBullet(link.body->getWorldTransform().getOrigin()) - to.pose.Pos();
  link.body->setLinearVelocity(toBullet(to.twist.linear + to.twist.angular.Cross(arm)));
  link.body->setAngularVelocity(toBullet(to.twist.angular));
  link.body->activate(true);
}

void moveBodies(Model& model, const EntityState& to) {
  const btTransform move = toBullet(to.pose) * toBullet(canonicalState(model).pose).inverse();
  for (LinkBody& link : model.bodies.links) {
    link.place(move * link.linkPose());
    const Vector3 arm = fromBullet(link.body->getWorldTransform().getOrigin()) - to.pose.Pos();
    link.body->setLinearVelocity(toBullet(to.twist.linear + to.twist.angular.Cross(arm)));
    link.body->setAngularVelocity(toBullet(to.twist.angular));
    link.body->activate(true);
  }
}

/// Puts the bodies of a model together anew, where and as fast as they are.
void rebuildBodies(WorldState& world, int slot) {
  Model& model = *world.models[slot];
  std::vector<EntityState> states;
  for (const LinkBody& link : model.bodies.links) states.push_back(bodyState(link));
  world.physics.remove(model.bodies);
  model.bodies = buildBodies(world, slot);
  for (std::size_t i = 0; i < states.size(); ++i) {
    setBodyState(model.bodies.links[i], states[i]);
  }
  world.physics.insert(model.bodies);
  restoreLimits(model);
}

/// What follows from another mass of something that is no body of its own.
void reweigh(WorldState& world, int slot, double added) {
  Model& model = *world.models[slot];
  if (model.kind == ModelKind::kRobot) {
    stopCruise(world.fleet, model.index);
    weighRobot(*model.description, &world.fleet.robots[model.index]);
    rebuildBody(world, model.index);
  } else if (model.kind == ModelKind::kStorageUnit) {
    addMass(world, model.index, added);
    if (!model.in_physics) return;
    const EntityState state = bodyState(model.bodies.links.front());
    deactivate(world, model);
    letFall(world, model);
    setBodyState(model.bodies.links.front(), state);
  } else if (model.kind == ModelKind::kItem) {
    Item& item = world.items[model.index];
    item.mass += added;
    if (item.unit >= 0) addMass(world, item.unit, added);
  }
}

void placeStatic(WorldState& world, Model& model, const Pose& pose) {
  world.physics.remove(model.bodies);
  model.pose = pose;
  model.bodies = buildStatic(world, world.slot_of_name.at(model.name));
  world.physics.insert(model.bodies);
  refitGeometry(world, model);
  measureFloor(world);
}

/// `model::link::collision` of a part. A body of several links' parts knows their names only.
std::string collisionName(const WorldState& world, const btCollisionObject* body,
                          const BodyPart* part) {
  const Model& model = *world.models[part ? part->model : body->getUserIndex()];
  const auto& links = model.description->links;
  const std::string name = part ? part->collision : "";
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool own = hasFreeBodies(model) || model.isStatic();
    const bool is_body =
        own && i < model.bodies.links.size() && model.bodies.links[i].body.get() == body;
    const bool has = std::any_of(links[i].collisions.begin(), links[i].collisions.end(),
                                 [&](const Collision& c) { return c.name == name; });
    if (own ? is_body : has) return model.name + "::" + links[i].name + "::" + name;
  }
  return model.name + "::" + (links.empty() ? "" : links.front().name) + "::" + name;
}

void placeUnit(WorldState& world, Model& model, const EntityState& state) {
  const int carrier = world.units[model.index].carrier;
  if (carrier >= 0) putDown(world, carrier);
  if (model.in_physics) deactivate(world, model);
  model.pose = state.pose;
  letFall(world, model);  // one that is moved by hand may float: let Bullet tell
  moveBodies(model, state);
  ++world.units_revision;
}

void resetUnit(WorldState& world, Model& model) {
  const int carrier = world.units[model.index].carrier;
  if (carrier >= 0) putDown(world, carrier);
  if (model.in_physics) deactivate(world, model);
  model.pose = model.spawn_pose;
  if (!standsUpright(world, model.index)) letFall(world, model);
  updateFootprints(world, model);
}

void placeItem(WorldState& world, Model& model, const EntityState& state) {
  Item& item = world.items[model.index];
  if (item.unit < 0) {
    moveBodies(model, state);
  } else {
    item.pose_in_unit = unitPose(world, item.unit).Inverse() * state.pose;
  }
  ++world.units_revision;
}

}  // namespace

void refitGeometry(WorldState& world, Model& model) {
  dropFootprints(world, model);
  addCollisionGeometry(world, model);
  updateFootprints(world, model);
}

void addCollisionGeometry(const WorldState& world, Model& model) {
  const auto& links = model.description->links;
  if (model.isStatic()) model.level_surfaces = levelSurfaces(*model.description, model.pose);
  for (std::size_t i = 0; i < links.size(); ++i) {
    for (const Collision& collision : links[i].collisions) {
      if (collision.shape.kind == Shape::Kind::kPlane) continue;
      const CollisionGeometry geometry{static_cast<int>(i), collision.pose_in_link,
                                       collision.shape};
      if (collision.shape.kind == Shape::Kind::kMesh && model.isStatic()) {
        addTriangles(world.floor, model, geometry);
      } else if (!model.isStatic() || !isLow(world.floor, topOf(model, geometry))) {
        model.geometries.push_back(geometry);
      }
    }
  }
}

ModelBodies buildBodies(const WorldState& world, int slot) {
  const Model& model = *world.models[slot];
  if (canActivate(model)) return buildActivated(world, model);
  if (model.isStatic()) return buildStatic(world, slot);
  return world.physics.build(*model.description, model.spawn_pose, slot, kDynamicGroup, ~0);
}

void loadPlugins(WorldState& world, Model& model) {
  const auto description = model.description;  // a plugin may give the model another
  for (const PluginDescription& plugin : description->plugins) {
    loadPlugin(world, model, plugin, nullptr);
  }
  for (const SensorDescription& sensor : description->sensors) {
    for (const PluginDescription& plugin : sensor.plugins) {
      loadPlugin(world, model, plugin, &sensor);
    }
  }
}

void spawnModel(WorldState& world, const ModelInstance& instance) {
  checkInstance(world, instance);
  const int slot = takeSlot(world, instance);
  try {
    addByKind(world, slot);
    updateFootprints(world, *world.models[slot]);
    loadPlugins(world, *world.models[slot]);
    if (!world.models[slot]->plugins.empty()) world.models_with_plugins.push_back(slot);
  } catch (const DescriptionError&) {
    dismantle(world, slot);
    throw;
  } catch (const std::exception& error) {
    dismantle(world, slot);
    refuse(instance, error.what());
  }
  const Model& model = *world.models[slot];
  if (model.kind == ModelKind::kRobot) world.setStatus(model.index, Status::kIdle, State::kIdle);
  alarm(world);
  ++world.models_revision;
  world.report(Event::Kind::kSpawned, instance.name, "", "");
}

void removeModel(WorldState& world, int slot) {
  const std::string name = world.models[slot]->name;
  dismantle(world, slot);
  ++world.models_revision;
  world.report(Event::Kind::kDeleted, name, "", "");
}

void placeModel(WorldState& world, int slot, const EntityState& state) {
  Model& model = *world.models[slot];
  checkPose(model.name, state.pose);
  checkTwist(model.name, state.twist);
  if (model.kind == ModelKind::kRobot) {
    placeRobot(world, model.index, state);
  } else if (model.kind == ModelKind::kStorageUnit) {
    placeUnit(world, model, state);
  } else if (model.kind == ModelKind::kItem) {
    placeItem(world, model, state);
  } else if (model.isStatic()) {
    placeStatic(world, model, state.pose);
  } else if (!model.bodies.links.empty()) {
    moveBodies(model, state);
  }
  updateFootprints(world, model);
  alarm(world);
  wakeBodies(world);
}

void placeLink(WorldState& world, int slot, int link, const EntityState& state) {
  Model& model = *world.models[slot];
  const Pose way = state.pose * linkPose(world, model, link).Inverse();
  if (!hasFreeBodies(model)) {
    return placeModel(world, slot, {way * modelState(world, model).pose, state.twist});
  }
  checkPose(model.name, state.pose);
  checkTwist(model.name, state.twist);
  for (int held : linksHeldTo(*model.description, link)) {
    LinkBody& body = model.bodies.links[held];
    body.place(toBullet(way) * body.linkPose());
    body.body->activate(true);
  }
  setBodyState(model.bodies.links[link], state);
  updateFootprints(world, model);
  wakeBodies(world);
  alarm(world);
}

void reweighLink(WorldState& world, int slot, int link, const Link& like) {
  Model& model = *world.models[slot];
  auto changed = std::make_shared<ModelDescription>(*model.description);
  Link& to = changed->links[link];
  const double added = like.mass - to.mass;
  to.mass = like.mass;
  to.inertial_pose_in_link = like.inertial_pose_in_link;
  to.principal_moments = like.principal_moments;
  to.gravity = like.gravity;
  const bool has_bodies = hasFreeBodies(model) && model.kind != ModelKind::kStorageUnit;
  model.description = changed;
  if (has_bodies) rebuildBodies(world, slot);
  if (!model.isStatic()) reweigh(world, slot, added);
  updateFootprints(world, model);
}

void letFall(WorldState& world, Model& model) {
  activate(world, model);
  for (LinkBody& link : model.bodies.links) link.body->forceActivationState(ACTIVE_TAG);
  model.disturbed = true;
}

void alarm(WorldState& world) {
  std::fill(world.fleet.look_again.begin(), world.fleet.look_again.end(), 0);
  std::fill(world.fleet.cruise_until.begin(), world.fleet.cruise_until.end(), 0);
}

void wakeBodies(WorldState& world) {
  for (int slot : world.bodies) {
    for (LinkBody& link : world.models[slot]->bodies.links) link.body->activate();
  }
}

std::vector<ContactPoint> contactsOf(const WorldState& world, int slot) {
  std::vector<ContactPoint> out;
  for (const TouchPoint& touch : world.physics.touchPoints(slot)) {
    out.push_back({collisionName(world, touch.body_a, touch.part_a),
                   collisionName(world, touch.body_b, touch.part_b), touch.point, touch.normal,
                   touch.depth, touch.impulse / world.dt});
  }
  return out;
}

void resetModel(WorldState& world, int slot) {
  Model& model = *world.models[slot];
  ++world.units_revision;
  if (model.kind == ModelKind::kRobot) return resetRobot(world, model.index);
  if (model.kind == ModelKind::kStorageUnit) return resetUnit(world, model);
  if (model.kind == ModelKind::kItem && world.items[model.index].unit >= 0) {
    Item& item = world.items[model.index];  // it goes where its unit goes
    item.pose_in_unit = item.spawn_pose_in_unit;
    return;
  }
  if (hasFreeBodies(model)) {  // joints too: a model is put together anew
    world.physics.remove(model.bodies);
    model.bodies = buildBodies(world, slot);
    world.physics.insert(model.bodies);
    initJoints(model);
    updateFootprints(world, model);
    return;
  }
  placeModel(world, slot, {model.spawn_pose, {}});
}

EntityState modelState(const WorldState& world, const Model& model) {
  if (model.kind == ModelKind::kRobot) {
    return {basePose(world, model.index), robotTwist(world.fleet, model.index)};
  }
  if (hasFreeBodies(model)) return canonicalState(model);
  if (model.kind == ModelKind::kItem && model.index >= 0) {
    const int unit = world.items[model.index].unit;
    const Pose pose = itemPose(world, model.index);
    const EntityState base = modelState(world, *world.models[world.units[unit].model]);
    return {pose, twistAt(base, pose.Pos())};
  }
  if (model.kind == ModelKind::kStorageUnit) {
    const int carrier = world.units[model.index].carrier;
    const Pose pose = unitPose(world, model.index);
    if (carrier < 0) return {pose, {}};
    const EntityState base{basePose(world, carrier), robotTwist(world.fleet, carrier)};
    return {pose, twistAt(base, pose.Pos())};
  }
  return {model.pose, {}};
}

Pose linkPose(const WorldState& world, const Model& model, int link) {
  if (hasFreeBodies(model)) return fromBullet(model.bodies.links[link].linkPose());
  if (model.kind == ModelKind::kRobot) return robotLinkPose(world, model.index, link);
  return modelState(world, model).pose * model.description->links[link].pose_in_model;
}

std::optional<EntityState> linkState(const WorldState& world, const Model& model,
                                     const std::string& link) {
  const auto& links = model.description->links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name != link) continue;
    if (hasFreeBodies(model)) return bodyState(model.bodies.links[i]);
    const Pose pose = linkPose(world, model, static_cast<int>(i));
    return EntityState{pose, twistAt(modelState(world, model), pose.Pos())};
  }
  return std::nullopt;
}

std::vector<int> slotsInOrder(const WorldState& world) {
  std::vector<int> slots;
  for (std::size_t i = 0; i < world.models.size(); ++i) {
    if (world.models[i]) slots.push_back(static_cast<int>(i));
  }
  std::sort(slots.begin(), slots.end(),
            [&world](int a, int b) { return world.models[a]->serial < world.models[b]->serial; });
  return slots;
}

namespace {

/// The footprints of one model, of `group`, in world or in the frame whose inverse is given.
void appendFootprints(const WorldState& world, const Model& model, const Pose& to_frame, int group,
                      std::vector<Footprint>* out) {
  const int slot = world.slot_of_name.at(model.name);
  for (const CollisionGeometry& geometry : model.geometries) {
    const Pose link =
        geometry.link < 0 ? basePose(world, model.index) : linkPose(world, model, geometry.link);
    const Pose pose = to_frame * link * geometry.pose_in_link;
    Footprint footprint;
    if (geometry.triangle >= 0) {
      *geometry.corners = cornersOf(*geometry.shape.mesh, geometry.triangle, pose);
      footprint = makeFootprint(*geometry.corners);
    } else {
      footprint = makeFootprint(geometry.shape, pose);
    }
    footprint.model = slot;
    footprint.group = group;
    if (footprint.kind == Footprint::Kind::kOther && model.in_physics) {
      footprint.body = model.bodies.links[std::max(0, geometry.link)].body.get();
    }
    out->push_back(footprint);
  }
}

/// A robot and its load move as one.
void updateMover(WorldState& world, int robot) {
  const Pose to_robot = Pose(0, 0, world.floor.z, 0, 0, 0) * basePose(world, robot).Inverse();
  std::vector<Footprint> local;
  appendFootprints(world, world.modelOf(robot), to_robot, robot, &local);
  const int unit = world.fleet.unit[robot];
  if (unit >= 0) {
    appendFootprints(world, *world.models[world.units[unit].model], to_robot, robot, &local);
  }
  world.obstacles.setMover(robot, std::move(local));
}

}  // namespace

int moverOf(const WorldState& world, const Model& model) {
  if (model.kind == ModelKind::kRobot) return model.index;
  return model.kind == ModelKind::kStorageUnit ? world.units[model.index].carrier : -1;
}

void updateFootprints(WorldState& world, Model& model) {
  const int mover = moverOf(world, model);
  if (mover >= 0) {
    if (model.kind != ModelKind::kRobot) hideFootprints(world, model);
    return updateMover(world, mover);
  }
  std::vector<Footprint> footprints;
  const int slot = world.slot_of_name.at(model.name);
  const int group = model.kind == ModelKind::kOther ? ownGroup(slot) : -1;
  appendFootprints(world, model, Pose::Zero, group, &footprints);
  for (std::size_t k = 0; k < footprints.size(); ++k) {
    int& handle = model.geometries[k].handle;
    if (handle < 0) {
      handle = world.obstacles.add(footprints[k]);
    } else {
      world.obstacles.update(handle, footprints[k]);
    }
  }
}

}  // namespace kiva
