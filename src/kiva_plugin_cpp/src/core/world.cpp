// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/checkpoint/checkpoint.h"
#include "core/communication/command_link.h"
#include "core/communication/reports.h"
#include "core/contact/activation.h"
#include "core/contact/collisions.h"
#include "core/contact/external_wrenches.h"
#include "core/contact/upright.h"
#include "core/control/commands.h"
#include "core/control/shadows.h"
#include "core/disturbances/batteries.h"
#include "core/disturbances/failures.h"
#include "core/disturbances/falling_items.h"
#include "core/disturbances/load_tipping.h"
#include "core/models/floors.h"
#include "core/models/items.h"
#include "core/models/models.h"
#include "core/models/ordinary_models.h"
#include "core/models/user_plugins.h"
#include "core/motion/driving/drives.h"
#include "core/motion/driving/self_location.h"
#include "core/motion/dynamics.h"
#include "core/motion/joints/joints.h"
#include "core/motion/wheels/ground.h"
#include "core/parallel/workers.h"
#include "core/people/protective_fields.h"
#include "core/people/walking.h"
#include "core/sensing/look_ahead.h"
#include "core/sensing/ray_scene.h"
#include "core/sensing/scans.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/progress/path_progress.h"
#include "core/state/views/fleet_plugin.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/principal_inertia.h"
#include "plugins/plugin_table.h"

namespace kiva {
namespace {

constexpr double kSameGravity = 1e-3;                 // [m/s²]
constexpr double kLeastMass = 1e-6, kMostMass = 1e9;  // [kg]
constexpr double kLeastMoment = 1e-12;                // [kg m²]
constexpr double kMostArm = 1000;                     // [m]
constexpr int kScansTogether = 16;                    // on one thread
constexpr int kRaysTogether = 1000;                   // on one thread
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const WorldOptions& checked(const WorldOptions& options) {
  if (options.threads >= 1 && options.threads <= kMostThreads) return options;
  throw std::invalid_argument("threads is " + std::to_string(options.threads) + "; 1 to " +
                              std::to_string(kMostThreads) + " was expected");
}

/// A faulty part of a world costs that part and a warning.
template <typename Add>
void addOrLeaveOut(WorldState& world, Add add) {
  try {
    add();
  } catch (const DescriptionError& error) {
    world.log.warn(error.what(), std::string("left out: ") + error.what());
  }
}

/// `<min>` and `<max>`: x and y of two corners [m].
void addLightCurtain(WorldState& world, const PluginDescription& plugin) {
  const Parameters& p = plugin.parameters;
  const std::vector<double> min = p.numbers("min", {0, 0}), max = p.numbers("max", {0, 0});
  p.rejectUnread();
  try {
    setLightCurtain(world.people, {plugin.name, min[0], max[0], min[1], max[1]});
  } catch (const std::invalid_argument& error) {
    throw DescriptionError(p.where() + ": " + error.what());
  }
}

void loadWorldPlugin(WorldState& world, const PluginDescription& plugin) {
  if (plugin.filename == kGridPlugin) {
    const double spacing =
        plugin.parameters.number("spacing", 1.0, kLeastGridSpacing, kMostGridSpacing);
    plugin.parameters.rejectUnread();
    world.settings.grid_spacing = spacing;
  } else if (plugin.filename == kFloorPatchPlugin) {
    world.floor.patches.push_back(readFloorPatch(plugin.parameters));
  } else if (plugin.filename == kLightCurtainPlugin) {
    addLightCurtain(world, plugin);
  } else if (auto own = loadPlugin(world.view, "", plugin.filename, plugin.parameters, nullptr)) {
    world.plugins.world.push_back(std::move(own));
    world.plugins.world_descriptions.push_back(plugin);
  }
}

/// Calls every user's plugin. It may add and remove models, its own among them.
template <typename Call>
void forEachUserPlugin(WorldState& world, Call call) {
  for (auto& plugin : world.plugins.world) call(*plugin);
  const std::vector<int> slots = world.models.with_plugins;
  for (int slot : slots) {
    if (!world.models[slot]) continue;
    const auto plugins = world.models[slot]->plugins;
    for (auto& plugin : plugins) call(*plugin);
  }
}

/// Decides by what was seen which robots brake, stop, or begin a command.
void decide(WorldState& world) {
  findFloorParts(world.view);
  haltCollidedRobots(world.view, world.contact_log);
  sampleFailures(world.view, world.failures);
  updateBatteries(world.view, world.chargers);
  deliverReports(world.view);
  applyProtectiveFields(world.view, world.people, world.scans.due);
  for (const auto& plugin : world.plugins.fleet) plugin->react(world.view, world.scans.sighted);
  world.scans.sighted.clear();
  receive(world.command_link, world.inbox, world.clock);
  acceptCommands(world.view, world.inbox, world.shadows);
}

void control(WorldState& world) {
  for (const auto& plugin : world.plugins.fleet) plugin->control(world.view);
}

void sense(WorldState& world) {
  findDueScans(world.view, world.failures, world.scans);
  lookAhead(world.view, world.scans);
}

/// -1 = none.
int linkIndex(const Model* model, const std::string& name) {
  return model ? linkIndex(*model->description, name) : -1;
}

/// Discards what robots know of their ways ahead.
void discardForesight(WorldState& world) {
  invalidateClearance(world.fleet);
  for (int i = 0; i < world.fleet.size(); ++i) {
    if (world.fleet.awake[i]) moved(world.fleet, i);
  }
}

}  // namespace

World::World(const WorldDescription& description, const WorldOptions& options)
    : state_(std::make_unique<WorldState>(description, checked(options))) {
  state_->plugins.owner = this;
  state_->plugins.fleet = makeFleetPlugins();
  for (const Light& light : description.lights) setLight(light);
  for (const ModelInstance& model : description.models) {
    addOrLeaveOut(*state_, [&] { spawn(model); });
  }
  for (const PluginDescription& plugin : description.plugins) {
    addOrLeaveOut(*state_, [&] { loadWorldPlugin(*state_, plugin); });
  }
}

World::~World() = default;

WorldState& insideOf(World& world) { return *world.state_; }
const WorldState& insideOf(const World& world) { return *world.state_; }

void World::step() {
  WorldState& world = *state_;
  const Workers::Step step(*world.schedule.workers);
  decide(world);
  forEachUserPlugin(world, [&](Plugin& plugin) { plugin.beforeStep(*this, world.clock.dt); });
  applyExternalWrenches(world.view);
  updateActivation(world.view);
  control(world);
  actuate(world.view);
  world.physics.step(world.clock.dt);
  integrate(world.view);
  stepPeople(world.view, world.people);
  world.clock.advance();
  sense(world);
  observeCollisions(world.view);
  stepLoadTipping(world.view);
  stepFallingItems(world.view);
  forEachUserPlugin(world, [&](Plugin& plugin) { plugin.afterStep(*this, world.clock.dt); });
}

double World::time() const { return state_->clock.time(); }
std::uint64_t World::steps() const { return state_->clock.steps; }
double World::stepSize() const { return state_->clock.dt; }
const Vector3& World::gravity() const { return state_->settings.gravity; }
std::uint64_t World::seed() const { return state_->settings.options.seed; }
const Realism& World::realism() const { return state_->settings.realism; }
const std::string& World::name() const { return state_->settings.name; }

void World::setStepSize(double seconds) {
  if (!(seconds >= kLeastStep && seconds <= kMostStep)) {
    throw std::invalid_argument("the step size must be from 1e-6 to 1 s");
  }
  if (seconds == state_->clock.dt) return;
  state_->clock.setStepSize(seconds);
  state_->fleet.applyRealism(state_->settings.realism, seconds);
  state_->scans.rounds_revision = ~0ull;  // those were counted in the old steps, as was
  discardForesight(*state_);              // when to look around again
}

void World::setGravity(const Vector3& gravity) {
  if (!gravity.IsFinite() || gravity.Length() > kMostGravity) {
    throw std::invalid_argument("gravity must be finite and at most 1000 m/s²");
  }
  if (gravity.Equal(state_->settings.gravity, kSameGravity)) return;
  state_->settings.gravity = gravity;
  state_->physics.setGravity(gravity);
  letAllTip(state_->view);
  wakeBodies(state_->view.models);
  discardForesight(*state_);
}

void World::reset(bool time_too) {
  WorldState& world = *state_;
  forgetContacts(world.view, -1);
  world.contact_log.crashes.clear();
  world.command_link.messages.clear();
  world.report_link.messages.clear();
  putAllBack(world.view);
  for (int slot : world.models.inOrder()) resetModel(world.view, *world.models[slot]);
  for (int i = 0; i < world.fleet.size(); ++i) recordPlacement(world.view, world.failures, i);
  world.external_inputs.wrenches.clear();
  world.external_inputs.efforts.clear();
  world.failures = {};
  restartScripts(world.fleet, world.people);
  if (time_too) world.clock.resetTime();
  forEachUserPlugin(world, [&](Plugin& plugin) { plugin.reset(*this); });
}

void World::post(const Command& command) {
  if (command.kind == Command::Kind::kFollow) {
    throw std::invalid_argument("a path is posted as a FollowPath");
  }
  send(state_->command_link, state_->inbox, state_->view, {command, {}});
}

void World::post(FollowPath path) {
  const auto isNone = [](double value) { return !std::isfinite(value); };
  for (std::vector<double>* column : {&path.x, &path.y}) {
    if (std::none_of(column->begin(), column->end(), isNone)) continue;
    path.fault = "a coordinate is not a finite number";
    column->clear();
  }
  Command command;
  command.kind = Command::Kind::kFollow;
  command.kiva_id = path.kiva_id;
  send(state_->command_link, state_->inbox, state_->view, {command, std::move(path)});
}

void World::fail(int kiva_id, Failure failure, double repair_after) {
  injectFailure(state_->view, state_->failures, kiva_id, failure, repair_after);
}
void World::repair(int kiva_id) { kiva::repair(state_->view, state_->failures, kiva_id); }
std::optional<RobotReport> World::lastHeard(int robot) const {
  return kiva::lastHeard(state_->view, state_->failures, robot);
}

void World::keepMode(int kiva_id, int mode) {
  const int robot = state_->fleet.find(kiva_id);
  if (robot < 0) throw std::invalid_argument("there is no kiva" + std::to_string(kiva_id));
  if (mode < 0 || mode > kMostMode) {
    throw std::invalid_argument("mode is " + std::to_string(mode) + "; 0 to " +
                                std::to_string(kMostMode) + " was expected");
  }
  state_->fleet.mode[robot] = static_cast<std::uint8_t>(mode);
}

void World::shadow(int kiva_id, const ShadowReport& report) {
  moveShadow(state_->view, state_->shadows, kiva_id, report);
}
bool World::isShadow(int kiva_id) const { return state_->shadows.has(kiva_id); }

void World::walk(const std::string& person, const Walk& walk) {
  kiva::walk(state_->view, state_->people, person, walk);
}
std::vector<Person> World::people() const { return listPeople(state_->view); }
void World::setLightCurtain(const LightCurtain& curtain) {
  kiva::setLightCurtain(state_->people, curtain);
}
bool World::removeLightCurtain(const std::string& name) {
  return kiva::removeLightCurtain(state_->people, name);
}
const std::vector<LightCurtain>& World::lightCurtains() const { return state_->people.curtains; }

std::vector<FallenItem> World::fallenItems() const { return listFallenItems(state_->view); }
void World::pickUp(const std::string& item) { kiva::pickUp(state_->view, item); }

void World::spawn(const ModelInstance& instance) {
  spawnModel(state_->view, instance);
  if (!instance.walk) return;
  beginScript(state_->view, state_->people, state_->models.slot_of_name.at(instance.name),
              *instance.walk);
}

void World::spawn(const std::vector<ModelInstance>& instances) {
  std::size_t done = 0;
  try {
    for (; done < instances.size(); ++done) spawn(instances[done]);
  } catch (const DescriptionError&) {
    while (done > 0) remove(instances[--done].name);
    throw;
  }
}

bool World::remove(const std::string& model) {
  const auto at = state_->models.slot_of_name.find(model);
  if (at == state_->models.slot_of_name.end()) return false;
  const Model& found = *state_->models[at->second];
  const int robot = found.owner->robot(state_->view, found);
  if (robot >= 0) endShadow(state_->shadows, state_->fleet.robots[robot].id);
  removeModel(state_->view, at->second);
  return true;
}

bool World::has(const std::string& model) const { return state_->models.find(model) != nullptr; }

std::vector<std::string> World::modelNames() const {
  std::vector<std::string> names;
  for (int slot : state_->models.inOrder()) names.push_back(state_->models[slot]->name);
  return names;
}

ModelKind World::kind(const std::string& model) const {
  const Model* found = state_->models.find(model);
  return found ? found->kind : ModelKind::kOther;
}

std::uint64_t World::modelsRevision() const { return state_->models.revision; }

std::optional<EntityState> World::state(const std::string& model, const std::string& link) const {
  const Model* found = state_->models.find(model);
  if (!found) return std::nullopt;
  if (link.empty()) return modelState(state_->view, *found);
  const int index = linkIndex(found, link);
  if (index < 0) return std::nullopt;
  return linkState(state_->view, *found, index);
}

std::shared_ptr<const ModelDescription> World::description(const std::string& model) const {
  const Model* found = state_->models.find(model);
  return found ? found->description : nullptr;
}

bool World::setState(const std::string& model, const EntityState& state) {
  Model* found = state_->models.find(model);
  if (!found) return false;
  placeModel(state_->view, *found, state);
  const int robot = found->owner->robot(state_->view, *found);
  if (robot >= 0) recordPlacement(state_->view, state_->failures, robot);
  return true;
}

void World::states(std::vector<EntityState>* out) const {
  out->clear();
  for (int slot : state_->models.inOrder()) {
    out->push_back(modelState(state_->view, *state_->models[slot]));
  }
}

bool World::setVelocity(const std::string& model, const Twist& twist) {
  Model* found = state_->models.find(model);
  if (!found || found->kind != ModelKind::kOther) return false;
  if (!found->owner->followsBodies(*found)) return false;
  if (!twist.linear.IsFinite() || !twist.angular.IsFinite()) {
    throw DescriptionError("the velocity of '" + model + "' must be finite");
  }
  setModelTwist(*found, twist);
  return true;
}

bool World::setLinkState(const std::string& model, const std::string& link,
                         const EntityState& state) {
  Model* found = state_->models.find(model);
  const int index = linkIndex(found, link);
  if (index < 0) return false;
  placeLink(state_->view, *found, index, state);
  return true;
}

void World::linkStates(std::vector<std::string>* names, std::vector<EntityState>* states) const {
  names->clear();
  states->clear();
  for (int slot : state_->models.inOrder()) {
    const Model& model = *state_->models[slot];
    const auto& links = model.description->links;
    for (std::size_t i = 0; i < links.size(); ++i) {
      names->push_back(model.name + "::" + links[i].name);
      states->push_back(linkState(state_->view, model, static_cast<int>(i)));
    }
  }
}

bool World::setLinkInertia(const std::string& model, const Link& link) {
  Model* found = state_->models.find(model);
  const int index = linkIndex(found, link.name);
  if (index < 0) return false;
  const InertiaTensor inertia{link.principal_moments, Vector3::Zero};
  const bool is_usable =
      link.mass >= kLeastMass && link.mass <= kMostMass && link.principal_moments.IsFinite() &&
      link.principal_moments.Min() >= kLeastMoment && link.inertial_pose_in_link.IsFinite() &&
      link.inertial_pose_in_link.Pos().Abs().Max() <= kMostArm;
  if (!is_usable || !inertia.isPossible(link.mass)) {
    throw std::invalid_argument(
        "no body is like that; expected a mass above 0 kg, principal moments above 0 kg m², none "
        "larger than the sum of the other two, and a centre of mass near the link");
  }
  reweighLink(state_->view, *found, index, link);
  return true;
}

std::optional<JointState> World::joint(const std::string& model, const std::string& joint) const {
  const Model* found = state_->models.find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return std::nullopt;
  return jointState(state_->view.fleet, *found, index);
}

std::optional<JointWrench> World::jointWrench(const std::string& model,
                                              const std::string& joint) const {
  const Model* found = state_->models.find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return std::nullopt;
  return kiva::jointWrench(*found, index);
}

bool World::setJoint(const std::string& model, const std::string& joint,
                     const JointSettings& settings) {
  Model* found = state_->models.find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return false;
  kiva::setJoint(*found, index, settings);
  return true;
}

void World::setJointPositions(const std::string& model,
                              const std::map<std::string, double>& positions) {
  Model* found = state_->models.find(model);
  if (!found) throw std::invalid_argument("there is no model '" + model + "'");
  placeJoints(state_->view, *found, positions);
}

const ExternalInputs& World::externalInputs() const { return state_->external_inputs; }

bool World::applyWrench(const std::string& model, const std::string& link, const Vector3& force,
                        const Vector3& torque) {
  Model* found = state_->models.find(model);
  const int index = linkIndex(found, link);
  return index >= 0 && pushLink(state_->view, *found, index, force, torque);
}

bool World::apply(const Wrench& wrench) {
  const Model* found = state_->models.find(wrench.model);
  if (linkIndex(found, wrench.link) < 0 || found->isStatic()) return false;
  state_->external_inputs.wrenches.push_back(wrench);
  return true;
}

bool World::apply(const Effort& effort) {
  const Model* found = state_->models.find(effort.model);
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
const std::vector<StorageUnit>& World::storageUnits() const { return state_->storage.units; }
const std::vector<Item>& World::items() const { return state_->storage.items; }
Pose World::storageUnitPose(int unit) const { return unitPose(state_->view, unit); }
Pose World::itemPose(int item) const { return kiva::itemPose(state_->view, item); }
std::vector<PathPoint> World::pathAhead(int robot) const {
  const Task& task = state_->fleet.tasks[robot];
  if (task.follows()) return pointsAhead(state_->view.fleet, robot);
  std::vector<PathPoint> points;
  for (const MotionSegment& segment : task.segments) {
    if (segment.kind == MotionSegment::Kind::kDrive) points.push_back({segment.x, segment.y});
  }
  return points;
}
Vector3 World::believedPose(int robot) const {
  const PlanarPose at = state_->fleet.believed(robot);
  return {at.x, at.y, at.yaw};
}
Odometry World::odometry(int robot) const { return odometryOf(state_->view, robot); }
double World::loadLimit(int robot) const { return kiva::loadLimit(state_->view, robot); }
Pose World::basePose(int robot) const { return kiva::basePose(state_->view, robot); }
std::uint64_t World::unitsRevision() const { return state_->storage.revision; }
const Floor& World::floor() const { return state_->floor.extent; }
double World::gridSpacing() const { return state_->settings.grid_spacing; }

void World::scan(int robot, std::vector<float>* ranges) const {
  static thread_local FanHits hits;
  const LaserParameters& laser = state_->fleet.robots[robot].laser;
  castRays(state_->view, state_->scans, robot, {laser.max_range, kInfinity}, &hits);
  if (isBlind(state_->view.fleet, robot)) {
    ranges->assign(laser.rays, std::numeric_limits<float>::quiet_NaN());
    return;
  }
  ranges->assign(laser.rays, static_cast<float>(kInfinity));
  for (int ray = hits.first; ray <= hits.last; ++ray) {
    if (hits.model[ray] < 0) continue;
    const double range = hits.range[ray];
    (*ranges)[ray] = static_cast<float>(range < laser.min_range ? -kInfinity : range);
  }
}

void World::scan(const std::vector<int>& robots, std::vector<std::vector<float>>* ranges) const {
  ranges->resize(robots.size());
  state_->schedule.workers->share(static_cast<int>(robots.size()), kScansTogether,
                                  [&](int begin, int end) {
                                    for (int k = begin; k < end; ++k)
                                      scan(robots[k], &(*ranges)[k]);
                                  });
}

const std::vector<int>& World::scansDue() const { return state_->scans.due; }

double World::rayCast(const Vector3& from, double yaw, double range, const std::string& but) const {
  const Model* passed = state_->models.find(but);
  const int group = passed ? passed->owner->group(*passed) : -1;
  return state_->obstacles
      .cast(from.X(), from.Y(), from.Z(), std::cos(yaw), std::sin(yaw), range, group)
      .range;
}

void World::rayCast(const Vector3& from, const std::vector<Vector3>& directions, double range,
                    const std::string& but, std::vector<double>* ranges) const {
  const RayScene scene(state_->view, from, range, state_->models.find(but));
  ranges->resize(directions.size());
  const int rays = static_cast<int>(directions.size());
  state_->schedule.workers->share(rays, kRaysTogether, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) (*ranges)[k] = scene.cast(directions[k]);
  });
}

std::vector<ContactPoint> World::contacts(const std::string& model) const {
  const auto at = state_->models.slot_of_name.find(model);
  if (at == state_->models.slot_of_name.end()) return {};
  return contactsOf(state_->view, at->second);
}

std::string World::checkpoint() const { return kiva::checkpoint(*state_); }
std::uint64_t World::stateHash() const { return kiva::stateHash(*state_); }

void World::restore(const std::string& checkpoint) {
  if (returnTo(*state_, checkpoint)) return;
  Restored next = readCheckpoint(checkpoint);
  const std::vector<PluginState> before = savePlugins(*state_);
  next.world->plugins.owner = this;
  next.world->settings.options.plugins = state_->settings.options.plugins;
  next.world->settings.options.threads = state_->settings.options.threads;
  next.world->schedule.workers = state_->schedule.workers;
  next.world->shadows = state_->shadows;
  next.world->log.warned = state_->log.warned;
  next.world->plugins.fleet = makeFleetPlugins();
  next.world->models.revision = state_->models.revision + 1;
  next.world->storage.revision = state_->storage.revision + 1;
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
  out.swap(state_->log.events);
  state_->log.events.reserve(out.size());  // as many may follow
  return out;
}

std::vector<StatusChange> World::takeStatusChanges() {
  std::vector<StatusChange> out;
  out.swap(state_->log.status_changes);
  return out;
}

void World::warn(const std::string& warning) { state_->log.warn(warning, warning); }

std::vector<std::string> World::takeWarnings() {
  std::vector<std::string> out;
  out.swap(state_->log.warnings);
  return out;
}

}  // namespace kiva
