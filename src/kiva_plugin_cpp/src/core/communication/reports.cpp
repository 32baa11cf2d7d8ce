// SPDX-License-Identifier: Apache-2.0
#include "core/communication/reports.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

constexpr double kReportPeriod = 0.1;  // [s]

bool comesLater(const ReportMessage& a, const ReportMessage& b) {
  return std::tie(a.due, a.number) > std::tie(b.due, b.number);
}

void sendReport(MotionView& world, int robot) {
  const FleetState& f = world.fleet;
  if (f.failures[robot] & bitOf(Failure::kRadio)) return;
  const RadioRealism& real = world.settings.realism.radio;
  const int id = f.robots[robot].id;
  const std::uint64_t number = ++world.report_link.sent;
  RandomStream random(world.settings.options.seed, Matter::kStatus, id, number);
  if (random.chance(real.status_lost)) return;
  const double rest = std::max(0.0, real.status_latency_mean - real.status_latency_least);
  const double latency = real.status_latency_least + random.exponential(rest);
  world.report_link.messages.push_back(
      {world.clock.total_steps + world.clock.stepsIn(latency), number, id, reportOf(world, robot)});
  std::push_heap(world.report_link.messages.begin(), world.report_link.messages.end(), comesLater);
}

bool tellsTheSame(const RobotReport& a, const RobotReport& b) {
  return a.status == b.status && a.state == b.state && a.shelf_id == b.shelf_id;
}

/// Takes in a report, unless a newer one has overtaken it.
void takeReport(MotionView& world, int robot, std::uint64_t number, const RobotReport& report) {
  Heard& heard = world.fleet.heard[robot];
  if (number < heard.number) return;
  const bool is_new = heard.number == 0 || !tellsTheSame(report, heard.report);
  heard = {number, report};
  if (!is_new) return;
  world.log.status_changes.push_back({world.clock.time(), world.fleet.robots[robot].id,
                                      report.status, report.state, report.shelf_id, report.x,
                                      report.y, report.yaw});
}

void receiveReports(MotionView& world) {
  auto& on_air = world.report_link.messages;
  while (!on_air.empty() && on_air.front().due <= world.clock.total_steps) {
    std::pop_heap(on_air.begin(), on_air.end(), comesLater);
    const ReportMessage& message = on_air.back();
    const int robot = world.fleet.find(message.kiva_id);
    if (robot >= 0) takeReport(world, robot, message.number, message.report);
    on_air.pop_back();
  }
}

}  // namespace

RobotReport reportOf(const Scene& world, int robot) {
  const Fleet& f = world.fleet;
  const int unit = f.unit[robot];
  return {f.x[robot],       f.y[robot],       f.yaw[robot],
          f.vx[robot],      f.vy[robot],      f.yaw_rate[robot],
          f.status[robot],  f.state[robot],   unit < 0 ? 0 : world.storage.units[unit].id,
          f.path_id[robot], f.reached[robot], f.left[robot],
          f.last_end[robot]};
}

void deliverReports(MotionView& world) {
  if (!world.settings.realism.radio.delaysReports()) return;
  std::vector<int> changed;
  changed.swap(world.report_link.changed);
  for (const int id : changed) {
    const int robot = world.fleet.find(id);
    if (robot < 0) continue;
    // The client that spawns a robot knows its pose.
    if (world.fleet.heard[robot].number == 0) {
      takeReport(world, robot, ++world.report_link.sent, reportOf(world, robot));
    } else {
      sendReport(world, robot);
    }
  }
  const auto period = static_cast<int>(world.clock.stepsIn(kReportPeriod));
  const auto first = static_cast<int>(world.clock.total_steps % static_cast<std::uint64_t>(period));
  for (int i = first; i < world.fleet.size(); i += period) sendReport(world, i);
  receiveReports(world);
}

void recordPlacement(MotionView& world, FailureState& failures, int robot) {
  const RobotReport report = reportOf(world, robot);
  if (world.fleet.heard[robot].number > 0)
    takeReport(world, robot, ++world.report_link.sent, report);
  const int id = world.fleet.robots[robot].id;
  for (Defect& defect : failures.defects) {
    if (defect.kiva_id == id) defect.last = report;
  }
}

}  // namespace kiva
