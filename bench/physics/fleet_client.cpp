// SPDX-License-Identifier: Apache-2.0
//
// One client of a whole warehouse under ROS: gives every idle robot a random command, and listens
// to the status and the scan of each robot. Prints how many messages came, how late they were, and
// how long commands took to be accepted; and the CPU time that this took here and in another
// process.
//
// How late: a message's wall time less its stamp, against the quickest message of the same second.
// That needs simulated time to follow the wall clock, that is, rtf:=1.
#include <ros/callback_queue_interface.h>
#include <ros/ros.h>
#include <sensor_msgs/LaserScan.h>
#include <unistd.h>
#include <warehouse_msgs/Event.h>
#include <warehouse_msgs/FleetState.h>
#include <warehouse_msgs/KivaStatus.h>
#include <warehouse_msgs/Lift.h>
#include <warehouse_msgs/MoveAlong.h>
#include <warehouse_msgs/MoveTo.h>
#include <warehouse_msgs/Rotate.h>
#include <warehouse_msgs/UnitStates.h>
#include <warehouse_msgs/WarehouseObjects.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "random_commands.h"

namespace {

constexpr char kHelp[] =
    "fleet_client [--no-listen] [--no-command] [--seconds S] [--watch PID]\n"
    "  --no-listen   to no topic of a single robot\n"
    "  --no-command  robots stand\n"
    "  --seconds     of wall time, once all is connected (30)\n"
    "  --watch       also print the CPU time of process PID\n";
constexpr double kPatience = 120;  // time until all is connected [s]
constexpr double kSettling = 3;  // time until the messages of the connecting phase are handled [s]
constexpr int kQueue = 100000;
constexpr auto kLook = std::chrono::milliseconds(50);  // between two at what came

struct Options {
  bool listen = true, command = true;
  double seconds = 30;
  int watched = 0;  // process
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--no-listen") {
      options.listen = false;
    } else if (word == "--no-command") {
      options.command = false;
    } else if (word == "--seconds" && i + 1 < argc) {
      options.seconds = std::atof(argv[++i]);
    } else if (word == "--watch" && i + 1 < argc) {
      options.watched = std::atoi(argv[++i]);
    } else {
      std::fputs(kHelp, stderr);
      std::exit(2);
    }
  }
  return options;
}

double now() { return ros::WallTime::now().toSec(); }

/// Returns the CPU time of all threads of a process, 0 for this one [s]; 0 if there is no such
/// process.
double cpuTime(int process) {
  const std::string name = process ? std::to_string(process) : "self";
  std::ifstream file("/proc/" + name + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(std::min(text.rfind(')') + 1, text.size())));
  std::string skipped;
  for (int k = 0; k < 11; ++k) fields >> skipped;  // state to cmajflt
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

int numberOf(const std::string& name) {
  return std::atoi(name.c_str() + std::min(name.find_first_of("0123456789"), name.size()));
}

/// Times in [ms].
class Times {
 public:
  void add(double seconds) { ms_.push_back(static_cast<float>(1e3 * seconds)); }
  void clear() { ms_.clear(); }
  /// Returns a percentile [ms] as JSON, null without messages.
  std::string percentile(double share) {
    if (ms_.empty()) return "null";
    const auto at = ms_.begin() + static_cast<long>(share * static_cast<double>(ms_.size() - 1));
    std::nth_element(ms_.begin(), at, ms_.end());
    return std::to_string(*at);
  }

 private:
  std::vector<float> ms_;
};

/// Calls back in the thread that received, roscpp's own: for so many small messages the usual
/// second thread would cost as much, since it has to wake for them.
class ReceivingThread : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    callback->call();
  }
  void removeByID(std::uint64_t) override {}  // nothing waits

  /// Calls look() while no callback writes.
  template <typename Look>
  auto pause(Look look) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return look();
  }

 private:
  std::mutex mutex_;
};

/// Subscribes to each robot's status and scan; counts, and measures how late they are.
class Listener {
 public:
  void listen(ros::NodeHandle& node, const std::vector<int>& ids) {
    counts_.assign(2 * ids.size(), 0);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::string robot = "/kiva" + std::to_string(ids[i]);
      subscribe<warehouse_msgs::KivaStatus>(node, robot + "/status", 2 * i);
      subscribe<sensor_msgs::LaserScan>(node, robot + "/chassis/laser/scan", 2 * i + 1);
    }
  }

  bool heardAll() const {
    return std::all_of(counts_.begin(), counts_.end(), [](long count) { return count > 0; });
  }
  void restart() {
    std::fill(counts_.begin(), counts_.end(), 0);
    second_.clear();
    late_.clear();
  }
  long messages() const {
    long sum = 0;
    for (long count : counts_) sum += count;
    return sum;
  }
  /// Returns the number of messages of the topic with the fewest.
  long fewest() const {
    return counts_.empty() ? 0 : *std::min_element(counts_.begin(), counts_.end());
  }
  Times& late() { return late_; }

 private:
  template <typename Message>
  void subscribe(ros::NodeHandle& node, const std::string& topic, std::size_t index) {
    const boost::function<void(const boost::shared_ptr<const Message>&)> note =
        [this, index](const boost::shared_ptr<const Message>& message) {
          this->note(index, message->header.stamp.toSec());
        };
    subscribers_.push_back(node.subscribe<Message>(topic, 100, note, ros::VoidConstPtr(),
                                                   ros::TransportHints().tcpNoDelay()));
  }

  void note(std::size_t index, double stamp) {
    ++counts_[index];
    const double wall = now();
    if (wall > second_ends_) {
      second_ends_ = wall + 1;
      if (!second_.empty()) {
        const double quickest = *std::min_element(second_.begin(), second_.end());
        for (double delay : second_) late_.add(delay - quickest);
      }
      second_.clear();
    }
    second_.push_back(wall - stamp);
  }

  std::vector<long> counts_;  // two topics a robot
  std::vector<double> second_;
  double second_ends_ = 0;
  Times late_;
  std::vector<ros::Subscriber> subscribers_;  // last: they go before what their callbacks write
};

/// Gives commands, and measures how long they take to be accepted.
class Commander {
 public:
  explicit Commander(ros::NodeHandle& node)
      : mov_(node.advertise<warehouse_msgs::MoveTo>("/mov", kQueue)),
        movx_(node.advertise<warehouse_msgs::MoveAlong>("/movx", kQueue)),
        movy_(node.advertise<warehouse_msgs::MoveAlong>("/movy", kQueue)),
        rot_(node.advertise<warehouse_msgs::Rotate>("/rot", kQueue)),
        lift_(node.advertise<warehouse_msgs::Lift>("/lift", kQueue)),
        events_(node.subscribe("/warehouse/events", kQueue, &Commander::note, this,
                               ros::TransportHints().tcpNoDelay())) {}

  void standsAt(int shelf_id, double x, double y) { random_.standsAt(shelf_id, x, y); }

  void dispatch(const warehouse_msgs::FleetState& fleet) {
    for (std::size_t i = 0; i < fleet.kiva_id.size(); ++i) {
      const bench::Waiting robot{fleet.kiva_id[i], fleet.x[i], fleet.y[i], fleet.shelf_id[i]};
      places_[robot.kiva_id] = robot;
      if (fleet.status[i] != warehouse_msgs::KivaStatus::STATUS_IDLE) continue;
      if (sent_.count(robot.kiva_id)) continue;
      sent_[robot.kiva_id] = now();
      publish(random_.next(robot));
    }
  }

  void restart() {
    took_.clear();
    counts_.clear();
  }
  Times& took() { return took_; }
  long count(int kind) { return counts_[kind]; }

 private:
  void publish(const kiva::Command& command) {
    using Kind = kiva::Command::Kind;
    if (command.kind == Kind::kMoveTo) {
      warehouse_msgs::MoveTo message;
      message.x = command.x;
      message.y = command.y;
      message.kiva_id = command.kiva_id;
      mov_.publish(message);
    } else if (command.kind == Kind::kRotate) {
      warehouse_msgs::Rotate message;
      message.direction = static_cast<std::int8_t>(command.direction);
      message.kiva_id = command.kiva_id;
      rot_.publish(message);
    } else if (command.kind == Kind::kLift) {
      warehouse_msgs::Lift message;
      message.status = static_cast<std::uint8_t>(command.lift);
      message.kiva_id = command.kiva_id;
      message.shelf_id = command.shelf_id;
      lift_.publish(message);
    } else {
      const bool along_x = command.kind == Kind::kMoveX;
      warehouse_msgs::MoveAlong message;
      message.distance = along_x ? command.x : command.y;
      message.kiva_id = command.kiva_id;
      (along_x ? movx_ : movy_).publish(message);
    }
  }

  void note(const warehouse_msgs::Event& event) {
    ++counts_[event.kind];
    const int id = numberOf(event.model);
    if (event.kind == event.ACCEPTED || event.kind == event.REFUSED) {
      const auto at = sent_.find(id);
      if (at == sent_.end()) return;
      if (event.kind == event.ACCEPTED) took_.add(now() - at->second);
      sent_.erase(at);
    } else if (event.kind == event.LIFTED) {
      random_.liftedAt(places_[id].x, places_[id].y);
    } else if (event.kind == event.DROPPED) {
      random_.standsAt(numberOf(event.other), places_[id].x, places_[id].y);
    }
  }

  bench::RandomCommands random_{1};
  std::map<int, bench::Waiting> places_;
  std::map<int, double> sent_;  // robot and time of each command, one command a robot at a time
  std::map<int, long> counts_;  // events by kind
  Times took_;
  ros::Publisher mov_, movx_, movy_, rot_, lift_;
  ros::Subscriber events_;  // last, likewise
};

template <typename Condition>
bool waitUntil(double deadline, ReceivingThread& thread, Condition condition) {
  while (ros::ok() && now() < deadline) {
    if (thread.pause(condition)) return true;
    std::this_thread::sleep_for(kLook);
  }
  return false;
}

void sleepUntil(double deadline) { ros::WallTime::sleepUntil(ros::WallTime(deadline)); }

/// Returns the newest message of a topic that is published periodically. Waits by the wall clock:
/// simulated seconds may be short.
template <typename Message>
boost::shared_ptr<const Message> first(ros::NodeHandle& node, ReceivingThread& thread,
                                       const std::string& topic) {
  boost::shared_ptr<const Message> message;
  const ros::Subscriber subscriber = node.subscribe<Message>(
      topic, 1, [&](const boost::shared_ptr<const Message>& newest) { message = newest; });
  if (!waitUntil(now() + kPatience, thread, [&] { return message != nullptr; })) {
    std::fprintf(stderr, "fleet_client: nothing came on %s\n", topic.c_str());
    std::exit(1);
  }
  return message;
}

void readUnits(ros::NodeHandle& node, ReceivingThread& thread, Commander& commander) {
  const auto objects = first<warehouse_msgs::WarehouseObjects>(node, thread, "/warehouse/objects");
  const auto units = first<warehouse_msgs::UnitStates>(node, thread, "/warehouse/unit_states");
  thread.pause([&] {
    for (std::size_t i = 0; i < objects->storage_units.size(); ++i) {
      const int id = numberOf(objects->storage_units[i]);
      commander.standsAt(id, units->pose[7 * i], units->pose[7 * i + 1]);
    }
  });
}

/// Prints the measurements as a line of JSON. `took`: [s, wall]; `simulated` meanwhile [s].
void print(std::size_t robots, double took, double simulated, double cpu, double watched_cpu,
           Listener& listener, Commander& commander) {
  using warehouse_msgs::Event;
  std::printf(
      "{\"robots\": %zu, \"rtf\": %.3f, \"messages_per_second\": %.0f, "
      "\"least_rate\": %.2f, \"late_p50_ms\": %s, \"late_p99_ms\": %s, "
      "\"accepted_p50_ms\": %s, \"accepted_p99_ms\": %s, \"accepted\": %ld, \"refused\": %ld, "
      "\"done\": %ld, \"blocked\": %ld, \"lifted\": %ld, \"collision\": %ld, "
      "\"cpu_s\": %.2f, \"watched_cpu_s\": %.2f}\n",
      robots, simulated / took, static_cast<double>(listener.messages()) / took,
      static_cast<double>(listener.fewest()) / took, listener.late().percentile(0.5).c_str(),
      listener.late().percentile(0.99).c_str(), commander.took().percentile(0.5).c_str(),
      commander.took().percentile(0.99).c_str(), commander.count(Event::ACCEPTED),
      commander.count(Event::REFUSED), commander.count(Event::DONE),
      commander.count(Event::BLOCKED), commander.count(Event::LIFTED),
      commander.count(Event::COLLISION), cpu, watched_cpu);
}

int run(const Options& options) {
  ReceivingThread thread;
  ros::NodeHandle node;
  node.setCallbackQueue(&thread);
  const auto fleet = first<warehouse_msgs::FleetState>(node, thread, "/warehouse/fleet");
  Listener listener;
  Commander commander(node);
  readUnits(node, thread, commander);
  double simulated = fleet->stamp.toSec();
  const auto follow = node.subscribe<warehouse_msgs::FleetState>(
      "/warehouse/fleet", 10, [&](const warehouse_msgs::FleetState::ConstPtr& state) {
        simulated = state->stamp.toSec();
        if (options.command) commander.dispatch(*state);
      });
  if (options.listen) listener.listen(node, fleet->kiva_id);
  if (!waitUntil(now() + kPatience, thread, [&] { return listener.heardAll(); })) {
    std::fprintf(stderr, "fleet_client: some robots were not heard\n");
    return 1;
  }
  sleepUntil(now() + kSettling);

  std::fprintf(stderr, "  %zu robots heard, measuring %g s\n", fleet->kiva_id.size(),
               options.seconds);
  const double simulated_begin = thread.pause([&] {
    listener.restart();
    commander.restart();
    return simulated;
  });
  const double begin = now();
  const double cpu_begin = cpuTime(0), watched_begin = cpuTime(options.watched);
  sleepUntil(begin + options.seconds);
  thread.pause([&] {
    print(fleet->kiva_id.size(), now() - begin, simulated - simulated_begin, cpuTime(0) - cpu_begin,
          cpuTime(options.watched) - watched_begin, listener, commander);
  });
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "fleet_client", ros::init_options::AnonymousName);
  return run(parse(argc, argv));
}
