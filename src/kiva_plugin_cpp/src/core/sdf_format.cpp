// SPDX-License-Identifier: Apache-2.0
#include "core/sdf_format.h"

#include <algorithm>
#include <map>
#include <memory>
#include <sdf/Element.hh>
#include <sdf/Param.hh>
#include <sdf/parser.hh>

namespace kiva {
namespace {

/// libsdformat's own description of SDF. Building it takes 30 ms, copying it half of that.
const sdf::ElementPtr& format() {
  static const sdf::ElementPtr kFormat = [] {
    auto document = std::make_shared<sdf::SDF>();
    sdf::init(document);
    return document->Root();
  }();
  return kFormat;
}

}  // namespace

sdf::SDFPtr emptyDocument() {
  auto document = std::make_shared<sdf::SDF>();
  document->Root(format()->Clone());
  return document;
}

/// By hand: std::regex overflows the stack on names of a hundred thousand letters.
std::vector<PathStep> pathSteps(const std::string& xml_path) {
  constexpr char kName[] = "[@name=\"";
  std::vector<PathStep> steps;
  for (std::size_t at = 0; at < xml_path.size() && xml_path[at] == '/';) {
    const std::size_t stop = std::min(xml_path.find_first_of("/[", at + 1), xml_path.size());
    steps.push_back({xml_path.substr(at + 1, stop - at - 1), std::nullopt});
    at = stop;
    if (xml_path.compare(at, sizeof(kName) - 1, kName) == 0) {
      const std::size_t begin = at + sizeof(kName) - 1;
      const std::size_t end = std::min(xml_path.find("\"]", begin), xml_path.size());
      steps.back().name = xml_path.substr(begin, end - begin);
      at = end;
    }
    at = std::min(xml_path.find('/', at), xml_path.size());  // Behind `"]` or `[0]`.
  }
  return steps;
}

std::string expectedValue(const std::string& xml_path) {
  static const std::map<std::string, std::string> kWords = {
      {"double", "a number"},           {"float", "a number"},
      {"int", "a whole number"},        {"unsigned int", "a whole number of 0 or above"},
      {"bool", "true or false"},        {"vector2d", "two numbers"},
      {"vector3", "three numbers"},     {"pose", "six numbers, x y z roll pitch yaw"},
      {"color", "red green blue alpha"}};
  sdf::ElementPtr element = format();
  for (const PathStep& step : pathSteps(xml_path)) {
    if (step.element != "sdf" && element) element = element->GetElementDescription(step.element);
  }
  if (!element || !element->GetValue()) return "";
  const auto words = kWords.find(element->GetValue()->GetTypeName());
  return words == kWords.end() ? "" : words->second;
}

}  // namespace kiva
