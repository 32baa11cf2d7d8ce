// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint/consistency.h"

#include <algorithm>
#include <set>
#include <string>

#include "core/checkpoint/archive.h"
#include "core/checkpoint/describe.h"
#include "core/motion/joints/jointed_body.h"

namespace kiva {
namespace {

constexpr double kMostMass = 1e12;       // [kg]
constexpr double kMostSize = 1e6;        // [m]
constexpr double kMostCoordinate = 1e6;  // [m] of models in the world
constexpr double kMostSpeed = 1e5;       // [m/s, rad/s]

/// Throws ArchiveError at `list`[i].`field` unless it is right.
void require(bool is_right, const char* list, std::size_t i, const char* field, const char* why) {
  if (is_right) return;
  const std::string dot = *field ? "." : "";
  throw ArchiveError(why, list + ("[" + std::to_string(i) + "]") + dot + field);
}

bool isIn(int index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}
bool isInOrNone(int index, std::size_t size) { return index == -1 || isIn(index, size); }

const Model* modelAt(const WorldState& world, int slot) {
  return isIn(slot, world.models.size()) ? world.models[slot] : nullptr;
}

// --- descriptions

bool isUsable(const Mesh& mesh, bool is_static) {
  const auto count = static_cast<int>(mesh.vertices.size());
  const auto exists = [count](int corner) { return corner >= 0 && corner < count; };
  const bool exist = std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
    return std::all_of(t.begin(), t.end(), exists);
  });
  const bool is_small = std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                                    [](const auto& v) { return v.Abs().Max() <= kMostSize; });
  return exist && is_small && (is_static ? !mesh.triangles.empty() : count > 0);
}

bool isUsable(const Shape& shape, bool is_static) {
  const auto fits = [](double length) { return length > 0 && length <= kMostSize; };
  switch (shape.kind) {
    case Shape::Kind::kBox:
    case Shape::Kind::kEllipsoid:
      return fits(shape.size.X()) && fits(shape.size.Y()) && fits(shape.size.Z());
    case Shape::Kind::kSphere:
      return fits(shape.radius);
    case Shape::Kind::kCylinder:
    case Shape::Kind::kCapsule:
      return fits(shape.radius) && fits(shape.length);
    case Shape::Kind::kPlane:
      return std::abs(shape.normal.Length() - 1) < kUnitError;
    case Shape::Kind::kMesh:
      return shape.mesh && isUsable(*shape.mesh, is_static);
  }
  return false;
}

void checkLinks(const ModelDescription& model, std::size_t slot) {
  require(model.is_static || !model.links.empty(), "models", slot, "links", "it has none");
  for (const Link& link : model.links) {
    const bool can_move = link.mass > 0 && link.mass <= kMostMass &&
                          link.principal_moments.Min() > 0 &&
                          link.principal_moments.Max() <= kMostMass;
    require(model.is_static || can_move, "models", slot, "links.mass", "nothing has such a mass");
    for (const Collision& c : link.collisions) {
      require(isUsable(c.shape, model.is_static), "models", slot, "links.collisions.shape",
              "there is no such shape");
      require(c.pose_in_link.Pos().Abs().Max() <= kMostSize, "models", slot,
              "links.collisions.pose_in_link", "too far away");
    }
  }
}

void checkJoints(const ModelDescription& model, std::size_t slot) {
  for (const Joint& joint : model.joints) {
    const bool is_held = joint.parent == "world" || model.findLink(joint.parent);
    require(is_held && model.findLink(joint.child) && joint.parent != joint.child, "models", slot,
            "joints", "one holds no link");
    require(!joint.hasAxis() || std::abs(joint.axis_in_model.Length() - 1) < kUnitError, "models",
            slot, "joints.axis_in_model", "expected a unit vector");
  }
}

// --- models

bool isActivatable(const Model& model) {
  return model.kind == ModelKind::kRobot || model.kind == ModelKind::kStorageUnit;
}

/// Returns whether the entry of that index in the table of its kind is about that model.
bool isListed(const WorldState& world, const Model& model) {
  const auto leads_back = [&](const auto& list) {
    return isIn(model.index, list.size()) && list[model.index].model == model.slot;
  };
  switch (model.kind) {
    case ModelKind::kRobot:
      return leads_back(world.fleet.robots);
    case ModelKind::kStorageUnit:
      return leads_back(world.storage.units);
    case ModelKind::kItem:
      return leads_back(world.storage.items);
    default:
      return model.index == -1;
  }
}

bool mayBeInPhysics(const WorldState& world, const Model& model) {
  switch (model.kind) {
    case ModelKind::kRobot:
      return model.in_physics == (world.fleet.activated[model.index] != 0);
    case ModelKind::kStorageUnit:
      return !model.in_physics || world.storage.units[model.index].carrier < 0;
    case ModelKind::kItem:
      return model.in_physics == (world.storage.items[model.index].unit < 0);
    default:
      return model.in_physics;
  }
}

void checkModel(const WorldState& world, const Model& model, std::size_t slot) {
  const ModelDescription& description = *model.description;
  checkLinks(description, slot);
  checkJoints(description, slot);
  require(!model.name.empty(), "models", slot, "name", "it is empty");
  require(model.serial < world.models.next_serial, "models", slot, "serial", "it has not come yet");
  const bool must_move = isActivatable(model) || model.kind == ModelKind::kItem;
  require(!must_move || !model.isStatic(), "models", slot, "kind", "it can't be static");
  require(isListed(world, model), "models", slot, "index", "it leads to something else");
  require(mayBeInPhysics(world, model), "models", slot, "in_physics", "it can't be");
  const bool may_be_disturbed = model.kind == ModelKind::kStorageUnit && model.in_physics;
  require(!model.disturbed || may_be_disturbed, "models", slot, "disturbed", "it can't be");
  require(!model.upright || (may_be_disturbed && description.links.size() == 1), "models", slot,
          "upright", "it can't be");
  require(model.joints.empty() || model.joints.size() == description.joints.size(), "models", slot,
          "joints", "their number is not that of its description");
  require(model.joints.empty() || (model.in_physics && !isActivatable(model)), "models", slot,
          "joints", "they don't move freely");
  const bool is_near = model.pose.Pos().Abs().Max() <= kMostCoordinate &&
                       model.spawn_pose.Pos().Abs().Max() <= kMostCoordinate;
  require(is_near, "models", slot, "pose", "too far away");
  for (const CollisionGeometry& geometry : model.geometries) {
    const bool has_link = geometry.link == -1 || isIn(geometry.link, description.links.size());
    require(has_link && isUsable(geometry.shape, model.isStatic()), "models", slot, "geometries",
            "no such shape is in it");
  }
}

/// Checks that a list has exactly those slots, each once.
void checkSlots(const std::vector<int>& list, const std::set<int>& slots, const char* name) {
  std::set<int> left = slots;
  for (std::size_t i = 0; i < list.size(); ++i) {
    require(left.erase(list[i]) == 1, name, i, "", "no model there belongs here");
  }
  require(left.empty(), name, list.size(), "", "a model is missing");
}

template <typename Belongs>
std::set<int> slotsOf(const WorldState& world, Belongs belongs) {
  std::set<int> slots;
  for (std::size_t slot = 0; slot < world.models.size(); ++slot) {
    if (belongs(world.models[slot])) slots.insert(static_cast<int>(slot));
  }
  return slots;
}

void checkModels(const WorldState& world, const PhysicsState& physics) {
  std::set<std::string> names;
  std::set<std::uint64_t> serials;
  for (std::size_t slot = 0; slot < world.models.size(); ++slot) {
    const Model* model = world.models[slot];
    if (!model) continue;
    checkModel(world, *model, slot);
    require(names.insert(model->name).second, "models", slot, "name", "there are two of it");
    require(serials.insert(model->serial).second, "models", slot, "serial", "there are two of it");
  }
  const auto is_in = [](const Model* m) { return m && m->in_physics; };
  checkSlots(world.models.free_slots, slotsOf(world, [](const Model* m) { return !m; }),
             "free_slots");
  checkSlots(world.models.activated,
             slotsOf(world, [&](const Model* m) { return is_in(m) && isActivatable(*m); }),
             "activated");
  checkSlots(
      world.models.bodies,
      slotsOf(world,
              [&](const Model* m) { return is_in(m) && !isActivatable(*m) && !m->isStatic(); }),
      "bodies");
  std::vector<int> built;
  for (const ModelInPhysics& model : physics.models) built.push_back(model.slot);
  checkSlots(built, slotsOf(world, is_in), "physics.models");
  std::set<int> once;
  for (std::size_t i = 0; i < world.models.with_plugins.size(); ++i) {
    const int slot = world.models.with_plugins[i];
    require(modelAt(world, slot) && once.insert(slot).second, "models_with_plugins", i, "",
            "there is no such model");
  }
}

// --- the fleet

/// Visits a fleet's fields like an archive and checks that every column has an entry for each
/// robot.
class ColumnCheck {
 public:
  static constexpr bool kReads = false;
  explicit ColumnCheck(std::size_t size) : size_(size) {}

  template <typename... Fields>
  void named(const char* names, Fields&&... fields) {
    int index = 0;
    (checkColumn(nameIn(names, index++), fields), ...);
  }

 private:
  template <typename T>
  void checkColumn(const std::string& name, const Column<T>& column) const {
    if (column.size() == size_) return;
    throw ArchiveError("it has " + std::to_string(column.size()) + " entries for " +
                           std::to_string(size_) + " robots",
                       "fleet." + name);
  }
  template <typename T>
  void checkColumn(const std::string& name, const Column<T> (&columns)[2]) const {
    for (const Column<T>& column : columns) checkColumn(name, column);
  }
  template <typename T>
  void checkColumn(const std::string& name, const Within<T>& column) const {
    checkColumn(name, column.value);
  }
  template <typename T>
  void checkColumn(const std::string& /*name*/, const T& /*table*/) const {}

  std::size_t size_;
};

bool fits(const Task& task, std::size_t units) {
  const MotionSegment* at = task.segment();
  if (task.phase == Phase::kWaiting) {
    return task.follows() && (!at || at->kind == MotionSegment::Kind::kDrive);
  }
  const bool has_none = task.phase == Phase::kIdle || task.isSteered();
  if (has_none != (at == nullptr)) return false;
  for (const MotionSegment& segment : task.segments) {
    if (!isInOrNone(segment.unit, units)) return false;
  }
  if (!at) return true;
  using Kind = MotionSegment::Kind;
  const bool lifts = at->kind == Kind::kRaise || at->kind == Kind::kLower;
  switch (task.phase) {
    case Phase::kTurning:
      return at->kind == Kind::kTurn;
    case Phase::kDriving:
    case Phase::kBraking:
      return at->kind == Kind::kDrive;
    case Phase::kHalting:
      return !lifts;
    case Phase::kLifting:
    case Phase::kAbandoning:
      return lifts;
    default:
      return true;
  }
}

/// Returns whether all indices of a path refer to points of it.
bool fits(const ReleasedPath& path, std::uint32_t reached, std::uint32_t left) {
  if (!path.isUnderWay()) return path.points.empty() && path.limits.empty();
  if (path.isLimited() && path.limits.size() != path.points.size()) return false;
  constexpr std::size_t kMost = 0xffffffffu;
  return path.points.size() < kMost - path.first && path.first <= path.origin &&
         path.first <= left && path.origin <= path.end && path.end < path.released &&
         path.released <= path.size() && left <= reached && path.origin < reached &&
         reached <= path.end + 1;
}

void checkRobot(const WorldState& world, int i) {
  const FleetState& f = world.fleet;
  const Robot& robot = f.robots[i];
  const Task& task = f.tasks[i];
  const Model* model = modelAt(world, robot.model);
  require(model && model->kind == ModelKind::kRobot && model->index == i, "fleet.robots", i,
          "model", "it leads to something else");
  require(model->name == robot.name, "fleet.robots", i, "name", "its model has another");
  require(isIn(robot.id, f.index_of_id.size()) && f.index_of_id[robot.id] == i, "fleet.robots", i,
          "id", "it leads to another robot");
  require(robot.drive.drive != Drive::kJointed || hasDriveWheels(*model->description),
          "fleet.robots", i, "drive", "its model lacks a wheel of the jointed drive");
  const double farthest = std::max(std::abs(f.x[i]), std::abs(f.y[i]));
  require(farthest <= kMostCoordinate, "fleet.x", i, "", "too far away");
  const double fastest = std::max({std::abs(f.vx[i]), std::abs(f.vy[i]), std::abs(f.yaw_rate[i])});
  require(fastest <= kMostSpeed, "fleet.vx", i, "", "too fast");
  require(f.tower[i] >= 0 && f.tower[i] <= 10, "fleet.tower", i, "", "no tower is so high");
  const bool carries = f.unit[i] != -1;
  require(!carries || (isIn(f.unit[i], world.storage.units.size()) &&
                       world.storage.units[f.unit[i]].carrier == i),
          "fleet.unit", i, "", "it is not carried by this robot");
  require(fits(task, world.storage.units.size()), "fleet.tasks", i, "segments",
          "they don't fit its phase");
  require(fits(task.path, f.reached[i], f.left[i]), "fleet.tasks", i, "path",
          "it has no such points");
  for (const Sighting* sighting : {&task.sighting, &task.last_sighting}) {
    require(sighting->model == -1 || modelAt(world, sighting->model), "fleet.tasks", i,
            "sighting.model", "there is no such model");
  }
}

/// Checks that there is a steering for each steered robot.
void checkSteerings(const WorldState& world) {
  const FleetState& f = world.fleet;
  std::set<int> ids;
  for (std::size_t i = 0; i < f.steerings.size(); ++i) {
    const Steering& s = f.steerings[i];
    const int robot = f.find(s.kiva_id);
    const bool fits = robot >= 0 && f.tasks[robot].isSteered() && ids.insert(s.kiva_id).second;
    require(fits, "fleet.steerings", i, "kiva_id", "it leads to a robot that is not steered");
    require(isInOrNone(s.obstacle, world.models.size()), "fleet.steerings", i, "obstacle",
            "there is no such model");
  }
  const auto steered = static_cast<std::size_t>(std::count_if(
      f.tasks.begin(), f.tasks.end(), [](const Task& task) { return task.isSteered(); }));
  require(steered == ids.size(), "fleet.steerings", ids.size(), "", "a steered robot is missing");
}

void checkFleet(WorldState& world) {
  FleetState& f = world.fleet;
  ColumnCheck columns(f.robots.size());
  describe(columns, f);
  require(f.tasks.size() == f.robots.size(), "fleet.tasks", f.tasks.size(), "",
          "there is one for every robot");
  require(f.mode.size() == f.robots.size(), "fleet.mode", f.mode.size(), "",
          "as many as there are robots were expected");
  require(!world.settings.realism.loads.enabled || f.sway.size() == f.robots.size(), "fleet.sway",
          f.sway.size(), "", "there is one for every robot");
  require(f.lag.isNone() || f.command_speed.size() == f.robots.size(), "fleet.command_speed",
          f.command_speed.size(), "", "there is one for every robot");
  require(!world.settings.realism.radio.delaysReports() || f.heard.size() == f.robots.size(),
          "fleet.heard", f.heard.size(), "", "there is one for every robot");
  require(!world.settings.realism.energy.enabled || f.battery.size() == f.robots.size(),
          "fleet.battery", f.battery.size(), "", "there is one for every robot");
  for (const std::size_t size : {f.allowed_speed.size(), f.curtained.size()}) {
    require(size == f.robots.size(), "fleet.allowed_speed", size, "",
            "there is one for every robot");
  }
  require(f.localisation.size() == (f.localises ? f.robots.size() : 0), "fleet.localisation",
          f.localisation.size(), "", "there is one for every robot that has to find out");
  for (int i = 0; i < f.size(); ++i) checkRobot(world, i);
  checkSteerings(world);
  for (std::size_t id = 0; id < f.index_of_id.size(); ++id) {
    const int i = f.index_of_id[id];
    const bool leads_back = isIn(i, f.robots.size()) && f.robots[i].id == static_cast<int>(id);
    require(i == -1 || leads_back, "fleet.index_of_id", id, "", "it leads to another robot");
  }
}

// --- the rest

void checkUnits(const WorldState& world) {
  std::set<int> ids;
  for (std::size_t i = 0; i < world.storage.units.size(); ++i) {
    const StorageUnit& unit = world.storage.units[i];
    const Model* model = modelAt(world, unit.model);
    require(model && model->kind == ModelKind::kStorageUnit && model->index == static_cast<int>(i),
            "units", i, "model", "it leads to something else");
    require(model->name == unit.name, "units", i, "name", "its model has another");
    require(unit.id > 0 && ids.insert(unit.id).second, "units", i, "id", "there are two of it");
    require(unit.mass > 0 && unit.mass <= kMostMass, "units", i, "mass", "nothing has such a mass");
    const FleetState& f = world.fleet;
    const bool is_carried = unit.carrier != -1;
    require(!is_carried || (isIn(unit.carrier, f.robots.size()) &&
                            f.unit[unit.carrier] == static_cast<int>(i)),
            "units", i, "carrier", "that robot does not carry it");
    require(isInOrNone(unit.claimed_by, f.robots.size()), "units", i, "claimed_by",
            "there is no such robot");
    require(unit.pose_on_carrier.Pos().Abs().Max() <= 100, "units", i, "pose_on_carrier",
            "too far away");
  }
  for (std::size_t i = 0; i < world.storage.items.size(); ++i) {
    const Item& item = world.storage.items[i];
    const Model* model = modelAt(world, item.model);
    require(model && model->kind == ModelKind::kItem && model->index == static_cast<int>(i),
            "items", i, "model", "it leads to something else");
    require(isInOrNone(item.unit, world.storage.units.size()), "items", i, "unit",
            "there is no such unit");
    require(item.mass >= 0 && item.mass <= kMostMass, "items", i, "mass",
            "nothing has such a mass");
  }
}

void checkLists(const WorldState& world) {
  for (std::size_t i = 0; i < world.contact_log.touching.size(); ++i) {
    const TouchingPair& pair = world.contact_log.touching[i];
    require(modelAt(world, pair.model_a) && modelAt(world, pair.model_b), "touching", i, "model_a",
            "there is no such model");
  }
  const std::size_t robots = world.fleet.robots.size();
  for (std::size_t i = 0; i < world.scans.due.size(); ++i) {
    require(isIn(world.scans.due[i], robots), "scans_due", i, "", "there is no such robot");
  }
  for (std::size_t i = 0; i < world.failures.defects.size(); ++i) {
    const Defect& defect = world.failures.defects[i];
    const bool is_known = world.fleet.find(defect.kiva_id) >= 0 && bitOf(defect.failure) > 1;
    require(is_known, "failures.defects", i, "", "there is no such robot, or nothing like that");
  }
  for (std::size_t i = 0; i < world.people.walkers.size(); ++i) {
    const Walker& walker = world.people.walkers[i];
    const Model* model = modelAt(world, walker.model);
    require(model && model->isStatic() && model->kind == ModelKind::kOther, "walkers", i, "model",
            "it is not a person");
    require(walker.next <= walker.walk.waypoints.size(), "walkers", i, "next",
            "there is no such waypoint");
  }
  for (std::size_t i = 0; i < world.fallen.items.size(); ++i) {
    const OffShelf& off = world.fallen.items[i];
    const Model* item = modelAt(world, off.item);
    const Model* unit = modelAt(world, off.unit);
    require(item && item->kind == ModelKind::kItem && item->in_physics == off.lies, "off_shelf", i,
            "item", "there is no such item");
    require(unit && unit->kind == ModelKind::kStorageUnit, "off_shelf", i, "unit",
            "there is no such storage unit");
  }
  for (std::size_t i = 0; i < world.scans.sighted.size(); ++i) {
    require(isIn(world.scans.sighted[i], robots), "sighted", i, "", "there is no such robot");
  }
}

void checkMovers(const WorldState& world, const PhysicsState& physics) {
  require(physics.movers.size() == world.fleet.robots.size(), "physics.movers",
          physics.movers.size(), "", "there is one for every robot");
  for (std::size_t i = 0; i < physics.movers.size(); ++i) {
    for (const Footprint& footprint : physics.movers[i]) {
      const bool is_own = modelAt(world, footprint.model) &&
                          footprint.group == static_cast<int>(i) &&
                          footprint.kind != Footprint::Kind::kTriangle;
      require(is_own, "physics.movers", i, "", "it has no such footprint");
    }
  }
}

void checkBodies(const PhysicsState& physics) {
  for (std::size_t i = 0; i < physics.models.size(); ++i) {
    for (const BodyState& body : physics.models[i].links) {
      const auto is_small = [](const btVector3& v, double most) {
        return v.length2() <= most * most;
      };
      const bool fits = is_small(body.pose.getOrigin(), kMostCoordinate) &&
                        is_small(body.predicted_pose.getOrigin(), kMostCoordinate);
      require(fits, "physics.models", i, "links.pose", "too far away");
      const bool is_slow = is_small(body.velocity, kMostSpeed) &&
                           is_small(body.angular_velocity, kMostSpeed) &&
                           is_small(body.predicted_velocity, kMostSpeed) &&
                           is_small(body.predicted_angular_velocity, kMostSpeed);
      require(is_slow, "physics.models", i, "links.velocity", "too fast");
      const btVector3& inertia = body.inverse_inertia;
      require(inertia.x() >= 0 && inertia.y() >= 0 && inertia.z() >= 0, "physics.models", i,
              "links.inverse_inertia", "nothing has such an inertia");
    }
  }
}

}  // namespace

void checkConsistent(const WorldState& world, const PhysicsState& physics) {
  checkFleet(const_cast<WorldState&>(world));  // describing changes nothing
  checkUnits(world);
  checkModels(world, physics);
  checkLists(world);
  checkMovers(world, physics);
  checkBodies(physics);
}

}  // namespace kiva
