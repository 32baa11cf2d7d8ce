// SPDX-License-Identifier: Apache-2.0
#include "world_file/population.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

namespace kiva {
namespace {

using Parts = std::vector<XmlPart>;

constexpr std::size_t kMost = 10000;                // models
constexpr std::size_t kLongest = 64 * 1024 * 1024;  // [byte]

Parts childrenOf(const XmlPart& part) {
  auto children = partsOf(part.inside);
  if (!children) throw DescriptionError("<" + std::string(part.name) + "> is ill-formed");
  return *children;
}

std::string textOf(const Parts& parts, const char* name, const char* fallback) {
  const XmlPart* part = findPart(parts, name);
  return part ? trimmed(part->inside) : fallback;
}

std::vector<double> numbersOf(const Parts& parts, const char* name, std::size_t count,
                              const char* fallback) {
  const auto numbers = parseNumbers(textOf(parts, name, fallback), count);
  if (numbers) return *numbers;
  throw DescriptionError("expected " + std::to_string(count) + " finite numbers in <" + name + ">");
}

std::size_t countOf(const Parts& parts, const char* name) {
  const double count = numbersOf(parts, name, 1, "1")[0];
  if (count >= 1 && count <= kMost && count == std::floor(count)) return std::size_t(count);
  throw DescriptionError("expected a whole number from 1 to " + std::to_string(kMost) + " in <" +
                         name + ">");
}

/// Where models may stand: a box, or an upright cylinder, about the origin.
struct Region {
  Vector3 size;
  bool is_round = false;

  /// `share` is in 0…1 along each axis: for a cylinder of radius, angle and height.
  Vector3 at(const Vector3& share) const {
    const Vector3 even = (share - Vector3(0.5, 0.5, 0.5)) * size;
    if (!is_round) return even;
    const double radius = size.X() / 2 * std::sqrt(share.X()), angle = 2 * M_PI * share.Y();
    return {radius * std::cos(angle), radius * std::sin(angle), even.Z()};
  }
};

Region regionOf(const Parts& parts) {
  if (const XmlPart* cylinder = findPart(parts, "cylinder")) {
    const Parts sizes = childrenOf(*cylinder);
    const double diameter = 2 * numbersOf(sizes, "radius", 1, "1")[0];
    return {{diameter, diameter, numbersOf(sizes, "length", 1, "1")[0]}, true};
  }
  const XmlPart* box = findPart(parts, "box");
  const auto size = numbersOf(box ? childrenOf(*box) : Parts(), "size", 3, "1 1 1");
  return {{size[0], size[1], size[2]}, false};
}

/// The radical inverse: points of two or three of them are spread evenly (Halton 1960).
double radicalInverse(std::size_t index, std::size_t base) {
  double value = 0, digit = 1;
  for (; index > 0; index /= base) {
    digit /= static_cast<double>(base);
    value += digit * static_cast<double>(index % base);
  }
  return value;
}

std::vector<Vector3> gridPlaces(const Parts& distribution, std::size_t count) {
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

/// In shares of the region along each axis.
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

std::vector<Vector3> placesOf(const Parts& parts) {
  const std::size_t count = countOf(parts, "model_count");
  const XmlPart* element = findPart(parts, "distribution");
  const Parts distribution = element ? childrenOf(*element) : Parts();
  const std::string type = textOf(distribution, "type", "random");
  if (type == "grid") return gridPlaces(distribution, count);
  Region region = regionOf(parts);
  region.is_round = region.is_round && type.compare(0, 6, "linear") != 0;
  std::vector<Vector3> places = sharesOf(type, count);
  for (Vector3& place : places) place = region.at(place);
  return places;
}

/// What is the same in all clones, and what is not.
struct Pattern {
  std::string tag;     ///< model or include.
  std::string name;    ///< Of the pattern.
  std::string inside;  ///< But for pose and name.
  Pose pose;
};

Pose poseOf(const Parts& parts) {
  const auto pose = parsePose(textOf(parts, "pose", "0 0 0 0 0 0"));
  if (!pose) throw DescriptionError("expected six finite numbers in <pose>");
  return *pose;
}

std::string flat(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string nameOf(const XmlPart& element, const Parts& parts) {
  if (element.name == "model") return attributeOf(element, "name").value_or("");
  const std::string uri = textOf(parts, "uri", "");
  return textOf(parts, "name", uri.substr(uri.rfind('/') + 1).c_str());
}

Pattern patternOf(const XmlPart& element) {
  const Parts parts = childrenOf(element);
  Pattern pattern{std::string(element.name), nameOf(element, parts), "", poseOf(parts)};
  if (pattern.name.empty()) throw DescriptionError("expected a model with a name");
  for (const XmlPart& part : parts) {
    const bool varies = part.name == "pose" || (part.name == "name" && element.name == "include");
    if (!varies) pattern.inside += flat(std::string(part.whole));
  }
  return pattern;
}

void addClone(const Pattern& pattern, std::size_t index, const Pose& pose, std::ostream* out) {
  const std::string name = pattern.name + "_clone_" + std::to_string(index);
  const bool is_model = pattern.tag == "model";
  *out << '<' << pattern.tag
       << (is_model ? " name=\"" + name + "\">" : "><name>" + name + "</name>") << "<pose>"
       << pose.X() << ' ' << pose.Y() << ' ' << pose.Z() << ' ' << pose.Roll() << ' '
       << pose.Pitch() << ' ' << pose.Yaw() << "</pose>" << pattern.inside << "</" << pattern.tag
       << '>';
}

}  // namespace

std::string populate(const XmlPart& population) {
  const Parts parts = childrenOf(population);
  const XmlPart* element = findPart(parts, "model");
  if (!element) element = findPart(parts, "include");
  if (!element) throw DescriptionError("expected a <model>");
  const Pattern pattern = patternOf(*element);
  const std::vector<Vector3> places = placesOf(parts);
  if (pattern.inside.size() * places.size() > kLongest) throw DescriptionError("it is too large");
  std::ostringstream out;
  out.precision(17);
  const Pose origin = poseOf(parts);
  for (std::size_t i = 0; i < places.size(); ++i) {
    addClone(pattern, i, origin * Pose(places[i], Quaternion::Identity) * pattern.pose, &out);
  }
  return out.str();
}

}  // namespace kiva
