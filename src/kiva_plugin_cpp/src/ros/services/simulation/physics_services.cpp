// SPDX-License-Identifier: Apache-2.0
#include "ros/services/simulation/physics_services.h"

#include <cmath>

#include "ros/messages/convert.h"
#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

gazebo_msgs::ODEPhysics odeMessage(const kiva::OdeSettings& ode) {
  gazebo_msgs::ODEPhysics out;
  out.auto_disable_bodies = ode.auto_disable_bodies;
  out.sor_pgs_precon_iters = ode.sor_pgs_precon_iters;
  out.sor_pgs_iters = ode.sor_pgs_iters;
  out.sor_pgs_w = ode.sor_pgs_w;
  out.sor_pgs_rms_error_tol = ode.sor_pgs_rms_error_tol;
  out.contact_surface_layer = ode.contact_surface_layer;
  out.contact_max_correcting_vel = ode.contact_max_correcting_vel;
  out.cfm = ode.cfm;
  out.erp = ode.erp;
  out.max_contacts = ode.max_contacts;
  return out;
}

kiva::OdeSettings odeSettings(const gazebo_msgs::ODEPhysics& ode) {
  for (double value : {ode.sor_pgs_w, ode.sor_pgs_rms_error_tol, ode.contact_surface_layer,
                       ode.contact_max_correcting_vel, ode.cfm, ode.erp}) {
    if (!std::isfinite(value)) throw std::invalid_argument("a number of ode_config is not finite");
  }
  return {static_cast<bool>(ode.auto_disable_bodies),
          ode.sor_pgs_precon_iters,
          ode.sor_pgs_iters,
          ode.sor_pgs_w,
          ode.sor_pgs_rms_error_tol,
          ode.contact_surface_layer,
          ode.contact_max_correcting_vel,
          ode.cfm,
          ode.erp,
          ode.max_contacts};
}

gazebo_msgs::SetPhysicsProperties::Request propertiesOf(const kiva::World& world,
                                                        const SimulationThread& simulation) {
  gazebo_msgs::SetPhysicsProperties::Request out;
  out.time_step = world.stepSize();
  out.max_update_rate = simulation.targetFactor() / world.stepSize();
  out.gravity = toMessage(world.gravity());
  out.ode_config = odeMessage(world.externalInputs().ode);
  return out;
}

kiva_plugin_cpp::PhysicsConfig toConfig(const gazebo_msgs::SetPhysicsProperties::Request& p) {
  kiva_plugin_cpp::PhysicsConfig out = kiva_plugin_cpp::PhysicsConfig::__getDefault__();
  out.time_step = p.time_step;
  out.max_update_rate = p.max_update_rate;
  out.gravity_x = p.gravity.x;
  out.gravity_y = p.gravity.y;
  out.gravity_z = p.gravity.z;
  out.auto_disable_bodies = p.ode_config.auto_disable_bodies;
  out.sor_pgs_precon_iters = static_cast<int>(p.ode_config.sor_pgs_precon_iters);
  out.sor_pgs_iters = static_cast<int>(p.ode_config.sor_pgs_iters);
  out.sor_pgs_w = p.ode_config.sor_pgs_w;
  out.sor_pgs_rms_error_tol = p.ode_config.sor_pgs_rms_error_tol;
  out.cfm = p.ode_config.cfm;
  out.erp = p.ode_config.erp;
  out.contact_surface_layer = p.ode_config.contact_surface_layer;
  out.contact_max_correcting_vel = p.ode_config.contact_max_correcting_vel;
  out.max_contacts = static_cast<int>(p.ode_config.max_contacts);
  return out;
}

gazebo_msgs::SetPhysicsProperties::Request fromConfig(
    const kiva_plugin_cpp::PhysicsConfig& config) {
  gazebo_msgs::SetPhysicsProperties::Request out;
  out.time_step = config.time_step;
  out.max_update_rate = config.max_update_rate;
  out.gravity.x = config.gravity_x;
  out.gravity.y = config.gravity_y;
  out.gravity.z = config.gravity_z;
  out.ode_config.auto_disable_bodies = config.auto_disable_bodies;
  out.ode_config.sor_pgs_precon_iters = static_cast<std::uint32_t>(config.sor_pgs_precon_iters);
  out.ode_config.sor_pgs_iters = static_cast<std::uint32_t>(config.sor_pgs_iters);
  out.ode_config.sor_pgs_w = config.sor_pgs_w;
  out.ode_config.sor_pgs_rms_error_tol = config.sor_pgs_rms_error_tol;
  out.ode_config.cfm = config.cfm;
  out.ode_config.erp = config.erp;
  out.ode_config.contact_surface_layer = config.contact_surface_layer;
  out.ode_config.contact_max_correcting_vel = config.contact_max_correcting_vel;
  out.ode_config.max_contacts = static_cast<std::uint32_t>(config.max_contacts);
  return out;
}

/// Returns simulated seconds a wall second at that many steps a wall second; 0 = as fast as
/// possible.
double factorOf(double max_update_rate, double step_size) {
  constexpr double kLeast = 1e-4, kMost = 1e6;
  if (!std::isfinite(max_update_rate)) {
    throw std::invalid_argument("max_update_rate is not finite");
  }
  const double factor = max_update_rate * step_size;
  if (factor <= 0 || factor > kMost) return 0;
  if (factor >= kLeast) return factor;
  throw std::invalid_argument("max_update_rate must be 0, or let 1e-4 s pass in a second at least");
}

template <typename Message>
bool isSame(const Message& a, const Message& b) {
  std::vector<std::uint8_t> bytes[2];
  for (int i = 0; i < 2; ++i) {
    const Message& message = i == 0 ? a : b;
    bytes[i].resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(bytes[i].data(), bytes[i].size());
    ros::serialization::serialize(stream, message);
  }
  return bytes[0] == bytes[1];
}

}  // namespace

PhysicsServices::PhysicsServices(ros::NodeHandle& node, const kiva::World& world,
                                 SimulationThread& simulation)
    : simulation_(simulation), server_(mutex_, node) {
  using namespace gazebo_msgs;
  offer(propertiesOf(world,
                     simulation));  // replaces values of an earlier run on the parameter server
  server_.setCallback([this](Config& config, std::uint32_t) { reconfigure(config); });
  servers_.push_back(serve<GetPhysicsProperties>(
      node, "get_physics_properties", "GetPhysicsProperties", [&simulation](auto&, auto& response) {
        const Properties now =
            simulation.run([&](kiva::World& world) { return propertiesOf(world, simulation); });
        response.time_step = now.time_step;
        response.pause = simulation.paused();
        response.max_update_rate = now.max_update_rate;
        response.gravity = now.gravity;
        response.ode_config = now.ode_config;
        return "GetPhysicsProperties: got properties";
      }));
  servers_.push_back(serveChange<SetPhysicsProperties>(
      node, "set_physics_properties", "SetPhysicsProperties", [this](auto& request, auto&) {
        set(request);
        offer(request);
        return "physics engine updated; ode_config is kept, but Bullet has no counterpart for it";
      }));
}

/// Sets all properties, or none if one is wrong.
void PhysicsServices::set(const Properties& properties) {
  const double rate = properties.max_update_rate;
  const double factor = factorOf(rate, properties.time_step);
  const kiva::Vector3 gravity = fromMessage(properties.gravity, "gravity");
  const kiva::OdeSettings ode = odeSettings(properties.ode_config);
  simulation_.change([&](kiva::World& world) {
    const kiva::Vector3 before = world.gravity();
    const Properties old = propertiesOf(world, simulation_);
    world.setGravity(gravity);
    try {
      world.setStepSize(properties.time_step);
    } catch (const std::exception&) {
      world.setGravity(before);
      throw;
    }
    world.setOde(ode);
    if (old.time_step == properties.time_step && old.max_update_rate == rate) return;
    simulation_.retime(world.stepSize(), factor);
  });
}

void PhysicsServices::reconfigure(Config& config) {
  const Properties asked = fromConfig(config);
  if (isSame(asked, fromConfig(last_))) return;
  try {
    set(asked);
    last_ = config;
  } catch (const std::exception& error) {
    ROS_WARN("%s: %s", "set_parameters", error.what());
    config = last_;
  }
}

void PhysicsServices::offer(const Properties& properties) {
  const boost::recursive_mutex::scoped_lock lock(mutex_);
  last_ = toConfig(properties);
  server_.updateConfig(last_);
}

}  // namespace kiva_ros
