// SPDX-License-Identifier: Apache-2.0
//
// A small binary archive. The fields of a struct are listed once, by a function
//
//   template <class Archive>
//   void describe(Archive& a, MotionSegment& segment) {
//     FIELDS(segment.kind, segment.x, within(segment.yaw, -1e9, 1e9));
//   }
// which writes, reads, compares or hashes them, depending on the archive, so that these can't
// diverge. Input is checked: an enum is at most `lastOf`, a number is finite, or within its limits.
// An error names the field.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// An error of truncated or impossible input. `field` is its address, such as `robots[3].mass`.
class ArchiveError : public std::runtime_error {
 public:
  explicit ArchiveError(const std::string& why, const std::string& field = "")
      : std::runtime_error(field.empty() ? why : field + ": " + why), why_(why), field_(field) {}

  /// Returns the same error, as a part of `outer`.
  ArchiveError in(const std::string& outer) const {
    const bool follows = !field_.empty() && field_.front() != '[';
    return ArchiveError(why_, outer + (follows ? "." : "") + field_);
  }

 private:
  std::string why_, field_;
};

/// Describes the fields of a struct to the archive `a`.
#define FIELDS(...) a.named(#__VA_ARGS__, __VA_ARGS__)

/// A number, or a list of numbers, with its limits.
template <typename T>
struct Within {
  T& value;
  double least, most;
};
template <typename T>
Within<T> within(T& value, double least, double most) {
  return {value, least, most};
}

constexpr double kFarthest = 1e17;  // largest number in a world without limits of its own
constexpr double kEndless = std::numeric_limits<double>::infinity();

[[noreturn]] void failTooShort();  ///< Throws that the bytes end too early.
/// Throws that the number is not from `least` to `most`.
[[noreturn]] void failOutside(double value, double least, double most);

/// Returns the name of text number `index` in a list such as `r.name, within(r.id, 1, 9)`: `id` for
/// 1.
std::string nameIn(const char* list, int index);

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

/// The source or the destination of bytes, in which the archives differ.
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
    if (size > left()) failTooShort();
    if (size > 0) std::memcpy(data, at, size);
    at += size;
  }
};

/// Compares bytes that would be written with present ones, which begin at `at`.
struct CompareBytes {
  static constexpr bool kReads = false;
  const char* at;
  const char* end;
  bool is_same = true;
  CompareBytes(const char* from, const char* to) : at(from), end(to) {}
  void raw(void* data, std::size_t size) {
    is_same = is_same && size <= static_cast<std::size_t>(end - at) &&
              (size == 0 || std::memcmp(at, data, size) == 0);
    if (is_same) at += size;
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

/// Returns the bits of a pose, x y z w qx qy qz of it: Pose's own comparison ignores the sign of 0.
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
    (transfer(fields), ...);
    return *this;
  }

  template <typename... Fields>
  Archive& named(const char* names, Fields&&... fields) {
    int index = 0;
    ((inField([&] { return nameIn(names, index); }, fields), ++index), ...);
    return *this;
  }

  /// Describes a pose that mostly equals another one, which was described before.
  void mostly(Pose& pose, const Pose& usual) {
    bool differs = !kReads && numbersOf(pose) != numbersOf(usual);
    transfer(differs);
    if (differs) return transfer(pose);
    if constexpr (kReads) pose = usual;
  }

 private:
  template <typename T>
  static constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

  template <typename Name, typename T>
  void inField(Name name, T& field) {
    if constexpr (kReads) {
      try {
        transfer(field);
      } catch (const ArchiveError& error) {
        throw error.in(name());
      }
    } else {
      transfer(field);
    }
  }

  template <typename T>
  static void check(T value, double least = -kFarthest, double most = kFarthest) {
    if constexpr (std::is_enum_v<T>) {
      const auto number = static_cast<std::int64_t>(value);
      if (number >= 0 && number <= static_cast<std::int64_t>(lastOf(value))) return;
      throw ArchiveError(std::to_string(number) + " is not one of its values");
    } else if constexpr (std::is_floating_point_v<T>) {
      if (!(value >= least && value <= most)) failOutside(value, least, most);
    }
  }

  static std::string indexed(std::size_t i) { return "[" + std::to_string(i) + "]"; }

  void transfer(bool& value) {
    auto byte = static_cast<std::uint8_t>(value);
    this->raw(&byte, 1);
    if constexpr (kReads) {
      if (byte > 1) throw ArchiveError(std::to_string(byte) + " is neither true nor false");
      value = byte != 0;
    }
  }

  template <typename T>
  void transfer(Within<T>& field) {
    transfer(field.value, field.least, field.most);
  }

  template <typename T>
  void transfer(T& value, double least, double most) {
    static_assert(std::is_arithmetic_v<T>);
    this->raw(&value, sizeof value);
    if constexpr (kReads) check(static_cast<double>(value), least, most);
  }

  template <typename T, typename Allocator>
  void transfer(std::vector<T, Allocator>& list, double least, double most) {
    plain(list);
    for (std::size_t i = 0; kReads && i < list.size(); ++i) {
      checkIn(static_cast<double>(list[i]), i, least, most);
    }
  }

  void transfer(std::vector<bool>& flags) {
    std::vector<std::uint8_t> bytes(flags.begin(), flags.end());
    transfer(bytes);
    if constexpr (kReads) flags.assign(bytes.begin(), bytes.end());
  }

  template <typename T>
  void transfer(T& value) {
    if constexpr (kIsPlain<T>) {
      this->raw(&value, sizeof value);
      if constexpr (kReads) check(value);
    } else {
      describe(*this, value);
    }
  }

  template <typename T, std::size_t N>
  void transfer(T (&values)[N]) {
    for (std::size_t i = 0; i < N; ++i) inField([i] { return indexed(i); }, values[i]);
  }

  template <typename T>
  void transfer(std::optional<T>& value) {
    bool has = value.has_value();
    transfer(has);
    if constexpr (kReads) value = has ? std::optional<T>(std::in_place) : std::nullopt;
    if (has) transfer(*value);
  }

  void transfer(std::string& text) {
    const std::size_t size = count(text.size());
    if constexpr (kReads) text.resize(size);
    this->raw(text.data(), size);
  }

  template <typename T, typename Allocator>
  void transfer(std::vector<T, Allocator>& list) {
    if constexpr (kIsPlain<T>) {
      plain(list);
      for (std::size_t i = 0; kReads && i < list.size(); ++i) checkIn(list[i], i);
    } else {
      each(list);
    }
  }

  template <typename T, typename... Limits>
  static void checkIn(T value, std::size_t i, Limits... limits) {
    try {
      check(value, limits...);
    } catch (const ArchiveError& error) {
      throw error.in(indexed(i));
    }
  }

  template <typename List>
  void plain(List& list) {
    constexpr std::size_t kEach = sizeof(typename List::value_type);
    const std::size_t size = count(list.size() * kEach);
    if (size % kEach != 0) throw ArchiveError("a list of it has an impossible size");
    if constexpr (kReads) list.resize(size / kEach);
    this->raw(list.data(), size);
  }

  template <typename T>
  void transfer(std::deque<T>& list) {
    each(list);
  }

  template <typename List>
  void each(List& list) {
    const std::size_t size = count(list.size());
    if constexpr (kReads) {
      list.clear();
      // Elements are read one by one: a wrong size must not allocate memory before the bytes run
      // out.
      for (std::size_t i = 0; i < size; ++i)
        inField([i] { return indexed(i); }, list.emplace_back());
    } else {
      for (auto& element : list) transfer(element);
    }
  }

  /// Returns the size of a list. Throws unless at least a byte is left for each element.
  std::size_t count(std::size_t size) {
    auto number = static_cast<std::uint32_t>(size);
    this->raw(&number, sizeof number);
    if constexpr (kReads) {
      if (number > this->left()) failTooShort();
    }
    return number;
  }
};

using Writer = Archive<WriteBytes>;
using Reader = Archive<ReadBytes>;
using Comparer = Archive<CompareBytes>;
using Hasher = Archive<HashBytes>;

template <class A>
void describe(A& a, Vector3& v) {
  FIELDS(v.X(), v.Y(), v.Z());
}

constexpr double kUnitError = 1e-3;  // tolerance of a quaternion's squared length

/// Describes the difference from the identity alone: most things are upright, and square to the
/// axes.
template <class A>
void describe(A& a, Pose& pose) {
  static const std::array<std::uint64_t, 7> identity = numbersOf(Pose::Zero);
  std::array<std::uint64_t, 7> numbers = numbersOf(pose);
  std::uint8_t is_present = 0;
  for (int i = 0; i < 7; ++i) is_present |= (numbers[i] != identity[i]) << i;
  a(is_present);
  for (int i = 0; i < 7; ++i) {
    if (A::kReads) numbers[i] = identity[i];
    if (is_present & (1 << i)) a(numbers[i]);
  }
  if constexpr (A::kReads) {
    double n[7];
    std::memcpy(n, numbers.data(), sizeof n);
    pose.Pos().Set(n[0], n[1], n[2]);
    pose.Rot().Set(n[3], n[4], n[5], n[6]);
    const double far = pose.Pos().Abs().Max(),
                 norm = pose.Rot().W() * pose.Rot().W() + pose.Rot().X() * pose.Rot().X() +
                        pose.Rot().Y() * pose.Rot().Y() + pose.Rot().Z() * pose.Rot().Z();
    if (!pose.IsFinite() || !(far <= kFarthest) || !(std::abs(norm - 1) < kUnitError)) {
      throw ArchiveError("expected a finite position and a unit quaternion");
    }
  }
}

}  // namespace kiva
