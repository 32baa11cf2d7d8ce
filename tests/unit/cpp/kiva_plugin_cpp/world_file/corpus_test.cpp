// SPDX-License-Identifier: Apache-2.0
//
// Small worlds in tests/worlds/corpus, each with one feature of files made for Gazebo. Each loads
// and runs; every loss is reported with file and line; everything else is there.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "warehouse.h"

namespace kiva::test {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(TESTS_DIR) / "worlds" / "corpus";
const ModelPaths kPaths{std::string(WORLDS_DIR) + "/models",
                        std::string(TESTS_DIR) + "/worlds/models",
                        std::string(TESTS_DIR) + "/worlds"};

struct Expected {
  std::vector<std::string> models;
  std::vector<std::string> warnings;  ///< Parts of them, each of one.
};

const std::map<std::string, Expected> kWorlds = {
    {"actor_reference",
     {{"walker", "box"},
      {"actor 'walker'", "frame 'beside'", "model 'sign'", "link 'lamp'", "joint 'j'"}}},
    {"actors",
     {{"ground_plane", "walker", "standing", "somewhere", "box"},
      {"actor 'walker'", "actor 'standing'", "actor 'somewhere'"}}},
    {"faults",
     {{"hill", "ice", "broken", "ill_formed", "wrapped", "twice", "box"},
      {"collision 'terrain', geometry/heightmap", "visual 'terrain', geometry/heightmap",
       "ode/mu: this mu is left out", "ode/mu2: this mu2 is left out", "it is called 'c_2' here",
       "collision 'void': this collision is left out: expected a <uri>", "visual 'void'",
       "broken/model.sdf:6: model 'broken', link 'l', inertial/mass: this mass is left out",
       ":23: include: this include is left out: ",
       "model 'wrapped', include/uri: this include is left out: ", "model 'twice'",
       "model 'nowhere', pose: this model is left out", "light 'lamp'", "plugin 'p'"}}},
    {"joints",
     {{"chain"}, {"joint 'j_universal'", "'j_revolute2'", "joint 'j_screw'", "joint 'j_gearbox'"}}},
    {"materials", {{"painted"}, {}}},
    {"meshes",
     {{"whole", "part", "centred", "scaled", "absent"},
      {"holds no submesh 'arm'", "model 'absent': none of its collisions can be had"}}},
    {"model_in_model", {{"cart"}, {}}},
    {"nested_includes",
     {{"ground_plane", "shelf", "gone", "Forklift", "box"},
      {"'model://nowhere_to_be_found'", "their_shelf/model.sdf:8", "their_shelf/model.sdf:14",
       "'https://fuel.example.org"}}},
    {"population",
     {{"can_clone_0", "can_clone_1", "can_clone_2", "can_clone_3", "can_clone_4", "can_clone_5",
       "person_clone_0", "person_clone_1", "person_clone_2"},
      {}}},
    {"saved_world", {{"ground_plane", "box", "crate"}, {}}},
    {"sdf_1_3", {{"gate"}, {}}},
    {"sdf_1_4", {{"gate"}, {}}},
    {"sdf_1_5", {{"gate"}, {}}},
    {"sdf_1_6", {{"gate"}, {}}},
    {"sensors", {{"robot"}, {"sensor 'odd': this sensor is left out"}}},
};

WorldDescription load(const std::string& name, std::vector<std::string>* warnings = nullptr) {
  return loadWorld((kCorpus / (name + ".world")).string(), kPaths, warnings);
}

const ModelDescription& model(const WorldDescription& world, const std::string& name) {
  for (const ModelInstance& instance : world.models) {
    if (instance.name == name) return *instance.description;
  }
  throw std::out_of_range(name);
}

class Corpus : public testing::TestWithParam<std::string> {};

std::vector<std::string> names() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(kCorpus)) {
    if (entry.path().extension() == ".world") files.push_back(entry.path().stem().string());
  }
  return files;
}

INSTANTIATE_TEST_SUITE_P(Worlds, Corpus, testing::ValuesIn(names()),
                         [](const auto& param) { return param.param; });

TEST_P(Corpus, LoadsRunsAndTellsWhatItLost) {
  ASSERT_EQ(kWorlds.count(GetParam()), 1u) << "say what to expect of it";
  const Expected& expected = kWorlds.at(GetParam());
  std::vector<std::string> warnings, models;
  const WorldDescription description = load(GetParam(), &warnings);
  for (const ModelInstance& instance : description.models) models.push_back(instance.name);
  EXPECT_EQ(models, expected.models);
  EXPECT_EQ(warnings.size(), expected.warnings.size());
  for (const std::string& part : expected.warnings) {
    const auto matches = [&](const std::string& warning) { return contains(warning, part); };
    EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(), matches), 1) << part;
  }
  const std::regex address("/.*\\.(world|sdf):[0-9]+: .*");
  for (const std::string& warning : warnings)
    EXPECT_TRUE(std::regex_match(warning, address)) << warning;
  Warehouse w(description);
  w.run(0.1);
  EXPECT_EQ(w.world.modelNames(), expected.models);
}

TEST(CorpusDetails, ActorsStandAtTheirFirstWaypointsAsPeople) {
  const WorldDescription world = load("actors");
  EXPECT_EQ(world.models[1].pose.Pos(), Vector3(3, 2, 0));
  EXPECT_NEAR(world.models[1].pose.Yaw(), 1.5, 1e-12);
  EXPECT_EQ(world.models[2].pose, Pose(-3, 0, 0, 0, 0, 0));
  Warehouse w(world);
  EXPECT_NEAR(w.world.rayCast({1, 2, 0.2}, 0, 5), 1.8, 0.2);
}

TEST(CorpusDetails, FaultsCostNothingElse) {
  const WorldDescription world = load("faults");
  EXPECT_EQ(model(world, "hill").links[0].collisions.size(), 2u);
  const auto& ice = model(world, "ice").links[0].collisions;
  ASSERT_EQ(ice.size(), 2u);
  EXPECT_EQ(ice[0].friction, 1);
  EXPECT_EQ(ice[1].pose_in_link.Z(), 1);
  EXPECT_EQ(model(world, "wrapped").links[0].name, "own");
}

/// Well-formed, but nothing that can stand in a world: it is left out by the world, not its file.
TEST(CorpusDetails, MisfitsCostNothingElse) {
  const std::string box =
      "<link name='l'><collision name='c'><geometry><box><size>1 1 1</size></box></geometry>"
      "</collision></link>";
  const std::string text =
      "<sdf version='1.6'><world name='w'>\n"
      "<model name='a::b'>" +
      box +
      "</model>\n"
      "<model name='far'><pose>1e9 0 0 0 0 0</pose>" +
      box +
      "</model>\n"
      "<include><uri>model://kiva</uri></include>\n"
      "<model name='kiva7'><link name='l'/><plugin name='m' "
      "filename='libkiva_motion.so'/></model>\n"
      "<model name='kiva8'>" +
      box +
      "<plugin name='m' filename='libkiva_motion.so'>"
      "<sped>1</sped></plugin></model>\n"
      "<plugin name='g' filename='libkiva_grid.so'><spacing>0</spacing></plugin>\n"
      "<include><uri>model://kiva</uri><name>kiva1</name></include>\n"
      "<model name='box'><pose>9 0 0.5 0 0 0</pose>" +
      box + "</model></world></sdf>";
  Warehouse w(parseWorld(text, kPaths, "their.world"));
  EXPECT_EQ(w.world.modelNames(), (std::vector<std::string>{"kiva1", "box"}));
  EXPECT_EQ(w.world.gridSpacing(), 1);
  const char* const expected[] = {"model 'a::b': '::' can't be part of a name",
                                  "model 'far': its pose must be finite and within 100 km",
                                  "model 'kiva': a robot is called kiva<id>",
                                  "model 'kiva7': a robot needs a collision shape",
                                  "unknown parameter 'sped'",
                                  "their.world:7: world 'w', plugin 'g': parameter 'spacing'"};
  const std::vector<std::string> warnings = w.world.takeWarnings();
  ASSERT_EQ(warnings.size(), std::size(expected));
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    EXPECT_PRED2(contains, warnings[i], "left out: ");
    EXPECT_PRED2(contains, warnings[i], expected[i]);
  }
}

TEST(CorpusDetails, JointsWeKnowAreThere) {
  EXPECT_EQ(model(load("joints"), "chain").joints.size(), 5u);
  EXPECT_EQ(model(load("joints"), "chain").links.size(), 10u);
}

TEST(CorpusDetails, MeshesHaveTheirPartsAndScales) {
  const WorldDescription world = load("meshes");
  const auto size = [&](const std::string& name) {
    const Mesh& mesh = *model(world, name).links[0].collisions.at(0).shape.mesh;
    return std::pair(mesh.min, mesh.max);
  };
  const auto near = [](const std::pair<Vector3, Vector3>& box, const Vector3& min,
                       const Vector3& max) {
    return box.first.Distance(min) < 1e-6 && box.second.Distance(max) < 1e-6;
  };
  EXPECT_PRED3(near, size("whole"), Vector3(0, 0, 0), Vector3(1, 1, 4));
  EXPECT_PRED3(near, size("part"), Vector3(0, 0, 0), Vector3(0.5, 0.5, 3));
  EXPECT_PRED3(near, size("centred"), Vector3(-0.25, -0.25, -1.5), Vector3(0.25, 0.25, 1.5));
  EXPECT_PRED3(near, size("scaled"), Vector3(0, 0, -2), Vector3(2, 2, 0));
}

TEST(CorpusDetails, NestedModelsStandWhereTheirPosesSay) {
  const ModelDescription cart = model(load("model_in_model"), "cart");
  EXPECT_EQ(cart.findLink("arm::hand::palm")->pose_in_model.Pos(), Vector3(0, 0, 1.5));
  EXPECT_EQ(cart.joints.size(), 2u);
  const WorldDescription nested = load("nested_includes");
  EXPECT_EQ(model(nested, "shelf").links.at(0).pose_in_model.Z(), 1);
}

TEST(CorpusDetails, SavedStatesPlaceTheirModels) {
  EXPECT_EQ(load("saved_world").models[1].pose.Pos(), Vector3(4, -3, 0.5));
}

TEST(CorpusDetails, OldVersionsMeanTheSame) {
  for (const char* version : {"sdf_1_3", "sdf_1_4", "sdf_1_5", "sdf_1_6"}) {
    SCOPED_TRACE(version);
    const ModelDescription gate = model(load(version), "gate");
    ASSERT_EQ(gate.joints.size(), 1u);
    EXPECT_EQ(gate.joints[0].upper, 1);
    EXPECT_EQ(gate.joints[0].damping, 0.5);
    EXPECT_NEAR(gate.joints[0].axis_in_model.Distance({0, 0, 1}), 0, 1e-9);
    EXPECT_EQ(gate.links[1].mass, 3);
  }
}

TEST(CorpusDetails, SensorsAreKeptForTheirPlugins) {
  EXPECT_EQ(model(load("sensors"), "robot").sensors.size(), 10u);
}

TEST(CorpusDetails, RobotsOfUrdfComeWithWhatRosAddsToThem) {
  std::vector<std::string> warnings;
  const auto models =
      parseModels(fileText((kCorpus / "arm.urdf").string()), kPaths, "arm.urdf", &warnings);
  ASSERT_EQ(models.size(), 1u);
  const ModelDescription& arm = *models[0].description;
  EXPECT_EQ(arm.links.size(), 3u);
  EXPECT_NEAR(arm.links[0].collisions.at(0).friction, 0.2, 1e-9);
  ASSERT_TRUE(arm.findJoint("shoulder"));
  EXPECT_EQ(arm.findJoint("shoulder")->max_effort, 50);
  EXPECT_FALSE(arm.findLink("upper")->gravity);
  EXPECT_EQ(arm.sensors.size(), 1u);
  EXPECT_EQ(arm.plugins.size(), 1u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(contains, warnings[0], "there is no file");
}

TEST(ModelPaths, OfPackagesAreFoundByWhatTheyExport) {
  const fs::path root = fs::temp_directory_path() / ("packages_" + std::to_string(getpid()));
  const auto write = [&](const std::string& package, const std::string& exports) {
    fs::create_directories(root / package);
    std::ofstream(root / package / "package.xml")
        << "<package><name>p</name>" << exports << "</package>";
  };
  write("deep/er/world_pkg",
        "<export><gazebo_ros gazebo_model_path=\"${prefix}/models:/opt/m\" "
        "gazebo_media_path='${prefix}'/></export>");
  write("plain", "");
  write("plain/inside", "<export><gazebo_ros gazebo_model_path='${prefix}'/></export>");
  write("off", "<export><gazebo_ros gazebo_model_path='${prefix}'/></export>");
  std::ofstream(root / "off" / "CATKIN_IGNORE");
  write("broken", "<export>");
  EXPECT_EQ(exportedModelPaths("/nowhere:" + root.string()),
            (::kiva::ModelPaths{(root / "deep/er/world_pkg/models").string(), "/opt/m"}));
  fs::remove_all(root);
}

}  // namespace
}  // namespace kiva::test
