// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <set>
#include <string>

#include "world_file/files/xml.h"

namespace kiva {

/// An SDF 1.9 document without formal faults, its includes expanded.
struct SdfDocument {
  std::unique_ptr<XmlDocument> xml;
  std::deque<Source> sources;  ///< Files of its includes, and of a URDF.
  Faults warnings;
  /// Files of the included models, and those that would make a missing model available.
  std::set<std::string> files;

  const XmlElement& root() const { return *xml->RootElement(); }
};

}  // namespace kiva
