// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_records.hpp"

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// Visits all members of plain structs without their names, so that it includes members added later.
namespace grouser::test {

namespace detail {

struct Anything {
  template <class T> operator T() const; // NOLINT(google-explicit-constructor): stands for any initialiser
};

template <class T, std::size_t... kIndex> constexpr bool takes(std::index_sequence<kIndex...>) {
  return requires { T{(static_cast<void>(kIndex), Anything{})...}; };
}

inline constexpr std::size_t kMaxMembers = 28;

/// Members of an aggregate without arrays: its largest number of initialisers.
template <class T, std::size_t kMax = kMaxMembers> constexpr std::size_t memberCount() {
  if constexpr (takes<T>(std::make_index_sequence<kMax>{}))
    return kMax;
  else
    return memberCount<T, kMax - 1>();
}

// clang-format off
template <class T> auto membersOf(T& s) {
  constexpr std::size_t n = memberCount<std::remove_const_t<T>>();
  static_assert(n >= 1 && n <= kMaxMembers);
#define GROUSER_MEMBERS(count, ...) \
  else if constexpr (n == (count)) { auto& [__VA_ARGS__] = s; return std::tie(__VA_ARGS__); }
  if constexpr (n == 1) { auto& [a] = s; return std::tie(a); }
  GROUSER_MEMBERS(2, a, b)
  GROUSER_MEMBERS(3, a, b, c)
  GROUSER_MEMBERS(4, a, b, c, d)
  GROUSER_MEMBERS(5, a, b, c, d, e)
  GROUSER_MEMBERS(6, a, b, c, d, e, f)
  GROUSER_MEMBERS(7, a, b, c, d, e, f, g)
  GROUSER_MEMBERS(8, a, b, c, d, e, f, g, h)
  GROUSER_MEMBERS(9, a, b, c, d, e, f, g, h, i)
  GROUSER_MEMBERS(10, a, b, c, d, e, f, g, h, i, j)
  GROUSER_MEMBERS(11, a, b, c, d, e, f, g, h, i, j, k)
  GROUSER_MEMBERS(12, a, b, c, d, e, f, g, h, i, j, k, l)
  GROUSER_MEMBERS(13, a, b, c, d, e, f, g, h, i, j, k, l, m)
  GROUSER_MEMBERS(14, a, b, c, d, e, f, g, h, i, j, k, l, m, o)
  GROUSER_MEMBERS(15, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p)
  GROUSER_MEMBERS(16, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q)
  GROUSER_MEMBERS(17, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r)
  GROUSER_MEMBERS(18, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t)
  GROUSER_MEMBERS(19, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u)
  GROUSER_MEMBERS(20, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v)
  GROUSER_MEMBERS(21, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v, w)
  GROUSER_MEMBERS(22, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v, w, x)
  GROUSER_MEMBERS(23, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v, w, x, y)
  GROUSER_MEMBERS(24, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v, w, x, y, z)
  GROUSER_MEMBERS(25, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v, w, x, y, z, aa)
  GROUSER_MEMBERS(26, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v, w, x, y, z, aa, ab)
  GROUSER_MEMBERS(27, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v, w, x, y, z, aa, ab, ac)
  GROUSER_MEMBERS(28, a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, t, u, v, w, x, y, z, aa, ab, ac, ad)
#undef GROUSER_MEMBERS
}
// clang-format on

template <class T> struct IsVector : std::false_type {};
template <class T> struct IsVector<std::vector<T>> : std::true_type {};
template <class T> struct IsOptional : std::false_type {};
template <class T> struct IsOptional<std::optional<T>> : std::true_type {};

} // namespace detail

/// Calls f(path, number) for every number in `s`; `path` counts the members: "7.2[1].0". With `make`, empty optionals
/// are filled and vectors get three entries.
template <class T, class F> void forEachNumber(T& s, const F& f, bool make = false, const std::string& path = "") {
  using U = std::remove_const_t<T>;
  if constexpr (std::is_arithmetic_v<U>) {
    f(path, s);
  } else if constexpr (std::is_array_v<U>) {
    for (std::size_t i = 0; i < std::extent_v<U>; ++i)
      forEachNumber(s[i], f, make, path + "[" + std::to_string(i) + "]");
  } else if constexpr (std::is_same_v<U, terrain::Remainders>) { // has an array, whose entries count as initialisers
    forEachNumber(s.axis, f, make, path + ".0"), forEachNumber(s.position, f, make, path + ".1");
  } else if constexpr (detail::IsOptional<U>::value) {
    if constexpr (!std::is_const_v<T>)
      if (make) s.emplace();
    if (s) forEachNumber(*s, f, make, path);
  } else if constexpr (detail::IsVector<U>::value) {
    if constexpr (!std::is_const_v<T>)
      if (make) s.resize(3);
    for (std::size_t i = 0; i < s.size(); ++i) forEachNumber(s[i], f, make, path + "[" + std::to_string(i) + "]");
  } else {
    const auto members = detail::membersOf(s);
    [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
      (forEachNumber(std::get<kIndex>(members), f, make, path + "." + std::to_string(kIndex)), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<decltype(members)>>{});
  }
}

/// All numbers with their paths, as bits: equal lists mean equal records, and NaN equals NaN.
template <class T> std::vector<std::pair<std::string, std::uint64_t>> numbersOf(const T& s) {
  std::vector<std::pair<std::string, std::uint64_t>> numbers;
  forEachNumber(s, [&](const std::string& path, const auto& number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof number);
    numbers.emplace_back(path, bits);
  });
  return numbers;
}

} // namespace grouser::test
