#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>

namespace railcast {

/// References to all members of a struct of `kNum` members, in their order. Another number of
/// members does not compile.
template <std::size_t kNum, typename Struct>
[[nodiscard]] constexpr auto MembersOf(Struct& self) {
  static_assert(kNum >= 1 && kNum <= 14, "a struct of more members needs a branch of its own");
  if constexpr (kNum == 1) {
    auto& [a] = self;
    return std::tie(a);
  } else if constexpr (kNum == 2) {
    auto& [a, b] = self;
    return std::tie(a, b);
  } else if constexpr (kNum == 3) {
    auto& [a, b, c] = self;
    return std::tie(a, b, c);
  } else if constexpr (kNum == 4) {
    auto& [a, b, c, d] = self;
    return std::tie(a, b, c, d);
  } else if constexpr (kNum == 5) {
    auto& [a, b, c, d, e] = self;
    return std::tie(a, b, c, d, e);
  } else if constexpr (kNum == 6) {
    auto& [a, b, c, d, e, f] = self;
    return std::tie(a, b, c, d, e, f);
  } else if constexpr (kNum == 7) {
    auto& [a, b, c, d, e, f, g] = self;
    return std::tie(a, b, c, d, e, f, g);
  } else if constexpr (kNum == 8) {
    auto& [a, b, c, d, e, f, g, h] = self;
    return std::tie(a, b, c, d, e, f, g, h);
  } else if constexpr (kNum == 9) {
    auto& [a, b, c, d, e, f, g, h, i] = self;
    return std::tie(a, b, c, d, e, f, g, h, i);
  } else if constexpr (kNum == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = self;
    return std::tie(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (kNum == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = self;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (kNum == 12) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l] = self;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k, l);
  } else if constexpr (kNum == 13) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = self;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m);
  } else {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = self;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
  }
}

/// Calls `visit(name, member)` for each member of a struct, in their order. `kFields` of the struct
/// is an array of their names.
template <typename Struct, typename Visit>
void VisitFields(Struct& self, Visit&& visit) {
  constexpr auto& kNames = std::remove_const_t<Struct>::kFields;
  std::apply(
      [&visit](auto&... members) {
        std::size_t place = 0;
        (visit(kNames[place++], members), ...);
      },
      MembersOf<kNames.size()>(self));
}

}  // namespace railcast
