// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <unordered_map>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

struct JointedBody;

/// The mechanisms of robots without a load, which robots of one description share and own.
struct JointedBodies {
  std::unordered_map<const ModelDescription*, std::weak_ptr<const JointedBody>> bare;
};

}  // namespace kiva
