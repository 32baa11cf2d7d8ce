// SPDX-License-Identifier: Apache-2.0
//
// A warehouse in turmoil: models are added and removed, robots are commanded, moved and reset, all
// at random. All references must stay valid, and every command must end.
#include <algorithm>
#include <random>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr int kRobots = 8, kUnits = 8, kItems = 16;

// --- what has to be true at any time

void checkModels(const WorldState& parts) {
  for (std::size_t slot = 0; slot < parts.models.size(); ++slot) {
    if (!parts.models[slot]) continue;
    const Model& model = *parts.models[slot];
    ASSERT_EQ(parts.models.slot_of_name.at(model.name), static_cast<int>(slot));
    const bool listed =
        std::count(parts.models.activated.begin(), parts.models.activated.end(), slot) == 1;
    const bool by_nature = model.kind == ModelKind::kRobot || model.kind == ModelKind::kStorageUnit;
    ASSERT_TRUE(!by_nature || model.in_physics == listed) << model.name;
    ASSERT_EQ(model.in_physics, !model.bodies.links.empty()) << model.name;
  }
  for (const auto* slots :
       {&parts.models.bodies, &parts.models.activated, &parts.models.with_plugins}) {
    for (int slot : *slots) ASSERT_TRUE(parts.models.slots.at(slot));
  }
}

void checkRobots(const WorldState& parts) {
  const FleetState& f = parts.fleet;
  for (int i = 0; i < f.size(); ++i) {
    const Robot& r = f.robots[i];
    ASSERT_EQ(f.find(r.id), i);
    ASSERT_EQ(parts.models.slots.at(r.model)->name, r.name);
    ASSERT_EQ(parts.models[r.model]->index, i);
    ASSERT_EQ(parts.models[r.model]->in_physics, f.activated[i] != 0);
    ASSERT_FALSE(parts.obstacles.footprints(i).empty());
    for (const Footprint& footprint : parts.obstacles.footprints(i)) {
      ASSERT_EQ(footprint.group, i);
      const bool own = footprint.model == r.model;
      ASSERT_TRUE(own ||
                  (f.unit[i] >= 0 && footprint.model == parts.storage.units[f.unit[i]].model));
    }
    for (const MotionSegment& segment : f.tasks[i].segments)
      ASSERT_LT(segment.unit, static_cast<int>(parts.storage.units.size()));
    ASSERT_EQ(f.tasks[i].segments.empty(), f.status[i] == Status::kIdle) << r.name;
    ASSERT_TRUE(std::isfinite(f.x[i] + f.y[i] + f.yaw[i] + f.vx[i] + f.vy[i]));
    if (f.unit[i] < 0) {
      ASSERT_EQ(r.load_mass, 0);
      ASSERT_TRUE(f.awake[i] || f.tower[i] == 0) << r.name;
    } else {
      ASSERT_EQ(parts.storage.units.at(f.unit[i]).carrier, i);
      ASSERT_NEAR(r.load_mass, parts.storage.units[f.unit[i]].mass, 1e-9);
    }
  }
}

void checkUnits(const WorldState& parts) {
  ASSERT_EQ(parts.storage.units.size(), parts.storage.unit_of_id.size());
  std::vector<double> masses(parts.storage.units.size(), 60);
  for (const Item& item : parts.storage.items) {
    ASSERT_LT(item.unit, static_cast<int>(parts.storage.units.size()));
    if (item.unit >= 0) masses[item.unit] += item.mass;
    ASSERT_EQ(parts.models.slots.at(item.model)->name, item.name);
  }
  for (std::size_t u = 0; u < parts.storage.units.size(); ++u) {
    const StorageUnit& unit = parts.storage.units[u];
    ASSERT_EQ(parts.storage.unit_of_id.at(unit.id), static_cast<int>(u));
    ASSERT_EQ(parts.models.slots.at(unit.model)->index, static_cast<int>(u));
    ASSERT_NEAR(unit.mass, masses[u], 1e-9) << unit.name;
    ASSERT_TRUE(unit.carrier < 0 || parts.fleet.unit.at(unit.carrier) == static_cast<int>(u));
    for (const CollisionGeometry& o : parts.models[unit.model]->geometries) {
      ASSERT_EQ(o.handle < 0, unit.carrier >= 0) << unit.name;
    }
    if (unit.claimed_by < 0) continue;
    const auto& segments = parts.fleet.tasks.at(unit.claimed_by).segments;
    ASSERT_TRUE(std::any_of(segments.begin(), segments.end(),
                            [u](const MotionSegment& segment) {
                              return segment.kind == MotionSegment::Kind::kRaise &&
                                     segment.unit == static_cast<int>(u);
                            }))
        << unit.name << " is claimed for nothing";
  }
}

void check(const Warehouse& w) {
  checkModels(insideOf(w.world));
  checkRobots(insideOf(w.world));
  checkUnits(insideOf(w.world));
}

// --- turmoil

class Churn : public ::testing::TestWithParam<int> {
 protected:
  int any(int count) { return static_cast<int>(random_() % count); }
  int cell() { return any(11) - 5; }

  void spawn(const std::string& kind, int id) {
    const std::string name = kind + std::to_string(id);
    if (w_.world.has(name)) return;
    if (kind == "item" && !w_.world.storageUnits().empty()) {
      const int unit = any(static_cast<int>(w_.world.storageUnits().size()));
      const Pose pose = w_.world.storageUnitPose(unit) * Pose(0.1, 0.1, 0.5, 0, 0, 0);
      w_.world.spawn(instance(texts_.at(kind), name, pose));
    } else {
      const Pose pose(cell(), cell(), 0, 0, 0, any(4) * kQuarter);
      if (isFree(pose, kind)) w_.world.spawn(instance(texts_.at(kind), name, pose));
    }
  }
  /// Robots begin clear of each other; a unit may come over one.
  bool isFree(const Pose& pose, const std::string& kind) const {
    const auto near = [&](const Pose& other) { return (other.Pos() - pose.Pos()).Length() < 0.95; };
    for (int i = 0; i < w_.world.fleet().size(); ++i) {
      if (kind == "kiva" && near(w_.world.basePose(i))) return false;
      if (w_.world.fleet().unit[i] >= 0 && near(w_.world.basePose(i))) return false;
    }
    for (std::size_t u = 0; u < w_.world.storageUnits().size(); ++u) {
      if (kind == "storage_unit" && near(w_.world.storageUnitPose(static_cast<int>(u))))
        return false;
    }
    return true;
  }

  void spawnAny() {
    switch (any(4)) {
      case 0:
        return spawn("kiva", 1 + any(kRobots));
      case 1:
        return spawn("storage_unit", 1 + any(kUnits));
      default:
        return spawn("item", 1 + any(kItems));
    }
  }
  void removeAny() {
    const std::vector<std::string> names = w_.world.modelNames();
    const std::string& name = names[any(static_cast<int>(names.size()))];
    if (name != "ground_plane" && !contains(name, "wall")) w_.world.remove(name);
  }
  void commandAny() {
    const int id = 1 + any(kRobots);
    switch (any(6)) {
      case 0:
        return w_.mov(id, cell(), cell());
      case 1:
        return w_.rot(id, any(2) ? kLeft : kRight);
      default:
        return serve(id);
    }
  }
  /// Drives a robot to a unit, lifts it, drives away and puts it down: a robot's daily work.
  void serve(int id) {
    const Fleet& f = w_.world.fleet();
    const int robot = f.find(id);
    if (robot < 0 || w_.world.storageUnits().empty()) return;
    if (f.unit[robot] >= 0) {
      const int shelf = w_.world.storageUnits()[f.unit[robot]].id;
      return any(2) ? w_.drop(id, shelf) : w_.mov(id, cell(), cell());
    }
    for (std::size_t u = 0; u < w_.world.storageUnits().size(); ++u) {
      const Vector3 way = w_.world.storageUnitPose(u).Pos() - w_.world.basePose(robot).Pos();
      if (way.Length() < 0.05) return w_.carry(id, w_.world.storageUnits()[u].id);
    }
    const int unit = any(static_cast<int>(w_.world.storageUnits().size()));
    const Vector3 goal = w_.world.storageUnitPose(unit).Pos();
    w_.mov(id, std::round(goal.X()), std::round(goal.Y()));
  }
  void moveAny() {
    const std::vector<std::string> names = w_.world.modelNames();
    const std::string& name = names[any(static_cast<int>(names.size()))];
    if (name == "ground_plane" || contains(name, "wall")) return;
    const Pose pose(cell(), cell(), 0, 0, 0, any(4) * kQuarter);
    const std::string kind = contains(name, "kiva") ? "kiva" : "storage_unit";
    if (isFree(pose, kind)) w_.world.setState(name, {pose, {}});
  }
  void anything() {
    const int choice = any(1000);
    if (choice < 200) return spawnAny();
    if (choice < 260) return removeAny();
    if (choice < 280) return moveAny();
    if (choice < 282) return w_.world.reset(choice == 281);
    commandAny();
  }

  std::mt19937 random_{static_cast<unsigned>(GetParam())};
  const std::map<std::string, std::string> texts_{{"kiva", modelText("kiva")},
                                                  {"storage_unit", modelText("storage_unit")},
                                                  {"item", modelText("item")}};
  Warehouse w_{"hall.sdf"};
};

TEST_P(Churn, LeavesNothingStaleAndNobodyBusy) {
  for (int round = 0; round < 800; ++round) {
    anything();
    w_.run(0.001 * any(500));
    check(w_);
    if (HasFatalFailure()) FAIL() << "in round " << round;
  }
  EXPECT_GT(w_.count(Kind::kDeleted), 20);
  EXPECT_GT(w_.count(Kind::kLifted) + w_.count(Kind::kDropped), 5);
  w_.run(60);
  check(w_);
  for (const Robot& robot : w_.world.fleet().robots) {
    EXPECT_EQ(w_.status(robot.id), Status::kIdle) << robot.name;
    EXPECT_EQ(disorder(w_.kindsOf(robot.name)), "") << robot.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Churn, ::testing::Range(1, 4));

}  // namespace
}  // namespace kiva::test
