// SPDX-License-Identifier: Apache-2.0
//
// A small binary archive. What a struct holds is listed once, by a function
//
//   template <class Archive> void describe(Archive& a, MotionSegment& segment) { a(segment.kind,
//   segment.x, segment.y); }
//
// which writes, reads or hashes it, depending on the archive, so that the three can't diverge.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Bytes that end too early, or are none of ours.
class ArchiveError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Mixes one word into a hash (the finaliser of MurmurHash3, Appleby 2011).
inline std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0xff51afd7ed558ccdULL;
  return hash ^ (hash >> 32);
}

inline std::uint64_t hashBytes(std::uint64_t hash, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  for (; size >= 8; at += 8, size -= 8) {
    std::uint64_t word;
    std::memcpy(&word, at, 8);
    hash = mix(hash, word);
  }
  std::uint64_t rest = 0;
  if (size > 0) std::memcpy(&rest, at, size);
  return mix(hash, rest ^ (static_cast<std::uint64_t>(size) << 56));
}

/// Where the bytes go to or come from: what the three archives differ in.
struct WriteBytes {
  static constexpr bool kReads = false;
  std::string bytes;
  void raw(void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
};

struct ReadBytes {
  static constexpr bool kReads = true;
  const char* at;
  const char* end;
  explicit ReadBytes(const std::string& bytes)
      : at(bytes.data()), end(bytes.data() + bytes.size()) {}
  std::size_t left() const { return static_cast<std::size_t>(end - at); }
  void raw(void* data, std::size_t size) {
    if (size > left()) throw ArchiveError("it ends too early");
    if (size > 0) std::memcpy(data, at, size);
    at += size;
  }
};

struct HashBytes {
  static constexpr bool kReads = false;
  std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
  void raw(void* data, std::size_t size) {
    if (size != 8) {
      hash = hashBytes(hash, data, size);
      return;
    }
    std::uint64_t word;
    std::memcpy(&word, data, 8);
    hash = mix(hash, word);
  }
};

/// x y z w qx qy qz of a pose, bit by bit: Pose's own comparison has a tolerance, and -0 == 0.
inline std::array<std::uint64_t, 7> numbersOf(const Pose& pose) {
  const Vector3& p = pose.Pos();
  const Quaternion& q = pose.Rot();
  const double numbers[7] = {p.X(), p.Y(), p.Z(), q.W(), q.X(), q.Y(), q.Z()};
  std::array<std::uint64_t, 7> out;
  std::memcpy(out.data(), numbers, sizeof numbers);
  return out;
}

template <class Bytes>
class Archive : public Bytes {
 public:
  using Bytes::Bytes;
  using Bytes::kReads;

  template <typename... Fields>
  Archive& operator()(Fields&... fields) {
    (one(fields), ...);
    return *this;
  }

  /// A pose that is mostly equal to another one, which was described before it.
  void mostly(Pose& pose, const Pose& usual) {
    bool differs = !kReads && numbersOf(pose) != numbersOf(usual);
    one(differs);
    if (differs) return one(pose);
    if constexpr (kReads) pose = usual;
  }

 private:
  template <typename T>
  static constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

  void one(bool& value) {
    auto byte = static_cast<std::uint8_t>(value);
    this->raw(&byte, 1);
    if constexpr (kReads) value = byte != 0;
  }

  void one(std::vector<bool>& flags) {
    std::vector<std::uint8_t> bytes(flags.begin(), flags.end());
    one(bytes);
    if constexpr (kReads) flags.assign(bytes.begin(), bytes.end());
  }

  template <typename T>
  void one(T& value) {
    if constexpr (kIsPlain<T>) {
      this->raw(&value, sizeof value);
    } else {
      describe(*this, value);
    }
  }

  template <typename T, std::size_t N>
  void one(T (&values)[N]) {
    for (T& value : values) one(value);
  }

  template <typename T>
  void one(std::optional<T>& value) {
    bool has = value.has_value();
    one(has);
    if constexpr (kReads) value = has ? std::optional<T>(std::in_place) : std::nullopt;
    if (has) one(*value);
  }

  void one(std::string& text) {
    const std::size_t size = count(text.size());
    if constexpr (kReads) text.resize(size);
    this->raw(text.data(), size);
  }

  template <typename T, typename Allocator>
  void one(std::vector<T, Allocator>& list) {
    if constexpr (kIsPlain<T>) {
      const std::size_t size = count(list.size() * sizeof(T));
      if (size % sizeof(T) != 0) throw ArchiveError("a list of it has an impossible size");
      if constexpr (kReads) list.resize(size / sizeof(T));
      this->raw(list.data(), size);
    } else {
      each(list);
    }
  }

  template <typename T>
  void one(std::deque<T>& list) {
    each(list);
  }

  template <typename List>
  void each(List& list) {
    const std::size_t size = count(list.size());
    if constexpr (kReads) {
      list.clear();
      // One by one: a wrong size must not take the memory before the bytes run out.
      for (std::size_t i = 0; i < size; ++i) one(list.emplace_back());
    } else {
      for (auto& element : list) one(element);
    }
  }

  /// The size of what follows; at least a byte for each is left, or the size is wrong.
  std::size_t count(std::size_t size) {
    auto number = static_cast<std::uint32_t>(size);
    this->raw(&number, sizeof number);
    if constexpr (kReads) {
      if (number > this->left()) throw ArchiveError("it ends too early");
    }
    return number;
  }
};

using Writer = Archive<WriteBytes>;
using Reader = Archive<ReadBytes>;
using Hasher = Archive<HashBytes>;

template <class A>
void describe(A& a, Vector3& v) {
  a(v.X(), v.Y(), v.Z());
}

/// Only what differs from the identity: most things stand upright, and squarely.
template <class A>
void describe(A& a, Pose& pose) {
  static const std::array<std::uint64_t, 7> identity = numbersOf(Pose::Zero);
  std::array<std::uint64_t, 7> numbers = numbersOf(pose);
  std::uint8_t given = 0;
  for (int i = 0; i < 7; ++i) given |= (numbers[i] != identity[i]) << i;
  a(given);
  for (int i = 0; i < 7; ++i) {
    if (A::kReads) numbers[i] = identity[i];
    if (given & (1 << i)) a(numbers[i]);
  }
  if constexpr (A::kReads) {
    double n[7];
    std::memcpy(n, numbers.data(), sizeof n);
    pose.Pos().Set(n[0], n[1], n[2]);
    pose.Rot().Set(n[3], n[4], n[5], n[6]);
  }
}

}  // namespace kiva
