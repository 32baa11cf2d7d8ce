// SPDX-License-Identifier: Apache-2.0
#include "world_file/parsing/population.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace kiva {
namespace {

constexpr std::size_t kMost = 10000;  // models

std::string textIn(const XmlElement* around, const char* name, const char* fallback) {
  const XmlElement* part = around ? around->FirstChildElement(name) : nullptr;
  return part ? contentOf(part) : fallback;
}

std::vector<double> numbersOf(const XmlElement* around, const char* name, std::size_t count,
                              const char* fallback) {
  const auto numbers = parseNumbers(textIn(around, name, fallback), count);
  if (numbers) return *numbers;
  throw DescriptionError("expected " + std::to_string(count) + " finite numbers in <" + name + ">");
}

std::size_t countOf(const XmlElement* around, const char* name) {
  const double count = numbersOf(around, name, 1, "1")[0];
  if (count >= 1 && count <= kMost && count == std::floor(count)) return std::size_t(count);
  throw DescriptionError("expected a whole number from 1 to " + std::to_string(kMost) + " in <" +
                         name + ">");
}

/// The region of a population: a box, or an upright cylinder, about the origin.
struct Region {
  Vector3 size;
  bool is_round = false;

  /// Returns a point; `share` is in 0…1 along each axis, for a cylinder along radius, angle and
  /// height.
  Vector3 at(const Vector3& share) const {
    const Vector3 even = (share - Vector3(0.5, 0.5, 0.5)) * size;
    if (!is_round) return even;
    const double radius = size.X() / 2 * std::sqrt(share.X()), angle = 2 * M_PI * share.Y();
    return {radius * std::cos(angle), radius * std::sin(angle), even.Z()};
  }
};

Region regionOf(const XmlElement& population) {
  if (const XmlElement* cylinder = population.FirstChildElement("cylinder")) {
    const double diameter = 2 * numbersOf(cylinder, "radius", 1, "1")[0];
    return {{diameter, diameter, numbersOf(cylinder, "length", 1, "1")[0]}, true};
  }
  const auto size = numbersOf(population.FirstChildElement("box"), "size", 3, "1 1 1");
  return {{size[0], size[1], size[2]}, false};
}

/// Returns the radical inverse; points of two or three of these are spread evenly (Halton 1960).
double radicalInverse(std::size_t index, std::size_t base) {
  double value = 0, digit = 1;
  for (; index > 0; index /= base) {
    digit /= static_cast<double>(base);
    value += digit * static_cast<double>(index % base);
  }
  return value;
}

std::vector<Vector3> gridPlaces(const XmlElement* distribution, std::size_t count) {
  const std::size_t rows = countOf(distribution, "rows"), columns = countOf(distribution, "cols");
  const auto step = numbersOf(distribution, "step", 3, "1 1 1");
  std::vector<Vector3> places;
  for (std::size_t i = 0; i < std::min(count, rows * columns); ++i) {
    const double row = static_cast<double>(i / columns), column = static_cast<double>(i % columns);
    places.emplace_back(step[0] * (column - static_cast<double>(columns - 1) / 2),
                        step[1] * (row - static_cast<double>(rows - 1) / 2), 0);
  }
  return places;
}

/// Returns the positions as shares of the region along each axis.
std::vector<Vector3> sharesOf(const std::string& type, std::size_t count) {
  std::mt19937_64 random;
  const auto any = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<Vector3> shares(count, Vector3(0.5, 0.5, 0.5));
  for (std::size_t i = 0; i < count; ++i) {
    const double along = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    if (type == "random") {
      for (int axis = 0; axis < 3; ++axis) shares[i][axis] = any();
    } else if (type == "uniform") {
      shares[i].Set(radicalInverse(i + 1, 2), radicalInverse(i + 1, 3), 0.5);
    } else if (type == "linear-x" || type == "linear-y" || type == "linear-z") {
      shares[i][type.back() - 'x'] = along;
    } else {
      throw DescriptionError("the distribution '" + type +
                             "' is unknown; expected random, uniform, grid, linear-x, linear-y or "
                             "linear-z");
    }
  }
  return shares;
}

std::vector<Vector3> placesOf(const XmlElement& population) {
  const std::size_t count = countOf(&population, "model_count");
  const XmlElement* const distribution = population.FirstChildElement("distribution");
  const std::string type = textIn(distribution, "type", "random");
  if (type == "grid") return gridPlaces(distribution, count);
  Region region = regionOf(population);
  region.is_round = region.is_round && type.compare(0, 6, "linear") != 0;
  std::vector<Vector3> places = sharesOf(type, count);
  for (Vector3& place : places) place = region.at(place);
  return places;
}

Pose poseOf(const XmlElement& element) {
  const auto pose = parsePose(textIn(&element, "pose", "0 0 0 0 0 0"));
  if (!pose) throw DescriptionError("expected six finite numbers in <pose>");
  return *pose;
}

std::string nameOf(const XmlElement& pattern) {
  if (std::string(pattern.Name()) == "model") return attributeOf(pattern, "name");
  const std::string uri = textIn(&pattern, "uri", "");
  return textIn(&pattern, "name", uri.substr(uri.rfind('/') + 1).c_str());
}

}  // namespace

Population readPopulation(const XmlElement& population) {
  Population out;
  out.pattern = population.FirstChildElement("model");
  if (!out.pattern) out.pattern = population.FirstChildElement("include");
  if (!out.pattern) throw DescriptionError("expected a <model>");
  out.name = nameOf(*out.pattern);
  if (out.name.empty()) throw DescriptionError("expected a model with a name");
  const Pose origin = poseOf(population), own = poseOf(*out.pattern);
  for (const Vector3& place : placesOf(population)) {
    out.poses.push_back(origin * Pose(place, Quaternion::Identity) * own);
  }
  return out;
}

}  // namespace kiva
