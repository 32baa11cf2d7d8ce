// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace kiva {

/// Stands for a field of any type.
struct AnyField {
  template <typename T>
  operator T() const;
};

template <typename T, std::size_t... I>
std::true_type takes(std::index_sequence<I...>,
                     decltype(T{(static_cast<void>(I), AnyField())...}) *);
template <typename T>
std::false_type takes(...);

/// Returns how many initialisers an aggregate takes: one a base and a field, one an element of an
/// array. At most `Most` are looked for.
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
