// SPDX-License-Identifier: Apache-2.0
//
// Shared by all benchmarks of this folder: chunks of simulated time, measured on the wall clock and
// on the CPU, and the line of JSON in which a figure is printed.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

namespace bench {

constexpr int kChunks = 5;

/// CPU time of the calling thread [s], which other programs on the machine do not change.
inline double cpuTime() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Real-time factors: simulated seconds a wall second, and a CPU second of the thread.
struct Factors {
  double wall = 0, cpu = 0;
};

/// Returns the medians over kChunks calls of `chunk`, each of which simulates `seconds`.
template <typename Chunk>
Factors measure(double seconds, Chunk chunk) {
  std::vector<double> wall, cpu;
  for (int i = 0; i < kChunks; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const double cpu_begin = cpuTime();
    chunk();
    const double cpu_took = cpuTime() - cpu_begin;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    wall.push_back(seconds / took.count());
    cpu.push_back(seconds / cpu_took);
  }
  return {median(wall), median(cpu)};
}

/// `more`: further members of the JSON object, each with a comma before it.
inline void print(const std::string& engine, int robots, bool lasers, const Factors& factors,
                  const std::string& more = "") {
  std::printf(
      "{\"engine\": \"%s\", \"robots\": %d, \"lasers\": %s, \"rtf\": %.4g, "
      "\"rtf_cpu\": %.4g%s}\n",
      engine.c_str(), robots, lasers ? "true" : "false", factors.wall, factors.cpu, more.c_str());
  std::fflush(stdout);
}

/// The options of all workloads: [--no-lasers] [--seconds S] N…; other words are left in `others`.
struct Options {
  bool lasers = true;
  double seconds = 2;  ///< Simulated time of a chunk.
  std::vector<int> robots;
  std::vector<std::string> others;
};

[[noreturn]] inline void usage(const char* text) {
  std::fputs(text, stderr);
  std::exit(2);
}

/// Parses the options. Exits with `help` for a malformed number, or without a number of robots.
inline Options parse(int argc, char** argv, const char* help) {
  Options options;
  const auto number = [help](const std::string& word) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end || !(value > 0)) usage(help);
    return value;
  };
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--no-lasers") {
      options.lasers = false;
    } else if (word == "--seconds" && i + 1 < argc) {
      options.seconds = number(argv[++i]);
    } else if (!word.empty() && word.find_first_not_of("0123456789") == std::string::npos) {
      options.robots.push_back(static_cast<int>(number(word)));
    } else {
      options.others.push_back(word);
    }
  }
  if (options.robots.empty()) usage(help);
  return options;
}

}  // namespace bench
