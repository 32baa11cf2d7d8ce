// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/world.h"

#include <cmath>
#include <limits>

#include "../plugins/fleet_plugin.h"
#include "checkpoint.h"
#include "collisions.h"
#include "commands.h"
#include "engagement.h"
#include "load.h"
#include "models.h"
#include "parts.h"
#include "sensing.h"
#include "user_plugins.h"

namespace kiva {
namespace {

void loadWorldPlugins(Parts& parts, const std::vector<PluginDescription>& plugins) {
  for (const PluginDescription& plugin : plugins) {
    if (isGridPlugin(plugin.filename)) {
      configureGrid(parts, plugin.parameters);
    } else {
      parts.world_plugins.push_back(loadUserPlugin(plugin.filename, plugin.parameters.where()));
      parts.world_plugins.back()->load(*parts.world, "", plugin.parameters);
      parts.world_plugin_descriptions.push_back(plugin);
    }
    plugin.parameters.rejectUnread();
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

void command(Parts& parts) {
  for (auto& plugin : parts.fleet_plugins) plugin->beforeStep(parts);
}

void afterStep(Parts& parts) {
  for (auto& plugin : parts.fleet_plugins) plugin->afterStep(parts);
  forEachUserPlugin(parts, [&](Plugin& p) { p.afterStep(*parts.world, parts.dt); });
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
                          const std::string& text) {
  events.push_back({time(), kind, model, other, text});
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
  spawn(description.models);
  loadWorldPlugins(*parts_, description.plugins);
}

World::~World() = default;

void World::step() {
  Parts& parts = *parts_;
  acceptCommands(parts);
  forEachUserPlugin(parts, [&](Plugin& p) { p.beforeStep(*this, parts.dt); });
  updateEngagement(parts);
  command(parts);
  drive(parts);
  parts.physics.step(parts.dt);
  settle(parts);
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
const std::string& World::name() const { return parts_->name; }

void World::reset(bool time_too) {
  for (int slot : slotsInOrder(*parts_)) resetModel(*parts_, slot);
  parts_->touching.clear();
  if (time_too) parts_->steps = 0;
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

bool World::applyWrench(const std::string& model, const std::string& link, const Vector3& force,
                        const Vector3& torque) {
  Model* found = parts_->find(model);
  if (!found || found->isStatic() || !found->in_physics) return false;
  const auto& links = found->description->links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name != link || i >= found->bodies.links.size()) continue;
    btRigidBody& body = *found->bodies.links[i].body;
    body.activate(true);
    body.applyCentralForce(toBullet(force));
    body.applyTorque(toBullet(torque));
    return true;
  }
  return false;
}

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

double World::rayCast(const Vector3& from, double yaw, double range) const {
  return parts_->obstacles
      .cast(from.X(), from.Y(), from.Z(), std::cos(yaw), std::sin(yaw), range, -1)
      .range;
}

std::string World::checkpoint() { return kiva::checkpoint(*parts_); }
std::uint64_t World::stateHash() const { return kiva::stateHash(*parts_); }

void World::restore(const std::string& checkpoint) {
  Restored next = readCheckpoint(checkpoint);
  const std::vector<PluginState> before = savePlugins(*parts_);
  next.parts->world = this;
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

}  // namespace kiva
