// SPDX-License-Identifier: Apache-2.0
#include "models.h"

#include <algorithm>
#include <cmath>
#include <regex>

#include "../plugins/fleet_plugin.h"
#include "collisions.h"
#include "commands.h"
#include "cruise.h"
#include "engagement.h"
#include "footprint.h"
#include "intervene.h"
#include "joints.h"
#include "load.h"
#include "robots.h"
#include "triangle_outline.h"
#include "user_plugins.h"

namespace kiva {
namespace {

constexpr double kMaxCoordinate = 1e5;  // [m]; beyond, a double grows too coarse for contacts
constexpr double kMaxSpeed = 1e4;       // [m/s, rad/s]; bodies beyond pass through each other
constexpr double kFlat = 0.005;         // [m]; what rises less above the ground is floor

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

void checkInstance(const Parts& parts, const ModelInstance& instance) {
  const std::string& name = instance.name;
  if (name.empty()) throw DescriptionError("a model needs a name");
  if (name.size() > 200) refuse(instance, "a name may have 200 characters at the most");
  if (name.find("::") != std::string::npos) refuse(instance, "'::' can't be part of a name");
  if (parts.find(name)) refuse(instance, "entity already exists");
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

bool isFloor(const ModelDescription& description) {
  if (!description.is_static) return false;
  bool flat = false;
  for (const Link& link : description.links) {
    for (const Collision& collision : link.collisions) {
      if (collision.shape.kind == Shape::Kind::kPlane) return true;
      flat = true;
    }
  }
  return flat && bounds(description).max.Z() <= kFlat;
}

ModelKind classify(const ModelInstance& instance) {
  const ModelDescription& description = *instance.description;
  if (isRobot(description)) return ModelKind::kRobot;
  if (isFloor(description)) return ModelKind::kFloor;
  if (instance.name.rfind("conveyor_belt", 0) == 0) return ModelKind::kBelt;
  if (description.is_static) return ModelKind::kOther;
  if (numberIn(instance.name, "storage_unit")) return ModelKind::kStorageUnit;
  if (numberIn(instance.name, "item")) return ModelKind::kItem;
  return ModelKind::kOther;
}

int takeSlot(Parts& parts, const ModelInstance& instance) {
  int slot = static_cast<int>(parts.models.size());
  if (parts.free_slots.empty()) {
    parts.models.emplace_back();
  } else {
    slot = parts.free_slots.back();
    parts.free_slots.pop_back();
  }
  auto model = std::make_unique<Model>();
  model->name = instance.name;
  model->description = instance.description;
  model->kind = classify(instance);
  model->serial = parts.next_serial++;
  model->spawn_pose = model->pose = instance.pose;
  model->robot_namespace = instance.robot_namespace;
  parts.models[slot] = std::move(model);
  parts.slot_of_name[instance.name] = slot;
  return slot;
}

void freeSlot(Parts& parts, int slot) {
  parts.slot_of_name.erase(parts.models[slot]->name);
  parts.models[slot].reset();
  parts.free_slots.push_back(slot);
}

/// What lies flat on the ground, as the floor of a building does, is in nobody's way.
void addTriangles(Model& model, Outline outline) {
  const Mesh& mesh = *outline.shape.mesh;
  const Pose pose =
      model.pose * model.description->links[outline.link].pose_in_model * outline.pose_in_link;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    outline.triangle = static_cast<int>(i);
    outline.corners = std::make_shared<Triangle>(cornersOf(mesh, outline.triangle, pose));
    const Footprint flat = makeFootprint(*outline.corners);
    if (flat.z_max > kFlat) model.outlines.push_back(outline);
  }
}

/// Bodies that are in Bullet for as long as the model stands.
void addBodies(Parts& parts, int slot) {
  Model& model = *parts.models[slot];
  model.bodies = buildBodies(parts, slot);
  parts.physics.insert(model.bodies);
  model.in_physics = true;
  if (!model.isStatic()) {
    parts.bodies.push_back(slot);
    initJoints(model);
  }
  if (model.kind != ModelKind::kFloor) addOutlines(model);
}

double massOf(const ModelDescription& description) {
  double mass = 0;
  for (const Link& link : description.links) mass += link.mass;
  return mass;
}

void addUnit(Parts& parts, int slot) {
  Model& model = *parts.models[slot];
  StorageUnit unit;
  unit.name = model.name;
  unit.id = numberIn(model.name, "storage_unit");
  unit.model = slot;
  unit.mass = massOf(*model.description);
  model.index = static_cast<int>(parts.units.size());
  parts.units.push_back(unit);
  parts.unit_of_id[unit.id] = model.index;
  addOutlines(model);
  if (!standsUpright(parts, model.index)) letFall(parts, model);
  ++parts.units_revision;
}

void addItem(Parts& parts, int slot) {
  Model& model = *parts.models[slot];
  Item item;
  item.name = model.name;
  item.id = numberIn(model.name, "item");
  item.model = slot;
  item.mass = massOf(*model.description);
  item.unit = unitAt(parts, model.pose.Pos());
  if (item.unit >= 0) item.pose_in_unit = unitPose(parts, item.unit).Inverse() * model.pose;
  item.spawn_pose_in_unit = item.pose_in_unit;
  model.index = static_cast<int>(parts.items.size());
  parts.items.push_back(item);
  if (item.unit >= 0) {
    addMass(parts, item.unit, item.mass);
  } else {
    addBodies(parts, slot);
  }
}

/// The floor is what the floor models cover together.
void measureFloor(Parts& parts) {
  Bounds all;
  parts.floor_friction = 1;
  for (const auto& model : parts.models) {
    if (!model || model->kind != ModelKind::kFloor) continue;
    for (const Link& link : model->description->links) {
      for (const Collision& collision : link.collisions) {
        all.add(bounds(collision.shape, model->pose * link.pose_in_model * collision.pose_in_link));
        parts.floor_friction = collision.friction;
      }
    }
  }
  parts.floor = all.empty() ? Floor() : Floor{all.min.X(), all.max.X(), all.min.Y(), all.max.Y()};
}

void addByKind(Parts& parts, int slot) {
  switch (parts.models[slot]->kind) {
    case ModelKind::kRobot:
      return addRobot(parts, slot);
    case ModelKind::kStorageUnit:
      return addUnit(parts, slot);
    case ModelKind::kItem:
      return addItem(parts, slot);
    case ModelKind::kFloor:
      addBodies(parts, slot);
      return measureFloor(parts);
    default:
      return addBodies(parts, slot);
  }
}

/// Whether a plugin of that file comes with the world and is dealt with elsewhere.
bool isOurs(const Parts& parts, const Model& model, const PluginDescription& plugin) {
  const std::string& where = plugin.parameters.where();
  if (const FleetPlugin* ours = findFleetPlugin(parts, plugin.filename)) {
    if (model.kind == ModelKind::kRobot) return true;
    throw DescriptionError(where + ": " + ours->filename() +
                           " works on a model that has libkiva_motion.so too");
  }
  if (isGridPlugin(plugin.filename)) {
    throw DescriptionError(where + ": libkiva_grid.so is a plugin of a world, not of a model");
  }
  return false;
}

void loadPlugin(Parts& parts, Model& model, const PluginDescription& description,
                const SensorDescription* sensor) {
  if (isOurs(parts, model, description)) return;
  Parameters parameters = description.parameters;
  if (!model.robot_namespace.empty() && !parameters.has("robotNamespace")) {
    parameters.set("robotNamespace", model.robot_namespace);
  }
  if (auto plugin = loadPlugin(parts, model.name, description.filename, parameters, sensor)) {
    model.plugins.push_back(std::move(plugin));
  }
}

void hideOutlines(Parts& parts, Model& model) {
  for (Outline& outline : model.outlines) {
    if (outline.handle >= 0) parts.obstacles.remove(outline.handle);
    outline.handle = -1;
  }
}

void dropOutlines(Parts& parts, Model& model) {
  hideOutlines(parts, model);
  model.outlines.clear();
}

/// Takes entry `index` out of the units; the last one takes its place.
void dropUnit(Parts& parts, int index) {
  const StorageUnit& unit = parts.units[index];
  if (unit.carrier >= 0) unload(parts, unit.carrier);
  parts.unit_of_id.erase(unit.id);
  const int last = static_cast<int>(parts.units.size()) - 1;
  if (index != last) {
    StorageUnit& moved = parts.units[index] = std::move(parts.units[last]);
    parts.unit_of_id[moved.id] = index;
    parts.models[moved.model]->index = index;
    if (moved.carrier >= 0) parts.fleet.unit[moved.carrier] = index;
    for (Item& item : parts.items) {
      if (item.unit == last) item.unit = index;
    }
  }
  for (Robot& robot : parts.fleet.robots) {
    for (Leg& leg : robot.legs) {
      if (leg.unit == index) {
        leg.unit = -1;
      } else if (leg.unit == last) {
        leg.unit = index;
      }
    }
  }
  parts.units.pop_back();
  ++parts.units_revision;
}

void dropItem(Parts& parts, int index) {
  const Item gone = parts.items[index];
  const int last = static_cast<int>(parts.items.size()) - 1;
  if (index != last) {
    parts.items[index] = std::move(parts.items[last]);
    parts.models[parts.items[index].model]->index = index;
  }
  parts.items.pop_back();
  if (gone.unit >= 0) addMass(parts, gone.unit, -gone.mass);
  ++parts.units_revision;
}

/// Slots of the items that lie on a unit.
std::vector<int> itemsOn(const Parts& parts, int unit) {
  std::vector<int> slots;
  for (const Item& item : parts.items) {
    if (item.unit == unit) slots.push_back(item.model);
  }
  return slots;
}

void dropByKind(Parts& parts, int slot) {
  Model& model = *parts.models[slot];
  if (model.index < 0) return;
  if (model.kind == ModelKind::kRobot) removeRobot(parts, model.index);
  if (model.kind == ModelKind::kItem) dropItem(parts, model.index);
  if (model.kind == ModelKind::kStorageUnit) {
    for (int item : itemsOn(parts, model.index)) removeModel(parts, item);
    dropUnit(parts, model.index);
  }
}

void eraseFrom(std::vector<int>& slots, int slot) {
  slots.erase(std::remove(slots.begin(), slots.end(), slot), slots.end());
}

void dismantle(Parts& parts, int slot) {
  Model& model = *parts.models[slot];
  forgetContacts(parts, slot);
  model.plugins.clear();
  forgetInterventions(parts, model.name);
  if (model.in_physics) parts.physics.remove(model.bodies);
  model.in_physics = false;
  for (auto* slots : {&parts.bodies, &parts.engaged, &parts.models_with_plugins}) {
    eraseFrom(*slots, slot);
  }
  dropByKind(parts, slot);
  dropOutlines(parts, model);
  const bool was_floor = model.kind == ModelKind::kFloor;
  freeSlot(parts, slot);
  if (was_floor) measureFloor(parts);
  wakeBodies(parts);  // what sleeps on something falls once that is gone
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
void rebuildBodies(Parts& parts, int slot) {
  Model& model = *parts.models[slot];
  std::vector<EntityState> states;
  for (const LinkBody& link : model.bodies.links) states.push_back(bodyState(link));
  parts.physics.remove(model.bodies);
  model.bodies = buildBodies(parts, slot);
  for (std::size_t i = 0; i < states.size(); ++i) {
    setBodyState(model.bodies.links[i], states[i]);
  }
  parts.physics.insert(model.bodies);
  restoreLimits(model);
}

/// What follows from another mass of something that is no body of its own.
void reweigh(Parts& parts, int slot, double added) {
  Model& model = *parts.models[slot];
  if (model.kind == ModelKind::kRobot) {
    stopCruise(parts.fleet, model.index);
    weighRobot(*model.description, &parts.fleet.robots[model.index]);
    rebuildBody(parts, model.index);
  } else if (model.kind == ModelKind::kStorageUnit) {
    addMass(parts, model.index, added);
    if (!model.in_physics) return;
    const EntityState state = bodyState(model.bodies.links.front());
    disengage(parts, model);
    letFall(parts, model);
    setBodyState(model.bodies.links.front(), state);
  } else if (model.kind == ModelKind::kItem) {
    Item& item = parts.items[model.index];
    item.mass += added;
    if (item.unit >= 0) addMass(parts, item.unit, added);
  }
}

void placeStatic(Parts& parts, Model& model, const Pose& pose) {
  parts.physics.remove(model.bodies);
  const int slot = parts.slot_of_name.at(model.name);
  const LinkBody& any = model.bodies.links.front();
  model.bodies = parts.physics.build(*model.description, pose, slot, any.group, any.mask);
  parts.physics.insert(model.bodies);
}

/// `model::link::collision` of a part. A body of several links' parts knows their names only.
std::string collisionName(const Parts& parts, const btCollisionObject* body, const BodyPart* part) {
  const Model& model = *parts.models[part ? part->model : body->getUserIndex()];
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

void placeUnit(Parts& parts, Model& model, const EntityState& state) {
  const int carrier = parts.units[model.index].carrier;
  if (carrier >= 0) putDown(parts, carrier);
  if (model.in_physics) disengage(parts, model);
  model.pose = state.pose;
  letFall(parts, model);  // one that is moved by hand may float: let Bullet tell
  moveBodies(model, state);
  ++parts.units_revision;
}

void resetUnit(Parts& parts, Model& model) {
  const int carrier = parts.units[model.index].carrier;
  if (carrier >= 0) putDown(parts, carrier);
  if (model.in_physics) disengage(parts, model);
  model.pose = model.spawn_pose;
  if (!standsUpright(parts, model.index)) letFall(parts, model);
  updateOutlines(parts, model);
}

void placeItem(Parts& parts, Model& model, const EntityState& state) {
  Item& item = parts.items[model.index];
  if (item.unit < 0) {
    moveBodies(model, state);
  } else {
    item.pose_in_unit = unitPose(parts, item.unit).Inverse() * state.pose;
  }
  ++parts.units_revision;
}

}  // namespace

void addOutlines(Model& model) {
  const auto& links = model.description->links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    for (const Collision& collision : links[i].collisions) {
      if (collision.shape.kind == Shape::Kind::kPlane) continue;
      const Outline outline{static_cast<int>(i), collision.pose_in_link, collision.shape};
      if (collision.shape.kind == Shape::Kind::kMesh && model.isStatic()) {
        addTriangles(model, outline);
      } else {
        model.outlines.push_back(outline);
      }
    }
  }
}

ModelBodies buildBodies(const Parts& parts, int slot) {
  const Model& model = *parts.models[slot];
  if (canEngage(model)) return buildEngaged(parts, model);
  const bool is_floor = model.kind == ModelKind::kFloor;
  const int group = is_floor ? kFloorGroup : model.isStatic() ? kStaticGroup : kDynamicGroup;
  return parts.physics.build(*model.description, model.isStatic() ? model.pose : model.spawn_pose,
                             slot, group, ~0);
}

void loadPlugins(Parts& parts, Model& model) {
  const auto description = model.description;  // a plugin may give the model another
  for (const PluginDescription& plugin : description->plugins) {
    loadPlugin(parts, model, plugin, nullptr);
  }
  for (const SensorDescription& sensor : description->sensors) {
    for (const PluginDescription& plugin : sensor.plugins) {
      loadPlugin(parts, model, plugin, &sensor);
    }
  }
}

void spawnModel(Parts& parts, const ModelInstance& instance) {
  checkInstance(parts, instance);
  const int slot = takeSlot(parts, instance);
  try {
    addByKind(parts, slot);
    updateOutlines(parts, *parts.models[slot]);
    loadPlugins(parts, *parts.models[slot]);
    if (!parts.models[slot]->plugins.empty()) parts.models_with_plugins.push_back(slot);
  } catch (const DescriptionError&) {
    dismantle(parts, slot);
    throw;
  } catch (const std::exception& error) {
    dismantle(parts, slot);
    refuse(instance, error.what());
  }
  const Model& model = *parts.models[slot];
  if (model.kind == ModelKind::kRobot) parts.setStatus(model.index, Status::kIdle, State::kIdle);
  alarm(parts);
  ++parts.models_revision;
  parts.report(Event::Kind::kSpawned, instance.name, "", "");
}

void removeModel(Parts& parts, int slot) {
  const std::string name = parts.models[slot]->name;
  dismantle(parts, slot);
  ++parts.models_revision;
  parts.report(Event::Kind::kDeleted, name, "", "");
}

void placeModel(Parts& parts, int slot, const EntityState& state) {
  Model& model = *parts.models[slot];
  checkPose(model.name, state.pose);
  checkTwist(model.name, state.twist);
  if (model.kind == ModelKind::kRobot) {
    placeRobot(parts, model.index, state);
  } else if (model.kind == ModelKind::kStorageUnit) {
    placeUnit(parts, model, state);
  } else if (model.kind == ModelKind::kItem) {
    placeItem(parts, model, state);
  } else if (model.isStatic()) {
    placeStatic(parts, model, state.pose);
  } else if (!model.bodies.links.empty()) {
    moveBodies(model, state);
  }
  if (model.isStatic()) model.pose = state.pose;
  if (model.kind == ModelKind::kFloor) measureFloor(parts);
  updateOutlines(parts, model);
  alarm(parts);
  wakeBodies(parts);
}

void placeLink(Parts& parts, int slot, int link, const EntityState& state) {
  Model& model = *parts.models[slot];
  const Pose way = state.pose * linkPose(parts, model, link).Inverse();
  if (!hasFreeBodies(model)) {
    return placeModel(parts, slot, {way * modelState(parts, model).pose, state.twist});
  }
  checkPose(model.name, state.pose);
  checkTwist(model.name, state.twist);
  for (int held : linksHeldTo(*model.description, link)) {
    LinkBody& body = model.bodies.links[held];
    body.place(toBullet(way) * body.linkPose());
    body.body->activate(true);
  }
  setBodyState(model.bodies.links[link], state);
  updateOutlines(parts, model);
  wakeBodies(parts);
  alarm(parts);
}

void reweighLink(Parts& parts, int slot, int link, const Link& like) {
  Model& model = *parts.models[slot];
  auto changed = std::make_shared<ModelDescription>(*model.description);
  Link& to = changed->links[link];
  const double added = like.mass - to.mass;
  to.mass = like.mass;
  to.inertial_pose_in_link = like.inertial_pose_in_link;
  to.principal_moments = like.principal_moments;
  to.gravity = like.gravity;
  const bool has_bodies = hasFreeBodies(model) && model.kind != ModelKind::kStorageUnit;
  model.description = changed;
  if (has_bodies) rebuildBodies(parts, slot);
  if (!model.isStatic()) reweigh(parts, slot, added);
  updateOutlines(parts, model);
}

void letFall(Parts& parts, Model& model) {
  engage(parts, model);
  for (LinkBody& link : model.bodies.links) link.body->forceActivationState(ACTIVE_TAG);
  model.disturbed = true;
}

void alarm(Parts& parts) {
  std::fill(parts.fleet.look_again.begin(), parts.fleet.look_again.end(), 0);
  std::fill(parts.fleet.cruise_until.begin(), parts.fleet.cruise_until.end(), 0);
}

void wakeBodies(Parts& parts) {
  for (int slot : parts.bodies) {
    for (LinkBody& link : parts.models[slot]->bodies.links) link.body->activate();
  }
}

std::vector<ContactPoint> contactsOf(const Parts& parts, int slot) {
  std::vector<ContactPoint> out;
  for (const TouchPoint& touch : parts.physics.touchPoints(slot)) {
    out.push_back({collisionName(parts, touch.body_a, touch.part_a),
                   collisionName(parts, touch.body_b, touch.part_b), touch.point, touch.normal,
                   touch.depth, touch.impulse / parts.dt});
  }
  return out;
}

void resetModel(Parts& parts, int slot) {
  Model& model = *parts.models[slot];
  ++parts.units_revision;
  if (model.kind == ModelKind::kRobot) return resetRobot(parts, model.index);
  if (model.kind == ModelKind::kStorageUnit) return resetUnit(parts, model);
  if (model.kind == ModelKind::kItem && parts.items[model.index].unit >= 0) {
    Item& item = parts.items[model.index];  // it goes where its unit goes
    item.pose_in_unit = item.spawn_pose_in_unit;
    return;
  }
  if (hasFreeBodies(model)) {  // joints too: a model is put together anew
    parts.physics.remove(model.bodies);
    model.bodies = buildBodies(parts, slot);
    parts.physics.insert(model.bodies);
    initJoints(model);
    updateOutlines(parts, model);
    return;
  }
  placeModel(parts, slot, {model.spawn_pose, {}});
}

EntityState modelState(const Parts& parts, const Model& model) {
  if (model.kind == ModelKind::kRobot) {
    return {basePose(parts, model.index), robotTwist(parts.fleet, model.index)};
  }
  if (hasFreeBodies(model)) return canonicalState(model);
  if (model.kind == ModelKind::kItem && model.index >= 0) {
    const int unit = parts.items[model.index].unit;
    const Pose pose = itemPose(parts, model.index);
    const EntityState base = modelState(parts, *parts.models[parts.units[unit].model]);
    return {pose, twistAt(base, pose.Pos())};
  }
  if (model.kind == ModelKind::kStorageUnit) {
    const int carrier = parts.units[model.index].carrier;
    const Pose pose = unitPose(parts, model.index);
    if (carrier < 0) return {pose, {}};
    const EntityState base{basePose(parts, carrier), robotTwist(parts.fleet, carrier)};
    return {pose, twistAt(base, pose.Pos())};
  }
  return {model.pose, {}};
}

Pose linkPose(const Parts& parts, const Model& model, int link) {
  if (hasFreeBodies(model)) return fromBullet(model.bodies.links[link].linkPose());
  if (model.kind == ModelKind::kRobot) return robotLinkPose(parts, model.index, link);
  return modelState(parts, model).pose * model.description->links[link].pose_in_model;
}

std::optional<EntityState> linkState(const Parts& parts, const Model& model,
                                     const std::string& link) {
  const auto& links = model.description->links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name != link) continue;
    if (hasFreeBodies(model)) return bodyState(model.bodies.links[i]);
    const Pose pose = linkPose(parts, model, static_cast<int>(i));
    return EntityState{pose, twistAt(modelState(parts, model), pose.Pos())};
  }
  return std::nullopt;
}

std::vector<int> slotsInOrder(const Parts& parts) {
  std::vector<int> slots;
  for (std::size_t i = 0; i < parts.models.size(); ++i) {
    if (parts.models[i]) slots.push_back(static_cast<int>(i));
  }
  std::sort(slots.begin(), slots.end(),
            [&parts](int a, int b) { return parts.models[a]->serial < parts.models[b]->serial; });
  return slots;
}

namespace {

/// The footprints of one model, of `group`, in world or in the frame whose inverse is given.
void appendFootprints(const Parts& parts, const Model& model, const Pose& to_frame, int group,
                      std::vector<Footprint>* out) {
  const int slot = parts.slot_of_name.at(model.name);
  for (const Outline& outline : model.outlines) {
    const Pose link =
        outline.link < 0 ? basePose(parts, model.index) : linkPose(parts, model, outline.link);
    const Pose pose = to_frame * link * outline.pose_in_link;
    Footprint footprint;
    if (outline.triangle >= 0) {
      *outline.corners = cornersOf(*outline.shape.mesh, outline.triangle, pose);
      footprint = makeFootprint(*outline.corners);
    } else {
      footprint = makeFootprint(outline.shape, pose);
    }
    footprint.model = slot;
    footprint.group = group;
    if (footprint.kind == Footprint::Kind::kOther && model.in_physics) {
      footprint.body = model.bodies.links[std::max(0, outline.link)].body.get();
    }
    out->push_back(footprint);
  }
}

/// A robot and its load move as one.
void updateMover(Parts& parts, int robot) {
  const Pose to_robot = basePose(parts, robot).Inverse();
  std::vector<Footprint> local;
  appendFootprints(parts, parts.modelOf(robot), to_robot, robot, &local);
  const int unit = parts.fleet.unit[robot];
  if (unit >= 0) {
    appendFootprints(parts, *parts.models[parts.units[unit].model], to_robot, robot, &local);
  }
  parts.obstacles.setMover(robot, std::move(local));
}

}  // namespace

int moverOf(const Parts& parts, const Model& model) {
  if (model.kind == ModelKind::kRobot) return model.index;
  return model.kind == ModelKind::kStorageUnit ? parts.units[model.index].carrier : -1;
}

void updateOutlines(Parts& parts, Model& model) {
  const int mover = moverOf(parts, model);
  if (mover >= 0) {
    if (model.kind != ModelKind::kRobot) hideOutlines(parts, model);
    return updateMover(parts, mover);
  }
  std::vector<Footprint> footprints;
  const int slot = parts.slot_of_name.at(model.name);
  const int group = model.kind == ModelKind::kOther ? ownGroup(slot) : -1;
  appendFootprints(parts, model, Pose::Zero, group, &footprints);
  for (std::size_t k = 0; k < footprints.size(); ++k) {
    int& handle = model.outlines[k].handle;
    if (handle < 0) {
      handle = parts.obstacles.add(footprints[k]);
    } else {
      parts.obstacles.update(handle, footprints[k]);
    }
  }
}

}  // namespace kiva
