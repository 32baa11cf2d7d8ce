// SPDX-License-Identifier: Apache-2.0
#include "core/people/walking.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "core/geometry/solid.h"
#include "core/people/detour.h"
#include "core/people/footing.h"
#include "core/state/people/people.h"
#include "core/state/places/floors.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kLargest = 1;        // [m]; a longer or wider model is not a person
constexpr double kLook = 0.02;        // [s] between two looks ahead,
constexpr double kLookAhead = 0.35;   // [m] of each look: half a pace
constexpr double kPatience = 2;       // [s] before the first search for a detour,
constexpr double kMostPatience = 30;  // [s], the longest time before a later one
constexpr double kThere = 1e-9;       // [m]

[[noreturn]] void refuse(const std::string& person, const std::string& why) {
  throw std::invalid_argument(person + ": " + why);
}

bool isPerson(const Model& model) {
  const Bounds box = bounds(*model.description);
  if (!model.isStatic() || model.owner->isFloor() || model.kind != ModelKind::kOther) return false;
  return !box.empty() && std::max(box.max.X() - box.min.X(), box.max.Y() - box.min.Y()) <= kLargest;
}

void checkWaypoint(const Waypoint& w, const std::string& person, std::size_t number) {
  const std::string which = "waypoint " + std::to_string(number) + ": ";
  if (!std::isfinite(w.x) || !std::isfinite(w.y)) refuse(person, which + "it is not finite");
  if (!(w.speed > 0 && w.speed <= kMostWalkingSpeed)) {
    refuse(person, which + "a speed above 0 and up to 1.6 m/s was expected");
  }
  if (!(w.pause >= 0 && std::isfinite(w.pause))) {
    refuse(person, which + "a pause of 0 s or more was expected");
  }
}

void checkOnFloor(const Scene& world, const Walk& walk, const std::string& person) {
  if (walk.waypoints.empty()) return;
  const FloorCover cover(world);
  for (std::size_t k = 0; k < walk.waypoints.size(); ++k) {
    const Waypoint& w = walk.waypoints[k];
    checkWaypoint(w, person, k);
    if (cover.covers(w.x, w.y, 0)) continue;
    char text[96];
    std::snprintf(text, sizeof text, "waypoint %zu at (%g, %g) is not on the floor", k, w.x, w.y);
    refuse(person, text);
  }
}

Walker newWalker(const Model& model) {
  const Bounds box = bounds(*model.description);
  Walker walker;
  walker.model = model.slot;
  walker.radius = std::max({box.max.X(), box.max.Y(), -box.min.X(), -box.min.Y()});
  walker.bottom = box.min.Z();
  walker.top = box.max.Z();
  return walker;
}

Walker& walkerOf(People& people, const Model& model) {
  if (Walker* known = people.find(model.slot)) return *known;
  people.walkers.push_back(newWalker(model));
  return people.walkers.back();
}

/// Starts the walk; robots that relied on a person at rest test their ways again.
void startWalk(FleetState& fleet, Walker* walker, const Walk& walk) {
  walker->walk = walk;
  walker->next = 0;
  walker->pause = walker->held_up = walker->vx = walker->vy = 0;
  walker->patience = kPatience;
  walker->detour.clear();
  walker->look_at = 0;
  invalidateClearance(fleet);
}

// --- a step

/// Returns the share of the vector (dx, dy) [m] that `metres` are, at most 1.
double partOf(double metres, double dx, double dy) {
  return std::min(1.0, metres / std::max(std::hypot(dx, dy), kThere));
}

/// Returns whether there is room half a pace ahead, or at least more than here.
bool isFreeAhead(const Scene& world, const Walker& walker, const Pose& at, const PathPoint& to) {
  const double dx = to.x - at.X(), dy = to.y - at.Y();
  const double part = partOf(kLookAhead, dx, dy);
  const double there = clearanceAt(world, walker, at.X() + part * dx, at.Y() + part * dy);
  return there >= 0 || there > clearanceAt(world, walker, at.X(), at.Y()) + kThere;
}

void waitOrDetour(const Scene& world, Walker* walker) {
  walker->held_up += world.clock.dt;
  if (walker->held_up < walker->patience) return;
  const Waypoint& to = walker->walk.waypoints[walker->next];
  walker->detour = findDetour(world, *walker, to.x, to.y);
  walker->look_at = 0;
  walker->held_up = 0;
  const bool is_none = walker->detour.empty();
  walker->patience = is_none ? std::min(kMostPatience, 2 * walker->patience) : kPatience;
}

void arrive(Walker* walker) {
  walker->look_at = 0;
  if (walker->detour.size() > 1) return walker->detour.pop_back();
  walker->detour.clear();  // its last point is the waypoint itself
  walker->pause = walker->walk.waypoints[walker->next].pause;
  ++walker->next;
  if (walker->walk.loops && !walker->walks()) walker->next = 0;
}

void put(ContactView& world, Model& model, const Pose& pose) {
  model.pose = pose;
  world.physics.shift(model.bodies, *model.description, pose);
  moved(world, model);
}

void stepTowards(ContactView& world, Walker* walker, const PathPoint& to) {
  Model& model = *world.models[walker->model];
  const double dx = to.x - model.pose.X(), dy = to.y - model.pose.Y();
  const double part = partOf(walker->walk.waypoints[walker->next].speed * world.clock.dt, dx, dy);
  const Vector3& at = model.pose.Pos();
  walker->vx = part * dx / world.clock.dt;
  walker->vy = part * dy / world.clock.dt;
  walker->held_up = 0;
  const double yaw = std::hypot(dx, dy) > kThere ? std::atan2(dy, dx) : model.pose.Yaw();
  put(world, model, Pose(at.X() + part * dx, at.Y() + part * dy, at.Z(), 0, 0, yaw));
  if (part == 1) arrive(walker);
}

void advanceWalker(ContactView& world, Walker* walker) {
  walker->vx = walker->vy = 0;
  if (walker->pause > 0) {
    walker->pause -= world.clock.dt;
    return;
  }
  if (!walker->walks()) return;
  const PathPoint to = walker->target();
  if (world.clock.total_steps >= walker->look_at) {
    walker->is_free = isFreeAhead(world, *walker, world.models[walker->model]->pose, to);
    walker->look_at = world.clock.total_steps + world.clock.stepsIn(kLook);
  }
  if (walker->is_free) return stepTowards(world, walker, to);
  waitOrDetour(world, walker);
}

}  // namespace

void walk(RobotView& world, People& people, const std::string& person, const Walk& walk) {
  const Model* model = world.models.find(person);
  if (!model) throw std::invalid_argument("there is no model '" + person + "'");
  if (!isPerson(*model)) refuse(person, "it is not a person");
  checkOnFloor(world, walk, person);
  startWalk(world.fleet, &walkerOf(people, *model), walk);
}

void beginScript(RobotView& world, People& people, int model, const Walk& script) {
  Walker& walker = walkerOf(people, *world.models[model]);
  walker.script = script;
  startWalk(world.fleet, &walker, script);
}

void restartScripts(FleetState& fleet, People& people) {
  auto& walkers = people.walkers;
  const auto has_none = [](const Walker& walker) { return !walker.script; };
  walkers.erase(std::remove_if(walkers.begin(), walkers.end(), has_none), walkers.end());
  for (Walker& walker : walkers) startWalk(fleet, &walker, *walker.script);
}

void stepPeople(ContactView& world, People& people) {
  for (Walker& walker : people.walkers) advanceWalker(world, &walker);
}

std::vector<Person> listPeople(const Scene& world) {
  std::vector<Person> people;
  for (const Walker& walker : world.people.walkers) {
    const Model& model = *world.models[walker.model];
    Person person{model.name, model.pose.X(), model.pose.Y(), model.pose.Yaw(),
                  walker.vx,  walker.vy,      model.pose.X(), model.pose.Y()};
    if (walker.pause <= 0 && walker.walks()) {
      const PathPoint to = walker.target();
      const double way = walker.walk.waypoints[walker.next].speed * kForesight;
      const double part = partOf(way, to.x - person.x, to.y - person.y);
      person.ahead_x += part * (to.x - person.x);
      person.ahead_y += part * (to.y - person.y);
    }
    people.push_back(person);
  }
  return people;
}

}  // namespace kiva
