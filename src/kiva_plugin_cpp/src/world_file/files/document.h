// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <set>
#include <string>

#include "world_file/files/xml.h"

namespace kiva {

/// A text as SDF 1.9 without faults in form: what it includes is in it.
struct SdfDocument {
  std::unique_ptr<XmlDocument> xml;
  std::deque<Source> sources;  ///< Of what it included, or was URDF.
  Faults warnings;
  /// Those of the models that the text includes, and where it looked for those that are missing.
  std::set<std::string> files;

  const XmlElement& root() const { return *xml->RootElement(); }
};

}  // namespace kiva
