// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/world.h"

#include <algorithm>
#include <cmath>
#include <ignition/math/MassMatrix3.hh>
#include <limits>
#include <stdexcept>

#include "core/checkpoint/checkpoint.h"
#include "core/contact/activation.h"
#include "core/contact/collisions.h"
#include "core/contact/external_wrenches.h"
#include "core/contact/joints.h"
#include "core/control/commands.h"
#include "core/models/load.h"
#include "core/models/models.h"
#include "core/models/user_plugins.h"
#include "core/motion/cruise.h"
#include "core/sensing/sensing.h"
#include "core/state/world_state.h"
#include "plugins/fleet_plugin.h"

namespace kiva {
namespace {

constexpr double kMostGravity = 1000;                 // [m/s²]
constexpr double kLeastStep = 1e-6;                   // [s]
constexpr double kMostStep = 1;                       // [s]
constexpr double kLeastMass = 1e-6, kMostMass = 1e9;  // [kg]
constexpr double kLeastMoment = 1e-12;                // [kg m²]
constexpr double kMostArm = 1000;                     // [m]

void loadWorldPlugins(WorldState& world, const std::vector<PluginDescription>& plugins) {
  for (const PluginDescription& plugin : plugins) {
    if (isGridPlugin(plugin.filename)) {
      configureGrid(world, plugin.parameters);
      plugin.parameters.rejectUnread();
    } else if (auto own = loadPlugin(world, "", plugin.filename, plugin.parameters, nullptr)) {
      world.world_plugins.push_back(std::move(own));
      world.world_plugin_descriptions.push_back(plugin);
    }
  }
}

/// Calls every user's plugin. It may add and remove models, its own among them.
template <typename Call>
void forEachUserPlugin(WorldState& world, Call call) {
  for (auto& plugin : world.world_plugins) call(*plugin);
  const std::vector<int> slots = world.models_with_plugins;
  for (int slot : slots) {
    if (!world.models[slot]) continue;
    const auto plugins = world.models[slot]->plugins;
    for (auto& plugin : plugins) call(*plugin);
  }
}

void afterStep(WorldState& world) {
  for (auto& plugin : world.fleet_plugins) plugin->afterStep(world);
  forEachUserPlugin(world, [&](Plugin& p) { p.afterStep(*world.owner, world.dt); });
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
void beginAnew(WorldState& world) {
  for (int i = 0; i < world.fleet.size(); ++i) stopCruise(world.fleet, i);
  alarm(world);
}

int shelfId(const WorldState& world, int robot) {
  const int unit = world.fleet.unit[robot];
  return unit < 0 ? 0 : world.units[unit].id;
}

}  // namespace

WorldState::WorldState(const WorldDescription& description, const WorldOptions& world_options)
    : name(description.name),
      gravity(description.gravity),
      options(world_options),
      dt(description.step_size),
      physics(description.gravity),
      fleet_plugins(makeFleetPlugins()) {}

WorldState::~WorldState() {
  for (auto& model : models) {
    if (model && model->in_physics) physics.remove(model->bodies);
  }
}

void WorldState::report(Event::Kind kind, const std::string& model, const std::string& other,
                        const std::string& text, const Impact& impact) {
  events.push_back({time(), kind, model, other, text, impact});
}

void WorldState::warn(const std::string& subject, const std::string& text) {
  if (warned.insert(subject).second) warnings.push_back(text);
}

void WorldState::setStatus(int robot, Status status, State state) {
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
    : state_(std::make_unique<WorldState>(description, options)) {
  state_->owner = this;
  for (const Light& light : description.lights) setLight(light);
  spawn(description.models);
  loadWorldPlugins(*state_, description.plugins);
}

World::~World() = default;

WorldState& insideOf(World& world) { return *world.state_; }
const WorldState& insideOf(const World& world) { return *world.state_; }

void World::step() {
  WorldState& world = *state_;
  acceptCommands(world);
  forEachUserPlugin(world, [&](Plugin& p) { p.beforeStep(*this, world.dt); });
  applyExternalWrenches(world);
  updateActivation(world);
  for (auto& plugin : world.fleet_plugins) plugin->beforeStep(world);
  drive(world);
  driveJoints(world);
  world.physics.step(world.dt);
  settle(world);
  readJoints(world);
  ++world.steps;
  ++world.total_steps;
  findDueScans(world);
  reportCollisions(world);
  afterStep(world);
}

double World::time() const { return state_->time(); }
std::uint64_t World::steps() const { return state_->steps; }
double World::stepSize() const { return state_->dt; }
const Vector3& World::gravity() const { return state_->gravity; }
std::uint64_t World::seed() const { return state_->options.seed; }
const std::string& World::name() const { return state_->name; }

void World::setStepSize(double seconds) {
  if (!(seconds >= kLeastStep && seconds <= kMostStep)) {
    throw std::invalid_argument("the step size must be from 1e-6 to 1 s");
  }
  if (seconds == state_->dt) return;
  state_->dt_since_time = time();
  state_->dt_since = state_->steps;
  state_->dt = seconds;
  state_->scan_rounds_revision = ~0ull;  // those were counted in the old steps, as was
  beginAnew(*state_);                    // when to look around again
}

void World::setGravity(const Vector3& gravity) {
  if (!gravity.IsFinite() || gravity.Length() > kMostGravity) {
    throw std::invalid_argument("gravity must be finite and at most 1000 m/s²");
  }
  if (gravity == state_->gravity) return;
  state_->gravity = gravity;
  state_->physics.setGravity(gravity);
  wakeBodies(*state_);
  beginAnew(*state_);
}

void World::reset(bool time_too) {
  WorldState& world = *state_;
  forgetContacts(world, -1);
  for (int slot : slotsInOrder(world)) resetModel(world, slot);
  world.external_inputs.wrenches.clear();
  world.external_inputs.efforts.clear();
  if (time_too) {
    world.steps = world.dt_since = 0;
    world.dt_since_time = 0;
  }
  forEachUserPlugin(world, [&](Plugin& plugin) { plugin.reset(*this); });
}

void World::post(const Command& command) { state_->commands.push_back(command); }

void World::spawn(const ModelInstance& instance) { spawnModel(*state_, instance); }

void World::spawn(const std::vector<ModelInstance>& instances) {
  std::size_t done = 0;
  try {
    for (; done < instances.size(); ++done) spawnModel(*state_, instances[done]);
  } catch (const DescriptionError&) {
    while (done > 0) remove(instances[--done].name);
    throw;
  }
}

bool World::remove(const std::string& model) {
  const auto at = state_->slot_of_name.find(model);
  if (at == state_->slot_of_name.end()) return false;
  removeModel(*state_, at->second);
  return true;
}

bool World::has(const std::string& model) const { return state_->find(model) != nullptr; }

std::vector<std::string> World::modelNames() const {
  std::vector<std::string> names;
  for (int slot : slotsInOrder(*state_)) names.push_back(state_->models[slot]->name);
  return names;
}

ModelKind World::kind(const std::string& model) const {
  const Model* found = state_->find(model);
  return found ? found->kind : ModelKind::kOther;
}

std::uint64_t World::modelsRevision() const { return state_->models_revision; }

std::optional<EntityState> World::state(const std::string& model, const std::string& link) const {
  const Model* found = state_->find(model);
  if (!found) return std::nullopt;
  if (link.empty()) return modelState(*state_, *found);
  return linkState(*state_, *found, link);
}

std::shared_ptr<const ModelDescription> World::description(const std::string& model) const {
  const Model* found = state_->find(model);
  return found ? found->description : nullptr;
}

bool World::setState(const std::string& model, const EntityState& state) {
  const auto at = state_->slot_of_name.find(model);
  if (at == state_->slot_of_name.end()) return false;
  placeModel(*state_, at->second, state);
  return true;
}

void World::states(std::vector<EntityState>* out) const {
  out->clear();
  for (int slot : slotsInOrder(*state_)) {
    out->push_back(modelState(*state_, *state_->models[slot]));
  }
}

bool World::setLinkState(const std::string& model, const std::string& link,
                         const EntityState& state) {
  const int index = linkIndex(state_->find(model), link);
  if (index < 0) return false;
  placeLink(*state_, state_->slot_of_name.at(model), index, state);
  return true;
}

void World::linkStates(std::vector<std::string>* names, std::vector<EntityState>* states) const {
  names->clear();
  states->clear();
  for (int slot : slotsInOrder(*state_)) {
    const Model& model = *state_->models[slot];
    for (const Link& link : model.description->links) {
      names->push_back(model.name + "::" + link.name);
      states->push_back(*linkState(*state_, model, link.name));
    }
  }
}

bool World::setLinkInertia(const std::string& model, const Link& link) {
  const int index = linkIndex(state_->find(model), link.name);
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
  reweighLink(*state_, state_->slot_of_name.at(model), index, link);
  return true;
}

std::optional<JointState> World::joint(const std::string& model, const std::string& joint) const {
  const Model* found = state_->find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return std::nullopt;
  return jointState(*state_, *found, index);
}

bool World::setJoint(const std::string& model, const std::string& joint,
                     const JointSettings& settings) {
  Model* found = state_->find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return false;
  kiva::setJoint(*found, index, settings);
  return true;
}

void World::setJointPositions(const std::string& model,
                              const std::map<std::string, double>& positions) {
  Model* found = state_->find(model);
  if (!found) throw std::invalid_argument("there is no model '" + model + "'");
  placeJoints(*state_, *found, positions);
}

const ExternalInputs& World::externalInputs() const { return state_->external_inputs; }

bool World::applyWrench(const std::string& model, const std::string& link, const Vector3& force,
                        const Vector3& torque) {
  const int index = linkIndex(state_->find(model), link);
  if (index < 0) return false;
  return pushLink(*state_, state_->slot_of_name.at(model), index, force, torque);
}

bool World::apply(const Wrench& wrench) {
  const Model* found = state_->find(wrench.model);
  if (linkIndex(found, wrench.link) < 0 || found->isStatic()) return false;
  state_->external_inputs.wrenches.push_back(wrench);
  return true;
}

bool World::apply(const Effort& effort) {
  const Model* found = state_->find(effort.model);
  if (!found || findJoint(*found, effort.joint) < 0 || found->joints.empty()) return false;
  state_->external_inputs.efforts.push_back(effort);
  return true;
}

void World::clearWrenches(const std::string& model, const std::string& link) {
  auto& all = state_->external_inputs.wrenches;
  const auto on = [&](const Wrench& w) { return w.model == model && w.link == link; };
  all.erase(std::remove_if(all.begin(), all.end(), on), all.end());
}

void World::clearEfforts(const std::string& model, const std::string& joint) {
  auto& all = state_->external_inputs.efforts;
  const auto on = [&](const Effort& e) { return e.model == model && e.joint == joint; };
  all.erase(std::remove_if(all.begin(), all.end(), on), all.end());
}

void World::setLight(const Light& light) { state_->external_inputs.lights[light.name] = light; }

bool World::removeLight(const std::string& name) {
  return state_->external_inputs.lights.erase(name) > 0;
}

void World::setOde(const OdeSettings& settings) { state_->external_inputs.ode = settings; }

const Fleet& World::fleet() const { return state_->fleet; }
const std::vector<StorageUnit>& World::storageUnits() const { return state_->units; }
const std::vector<Item>& World::items() const { return state_->items; }
Pose World::storageUnitPose(int unit) const { return unitPose(*state_, unit); }
Pose World::itemPose(int item) const { return kiva::itemPose(*state_, item); }
Pose World::basePose(int robot) const { return kiva::basePose(*state_, robot); }
std::uint64_t World::unitsRevision() const { return state_->units_revision; }
const Floor& World::floor() const { return state_->floor; }
double World::gridSpacing() const { return state_->grid_spacing; }

void World::scan(int robot, std::vector<float>* ranges) const {
  std::vector<RayHit> hits;
  castScan(*state_, robot, &hits);
  const double nearest = state_->fleet.robots[robot].laser.min_range;
  ranges->resize(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    (*ranges)[i] = hits[i].range < nearest ? -std::numeric_limits<float>::infinity()
                                           : static_cast<float>(hits[i].range);
  }
}

const std::vector<int>& World::scansDue() const { return state_->scans_due; }

double World::rayCast(const Vector3& from, double yaw, double range, const std::string& but) const {
  const Model* passed = state_->find(but);
  int group = -1;
  if (passed) {
    const bool is_robot = passed->kind == ModelKind::kRobot;
    group = is_robot ? passed->index : ownGroup(state_->slot_of_name.at(but));
  }
  return state_->obstacles
      .cast(from.X(), from.Y(), from.Z(), std::cos(yaw), std::sin(yaw), range, group)
      .range;
}

std::vector<ContactPoint> World::contacts(const std::string& model) const {
  const auto at = state_->slot_of_name.find(model);
  if (at == state_->slot_of_name.end()) return {};
  return contactsOf(*state_, at->second);
}

std::string World::checkpoint() { return kiva::checkpoint(*state_); }
std::uint64_t World::stateHash() const { return kiva::stateHash(*state_); }

void World::restore(const std::string& checkpoint) {
  Restored next = readCheckpoint(checkpoint);
  const std::vector<PluginState> before = savePlugins(*state_);
  next.world->owner = this;
  next.world->options.plugins = state_->options.plugins;
  next.world->warned = state_->warned;
  next.world->models_revision = state_->models_revision + 1;
  next.world->units_revision = state_->units_revision + 1;
  state_.swap(next.world);
  try {
    adoptPlugins(*state_, *next.world);
    restorePlugins(*state_, next.plugins);
  } catch (...) {
    state_.swap(next.world);
    restorePlugins(*state_, before);
    throw;
  }
}

std::vector<Event> World::takeEvents() {
  std::vector<Event> out;
  out.swap(state_->events);
  return out;
}

std::vector<StatusChange> World::takeStatusChanges() {
  std::vector<StatusChange> out;
  out.swap(state_->status_changes);
  return out;
}

std::vector<std::string> World::takeWarnings() {
  std::vector<std::string> out;
  out.swap(state_->warnings);
  return out;
}

}  // namespace kiva
