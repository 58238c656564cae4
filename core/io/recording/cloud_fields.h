#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/io/cloud/cloud.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Where in a frame the points of a file go.
struct SlotPlan {
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::uint32_t returns{1};
  /// For each point its slot; if empty, each point's own index.
  std::vector<std::uint32_t> slots;
  bool is_grid{};
  std::string why_no_grid{};                          ///< As in RecordedFrame.
  std::optional<Eigen::Matrix3d> sensor_from_spin{};  ///< As in Frame.
};

/// Gives the frame the plan's shape and fills all the fields that the file has, under our names or
/// under those that other software uses for the same quantity (docs/recordings.md). Then computes
/// what follows from the positions: range_m and, in a grid, ring, column, return_index and
/// return_count. A slot has a point where x, y and z are finite and not all 0, since some drivers
/// write 0 for "no return". Positions far from 0 are taken from an origin near them
/// (TakeFromNearOrigin()). Numeric columns that hold no field of ours become foreign fields.
/// @throws InputError "name: field: rule (got value)" if a value does not fit its field, or if x, y
///   or z is missing.
void FillFrame(const Cloud& cloud, const SlotPlan& plan, RecordedFrame& recorded);

/// Fills ring, column, return_index and return_count by the slots.
/// @pre Slots without a point have NaN positions.
void FillGridIndices(Frame& frame);

/// Moves positions far from 0 to an origin near them. Where x, y or z is stored as float64 and
/// the median of the points lies more than 10 km from 0, as in a national grid, the positions are
/// taken from a whole kilometre near them, RecordedFrame::origin_m; as float32 they would otherwise
/// be rounded to 0.5 m at 5000 km. Leaves range_m unchanged. What is stored there as float32 is
/// told (RemarkKind::kPositionsRounded).
/// @pre The frame has the positions as stored; slots without a point have NaN.
void TakeFromNearOrigin(const Cloud& cloud, const SlotPlan& plan, RecordedFrame& recorded);

/// Tells which values of RecordedFrame::foreign single precision cannot hold: whole numbers and
/// those of float64 beyond 2^24, such as GPS times (RemarkKind::kValuesRounded).
void RemarkRoundedValues(const Cloud& cloud, const SlotPlan& plan, RecordedFrame& recorded);

/// Returns the column of the file that holds our field of this name, or null if none does. Its
/// letters may be capitals, as in X, Y, Z.
[[nodiscard]] const CloudField* FindFieldOf(const Cloud& cloud, std::string_view name);
/// As FindFieldOf(), but requires the column.
/// @throws InputError "name: has no field x" if the file does not have it.
[[nodiscard]] const CloudField& NeedFieldOf(const Cloud& cloud,
                                            std::string_view field,
                                            const std::string& name);

/// Returns the column as one whole number for each point.
/// @throws InputError if a value is not a whole number, is negative, or exceeds `limit`.
[[nodiscard]] std::vector<std::uint32_t> LoadIndices(const Cloud& cloud,
                                                     const CloudField& column,
                                                     std::uint32_t limit,
                                                     const std::string& name);

}  // namespace railcast
