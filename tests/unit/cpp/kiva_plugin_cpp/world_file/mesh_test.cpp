// SPDX-License-Identifier: Apache-2.0
//
// Meshes and polylines: read at their size, touched where they are, seen by lasers.
#include <filesystem>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

namespace fs = std::filesystem;

const std::string kMeshes = std::string(TESTS_DIR) + "/worlds/meshes/";

std::string mesh(const std::string& uri, const std::string& inside = "") {
  return "<mesh><uri>" + uri + "</uri>" + inside + "</mesh>";
}

std::string fileUri(const std::string& file) { return "file://" + kMeshes + file; }

std::string model(const std::string& geometry, bool is_static = true) {
  return "<sdf version='1.9'><model name='m'><static>" + std::string(is_static ? "true" : "false") +
         "</static><link name='l'><inertial><pose>0.2 0.2 0.2 0 0 0</pose><mass>5</mass><inertia>"
         "<ixx>0.13</ixx><iyy>0.13</iyy><izz>0.13</izz></inertia></inertial><collision "
         "name='c'><geometry>" +
         geometry + "</geometry></collision></link></model></sdf>";
}

Shape shapeOf(const std::string& geometry, const ModelPaths& paths = {}) {
  return parseModels(model(geometry), paths, "text")
      .at(0)
      .description->links[0]
      .collisions.at(0)
      .shape;
}

void expectBox(const Shape& shape, const Vector3& min, const Vector3& max) {
  ASSERT_EQ(shape.kind, Shape::Kind::kMesh);
  EXPECT_LT(shape.mesh->min.Distance(min), 1e-6) << shape.mesh->min;
  EXPECT_LT(shape.mesh->max.Distance(max), 1e-6) << shape.mesh->max;
}

// --- files

TEST(Meshes, OfStlComeInMetresUnderUpperCaseNames) {
  const Shape shape = shapeOf(mesh(fileUri("CUBE.STL")));
  expectBox(shape, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(shape.mesh->vertices.size(), 8u);
  EXPECT_EQ(shape.mesh->triangles.size(), 12u);
}

TEST(Meshes, OfColladaHaveTheirUnitAndNodesButKeepTheirAxes) {
  expectBox(shapeOf(mesh(fileUri("crate.DAE"))), {0, 0, 1}, {2, 1, 1.5});
}

TEST(Meshes, OfWavefrontAreTakenWholeOrByPart) {
  expectBox(shapeOf(mesh(fileUri("room.obj"))), {-2.2, -2.2, 0}, {2.2, 2.2, 2});
  expectBox(shapeOf(mesh(fileUri("room.obj"), "<submesh><name>east_a</name></submesh>")),
            {2, -2, 0}, {2.2, -0.5, 2});
  expectBox(shapeOf(mesh(fileUri("room.obj"),
                         "<submesh><name>west</name><center>true</center></submesh>")),
            {-0.1, -2, -1}, {0.1, 2, 1});
}

TEST(Meshes, AreScaled) {
  expectBox(shapeOf(mesh(fileUri("CUBE.STL"), "<scale>2 3 -0.5</scale>")), {0, 0, -0.5}, {2, 3, 0});
}

TEST(Meshes, OfOneFileAreOne) {
  EXPECT_EQ(shapeOf(mesh(fileUri("CUBE.STL"))).mesh, shapeOf(mesh(fileUri("CUBE.STL"))).mesh);
}

TEST(Meshes, AreFoundInModelsPackagesAndBesideTheirWorld) {
  const ModelPaths paths{std::string(TESTS_DIR) + "/worlds"};
  for (const char* uri : {"model://meshes/CUBE.STL", "package://meshes/CUBE.STL"}) {
    expectBox(shapeOf(mesh(uri), paths), {0, 0, 0}, {1, 1, 1});
  }
  expectBox(shapeOf(mesh(kMeshes + "CUBE.STL")), {0, 0, 0}, {1, 1, 1});
  const std::string text = model(mesh("meshes/CUBE.STL"));
  const std::string world =
      replaced(replaced(text, "<model", "<world name='w'><model"), "</sdf>", "</world></sdf>");
  const auto beside = parseWorld(world, {}, std::string(TESTS_DIR) + "/worlds/text.sdf");
  EXPECT_EQ(beside.models.at(0).description->links[0].collisions.size(), 1u);
}

const std::string kBox = "; a box of 1 m by 1 m stands in for it, where nothing drives";

std::vector<std::string> warningsOf(const std::string& geometry) {
  std::vector<std::string> warnings;
  const auto models = parseModels(model(geometry), {}, "text", &warnings);
  const auto& collisions = models.at(0).description->links[0].collisions;
  EXPECT_EQ(collisions.size(), 1u);
  EXPECT_EQ(collisions.at(0).shape.size, Vector3(1, 1, 3));
  return warnings;
}

TEST(Meshes, ThatCantBeHadAreABoxAndAWarning) {
  const std::string at =
      "text:1: model 'm', link 'l', collision 'c', geometry/mesh: this collision is left out: ";
  EXPECT_EQ(warningsOf(mesh("model://nowhere/m.dae")),
            std::vector<std::string>{at +
                                     "there is no file 'model://nowhere/m.dae' in the model "
                                     "paths, which are empty" +
                                     kBox});
  EXPECT_EQ(warningsOf(mesh(fileUri("room.obj"), "<submesh><name>roof</name></submesh>")),
            std::vector<std::string>{at + "mesh " + kMeshes + "room.obj: holds no submesh 'roof'" +
                                     kBox});
  EXPECT_EQ(warningsOf(mesh("file://" + std::string(TESTS_DIR) + "/package.xml")),
            std::vector<std::string>{at + "mesh " + std::string(TESTS_DIR) +
                                     "/package.xml: meshes of the format '.xml' are not "
                                     "supported; expected .dae, .obj or .stl" +
                                     kBox});
  const fs::path broken =
      fs::temp_directory_path() / ("broken" + std::to_string(getpid()) + ".dae");
  std::ofstream(broken) << "<COLLADA><broken>";
  const auto warnings = warningsOf(mesh("file://" + broken.string()));
  fs::remove(broken);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(contains, warnings[0], "can't be read: ");
}

// --- polylines

const std::string kCorner =
    "<polyline><point>0 0</point><point>2 0</point><point>2 1</point><point>1 1</point>"
    "<point>1 2</point><point>0 2</point><height>1.5</height></polyline>";

double volumeOf(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.vertices[a].Dot(mesh.vertices[b].Cross(mesh.vertices[c])) / 6;
  }
  return sum;
}

TEST(Polylines, AreExtrudedFromTheFloorUp) {
  const Shape shape = shapeOf(kCorner);
  expectBox(shape, {0, 0, 0}, {2, 2, 1.5});
  EXPECT_NEAR(volumeOf(*shape.mesh), 3 * 1.5, 1e-12);
}

TEST(Polylines, MayGoEitherWayRoundAndBeClosed) {
  const std::string clockwise =
      "<polyline><point>0 0</point><point>0 1</point><point>1 1</point><point>1 0</point>"
      "<point>0 0</point><height>1</height></polyline>";
  EXPECT_NEAR(volumeOf(*shapeOf(clockwise).mesh), 1, 1e-12);
}

// --- what touches and is seen

TEST(StaticMeshes, AreSeenByRaysWhereTheyAre) {
  Warehouse w;
  w.spawnText(model(mesh(fileUri("room.obj")), true), "room", 3, 0);
  const auto range = [&](double x, double y, double yaw) {
    return w.world.rayCast({x, y, 0.2}, yaw, 20);
  };
  EXPECT_NEAR(range(3, 0, kQuarter), 2, 1e-6);                         // within, the north wall
  EXPECT_NEAR(range(3, 1, 0), 2, 1e-6);                                // the east wall
  EXPECT_EQ(range(3, 0, 0), std::numeric_limits<double>::infinity());  // through the door
  EXPECT_NEAR(range(-1, 0.3, 0), 1.8, 1e-6);  // from without, the west wall
  EXPECT_NEAR(range(2, 0, -kQuarter / 2), 2 * std::sqrt(2), 1e-6);
  EXPECT_EQ(w.world.rayCast({3, 0, 2.5}, 0, 20), std::numeric_limits<double>::infinity());
}

TEST(StaticMeshes, CatchWhatFallsOnThemAndHoldItIn) {
  Warehouse w;
  w.spawnText(model(mesh(fileUri("CUBE.STL")), true), "cube", 0, 0);
  w.spawnText(modelText("item"), "item1", 0.5, 0.5, 0, 1.3);
  w.run(3);
  EXPECT_NEAR(w.world.state("item1")->pose.Z(), 1.0, 0.005);
  EXPECT_LT(w.world.state("item1")->twist.linear.Length(), 1e-3);
}

TEST(StaticMeshes, StopRobotsAndLetThemThroughTheirDoors) {
  Warehouse w;
  w.spawnText(model(mesh(fileUri("room.obj")), true), "room", 4, 0);
  w.spawn("kiva", "kiva1", 4, 0);
  w.movx(1, -3);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 3, 0.01);  // a grid point before the wall
  w.movx(1, 5);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), 8, 0.01);
}

TEST(StaticMeshes, CostNothingWhereNobodyIs) {
  Warehouse w;
  w.spawnText(model(mesh(fileUri("room.obj")), true), "room", 4, 0);
  w.spawn("kiva", "kiva1", 4, 0);
  w.run(0.1);
  EXPECT_FALSE(insideOf(w.world).fleet.activated[0]);
}

TEST(DynamicMeshes, FallAndLieAsTheirHulls) {
  Warehouse w;
  w.spawnText(model(mesh(fileUri("CUBE.STL"), "<scale>0.4 0.4 0.4</scale>"), false), "cube", 2, 2,
              0, 0.5);
  w.run(3);
  const Pose pose = w.world.state("cube")->pose;
  EXPECT_NEAR(pose.Z(), 0, 0.005);
  EXPECT_NEAR(pose.X(), 2, 0.01);
  EXPECT_NEAR(w.world.rayCast({0, 2.2, 0.2}, 0, 5), 2, 0.01);
}

TEST(DynamicMeshes, AreCaughtByStaticOnes) {
  Warehouse w;
  w.spawnText(model(mesh(fileUri("CUBE.STL")), true), "table", 0, 0);
  w.spawnText(model(mesh(fileUri("CUBE.STL"), "<scale>0.4 0.4 0.4</scale>"), false), "cube", 0.3,
              0.3, 0, 1.2);
  w.run(3);
  EXPECT_NEAR(w.world.state("cube")->pose.Z(), 1, 0.005);
}

}  // namespace
}  // namespace kiva::test
