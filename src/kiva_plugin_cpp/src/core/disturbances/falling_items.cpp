// SPDX-License-Identifier: Apache-2.0
#include "core/disturbances/falling_items.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "core/geometry/footprint.h"
#include "core/models/items.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

constexpr double kClear = 0.002;   // [m] between a falling item and the edge
constexpr double kSlip = 0.001;    // [m/s]
constexpr double kWaits = 0.5;     // [s] that an item waits while its landing place is taken
constexpr double kUpright = 0.99;  // cosine of the largest tilt of a unit that keeps its items
constexpr double kNextTry =
    10;  // [s] between attempts to put items back on a unit that does not stand

/// Returns the friction of an item on its board, the same at each slide.
double frictionOf(const WorldSettings& settings, const Item& item) {
  const LoadRealism& r = settings.realism.loads;
  RandomStream random(settings.options.seed, Matter::kItem, item.id, 0);
  return r.item_friction_least + (r.item_friction_most - r.item_friction_least) * random.uniform();
}

/// Returns the distance from `at` to the boundary of `box` along `way`, a horizontal unit vector.
double wayOut(const Bounds& box, const Vector3& at, const Vector3& way) {
  const auto along = [](double from, double min, double max, double step) {
    return step == 0 ? 1e9 : ((step > 0 ? max : min) - from) / step;
  };
  return std::min(along(at.X(), box.min.X(), box.max.X(), way.X()),
                  along(at.Y(), box.min.Y(), box.max.Y(), way.Y()));
}

/// Calls visit(item) for the items at rest on that unit.
template <typename Visit>
void forEachOn(const Scene& world, const Model& unit, Visit visit) {
  const std::vector<int> on = world.storage.items_on[unit.index];  // visits may take some off
  for (const int index : on) {
    const Item& item = world.storage.items[index];
    if (item.unit == unit.index && !world.fallen.find(item.model)) visit(item);
  }
}

/// Slides items on a unit whose velocity suddenly changes by v: friction stops them after v² / 2 μ
/// g.
void slide(const Scene& world, FallenItems& fallen, const Jolt& jolt) {
  const Model& unit = *world.models[jolt.unit];
  Vector3 way = unitPose(world, unit.index).Rot().RotateVectorReverse(-jolt.change);
  way.Z() = 0;
  const double change = way.Length(), g = world.settings.gravityDown();
  if (change == 0 || g <= 0) return;
  way /= change;
  const Bounds box = bounds(*unit.description);
  forEachOn(world, unit, [&](const Item& item) {
    const double brake = frictionOf(world.settings, item) * g;
    const double left2 = change * change - 2 * brake * wayOut(box, item.pose_in_unit.Pos(), way);
    if (left2 <= 0) return;
    const double left = std::sqrt(left2);
    const double time = brake > 0 ? (change - left) / brake : 0;
    fallen.items.push_back({item.model, unit.slot, way * left, false,
                            world.clock.total_steps + world.clock.stepsIn(time)});
  });
}

/// Slides items over the lower edge of boards that are too steep for their friction.
void tilt(const Scene& world, FallenItems& fallen, const Model& unit) {
  Vector3 way = unitPose(world, unit.index).Rot().RotateVectorReverse(world.settings.gravity);
  const double down = -way.Z();
  way.Z() = 0;
  const double slope = way.Length();
  if (slope <= world.settings.realism.loads.item_friction_least * down) return;
  forEachOn(world, unit, [&](const Item& item) {
    if (slope <= frictionOf(world.settings, item) * down) return;
    fallen.items.push_back(
        {item.model, unit.slot, way / slope * kSlip, false, world.clock.total_steps});
  });
}

void tiltAll(const Scene& world, FallenItems& fallen) {
  for (const int slot : world.models.activated) {
    const Model& model = *world.models[slot];
    const bool may_lean = model.disturbed && !model.upright && model.owner->holdsItems();
    if (may_lean && isAwake(model)) tilt(world, fallen, model);
  }
}

/// Returns whether the place at that pose, above the floor, is free of models other than the item's
/// unit.
bool isFree(const Scene& world, const Model& item, const Pose& pose, int unit) {
  bool is_free = true;
  for (const Link& link : item.description->links) {
    for (const Collision& c : link.collisions) {
      const Footprint own = makeFootprint(c.shape, pose * link.pose_in_model * c.pose_in_link);
      is_free = is_free && own.z_min >= world.floor.extent.z;
      world.obstacles.near(own.x, own.y, radiusOf(own), [&](const Footprint& other) {
        if (other.model == unit || other.model == item.slot) return;
        is_free = is_free && (!shareHeight(own, other) || gap(own, other) >= 0);
      });
    }
  }
  return is_free;
}

/// Returns the pose just outside of the unit in the direction of sliding, in the unit's frame.
Pose outside(const Model& unit, const Model& item, const Pose& in_unit, const Vector3& way) {
  Bounds box = bounds(*unit.description);
  const Bounds own = bounds(*item.description, in_unit);
  const Vector3 centre = (own.min + own.max) / 2, half = (own.max - own.min) / 2;
  box.min -= half + Vector3(kClear, kClear, 0);
  box.max += half + Vector3(kClear, kClear, 0);
  return Pose(in_unit.Pos() + way * wayOut(box, centre, way), in_unit.Rot());
}

std::string placeOf(const Pose& pose) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.2f, %.2f)", pose.X(), pose.Y());
  return text;
}

/// Drops an item over the edge of its board. Returns false if its landing place is taken.
bool dropOverEdge(ModelView& world, OffShelf& off) {
  Model& item = *world.models[off.item];
  const Model& unit = *world.models[off.unit];
  const EntityState below = modelState(world, unit);
  const Pose pose = below.pose * outside(unit, item, world.storage.items[item.index].pose_in_unit,
                                         off.velocity.Normalized());
  if (!isFree(world, item, pose, unit.slot)) return false;
  EntityState state = carriedState(below, pose);
  state.twist.linear += below.pose.Rot() * off.velocity;
  fallOff(world, item, state);
  off.lies = true;
  const double until = world.settings.realism.loads.pick_up_after;
  off.due = until > 0 ? world.clock.total_steps + world.clock.stepsIn(until) : 0;
  world.log.report(Event::Kind::kFell, item.name, unit.name,
                   item.name + " falls off " + unit.name + " at " + placeOf(pose));
  return true;
}

bool isUpright(const Scene& world, const OffShelf& off) {
  const Model& unit = *world.models[off.unit];
  return unitPose(world, unit.index).Rot().ZAxis().Z() > kUpright;
}

/// Puts an item from the floor back into its place.
void lift(ModelView& world, const OffShelf& off) {
  Model& item = *world.models[off.item];
  const Model& unit = *world.models[off.unit];
  const std::string from = placeOf(modelState(world, item).pose);
  putBack(world, item, unit);
  world.log.report(Event::Kind::kPickedUp, item.name, unit.name,
                   item.name + " is picked up at " + from + " and is back on " + unit.name);
}

/// Performs the action that is due for one item. Returns whether the item is back, or stays where
/// it was.
bool attend(ModelView& world, OffShelf& off) {
  if (!off.lies) {
    if (off.due > world.clock.total_steps || dropOverEdge(world, off)) return false;
    return off.due + world.clock.stepsIn(kWaits) < world.clock.total_steps;
  }
  if (off.due == 0 || off.due > world.clock.total_steps) return false;
  if (!isUpright(world, off)) {
    off.due = world.clock.total_steps + world.clock.stepsIn(kNextTry);
    return false;
  }
  lift(world, off);
  return true;
}

}  // namespace

void stepFallingItems(ModelView& world) {
  if (!world.settings.realism.loads.enabled) return;
  for (const Jolt& jolt : world.contact_log.jolts) slide(world, world.fallen, jolt);
  world.contact_log.jolts.clear();
  tiltAll(world, world.fallen);
  auto& all = world.fallen.items;
  for (std::size_t i = 0; i < all.size();) {
    if (attend(world, all[i])) {
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

std::vector<FallenItem> listFallenItems(const Scene& world) {
  std::vector<FallenItem> out;
  for (const OffShelf& off : world.fallen.items) {
    if (!off.lies) continue;
    const Model& item = *world.models[off.item];
    out.push_back({item.name, world.models[off.unit]->name, modelState(world, item).pose});
  }
  return out;
}

void pickUp(ModelView& world, const std::string& item) {
  const Model* model = world.models.find(item);
  auto& all = world.fallen.items;
  const auto at = std::find_if(all.begin(), all.end(), [&](const OffShelf& off) {
    return model && off.lies && off.item == model->slot;
  });
  if (at == all.end()) {
    throw std::invalid_argument("no '" + item + "' has fallen off a storage unit");
  }
  if (!isUpright(world, *at)) {
    throw std::invalid_argument(item + " can't be put back: " + world.models[at->unit]->name +
                                " does not stand upright");
  }
  lift(world, *at);
  all.erase(at);
}

}  // namespace kiva
