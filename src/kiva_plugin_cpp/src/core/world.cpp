// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/world.h"

#include <algorithm>
#include <cmath>
#include <ignition/math/MassMatrix3.hh>
#include <limits>
#include <stdexcept>

#include "../plugins/fleet_plugin.h"
#include "checkpoint.h"
#include "collisions.h"
#include "commands.h"
#include "cruise.h"
#include "engagement.h"
#include "intervene.h"
#include "joints.h"
#include "load.h"
#include "models.h"
#include "parts.h"
#include "sensing.h"
#include "user_plugins.h"

namespace kiva {
namespace {

constexpr double kMostGravity = 1000;                 // [m/s²]
constexpr double kLeastStep = 1e-6;                   // [s]
constexpr double kMostStep = 1;                       // [s]
constexpr double kLeastMass = 1e-6, kMostMass = 1e9;  // [kg]
constexpr double kLeastMoment = 1e-12;                // [kg m²]
constexpr double kMostArm = 1000;                     // [m]

void loadWorldPlugins(Parts& parts, const std::vector<PluginDescription>& plugins) {
  for (const PluginDescription& plugin : plugins) {
    if (isGridPlugin(plugin.filename)) {
      configureGrid(parts, plugin.parameters);
      plugin.parameters.rejectUnread();
    } else if (auto own = loadPlugin(parts, "", plugin.filename, plugin.parameters, nullptr)) {
      parts.world_plugins.push_back(std::move(own));
      parts.world_plugin_descriptions.push_back(plugin);
    }
  }
}

/// Calls every user's plugin. It may add and remove models, its own among them.
template <typename Call>
void forEachUserPlugin(Parts& parts, Call call) {
  for (auto& plugin : parts.world_plugins) call(*plugin);
  const std::vector<int> slots = parts.models_with_plugins;
  for (int slot : slots) {
    if (!parts.models[slot]) continue;
    const auto plugins = parts.models[slot]->plugins;
    for (auto& plugin : plugins) call(*plugin);
  }
}

void afterStep(Parts& parts) {
  for (auto& plugin : parts.fleet_plugins) plugin->afterStep(parts);
  forEachUserPlugin(parts, [&](Plugin& p) { p.afterStep(*parts.world, parts.dt); });
}

/// -1 = none.
int linkIndex(const Model* model, const std::string& name) {
  if (!model) return -1;
  const auto& links = model->description->links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

/// Whatever robots foresaw holds no more.
void beginAnew(Parts& parts) {
  for (int i = 0; i < parts.fleet.size(); ++i) stopCruise(parts.fleet, i);
  alarm(parts);
}

int shelfId(const Parts& parts, int robot) {
  const int unit = parts.fleet.unit[robot];
  return unit < 0 ? 0 : parts.units[unit].id;
}

}  // namespace

World::Parts::Parts(const WorldDescription& description, const WorldOptions& world_options)
    : name(description.name),
      gravity(description.gravity),
      options(world_options),
      dt(description.step_size),
      physics(description.gravity),
      fleet_plugins(makeFleetPlugins()) {}

World::Parts::~Parts() {
  for (auto& model : models) {
    if (model && model->in_physics) physics.remove(model->bodies);
  }
}

void World::Parts::report(Event::Kind kind, const std::string& model, const std::string& other,
                          const std::string& text, const Impact& impact) {
  events.push_back({time(), kind, model, other, text, impact});
}

void World::Parts::warn(const std::string& subject, const std::string& text) {
  if (warned.insert(subject).second) warnings.push_back(text);
}

void World::Parts::setStatus(int robot, Status status, State state) {
  Robot& r = fleet.robots[robot];
  const int shelf = shelfId(*this, robot);
  if (fleet.status[robot] == status && fleet.state[robot] == state && r.reported_shelf == shelf) {
    return;
  }
  fleet.status[robot] = status;
  fleet.state[robot] = state;
  r.reported_shelf = shelf;
  status_changes.push_back(
      {time(), r.id, status, state, shelf, fleet.x[robot], fleet.y[robot], fleet.yaw[robot]});
}

World::World(const WorldDescription& description, const WorldOptions& options)
    : parts_(std::make_unique<Parts>(description, options)) {
  parts_->world = this;
  for (const Light& light : description.lights) setLight(light);
  spawn(description.models);
  loadWorldPlugins(*parts_, description.plugins);
}

World::~World() = default;

void World::step() {
  Parts& parts = *parts_;
  acceptCommands(parts);
  forEachUserPlugin(parts, [&](Plugin& p) { p.beforeStep(*this, parts.dt); });
  intervene(parts);
  updateEngagement(parts);
  for (auto& plugin : parts.fleet_plugins) plugin->beforeStep(parts);
  drive(parts);
  driveJoints(parts);
  parts.physics.step(parts.dt);
  settle(parts);
  readJoints(parts);
  ++parts.steps;
  ++parts.total_steps;
  findDueScans(parts);
  reportCollisions(parts);
  afterStep(parts);
}

double World::time() const { return parts_->time(); }
std::uint64_t World::steps() const { return parts_->steps; }
double World::stepSize() const { return parts_->dt; }
const Vector3& World::gravity() const { return parts_->gravity; }
std::uint64_t World::seed() const { return parts_->options.seed; }
const std::string& World::name() const { return parts_->name; }

void World::setStepSize(double seconds) {
  if (!(seconds >= kLeastStep && seconds <= kMostStep)) {
    throw std::invalid_argument("the step size must be from 1e-6 to 1 s");
  }
  if (seconds == parts_->dt) return;
  parts_->dt_since_time = time();
  parts_->dt_since = parts_->steps;
  parts_->dt = seconds;
  parts_->scan_rounds_revision = ~0ull;  // those were counted in the old steps, as was
  beginAnew(*parts_);                    // when to look around again
}

void World::setGravity(const Vector3& gravity) {
  if (!gravity.IsFinite() || gravity.Length() > kMostGravity) {
    throw std::invalid_argument("gravity must be finite and at most 1000 m/s²");
  }
  if (gravity == parts_->gravity) return;
  parts_->gravity = gravity;
  parts_->physics.setGravity(gravity);
  wakeBodies(*parts_);
  beginAnew(*parts_);
}

void World::reset(bool time_too) {
  Parts& parts = *parts_;
  forgetContacts(parts, -1);
  for (int slot : slotsInOrder(parts)) resetModel(parts, slot);
  parts.interventions.wrenches.clear();
  parts.interventions.efforts.clear();
  if (time_too) {
    parts.steps = parts.dt_since = 0;
    parts.dt_since_time = 0;
  }
  forEachUserPlugin(parts, [&](Plugin& plugin) { plugin.reset(*this); });
}

void World::post(const Command& command) { parts_->commands.push_back(command); }

void World::spawn(const ModelInstance& instance) { spawnModel(*parts_, instance); }

void World::spawn(const std::vector<ModelInstance>& instances) {
  std::size_t done = 0;
  try {
    for (; done < instances.size(); ++done) spawnModel(*parts_, instances[done]);
  } catch (const DescriptionError&) {
    while (done > 0) remove(instances[--done].name);
    throw;
  }
}

bool World::remove(const std::string& model) {
  const auto at = parts_->slot_of_name.find(model);
  if (at == parts_->slot_of_name.end()) return false;
  removeModel(*parts_, at->second);
  return true;
}

bool World::has(const std::string& model) const { return parts_->find(model) != nullptr; }

std::vector<std::string> World::modelNames() const {
  std::vector<std::string> names;
  for (int slot : slotsInOrder(*parts_)) names.push_back(parts_->models[slot]->name);
  return names;
}

ModelKind World::kind(const std::string& model) const {
  const Model* found = parts_->find(model);
  return found ? found->kind : ModelKind::kOther;
}

std::uint64_t World::modelsRevision() const { return parts_->models_revision; }

std::optional<EntityState> World::state(const std::string& model, const std::string& link) const {
  const Model* found = parts_->find(model);
  if (!found) return std::nullopt;
  if (link.empty()) return modelState(*parts_, *found);
  return linkState(*parts_, *found, link);
}

std::shared_ptr<const ModelDescription> World::description(const std::string& model) const {
  const Model* found = parts_->find(model);
  return found ? found->description : nullptr;
}

bool World::setState(const std::string& model, const EntityState& state) {
  const auto at = parts_->slot_of_name.find(model);
  if (at == parts_->slot_of_name.end()) return false;
  placeModel(*parts_, at->second, state);
  return true;
}

void World::states(std::vector<EntityState>* out) const {
  out->clear();
  for (int slot : slotsInOrder(*parts_)) {
    out->push_back(modelState(*parts_, *parts_->models[slot]));
  }
}

bool World::setLinkState(const std::string& model, const std::string& link,
                         const EntityState& state) {
  const int index = linkIndex(parts_->find(model), link);
  if (index < 0) return false;
  placeLink(*parts_, parts_->slot_of_name.at(model), index, state);
  return true;
}

void World::linkStates(std::vector<std::string>* names, std::vector<EntityState>* states) const {
  names->clear();
  states->clear();
  for (int slot : slotsInOrder(*parts_)) {
    const Model& model = *parts_->models[slot];
    for (const Link& link : model.description->links) {
      names->push_back(model.name + "::" + link.name);
      states->push_back(*linkState(*parts_, model, link.name));
    }
  }
}

bool World::setLinkInertia(const std::string& model, const Link& link) {
  const int index = linkIndex(parts_->find(model), link.name);
  if (index < 0) return false;
  const ignition::math::MassMatrix3d inertia(link.mass, link.principal_moments, Vector3::Zero);
  const bool is_usable =
      link.mass >= kLeastMass && link.mass <= kMostMass && link.principal_moments.IsFinite() &&
      link.principal_moments.Min() >= kLeastMoment && link.inertial_pose_in_link.IsFinite() &&
      link.inertial_pose_in_link.Pos().Abs().Max() <= kMostArm;
  if (!is_usable || !inertia.IsValid()) {
    throw std::invalid_argument(
        "no body is like that; expected a mass above 0 kg, principal moments above 0 kg m², none "
        "larger than the sum of the other two, and a centre of mass near the link");
  }
  reweighLink(*parts_, parts_->slot_of_name.at(model), index, link);
  return true;
}

std::optional<JointState> World::joint(const std::string& model, const std::string& joint) const {
  const Model* found = parts_->find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return std::nullopt;
  return jointState(*parts_, *found, index);
}

bool World::setJoint(const std::string& model, const std::string& joint,
                     const JointSettings& settings) {
  Model* found = parts_->find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return false;
  kiva::setJoint(*found, index, settings);
  return true;
}

void World::setJointPositions(const std::string& model,
                              const std::map<std::string, double>& positions) {
  Model* found = parts_->find(model);
  if (!found) throw std::invalid_argument("there is no model '" + model + "'");
  placeJoints(*parts_, *found, positions);
}

const Interventions& World::interventions() const { return parts_->interventions; }

bool World::applyWrench(const std::string& model, const std::string& link, const Vector3& force,
                        const Vector3& torque) {
  const int index = linkIndex(parts_->find(model), link);
  if (index < 0) return false;
  return pushLink(*parts_, parts_->slot_of_name.at(model), index, force, torque);
}

bool World::apply(const Wrench& wrench) {
  const Model* found = parts_->find(wrench.model);
  if (linkIndex(found, wrench.link) < 0 || found->isStatic()) return false;
  parts_->interventions.wrenches.push_back(wrench);
  return true;
}

bool World::apply(const Effort& effort) {
  const Model* found = parts_->find(effort.model);
  if (!found || findJoint(*found, effort.joint) < 0 || found->joints.empty()) return false;
  parts_->interventions.efforts.push_back(effort);
  return true;
}

void World::clearWrenches(const std::string& model, const std::string& link) {
  auto& all = parts_->interventions.wrenches;
  const auto on = [&](const Wrench& w) { return w.model == model && w.link == link; };
  all.erase(std::remove_if(all.begin(), all.end(), on), all.end());
}

void World::clearEfforts(const std::string& model, const std::string& joint) {
  auto& all = parts_->interventions.efforts;
  const auto on = [&](const Effort& e) { return e.model == model && e.joint == joint; };
  all.erase(std::remove_if(all.begin(), all.end(), on), all.end());
}

void World::setLight(const Light& light) { parts_->interventions.lights[light.name] = light; }

bool World::removeLight(const std::string& name) {
  return parts_->interventions.lights.erase(name) > 0;
}

void World::setOde(const OdeSettings& settings) { parts_->interventions.ode = settings; }

const Fleet& World::fleet() const { return parts_->fleet; }
const std::vector<StorageUnit>& World::storageUnits() const { return parts_->units; }
const std::vector<Item>& World::items() const { return parts_->items; }
Pose World::storageUnitPose(int unit) const { return unitPose(*parts_, unit); }
Pose World::itemPose(int item) const { return kiva::itemPose(*parts_, item); }
Pose World::basePose(int robot) const { return kiva::basePose(*parts_, robot); }
std::uint64_t World::unitsRevision() const { return parts_->units_revision; }
const Floor& World::floor() const { return parts_->floor; }
double World::gridSpacing() const { return parts_->grid_spacing; }

void World::scan(int robot, std::vector<float>* ranges) const {
  std::vector<RayHit> hits;
  castScan(*parts_, robot, &hits);
  const double nearest = parts_->fleet.robots[robot].laser.min_range;
  ranges->resize(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    (*ranges)[i] = hits[i].range < nearest ? -std::numeric_limits<float>::infinity()
                                           : static_cast<float>(hits[i].range);
  }
}

const std::vector<int>& World::scansDue() const { return parts_->scans_due; }

double World::rayCast(const Vector3& from, double yaw, double range, const std::string& but) const {
  const Model* passed = parts_->find(but);
  int group = -1;
  if (passed) {
    const bool is_robot = passed->kind == ModelKind::kRobot;
    group = is_robot ? passed->index : ownGroup(parts_->slot_of_name.at(but));
  }
  return parts_->obstacles
      .cast(from.X(), from.Y(), from.Z(), std::cos(yaw), std::sin(yaw), range, group)
      .range;
}

std::vector<ContactPoint> World::contacts(const std::string& model) const {
  const auto at = parts_->slot_of_name.find(model);
  if (at == parts_->slot_of_name.end()) return {};
  return contactsOf(*parts_, at->second);
}

std::string World::checkpoint() { return kiva::checkpoint(*parts_); }
std::uint64_t World::stateHash() const { return kiva::stateHash(*parts_); }

void World::restore(const std::string& checkpoint) {
  Restored next = readCheckpoint(checkpoint);
  const std::vector<PluginState> before = savePlugins(*parts_);
  next.parts->world = this;
  next.parts->options.plugins = parts_->options.plugins;
  next.parts->warned = parts_->warned;
  next.parts->models_revision = parts_->models_revision + 1;
  next.parts->units_revision = parts_->units_revision + 1;
  parts_.swap(next.parts);
  try {
    adoptPlugins(*parts_, *next.parts);
    restorePlugins(*parts_, next.plugins);
  } catch (...) {
    parts_.swap(next.parts);
    restorePlugins(*parts_, before);
    throw;
  }
}

std::vector<Event> World::takeEvents() {
  std::vector<Event> out;
  out.swap(parts_->events);
  return out;
}

std::vector<StatusChange> World::takeStatusChanges() {
  std::vector<StatusChange> out;
  out.swap(parts_->status_changes);
  return out;
}

std::vector<std::string> World::takeWarnings() {
  std::vector<std::string> out;
  out.swap(parts_->warnings);
  return out;
}

}  // namespace kiva
