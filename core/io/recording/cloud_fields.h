#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/io/recording/point_table.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// Where the points of a file go in a frame.
struct SlotPlan {
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::uint32_t returns{1};
  /// Of each point; empty: its own index.
  std::vector<std::uint32_t> slots;
  bool is_grid{};
};

/// Of a point that is left out.
inline constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

/// Gives the frame the plan's shape and all the fields that the file has, under our names or those
/// that others use for the same (docs/recordings.md). Then what follows from the positions:
/// range_m, and in a grid ring, column, return_index and return_count. A slot has a point where x,
/// y and z are finite, and not all 0, as some drivers write "none". Positions far from 0 are taken
/// from an origin near them (near_origin.h). Columns of numbers that hold no
/// field of ours become foreign ones.
/// @throws InputError "name: field: rule (got value)" if a value does not fit its field or x, y or
/// z
///   is missing.
void FillFrame(const PointTable& table, const SlotPlan& plan, RecordedFrame& recorded);

/// The field of the file that holds ours, if any.
[[nodiscard]] const PointColumn* FindFieldOf(const PointTable& table, std::string_view name);
/// @throws InputError "name: has no field x" if it has none.
[[nodiscard]] const PointColumn& NeedFieldOf(const PointTable& table,
                                             std::string_view field,
                                             const std::string& name);

/// A whole number for every point. @throws InputError if one is none, is negative, or > `limit`.
[[nodiscard]] std::vector<std::uint32_t> LoadIndices(const PointTable& table,
                                                     const PointColumn& column,
                                                     std::uint32_t limit,
                                                     const std::string& name);

/// The x, y or z of every point.
[[nodiscard]] std::vector<float> LoadFloats(const PointTable& table, const PointColumn& column);

}  // namespace railcast
