// SPDX-License-Identifier: Apache-2.0
//
// External inputs of a world, as plain structs: temporary forces, lights and settings. They are
// part of the world's state. A reset ends present and future forces.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// The time in which a force acts [s, simulated]: one step at least; forever if `end` is infinite.
struct Period {
  double start = 0;
  double end = 0;
};

/// A force and a torque on a link.
struct Wrench {
  std::string model;
  std::string link;
  Vector3 force;   ///< Force on the centre of mass, in world [N].
  Vector3 torque;  ///< Torque in world [Nm].
  Period period;
};

/// A force along a joint, or a torque about it.
struct Effort {
  std::string model;
  std::string joint;
  double effort = 0;  ///< [Nm] or [N].
  Period period;
};

/// Settings of ODE. Clients can set and read them; Bullet has no equivalent, so they do nothing.
struct OdeSettings {
  bool auto_disable_bodies = false;
  std::uint32_t sor_pgs_precon_iters = 0;
  std::uint32_t sor_pgs_iters = 50;
  double sor_pgs_w = 1.3;
  double sor_pgs_rms_error_tol = 0;
  double contact_surface_layer = 0.001;     ///< [m]
  double contact_max_correcting_vel = 100;  ///< [m/s]
  double cfm = 0;
  double erp = 0.2;
  std::uint32_t max_contacts = 20;
};

struct ExternalInputs {
  std::vector<Wrench> wrenches;
  std::vector<Effort> efforts;
  std::map<std::string, Light> lights;  ///< Lights by name.
  OdeSettings ode;
};

}  // namespace kiva
