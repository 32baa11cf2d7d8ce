// SPDX-License-Identifier: Apache-2.0
#include "world_file/preparation.h"

#include <algorithm>

#include "world_file/errors.h"
#include "world_file/population.h"
#include "world_file/xml_parts.h"

namespace kiva {
namespace {

/// Rewrites the elements of a world that need it.
class Preparation {
 public:
  explicit Preparation(const std::string& xml) : xml_(xml), scanner_(xml_) {}

  /// False if the text is no XML: let libsdformat say what is wrong with it.
  bool run() {
    while (scanner_.next()) {
      if (scanner_.opens && isOurs()) {
        if (!replace()) return false;
        continue;
      }
      if (scanner_.opens && !scanner_.closes) open();
      if (scanner_.opens || !scanner_.closes) continue;
      if (path_.empty() || path_.back() != scanner_.name) return false;
      path_.pop_back();
      addresses_.pop_back();
    }
    keepUpTo(xml_.size());
    return path_.empty();
  }

  PreparedText take() { return std::move(result_); }

 private:
  void open() {
    path_.push_back(scanner_.name);
    addresses_.push_back(addressOf({scanner_.name, scanner_.attributes, {}, {}}));
  }

  /// As libsdformat has it.
  static std::string addressOf(const XmlPart& part) {
    const auto name = attributeOf(part, "name");
    return "/" + std::string(part.name) + (name ? "[@name=\"" + *name + "\"]" : "");
  }

  bool isOurs() const {
    const bool is_in_world = path_ == std::vector<std::string_view>{"sdf", "world"};
    const bool is_alone = path_ == std::vector<std::string_view>{"sdf"};
    if (scanner_.name == "actor") return is_in_world || is_alone;
    return is_in_world && (scanner_.name == "state" || scanner_.name == "population");
  }

  bool replace() {
    keepUpTo(scanner_.begin);
    const auto part = takePart(xml_, &scanner_);
    if (!part) return false;
    if (part->name == "actor") warn(*part, "actors are left out");
    if (part->name == "state") readState(*part);
    if (part->name == "population") writeOut(*part);
    const auto lines = std::count(part->whole.begin(), part->whole.end(), '\n');
    result_.xml.append(static_cast<std::size_t>(lines), '\n');
    kept_ = scanner_.end;
    return true;
  }

  void writeOut(const XmlPart& population) {
    try {
      result_.xml += populate(population);
    } catch (const DescriptionError& error) {
      warn(population, std::string("this population is left out: ") + error.what());
    }
  }

  void readState(const XmlPart& state) {
    for (const XmlPart& model : partsOf(state.inside).value_or(std::vector<XmlPart>())) {
      const auto name = attributeOf(model, "name");
      if (model.name != "model" || !name) continue;
      const auto parts = partsOf(model.inside).value_or(std::vector<XmlPart>());
      const XmlPart* pose = findPart(parts, "pose");
      const auto numbers = pose ? parsePose(trimmed(pose->inside)) : std::nullopt;
      if (numbers) result_.poses[*name] = *numbers;
    }
  }

  void warn(const XmlPart& part, const std::string& message) {
    sdf::Error warning(sdf::ErrorCode::NONE, message);
    const auto begin = static_cast<std::size_t>(part.whole.data() - xml_.data());
    warning.SetLineNumber(1 +
                          static_cast<int>(std::count(xml_.begin(), xml_.begin() + begin, '\n')));
    std::string path;
    for (const std::string& address : addresses_) path += address;
    warning.SetXmlPath(path + addressOf(part));
    result_.warnings.push_back(warning);
  }

  void keepUpTo(std::size_t position) {
    result_.xml.append(xml_.substr(kept_, position - kept_));
    kept_ = position;
  }

  std::string_view xml_;
  TagScanner scanner_;
  std::vector<std::string_view> path_;
  std::vector<std::string> addresses_;  // of the path's elements
  PreparedText result_;
  std::size_t kept_ = 0;  ///< Up to here the text is in the result, or replaced.
};

}  // namespace

PreparedText prepare(const std::string& xml) {
  Preparation preparation(xml);
  if (preparation.run()) return preparation.take();
  return {xml, {}, {}};
}

}  // namespace kiva
