// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace kiva {

/// Converts to a field of any type.
struct AnyField {
  template <typename T>
  operator T() const;
};

template <typename T, std::size_t... I>
std::true_type takes(std::index_sequence<I...>,
                     decltype(T{(static_cast<void>(I), AnyField())...}) *);
template <typename T>
std::false_type takes(...);

/// Returns the number of an aggregate's initialisers: one for each base and field, one for each
/// element of an array; `Most` at most.
template <typename T, std::size_t Most = 48>
constexpr std::size_t fieldCount() {
  static_assert(std::is_aggregate_v<T>);
  if constexpr (decltype(takes<T>(std::make_index_sequence<Most>(), nullptr))::value) {
    return Most;
  } else {
    return fieldCount<T, Most - 1>();
  }
}

}  // namespace kiva
