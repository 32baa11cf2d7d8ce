// SPDX-License-Identifier: Apache-2.0
//
// Files that would take all memory, all stack or minutes are refused before the work begins.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <tinyxml2.h>
#include <unistd.h>

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "warehouse.h"

namespace kiva::test {
namespace {

namespace fs = std::filesystem;

/// A folder of models that ends with the test.
class Models {
 public:
  Models() : folder_(fs::temp_directory_path() / ("limits_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Models() { fs::remove_all(folder_); }

  /// A model with a link, and what else is given.
  void add(const std::string& name, const std::string& inside) const {
    write(name + "/model.config",
          "<model><name>" + name + "</name><sdf version='1.6'>model.sdf</sdf></model>");
    write(name + "/model.sdf", "<sdf version='1.6'><model name='" + name + "'><link name='l'/>" +
                                   inside + "</model></sdf>");
  }
  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file, std::ios::binary) << text;
  }
  std::string path(const std::string& file) const { return (folder_ / file).string(); }
  ModelPaths paths() const { return {folder_.string()}; }

 private:
  fs::path folder_;
};

std::string include(const std::string& uri, const std::string& name = "inner") {
  return "<include><uri>" + uri + "</uri><name>" + name + "</name></include>";
}

/// What is warned of when models are read, joined by lines.
std::string warningsOf(const std::string& inside, const ModelPaths& paths) {
  std::vector<std::string> warnings;
  std::string all;
  try {
    parseWorld("<sdf version='1.6'><world name='w'>" + inside + "</world></sdf>", paths, "test",
               &warnings);
  } catch (const DescriptionError& error) {
    all = error.what();
  }
  for (const std::string& warning : warnings) all += warning + "\n";
  return all;
}

std::string model(const std::string& inside) {
  return "<model name='m'><link name='l'/>" + inside + "</model>";
}

double cpuSeconds(const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

TEST(Limits, EndIncludesInCircles) {
  const Models models;
  const std::string folder = models.path("circle"), file = models.path("circle/model.sdf");
  for (const std::string& uri :
       {std::string("model://circle"), std::string("model:&#47;/circle"), "file://" + folder,
        "file://" + file, folder, file, models.path("other/../circle/model.sdf")}) {
    models.add("other", "");
    models.add("circle", include(uri));
    for (const std::string& outer : {include(uri, "m"), model(include(uri))}) {
      EXPECT_PRED2(contains, warningsOf(outer, models.paths()), "includes itself") << uri;
    }
  }
}

TEST(Limits, EndIncludesThatMultiply) {
  const Models models;
  for (int i = 0; i < 14; ++i) {
    const std::string next = "model://m" + std::to_string(i + 1);
    models.add("m" + std::to_string(i), include(next, "a") + include(next, "b"));
  }
  models.add("m14", "");
  for (const std::string& outer : {include("model://m0", "m"), model(include("model://m0"))}) {
    EXPECT_PRED2(contains, warningsOf(outer, models.paths()), "more than 1000 includes");
  }
}

TEST(Limits, EndIncludesThatNestTooDeep) {
  const Models models;
  for (int i = 0; i < 100; ++i) {
    models.add("m" + std::to_string(i), include("model://m" + std::to_string(i + 1)));
  }
  models.add("m100", "");
  EXPECT_PRED2(contains, warningsOf(model(include("model://m0")), models.paths()),
               "nest deeper than 30");
}

TEST(Limits, EndTextsThatAreTooLong) {
  const Models models;
  const std::string blanks(20'000'001, ' ');
  EXPECT_PRED2(contains, warningsOf(blanks, {}), "expected at most 20000000");
  models.add("long", blanks);
  for (const std::string& outer : {include("model://long", "m"), model(include("model://long"))}) {
    EXPECT_PRED2(contains, warningsOf(outer, models.paths()), "expected at most 20000000");
  }
  models.write("long.world", blanks);
  try {
    loadWorld(models.path("long.world"), {});
    FAIL() << "no error";
  } catch (const DescriptionError& error) {
    EXPECT_PRED2(contains, error.what(), "long.world: it has 20000001 bytes");
  }
}

// Releases of tinyxml2 have different limits.
const std::string kTooDeep =
    "elements nest deeper than " + std::to_string(TINYXML2_MAX_ELEMENT_DEPTH);

TEST(Limits, EndTextsThatNestTooDeep) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += "<model name='m'>";
  EXPECT_PRED2(contains, warningsOf(text, {}), kTooDeep);
}

std::string mesh(const std::string& file) {
  return "<model name='m'><static>1</static><link name='l'><collision name='c'><geometry><mesh>"
         "<uri>file://" +
         file + "</uri></mesh></geometry></collision></link></model>";
}

/// The header alone says how many there are.
TEST(Limits, EndMeshesOfTooManyTriangles) {
  const Models models;
  const std::uint32_t count = 1'000'001;
  models.write("many.stl", std::string(80, ' ') +
                               std::string(reinterpret_cast<const char*>(&count), sizeof(count)));
  fs::resize_file(models.path("many.stl"), 84 + 50ull * count);
  models.write("many.dae",
               "<COLLADA><library_geometries><geometry><mesh><triangles count='10000000'/>"
               "</mesh></geometry></library_geometries></COLLADA>");
  std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 500'001; ++i) faces += "f 1 2 3 1\n";  // two triangles each
  models.write("many.obj", faces);
  for (const char* file : {"many.stl", "many.dae", "many.obj"}) {
    const std::string warning = warningsOf(mesh(models.path(file)), {});
    EXPECT_PRED2(contains, warning, "more than 1000000 triangles") << file;
    EXPECT_PRED2(contains, warning, file);
  }
}

TEST(Limits, EndMeshFilesThatAreTooLong) {
  const Models models;
  models.write("long.dae", "<COLLADA/>");
  fs::resize_file(models.path("long.dae"), 100'000'001);
  EXPECT_PRED2(contains, warningsOf(mesh(models.path("long.dae")), {}),
               "expected at most 100000000");
}

TEST(Limits, LeaveMeshesAloneThatAreNoRegularFiles) {
  const Models models;
  ASSERT_EQ(mkfifo(models.path("pipe.stl").c_str(), 0600), 0);
  EXPECT_PRED2(contains, warningsOf(mesh(models.path("pipe.stl")), {}), "there is no file");
}

TEST(Limits, EndMeshFilesThatNestTooDeep) {
  const Models models;
  std::string text = "<COLLADA><library_visual_scenes><visual_scene>";
  for (int i = 0; i < 100'000; ++i) text += "<node>";
  models.write("deep.dae", text);
  EXPECT_PRED2(contains, warningsOf(mesh(models.path("deep.dae")), {}), kTooDeep);
}

/// It took 82 s: each of its triangles was noted in a million cells.
TEST(Limits, LetWhatIsLargeBeLarge) {
  std::string points;
  for (int i = 0; i < 60; ++i) {
    points += "<point>" + number(1000 * std::cos(i * M_PI / 30)) + " " +
              number(1000 * std::sin(i * M_PI / 30)) + "</point>";
  }
  const std::string dome =
      "<model name='dome'><static>1</static><link name='l'><collision "
      "name='c'><geometry><polyline>" +
      points + "<height>3</height></polyline></geometry></collision></link></model>";
  Floorplan plan;
  plan.more = dome;
  EXPECT_LT(cpuSeconds([&] {
              Warehouse w(plan);
              w.spawn("kiva", "kiva1", 0, 0);
              w.movx(1, 2);
              w.run(1);
              w.world.occupancy();
            }),
            8);
}

/// A hundred faults are reported, without reading a thousand megabytes for them.
TEST(Limits, LetFaultsBeMany) {
  std::string models;
  for (int i = 0; i < 100; ++i) {
    models += "<model name='m" + std::to_string(i) +
              "'><link name='l'><collision name='c'><geometry><box><size>1 " + number(i + 1) +
              (i % 2 ? " 0.5" : " thick") + "</size></box></geometry></collision></link></model>\n";
  }
  std::vector<std::string> warnings;
  const auto world = parseWorld("<sdf version='1.6'><world name='w'>" + models + "</world></sdf>",
                                {}, "test", &warnings);
  EXPECT_EQ(world.models.size(), 100u);
}

}  // namespace
}  // namespace kiva::test
