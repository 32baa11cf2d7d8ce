// SPDX-License-Identifier: Apache-2.0
//
// Halls of other makers, in tests/worlds/halls: their models, the taken cells of their maps, and
// warnings. Parts that can't be loaded never count as free floor.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "kiva_plugin_cpp/look.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

using Strings = std::vector<std::string>;

const std::string kHalls = std::string(TESTS_DIR) + "/worlds/halls/";

/// A variable of the environment for as long as it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

/// A hall that was loaded as the node loads it.
struct LoadedHall {
  explicit LoadedHall(const std::string& file)
      : description(loadWorld(kHalls + file, paths(kHalls + file), &warnings)),
        world(description, {}),
        map(world.occupancy()) {}

  static ModelPaths paths(const std::string& file) {
    ModelPaths paths = environmentModelPaths();
    for (const std::string& path : modelPathsAround(file)) paths.push_back(path);
    paths.push_back(std::string(WORLDS_DIR) + "/models");
    return paths;
  }

  Strings names() const { return world.modelNames(); }

  bool isTaken(double x, double y) const {
    const int column = static_cast<int>(std::lround((x - map.x) / map.spacing));
    const int row = static_cast<int>(std::lround((y - map.y) / map.spacing));
    return map.cells.at(static_cast<std::size_t>(row) * map.columns + column) != Occupancy::kFree;
  }

  void expectTaken(const std::vector<std::pair<double, double>>& points) const {
    for (const auto& [x, y] : points) EXPECT_TRUE(isTaken(x, y)) << x << ", " << y;
  }
  void expectFree(const std::vector<std::pair<double, double>>& points) const {
    for (const auto& [x, y] : points) EXPECT_FALSE(isTaken(x, y)) << x << ", " << y;
  }
  /// Each of them is a part of one warning, and there are no others.
  void expectWarnings(const Strings& parts) const {
    EXPECT_EQ(warnings.size(), parts.size()) << testing::PrintToString(warnings);
    for (const std::string& part : parts) {
      const auto matches = [&](const std::string& w) { return w.find(part) != std::string::npos; };
      EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(), matches), 1) << part;
    }
  }

  Strings warnings;
  WorldDescription description;
  World world;
  Occupancy map;
};

TEST(Halls, MayBeCalledWorldAndNameMeshesByRelativeFiles) {
  LoadedHall hall("hospital/worlds/hospital.world");
  EXPECT_EQ(hall.world.name(), "world");
  EXPECT_EQ(hall.names(), (Strings{"ground_plane", "walls_01", "bed_01", "bed_02", "cabinet_01",
                                   "wheelchair_01"}));
  hall.expectTaken({{-12, 0}, {0, 10}, {0, -10}, {12, 5}});  // walls
  hall.expectFree({{12, 0}, {0, 0}, {-6, 0}});               // the door, rooms
  for (int i = 0; i < 1000; ++i) hall.world.step();
}

TEST(Halls, HaveWhatTheyShowWhereWhatTouchesIsMissing) {
  LoadedHall hall("hospital/worlds/hospital.world");
  hall.expectTaken({{-7, 5}, {-6, 5}, {-5, 5}, {-6, -6}, {-6, -5}, {-6, -4}});
  hall.expectFree({{-9, 5}, {-6, 7}});
  EXPECT_LT(hall.world.rayCast({-6, 0, 0.4}, M_PI / 2, 20), 4.6);
}

TEST(Halls, AreClosedWhereSomethingUnknownStands) {
  LoadedHall hall("hospital/worlds/hospital.world");
  hall.expectTaken({{6, 5}, {6, -5}});  // neither mesh, and no model
  hall.expectFree({{8, 5}, {6, -3}});
  EXPECT_NEAR(hall.world.rayCast({3, 5, 0.2}, 0, 20), 2.5, 1e-6);
  EXPECT_NEAR(hall.world.rayCast({3, -5, 0.2}, 0, 20), 2.5, 1e-6);
  hall.expectWarnings(
      {"hospital.world:27: world 'world.', model 'wheelchair_01', include/uri: this include is "
       "left "
       "out: found no model for 'model://hospital_wheelchair'; expected a folder of that name with "
       "a model.config in " +
           kHalls + "hospital/worlds",
       "hospital_bed/model.sdf:8: model 'hospital_bed', link 'link', collision 'collision', "
       "geometry/mesh: this collision is left out: there is no file "
       "'file://models/hospital_bed/meshes/bed_collision.DAE' in " +
           kHalls + "hospital/models/hospital_bed, ",
       "hospital_cabinet/model.sdf:8", "hospital_cabinet/model.sdf:11"});
}

TEST(Halls, OfOneMeshManyTimesKeepTheirFloor) {
  LoadedHall hall("small_house/worlds/small_house.world");
  EXPECT_EQ(hall.names().size(), 14u);
  hall.expectTaken({{-8, -6}, {2, -4}, {-1, 4}, {7, 5}});
  hall.expectFree({{-7, -6}, {0, 0}, {5, 3}});
  hall.expectWarnings({});  // lamp.dae is found as lamp.DAE
}

TEST(Halls, LieWhereResourcesDo) {
  const Variable resources("GAZEBO_RESOURCE_PATH", kHalls + "bookstore/media");
  LoadedHall hall("bookstore/worlds/bookstore.world");
  hall.expectWarnings({});
  hall.expectTaken({{-4, 3}, {3, 3}, {5, 3}, {0, -3}, {1, -3}});
  hall.expectFree({{0, 3}, {0, 0}});
}

TEST(Halls, WithoutTheirResourcesAreClosedWhereThoseWouldBe) {
  LoadedHall hall("bookstore/worlds/bookstore.world");
  EXPECT_EQ(hall.warnings.size(), 2u);  // three models are one
  hall.expectTaken({{-4, 3}, {4, 3}, {0, -3}});
}

TEST(Halls, OfACollectionThatIsNotAllThereAreClosedWhereItIsMissing) {
  const Variable models("GAZEBO_MODEL_PATH", std::string(TESTS_DIR) + "/worlds/models");
  LoadedHall hall("factory.world");
  EXPECT_EQ(hall.names(),
            (Strings{"ground_plane", "line_1", "line_2", "europallet", "cell", "shelf"}));
  hall.expectTaken({{5, 0}, {5, 6}, {-4, 0}, {1, 8}, {-2, 8}, {-8, 6}});
  hall.expectFree({{5, 3}, {-4, 2}, {-6, 0}});
  hall.expectWarnings({"factory.world:8: include", "factory.world:9: include",
                       "factory.world:10: include",
                       "factory.world:13: world 'factory', model 'cell'", "their_shelf/model.sdf:8",
                       "their_shelf/model.sdf:14"});
}

TEST(Halls, ThatGazeboSavedAreAsTheyWereAtTheEnd) {
  LoadedHall hall("saved.world");
  EXPECT_EQ(hall.names(), (Strings{"ground_plane", "column", "late"}));
  hall.expectTaken({{8, 8}, {-6, -6}});
  hall.expectFree({{1, 1}, {3, 3}});
  hall.expectWarnings({});
}

TEST(Halls, WithHillsAreClosedThere) {
  LoadedHall hall("terrain.world");
  EXPECT_EQ(hall.names(), (Strings{"ground_plane", "hill", "walker"}));
  hall.expectTaken({{10, 0}, {20, 0}, {15, 5}, {15, -5}, {15, 0}});
  hall.expectFree({{8, 0}, {15, 7}, {-8, 0}});
  hall.expectWarnings(
      {"collision 'collision', geometry/heightmap", "visual 'visual'", "actor 'walker'"});
}

TEST(Halls, MayComeAsUrdfWithTheirFloor) {
  LoadedHall hall("hall.urdf");
  EXPECT_EQ(hall.names(), Strings{"hall"});
  EXPECT_TRUE(hall.description.models.at(0).description->is_static);
  EXPECT_EQ(hall.map.columns, 29);
  hall.expectTaken({{-5, 11}, {4, 2}});
  hall.expectFree({{0, 0}, {-10, -8}});
  for (int i = 0; i < 100; ++i) hall.world.step();
  EXPECT_EQ(hall.world.state("hall")->pose, Pose::Zero);
}

TEST(Halls, OfMeshesLookAsTheyAreFromAbove) {
  const LoadedHall hall("hospital/worlds/hospital.world");
  const Look look = lookOf(*hall.world.description("walls_01"));
  const auto covers = [&](double x, double y) {
    for (std::size_t i = 0; i < look.shape_kind.size(); ++i) {
      const double* const at = &look.shape_pose[7 * i];
      const double* const size = &look.shape_size[3 * i];
      if (std::abs(x - at[0]) <= size[0] / 2 && std::abs(y - at[1]) <= size[1] / 2) return true;
    }
    return false;
  };
  EXPECT_TRUE(covers(0, 9.9) && covers(-11.9, 0) && covers(11.9, 5));
  EXPECT_FALSE(covers(0, 0) || covers(11.9, 0) || covers(5, 5));
  EXPECT_LT(look.shape_kind.size(), 40u);
}

}  // namespace
}  // namespace kiva::test
