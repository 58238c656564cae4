#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <type_traits>

#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "analysis/stats/names.h"

namespace railcast {

// Frames are measured in parallel, each into sums of its own, which are put together in the frames'
// order. A struct lists its sums once, in a static member `Sums(of)` that ties those of `of`.

/// Adds sums to their counterparts: numbers, whether anything was so, what has an Add() of its own,
/// structs with Sums(), and arrays, lists (which grow) and maps of these.
template <typename Sum>
void AddTo(Sum& sum, const Sum& other) {
  if constexpr (std::same_as<Sum, bool>) {
    sum = sum || other;
  } else if constexpr (std::is_arithmetic_v<Sum>) {
    sum += other;
  } else if constexpr (requires { Sum::Sums(sum); }) {
    std::apply(
        [&](auto&... sums) {
          std::apply([&](const auto&... others) { (AddTo(sums, others), ...); }, Sum::Sums(other));
        },
        Sum::Sums(sum));
  } else if constexpr (requires { sum.Add(other); }) {
    sum.Add(other);
  } else if constexpr (requires { typename Sum::mapped_type; }) {
    for (const auto& [key, each] : other) AddTo(sum[key], each);
  } else {
    if constexpr (requires { sum.resize(0); }) sum.resize(std::max(sum.size(), other.size()));
    for (std::size_t i = 0; i < other.size(); ++i) AddTo(sum[i], other[i]);
  }
}

/// Plain and robust figures of the same samples.
struct Scatter {
  Moments plain;
  LogHistogram robust;

  void Add(double sample) {
    plain.Add(sample);
    robust.Add(sample);
  }
  static auto Sums(auto& of) { return std::tie(of.plain, of.robust); }
  [[nodiscard]] std::uint64_t num() const { return plain.num(); }
};

/// What samples are grouped by in tables: bins of range and incidence, or the number of a label,
/// material or ring.
enum class GroupBy : std::uint8_t { kRange, kIncidence, kLabel, kMaterial, kRing };

/// What a group is called: "20 to 30" of a bin, or a name.
[[nodiscard]] Cell GroupCell(GroupBy by, std::size_t group, const Names& names);

/// Sums of the same samples by several keys.
template <typename Sum>
class Grouped {
 public:
  /// Nothing is added to no group.
  template <typename Sample>
  void Add(GroupBy by, std::optional<std::size_t> group, const Sample& sample) {
    if (group) groups_[static_cast<std::size_t>(by)][*group].Add(sample);
  }
  static auto Sums(auto& of) { return std::tie(of.groups_); }
  void Forget(GroupBy by) { groups_[static_cast<std::size_t>(by)].clear(); }

  [[nodiscard]] const std::map<std::size_t, Sum>& Of(GroupBy by) const {
    return groups_[static_cast<std::size_t>(by)];
  }
  /// Visits the groups of a key in their order: visit(what it is called, sum).
  template <typename Visitor>
  void ForEach(GroupBy by, const Names& names, Visitor&& visit) const {
    for (const auto& [group, sum] : Of(by)) visit(GroupCell(by, group, names), sum);
  }

 private:
  std::array<std::map<std::size_t, Sum>, 5> groups_;
};

}  // namespace railcast
