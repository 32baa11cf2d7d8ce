// SPDX-License-Identifier: Apache-2.0
//
// Damaged checkpoints: a few bytes are changed, and the seal is renewed, so that the content must
// be refused.
#pragma once

#include <cstring>
#include <random>
#include <stdexcept>
#include <string>

#include "core/checkpoint/archive.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva::test {

constexpr std::size_t kVersionAt = 8, kSizeAt = 12, kHashAt = 20, kContentAt = 28;

/// Returns a checkpoint with the size and the hash of its present content.
inline std::string resealed(std::string bytes) {
  std::uint32_t version = 0;
  std::memcpy(&version, &bytes[kVersionAt], sizeof version);
  const std::uint64_t size = bytes.size() - kContentAt;
  const std::uint64_t hash = hashBytes(version, &bytes[kContentAt], size);
  std::memcpy(&bytes[kSizeAt], &size, sizeof size);
  std::memcpy(&bytes[kHashAt], &hash, sizeof hash);
  return bytes;
}

class CheckpointDamager {
 public:
  explicit CheckpointDamager(unsigned long seed) : random_(seed) {}

  std::string operator()(std::string bytes) {
    for (std::size_t i = 1 + below(3); i > 0; --i) damage(&bytes);
    return resealed(std::move(bytes));
  }

  std::size_t below(std::size_t limit) { return random_() % limit; }

 private:
  template <typename T>
  void write(std::string* bytes, T value) {
    if (bytes->size() < kContentAt + sizeof value) return;
    const std::size_t at = kContentAt + below(bytes->size() - kContentAt - sizeof value + 1);
    std::memcpy(&(*bytes)[at], &value, sizeof value);
  }

  void damage(std::string* bytes) {
    static const double kNumbers[] = {0,     -0.0, 1,     -1,     1e-308,   1e308,
                                      -1e30, 1e15, 1e300, 0.5e-3, kEndless, std::nan("")};
    static const std::int32_t kIndices[] = {0, -1, 1, 2, 7, 100, 65536, 0x7fffffff, -0x7fffffff};
    const std::size_t at = kContentAt + below(bytes->size() - kContentAt);
    switch (below(7)) {
      case 0:
        return write(bytes, kNumbers[below(std::size(kNumbers))]);
      case 1:
        return write(bytes, kIndices[below(std::size(kIndices))]);
      case 2:
        return write(bytes, static_cast<std::uint8_t>(below(8)));
      case 3:
        return write(bytes, static_cast<std::uint8_t>(random_()));
      case 4:
        (*bytes)[at] ^= static_cast<char>(1 << below(8));
        return;
      case 5:
        bytes->erase(at, below(9));
        bytes->resize(std::max(bytes->size(), kContentAt + 1));
        return;
      default:
        bytes->insert(at, bytes->substr(at, below(9)));
    }
  }

  std::mt19937_64 random_;
};

/// Returns whether the world accepted it and could be stepped. Throws std::logic_error unless a
/// refusal has a reason and changes nothing.
inline bool restores(World& world, const std::string& bytes, int steps) {
  const std::uint64_t before = world.stateHash();
  const auto refused = [&](const std::string& why) {
    if (why.empty()) throw std::logic_error("it was refused without a reason");
    if (world.stateHash() != before)
      throw std::logic_error("it was refused, and changed the world");
    return false;
  };
  try {
    world.restore(bytes);
  } catch (const CheckpointError& error) {
    return refused(error.what());
  } catch (const DescriptionError& error) {
    return refused(error.what());
  }
  std::vector<float> ranges;
  for (int i = 0; i < steps; ++i) world.step();
  for (int i = 0; i < world.fleet().size(); ++i) world.scan(i, &ranges);
  world.checkpoint();
  return true;
}

}  // namespace kiva::test
