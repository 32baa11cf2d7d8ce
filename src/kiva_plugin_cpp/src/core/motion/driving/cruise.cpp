// SPDX-License-Identifier: Apache-2.0
#include "core/motion/driving/cruise.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/motion/driving/clearance.h"
#include "core/motion/driving/drives.h"
#include "core/motion/driving/speed_limits.h"
#include "core/motion/driving/stretches.h"
#include "core/motion/wheels/ground.h"
#include "core/parallel/avx2_clone.h"
#include "core/parallel/workers.h"
#include "core/state/progress/path_progress.h"

namespace kiva {
namespace {

/// Returns whether the chassis moves exactly as its reference.
bool keepsUp(const FleetState& f, int i, const ReferenceMotion& per) {
  const double v = f.reference_speed[i];
  return isExact(f.vx[i] - per.x * v) && isExact(f.vy[i] - per.y * v) &&
         isExact(f.yaw_rate[i] - per.yaw * v);
}

/// Returns the highest speed of the reference from now to its goal.
double peakSpeed(const FleetState& f, int i, const ReferenceMotion& per) {
  const double way = std::abs(f.reference_end[i] - f.reference[i]), v = f.reference_speed[i];
  const double peak = std::sqrt(v * v / 2 + per.acceleration * way);
  return std::min(per.top_speed, std::max(std::abs(v), peak));
}

bool hasForce(const FleetState& f, int i, const ReferenceMotion& per, const Ground& ground) {
  const Robot& robot = f.robots[i];
  if (robot.drive.acceleration == 0) return true;  // grip and motors have no limit
  if (per.acceleration == 0) return false;
  const double hardest = std::max(per.acceleration, f.deceleration[i]);
  const Vehicle vehicle = vehicleOf(robot, ground);
  if (per.yaw == 0) return hardest < std::min(drivingLimit(vehicle), brakingLimit(vehicle));
  const double peak = peakSpeed(f, i, per);
  return std::max(turningEffort(vehicle, hardest, peak), turningEffort(vehicle, -hardest, peak)) <
         1;
}

/// Returns the last, uneven steps of a reference's way, which are left to the robot's motors [m,
/// rad].
inline double endOf(double acceleration, double deceleration, double speed, double dt) {
  const double end = std::abs(speed) * dt + deceleration * dt * dt;
  return acceleration > 0 ? end : 0.0;
}

bool hasEnded(const FleetState& f, int i, double dt) {
  return std::abs(f.reference_end[i] - f.reference[i]) <=
         endOf(f.acceleration[i], f.deceleration[i], f.reference_speed[i], dt);
}

constexpr int kBlock = 16;           // robots that share an entry of StepSchedule::cruised
constexpr int kLanes = 4;            // robots of a vector: skipped if none of them cruises
constexpr int kBlocksTogether = 96;  // on one thread: fewer do not justify waking another
constexpr int kLooksTogether = 32;   // the same

/// Implements advance() for robots whose motors lag, or don't.
template <bool kLags>
__attribute__((always_inline)) inline bool advanceAll(FleetState& f, int begin, int end, double dt,
                                                      double now) {
  const MotorLag lag = f.lag;
  double* __restrict command_speed = f.command_speed.data();
  const std::int64_t* __restrict mask = f.cruising.data();
  const double* __restrict goal = f.reference_end.data();
  const double* __restrict top = f.top_speed.data();
  const double* __restrict acceleration = f.acceleration.data();
  const double* __restrict deceleration = f.deceleration.data();
  const double* __restrict until = f.attend_at.data();
  const double* __restrict per_x = f.per_x.data();
  const double* __restrict per_y = f.per_y.data();
  const double* __restrict per_yaw = f.per_yaw.data();
  const double* __restrict per_left = f.per_wheel[0].data();
  const double* __restrict per_right = f.per_wheel[1].data();
  double* __restrict reference = f.reference.data();
  double* __restrict speed = f.reference_speed.data();
  double* __restrict x = f.x.data();
  double* __restrict y = f.y.data();
  double* __restrict yaw = f.yaw.data();
  double* __restrict vx = f.vx.data();
  double* __restrict vy = f.vy.data();
  double* __restrict yaw_rate = f.yaw_rate.data();
  double* __restrict left = f.wheel_angle[0].data();
  double* __restrict right = f.wheel_angle[1].data();
  double* __restrict left_speed = f.wheel_speed[0].data();
  double* __restrict right_speed = f.wheel_speed[1].data();
  std::int64_t attention = 0;
  const auto advanceOne = [&](int i) __attribute__((always_inline)) {
    const std::int64_t cruises = mask[i];
    const double was_reference = reference[i], was_speed = speed[i];
    const double was_vx = vx[i], was_vy = vy[i], was_yaw_rate = yaw_rate[i];
    const double was_left = left_speed[i], was_right = right_speed[i];
    Profile profile{was_reference, was_speed};
    if constexpr (kLags) {
      const double was_command = command_speed[i];
      profile = {was_reference + lag.behind * was_speed, was_command};
      profile.advance(goal[i], top[i], acceleration[i], deceleration[i], dt);
      command_speed[i] = cruises ? profile.speed : was_command;
      profile.speed = was_speed + lag.share * (profile.speed - was_speed);
      profile.position -= lag.behind * profile.speed;
    } else {
      profile.advance(goal[i], top[i], acceleration[i], deceleration[i], dt);
    }
    const double v = profile.speed;
    const double way = cruises ? v * dt : 0.0;
    reference[i] = cruises ? profile.position : was_reference;
    speed[i] = cruises ? v : was_speed;
    x[i] += per_x[i] * way;
    y[i] += per_y[i] * way;
    yaw[i] += per_yaw[i] * way;
    left[i] += per_left[i] * way;
    right[i] += per_right[i] * way;
    vx[i] = cruises ? per_x[i] * v : was_vx;
    vy[i] = cruises ? per_y[i] * v : was_vy;
    yaw_rate[i] = cruises ? per_yaw[i] * v : was_yaw_rate;
    left_speed[i] = cruises ? per_left[i] * v : was_left;
    right_speed[i] = cruises ? per_right[i] * v : was_right;
    const double end = endOf(acceleration[i], deceleration[i], v, dt);
    const std::int64_t ended = std::abs(goal[i] - profile.position) <= end ? -1 : 0;
    const std::int64_t due = until[i] <= now ? -1 : 0;
    attention |= cruises & (ended | due);
  };
  int i = begin;
  for (; i + kLanes <= end; i += kLanes) {
    if ((mask[i] | mask[i + 1] | mask[i + 2] | mask[i + 3]) == 0) continue;
#pragma GCC ivdep
    for (int lane = i; lane < i + kLanes; ++lane) advanceOne(lane);
  }
  for (; i < end; ++i) advanceOne(i);
  return attention != 0;
}

/// Advances robots [begin, end) that cruise by one step. Returns whether one of them needs
/// attention: its reference has ended, or `now` is the step that it waits for.
KIVA_AVX2_CLONE bool advance(FleetState& f, int begin, int end, double dt, double now) {
  return f.lag.isNone() ? advanceAll<false>(f, begin, end, dt, now)
                        : advanceAll<true>(f, begin, end, dt, now);
}

/// Returns the least number of steps in which the robot's reference can reach `place`:
/// accelerating, or at top speed, all the way.
double stepsTo(const FleetState& f, int i, double place, double dt) {
  const double way = place - f.reference[i];
  const double faster = f.acceleration[i] * dt * dt;  // gain of each step's length over the last
  double steps = way / (f.top_speed[i] * dt);
  if (faster > 0 && f.reference_speed[i] < f.top_speed[i]) {
    const double first = f.reference_speed[i] * dt + faster / 2;
    steps = std::max(steps, (std::sqrt(first * first + 2 * faster * way) - first) / faster);
  }
  return std::max(1.0, std::ceil(steps - 1e-6));
}

/// Plans the next step after number `after` at which a cruising robot needs attention.
void planAttention(RobotView& world, int i, double after) {
  FleetState& f = world.fleet;
  f.attend_at[i] = f.clear_until[i];
  if (f.localises && !f.localisation[i].stretch.turns) {
    const double end = after + stepsTo(f, i, f.localisation[i].stretch.until, world.clock.dt);
    f.attend_at[i] = std::min(f.attend_at[i], end);
  }
  if (f.tasks[i].path.isLimited()) {
    const double until = holdsUntil(world, i, f.top_speed[i]) - 2 * f.top_speed[i] * world.clock.dt;
    f.attend_at[i] = std::min(f.attend_at[i], after + stepsTo(f, i, until, world.clock.dt));
  }
  if (std::isinf(f.count_at[i])) return;
  const double next = after + stepsTo(f, i, f.count_at[i], world.clock.dt);
  f.attend_at[i] = std::min(f.attend_at[i], next);
}

/// Does the same after a change of its way.
void replanAttention(RobotView& world, int i) {
  world.fleet.count_at[i] = nextCount(world, i);
  planAttention(world, i, static_cast<double>(world.clock.total_steps));
}

/// Counts the points that the robot has reached or left.
void count(RobotView& world, int i) {
  countPoints(world, i, world.fleet.reference[i]);
  world.fleet.count_at[i] = nextCount(world, i);
}

/// A cruising robot that needs attention now.
struct Attention {
  int robot = -1;
  bool ended = false;     ///< Whether its reference has ended.
  double clear_time = 0;  ///< Duration for which its way is free from here [s], if needed.
};

void attend(TaskView& world, Obstacles& obstacles, const Attention& due, double now) {
  FleetState& f = world.fleet;
  const int i = due.robot;
  bool ended = due.ended;
  if (f.reference[i] >= f.count_at[i]) count(world, i);
  if (f.localises && !ended) ended = !continueStretch(world, i) || hasEnded(f, i, world.clock.dt);
  if (ended || !holdsSpeed(world, i, f.top_speed[i])) return moved(f, i);
  // A robot that has just read a code may change its way.
  const auto time = [&] { return f.localises ? clearTime(world, i, false) : due.clear_time; };
  if (f.clear_until[i] <= now && !noteClearance(world, obstacles, i, time())) return moved(f, i);
  planAttention(world, i, now);
}

enum : char { kNeedsALook = 1, kCarries = 2 };

/// Advances the cruising robots of block `b` by one step. Returns the attention that the block
/// needs.
char advanceBlock(FleetState& f, int b, double dt, double now) {
  const int begin = b * kBlock, end = std::min(begin + kBlock, f.size());
  std::int64_t any = 0, loaded = 0;
  for (int i = begin; i < end; ++i) {
    any |= f.cruising[i];
    loaded |= f.cruising[i] & (f.unit[i] >= 0);
  }
  if (any == 0) return 0;
  const bool needs_a_look = advance(f, begin, end, dt, now);
  return static_cast<char>((needs_a_look ? kNeedsALook : 0) | (loaded ? kCarries : 0));
}

/// Adds the robots of block `b` that need attention.
void findAttention(const Scene& world, int b, double now, std::vector<Attention>* out) {
  const FleetState& f = world.fleet;
  const int begin = b * kBlock, end = std::min(begin + kBlock, f.size());
  for (int i = begin; i < end; ++i) {
    if (f.cruising[i] == 0) continue;
    const bool ended = hasEnded(f, i, world.clock.dt);
    if (ended || f.attend_at[i] <= now) out->push_back({i, ended, 0});
  }
}

/// Computes clear times on all threads, after all robots have moved. Storing them later does not
/// change their results.
void attendAll(TaskView& world, Obstacles& obstacles, std::vector<Attention> all, double now) {
  const FleetState& f = world.fleet;
  world.schedule.workers->share(
      static_cast<int>(all.size()), kLooksTogether, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
          const int i = all[k].robot;
          const bool asks = !all[k].ended && !f.localises && f.clear_until[i] <= now;
          if (asks) all[k].clear_time = clearTime(world, i, false);
        }
      });
  for (const Attention& due : all) attend(world, obstacles, due, now);
}

/// Sets the motion per unit of reference, exactly or by the robot's own estimate.
void setMotion(RobotView& world, int i, const ReferenceMotion& per) {
  FleetState& f = world.fleet;
  if (f.localises) return beginStretch(world, i, per.yaw != 0);
  const DriveParameters& drive = f.robots[i].drive;
  const double turn = per.yaw * drive.wheel_separation / 2;
  const double ahead = std::cos(f.yaw[i]) * per.x + std::sin(f.yaw[i]) * per.y;
  f.per_x[i] = per.x;
  f.per_y[i] = per.y;
  f.per_yaw[i] = per.yaw;
  f.per_wheel[0][i] = (ahead - turn) / drive.wheel_radius;
  f.per_wheel[1][i] = (ahead + turn) / drive.wheel_radius;
}

}  // namespace

bool tryCruise(RobotView& world, Obstacles& obstacles, int i, const ReferenceMotion& per) {
  FleetState& f = world.fleet;
  const Robot& r = f.robots[i];
  const double way = std::abs(f.reference_end[i] - f.reference[i]);
  const double end =
      endOf(per.acceleration, f.deceleration[i], f.reference_speed[i], world.clock.dt);
  if (r.drive.drive == Drive::kJointed || f.activated[i] ||
      world.settings.options.always_in_bullet || f.sway[i].tilt > 0 || way <= end ||
      (f.tower[i] > 0 && f.unit[i] < 0) || std::abs(f.reference_speed[i]) > per.top_speed ||
      !hasClearance(world, i) ||
      !(f.localises ? keepsUpByEstimate(f, i, per.yaw != 0) : keepsUp(f, i, per)) ||
      !hasForce(f, i, per, groundAhead(world, i))) {
    return false;
  }
  setMotion(world, i, per);
  f.top_speed[i] = per.top_speed;
  f.acceleration[i] = per.acceleration;
  f.cruising[i] = -1;
  if (!hasEnded(f, i, world.clock.dt) && findClearance(world, obstacles, i, true)) {
    replanAttention(world, i);
    return true;
  }
  f.cruising[i] = 0;
  if (f.localises) f.localisation[i].stretch.under_way = false;  // it has not moved yet
  return false;
}

void setReferenceEnd(RobotView& world, Obstacles& obstacles, int i, double goal) {
  FleetState& f = world.fleet;
  const double left = f.clear_until[i] - static_cast<double>(world.clock.total_steps) + 1;
  const bool saw_the_end =
      f.reference_end[i] - f.reference[i] < left * f.top_speed[i] * world.clock.dt;
  const bool goes_farther = goal > f.reference_end[i];
  f.reference_end[i] = goal;
  if (f.cruising[i] == 0) return;
  // Its way was clear up to the old goal only.
  if (goes_farther && isPatchy(world)) return moved(f, i);
  if (saw_the_end && goes_farther && !findClearance(world, obstacles, i, false)) return moved(f, i);
  replanAttention(world, i);
}

void cruise(MotionView& world) {
  FleetState& f = world.fleet;
  const auto next = static_cast<double>(world.clock.total_steps + 1);
  world.schedule.cruised.resize((f.size() + kBlock - 1) / kBlock);
  const auto blocks = static_cast<int>(world.schedule.cruised.size());
  world.schedule.workers->share(blocks, kBlocksTogether, [&](int begin, int end) {
    for (int b = begin; b < end; ++b)
      world.schedule.cruised[b] = advanceBlock(f, b, world.clock.dt, next);
  });
  char any = 0;
  std::vector<Attention> due;
  for (int b = 0; b < blocks; ++b) {
    any |= world.schedule.cruised[b];
    if (world.schedule.cruised[b] & kNeedsALook) findAttention(world, b, next, &due);
  }
  attendAll(world, world.obstacles, std::move(due), next);
  if (any & kCarries) world.storage.noteMove();
}

}  // namespace kiva
