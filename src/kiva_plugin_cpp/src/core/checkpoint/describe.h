// SPDX-License-Identifier: Apache-2.0
//
// The fields of a world's structs, listed once for writing, reading and hashing; see archive.h.
#pragma once

#include "core/checkpoint/archive.h"
#include "core/checkpoint/field_count.h"
#include "core/checkpoint/plugin_states.h"
#include "core/checkpoint/rebuild.h"
#include "core/models/models.h"
#include "core/state/places/footprints.h"

namespace kiva {

// Asserts the number of a struct's fields, as a reminder: a new field must be described below. If
// that changes the meaning of the bytes, the version must be increased.
#define DESCRIBED(type, fields) \
  static_assert(fieldCount<type>() == (fields), "describe what is new in it, then correct this")

// --- the last value of each enum, the limit of a valid one

constexpr Shape::Kind lastOf(Shape::Kind) { return Shape::Kind::kMesh; }
constexpr Joint::Kind lastOf(Joint::Kind) { return Joint::Kind::kBall; }
constexpr Light::Kind lastOf(Light::Kind) { return Light::Kind::kDirectional; }
constexpr Command::Kind lastOf(Command::Kind) { return Command::Kind::kFollow; }
constexpr Event::Kind lastOf(Event::Kind) { return Event::Kind::kPickedUp; }
constexpr ModelKind lastOf(ModelKind) { return ModelKind::kOther; }
constexpr Status lastOf(Status) { return Status::kBlocked; }
constexpr State lastOf(State) { return State::kSteered; }
constexpr Drive lastOf(Drive) { return Drive::kJointed; }
constexpr MotionSegment::Kind lastOf(MotionSegment::Kind) { return MotionSegment::Kind::kLower; }
constexpr Phase lastOf(Phase) { return Phase::kSteered; }
constexpr Failure lastOf(Failure) { return Failure::kWheelSlip; }
constexpr Footprint::Kind lastOf(Footprint::Kind) { return Footprint::Kind::kOther; }

/// Returns a function for a struct's fields() that describes each number with its limits.
template <class A>
auto limited(A& a) {
  return [&a](const char* name, auto& value, double least, double most) {
    a.named(name, within(value, least, most));
  };
}

// --- descriptions

template <class A>
void describe(A& a, Mesh& m) {
  DESCRIBED(Mesh, 4);
  std::vector<int> corners;
  for (const auto& triangle : m.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  FIELDS(m.vertices, corners, m.min, m.max);
  if constexpr (A::kReads) {
    m.triangles.resize(corners.size() / 3);
    for (std::size_t i = 0; i < m.triangles.size() * 3; ++i) m.triangles[i / 3][i % 3] = corners[i];
  }
}

template <class A>
void describe(A& a, Shape& s) {
  DESCRIBED(Shape, 10);
  FIELDS(s.kind, s.size, s.radius, s.length, s.normal, s.plane_size, s.mesh_file, s.mesh_scale);
  bool has_mesh = s.mesh != nullptr;
  FIELDS(has_mesh);
  if (!has_mesh) return;
  Mesh mesh = A::kReads ? Mesh() : *s.mesh;
  FIELDS(mesh);
  if constexpr (A::kReads) s.mesh = std::make_shared<const Mesh>(std::move(mesh));
}

template <class A>
void describe(A& a, Collision& c) {
  DESCRIBED(Collision, 5);
  FIELDS(c.name, c.pose_in_link, c.shape, c.friction, c.restitution);
}

template <class A>
void describe(A& a, Visual& v) {
  DESCRIBED(Visual, 7);
  FIELDS(v.name, v.pose_in_link, v.shape, v.rgba);
}

template <class A>
void describe(A& a, Link& l) {
  DESCRIBED(Link, 9);
  FIELDS(l.name, l.pose_in_model, l.mass, l.inertial_pose_in_link, l.principal_moments, l.gravity,
         l.self_collide, l.collisions, l.visuals);
}

template <class A>
void describe(A& a, Joint& j) {
  DESCRIBED(Joint, 14);
  FIELDS(j.name, j.kind, j.parent, j.child, j.anchor_in_model, j.axis_in_model,
         within(j.lower, -kEndless, kEndless), within(j.upper, -kEndless, kEndless),
         within(j.max_effort, -kEndless, kEndless), within(j.max_velocity, -kEndless, kEndless),
         j.damping, j.friction, j.stiffness, j.spring_reference);
}

template <class A>
void describe(A& a, Parameters& p) {
  std::string where = p.where();
  std::vector<std::string> keys, texts;
  for (const auto& [key, text] : p.values()) {
    keys.push_back(key);
    texts.push_back(text);
  }
  FIELDS(where, keys, texts);
  if constexpr (A::kReads) {
    if (texts.size() != keys.size()) throw ArchiveError("as many as there are keys", "texts");
    p = Parameters(where);
    for (std::size_t i = 0; i < keys.size(); ++i) p.set(keys[i], texts[i]);
  }
}

template <class A>
void describe(A& a, PluginDescription& p) {
  DESCRIBED(PluginDescription, 3);
  FIELDS(p.name, p.filename, p.parameters);
}

template <class A>
void describe(A& a, SensorDescription& s) {
  DESCRIBED(SensorDescription, 7);
  FIELDS(s.name, s.type, s.link, s.pose_in_link, s.update_rate, s.parameters, s.plugins);
}

template <class A>
void describe(A& a, ModelDescription& m) {
  DESCRIBED(ModelDescription, 6);
  FIELDS(m.is_static, m.links, m.joints, m.plugins, m.sensors, m.nested_models);
}

template <class A>
void describe(A& a, std::shared_ptr<const ModelDescription>& shared) {
  if constexpr (A::kReads) {
    auto description = std::make_shared<ModelDescription>();
    a(*description);
    shared = std::move(description);
  } else {
    a(const_cast<ModelDescription&>(*shared));  // describing changes nothing, except by a reader
  }
}

// --- the fleet

template <class A>
void describe(A& a, DriveParameters& d) {
  DESCRIBED(DriveParameters, 11);
  FIELDS(d.drive);
  d.fields(d, limited(a));
}

template <class A>
void describe(A& a, LiftParameters& l) {
  DESCRIBED(LiftParameters, 6);
  FIELDS(l.fitted);
  l.fields(l, limited(a));
}

template <class A>
void describe(A& a, LaserParameters& l) {
  DESCRIBED(LaserParameters, 9);
  FIELDS(l.fitted);
  l.fields(l, limited(a));
}

template <class A>
void describe(A& a, MotionSegment& l) {
  DESCRIBED(MotionSegment, 9);
  FIELDS(l.kind, l.x, l.y, l.length, l.yaw, l.reverse, l.on_grid, l.unit, l.state);
}

template <class A>
void describe(A& a, Sighting& s) {
  DESCRIBED(Sighting, 5);
  FIELDS(s.taken, within(s.distance, 0, kEndless), s.model, s.faces, s.along);
}

template <class A>
void describe(A& a, PathPoint& p) {
  DESCRIBED(PathPoint, 2);
  FIELDS(p.x, p.y);
}

template <class A>
void describe(A& a, ReleasedPath& p) {
  DESCRIBED(ReleasedPath, 6);
  FIELDS(p.first, p.points, p.released, p.origin, p.end);
  // The hash of a world without limits is what it was before there were any.
  if (!std::is_same_v<A, Hasher> || p.isLimited()) FIELDS(within(p.limits, 0, kEndless));
}

template <class A>
void describe(A& a, Task& t) {
  DESCRIBED(Task, 13);
  FIELDS(t.phase, t.command, t.request, t.segments, t.path, t.cancelled, t.overdue,
         within(t.stop_at, -kEndless, kEndless), t.sighting, t.last_sighting, t.blocked_by,
         t.blocked_reason, t.reported_unit_id);
}

template <class A>
void describe(A& a, Robot& r) {
  DESCRIBED(Robot, 28);
  FIELDS(r.name, within(r.id, 1, kMaxKivaId), r.model, within(r.mass, 1e-9, 1e12),
         within(r.inertia, 0, 1e15), within(r.half_length, 0, 100), within(r.half_width, 0, 100),
         within(r.height, -100, 100));
  FIELDS(within(r.centre[0], -100, 100), within(r.centre[1], -100, 100),
         within(r.tyre_friction[0], 0, kEndless), within(r.tyre_friction[1], 0, kEndless));
  FIELDS(within(r.load_mass, 0, 1e12), within(r.load_inertia, 0, 1e15),
         within(r.load_centre[0], -100, 100), within(r.load_centre[1], -100, 100),
         within(r.load_half_length, 0, 100), within(r.load_half_width, 0, 100));
  FIELDS(within(r.load_height, -1000, 1000), within(r.load_foothold, 0, 100),
         within(r.load_tipping_inertia, 0, 1e15));
  FIELDS(r.drive, r.lift, r.laser, r.has_motion,
         r.has_rotation);  // its ray_fan is derived from its laser, its grip from its failures
}

template <class A>
void describe(A& a, Stance& s) {
  DESCRIBED(Stance, 6);
  FIELDS(s.height, s.roll, s.pitch, s.climb_rate, s.roll_rate, s.pitch_rate);
}

template <class A>
void describe(A& a, Battery& b) {
  DESCRIBED(Battery, 5);
  FIELDS(b.energy, b.wheel_angle, b.kinetic, b.tower);
}

template <class A>
void describe(A& a, RobotReport& r) {
  DESCRIBED(RobotReport, 13);
  FIELDS(r.x, r.y, r.yaw, r.vx, r.vy, r.yaw_rate, r.status, r.state, r.shelf_id, r.path_id,
         r.reached, r.left, r.last_end);
}

template <class A>
void describe(A& a, Sway& s) {
  DESCRIBED(Sway, 7);
  FIELDS(s.tilt, s.rate, s.to_x, s.to_y, s.vx, s.vy, s.step);
}

template <class A>
void describe(A& a, Heard& h) {
  DESCRIBED(Heard, 2);
  FIELDS(h.number, h.report);
}

template <class A>
void describe(A& a, PlanarPose& p) {
  DESCRIBED(PlanarPose, 3);
  FIELDS(p.x, p.y, p.yaw);
}

template <class A>
void describe(A& a, Stretch& s) {
  DESCRIBED(Stretch, 7);
  FIELDS(s.under_way, s.turns, s.from, within(s.until, -kEndless, kEndless), s.curvature,
         s.next_curvature, s.next_length);
}

template <class A>
void describe(A& a, Localisation& l) {
  DESCRIBED(Localisation, 41);
  FIELDS(l.pose, within(l.believed.radius[0], 0.001, 2), within(l.believed.radius[1], 0.001, 2),
         within(l.believed.separation, 0.001, 20), l.covariance, l.way, l.turn, l.wheel_angle,
         l.slip, l.slip_for, l.since_code, l.lost_at, l.lost, l.code_column, l.code_row, l.draws,
         l.stretch);
}

template <class A>
void describe(A& a, DriveVelocity& v) {
  DESCRIBED(DriveVelocity, 2);
  FIELDS(within(v.speed, -1e3, 1e3), within(v.turn_rate, -1e6, 1e6));
}

template <class A>
void describe(A& a, Steering& s) {
  DESCRIBED(Steering, 16);
  FIELDS(s.kiva_id, s.asked, s.silence, s.command, s.lagged, within(s.room, 0, kEndless),
         s.obstacle, s.looks, s.since_look, s.approach, within(s.curvature, -kEndless, kEndless),
         within(s.measured, -kEndless, kEndless), s.since_measured, s.bumped, s.origin,
         s.per_separation);
}

template <class A>
void describe(A& a, FleetState& f) {
  DESCRIBED(FleetState, 31);  // fields of realism are described with the world
  // Some fields are derived from other state: failures, charge, and the next points to count. The
  // allowed speed is derived from people.
  DESCRIBED(Fleet, 27);
  FIELDS(f.x, f.y, f.yaw, f.vx, f.vy, f.yaw_rate, f.wheel_speed, f.wheel_angle, f.wheel_target);
  FIELDS(f.stance, f.tower, f.unit, f.status, f.state,
         within(f.last_end, 0, static_cast<double>(lastOf(Event::Kind()))), f.path_id, f.reached,
         f.left, within(f.stopped, 0, 1), within(f.awake, 0, 1), within(f.activated, 0, 1),
         within(f.clear_until, -kEndless, kEndless), within(f.attend_at, -kEndless, kEndless),
         within(f.wedged_until, -kEndless, kEndless));
  FIELDS(f.reference, f.reference_speed, f.reference_end, f.deceleration);
  FIELDS(within(f.cruising, -1, 0), f.per_x, f.per_y, f.per_yaw, f.per_wheel, f.top_speed,
         f.acceleration);
  FIELDS(f.robots, f.index_of_id, f.tasks);
}

// --- models, storage units, items

template <class A>
void describe(A& a, CollisionGeometry& o) {
  DESCRIBED(CollisionGeometry, 6);
  FIELDS(o.link, o.pose_in_link, o.shape);
}

template <class A>
void describe(A& a, JointSettings& s) {
  DESCRIBED(JointSettings, 6);
  FIELDS(s.damping, s.friction, within(s.lower, -kEndless, kEndless),
         within(s.upper, -kEndless, kEndless), s.motor_speed, s.motor_effort);
}

template <class A>
void describe(A& a, JointState& s) {
  DESCRIBED(JointState, 3);
  FIELDS(s.position, s.rate, s.settings);
}

template <class A>
void describe(A& a, Model& m) {
  DESCRIBED(Model, 22);
  FIELDS(m.name, m.kind, m.serial, m.spawn_pose);
  if constexpr (A::kReads) m.owner = &ownerOf(m.kind);
  a.mostly(m.pose, m.spawn_pose);
  FIELDS(m.index, m.in_physics, m.active_until, m.disturbed, m.upright, m.rocking, m.tips, m.joints,
         m.robot_namespace);
  if (m.kind == ModelKind::kRobot) FIELDS(m.geometries);  // derived for other kinds
}

template <class A>
void describe(A& a, StorageUnit& u) {
  DESCRIBED(StorageUnit, 8);
  FIELDS(u.name, u.id, u.model, u.mass, u.carrier, u.claimed_by, u.pose_on_carrier, u.raised);
}

template <class A>
void describe(A& a, Item& i) {
  DESCRIBED(Item, 7);
  FIELDS(i.id, i.model, i.unit, i.pose_in_unit, i.mass);  // its name is its model's
  a.mostly(i.spawn_pose_in_unit, i.pose_in_unit);
}

// --- Bullet

template <class A>
void describe(A& a, btVector3& v) {
  FIELDS(v.m_floats[0], v.m_floats[1], v.m_floats[2]);
}

template <class A>
void describe(A& a, btTransform& t) {
  btMatrix3x3& basis = t.getBasis();
  FIELDS(basis[0], basis[1], basis[2], t.getOrigin());
  if (A::kReads && !(std::abs(basis.determinant() - 1) < kUnitError)) {
    throw ArchiveError("expected a rotation", "basis");
  }
}

template <class A>
void describe(A& a, BodyState& b) {
  DESCRIBED(BodyState, 15);
  FIELDS(b.pose, b.predicted_pose, b.velocity, b.angular_velocity, b.predicted_velocity,
         b.predicted_angular_velocity, b.force, b.torque, within(b.mass, 1e-9, 1e12),
         b.inverse_inertia, within(b.activation, 1, 5), b.placed, b.resting, b.parts, b.faceted);
}

template <class A>
void describe(A& a, MotorState& m) {
  DESCRIBED(MotorState, 3);
  FIELDS(m.powered, m.speed, m.effort);
}

template <class A>
void describe(A& a, ModelInPhysics& m) {
  DESCRIBED(ModelInPhysics, 3);
  FIELDS(m.slot, m.links, m.motors);
}

template <class A>
void describe(A& a, BodyAddress& b) {
  DESCRIBED(BodyAddress, 3);
  FIELDS(b.model, b.link, b.is_surface);
}

template <class A>
void describe(A& a, btManifoldPoint& p) {
  FIELDS(p.m_localPointA, p.m_localPointB, p.m_positionWorldOnA, p.m_positionWorldOnB,
         p.m_normalWorldOnB, p.m_distance1, p.m_combinedFriction, p.m_combinedRollingFriction,
         p.m_combinedSpinningFriction, p.m_combinedRestitution, p.m_partId0, p.m_partId1,
         p.m_index0, p.m_index1, p.m_contactPointFlags, p.m_appliedImpulse, p.m_prevRHS,
         p.m_appliedImpulseLateral1, p.m_appliedImpulseLateral2, p.m_contactMotion1,
         p.m_contactMotion2, p.m_contactCFM, p.m_contactERP, p.m_frictionCFM, p.m_lifeTime,
         p.m_lateralFrictionDir1, p.m_lateralFrictionDir2);
}

template <class A>
void describe(A& a, ContactMemory& c) {
  DESCRIBED(ContactMemory, 5);
  FIELDS(c.a, c.b, c.part_a, c.part_b, c.points);
  if (A::kReads && c.points.size() > MANIFOLD_CACHE_SIZE) {
    throw ArchiveError("Bullet keeps no more than four", "points");
  }
}

template <class A>
void describe(A& a, Solid& s) {
  FIELDS(s.kind, s.half, s.axes[0], s.axes[1], s.axes[2]);
}

/// Describes a mover's footprint, which has no body and no triangles.
template <class A>
void describe(A& a, Footprint& f) {
  DESCRIBED(Footprint, 14);
  std::optional<Solid> solid;
  if (f.solid) solid = *f.solid;
  FIELDS(f.kind, within(f.x, -100, 100), within(f.y, -100, 100), within(f.c, -1.001, 1.001),
         within(f.s, -1.001, 1.001), within(f.hx, 0, 100), within(f.hy, 0, 100), f.z_min, f.z_max,
         f.model, f.group, solid);
  if constexpr (A::kReads) f.solid = solid ? std::make_shared<const Solid>(*solid) : nullptr;
}

template <class A>
void describe(A& a, PhysicsState& p) {
  DESCRIBED(PhysicsState, 3);
  FIELDS(p.models, p.contacts, p.movers);
}

// --- the world

template <class A>
void describe(A& a, Command& c) {
  DESCRIBED(Command, 7);
  FIELDS(c.kind, c.kiva_id, c.x, c.y, c.direction, c.lift, c.shelf_id);
}

template <class A>
void describe(A& a, FollowPath& p) {
  DESCRIBED(FollowPath, 8);
  FIELDS(p.kiva_id, p.path_id, p.first, within(p.x, -1e308, 1e308), within(p.y, -1e308, 1e308),
         p.released, p.fault, within(p.max_speed, 0, kEndless));
}

template <class A>
void describe(A& a, CommandMessage& m) {
  DESCRIBED(CommandMessage, 2);
  FIELDS(m.due, m.pending.command, m.pending.path);
}

template <class A>
void describe(A& a, ReportMessage& m) {
  DESCRIBED(ReportMessage, 4);
  FIELDS(m.due, m.number, m.kiva_id, m.report);
}

template <class A>
void describe(A& a, Impact& i) {
  DESCRIBED(Impact, 4);
  FIELDS(i.point, i.normal, i.speed, i.impulse);
}

template <class A>
void describe(A& a, Event& e) {
  DESCRIBED(Event, 7);
  FIELDS(e.time, e.kind, e.model, e.other, e.text, e.command, e.impact);
}

template <class A>
void describe(A& a, Period& p) {
  DESCRIBED(Period, 2);
  FIELDS(p.start, within(p.end, -kEndless, kEndless));
}

template <class A>
void describe(A& a, Wrench& w) {
  DESCRIBED(Wrench, 5);
  FIELDS(w.model, w.link, w.force, w.torque, w.period);
}

template <class A>
void describe(A& a, Effort& e) {
  DESCRIBED(Effort, 4);
  FIELDS(e.model, e.joint, e.effort, e.period);
}

template <class A>
void describe(A& a, Light& l) {
  DESCRIBED(Light, 16);
  FIELDS(l.name, l.kind, l.pose, l.diffuse, l.specular, l.attenuation_constant,
         l.attenuation_linear, l.attenuation_quadratic, l.direction, l.cast_shadows);
}

template <class A>
void describe(A& a, OdeSettings& o) {
  DESCRIBED(OdeSettings, 10);
  FIELDS(o.auto_disable_bodies, o.sor_pgs_precon_iters, o.sor_pgs_iters, o.sor_pgs_w,
         o.sor_pgs_rms_error_tol, o.contact_surface_layer, o.contact_max_correcting_vel, o.cfm,
         o.erp, o.max_contacts);
}

template <class A>
void describe(A& a, ExternalInputs& i) {
  DESCRIBED(ExternalInputs, 4);
  std::vector<Light> lights;
  for (const auto& [name, light] : i.lights) lights.push_back(light);
  FIELDS(i.wrenches, i.efforts, lights, i.ode);
  if constexpr (A::kReads) {
    i.lights.clear();
    for (Light& light : lights) i.lights[light.name] = std::move(light);
  }
}

template <class A>
void describe(A& a, StatusChange& s) {
  DESCRIBED(StatusChange, 8);
  FIELDS(s.time, s.kiva_id, s.status, s.state, s.shelf_id, s.x, s.y, s.yaw);
}

template <class A>
void describe(A& a, TouchingPair& t) {
  DESCRIBED(TouchingPair, 6);
  FIELDS(t.model_a, t.model_b, t.last_step, t.impact, t.report_at, t.report_latest);
}

template <class A>
void describe(A& a, Crash& c) {
  DESCRIBED(Crash, 2);
  FIELDS(c.kiva_id, c.with);
}

template <class A>
void describe(A& a, OffShelf& o) {
  DESCRIBED(OffShelf, 5);
  FIELDS(o.item, o.unit, o.velocity, o.lies, o.due);
}

template <class A>
void describe(A& a, Defect& d) {
  DESCRIBED(Defect, 4);
  FIELDS(d.kiva_id, d.failure, within(d.left, 0, kEndless), d.last);
}

template <class A>
void describe(A& a, FailureState& f) {
  DESCRIBED(FailureState, 3);
  FIELDS(f.defects, within(f.exposure, 0, kEndless), f.count);
}

template <class A>
void describe(A& a, Waypoint& w) {
  DESCRIBED(Waypoint, 4);
  FIELDS(w.x, w.y, within(w.speed, 1e-9, kMostWalkingSpeed), within(w.pause, 0, 1e9));
}

template <class A>
void describe(A& a, Walk& w) {
  DESCRIBED(Walk, 2);
  FIELDS(w.waypoints, w.loops);
}

template <class A>
void describe(A& a, Walker& w) {
  DESCRIBED(Walker, 15);
  FIELDS(w.model, within(w.radius, 0, 1), w.bottom, w.top, w.script, w.walk, w.next, w.pause,
         w.detour, w.vx, w.vy, w.is_free, w.look_at, w.held_up, w.patience);
}

template <class A>
void describe(A& a, LightCurtain& c) {
  DESCRIBED(LightCurtain, 5);
  FIELDS(c.name, c.min_x, c.max_x, c.min_y, c.max_y);
}

template <class A>
void describe(A& a, PluginState& p) {
  DESCRIBED(PluginState, 3);
  FIELDS(p.model, p.index, p.state);
}

template <class A>
void describe(A& a, FloorExtent& f) {
  DESCRIBED(FloorExtent, 5);
  FIELDS(f.min_x, f.max_x, f.min_y, f.max_y, f.z);
}

template <class A>
void describe(A& a, FloorPatch& p) {
  DESCRIBED(FloorPatch, 5);
  FIELDS(p.min_x, p.max_x, p.min_y, p.max_y, within(p.friction, 0, kMostFriction));
}

template <class A>
void describe(A& a, Realism& r) {
  DESCRIBED(Realism, 10);
  forEachSection(r, [&a](const char*, auto& section) {
    a(section.enabled);
    section.fields(section, limited(a));
  });
}

template <class A>
void describe(A& a, WorldOptions& o) {
  DESCRIBED(WorldOptions, 6);
  FIELDS(o.seed, o.drive, o.always_in_bullet,
         o.realism);  // plugins and threads stay those of the restoring world
}

#undef DESCRIBED

}  // namespace kiva
