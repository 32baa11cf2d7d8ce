// SPDX-License-Identifier: Apache-2.0
//
// Descriptions of each world and model file of the tests and of the project: compared with
// tests/worlds/descriptions, number by number, warnings and errors included. After an intended
// change, RECORD_DESCRIPTIONS=1 writes them again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "kiva_plugin_cpp/world_file.h"

namespace kiva {
namespace {

namespace fs = std::filesystem;

const std::string kTests = TESTS_DIR, kTop = fs::path(TESTS_DIR).parent_path().string();
const ModelPaths kPaths{std::string(WORLDS_DIR) + "/models", kTests + "/worlds/models",
                        kTests + "/worlds"};

/// A description as lines of words, indented by what holds what.
class Writer {
 public:
  std::string text() const { return out_.str(); }

  void write(const WorldDescription& world) {
    out_ << "world " << world.name << " gravity " << text(world.gravity) << " step "
         << world.step_size << " factor " << world.real_time_factor << '\n';
    for (const ModelInstance& model : world.models) write(model);
    for (const Light& light : world.lights) write(light);
    for (const PluginDescription& plugin : world.plugins) write(plugin, " ");
  }

  void write(const ModelInstance& model) {
    out_ << "model " << model.name << " at " << text(model.pose) << '\n';
    if (model.walk) write(*model.walk);
    const ModelDescription& of = *model.description;
    std::ostringstream own;
    std::swap(own, out_);
    out_.precision(17);
    out_ << " static " << of.is_static << '\n';
    for (const std::string& name : of.nested_models) out_ << " nested " << name << '\n';
    for (const Link& link : of.links) write(link);
    for (const Joint& joint : of.joints) write(joint);
    for (const SensorDescription& sensor : of.sensors) write(sensor);
    for (const PluginDescription& plugin : of.plugins) write(plugin, " ");
    std::swap(own, out_);
    // Models that are alike are written once.
    const auto [known, is_new] = known_.try_emplace(own.str(), model.name);
    out_ << (is_new ? own.str() : " like " + known->second + '\n');
  }

  void write(const Light& light) {
    out_ << "light " << light.name << " kind " << static_cast<int>(light.kind) << " at "
         << text(light.pose) << " diffuse " << text(light.diffuse) << " specular "
         << text(light.specular) << " fades " << light.attenuation_constant << ' '
         << light.attenuation_linear << ' ' << light.attenuation_quadratic << " towards "
         << text(light.direction) << " shadows " << light.cast_shadows << '\n';
  }

  /// Writes a line; folders are relative to the top of the project.
  void writeLine(const std::string& word, std::string line) {
    const std::string above = fs::path(kTop).parent_path().string() + ",";
    for (const auto& [folder, name] : {std::pair{kTop, "TOP"}, {above, "ABOVE,"}}) {
      for (std::size_t at = 0; (at = line.find(folder, at)) != std::string::npos; ++at) {
        const bool begins_path = at == 0 || !std::isalnum(static_cast<unsigned char>(line[at - 1]));
        if (begins_path) line.replace(at, folder.size(), name);
      }
    }
    out_ << word << ' ' << line << '\n';
  }

  Writer() { out_.precision(17); }

 private:
  static std::string text(const Vector3& v) {
    std::ostringstream out;
    out << std::setprecision(17) << v.X() << ' ' << v.Y() << ' ' << v.Z();
    return out.str();
  }
  static std::string text(const Pose& pose) {
    const Quaternion& q = pose.Rot();
    std::ostringstream out;
    out << std::setprecision(17) << text(pose.Pos()) << " | " << q.W() << ' ' << q.X() << ' '
        << q.Y() << ' ' << q.Z();
    return out.str();
  }
  static std::string text(const double (&colour)[4]) {
    std::ostringstream out;
    for (const double part : colour) out << std::setprecision(9) << part << ' ';
    return out.str();
  }

  void write(const Walk& walk) {
    out_ << " walk loops " << walk.loops << '\n';
    for (const Waypoint& to : walk.waypoints) {
      out_ << "  to " << to.x << ' ' << to.y << " pause " << to.pause << " speed " << to.speed
           << '\n';
    }
  }

  void write(const Shape& shape) {
    out_ << " shape " << static_cast<int>(shape.kind);
    switch (shape.kind) {
      case Shape::Kind::kBox:
      case Shape::Kind::kEllipsoid:
        out_ << ' ' << text(shape.size);
        break;
      case Shape::Kind::kPlane:
        out_ << ' ' << text(shape.normal) << ' ' << shape.plane_size[0] << ' '
             << shape.plane_size[1];
        break;
      case Shape::Kind::kMesh:
        write(shape.mesh.get(), shape.mesh_file, shape.mesh_scale);
        break;
      default:
        out_ << ' ' << shape.radius << ' ' << shape.length;
    }
    out_ << '\n';
  }

  void write(const Mesh* mesh, const std::string& file, const Vector3& scale) {
    out_ << ' ' << (file.empty() ? "extruded" : fs::relative(file, kTop).string()) << " scale "
         << text(scale);
    if (!mesh) return;
    Vector3 sum;
    for (const Vector3& vertex : mesh->vertices) sum += vertex;
    out_ << " vertices " << mesh->vertices.size() << " triangles " << mesh->triangles.size()
         << " box " << text(mesh->min) << " to " << text(mesh->max) << " sum " << text(sum);
  }

  void write(const Link& link) {
    out_ << " link " << link.name << " at " << text(link.pose_in_model) << " mass " << link.mass
         << " about " << text(link.inertial_pose_in_link) << " moments "
         << text(link.principal_moments) << " gravity " << link.gravity << '\n';
    for (const Collision& part : link.collisions) {
      out_ << "  collision " << part.name << " at " << text(part.pose_in_link) << " friction "
           << part.friction << " restitution " << part.restitution;
      write(part.shape);
    }
    for (const Visual& part : link.visuals) {
      out_ << "  visual " << part.name << " at " << text(part.pose_in_link) << " rgba "
           << text(part.rgba);
      write(part.shape);
    }
  }

  void write(const Joint& joint) {
    out_ << " joint " << joint.name << " kind " << static_cast<int>(joint.kind) << " from "
         << joint.parent << " to " << joint.child << " at " << text(joint.anchor_in_model)
         << " axis " << text(joint.axis_in_model) << " from " << joint.lower << " to "
         << joint.upper << " most " << joint.max_effort << ' ' << joint.max_velocity << " damping "
         << joint.damping << " friction " << joint.friction << '\n';
  }

  void write(const SensorDescription& sensor) {
    out_ << " sensor " << sensor.name << " type " << sensor.type << " of " << sensor.link << " at "
         << text(sensor.pose_in_link) << " rate " << sensor.update_rate << '\n';
    write(sensor.parameters, "  ");
    for (const PluginDescription& plugin : sensor.plugins) write(plugin, "  ");
  }

  void write(const PluginDescription& plugin, const std::string& indent) {
    out_ << indent << "plugin " << plugin.name << " file " << plugin.filename << '\n';
    write(plugin.parameters, indent + " ");
  }

  void write(const Parameters& parameters, const std::string& indent) {
    writeLine(indent + "where", parameters.where());
    for (auto [key, value] : parameters.values()) {
      std::replace(value.begin(), value.end(), '\n', ' ');
      out_ << indent << key << " = " << value << '\n';
    }
  }

  std::ostringstream out_;
  std::map<std::string, std::string> known_;
};

bool isModel(const fs::path& file) {
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return text.find("<world") == std::string::npos;
}

std::string describedAsModels(const fs::path& file) {
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  Writer out;
  std::vector<std::string> warnings;
  std::vector<Light> lights;
  try {
    const auto models = parseModels(text, kPaths, file.string(), &warnings, &lights);
    for (const ModelInstance& model : models) out.write(model);
    for (const Light& light : lights) out.write(light);
  } catch (const DescriptionError& error) {
    out.writeLine("error", error.what());
  }
  for (const std::string& warning : warnings) out.writeLine("warning", warning);
  return out.text();
}

std::string describedAsWorld(const fs::path& file) {
  Writer out;
  std::vector<std::string> warnings;
  try {
    ModelPaths paths = kPaths;
    for (const std::string& path : modelPathsAround(file.string())) paths.push_back(path);
    out.write(loadWorld(file.string(), paths, &warnings));
  } catch (const DescriptionError& error) {
    out.writeLine("error", error.what());
  }
  for (const std::string& warning : warnings) out.writeLine("warning", warning);
  return out.text();
}

std::vector<fs::path> documents() {
  std::vector<fs::path> files;
  for (const std::string& folder : {kTests + "/worlds", std::string(WORLDS_DIR)}) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const std::string ending = entry.path().extension();
      if (ending == ".sdf" || ending == ".world" || ending == ".urdf") files.push_back(entry);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

fs::path recordOf(const fs::path& document) {
  std::string name = fs::relative(document, kTop).string();
  std::replace(name.begin(), name.end(), '/', '.');
  return fs::path(kTests) / "worlds" / "descriptions" / (name + ".txt");
}

/// Returns whether words are equal, or numbers that differ by rounding alone.
bool areAlike(const std::string& a, const std::string& b) {
  if (a == b) return true;
  char *end_a, *end_b;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  if (*end_a || *end_b) return false;
  return std::abs(x - y) <= 1e-12 * std::max({std::abs(x), std::abs(y), 1.0});
}

void expectAlike(const std::string& read, const std::string& recorded) {
  std::istringstream now(read), other(recorded);
  int line = 0;
  for (std::string a, b;;) {
    const bool has_a = !!std::getline(now, a), has_b = !!std::getline(other, b);
    if (!has_a && !has_b) return;
    ++line;
    std::istringstream words_a(has_a ? a : ""), words_b(has_b ? b : "");
    for (std::string x, y;;) {
      const bool more_a = !!(words_a >> x), more_b = !!(words_b >> y);
      if (more_a == more_b && (!more_a || areAlike(x, y))) {
        if (!more_a) break;
        continue;
      }
      ADD_FAILURE() << "line " << line << "\n  read:     " << a << "\n  recorded: " << b;
      return;
    }
  }
}

TEST(Descriptions, AreAsTheyWereRecorded) {
  for (const fs::path& document : documents()) {
    SCOPED_TRACE(document.string());
    const std::string read =
        isModel(document) ? describedAsModels(document) : describedAsWorld(document);
    if (std::getenv("RECORD_DESCRIPTIONS")) {
      std::ofstream(recordOf(document)) << read;
      continue;
    }
    std::ifstream in(recordOf(document));
    ASSERT_TRUE(in) << "there is no " << recordOf(document);
    expectAlike(read, {std::istreambuf_iterator<char>(in), {}});
  }
}

}  // namespace
}  // namespace kiva
