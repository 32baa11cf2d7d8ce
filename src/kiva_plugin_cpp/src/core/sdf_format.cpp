// SPDX-License-Identifier: Apache-2.0
#include "core/sdf_format.h"

#include <map>
#include <memory>
#include <regex>
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

std::string expectedValue(const std::string& xml_path) {
  static const std::regex kSegment(R"re(/([^/\[]+)(\[[^\]]*\])?)re");
  static const std::map<std::string, std::string> kWords = {
      {"double", "a number"},           {"float", "a number"},
      {"int", "a whole number"},        {"unsigned int", "a whole number of 0 or above"},
      {"bool", "true or false"},        {"vector2d", "two numbers"},
      {"vector3", "three numbers"},     {"pose", "six numbers, x y z roll pitch yaw"},
      {"color", "red green blue alpha"}};
  sdf::ElementPtr element = format();
  for (std::sregex_iterator it(xml_path.begin(), xml_path.end(), kSegment), end; it != end; ++it) {
    if ((*it)[1] != "sdf" && element) element = element->GetElementDescription((*it)[1].str());
  }
  if (!element || !element->GetValue()) return "";
  const auto words = kWords.find(element->GetValue()->GetTypeName());
  return words == kWords.end() ? "" : words->second;
}

}  // namespace kiva
