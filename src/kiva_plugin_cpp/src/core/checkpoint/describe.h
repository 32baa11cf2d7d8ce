// SPDX-License-Identifier: Apache-2.0
//
// What the structs of a world hold, listed once for writing, reading and hashing; see archive.h.
#pragma once

#include "core/checkpoint/archive.h"
#include "core/checkpoint/plugin_states.h"
#include "core/checkpoint/rebuild.h"
#include "core/models/models.h"
#include "core/state/footprints.h"

namespace kiva {

// A field that is added to a struct below has to be described too, and where that changes what the
// bytes mean, the version counted up. Each of these numbers is to remind of it.
#if defined(__x86_64__) && defined(__GLIBCXX__)
#define DESCRIBED(type, size) \
  static_assert(sizeof(type) == (size), "describe what is new in it, then correct the size")
#else
#define DESCRIBED(type, size)
#endif

// --- descriptions

template <class A>
void describe(A& a, Mesh& m) {
  DESCRIBED(Mesh, 112);
  std::vector<int> corners;
  for (const auto& triangle : m.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  a(m.vertices, corners, m.min, m.max);
  if constexpr (A::kReads) {
    m.triangles.resize(corners.size() / 3);
    for (std::size_t i = 0; i < m.triangles.size() * 3; ++i) m.triangles[i / 3][i % 3] = corners[i];
  }
}

template <class A>
void describe(A& a, Shape& s) {
  DESCRIBED(Shape, 184);
  a(s.kind, s.size, s.radius, s.length, s.normal, s.plane_size, s.mesh_file, s.mesh_scale);
  bool has_mesh = s.mesh != nullptr;
  a(has_mesh);
  if (!has_mesh) return;
  Mesh mesh = A::kReads ? Mesh() : *s.mesh;
  a(mesh);
  if constexpr (A::kReads) s.mesh = std::make_shared<const Mesh>(std::move(mesh));
}

template <class A>
void describe(A& a, Collision& c) {
  DESCRIBED(Collision, 304);
  a(c.name, c.pose_in_link, c.shape, c.friction, c.restitution);
}

template <class A>
void describe(A& a, Visual& v) {
  DESCRIBED(Visual, 320);
  a(v.name, v.pose_in_link, v.shape, v.rgba);
}

template <class A>
void describe(A& a, Link& l) {
  DESCRIBED(Link, 272);
  a(l.name, l.pose_in_model, l.mass, l.inertial_pose_in_link, l.principal_moments, l.gravity,
    l.collisions, l.visuals);
}

template <class A>
void describe(A& a, Joint& j) {
  DESCRIBED(Joint, 216);
  a(j.name, j.kind, j.parent, j.child, j.anchor_in_model, j.axis_in_model, j.lower, j.upper,
    j.max_effort, j.max_velocity, j.damping, j.friction);
}

template <class A>
void describe(A& a, Parameters& p) {
  std::string where = p.where();
  std::vector<std::string> keys, texts;
  for (const auto& [key, text] : p.values()) {
    keys.push_back(key);
    texts.push_back(text);
  }
  a(where, keys, texts);
  if constexpr (A::kReads) {
    p = Parameters(where);
    for (std::size_t i = 0; i < keys.size(); ++i) p.set(keys[i], texts.at(i));
  }
}

template <class A>
void describe(A& a, PluginDescription& p) {
  DESCRIBED(PluginDescription, 192);
  a(p.name, p.filename, p.parameters);
}

template <class A>
void describe(A& a, SensorDescription& s) {
  DESCRIBED(SensorDescription, 328);
  a(s.name, s.type, s.link, s.pose_in_link, s.update_rate, s.parameters, s.plugins);
}

template <class A>
void describe(A& a, ModelDescription& m) {
  DESCRIBED(ModelDescription, 128);
  a(m.is_static, m.links, m.joints, m.plugins, m.sensors, m.nested_models);
}

// --- the fleet

template <class A>
void describe(A& a, DriveParameters& d) {
  DESCRIBED(DriveParameters, 88);
  a(d.drive, d.speed, d.acceleration, d.emergency_deceleration, d.wheel_radius, d.wheel_separation,
    d.wheel_inertia, d.motor_torque, d.friction, d.drive_wheel_load, d.quarter_turn_time);
}

template <class A>
void describe(A& a, LiftParameters& l) {
  DESCRIBED(LiftParameters, 48);
  a(l.fitted, l.height, l.time, l.max_load, l.max_force, l.proximity);
}

template <class A>
void describe(A& a, LaserParameters& l) {
  DESCRIBED(LaserParameters, 64);
  a(l.fitted, l.rays, l.min_angle, l.max_angle, l.min_range, l.max_range, l.rate, l.x, l.z);
}

template <class A>
void describe(A& a, MotionSegment& l) {
  DESCRIBED(MotionSegment, 48);
  a(l.kind, l.x, l.y, l.yaw, l.reverse, l.on_grid, l.unit, l.state);
}

template <class A>
void describe(A& a, Sighting& s) {
  DESCRIBED(Sighting, 32);
  a(s.taken, s.distance, s.model, s.faces, s.along);
}

template <class A>
void describe(A& a, Task& t) {
  DESCRIBED(Task, 264);
  a(t.phase, t.command, t.goal, t.segments, t.overdue, t.sighting, t.last_sighting, t.blocked_by,
    t.blocked_reason, t.reported_shelf);
}

template <class A>
void describe(A& a, Robot& r) {
  DESCRIBED(Robot, 368);
  a(r.name, r.id, r.model, r.mass, r.inertia, r.half_length, r.half_width, r.height);
  a(r.centre[0], r.centre[1], r.tyre_friction[0], r.tyre_friction[1]);
  a(r.load_mass, r.load_inertia, r.load_half_length, r.load_half_width);
  a(r.load_centre[0], r.load_centre[1]);
  a(r.drive, r.lift, r.laser, r.has_motion, r.has_rotation);  // its ray_fan comes with its laser
}

template <class A>
void describe(A& a, Stance& s) {
  DESCRIBED(Stance, 48);
  a(s.height, s.roll, s.pitch, s.climb_rate, s.roll_rate, s.pitch_rate);
}

template <class A>
void describe(A& a, FleetState& f) {
  DESCRIBED(FleetState, 864);
  a(f.x, f.y, f.yaw, f.vx, f.vy, f.yaw_rate, f.wheel_speed, f.wheel_angle, f.wheel_target);
  a(f.stance, f.tower, f.unit, f.status, f.state, f.last_end, f.awake, f.activated, f.clear_until);
  a(f.reference, f.reference_speed, f.goal, f.deceleration);
  a(f.cruising, f.per_x, f.per_y, f.per_yaw, f.per_wheel, f.top_speed, f.acceleration);
  a(f.robots, f.index_of_id, f.tasks);
}

// --- models, storage units, items

template <class A>
void describe(A& a, CollisionGeometry& o) {
  DESCRIBED(CollisionGeometry, 288);
  a(o.link, o.pose_in_link, o.shape);
}

template <class A>
void describe(A& a, JointSettings& s) {
  DESCRIBED(JointSettings, 48);
  a(s.damping, s.friction, s.lower, s.upper, s.motor_speed, s.motor_effort);
}

template <class A>
void describe(A& a, JointState& s) {
  DESCRIBED(JointState, 64);
  a(s.position, s.rate, s.settings);
}

template <class A>
void describe(A& a, Model& m) {
  DESCRIBED(Model, 448);
  a(m.name, m.kind, m.serial, m.spawn_pose);
  if constexpr (A::kReads) m.owner = &ownerOf(m.kind);
  a.mostly(m.pose, m.spawn_pose);
  a(m.index, m.in_physics, m.active_until, m.disturbed, m.joints, m.robot_namespace);
  bool has_outlines = !m.geometries.empty();
  a(has_outlines);
  if (m.kind == ModelKind::kRobot) {
    a(m.geometries);
  } else if (A::kReads && has_outlines) {
    addCollisionGeometry(m);
  }
}

template <class A>
void describe(A& a, StorageUnit& u) {
  DESCRIBED(StorageUnit, 128);
  a(u.name, u.id, u.model, u.mass, u.carrier, u.claimed_by, u.pose_on_carrier);
}

template <class A>
void describe(A& a, Item& i) {
  DESCRIBED(Item, 200);
  a(i.id, i.model, i.unit, i.pose_in_unit, i.mass);  // its name is its model's
  a.mostly(i.spawn_pose_in_unit, i.pose_in_unit);
}

// --- Bullet

template <class A>
void describe(A& a, btVector3& v) {
  a(v.m_floats[0], v.m_floats[1], v.m_floats[2]);
}

template <class A>
void describe(A& a, btTransform& t) {
  a(t.getBasis()[0], t.getBasis()[1], t.getBasis()[2], t.getOrigin());
}

template <class A>
void describe(A& a, BodyState& b) {
  DESCRIBED(BodyState, 464);
  a(b.pose, b.predicted_pose, b.velocity, b.angular_velocity, b.predicted_velocity,
    b.predicted_angular_velocity, b.force, b.torque, b.activation, b.resting);
}

template <class A>
void describe(A& a, BodyAddress& b) {
  a(b.model, b.link, b.is_plane);
}

template <class A>
void describe(A& a, btManifoldPoint& p) {
  a(p.m_localPointA, p.m_localPointB, p.m_positionWorldOnA, p.m_positionWorldOnB,
    p.m_normalWorldOnB, p.m_distance1, p.m_combinedFriction, p.m_combinedRollingFriction,
    p.m_combinedSpinningFriction, p.m_combinedRestitution, p.m_partId0, p.m_partId1, p.m_index0,
    p.m_index1, p.m_contactPointFlags, p.m_appliedImpulse, p.m_prevRHS, p.m_appliedImpulseLateral1,
    p.m_appliedImpulseLateral2, p.m_contactMotion1, p.m_contactMotion2, p.m_contactCFM,
    p.m_contactERP, p.m_frictionCFM, p.m_lifeTime, p.m_lateralFrictionDir1,
    p.m_lateralFrictionDir2);
}

template <class A>
void describe(A& a, ContactMemory& c) {
  a(c.a, c.b, c.points);
}

template <class A>
void describe(A& a, PhysicsState& p) {
  a(p.bodies, p.contacts);
}

// --- the world

template <class A>
void describe(A& a, Command& c) {
  DESCRIBED(Command, 40);
  a(c.kind, c.kiva_id, c.x, c.y, c.direction, c.lift, c.shelf_id);
}

template <class A>
void describe(A& a, Impact& i) {
  DESCRIBED(Impact, 80);
  a(i.point, i.normal, i.speed, i.impulse);
}

template <class A>
void describe(A& a, Event& e) {
  DESCRIBED(Event, 200);
  a(e.time, e.kind, e.model, e.other, e.text, e.command, e.impact);
}

template <class A>
void describe(A& a, Period& p) {
  a(p.start, p.end);
}

template <class A>
void describe(A& a, Wrench& w) {
  DESCRIBED(Wrench, 144);
  a(w.model, w.link, w.force, w.torque, w.period);
}

template <class A>
void describe(A& a, Effort& e) {
  DESCRIBED(Effort, 88);
  a(e.model, e.joint, e.effort, e.period);
}

template <class A>
void describe(A& a, Light& l) {
  DESCRIBED(Light, 240);
  a(l.name, l.kind, l.pose, l.diffuse, l.specular, l.attenuation_constant, l.attenuation_linear,
    l.attenuation_quadratic, l.direction, l.cast_shadows);
}

template <class A>
void describe(A& a, OdeSettings& o) {
  DESCRIBED(OdeSettings, 72);
  a(o.auto_disable_bodies, o.sor_pgs_precon_iters, o.sor_pgs_iters, o.sor_pgs_w,
    o.sor_pgs_rms_error_tol, o.contact_surface_layer, o.contact_max_correcting_vel, o.cfm, o.erp,
    o.max_contacts);
}

template <class A>
void describe(A& a, ExternalInputs& i) {
  std::vector<Light> lights;
  for (const auto& [name, light] : i.lights) lights.push_back(light);
  a(i.wrenches, i.efforts, lights, i.ode);
  if constexpr (A::kReads) {
    i.lights.clear();
    for (Light& light : lights) i.lights[light.name] = std::move(light);
  }
}

template <class A>
void describe(A& a, StatusChange& s) {
  DESCRIBED(StatusChange, 48);
  a(s.time, s.kiva_id, s.status, s.state, s.shelf_id, s.x, s.y, s.yaw);
}

template <class A>
void describe(A& a, TouchingPair& t) {
  DESCRIBED(TouchingPair, 112);
  a(t.model_a, t.model_b, t.last_step, t.impact, t.tell_at, t.tell_latest);
}

template <class A>
void describe(A& a, Crash& c) {
  DESCRIBED(Crash, 40);
  a(c.kiva_id, c.with);
}

template <class A>
void describe(A& a, PluginState& p) {
  a(p.model, p.index, p.state);
}

template <class A>
void describe(A& a, Floor& f) {
  DESCRIBED(Floor, 32);
  a(f.min_x, f.max_x, f.min_y, f.max_y);
}

template <class A>
void describe(A& a, WorldOptions& o) {
  DESCRIBED(WorldOptions, 48);
  a(o.seed, o.drive, o.always_in_bullet);  // the table of plugins stays the world's own
}

#undef DESCRIBED

}  // namespace kiva
