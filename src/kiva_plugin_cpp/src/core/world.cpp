// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/world.h"

#include <stdexcept>

#include "core/communication/command_link.h"
#include "core/communication/reports.h"
#include "core/contact/activation.h"
#include "core/contact/collisions.h"
#include "core/contact/external_wrenches.h"
#include "core/contact/upright.h"
#include "core/control/commands.h"
#include "core/disturbances/batteries.h"
#include "core/disturbances/failures.h"
#include "core/disturbances/falling_items.h"
#include "core/disturbances/load_tipping.h"
#include "core/models/floors.h"
#include "core/models/items.h"
#include "core/models/models.h"
#include "core/models/user_plugins.h"
#include "core/motion/dynamics.h"
#include "core/motion/wheels/ground.h"
#include "core/parallel/workers.h"
#include "core/people/protective_fields.h"
#include "core/people/walking.h"
#include "core/sensing/look_ahead.h"
#include "core/sensing/scans.h"
#include "core/state/places/footprints.h"
#include "core/state/views/fleet_plugin.h"
#include "core/state/world_state.h"
#include "plugins/plugin_table.h"
#include "plugins/steered_drive.h"

namespace kiva {
namespace {

constexpr double kSameGravity = 1e-3;  // [m/s²]

const WorldOptions& checked(const WorldOptions& options) {
  if (options.threads >= 1 && options.threads <= kMostThreads) return options;
  throw std::invalid_argument("threads is " + std::to_string(options.threads) + "; 1 to " +
                              std::to_string(kMostThreads) + " was expected");
}

/// Adds a part of the world. A faulty part is left out with a warning.
template <typename Add>
void addOrLeaveOut(WorldState& world, Add add) {
  try {
    add();
  } catch (const DescriptionError& error) {
    world.log.warn(error.what(), std::string("left out: ") + error.what());
  }
}

/// Reads `<min>` and `<max>`: x and y of two corners [m].
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

/// Calls every user's plugin, which may add and remove models, even its own.
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

// Phases of a step. A phase reads the world as a `const Scene&`, and writes what its other
// arguments name, or what its view has (core/state/views).

/// Decides by the last step's scans which robots brake, stop, or begin a command.
void decide(WorldState& world) {
  const Scene& scene = world.view;
  findFloorParts(scene, world.floor, world.log);
  haltCollidedRobots(world.view, world.contact_log);
  sampleFailures(world.view, world.failures);
  updateBatteries(world.view, world.chargers);
  deliverReports(world.view);
  applyProtectiveFields(world.view, world.people, world.scans.due);
  for (const auto& plugin : scene.plugins.fleet) plugin->react(world.view, world.scans.sighted);
  world.scans.sighted.clear();
  receive(world.command_link, world.inbox, scene.clock);
  acceptCommands(world.view, world.obstacles, world.inbox, world.shadows);
}

/// Sets the commands of motors and towers.
void control(ContactView& world) {
  for (const auto& plugin : world.plugins.fleet) plugin->control(world);
  driveSteered(world);
}

/// Scans, and looks ahead of robots that drive.
void sense(RobotView& world, const FailureState& failures, Scans& scans) {
  findDueScans(world, failures, scans);
  lookAhead(world, scans);
}

/// Discards the clearances of robots.
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
  control(world.view);
  actuate(world.view);
  world.physics.step(world.clock.dt);
  integrate(world.view);
  stepPeople(world.view, world.people);
  world.clock.advance();
  sense(world.view, world.failures, world.scans);
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
void World::drawFailuresAnew(std::uint64_t number) {
  kiva::drawFailuresAnew(state_->view, state_->failures, number);
}
const Realism& World::realism() const { return state_->settings.realism; }
const std::string& World::name() const { return state_->settings.name; }

void World::setStepSize(double seconds) {
  if (!(seconds >= kLeastStep && seconds <= kMostStep)) {
    throw std::invalid_argument("the step size must be from 1e-6 to 1 s");
  }
  if (seconds == state_->clock.dt) return;
  state_->clock.setStepSize(seconds);
  state_->fleet.applyRealism(state_->settings.realism, seconds);
  state_->scans.rounds_revision = ~0ull;  // these were counted in old steps, as was
  discardForesight(*state_);              // the next test of each robot's way
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
  forgetContacts(world.view, world.contact_log, world.log, -1);
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

}  // namespace kiva
