// SPDX-License-Identifier: Apache-2.0
//
// One broken file a rule, in tests/worlds: what a person is told about it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <string>

#include "kiva_plugin_cpp/world_file.h"

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

std::string taken(const std::string& what, const std::string& in) {
  return " is taken; expected every <" + what + "> in <" + in + "> to have a name of its own";
}

/// What follows the file's name, line and all.
const std::map<std::string, std::string> kErrors = {
    {"box_size", ":9:" + kGeometry + "/box/size: expected lengths above 0 m, found 1 0 1"},
    {"duplicate_collision",
     ":10:" + kLink + ", collision 'c': this name" + taken("collision", "link")},
    {"duplicate_include", ":9: include: the name 'item1'" + taken("model", "world")},
    {"duplicate_link", ":7:" + kLink + ": this name" + taken("link", "model")},
    {"duplicate_model", ":8: model: the name 'm'" + taken("model", "world")},
    {"empty", ": the XML is ill-formed: empty document"},
    {"friction", ":10:" + kLink +
                     ", collision 'c', surface/friction/ode/mu: The value [-1] is less than the "
                     "minimum allowed value of [0] for key [mu]"},
    {"friction_bullet", ":10:" + kLink +
                            ", collision 'c', surface/friction/bullet/friction: The value [-1] is "
                            "less than the minimum allowed value of [0] for key [friction]"},
    {"geometry_empty", ":8:" + kGeometry + ": expected a shape: " + kShapes.substr(9)},
    {"geometry_missing", ":7:" + kLink + ", collision 'c': expected <geometry> in <collision>"},
    {"geometry_unknown", ":8:" + kGeometry + ": <prism> is not supported; " + kShapes},
    {"gravity",
     ":5: world 'w', gravity: '0 0 down' is no value for <gravity>; expected three "
     "numbers"},
    {"heightmap", ":9:" + kGeometry + "/heightmap: <heightmap> is not supported; " + kShapes},
    {"include_name", ":7: include: expected a text in <name>"},
    {"include_pose", ":7: pose: Pose values must be finite"},
    {"include_uri", ":6: include: expected a text in <uri>"},
    {"joint_axis_missing", ":8:" + kJoint + ": expected an <axis>"},
    {"joint_axis_zero", ":12:" + kJoint + ", axis/xyz: expected an axis that points somewhere"},
    {"joint_damping", ":11:" + kJoint + ", axis: expected a damping of 0 or above"},
    {"joint_expressed_in",
     ":11:" + kJoint +
         ", axis: PoseRelativeToGraph unable to find unique frame with name [nowhere] in graph"},
    {"joint_friction", ":11:" + kJoint + ", axis: expected a friction of 0 or above"},
    {"joint_limits", ":11:" + kJoint + ", axis: expected a lower limit at or below the upper one"},
    {"mass_text",
     ":8:" + kLink + ", inertial/mass: 'heavy' is no value for <mass>; expected a number"},
    {"no_name",
     ":6: world 'w', model 'm', link: Required attribute[name] in element[link] is not "
     "specified in SDF"},
    {"no_version", ": expected <sdf version=\"…\"> as the root element, found no version"},
    {"no_world", ": expected a <world> in <sdf>"},
    {"plane_normal", ":9:" + kGeometry + "/plane/normal: expected a normal that points somewhere"},
    {"plane_size", ":9:" + kGeometry + "/plane/size: expected lengths above 0 m, found 1 0"},
    {"plugin_filename",
     ":5: world 'w', plugin 'p': Required attribute[filename] in "
     "element[plugin] is not specified in SDF"},
    {"polyline",
     ":9:" + kGeometry + "/polyline: expected three <point>s or more that span an area"},
    {"pose_nan", ":7:" + kLink + ", pose: Pose values must be finite"},
    {"pose_short", ":7:" + kLink +
                       ", pose: The value for //pose[@rotation_format='euler_rpy'] must have 6 "
                       "values, but 3 were found instead in '1 2 3'"},
    {"radius_missing", ":9:" + kGeometry + "/cylinder: expected <radius> in <cylinder>"},
    {"real_time_factor", ":5: world 'w', physics 'p': expected a real_time_factor of 0 or above"},
    {"relative_to",
     ": relative_to name[nowhere] specified by link with name[l] does not match a nested model, "
     "link, joint, or frame name in model with name[m]"},
    {"reserved_name", ": The supplied model name [world] is reserved"},
    {"restitution", ":10:" + kLink +
                        ", collision 'c', surface/bounce/restitution_coefficient: The value [2] is "
                        "greater than the maximum allowed value of [1] for key "
                        "[restitution_coefficient]"},
    {"root", ": expected <sdf version=\"…\"> as the root element, found <warehouse>"},
    {"size_nan",
     ":9:" + kGeometry + "/box/size: '1 nan 1' is no value for <size>; expected three numbers"},
    {"size_short",
     ":9:" + kGeometry + "/box/size: '1 1' is no value for <size>; expected three numbers"},
    {"sphere_radius", ":9:" + kGeometry + "/sphere/radius: expected lengths above 0 m, found -1"},
    {"static", ":6: world 'w', model 'm', static: Invalid boolean value; expected true or false"},
    {"step_size", ":5: world 'w', physics 'p': expected a max_step_size above 0 s"},
    {"step_size_infinite", ":5: world 'w', physics 'p': expected a max_step_size above 0 s"},
    {"transparency",
     ":8:" + kLink + ", visual 'v', transparency: expected a number from 0 to 1, found nan"},
    {"two_models", ": Root object can only contain one model"},
    {"two_worlds", ":3: expected one <world>, found several"},
    {"version", ": SDF version 3.3 is unknown; expected 1.0 to 1.9"},
    {"xml", ":6: the XML is ill-formed: mismatched element (XMLElement name=link)"},
};

const std::string kKilogram = "; this link has 1 kg and 1 kg m² instead";

/// What costs a part of the world and a warning, not the world.
const std::map<std::string, std::string> kWarnings = {
    {"include_missing", ":5: include" + kNowhere},
    {"inertia", ":8:" + kLink + ", inertial/inertia" + kNoBody},
    {"inertia_zero", ":8:" + kLink + ", inertial/inertia" + kNoBody},
    {"joint_child", ":8:" + kJoint + ": this joint is left out: its child 'c' is not there"},
    {"joint_type", ":8:" + kJoint +
                       ": this joint is left out: joints of type 'screw' are not supported; "
                       "expected fixed, revolute, continuous, prismatic or ball"},
    {"mass_nan",
     ":8:" + kLink + ", inertial/mass: expected a mass above 0 kg, found nan" + kKilogram},
    {"mass_negative",
     ":8:" + kLink + ", inertial/mass: expected a mass above 0 kg, found -1" + kKilogram},
    {"mass_zero",
     ":8:" + kLink + ", inertial/mass: expected a mass above 0 kg, found 0" + kKilogram},
    {"mesh",
     ":9:" + kGeometry + "/mesh: this collision is left out: there is no mesh 'model://m/m.dae'"},
    {"nested_include_missing", ":8: world 'w', model 'm', include/uri" + kNowhere},
    {"no_link", ":5: world 'w', model 'm': this model is left out: expected a <link> in <model>"},
    {"population",
     ":5: world 'w', population 'p': this population is left out: the distribution 'heap' is "
     "unknown; expected random, uniform, grid, linear-x, linear-y or linear-z"},
    {"visual_mesh", ":8:" + kLink +
                        ", visual 'v', geometry/mesh: this visual is left out: there is no mesh "
                        "'model://m/m.dae'"},
};

TEST(WorldFileWarnings, NameFileLineEntityAndCause) {
  for (const auto& [rule, message] : kWarnings) {
    const std::string path = (kFolder / ("invalid_" + rule + ".sdf")).string();
    std::vector<std::string> warnings;
    EXPECT_EQ(loadWorld(path, kPaths, &warnings).models.size(), 1u) << rule;
    EXPECT_EQ(warnings, std::vector<std::string>{path + message});
  }
}

TEST(WorldFileErrors, NameFileLineEntityAndCause) {
  for (const auto& [rule, message] : kErrors) {
    const std::string path = (kFolder / ("invalid_" + rule + ".sdf")).string();
    EXPECT_EQ(errorOf(path), path + message);
  }
}

TEST(WorldFileErrors, NameTheFileOfTheModelThatIsIncluded) {
  EXPECT_EQ(errorOf((kFolder / "invalid_include_broken.sdf").string()),
            kBrokenModels +
                "/broken/model.sdf:6: model 'broken', link 'l', inertial/mass: 'heavy' is no "
                "value for <mass>; expected a number");
}

TEST(WorldFileWarnings, NameWhatIsMissingHoweverDeepItIs) {
  const std::string path = (kFolder / "invalid_deep_include_missing.sdf").string();
  std::vector<std::string> warnings;
  EXPECT_EQ(loadWorld(path, kPaths, &warnings).models.size(), 2u);
  EXPECT_EQ(warnings, std::vector<std::string>{kBrokenModels + "/outer/model.sdf" + kNowhere});
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
  EXPECT_PRED2([](const auto& text, const auto& part) { return text.find(part) != text.npos; },
               errorOf(path), "the model 'model://cycle_b' includes itself");
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

TEST(WorldFileErrors, KeepTheirLineBehindIncludesThatWereTakenOut) {
  const std::string xml =
      "<sdf version='1.9'>\n<world name='w'>\n<include>\n<uri>model://item</uri>\n</include>\n"
      "<model name='m'>\n<link name='l'><inertial><mass>heavy</mass></inertial></link>\n</model>\n"
      "</world>\n</sdf>";
  try {
    parseWorld(xml, kPaths, "text");
    FAIL() << "no error";
  } catch (const DescriptionError& error) {
    EXPECT_STREQ(error.what(),
                 "text:7: world 'w', model 'm', link 'l', inertial/mass: 'heavy' is no value for "
                 "<mass>; expected a number");
  }
}

TEST(WorldFileErrors, KnowNamesOfIncludesAndOfModelsBesideThem) {
  const std::string xml =
      "<sdf version='1.9'><world name='w'>\n<model name='m'><link name='l'/></model>\n"
      "<include><uri>model://item</uri><name>m</name></include></world></sdf>";
  try {
    parseWorld(xml, kPaths, "text");
    FAIL() << "no error";
  } catch (const DescriptionError& error) {
    EXPECT_EQ(error.what(), "text:3: include: the name 'm'" + taken("model", "world"));
  }
}

/// std::regex, for one, overflows the stack on texts of this length.
TEST(WorldFileErrors, SurviveVeryLongTexts) {
  const std::string letters(1000000, 'x');
  const std::string model = "<model name='" + letters + "'>";
  for (const std::string& inside :
       {model + "</model>",
        model + "<link name='l'><inertial><mass>heavy</mass></inertial></link></model>",
        "<model name='m'><link name='l'><inertial><mass>" + letters +
            "</mass></inertial></link></model>",
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
