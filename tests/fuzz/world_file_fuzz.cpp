// SPDX-License-Identifier: Apache-2.0
//
// Feeds damaged SDF and URDF to the parsers of worlds and spawn requests, and builds what passes.
// Each must end in a world or in a DescriptionError with a reason.
//
//   world_file_fuzz COUNT SEED SECONDS KEPT    stops after COUNT files or SECONDS of wall time
// The present file is written to KEPT first, so that it survives a crash of the process.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"

namespace {

namespace fs = std::filesystem;

const std::string kTests = TESTS_DIR;
const kiva::ModelPaths kPaths{std::string(WORLDS_DIR) + "/models", kTests + "/worlds/models",
                              kTests + "/worlds"};
constexpr std::size_t kLongest = 20000;  // length of a seed; longer ones take the time of many
constexpr int kSteps = 3;

std::string textOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> readSeeds() {
  std::vector<std::string> seeds;
  for (const char* folder : {WORLDS_DIR, TESTS_DIR "/worlds", TESTS_DIR "/fuzz/seeds"}) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const std::string ending = entry.path().extension();
      if (ending != ".sdf" && ending != ".world" && ending != ".urdf") continue;
      // Files that are refused from the start lead nowhere.
      if (entry.path().filename().string().rfind("invalid_", 0) == 0) continue;
      const std::string text = textOf(entry.path());
      if (!text.empty() && text.size() < kLongest) seeds.push_back(text);
    }
  }
  return seeds;
}

/// Damages texts: bytes, pieces, numbers, tags, depth, entities.
class Mutator {
 private:
  std::size_t below(std::size_t limit) { return limit ? random_() % limit : 0; }

  template <typename List>
  const auto& any(const List& list) {
    return list[below(std::size(list))];
  }

 public:
  Mutator(std::vector<std::string> seeds, unsigned long seed)
      : seeds_(std::move(seeds)), random_(seed) {}

  std::string next() {
    std::string text = any(seeds_);
    for (std::size_t i = 1 + below(3); i > 0 && !text.empty(); --i) damage(&text);
    return text;
  }

 private:
  void damage(std::string* text) {
    switch (below(10)) {
      case 0:
        (*text)[below(text->size())] = static_cast<char>(random_());
        return;
      case 1:
        text->erase(below(text->size()), below(40));
        return;
      case 2:
        text->insert(below(text->size()), any(seeds_).substr(0, below(200)));
        return;
      case 3:
        return repeat(text);
      case 4:
        return replaceNumber(text);
      case 5:
        return renameTag(text);
      case 6:
        return moveElement(text);
      case 7:
        return nest(text);
      case 8:
        return addEntity(text);
      default:
        return replaceText(text);
    }
  }

  void repeat(std::string* text) {
    const std::string piece = text->substr(below(text->size()), below(100));
    const std::size_t at = below(text->size());
    for (std::size_t i = below(6); i > 0; --i) text->insert(at, piece);
  }

  void replaceNumber(std::string* text) {
    static const char* const kNumbers[] = {
        "nan",        "-inf", "1e308", "-1e308", "1e-308",        "0",  "-0",  "-1",
        "4294967296", "0x10", "",      "1,5",    "1 2 3 4 5 6 7", "1e", "--1", "2147483648"};
    const std::size_t from = text->find_first_of("0123456789", below(text->size()));
    if (from == std::string::npos) return;
    const std::size_t to = text->find_first_not_of("0123456789.e-", from);
    text->replace(from, to == std::string::npos ? to : to - from, any(kNumbers));
  }

  static constexpr const char* kWords[] = {
      "model",   "link",      "joint",    "include", "world",    "frame",   "pose",   "collision",
      "visual",  "geometry",  "box",      "mesh",    "inertial", "inertia", "plugin", "uri",
      "name",    "axis",      "xyz",      "limit",   "polyline", "point",   "sensor", "population",
      "state",   "actor",     "submesh",  "scale",   "static",   "robot",   "origin", "heightmap",
      "surface", "friction",  "material", "script",  "parent",   "child",   "light",  "physics",
      "gravity", "__model__", "world::a", "a::b",    "__root__", "sdf",     "size",   "radius"};

  void renameTag(std::string* text) {
    const std::size_t at = text->find('<', below(text->size()));
    if (at == std::string::npos) return;
    const std::size_t from = at + 1 + ((*text)[at + 1] == '/' ? 1 : 0);
    const std::size_t to = text->find_first_of(" >/\n", from);
    if (to != std::string::npos) text->replace(from, to - from, any(kWords));
  }

  void moveElement(std::string* text) {
    const std::size_t from = text->find('<', below(text->size()));
    if (from == std::string::npos) return;
    const std::size_t to = text->find('>', from + below(200));
    if (to == std::string::npos) return;
    const std::string piece = text->substr(from, to + 1 - from);
    if (below(2)) text->erase(from, piece.size());
    const std::size_t at = text->find('<', below(text->size()));
    text->insert(at == std::string::npos ? 0 : at, piece);
  }

  /// Puts an element into many others of one kind.
  void nest(std::string* text) {
    const std::size_t at = text->find('<', below(text->size()));
    if (at == std::string::npos) return;
    const std::string word = any(kWords);
    const std::size_t depth = below(10) ? below(12) : below(2000);
    std::string opened, closed;
    for (std::size_t i = 0; i < depth; ++i) {
      opened += "<" + word + " name='n" + std::to_string(below(3)) + "'>";
      closed += "</" + word + ">";
    }
    text->insert(below(text->size() - at) + at, closed);
    text->insert(at, opened);
  }

  /// Declares entities that would grow to a billion letters, and uses one.
  void addEntity(std::string* text) {
    std::string declared = "<!DOCTYPE sdf [<!ENTITY e0 '1 0 0'>";
    for (int i = 1; i < 10; ++i) {
      const std::string last = "&e" + std::to_string(i - 1) + ";";
      declared += "<!ENTITY e" + std::to_string(i) + " '";
      for (int j = 0; j < 10; ++j) declared += last;
      declared += "'>";
    }
    const std::size_t at = text->find('>', below(text->size()));
    if (at != std::string::npos) text->insert(at + 1, "&e9;");
    text->insert(0, declared + "]>");
  }

  void replaceText(std::string* text) {
    const std::size_t from = text->find_first_of(">\"'", below(text->size()));
    if (from == std::string::npos) return;
    const std::size_t to = text->find_first_of("<\"'", from + 1);
    if (to == std::string::npos) return;
    static const std::string kLong(5000, 'x');
    const std::string word = below(20) ? any(kWords) : kLong;
    text->replace(from + 1, to - from - 1, word);
  }

  const std::vector<std::string> seeds_;
  std::mt19937_64 random_;
};

/// Returns whether a world resulted.
bool tryWorld(const std::string& text) {
  std::vector<std::string> warnings;
  kiva::World world(kiva::parseWorld(text, kPaths, "fuzz.sdf", &warnings));
  for (int i = 0; i < kSteps; ++i) world.step();
  return true;
}

bool tryModels(const std::string& text) {
  std::vector<std::string> warnings;
  const auto models = kiva::parseModels(text, kPaths, "fuzz.sdf", &warnings);
  kiva::World world((kiva::WorldDescription()));
  world.spawn(models);
  for (int i = 0; i < kSteps; ++i) world.step();
  return true;
}

/// Reads the text as the model of a folder, which a world includes directly, merged into a model,
/// and nested in one.
bool tryInclude(const std::string& text, const fs::path& library) {
  const fs::path folder = library / "damaged";
  fs::create_directories(folder);
  std::ofstream(folder / "model.sdf", std::ios::binary) << text;
  std::ofstream(folder / "model.config")
      << "<model><name>damaged</name><sdf version='1.9'>model.sdf</sdf></model>";
  constexpr char kInclude[] = "<include><uri>model://damaged</uri></include>";
  constexpr char kMerged[] = "<include merge='true'><uri>model://damaged</uri></include>";
  const std::string world = std::string("<sdf version='1.9'><world name='w'>") + kInclude +
                            "<model name='merged'>" + kMerged + "</model><model name='around'>" +
                            kInclude + "<link name='own'/></model></world></sdf>";
  kiva::ModelPaths paths = kPaths;
  paths.push_back(library.string());
  std::vector<std::string> warnings;
  kiva::World built(kiva::parseWorld(world, paths, "fuzz.sdf", &warnings));
  for (int i = 0; i < kSteps; ++i) built.step();
  return warnings.empty();
}

template <typename Attempt>
bool passes(const Attempt& attempt) {
  try {
    return attempt();
  } catch (const kiva::DescriptionError& error) {
    if (*error.what()) return false;
    throw std::logic_error("an error without a word");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: world_file_fuzz COUNT SEED SECONDS KEPT\n";
    return 2;
  }
  const long count = std::atol(argv[1]);
  const std::chrono::duration<double> limit(std::atof(argv[3]));
  const auto start = std::chrono::steady_clock::now();
  Mutator mutator(readSeeds(), std::strtoul(argv[2], nullptr, 10));
  const fs::path library = std::string(argv[4]) + "_models";
  long done = 0, passed = 0;
  for (; done < count && std::chrono::steady_clock::now() - start < limit; ++done) {
    const std::string text = mutator.next();
    std::ofstream(argv[4], std::ios::binary) << text;
    const bool is_world = text.find("<world") != std::string::npos;
    passed += passes([&] { return is_world ? tryWorld(text) : tryModels(text); });
    if (!is_world) passes([&] { return tryInclude(text, library); });
  }
  fs::remove(argv[4]);
  fs::remove_all(library);
  std::printf("%ld files, %ld of them still worlds or models\n", done, passed);
  if (done < count) std::cerr << "out of time after " << done << " of " << count << " files\n";
  return done < count ? 1 : 0;
}
