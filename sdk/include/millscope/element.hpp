// Elements and sizes by whatever integer an index or a count is, so that signed counts and the library's unsigned sizes meet in one place.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace millscope {

/// What may count or name an element: an integer, or an enumerator of a list of its own.
template <class T>
concept Ordinal = std::integral<T> || std::is_enum_v<T>;

/// A count as the standard library wants it; it must not be below zero.
constexpr std::size_t as_size(Ordinal auto count) {
  if constexpr (std::is_enum_v<decltype(count)>) {
    return as_size(static_cast<std::underlying_type_t<decltype(count)>>(count));
  } else {
    assert(!(count < 0));
    return static_cast<std::size_t>(count);
  }
}

/// Element `index` of a list.
template <class List>
constexpr decltype(auto) element(List& list, Ordinal auto index) {
  return list[as_size(index)];
}

}  // namespace millscope
