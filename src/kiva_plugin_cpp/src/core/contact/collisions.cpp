// SPDX-License-Identifier: Apache-2.0
#include "core/contact/collisions.h"

#include <algorithm>
#include <cmath>

#include "core/contact/upright.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kApart = 0.0005;  // [m]
constexpr double kForget = 0.1;    // [s]; a contact that returns within this time is the same one

// Durations of an impact [s]. An impact takes a few steps: Bullet first moves an approaching body
// to the surface, then stops it there, and may find only one contact point a step. An impact is
// over when no pair has approached for kQuiet. Contact that lasts longer than kImpact is a push.
constexpr double kQuiet = 0.002, kImpact = 0.01;
// Limits of an approach: a share of the initial speed, and a speed [m/s].
constexpr double kShare = 0.01, kNearing = 0.001;

int robotIn(const Scene& world, const Model& model) { return model.owner->robot(world, model); }

/// Returns whether one is an item that slides, or has fallen, off the other.
bool isFall(const FallenItems& fallen, const Contact& contact) {
  const auto is_off = [&](int item, int unit) {
    const OffShelf* off = fallen.find(item);
    return off && off->unit == unit;
  };
  return is_off(contact.model_a, contact.model_b) || is_off(contact.model_b, contact.model_a);
}

bool isCollision(const Scene& world, const Contact& contact) {
  const Model& a = *world.models[contact.model_a];
  const Model& b = *world.models[contact.model_b];
  if (a.owner->isFloor() || b.owner->isFloor()) return false;
  if (!a.owner->reportsCollisions() && !b.owner->reportsCollisions()) return false;
  const int robot = robotIn(world, a);
  return (robot < 0 || robot != robotIn(world, b)) && !isFall(world.fallen, contact);
}

bool areApart(const Scene& world, const TouchingPair& pair) {
  bool apart = true;
  forFootprints(world, pair.model_a, [&](const Footprint& a) {
    forFootprints(world, pair.model_b, [&](const Footprint& b) {
      if (shareHeight(a, b) && gap(a, b) < kApart) apart = false;
    });
  });
  return apart;
}

/// Notes that a robot in the contact must stop.
void noteCrash(const Scene& world, ContactLog& contact_log, const Model& model,
               const Model& other) {
  const int robot = robotIn(world, model);
  if (robot >= 0) contact_log.crashes.push_back({world.fleet.robots[robot].id, other.name});
}

/// Notes the change of velocity by an impact [Ns, in world] on a storage unit, or on the unit of a
/// robot.
void noteJolt(const Scene& world, ContactLog& contact_log, const Model& model,
              const Vector3& impulse) {
  const int robot = robotIn(world, model);
  if (robot >= 0 && world.fleet.unit[robot] >= 0) {
    const Robot& r = world.fleet.robots[robot];
    const int unit = world.storage.units[world.fleet.unit[robot]].model;
    contact_log.jolts.push_back({unit, impulse / (r.mass + r.load_mass)});
  } else if (model.owner->holdsItems()) {
    contact_log.jolts.push_back({model.slot, impulse / world.storage.units[model.index].mass});
  }
}

void noteJolts(const Scene& world, ContactLog& contact_log, const TouchingPair& pair) {
  if (!world.settings.realism.loads.enabled) return;
  const Vector3 impulse = pair.impact.normal * pair.impact.impulse;
  noteJolt(world, contact_log, *world.models[pair.model_a], impulse);
  noteJolt(world, contact_log, *world.models[pair.model_b], -impulse);
}

void publishCollision(const Scene& world, ContactLog& contact_log, EventLog& log,
                      TouchingPair* pair) {
  const Model* a = world.models[pair->model_a];
  const Model* b = world.models[pair->model_b];
  Impact impact = pair->impact;
  if (robotIn(world, *a) < 0) {
    std::swap(a, b);
    impact.normal = -impact.normal;
  }
  pair->report_at = 0;
  log.report(Event::Kind::kCollision, a->name, b->name, a->name + " touches " + b->name, impact);
  noteCrash(world, contact_log, *a, *b);
  noteCrash(world, contact_log, *b, *a);
}

void reportEnded(const Scene& world, ContactLog& contact_log, EventLog& log) {
  for (TouchingPair& pair : contact_log.touching) {
    if (pair.report_at == 0 || pair.report_at > world.clock.total_steps) continue;
    noteJolts(world, contact_log, pair);
    publishCollision(world, contact_log, log, &pair);
  }
}

TouchingPair& pairOf(const Scene& world, ContactLog& contact_log, const Contact& contact) {
  for (TouchingPair& pair : contact_log.touching) {
    if (pair.model_a == contact.model_a && pair.model_b == contact.model_b) return pair;
  }
  const Impact impact{contact.point, contact.normal, contact.speed, 0};
  const std::uint64_t now = world.clock.total_steps;
  contact_log.touching.push_back({contact.model_a, contact.model_b, now, impact,
                                  now + world.clock.stepsIn(kQuiet),
                                  now + world.clock.stepsIn(kImpact)});
  return contact_log.touching.back();
}

void touch(ContactView& world, const Contact& contact) {
  for (int slot : {contact.model_a, contact.model_b}) {
    world.models[slot]->owner->touched(world, *world.models[slot]);
  }
  TouchingPair& pair = pairOf(world, world.contact_log, contact);
  pair.last_step = world.clock.total_steps;
  if (pair.report_at == 0) return;
  pair.impact.impulse += contact.impulse;
  if (contact.nearing <= std::max(kNearing, kShare * pair.impact.speed)) return;
  pair.report_at =
      std::min(pair.report_latest, world.clock.total_steps + world.clock.stepsIn(kQuiet));
}

}  // namespace

void observeCollisions(ContactView& world) {
  if (world.models.activated.empty() && world.contact_log.touching.empty()) return;
  world.physics.contacts(&world.contact_log.contacts);
  for (const Contact& contact : world.contact_log.contacts) {
    if (isCollision(world, contact)) touch(world, contact);
  }
  rock(world, world.models);
  reportEnded(world, world.contact_log, world.log);
  const auto keep = world.clock.stepsIn(kForget);
  const auto over = [&](const TouchingPair& pair) {
    return pair.last_step + keep < world.clock.total_steps && areApart(world, pair);
  };
  world.contact_log.touching.erase(
      std::remove_if(world.contact_log.touching.begin(), world.contact_log.touching.end(), over),
      world.contact_log.touching.end());
}

void forgetContacts(const Scene& world, ContactLog& contact_log, EventLog& log, int slot) {
  const auto has = [slot](const TouchingPair& pair) {
    return slot < 0 || pair.model_a == slot || pair.model_b == slot;
  };
  for (TouchingPair& pair : contact_log.touching) {
    if (has(pair) && pair.report_at > 0) publishCollision(world, contact_log, log, &pair);
  }
  contact_log.touching.erase(
      std::remove_if(contact_log.touching.begin(), contact_log.touching.end(), has),
      contact_log.touching.end());
}

}  // namespace kiva
