// SPDX-License-Identifier: Apache-2.0
//
// Values read from SDF. Refusals are in world_file_errors_test.cpp.
#include "kiva_plugin_cpp/world_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>

#include "kiva_plugin_cpp/principal_inertia.h"

namespace kiva {
namespace {

namespace fs = std::filesystem;

const ModelPaths kPaths{std::string(WORLDS_DIR) + "/models"};

std::string sdf(const std::string& inside) { return "<sdf version='1.9'>" + inside + "</sdf>"; }

std::string worldOf(const std::string& inside) {
  return sdf("<world name='w'>" + inside + "</world>");
}

std::string include(const std::string& model, const std::string& inside) {
  return "<include><uri>model://" + model + "</uri>" + inside + "</include>";
}

WorldDescription world(const std::string& inside) {
  return parseWorld(worldOf(inside), kPaths, "text");
}

ModelDescription model(const std::string& inside) {
  const auto models = parseModels(sdf("<model name='m'>" + inside + "</model>"), kPaths, "text");
  return *models.at(0).description;
}

Link link(const std::string& inside) {
  return model("<link name='l'>" + inside + "</link>").links.at(0);
}

Collision collision(const std::string& geometry, const std::string& rest = "") {
  return link("<collision name='c'><geometry>" + geometry + "</geometry>" + rest + "</collision>")
      .collisions.at(0);
}

Joint joint(const std::string& type, const std::string& inside,
            const std::string& child_pose = "0 0 0 0 0 0") {
  return model("<link name='a'/><link name='b'><pose>" + child_pose +
               "</pose></link><joint name='j' type='" + type +
               "'><parent>a</parent><child>b</child>" + inside + "</joint>")
      .joints.at(0);
}

void expectNear(const Vector3& actual, const Vector3& expected) {
  EXPECT_NEAR(actual.Distance(expected), 0, 1e-12) << actual << " instead of " << expected;
}

void expectNear(const Pose& actual, const Pose& expected) {
  expectNear(actual.Pos(), expected.Pos());
  EXPECT_NEAR(std::abs(actual.Rot().Dot(expected.Rot())), 1, 1e-12)
      << actual << " instead of " << expected;
}

// --- shapes

TEST(Shapes, BoxHasItsEdges) {
  const Shape shape = collision("<box><size>1 2 3</size></box>").shape;
  EXPECT_EQ(shape.kind, Shape::Kind::kBox);
  EXPECT_EQ(shape.size, Vector3(1, 2, 3));
}

TEST(Shapes, RoundOnesHaveRadiusAndLength) {
  const Shape sphere = collision("<sphere><radius>0.25</radius></sphere>").shape;
  EXPECT_EQ(sphere.kind, Shape::Kind::kSphere);
  EXPECT_EQ(sphere.radius, 0.25);
  const std::string size = "<radius>0.5</radius><length>3</length>";
  for (const auto& [name, kind] : {std::pair{"cylinder", Shape::Kind::kCylinder},
                                   std::pair{"capsule", Shape::Kind::kCapsule}}) {
    const std::string tag(name);
    const Shape shape = collision("<" + tag + ">" + size + "</" + tag + ">").shape;
    EXPECT_EQ(shape.kind, kind);
    EXPECT_EQ(shape.radius, 0.5);
    EXPECT_EQ(shape.length, 3);
  }
}

TEST(Shapes, EllipsoidHasItsRadii) {
  const Shape shape = collision("<ellipsoid><radii>1 2 3</radii></ellipsoid>").shape;
  EXPECT_EQ(shape.kind, Shape::Kind::kEllipsoid);
  EXPECT_EQ(shape.size, Vector3(1, 2, 3));
}

TEST(Shapes, PlaneHasAUnitNormalAndASize) {
  const Shape shape = collision("<plane><normal>0 3 4</normal><size>20 30</size></plane>").shape;
  EXPECT_EQ(shape.kind, Shape::Kind::kPlane);
  expectNear(shape.normal, {0, 0.6, 0.8});
  EXPECT_EQ(shape.plane_size[0], 20);
  EXPECT_EQ(shape.plane_size[1], 30);
}

TEST(Shapes, EmptyOnesAreNone) {
  EXPECT_TRUE(
      link("<collision name='c'><geometry><empty/></geometry></collision>").collisions.empty());
}

TEST(Shapes, StandWhereTheirPoseSays) {
  const Collision c =
      collision("<sphere><radius>1</radius></sphere>", "<pose>1 2 3 0 0 1.5</pose>");
  EXPECT_EQ(c.name, "c");
  expectNear(c.pose_in_link, Pose(1, 2, 3, 0, 0, 1.5));
}

const std::string kBall = "<sphere><radius>1</radius></sphere>";

std::string surface(const std::string& inside) { return "<surface>" + inside + "</surface>"; }

TEST(Surface, HasFrictionOneAndNoBounceByDefault) {
  const Collision c = collision(kBall);
  EXPECT_EQ(c.friction, 1);
  EXPECT_EQ(c.restitution, 0);
}

TEST(Surface, TakesFrictionOfOdeBeforeBullet) {
  const std::string ode = "<ode><mu>0.3</mu></ode>";
  const std::string bullet = "<bullet><friction>0.4</friction></bullet>";
  const auto friction = [](const std::string& of) {
    return collision(kBall, surface("<friction>" + of + "</friction>")).friction;
  };
  EXPECT_EQ(friction(ode), 0.3);
  EXPECT_EQ(friction(bullet), 0.4);
  EXPECT_EQ(friction(bullet + ode), 0.3);
  EXPECT_EQ(friction("<ode><mu>0</mu></ode>"), 0);
}

TEST(Surface, TakesRestitution) {
  const std::string bounce =
      "<bounce><restitution_coefficient>0.5</restitution_coefficient></bounce>";
  EXPECT_EQ(collision(kBall, surface(bounce)).restitution, 0.5);
}

Visual visual(const std::string& inside) {
  return link("<visual name='v'><geometry>" + kBall + "</geometry>" + inside + "</visual>")
      .visuals.at(0);
}

TEST(Visuals, AreDiffuseElseAmbientElseGrey) {
  const auto expectColour = [](const Visual& v, double r, double g, double b, double a) {
    EXPECT_NEAR(v.rgba[0], r, 1e-6);
    EXPECT_NEAR(v.rgba[1], g, 1e-6);
    EXPECT_NEAR(v.rgba[2], b, 1e-6);
    EXPECT_NEAR(v.rgba[3], a, 1e-6);
  };
  const std::string diffuse = "<diffuse>0.1 0.2 0.3 0.5</diffuse>";
  const std::string ambient = "<ambient>0.4 0.5 0.6 1</ambient>";
  expectColour(visual(""), 0.7, 0.7, 0.7, 1);
  expectColour(visual("<material>" + ambient + "</material>"), 0.4, 0.5, 0.6, 1);
  expectColour(visual("<material>" + ambient + diffuse + "</material>"), 0.1, 0.2, 0.3, 0.5);
  expectColour(visual("<transparency>0.75</transparency>"), 0.7, 0.7, 0.7, 0.25);
}

// --- links

TEST(Links, WeighOneKilogramByDefault) {
  const Link l = link("");
  EXPECT_EQ(l.mass, 1);
  expectNear(l.principal_moments, {1, 1, 1});
  EXPECT_TRUE(l.gravity);
}

TEST(Links, KeepDiagonalInertiaInItsAxes) {
  const Link l = link(
      "<inertial><pose>1 2 3 0 0 0.5</pose><mass>7</mass><inertia><ixx>3</ixx><iyy>2</iyy>"
      "<izz>4</izz></inertia></inertial>");
  EXPECT_EQ(l.mass, 7);
  expectNear(l.principal_moments, {3, 2, 4});
  expectNear(l.inertial_pose_in_link, Pose(1, 2, 3, 0, 0, 0.5));
}

TEST(Links, TurnInertiaToItsPrincipalAxes) {
  const Matrix3 inertia(3, 0.4, -0.2, 0.4, 4, 0.3, -0.2, 0.3, 5);
  const Link l = link(
      "<inertial><mass>7</mass><inertia><ixx>3</ixx><ixy>0.4</ixy><ixz>-0.2</ixz><iyy>4</iyy>"
      "<iyz>0.3</iyz><izz>5</izz></inertia></inertial>");
  const Matrix3 axes(l.inertial_pose_in_link.Rot());
  const Vector3& m = l.principal_moments;
  const Matrix3 again = axes * Matrix3(m.X(), 0, 0, 0, m.Y(), 0, 0, 0, m.Z()) * axes.Transposed();
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(again(i / 3, i % 3), inertia(i / 3, i % 3), 1e-5) << i;
}

TEST(Links, MayBeFreeOfGravity) { EXPECT_FALSE(link("<gravity>false</gravity>").gravity); }

TEST(Links, StandRelativeToFrames) {
  const ModelDescription m = model(
      "<frame name='f'><pose>1 0 0 0 0 1.5707963267948966</pose></frame>"
      "<link name='a'><pose relative_to='f'>2 0 0 0 0 0</pose></link>"
      "<link name='b'><pose relative_to='a'>0 0 3 0 0 0</pose></link>");
  expectNear(m.links[0].pose_in_model, Pose(1, 2, 0, 0, 0, M_PI / 2));
  expectNear(m.links[1].pose_in_model, Pose(1, 2, 3, 0, 0, M_PI / 2));
}

TEST(Models, PutTheCanonicalLinkFirst) {
  const auto models = parseModels(
      sdf("<model name='m' canonical_link='b'><link name='a'/><link name='b'/><link name='c'/>"
          "</model>"),
      kPaths, "text");
  const auto& links = models[0].description->links;
  EXPECT_EQ(links[0].name, "b");
  EXPECT_EQ(links[1].name, "a");
  EXPECT_EQ(links[2].name, "c");
}

TEST(Models, AreStaticWhereTheySaySo) {
  EXPECT_TRUE(model("<static>true</static><link name='l'/>").is_static);
  EXPECT_FALSE(model("<link name='l'/>").is_static);
}

// --- joints

TEST(Joints, HaveTheirKinds) {
  const std::string axis = "<axis><xyz>0 0 1</xyz></axis>";
  EXPECT_EQ(joint("fixed", "").kind, Joint::Kind::kFixed);
  EXPECT_EQ(joint("revolute", axis).kind, Joint::Kind::kRevolute);
  EXPECT_EQ(joint("continuous", axis).kind, Joint::Kind::kContinuous);
  EXPECT_EQ(joint("prismatic", axis).kind, Joint::Kind::kPrismatic);
  EXPECT_EQ(joint("ball", "").kind, Joint::Kind::kBall);
}

TEST(Joints, AreUnlimitedByDefault) {
  const Joint j = joint("revolute", "<axis><xyz>0 0 1</xyz></axis>");
  EXPECT_EQ(j.lower, -1e16);
  EXPECT_EQ(j.upper, 1e16);
  EXPECT_LT(j.max_effort, 0);
  EXPECT_LT(j.max_velocity, 0);
  EXPECT_EQ(j.damping, 0);
  EXPECT_EQ(j.friction, 0);
}

TEST(Joints, TakeLimitsAndDynamics) {
  const Joint j = joint(
      "prismatic",
      "<axis><xyz>0 0 2</xyz><limit><lower>-0.5</lower><upper>0.25</upper><effort>100</effort>"
      "<velocity>3</velocity></limit><dynamics><damping>4</damping><friction>5</friction>"
      "</dynamics></axis>");
  EXPECT_EQ(j.parent, "a");
  EXPECT_EQ(j.child, "b");
  expectNear(j.axis_in_model, {0, 0, 1});
  EXPECT_EQ(j.lower, -0.5);
  EXPECT_EQ(j.upper, 0.25);
  EXPECT_EQ(j.max_effort, 100);
  EXPECT_EQ(j.max_velocity, 3);
  EXPECT_EQ(j.damping, 4);
  EXPECT_EQ(j.friction, 5);
}

TEST(Joints, SitInTheirChildUnlessPlaced) {
  const std::string turned = "1 2 3 0 0 1.5707963267948966";
  const Joint j = joint("continuous", "<axis><xyz>1 0 0</xyz></axis>", turned);
  expectNear(j.anchor_in_model, {1, 2, 3});
  expectNear(j.axis_in_model, {0, 1, 0});
  const Joint placed =
      joint("continuous", "<pose relative_to='a'>0 0 5 0 0 0</pose><axis><xyz>1 0 0</xyz></axis>",
            turned);
  expectNear(placed.anchor_in_model, {0, 0, 5});
  expectNear(placed.axis_in_model, {1, 0, 0});
}

TEST(Joints, TurnAnAxisThatIsExpressedElsewhere) {
  const Joint j = joint("revolute", "<axis><xyz expressed_in='__model__'>1 0 0</xyz></axis>",
                        "1 2 3 0 0 1.5707963267948966");
  expectNear(j.axis_in_model, {1, 0, 0});
}

TEST(Joints, MayHoldOnToTheWorld) {
  const Joint j = model(
                      "<link name='l'/><joint name='j' type='fixed'><parent>world</parent>"
                      "<child>l</child></joint>")
                      .joints.at(0);
  EXPECT_EQ(j.parent, "world");
  EXPECT_EQ(j.child, "l");
}

// --- models in models

/// A folder of models that goes when the test ends.
class ModelFolder {
 public:
  ModelFolder() : path_(fs::temp_directory_path() / ("models_" + std::to_string(getpid()))) {}
  ~ModelFolder() { fs::remove_all(path_); }
  ModelPaths paths() const { return {path_.string()}; }

  void write(const std::string& name, const std::string& content) const {
    fs::create_directories(path_ / name);
    std::ofstream(path_ / name / "model.config")
        << "<model><name>" << name << "</name><sdf version='1.9'>model.sdf</sdf></model>";
    std::ofstream(path_ / name / "model.sdf") << sdf(content);
  }

 private:
  fs::path path_;
};

const std::string kNested =
    "<link name='base'/>"
    "<model name='arm'><pose>1 0 0 0 0 1.5707963267948966</pose>"
    "<link name='upper'><pose>1 0 0 0 0 0</pose></link>"
    "<model name='hand'><pose>2 0 0 0 0 0</pose><link name='palm'/>"
    "<plugin name='grip' filename='libgrip.so'/></model>"
    "<joint name='wrist' type='revolute'><parent>upper</parent><child>hand::palm</child>"
    "<axis><xyz>1 0 0</xyz></axis></joint></model>"
    "<joint name='shoulder' type='fixed'><parent>base</parent><child>arm::upper</child></joint>";

TEST(NestedModels, AreFlattened) {
  const ModelDescription m = model(kNested);
  ASSERT_EQ(m.links.size(), 3u);
  EXPECT_EQ(m.nested_models, (std::vector<std::string>{"arm", "arm::hand"}));
  ASSERT_TRUE(m.findLink("arm::hand::palm"));
  expectNear(m.findLink("arm::upper")->pose_in_model, Pose(1, 1, 0, 0, 0, M_PI / 2));
  expectNear(m.findLink("arm::hand::palm")->pose_in_model, Pose(1, 2, 0, 0, 0, M_PI / 2));
  EXPECT_EQ(m.plugins.at(0).name, "grip");
}

TEST(NestedModels, KeepTheirJoints) {
  const ModelDescription m = model(kNested);
  ASSERT_EQ(m.joints.size(), 2u);
  EXPECT_EQ(m.joints[0].name, "shoulder");
  EXPECT_EQ(m.joints[0].child, "arm::upper");
  EXPECT_EQ(m.joints[1].name, "arm::wrist");
  EXPECT_EQ(m.joints[1].parent, "arm::upper");
  EXPECT_EQ(m.joints[1].child, "arm::hand::palm");
  expectNear(m.joints[1].anchor_in_model, {1, 2, 0});
  expectNear(m.joints[1].axis_in_model, {0, 1, 0});
}

TEST(NestedModels, MayHoldOnToTheWorld) {
  const ModelDescription m = model(
      "<link name='l'/><model name='n'><link name='k'/><joint name='j' type='fixed'>"
      "<parent>world</parent><child>k</child></joint></model>");
  EXPECT_EQ(m.joints.at(0).parent, "world");
  EXPECT_EQ(m.joints.at(0).child, "n::k");
}

TEST(NestedModels, MayBeIncluded) {
  const ModelDescription m =
      model("<link name='l'/>" + include("item", "<name>box</name><pose>0 0 2 0 0 0</pose>"));
  ASSERT_TRUE(m.findLink("box::body"));
  expectNear(m.findLink("box::body")->pose_in_model, Pose(0, 0, 2, 0, 0, 0));
  EXPECT_EQ(m.findLink("box::body")->mass, 1.5);
}

TEST(NestedModels, MayIncludeModelsThatInclude) {
  const ModelFolder folder;
  folder.write("a", "<model name='a'><link name='l'/>" + include("b", "") + "</model>");
  folder.write("b", "<model name='b'><link name='l'/>" + include("c", "") + "</model>");
  folder.write("c", "<model name='c'><link name='l'/></model>");
  const auto models = parseModels(worldOf(include("a", "")), folder.paths(), "text");
  EXPECT_TRUE(models.at(0).description->findLink("b::c::l"));
}

TEST(NestedModels, MayBeMerged) {
  const ModelDescription m =
      model("<link name='l'/><include merge='true'><uri>model://item</uri></include>");
  EXPECT_TRUE(m.findLink("body"));
  EXPECT_TRUE(m.nested_models.empty());
}

TEST(NestedModels, ThatAreStaticMakeWhatWrapsThemStatic) {
  const std::string still = "<model name='n'><static>true</static><link name='k'/></model>";
  EXPECT_TRUE(model(still).is_static);
  EXPECT_FALSE(model(still + "<model name='o'><link name='k'/></model>").is_static);
}

TEST(NestedModels, ThatAreStaticInOnesThatMoveAreHeldToTheWorld) {
  const ModelDescription m =
      model("<link name='l'/><model name='n'><static>true</static><link name='k'/></model>");
  EXPECT_FALSE(m.is_static);
  EXPECT_EQ(m.joints.at(0).kind, Joint::Kind::kFixed);
  EXPECT_EQ(m.joints.at(0).parent, "world");
  EXPECT_EQ(m.joints.at(0).child, "n::k");
}

// --- equal models, populations, saved states

std::string boxModel(const std::string& name, const std::string& pose, const std::string& size) {
  return "<model name='" + name + "'>" + (pose.empty() ? "" : "<pose>" + pose + "</pose>") +
         "<static>true</static><link name='l'><collision name='c'><geometry><box><size>" + size +
         "</size></box></geometry></collision></link></model>";
}

TEST(EqualModels, ShareTheirDescriptionAndKeepNameAndPlace) {
  const auto models = world(boxModel("a", "1 0 0 0 0 0.5", "1 2 3") +
                            boxModel("b", "0 5 0 0 1 0", "1 2 3") + boxModel("c", "", "1 2 4"))
                          .models;
  ASSERT_EQ(models.size(), 3u);
  EXPECT_EQ(models[0].name, "a");
  expectNear(models[0].pose, Pose(1, 0, 0, 0, 0, 0.5));
  EXPECT_EQ(models[1].name, "b");
  expectNear(models[1].pose, Pose(0, 5, 0, 0, 1, 0));
  EXPECT_EQ(models[0].description, models[1].description);
  EXPECT_NE(models[0].description, models[2].description);
}

TEST(EqualModels, StandByTheirPlacementFrames) {
  const auto placed = [](const std::string& name, const std::string& pose) {
    return "<model name='" + name + "' placement_frame='f'><pose>" + pose +
           "</pose><frame name='f'><pose>0 0 2 0 0 0</pose></frame><link name='l'/></model>";
  };
  const auto models = world(placed("a", "1 0 0 0 0 1") + placed("b", "0 3 0 1 0 0")).models;
  expectNear(models.at(0).pose, Pose(1, 0, -2, 0, 0, 1));
  expectNear(models.at(1).pose, Pose(0, 3, 0, 1, 0, 0) * Pose(0, 0, -2, 0, 0, 0));
}

TEST(EqualModels, HaveNamesOfTheirOwn) {
  std::vector<std::string> warnings;
  const auto w = parseWorld(worldOf(boxModel("a", "", "1 1 1") + "\n" + boxModel("a", "", "1 1 1")),
                            kPaths, "text", &warnings);
  EXPECT_EQ(w.models.size(), 1u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("text:2: model: it is left out: the name 'a' is taken"), 0u)
      << warnings[0];
}

TEST(StaticModels, ByTheThousandAreReadWithinSeconds) {
  std::string equal, different;
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "m" + std::to_string(i), pose = std::to_string(i) + " 0 0 0 0 0";
    equal += boxModel(name, pose, "1 1 1");
    different += boxModel(name, pose, "1 1 " + std::to_string(i + 1));
  }
  for (const std::string& body : {equal, different}) {
    const std::clock_t start = std::clock();
    EXPECT_EQ(world(body).models.at(999).pose.X(), 999);
    const double took = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_LT(took, 4.0);  // Takes 0.1 and 1 s.
  }
}

std::string population(const std::string& distribution, const std::string& rest) {
  return "<population name='p'><model name='m'><pose>0 0 0.5 0 0 0</pose><link name='l'/></model>"
         "<pose>10 0 0 0 0 1.5707963267948966</pose><distribution>" +
         distribution + "</distribution>" + rest + "</population>";
}

TEST(Populations, StandInGrids) {
  const auto models = world(population("<type>grid</type><rows>2</rows><cols>3</cols>"
                                       "<step>2 1 0</step>",
                                       "<model_count>6</model_count>"))
                          .models;
  ASSERT_EQ(models.size(), 6u);
  EXPECT_EQ(models[0].name, "m_clone_0");
  EXPECT_EQ(models[5].name, "m_clone_5");
  expectNear(models[0].pose, Pose(10.5, -2, 0.5, 0, 0, M_PI / 2));
  expectNear(models[5].pose, Pose(9.5, 2, 0.5, 0, 0, M_PI / 2));
  EXPECT_EQ(models[0].description, models[5].description);
}

TEST(Populations, StandInRows) {
  const auto models = world(population("<type>linear-x</type>",
                                       "<model_count>4</model_count><box><size>8 1 1</size></box>"))
                          .models;
  ASSERT_EQ(models.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    expectNear(models[i].pose, Pose(10, -3 + 2 * i, 0.5, 0, 0, M_PI / 2));
  }
}

TEST(Populations, AreSpreadOverTheirRegionTheSameEachTime) {
  for (const char* type : {"random", "uniform"}) {
    const std::string text =
        population("<type>" + std::string(type) + "</type>",
                   "<model_count>50</model_count><cylinder><radius>3</radius><length>0</length>"
                   "</cylinder>");
    const auto models = world(text).models, again = world(text).models;
    ASSERT_EQ(models.size(), 50u);
    double farthest = 0;
    for (int i = 0; i < 50; ++i) {
      expectNear(models[i].pose, again[i].pose);
      farthest = std::max(farthest, std::hypot(models[i].pose.X() - 10, models[i].pose.Y()));
    }
    EXPECT_LE(farthest, 3);
    EXPECT_GT(farthest, 2);
  }
}

TEST(Populations, MayBeOfIncludes) {
  const auto models =
      world("<population name='p'>" + include("item", "") +
            "<model_count>2</model_count><distribution><type>linear-y</type></distribution>"
            "<box><size>1 4 1</size></box></population>")
          .models;
  EXPECT_EQ(models.at(1).name, "item_clone_1");
  expectNear(models.at(1).pose, Pose(0, 1, 0, 0, 0, 0));
}

TEST(SavedStates, PlaceTheirModels) {
  const auto models = world(boxModel("a", "1 0 0 0 0 0", "1 1 1") + include("item", "") +
                            "<state world_name='w'><sim_time>1 0</sim_time><model name='a'>"
                            "<pose>4 5 6 0 0 1</pose><link name='l'><pose>9 9 9 0 0 0</pose></link>"
                            "</model><model name='gone'><pose>1 1 1 0 0 0</pose></model></state>")
                          .models;
  ASSERT_EQ(models.size(), 2u);
  expectNear(models[0].pose, Pose(4, 5, 6, 0, 0, 1));
  expectNear(models[1].pose, Pose::Zero);
}

TEST(Worlds, MadeForGazeboMayHaveScriptedMaterialsActorsAndTheSun) {
  const auto w = world(
      include("sun", "") + include("ground_plane", "") +
      "<scene><ambient>1 1 1 1</ambient></scene><gui><camera name='c'/></gui>"
      "<physics type='ode'><max_step_size>0.001</max_step_size></physics>"
      "<actor name='a'><broken></broken></actor>"
      "<model name='m'><link name='l'><visual name='v'><geometry><box><size>1 1 1</size></box>"
      "</geometry><material><script><name>Gazebo/Wood</name></script></material></visual></link>"
      "</model>");
  ASSERT_EQ(w.models.size(), 3u);
  EXPECT_EQ(w.models[0].name, "ground_plane");
  EXPECT_EQ(w.models[1].name, "a");
  EXPECT_EQ(w.models[2].description->links[0].visuals.size(), 1u);
}

// --- worlds

TEST(Worlds, HaveSdfsDefaults) {
  const WorldDescription w = world("");
  EXPECT_EQ(w.name, "w");
  expectNear(w.gravity, {0, 0, -9.8});
  EXPECT_EQ(w.step_size, 0.001);
  EXPECT_EQ(w.real_time_factor, 1);
  EXPECT_TRUE(w.models.empty());
  EXPECT_TRUE(w.plugins.empty());
}

TEST(Worlds, TakeGravityStepAndPlugins) {
  const WorldDescription w = world(
      "<gravity>0 1 -3</gravity><physics name='p' type='bullet'><max_step_size>0.002"
      "</max_step_size><real_time_factor>0</real_time_factor></physics>"
      "<plugin name='grid' filename='libkiva_grid.so'><spacing>1.5</spacing></plugin>");
  expectNear(w.gravity, {0, 1, -3});
  EXPECT_EQ(w.step_size, 0.002);
  EXPECT_EQ(w.real_time_factor, 0);
  ASSERT_EQ(w.plugins.size(), 1u);
  EXPECT_EQ(w.plugins[0].filename, "libkiva_grid.so");
  EXPECT_EQ(w.plugins[0].parameters.number("spacing", 0, 0, 9), 1.5);
}

TEST(Worlds, PlaceModelsRelativeToFramesAndEachOther) {
  const WorldDescription w = world(
      "<frame name='f'><pose>1 0 0 0 0 1.5707963267948966</pose></frame>"
      "<model name='m'><pose relative_to='f'>2 0 0 0 0 0</pose><link name='l'/></model>" +
      include("item", "<name>i</name><pose relative_to='m'>0 0 1 0 0 0</pose>"));
  expectNear(w.models.at(0).pose, Pose(1, 2, 0, 0, 0, M_PI / 2));
  expectNear(w.models.at(1).pose, Pose(1, 2, 1, 0, 0, M_PI / 2));
}

TEST(Plugins, KeepNestedRepeatedAndEmptyParameters) {
  const auto models = parseModels(
      sdf("<model name='m'><link name='l'/>\n<plugin name='p' filename='libp.so'><a> 1 </a>"
          "<b><c>2</c><d><e>3</e></d></b><a>4</a><f/></plugin></model>"),
      kPaths, "text");
  const Parameters& p = models[0].description->plugins.at(0).parameters;
  const std::map<std::string, std::string> expected = {
      {"a", "1"}, {"a[2]", "4"}, {"b/c", "2"}, {"b/d/e", "3"}, {"f", ""}};
  EXPECT_EQ(p.values(), expected);
  EXPECT_EQ(p.where(), "model 'm', plugin 'p'");
}

TEST(Plugins, MayCallTheirParametersLikePartsOfSdf) {
  const ModelDescription m = model(
      "<link name='l'/><plugin name='p' filename='libp.so'><model>kiva1</model><joint type='x'/>"
      "</plugin>");
  EXPECT_EQ(m.plugins.at(0).parameters.text("model", ""), "kiva1");
}

TEST(Plugins, KnowTheirFile) {
  const auto models =
      parseWorld(worldOf(include("kiva", "<name>kiva1</name>")), kPaths, "w").models;
  for (const PluginDescription& plugin : models[0].description->plugins) {
    const std::string& where = plugin.parameters.where();
    EXPECT_EQ(where.find(kPaths[0] + "/kiva/model.sdf:"), 0u) << where;
    EXPECT_NE(where.find("model 'kiva', plugin '" + plugin.name + "'"), std::string::npos) << where;
  }
}

// --- includes

TEST(Includes, TakeNameAndPoseAndShareTheirDescription) {
  const auto models = world(include("item", "<name>i1</name><pose>1 2 3 0 0 0.5</pose>") +
                            include("item", "<name>i2</name>"))
                          .models;
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].name, "i1");
  expectNear(models[0].pose, Pose(1, 2, 3, 0, 0, 0.5));
  EXPECT_EQ(models[1].name, "i2");
  expectNear(models[1].pose, Pose::Zero);
  EXPECT_EQ(models[0].description, models[1].description);
}

TEST(Includes, AreCalledLikeTheirModelUnlessNamed) {
  EXPECT_EQ(world(include("item", "")).models.at(0).name, "item");
}

TEST(Includes, MayChangeWhetherAModelIsStatic) {
  const auto models = world(include("item", "<name>i1</name><static>true</static>") +
                            include("item", "<name>i2</name>"))
                          .models;
  EXPECT_TRUE(models[0].description->is_static);
  EXPECT_FALSE(models[1].description->is_static);
}

TEST(Includes, KeepTheOrderOfTheText) {
  const std::string inlined = "<model name='b'><link name='l'/></model>";
  const std::string special = "<plugin name='p' filename='libp.so'/>";
  const auto models =
      world(include("item", "<name>a</name>") + inlined +
            include("item", "<name>c</name>" + special) + include("item", "<name>d</name>") +
            "<model name='e'><link name='l'/></model>")
          .models;
  std::string names;
  for (const ModelInstance& m : models) names += m.name;
  EXPECT_EQ(names, "abcde");
  EXPECT_EQ(models[2].description->plugins.at(0).filename, "libp.so");
}

TEST(Includes, InCommentsAreNone) {
  EXPECT_TRUE(world("<!-- " + include("item", "") + " -->").models.empty());
}

TEST(Includes, MayHoldCommentsAndEntities) {
  const auto models = world(include("item", "<!-- x --><name>i1</name>") +
                            include("item", "<name>a&amp;b</name><!-- <name>c</name> -->"))
                          .models;
  EXPECT_EQ(models.at(0).name, "i1");
  EXPECT_EQ(models.at(1).name, "a&b");
}

TEST(Includes, KeepTheModelsOwnPoseUnlessGivenOne) {
  const ModelFolder folder;
  folder.write("m", "<model name='m'><pose>0 0 7 0 0 0</pose><link name='l'/></model>");
  const auto models = parseModels(worldOf(include("m", "<name>a</name>") +
                                          include("m", "<name>b</name><pose>1 0 0 0 0 0</pose>")),
                                  folder.paths(), "text");
  expectNear(models.at(0).pose, Pose(0, 0, 7, 0, 0, 0));
  expectNear(models.at(1).pose, Pose(1, 0, 0, 0, 0, 0));
}

TEST(Includes, PlaceTheModelByItsPlacementFrame) {
  const ModelFolder folder;
  folder.write("m",
               "<model name='m' placement_frame='top'><link name='l'/><frame name='top'>"
               "<pose>0 0 2 0 0 0</pose></frame></model>");
  const auto models = parseModels(worldOf(include("m", "<name>a</name><pose>1 0 0 0 0 0</pose>")),
                                  folder.paths(), "text");
  expectNear(models.at(0).pose, Pose(1, 0, -2, 0, 0, 0));
}

TEST(Includes, OfALightKeepItUnderItsName) {
  const ModelFolder folder;
  folder.write("sun", "<light name='sun' type='directional'/>");
  std::vector<std::string> warnings;
  const std::string text = worldOf(include("sun", "") + include("sun", "<name>moon</name>"));
  const auto w = parseWorld(text, folder.paths(), "text", &warnings);
  EXPECT_TRUE(w.models.empty());
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(w.lights.size(), 2u);
  EXPECT_EQ(w.lights[0].name + w.lights[1].name, "sunmoon");
  EXPECT_EQ(w.lights[1].kind, Light::Kind::kDirectional);
}

/// Plain includes are read apart from the rest; a frame on a robot has all read in one.
TEST(Includes, ComeOutAlikeApartAndInOne) {
  const std::string body = include("kiva", "<name>kiva1</name><pose>1 2 0 0 0 0.5</pose>") +
                           include("storage_unit", "<name>storage_unit1</name>");
  const std::string frame = "<frame name='f' attached_to='kiva1'/>";
  const auto ours = world(body).models;
  const auto theirs = world(body + frame).models;
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].name, theirs[i].name);
    expectNear(ours[i].pose, theirs[i].pose);
    const ModelDescription& a = *ours[i].description;
    const ModelDescription& b = *theirs[i].description;
    ASSERT_EQ(a.links.size(), b.links.size());
    for (std::size_t k = 0; k < a.links.size(); ++k) {
      EXPECT_EQ(a.links[k].name, b.links[k].name);
      expectNear(a.links[k].pose_in_model, b.links[k].pose_in_model);
      EXPECT_EQ(a.links[k].collisions.size(), b.links[k].collisions.size());
    }
    EXPECT_EQ(a.joints.size(), b.joints.size());
    EXPECT_EQ(a.plugins.size(), b.plugins.size());
  }
}

TEST(Includes, OfFiveThousandShelvesCostNoMoreThanOne) {
  std::string body;
  for (int i = 0; i < 5000; ++i) {
    body += include("storage_unit", "<name>storage_unit" + std::to_string(i) + "</name><pose>" +
                                        std::to_string(i) + " 0 0 0 0 0</pose>");
  }
  const auto start = std::chrono::steady_clock::now();
  const auto models = world(body).models;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(models.size(), 5000u);
  EXPECT_EQ(models[4999].pose.Pos().X(), 4999);
  EXPECT_EQ(models[0].description, models[4999].description);
  EXPECT_LT(took.count(), 5.0);  // Takes 0.05 s.
}

// --- requests

/// A warning about what is well-formed would hide one that matters.
TEST(Requests, OfUrdfWarnOfNothingThatUrdfHas) {
  const std::string inertial =
      "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
      "</inertial>";
  const std::string body =
      inertial +
      "<visual><geometry><sphere radius='1'/></geometry><material name='m'><color "
      "rgba='1 0 0 1'/></material></visual><collision><geometry><sphere radius='1'/></geometry>"
      "</collision>";
  const std::string urdf =
      "<robot name='r'><link name='a'>" + body + "</link><link name='b'>" + body +
      "</link><joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis "
      "xyz='0 1 0'/><limit lower='-1' upper='2' effort='3' velocity='4'/><dynamics damping='5' "
      "friction='6'/></joint><gazebo reference='b'><mu1>0.25</mu1><mu2>0.25</mu2><sensor name='s' "
      "type='ray'><update_rate>5</update_rate></sensor></gazebo></robot>";
  std::vector<std::string> warnings;
  const auto models = parseModels(urdf, kPaths, "text", &warnings);
  EXPECT_EQ(warnings, std::vector<std::string>());
  EXPECT_EQ(models.at(0).description->joints.at(0).upper, 2);
  EXPECT_EQ(models.at(0).description->links.at(1).collisions.at(0).friction, 0.25);
}

TEST(Requests, MayBeAModelAWorldABareIncludeOrUrdf) {
  const auto names = [](const std::string& xml) {
    std::string list;
    for (const ModelInstance& m : parseModels(xml, kPaths, "text")) list += m.name + " ";
    return list;
  };
  const std::string m = "<model name='m'><link name='l'/></model>";
  EXPECT_EQ(names(sdf(m)), "m ");
  EXPECT_EQ(names(worldOf(m + include("item", ""))), "m item ");
  EXPECT_EQ(names(sdf(include("item", ""))), "item ");
  EXPECT_EQ(names("<robot name='r'><link name='l'><inertial><mass value='2'/><inertia ixx='1' "
                  "iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>"),
            "r ");
}

TEST(Requests, MayBeOfAnOlderSdf) {
  const auto models = parseModels(
      "<sdf version='1.4'><model name='m'><pose>1 0 0 0 0 0</pose><link name='l'/></model></sdf>",
      kPaths, "text");
  expectNear(models.at(0).pose, Pose(1, 0, 0, 0, 0, 0));
}

TEST(Requests, OfEqualTextShareTheirDescription) {
  const std::string xml = sdf("<model name='shared'><link name='l'/></model>");
  const auto first = parseModels(xml, kPaths, "a")[0].description;
  EXPECT_EQ(parseModels(xml, kPaths, "b")[0].description, first);
  const std::string other = sdf("<model name='other'><link name='l'/></model>");
  EXPECT_NE(parseModels(other, kPaths, "c")[0].description, first);
}

TEST(Requests, ByTheThousandAreCheap) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 25000; ++i) {
    const std::string name = "item" + std::to_string(i);
    const auto models =
        parseModels(worldOf(include("item", "<name>" + name + "</name>")), kPaths, name);
    ASSERT_EQ(models.at(0).name, name);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 10.0);  // Takes 0.3 s.
}

TEST(Requests, SeeAModelThatWasEdited) {
  const ModelFolder folder;
  const auto mass = [&](const std::string& xml) {
    return parseModels(xml, folder.paths(), "text").at(0).description->links.back().mass;
  };
  const auto write = [&](const std::string& mass) {
    folder.write("m", "<model name='m'><link name='l'><inertial><mass>" + mass +
                          "</mass></inertial></link></model>");
  };
  const std::string plain = worldOf(include("m", ""));
  const std::string nested =
      sdf("<model name='n'><link name='l'/>" + include("m", "") + "</model>");
  write("2");
  EXPECT_EQ(mass(plain), 2);
  EXPECT_EQ(mass(nested), 2);
  write("3");  // No longer a file than before.
  EXPECT_EQ(mass(plain), 3);
  EXPECT_EQ(mass(nested), 3);
}

TEST(Requests, LookInTheirOwnPaths) {
  const ModelFolder folder;
  folder.write("item", "<model name='another'><link name='l'/></model>");
  const std::string xml = worldOf(include("item", ""));
  EXPECT_EQ(parseModels(xml, kPaths, "text").at(0).name, "item");
  EXPECT_EQ(parseModels(xml, folder.paths(), "text").at(0).name, "another");
}

TEST(Requests, MayComeFromSeveralThreads) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([t] {
      for (int i = 0; i < 5; ++i) {
        const std::string name = "m" + std::to_string(t * 5 + i);
        const auto models = parseModels(
            worldOf("<model name='" + name + "'><link name='l'/></model>" + include("wall", "")),
            kPaths, name);
        EXPECT_EQ(models.at(0).name, name);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

// --- warnings

TEST(Warnings, NameWhatIsLeftOutOnceEach) {
  const std::string text = worldOf(
      "\n<actor name='a'><skin><filename>a.dae</filename></skin></actor>"
      "\n<model name='m'><strange/><link name='l'>"
      "\n<collision name='c'><geometry>" +
      kBall +
      "</geometry>"
      "\n<surface><friction><ode><mu>1</mu><mu2>2</mu2></ode></friction></surface></collision>"
      "</link></model>");
  std::vector<std::string> warnings;
  testing::internal::CaptureStderr();
  parseWorld(text, kPaths, "text", &warnings);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  std::sort(warnings.begin(), warnings.end());
  const std::string m = "world 'w', model 'm', ";
  EXPECT_EQ(warnings, (std::vector<std::string>{
                          "text:2: world 'w', actor 'a': people look alike here: its skin and "
                          "animations are left out",
                          "text:3: " + m +
                              "strange: XML Element[strange], child of element[model], not "
                              "defined in SDF",
                          "text:5: " + m +
                              "link 'l', collision 'c', surface/friction/ode: mu2 is left out: "
                              "friction is the same in every direction",
                      }));
}

TEST(Sensors, HoldWhatTheirPluginsNeed) {
  const auto models = parseModels(
      sdf("<model name='m'><link name='l'><sensor name='s' type='ray'><pose>0 0 1 0 0 0</pose>"
          "<update_rate>7</update_rate><ray><scan><horizontal><samples>9</samples></horizontal>"
          "</scan></ray><plugin name='p' filename='lib.so'><topicName>t</topicName></plugin>"
          "</sensor></link></model>"),
      kPaths, "text");
  const SensorDescription& sensor = models.at(0).description->sensors.at(0);
  EXPECT_EQ(sensor.name + sensor.type + sensor.link, "srayl");
  EXPECT_EQ(sensor.update_rate, 7);
  EXPECT_EQ(sensor.pose_in_link.Z(), 1);
  EXPECT_EQ(sensor.parameters.whole("ray/scan/horizontal/samples", 0, 0, 99), 9);
  EXPECT_EQ(sensor.plugins.at(0).parameters.text("topicName", ""), "t");
}

TEST(Warnings, OfAModelComeOnceHoweverOftenItStands) {
  const ModelFolder folder;
  folder.write("odd", "<model name='odd'><strange/><link name='l'/></model>");
  const std::string plain = include("odd", "<name>a</name>") + include("odd", "<name>b</name>");
  const std::string nested = "<model name='m'><link name='l'/>" + plain + "</model>";
  for (const std::string& body : {plain, nested}) {
    std::vector<std::string> warnings;
    parseWorld(worldOf(body), folder.paths(), "text", &warnings);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].find(folder.paths()[0] + "/odd/model.sdf:1: "), 0u) << warnings[0];
  }
}

TEST(Warnings, ComeAgainFromTheCache) {
  const std::string xml = sdf("<model name='odd'><strange/><link name='l'/></model>");
  std::vector<std::string> first, second;
  parseModels(xml, kPaths, "a", &first);
  parseModels(xml, kPaths, "b", &second);
  ASSERT_EQ(first.size(), 1u);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0], "b" + first[0].substr(1));
}

}  // namespace
}  // namespace kiva
