// SPDX-License-Identifier: Apache-2.0
//
// Plugins of a user: found by their file names, configured by SDF, called around every step; and
// the example that shows how.
#include <cstdlib>
#include <filesystem>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

/// Returns the folder of the workspace's libraries, relative to this test.
std::string libraryFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path().string();
}

std::string patrol(const std::string& parameters) {
  return "<plugin name='patrol' filename='libhello_plugin.so'>" + parameters + "</plugin>";
}

class UserPlugin : public ::testing::Test {
 protected:
  UserPlugin() { setPath("/nowhere:" + libraryFolder()); }

  static void setPath(const std::string& folders) {
    setenv("KIVA_PLUGIN_PATH", folders.c_str(), true);
  }
  /// Returns the reason for which a Kiva with that element is refused.
  std::string refusal(const std::string& element, const std::string& kind = "kiva",
                      const std::string& name = "kiva1") {
    try {
      w.spawnText(withElement(modelText(kind), element), name, 0, 0);
      ADD_FAILURE() << name << " was spawned";
    } catch (const DescriptionError& error) {
      EXPECT_FALSE(w.world.has(name));
      return error.what();
    }
    return "";
  }

  Warehouse w;
};

// --- the example

TEST_F(UserPlugin, TheExampleSendsItsRobotBackAndForth) {
  w.spawnText(withElement(kivaText(), patrol("<x>3</x><y>1</y><pause>0.5</pause>")), "kiva1", 0, 0);
  for (int round = 0; round < 3; ++round) {
    w.runUntil([&] { return std::hypot(w.x(1) - 3, w.y(1) - 1) < kMillimetre; }, 20);
    w.runUntil([&] { return std::hypot(w.x(1), w.y(1)) < kMillimetre; }, 20);
  }
  EXPECT_GE(w.count(Event::Kind::kDone, "kiva1"), 5);
  EXPECT_EQ(w.count(Event::Kind::kRefused), 0);
}

TEST_F(UserPlugin, TheExampleTriesAgainWhatWasBlocked) {
  w.spawnText(withElement(kivaText(), patrol("<x>4</x>")), "kiva1", 0, 0);
  w.spawn("wall", "wall1", 3, 0, kQuarter);
  w.run(10);
  EXPECT_GE(w.count(Event::Kind::kBlocked, "kiva1"), 2);
  w.world.remove("wall1");
  w.runUntil([&] { return std::abs(w.x(1) - 4) < kMillimetre; }, 20);
}

TEST_F(UserPlugin, EveryModelHasAnObjectOfItsOwn) {
  w.spawnText(withElement(kivaText(), patrol("<x>3</x>")), "kiva1", 0, 0);
  w.spawnText(withElement(kivaText(), patrol("<x>-4</x>")), "kiva2", 0, 5);
  w.world.remove("kiva1");  // and kiva2 takes its index
  w.runUntil([&] { return std::abs(w.x(2) + 4) < kMillimetre; }, 20);
  EXPECT_EQ(w.count(Event::Kind::kAccepted, "kiva1"), 0);
}

// --- checkpoints

TEST_F(UserPlugin, TakesPartInCheckpoints) {
  w.spawnText(withElement(kivaText(), patrol("<x>3</x><pause>0.5</pause>")), "kiva1", 0, 0);
  w.runUntil([&] { return std::abs(w.x(1) - 3) < kMillimetre; }, 20);
  w.run(2);  // on its way back
  const std::string saved = w.world.checkpoint();
  w.run(5);
  const std::uint64_t hash = w.world.stateHash();
  Warehouse other;
  for (World* world : {&w.world, &other.world}) {
    world->restore(saved);
    for (int i = 0; i < 5000; ++i) world->step();
    EXPECT_EQ(world->stateHash(), hash);
  }
}

// --- what is refused

TEST_F(UserPlugin, AnUnknownParameterIsRefusedAndTheKnownOnesAreNamed) {
  const std::string reason = refusal(patrol("<x>3</x><pouse>1</pouse>"));
  EXPECT_PRED2(contains, reason, "unknown parameter 'pouse'");
  EXPECT_PRED2(contains, reason, "'pause', 'x', 'y'");
}

TEST_F(UserPlugin, AParameterOutOfItsRangeIsRefused) {
  EXPECT_PRED2(contains, refusal(patrol("<pause>-1</pause>")), "'pause' is '-1'");
}

TEST_F(UserPlugin, WhatThePluginThrowsIsTheReason) {
  EXPECT_PRED2(contains, refusal(patrol(""), "wall", "wall1"), "patrol is for robots");
}

TEST_F(UserPlugin, AMissingLibraryIsOneWarningThatNamesItAndWhatWasSearched) {
  setPath("/nowhere:/tmp");
  const std::string missing = "<plugin name='own' filename='libmissing.so'><x>1</x></plugin>";
  w.spawnText(withElement(kivaText(), missing), "kiva1", 0, 0);
  w.spawnText(withElement(modelText("wall"), missing), "wall1", 3, 0);
  const auto warnings = w.world.takeWarnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(contains, warnings[0], "libmissing.so");
  EXPECT_PRED2(contains, warnings[0], "KIVA_PLUGIN_PATH='/nowhere:/tmp'");
  EXPECT_PRED2(contains, warnings[0], "plugin 'own'");
  w.movx(1, 1);
  w.runUntilIdle(1);
  w.expectAt(1, 1, 0);
}

TEST_F(UserPlugin, ALibraryOfASourcedWorkspaceIsFound) {
  setPath("");
  const char* prefixes = std::getenv("CMAKE_PREFIX_PATH");
  const std::string before = prefixes ? prefixes : "";
  setenv("CMAKE_PREFIX_PATH", ("/nowhere:" + libraryFolder() + "/..").c_str(), true);
  w.spawnText(withElement(kivaText(), patrol("<x>3</x>")), "kiva1", 0, 0);
  setenv("CMAKE_PREFIX_PATH", before.c_str(), true);
  EXPECT_TRUE(w.world.takeWarnings().empty());
  w.runUntil([&] { return std::abs(w.x(1) - 3) < kMillimetre; }, 20);
}

TEST_F(UserPlugin, ADocumentDoesNotChooseTheFolderOfALibrary) {
  const std::string path = libraryFolder() + "/libhello_plugin.so";
  for (const std::string& name : {path, std::string("../lib/libhello_plugin.so")}) {
    w.spawnText(withElement(kivaText(), "<plugin name='patrol' filename='" + name + "'/>"), "kiva1",
                0, 0);
    const auto warnings = w.world.takeWarnings();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_PRED2(contains, warnings[0], "'" + name + "' is a path");
    w.world.remove("kiva1");
  }
  // Nor does the dynamic linker, which knows the system's libraries.
  w.spawnText(withElement(kivaText(), "<plugin name='c' filename='libc.so.6'/>"), "kiva1", 0, 0);
  const auto warnings = w.world.takeWarnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(contains, warnings[0], "there is no library 'libc.so.6'");
}

TEST_F(UserPlugin, AFileThatIsNoLibraryIsNamed) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "kiva_no_library";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "libtext.so") << "not a library";
  setPath(folder.string());
  EXPECT_PRED2(contains, refusal("<plugin name='own' filename='libtext.so'/>"), "libtext.so");
  std::filesystem::remove_all(folder);
}

TEST_F(UserPlugin, ALibraryWithoutAPluginIsNamed) {
  const std::string reason = refusal("<plugin name='own' filename='libkiva_core.so'/>");
  EXPECT_PRED2(contains, reason, "library 'libkiva_core.so' holds no class registered");
}

TEST_F(UserPlugin, ALibraryOfOtherClassesIsNamedWithWhatItHolds) {
  const std::string reason = refusal("<plugin name='own' filename='libright_of_way.so'/>");
  EXPECT_PRED2(contains, reason, "holds no class registered");
  EXPECT_PRED2(contains, reason, "it has RightOfWay (fleet::Planner)");
}

TEST_F(UserPlugin, AWorldWithAFaultyPluginGoesWithoutIt) {
  Floorplan plan;
  plan.more = patrol("");
  Warehouse other(plan);
  const auto warnings = other.world.takeWarnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_PRED2(contains, warnings[0], "left out: ");
}

TEST_F(UserPlugin, AWorldWithoutItsPluginIsAWarning) {
  Floorplan plan;
  plan.more = "<plugin name='own' filename='libmissing.so'/>";
  Warehouse other(plan);
  EXPECT_EQ(other.world.takeWarnings().size(), 1u);
}

// --- a table of plugins that is asked first

/// Notes its parameters; refuses a model on demand.
struct Noting : Plugin {
  Noting(bool is_strict, std::map<std::string, std::string>* notes)
      : is_strict_(is_strict), notes_(notes) {}
  void load(World&, const std::string& model, const Parameters& parameters) override {
    (*notes_)[model] = parameters.text("robotNamespace", "none");
    parameters.number("size", 1, 0, 9);
  }
  bool isStrict() const override { return is_strict_; }
  void reset(World&) override { (*notes_)["reset"] = "yes"; }

 private:
  bool is_strict_;
  std::map<std::string, std::string>* notes_;
};

class PluginTable : public UserPlugin {
 protected:
  PluginTable() {
    plan.options.plugins = [this](const std::string& file, const SensorDescription* in) {
      sensor = in ? in->name : "";
      const bool known = file == "libstrict.so" || file == "liblenient.so";
      return known ? std::make_shared<Noting>(file == "libstrict.so", &notes) : nullptr;
    };
  }
  static std::string plugin(const std::string& file, const std::string& parameters = "") {
    return "<plugin name='p' filename='" + file + "'>" + parameters + "</plugin>";
  }

  Floorplan plan;
  std::string sensor;
  std::map<std::string, std::string> notes;
};

TEST_F(PluginTable, TellsEachTheNamespaceOfItsModel) {
  Warehouse other(plan);
  auto wall = instance(withElement(modelText("wall"), plugin("libstrict.so")), "wall1");
  wall.robot_namespace = "/mine";
  other.world.spawn(wall);
  EXPECT_EQ(notes.at("wall1"), "/mine");
  wall = instance(withElement(modelText("wall"), plugin("libstrict.so",
                                                        "<robotNamespace>own"
                                                        "</robotNamespace>")),
                  "wall2", Pose(3, 0, 0, 0, 0, 0));
  wall.robot_namespace = "/mine";
  other.world.spawn(wall);
  EXPECT_EQ(notes.at("wall2"), "own");
}

TEST_F(PluginTable, KivasTakeANamespaceTooThoughTheirPluginsHaveNoUseForIt) {
  Warehouse other(plan);
  other.spawnText(replaced(kivaText(), "</plugin>", "<robotNamespace>x</robotNamespace></plugin>"),
                  "kiva1", 0, 0);
  EXPECT_TRUE(other.world.has("kiva1"));
}

TEST_F(PluginTable, FindsThoseInSensors) {
  Warehouse other(plan);
  other.spawnText(
      "<sdf version='1.9'><model name='m'><link name='l'><sensor name='eye' type='ray'>" +
          plugin("libstrict.so") + "</sensor></link></model></sdf>",
      "m", 0, 0);
  EXPECT_EQ(sensor, "eye");
  EXPECT_EQ(notes.at("m"), "none");
}

TEST_F(PluginTable, WhatALenientOneThrowsIsAWarning) {
  Warehouse other(plan);
  const auto wall = [&](const std::string& file, const std::string& parameters) {
    return withElement(modelText("wall"), plugin(file, parameters));
  };
  other.spawnText(wall("liblenient.so", "<size>huge</size>"), "wall1", 0, 0);
  other.spawnText(wall("liblenient.so", "<colour>red</colour>"), "wall2", 3, 0);
  const auto warnings = other.world.takeWarnings();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_PRED2(contains, warnings[0], "'size' is 'huge'");
  EXPECT_PRED2(contains, warnings[1], "colour");
  EXPECT_THROW(other.spawnText(wall("libstrict.so", "<size>huge</size>"), "wall3", 6, 0),
               DescriptionError);
}

TEST_F(PluginTable, TellsOfAReset) {
  Warehouse other(plan);
  other.spawnText(withElement(modelText("wall"), plugin("libstrict.so")), "wall1", 0, 0);
  other.world.reset(false);
  EXPECT_EQ(notes.count("reset"), 1u);
}

// --- when they are called

/// Runs a script around the step.
struct Scripted : Plugin {
  std::function<void(World&)> before = [](World&) {};
  std::function<void(const World&)> after = [](const World&) {};
  void load(World&, const std::string&, const Parameters&) override {}
  void beforeStep(World& world, double) override { before(world); }
  void afterStep(const World& world, double) override { after(world); }
};

class PluginCalls : public UserPlugin {
 protected:
  /// A plugin of a model that stands, or of the world.
  Scripted& script(const std::string& model = "") {
    auto plugin = std::make_shared<Scripted>();
    WorldState& parts = insideOf(w.world);
    if (model.empty()) {
      parts.plugins.world.push_back(plugin);
    } else {
      parts.models.find(model)->plugins.push_back(plugin);
      parts.models.with_plugins.push_back(parts.models.slot_of_name.at(model));
    }
    return *plugin;
  }
};

/// Remembers a number, and fails to go back to 13.
struct CountingPlugin : Plugin {
  int count = 0;
  void load(World&, const std::string&, const Parameters&) override {}
  std::string save() const override { return std::to_string(count); }
  void restore(World&, const std::string& state) override {
    count = std::stoi(state);
    if (count == 13) throw std::runtime_error("an unlucky number");
  }
};

TEST_F(PluginCalls, ThatFailToRestoreLeaveTheWorldAsItWas) {
  w.spawn("wall", "wall1", 0, 0);
  const auto first = std::make_shared<CountingPlugin>(),
             second = std::make_shared<CountingPlugin>();
  insideOf(w.world).plugins.world = {first, second};
  first->count = 1;
  second->count = 13;
  const std::string saved = w.world.checkpoint();
  first->count = 2;
  second->count = 3;
  w.spawn("wall", "wall2", 5, 5);
  EXPECT_THROW(w.world.restore(saved), std::runtime_error);
  EXPECT_TRUE(w.world.has("wall2"));
  EXPECT_EQ(first->count, 2);
  EXPECT_EQ(second->count, 3);
  w.step();
}

TEST_F(PluginCalls, AreBeforeAndAfterEachStep) {
  w.spawn("wall", "wall1", 0, 0);
  for (const char* model : {"", "wall1"}) {
    const auto steps = std::make_shared<std::vector<std::uint64_t>>();
    Scripted& plugin = script(model);
    plugin.before = [steps](World& world) { steps->push_back(world.steps()); };
    plugin.after = [steps](const World& world) { steps->push_back(world.steps()); };
    w.world.reset(true);
    w.step();
    w.step();
    EXPECT_EQ(*steps, (std::vector<std::uint64_t>{0, 1, 1, 2})) << model;
  }
}

TEST_F(PluginCalls, MayPushABody) {
  w.spawn("item", "item1", 0, 0);
  script("item1").before = [](World& world) {
    world.applyWrench("item1", "body", {0, 0, 3 * 9.81}, {});  // twice its weight
  };
  w.run(1);
  EXPECT_NEAR(w.itemPose("item1").Z(), 0.5 * 9.81, 0.05);
}

TEST_F(PluginCalls, MaySpawnModelsWithPlugins) {
  w.spawn("wall", "wall1", 0, 0);
  const std::string robot = withElement(kivaText(), patrol("<x>3</x>"));
  int spawned = 0;
  script("wall1").before = [&](World& world) {
    if (spawned == 20) return;
    ++spawned;
    world.spawn(
        instance(robot, "kiva" + std::to_string(spawned), Pose(0, 2 * spawned, 0, 0, 0, 0)));
  };
  w.run(1);
  EXPECT_EQ(w.world.fleet().size(), 20);
}

TEST_F(PluginCalls, MayRemoveModelsTheirOwnAmongThem) {
  for (int i = 1; i <= 5; ++i) w.spawn("wall", "wall" + std::to_string(i), i, 0);
  for (int i = 1; i <= 5; ++i) {
    script("wall" + std::to_string(i)).before = [i](World& world) {
      world.remove("wall" + std::to_string(i % 5 + 1));
      if (i == 3) world.remove("wall3");
    };
  }
  w.run(0.01);
  EXPECT_FALSE(w.world.has("wall3"));
}

TEST_F(PluginCalls, EndWithTheirModel) {
  w.spawn("wall", "wall1", 0, 0);
  int calls = 0;
  script("wall1").before = [&](World&) { ++calls; };
  w.step();
  w.world.remove("wall1");
  w.run(0.01);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace kiva::test
