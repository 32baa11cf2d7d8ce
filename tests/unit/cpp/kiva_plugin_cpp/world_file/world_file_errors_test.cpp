// SPDX-License-Identifier: Apache-2.0
//
// One broken file for each rule, in tests/worlds, with its message.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "kiva_plugin_cpp/world_file.h"
#include "warehouse.h"

namespace kiva {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(TESTS_DIR) / "worlds";
const std::string kModels = std::string(WORLDS_DIR) + "/models";
const std::string kBrokenModels = (kFolder / "models").string();
const ModelPaths kPaths{kModels, kBrokenModels};

std::string errorOf(const std::string& path) {
  try {
    loadWorld(path, kPaths);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "no error";
}

std::vector<std::string> warningsOf(const std::string& path) {
  std::vector<std::string> warnings;
  loadWorld(path, kPaths, &warnings);
  return warnings;
}

const std::string kLink = " world 'w', model 'm', link 'l'";
const std::string kGeometry = kLink + ", collision 'c', geometry";
const std::string kJoint = " world 'w', model 'm', joint 'j'";
const std::string kShapes =
    "expected box, sphere, cylinder, capsule, ellipsoid, plane, polyline, mesh";
const std::string kNoBody =
    ": no body has this inertia; expected finite principal moments above 0 kg m², none larger than "
    "the sum of the other two; this link has 1 kg m² instead";
const std::string kNowhere =
    ": this include is left out: found no model for 'model://nowhere'; expected a folder of that "
    "name with a model.config "
    "in " +
    kModels + ", " + kBrokenModels;

/// What follows the file's name, line and all: nothing would be left of these.
const std::map<std::string, std::string> kErrors = {
    {"empty", ": the XML is ill-formed: empty document"},
    {"no_version", ":3: expected <sdf version=\"…\"> as the root element, found no version"},
    {"no_world", ": expected a <world> in <sdf>, or a URDF <robot>"},
    {"root", ":3: expected <sdf version=\"…\"> as the root element, found <warehouse>"},
    {"two_models", ": expected a <world> in <sdf>, or a URDF <robot>"},
    {"two_worlds", ":3: expected one <world>, found several"},
    {"version", ":3: SDF version '3.3' is unknown; expected 1.0 to 1.11"},
    {"xml", ":6: the XML is ill-formed: mismatched element (XMLElement name=link)"},
};

const std::string kCube =
    ":5: world 'w', model 'm': none of its collisions can be had; a cube of 1 m stands in for them";
const std::string kKilogram = "; this link has 1 kg and 1 kg m² instead";
const std::string kNoCollision = ": this collision is left out: ";
const std::string kNoJoint = ": this joint is left out: ";
const std::string kNoModel =
    ":5: world 'w', model 'm': this model is left out: expected a <link> in <model>";

/// A fault that costs a part of the world and a warning, not the world: the number of models left,
/// and the warning.
struct Loss {
  std::size_t models;
  std::vector<std::string> warnings;
};
const std::map<std::string, Loss> kWarnings = {
    {"box_size",
     {1,
      {":9:" + kGeometry + "/box/size" + kNoCollision + "expected lengths above 0 m, found 1 0 1",
       kCube}}},
    {"duplicate_collision",
     {1, {":10:" + kLink + ", collision 'c': this name is taken; it is called 'c_2' here"}}},
    {"duplicate_include",
     {1,
      {":9: include: it is left out: the name 'item1' is taken; expected every <model> in <world> "
       "to have a name of its own"}}},
    {"duplicate_link",
     {1,
      {":7:" + kLink +
       ": this link is left out: this name is taken; expected every <link> in <model> to have a "
       "name of its own"}}},
    {"duplicate_model",
     {1,
      {":8: model: it is left out: the name 'm' is taken; expected every <model> in <world> to "
       "have a name of its own"}}},
    {"friction",
     {1,
      {":10:" + kLink +
       ", collision 'c', surface/friction/ode/mu: this mu is left out: The value [-1] is less than "
       "the minimum allowed value of [0] for key [mu]"}}},
    {"friction_bullet",
     {1,
      {":10:" + kLink +
       ", collision 'c', surface/friction/bullet/friction: this friction is left out: The value "
       "[-1] is less than the minimum allowed value of [0] for key [friction]"}}},
    {"geometry_empty",
     {1, {":8:" + kGeometry + kNoCollision + "expected a shape: " + kShapes.substr(9), kCube}}},
    {"geometry_missing",
     {1,
      {":7:" + kLink + ", collision 'c'" + kNoCollision + "expected <geometry> in <collision>",
       kCube}}},
    {"geometry_unknown",
     {1,
      {":9:" + kGeometry +
           "/prism: XML Element[prism], child of element[geometry], not defined in SDF",
       ":9:" + kGeometry + "/prism" + kNoCollision + "<prism> is not supported; " + kShapes,
       kCube}}},
    {"gravity",
     {0,
      {":5: world 'w', gravity: this gravity is left out: '0 0 down' is not a value for <gravity>; "
       "expected three numbers"}}},
    {"gravity_huge",
     {0,
      {":5: world 'w', gravity: this gravity is left out: expected a gravity of 1000 m/s² at "
       "most"}}},
    {"heightmap",
     {1,
      {":9:" + kGeometry + "/heightmap" + kNoCollision + "<heightmap> is not supported; " +
       kShapes + "; the box around it stands in for it"}}},
    {"include_missing",
     {2,
      {":5: include" + kNowhere + "; a box of 1 m by 1 m stands in for it, where nothing drives"}}},
    {"include_name",
     {0, {":6: world 'w', include/uri: this include is left out: expected a text in <name>"}}},
    {"include_pose",
     {0, {":7: world 'w', include/pose: this include is left out: Pose values must be finite"}}},
    {"include_uri",
     {0, {":6: world 'w', include/uri: this include is left out: expected a text in <uri>"}}},
    {"inertia", {1, {":8:" + kLink + ", inertial/inertia" + kNoBody}}},
    {"inertia_zero", {1, {":8:" + kLink + ", inertial/inertia" + kNoBody}}},
    {"joint_axis_missing", {1, {":8:" + kJoint + kNoJoint + "expected an <axis>"}}},
    {"joint_axis_zero",
     {1, {":8:" + kJoint + kNoJoint + "expected an axis that points somewhere"}}},
    {"joint_child", {1, {":8:" + kJoint + kNoJoint + "its child 'c' is not there"}}},
    {"joint_damping",
     {1, {":11:" + kJoint + ", axis" + kNoJoint + "expected a damping of 0 or above"}}},
    {"joint_expressed_in",
     {1, {":8:" + kJoint + kNoJoint + "its expressed_in 'nowhere' is not there"}}},
    {"joint_friction",
     {1, {":11:" + kJoint + ", axis" + kNoJoint + "expected a friction of 0 or above"}}},
    {"joint_limits",
     {1,
      {":11:" + kJoint + ", axis" + kNoJoint +
       "expected a lower limit at or below the upper one"}}},
    {"joint_type",
     {1,
      {":8:" + kJoint + kNoJoint +
       "joints of type 'screw' are not supported; expected fixed, revolute, continuous, prismatic "
       "or ball"}}},
    {"mass_nan",
     {1,
      {":8:" + kLink + ", inertial/mass: expected a mass above 0 kg, 1e9 at most, found nan" +
       kKilogram}}},
    {"mass_huge",
     {1,
      {":8:" + kLink + ", inertial/mass: expected a mass above 0 kg, 1e9 at most, found 1e308" +
       kKilogram}}},
    {"mass_negative",
     {1,
      {":8:" + kLink + ", inertial/mass: expected a mass above 0 kg, 1e9 at most, found -1" +
       kKilogram}}},
    {"mass_text",
     {1,
      {":8:" + kLink +
       ", inertial/mass: this mass is left out: 'heavy' is not a value for <mass>; expected a "
       "number"}}},
    {"mass_zero",
     {1,
      {":8:" + kLink + ", inertial/mass: expected a mass above 0 kg, 1e9 at most, found 0" +
       kKilogram}}},
    {"mesh",
     {1,
      {":9:" + kGeometry + "/mesh" + kNoCollision + "there is no file 'model://m/m.dae' in " +
           kModels + ", " + kBrokenModels,
       kCube}}},
    {"nested_include_missing", {1, {":8: world 'w', model 'm', include/uri" + kNowhere}}},
    {"no_link", {1, {kNoModel}}},
    {"no_name",
     {0,
      {":6: world 'w', model 'm', link: this link is left out: Required attribute[name] in "
       "element[link] is not specified in SDF",
       kNoModel}}},
    {"plane_normal",
     {1,
      {":9:" + kGeometry + "/plane/normal" + kNoCollision +
           "expected a normal that points somewhere",
       kCube}}},
    {"plane_size",
     {1,
      {":9:" + kGeometry + "/plane/size" + kNoCollision + "expected lengths above 0 m, found 1 0",
       kCube}}},
    {"plugin_filename",
     {0,
      {":5: world 'w', plugin 'p': this plugin is left out: Required attribute[filename] in "
       "element[plugin] is not specified in SDF"}}},
    {"polyline",
     {1,
      {":9:" + kGeometry + "/polyline" + kNoCollision +
           "expected three <point>s or more that span an area",
       kCube}}},
    {"population",
     {1,
      {":5: world 'w', population 'p': this population is left out: the distribution 'heap' is "
       "unknown; expected random, uniform, grid, linear-x, linear-y or linear-z"}}},
    {"pose_nan",
     {0, {":7:" + kLink + ", pose: this link is left out: Pose values must be finite", kNoModel}}},
    {"pose_short",
     {0,
      {":7:" + kLink +
           ", pose: this link is left out: The value for //pose[@rotation_format='euler_rpy'] must "
           "have 6 values, but 3 were found instead in '1 2 3'",
       kNoModel}}},
    {"radius_missing",
     {1,
      {":9:" + kGeometry + "/cylinder" + kNoCollision + "expected <radius> in <cylinder>", kCube}}},
    {"real_time_factor",
     {0,
      {":5: world 'w', physics 'p': this physics is left out: expected a real_time_factor of 0 or "
       "above"}}},
    {"relative_to",
     {0,
      {":6:" + kLink + ": this link is left out: its relative_to 'nowhere' is not there",
       kNoModel}}},
    {"reserved_name",
     {0,
      {":5: world 'w', model 'world': this model is left out: The supplied model name [world] is "
       "reserved"}}},
    {"restitution",
     {1,
      {":10:" + kLink +
       ", collision 'c', surface/bounce/restitution_coefficient: this restitution_coefficient is "
       "left out: The value [2] is greater than the maximum allowed value of [1] for key "
       "[restitution_coefficient]"}}},
    {"size_nan",
     {1,
      {":9:" + kGeometry + "/box/size" + kNoCollision +
       "'1 nan 1' is not a value for <size>; expected three numbers"}}},
    {"size_short",
     {1,
      {":9:" + kGeometry + "/box/size" + kNoCollision +
       "'1 1' is not a value for <size>; expected three numbers"}}},
    {"sphere_radius",
     {1,
      {":9:" + kGeometry + "/sphere/radius" + kNoCollision + "expected lengths above 0 m, found -1",
       kCube}}},
    {"static",
     {1,
      {":6: world 'w', model 'm', static: this static is left out: Invalid boolean value; expected "
       "true or false"}}},
    {"step_size",
     {0,
      {":5: world 'w', physics 'p': this physics is left out: expected a max_step_size from 1e-6 "
       "to 1 s"}}},
    {"step_size_infinite",
     {0,
      {":5: world 'w', physics 'p': this physics is left out: expected a max_step_size from 1e-6 "
       "to 1 s"}}},
    {"transparency",
     {1,
      {":8:" + kLink +
       ", visual 'v', transparency: this transparency is left out: expected a number from 0 to 1, "
       "found nan"}}},
    {"visual_mesh",
     {1,
      {":8:" + kLink +
       ", visual 'v', geometry/mesh: this visual is left out: there is no file 'model://m/m.dae' "
       "in " +
       kModels + ", " + kBrokenModels}}},
};

std::string pathOf(const std::string& rule) {
  return (kFolder / ("invalid_" + rule + ".sdf")).string();
}

TEST(WorldFileWarnings, NameFileLineEntityAndCause) {
  for (const auto& [rule, loss] : kWarnings) {
    const std::string path = pathOf(rule);
    std::vector<std::string> warnings, expected;
    EXPECT_EQ(loadWorld(path, kPaths, &warnings).models.size(), loss.models) << rule;
    for (const std::string& warning : loss.warnings) expected.push_back(path + warning);
    EXPECT_EQ(warnings, expected);
  }
}

TEST(WorldFileErrors, NameFileLineEntityAndCause) {
  for (const auto& [rule, message] : kErrors) {
    EXPECT_EQ(errorOf(pathOf(rule)), pathOf(rule) + message);
  }
}

TEST(WorldFileWarnings, NameTheFileOfTheModelThatIsIncluded) {
  EXPECT_EQ(warningsOf(pathOf("include_broken")),
            std::vector<std::string>{
                kBrokenModels + "/broken/model.sdf:6: model 'broken', link 'l', inertial/mass: "
                                "this mass is left out: 'heavy' is not a value for <mass>; "
                                "expected a number"});
}

TEST(WorldFileWarnings, NameWhatIsMissingHoweverDeepItIs) {
  const std::string path = (kFolder / "invalid_deep_include_missing.sdf").string();
  std::vector<std::string> warnings;
  EXPECT_EQ(loadWorld(path, kPaths, &warnings).models.size(), 2u);
  EXPECT_EQ(warnings, std::vector<std::string>{kBrokenModels +
                                               "/inner/model.sdf:7: model 'inner', "
                                               "include/uri" +
                                               kNowhere});
}

/// A robot whose sensor is in none of the folders drives without it.
TEST(WorldFileWarnings, NameTheJointThatHeldWhatIsMissing) {
  const std::string xml =
      "<sdf version='1.9'><world name='w'><model name='m'><link name='l'/>\n"
      "<include><uri>model://nowhere</uri><name>eye</name></include>\n"
      "<joint name='j' type='fixed'><parent>l</parent><child>eye::l</child></joint>\n"
      "</model></world></sdf>";
  std::vector<std::string> warnings;
  const WorldDescription world = parseWorld(xml, kPaths, "text", &warnings);
  ASSERT_EQ(world.models.size(), 1u);
  EXPECT_TRUE(world.models[0].description->joints.empty());
  EXPECT_EQ(warnings,
            (std::vector<std::string>{
                "text:2: world 'w', model 'm', include/uri" + kNowhere,
                "text:3: world 'w', model 'm', joint 'j': this joint is left out: its child "
                "'eye::l' is not there"}));
}

TEST(WorldFileWarnings, EndWhenTheMissingModelComes) {
  const fs::path folder = fs::temp_directory_path() / ("late_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string xml =
      "<sdf version='1.9'><model name='m'><link name='l'/><include><uri>model://late</uri>"
      "</include></model></sdf>";
  const auto nestedModels = [&] {
    return parseModels(xml, {folder.string()}, "text")[0].description->nested_models.size();
  };
  EXPECT_EQ(nestedModels(), 0u);
  fs::copy(fs::path(kModels) / "item", folder / "late", fs::copy_options::recursive);
  EXPECT_EQ(nestedModels(), 1u);
  fs::remove_all(folder);
}

TEST(WorldFileWarnings, NameTheModelConfigThatIsFaulty) {
  const fs::path folder = fs::temp_directory_path() / ("config_" + std::to_string(getpid()));
  fs::create_directories(folder / "m");
  std::ofstream(folder / "m" / "model.sdf")
      << "<sdf version='1.6'><model name='m'><link name='l'/></model></sdf>";
  const std::map<std::string, std::string> faults = {
      {"<model/>", "expected a <name>"},
      {"<model><sdf>model.sdf</sdf></model>", "expected a <name>"},
      {"<model><sdf version='1.6'/></model>", "expected a <name>"},
      {"<model><sdf version='99'>model.sdf</sdf></model>", "expected a <name>"},
      {"<model><name>m</name><sdf version='1.x'>model.sdf</sdf></model>", "'1.x' is not a number"},
      {"<model><sdf version='1.6'>model.sdf</sdf></model>", ""},
      {"<model><name>m</name><sdf>model.sdf</sdf></model>", ""}};
  const std::string include = "<include><uri>model://m</uri></include>";
  const std::string wrapped = "<model name='o'><link name='l'/>" + include + "</model>";
  for (const auto& [config, fault] : faults) {
    SCOPED_TRACE(config);
    std::ofstream(folder / "m" / "model.config") << config;
    for (const std::string& part : {include, wrapped}) {
      std::vector<std::string> warnings;
      parseWorld("<sdf version='1.6'><world name='w'>" + part + "</world></sdf>", {folder.string()},
                 "text", &warnings);
      if (fault.empty()) continue;
      ASSERT_EQ(warnings.size(), 1u);
      EXPECT_PRED2(test::contains, warnings[0], "m/model.config:1: ");
      EXPECT_PRED2(test::contains, warnings[0], fault);
    }
  }
  fs::remove_all(folder);
}

std::vector<std::string> warningsOfText(const std::string& xml) {
  std::vector<std::string> warnings;
  parseWorld(xml, kPaths, "text", &warnings);
  return warnings;
}

/// A model that is included may nest an include of its own that says nothing.
TEST(WorldFileWarnings, NameAnIncludeWithoutAUriInAModelThatIsIncluded) {
  const fs::path folder = fs::temp_directory_path() / ("blank_" + std::to_string(getpid()));
  fs::create_directories(folder / "m");
  std::ofstream(folder / "m" / "model.config")
      << "<model><name>m</name><sdf version='1.9'>model.sdf</sdf></model>";
  std::ofstream(folder / "m" / "model.sdf")
      << "<sdf version='1.9'><model name='m'><link name='l'/>\n<include/></model></sdf>";
  const std::string xml =
      "<sdf version='1.9'><world name='w'><model name='around'><link name='l'/>"
      "<include><uri>model://m</uri></include></model></world></sdf>";
  std::vector<std::string> warnings;
  parseWorld(xml, {folder.string()}, "text", &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(test::contains, warnings[0], "m/model.sdf:2: ");
  EXPECT_PRED2(test::contains, warnings[0], "expected a text in <uri>");
  fs::remove_all(folder);
}

TEST(WorldFileErrors, NameTheLineOfAUrdf) {
  const std::string urdf =
      "<robot name='r'>\n<link name='a'>\n<visual><origin xyz='1 2'/>\n"
      "<geometry><box size='a b c'/></geometry></visual></link></robot>";
  EXPECT_EQ(warningsOfText(urdf),
            (std::vector<std::string>{
                "text:3: robot 'r', link 'a', visual/origin: this xyz is left out: '1 2' is not "
                "a value for it; expected three numbers",
                "text:4: model 'r', link 'a', visual 'a_visual', geometry/box/size: this visual is "
                "left out: 'a b c' is not a value for <size>; expected three numbers"}));
}

TEST(WorldFileWarnings, AreNoneForAMeshBesideItsUrdf) {
  const std::string urdf =
      "<robot name='r'><link name='a'><collision><geometry><mesh filename='meshes/CUBE.STL'/>"
      "</geometry></collision></link></robot>";
  std::vector<std::string> warnings;
  parseWorld(urdf, {}, (kFolder / "text.urdf").string(), &warnings);
  EXPECT_EQ(warnings, std::vector<std::string>());
}

/// Entities of a document type are not read: none grows.
TEST(WorldFileErrors, LeaveEntitiesAsTheyAre) {
  std::string type = "<!DOCTYPE sdf [<!ENTITY a0 'lol'>";
  for (int i = 1; i < 10; ++i) {
    type += "<!ENTITY a" + std::to_string(i) + " '";
    for (int j = 0; j < 10; ++j) type += "&a" + std::to_string(i - 1) + ";";
    type += "'>";
  }
  const std::string xml = type + "]>\n<sdf version='1.9'><world name='w'><model name='m'>\n" +
                          "<pose>&a9;</pose><link name='l'/></model></world></sdf>";
  const std::vector<std::string> warnings = warningsOfText(xml);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(test::contains, warnings[0], "text:3: world 'w', model 'm', pose: ");
  EXPECT_PRED2(test::contains, warnings[0], "'&a9;' is not a value for <pose>");
}

/// Each fault costs itself alone, and no second look at the rest.
TEST(WorldFileWarnings, TakeNoLongerForEachFaultThanForAnother) {
  std::string xml = "<sdf version='1.9'><world name='w'>";
  constexpr std::size_t kFaults = 20000;
  for (std::size_t i = 0; i < kFaults; ++i) {
    xml += "<light name='l" + std::to_string(i) + "' type='point'><diffuse>red</diffuse></light>\n";
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(warningsOfText(xml + "</world></sdf>").size(), kFaults);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 10.0);  // Takes 0.3 s; minutes where each fault begins again.
}

/// Models that are each placed by the one before, in a world of many frames.
TEST(WorldFileWarnings, TakeNoLongSearchForFrames) {
  std::string xml = "<sdf version='1.9'><world name='w'>";
  for (int i = 0; i < 5000; ++i) xml += "<frame name='f" + std::to_string(i) + "'/>";
  for (int i = 0; i < 900; ++i) {
    const std::string before = i > 0 ? "m" + std::to_string(i - 1) : "f0";
    xml += "<model name='m" + std::to_string(i) + "'><pose relative_to='" + before +
           "'>1 0 0 0 0 0</pose><link name='l'/></model>";
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(warningsOfText(xml + "</world></sdf>"), std::vector<std::string>());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 15.0);  // Takes 1 s; a minute where each name is searched for.
}

TEST(WorldFileErrors, HaveAFixtureEach) {
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    const std::string name = entry.path().stem().string();
    if (name.compare(0, 8, "invalid_") != 0) continue;
    const std::string rule = name.substr(8);
    const bool has_its_own_test =
        rule == "include_broken" || rule == "deep_include_missing" || rule == "include_cycle";
    EXPECT_TRUE(has_its_own_test || kErrors.count(rule) || kWarnings.count(rule)) << name;
  }
}

TEST(WorldFileErrors, NameAFileThatCantBeRead) {
  const std::string missing = (kFolder / "nowhere.sdf").string();
  EXPECT_EQ(errorOf(missing), missing + ": can't read this file: No such file or directory");
  EXPECT_EQ(errorOf(kFolder.string()), kFolder.string() + ": can't read this file: is a folder");
}

TEST(WorldFileErrors, NameAModelThatIncludesItself) {
  const std::string path = (kFolder / "invalid_include_cycle.sdf").string();
  const std::vector<std::string> warnings = warningsOf(path);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("the model 'model://cycle_b' includes itself"), std::string::npos)
      << warnings[0];
}

TEST(WorldFileErrors, SayThatNoPathsWereGiven) {
  const std::string xml = "<sdf version='1.9'><include><uri>model://kiva</uri></include></sdf>";
  try {
    parseModels(xml, {}, "request");
    FAIL() << "no error";
  } catch (const DescriptionError& error) {
    EXPECT_STREQ(error.what(),
                 "request:1: include: this include is left out: found no model for 'model://kiva'; "
                 "expected a folder of that "
                 "name with a model.config in the model paths, which are empty");
  }
}

TEST(WorldFileWarnings, KeepTheirLineBehindIncludesThatWereTakenOut) {
  const std::string xml =
      "<sdf version='1.9'>\n<world name='w'>\n<include>\n<uri>model://item</uri>\n</include>\n"
      "<model name='m'>\n<link name='l'><inertial><mass>heavy</mass></inertial></link>\n</model>\n"
      "</world>\n</sdf>";
  std::vector<std::string> warnings;
  EXPECT_EQ(parseWorld(xml, kPaths, "text", &warnings).models.size(), 2u);
  EXPECT_EQ(warnings, std::vector<std::string>{
                          "text:7: world 'w', model 'm', link 'l', inertial/mass: this mass is "
                          "left out: 'heavy' is not a value for <mass>; expected a number"});
}

TEST(WorldFileWarnings, KnowNamesOfIncludesAndOfModelsBesideThem) {
  const std::string xml =
      "<sdf version='1.9'><world name='w'>\n<model name='m'><link name='l'/></model>\n"
      "<include><uri>model://item</uri><name>m</name></include></world></sdf>";
  std::vector<std::string> warnings;
  EXPECT_EQ(parseWorld(xml, kPaths, "text", &warnings).models.size(), 1u);
  EXPECT_EQ(warnings, std::vector<std::string>{
                          "text:3: include: it is left out: the name 'm' is taken; expected every "
                          "<model> in <world> to have a name of its own"});
}

/// std::regex, for one, overflows the stack on texts of this length.
TEST(WorldFileErrors, SurviveVeryLongTexts) {
  const std::string letters(1000000, 'x');
  const std::string model = "<model name='" + letters + "'>";
  for (const std::string& inside :
       {model + "</model>", model + "<link name='l'/>",
        "<model name='m'><link name='l'><pose relative_to='" + letters + "'/></link></model>",
        "<model name='m'>" + letters, "<include><uri>model://" + letters + "</uri></include>"}) {
    EXPECT_THROW(parseModels("<sdf version='1.9'>" + inside + "</sdf>", kPaths, "request"),
                 DescriptionError);
  }
}

TEST(WorldFileErrors, AreNotPrintedAsWell) {
  testing::internal::CaptureStderr();
  for (const char* rule : {"xml", "mass_text", "duplicate_model", "include_missing", "version"}) {
    errorOf((kFolder / ("invalid_" + std::string(rule) + ".sdf")).string());
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(WorldFileErrors, AreFoundAgainNextTime) {
  const std::string xml = "<sdf version='1.9'><model name='m'/></sdf>";
  for (int i = 0; i < 2; ++i) EXPECT_THROW(parseModels(xml, kPaths, "request"), DescriptionError);
}

}  // namespace
}  // namespace kiva
