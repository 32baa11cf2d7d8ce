// SPDX-License-Identifier: Apache-2.0
#include "core/disturbances/batteries.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/control/interruptions.h"
#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

constexpr double kBatteryPeriod = 0.1;  // [s]
constexpr double kJoule = 3600;         // [J] in 1 Wh
constexpr double kLeastCharge = 0.05;   // share of the power that a nearly full battery takes
constexpr double kRestarts =
    0.02;  // state of charge from which a robot with an empty battery works again
constexpr double kStandstill = 1e-3;  // [m/s]
constexpr char kMarkings[] = "floor_markings";
constexpr char kChargingLink[] = "charging";

double capacityOf(const EnergyRealism& e) { return e.capacity * e.health * kJoule; }

/// Adds the chargers of a static model: each visual of its charging links is a rectangle along the
/// axes.
void addChargers(const Model& model, std::vector<Charger>* out) {
  for (const Link& link : model.description->links) {
    if (link.name != kChargingLink) continue;
    for (const Visual& visual : link.visuals) {
      const Pose at = model.pose * link.pose_in_model * visual.pose_in_link;
      const double c = std::abs(std::cos(at.Yaw())), s = std::abs(std::sin(at.Yaw()));
      const double hx = (c * visual.shape.size.X() + s * visual.shape.size.Y()) / 2;
      const double hy = (s * visual.shape.size.X() + c * visual.shape.size.Y()) / 2;
      out->push_back({at.X() - hx, at.X() + hx, at.Y() - hy, at.Y() + hy});
    }
  }
}

void findChargers(const ModelTable& models, Chargers& chargers) {
  if (chargers.models_revision == models.revision) return;
  chargers.models_revision = models.revision;
  chargers.areas.clear();
  for (const auto& model : models) {
    if (model && model->name.rfind(kMarkings, 0) == 0) addChargers(*model, &chargers.areas);
  }
}

bool isOnCharger(const Chargers& chargers, const Fleet& f, int i) {
  if (std::hypot(f.vx[i], f.vy[i]) > kStandstill) return false;
  return std::any_of(chargers.areas.begin(), chargers.areas.end(), [&](const Charger& c) {
    return f.x[i] > c.min_x && f.x[i] < c.max_x && f.y[i] > c.min_y && f.y[i] < c.max_y;
  });
}

/// Returns the kinetic energy of chassis, load, and both wheels with their motors [J].
double kineticEnergy(const Fleet& f, int i) {
  const Robot& r = f.robots[i];
  const double v2 = f.vx[i] * f.vx[i] + f.vy[i] * f.vy[i], w = f.yaw_rate[i];
  const double left = f.wheel_speed[0][i], right = f.wheel_speed[1][i];
  const double spin2 = left * left + right * right;
  return ((r.mass + r.load_mass) * v2 + (r.inertia + r.load_inertia) * w * w +
          r.drive.wheel_inertia * spin2) /
         2;
}

/// Stores the wheel angles from which rolling resistance is counted next.
void markWheels(FleetState& f, int i) {
  for (int wheel = 0; wheel < 2; ++wheel) {
    f.battery[i].wheel_angle[wheel] = f.wheel_angle[wheel][i];
  }
}

/// Draws the battery's initial charge.
void begin(RobotView& world, int i) {
  const EnergyRealism& e = world.settings.realism.energy;
  FleetState& f = world.fleet;
  RandomStream random(world.settings.options.seed, Matter::kEnergy, f.robots[i].id, 0);
  const double most = std::max(e.initial_least, e.initial_most);
  const double charge = e.initial_least + (most - e.initial_least) * random.uniform();
  Battery& battery = f.battery[i];
  battery.energy = charge * capacityOf(e);
  battery.kinetic = kineticEnergy(f, i);
  battery.tower = f.tower[i];
  markWheels(f, i);
}

bool isAtRest(const FleetState& f, int i) {
  const Battery& battery = f.battery[i];
  return f.vx[i] == 0 && f.vy[i] == 0 && f.yaw_rate[i] == 0 && battery.kinetic == 0 &&
         f.tower[i] == battery.tower;
}

void show(FleetState& f, const EnergyRealism& e, int i) {
  const double charge = f.battery[i].energy / capacityOf(e);
  f.charge[i] = static_cast<float>(charge);
}

/// Drains the energy of one step of motion: acceleration less recovered braking, and lifting. Each
/// step counts, since a turn lasts only a few battery readings, and taking up a load only one.
void drainForMotion(RobotView& world, int i) {
  const EnergyRealism& e = world.settings.realism.energy;
  FleetState& f = world.fleet;
  Battery& battery = f.battery[i];
  if (battery.energy < 0) begin(world, i);
  if (isAtRest(f, i)) return;
  const double kinetic = kineticEnergy(f, i);
  const double faster = kinetic - battery.kinetic;
  const double moving = faster > 0 ? faster / e.drive_efficiency : faster * e.regeneration;
  const double raised = std::max(0.0, f.tower[i] - battery.tower);
  const double lifted = raised * f.robots[i].load_mass * world.settings.gravityDown();
  battery.kinetic = kinetic;
  battery.tower = f.tower[i];
  if (f.failures[i] & kEmptyBattery) return;
  battery.energy = std::max(0.0, battery.energy - moving - lifted / e.lift_efficiency);
  show(world.fleet, world.settings.realism.energy, i);
}

/// Returns the consumption of electronics and rolling since the last reading [J].
double drawnSteadily(const Scene& world, int i, double seconds) {
  const EnergyRealism& e = world.settings.realism.energy;
  const FleetState& f = world.fleet;
  const Battery& before = f.battery[i];
  const Robot& r = f.robots[i];
  double rolled = 0;  // [m], mean of both wheels
  for (int wheel = 0; wheel < 2; ++wheel) {
    rolled += std::abs(f.wheel_angle[wheel][i] - before.wheel_angle[wheel]);
  }
  rolled *= r.drive.wheel_radius / 2;
  const double weight = (r.mass + r.load_mass) * world.settings.gravityDown();
  const double rolling = e.rolling_resistance * weight * rolled;
  return e.electronics * seconds + rolling / e.drive_efficiency;
}

/// Returns the energy that a charger puts into the battery in that time [J].
double takenUp(const Scene& world, const Chargers& chargers, int i, double seconds) {
  const EnergyRealism& e = world.settings.realism.energy;
  if (!isOnCharger(chargers, world.fleet, i)) return 0;
  const double charge = world.fleet.battery[i].energy / capacityOf(e);
  const double falling = (1 - charge) / std::max(1e-9, 1 - e.charge_taper);
  return e.charge_power * std::clamp(falling, kLeastCharge, 1.0) * seconds;
}

void setEmpty(TaskView& world, int i, bool is_empty, const std::string& text) {
  FleetState& f = world.fleet;
  f.failures[i] =
      static_cast<std::uint8_t>((f.failures[i] & ~kEmptyBattery) | (is_empty ? kEmptyBattery : 0));
  const auto kind = is_empty ? Event::Kind::kFailed : Event::Kind::kRepaired;
  world.log.report(kind, f.robots[i].name, "", text);
  if (is_empty && f.awake[i]) moved(f, i);
  if (!is_empty && !isHeld(f, i)) replan(world, i);
}

void updateBattery(TaskView& world, const Chargers& chargers, int i, double seconds) {
  FleetState& f = world.fleet;
  Battery& battery = f.battery[i];
  const double most = capacityOf(world.settings.realism.energy);
  const double drawn = drawnSteadily(world, i, seconds) - takenUp(world, chargers, i, seconds);
  battery.energy = std::clamp(battery.energy - drawn, 0.0, most);
  markWheels(f, i);
  show(world.fleet, world.settings.realism.energy, i);
  const bool was_empty = (f.failures[i] & kEmptyBattery) != 0;
  if (!was_empty && battery.energy == 0) setEmpty(world, i, true, "its battery is empty");
  if (was_empty && battery.energy > kRestarts * most) {
    setEmpty(world, i, false, "its battery is being charged");
  }
}

}  // namespace

void updateBatteries(TaskView& world, Chargers& chargers) {
  if (!world.settings.realism.energy.enabled) return;
  for (int i = 0; i < world.fleet.size(); ++i) drainForMotion(world, i);
  const auto period = std::max<std::uint64_t>(1, std::llround(kBatteryPeriod / world.clock.dt));
  if (world.clock.total_steps % period != 0) return;
  findChargers(world.models, chargers);
  for (int i = 0; i < world.fleet.size(); ++i) {
    updateBattery(world, chargers, i, static_cast<double>(period) * world.clock.dt);
  }
}

void swapBattery(TaskView& world, int robot) {
  world.fleet.battery[robot].energy = capacityOf(world.settings.realism.energy);
  show(world.fleet, world.settings.realism.energy, robot);
  setEmpty(world, robot, false, "repaired: it has a full battery");
}

void restoreCharge(FleetState& f, const EnergyRealism& realism) {
  f.charge.assign(f.size(), 1);
  f.battery.resize(f.size());
  if (!realism.enabled) return;
  for (int i = 0; i < f.size(); ++i) {
    if (f.battery[i].energy < 0) continue;
    show(f, realism, i);
    if (f.battery[i].energy == 0) f.failures[i] |= kEmptyBattery;
  }
}

}  // namespace kiva
