// SPDX-License-Identifier: Apache-2.0
#include "collisions.h"

#include <algorithm>
#include <cmath>

#include "commands.h"
#include "models.h"

namespace kiva {
namespace {

constexpr double kApart = 0.0005;  // [m]
constexpr double kForget = 0.1;    // [s]: a contact that returns within is the same one

// An impact takes a few steps: Bullet first brings a body that comes near to where it touches, then
// stops it there, and may find only one point of contact a step. It is over when none has neared
// for a while; what goes on for longer than an impact is a push [s].
constexpr double kQuiet = 0.002, kImpact = 0.01;
// What counts as nearing: a share of the speed at first, and at least so much [m/s].
constexpr double kShare = 0.01, kNearing = 0.001;

std::uint64_t stepsIn(const Parts& parts, double seconds) {
  return static_cast<std::uint64_t>(std::ceil(seconds / parts.dt));
}

bool isHandled(const Model& model) {
  return model.kind == ModelKind::kRobot || model.kind == ModelKind::kStorageUnit;
}

/// The robot that is in that contact: the model itself, or who carries it. -1 = none.
int robotIn(const Parts& parts, const Model& model) {
  if (model.kind == ModelKind::kRobot) return model.index;
  if (model.kind == ModelKind::kStorageUnit) return parts.units[model.index].carrier;
  return -1;
}

bool isCollision(const Parts& parts, const Contact& contact) {
  const Model& a = *parts.models[contact.model_a];
  const Model& b = *parts.models[contact.model_b];
  if (a.kind == ModelKind::kFloor || b.kind == ModelKind::kFloor) return false;
  if (!isHandled(a) && !isHandled(b)) return false;
  const int robot_a = robotIn(parts, a);
  return robot_a < 0 || robot_a != robotIn(parts, b);
}

bool areApart(const Parts& parts, const TouchingPair& pair) {
  bool apart = true;
  forFootprints(parts, pair.model_a, [&](const Footprint& a) {
    forFootprints(parts, pair.model_b, [&](const Footprint& b) {
      const bool level = a.z_min <= b.z_max && b.z_min <= a.z_max;
      if (level && gap(a, b) < kApart) apart = false;
    });
  });
  return apart;
}

void halt(Parts& parts, const Model& model, const Model& other) {
  const int robot = robotIn(parts, model);
  if (robot >= 0) haltRobot(parts, robot, other.name, "collision with " + other.name);
}

void tell(Parts& parts, TouchingPair* pair) {
  const Model* a = parts.models[pair->model_a].get();
  const Model* b = parts.models[pair->model_b].get();
  Impact impact = pair->impact;
  if (robotIn(parts, *a) < 0) {
    std::swap(a, b);
    impact.normal = -impact.normal;
  }
  pair->tell_at = 0;
  parts.report(Event::Kind::kCollision, a->name, b->name, a->name + " touches " + b->name, impact);
  halt(parts, *a, *b);
  halt(parts, *b, *a);
}

void tellWhatIsOver(Parts& parts) {
  for (TouchingPair& pair : parts.touching) {
    if (pair.tell_at > 0 && pair.tell_at <= parts.total_steps) tell(parts, &pair);
  }
}

TouchingPair& pairOf(Parts& parts, const Contact& contact) {
  for (TouchingPair& pair : parts.touching) {
    if (pair.model_a == contact.model_a && pair.model_b == contact.model_b) return pair;
  }
  const Impact impact{contact.point, contact.normal, contact.speed, 0};
  const std::uint64_t now = parts.total_steps;
  parts.touching.push_back({contact.model_a, contact.model_b, now, impact,
                            now + stepsIn(parts, kQuiet), now + stepsIn(parts, kImpact)});
  return parts.touching.back();
}

void touch(Parts& parts, const Contact& contact) {
  for (int slot : {contact.model_a, contact.model_b}) {
    Model& model = *parts.models[slot];
    if (model.kind != ModelKind::kStorageUnit || parts.units[model.index].carrier >= 0) continue;
    if (!model.disturbed) {
      model.disturbed = true;  // from now on it is where its body is
      updateOutlines(parts, model);
    }
  }
  TouchingPair& pair = pairOf(parts, contact);
  pair.last_step = parts.total_steps;
  if (pair.tell_at == 0) return;
  pair.impact.impulse += contact.impulse;
  if (contact.nearing <= std::max(kNearing, kShare * pair.impact.speed)) return;
  pair.tell_at = std::min(pair.tell_latest, parts.total_steps + stepsIn(parts, kQuiet));
}

}  // namespace

void reportCollisions(Parts& parts) {
  if (parts.engaged.empty() && parts.touching.empty()) return;
  parts.physics.contacts(&parts.contacts);
  for (const Contact& contact : parts.contacts) {
    if (isCollision(parts, contact)) touch(parts, contact);
  }
  tellWhatIsOver(parts);
  const auto keep = stepsIn(parts, kForget);
  const auto over = [&](const TouchingPair& pair) {
    return pair.last_step + keep < parts.total_steps && areApart(parts, pair);
  };
  parts.touching.erase(std::remove_if(parts.touching.begin(), parts.touching.end(), over),
                       parts.touching.end());
}

void forgetContacts(Parts& parts, int slot) {
  const auto has = [slot](const TouchingPair& pair) {
    return slot < 0 || pair.model_a == slot || pair.model_b == slot;
  };
  for (TouchingPair& pair : parts.touching) {
    if (has(pair) && pair.tell_at > 0) tell(parts, &pair);
  }
  parts.touching.erase(std::remove_if(parts.touching.begin(), parts.touching.end(), has),
                       parts.touching.end());
}

}  // namespace kiva
