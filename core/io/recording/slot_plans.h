#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/io/cloud/cloud.h"
#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/ring_table.h"

namespace railcast {

/// Numbers of rows and columns of a scan's firings.
struct ScanShape {
  std::uint32_t rows{};
  std::uint32_t columns{};
};

/// The most slots that a grid may have beyond the number of points that arrived. The shape is only
/// what the file or the sender states, and memory must be bounded by what arrived.
inline constexpr std::size_t kMaxSpareSlots = std::size_t{1} << 20U;

/// Returns where the points are.
/// @pre The cloud has x, y and z.
[[nodiscard]] PointPositions LoadPositions(const Cloud& cloud);

/// Plans a cloud in which every point's index is its slot.
/// @param returns Must divide the width.
[[nodiscard]] SlotPlan OrganisedPlan(const Cloud& cloud, std::uint32_t returns);

/// Plans an organised cloud from any software: its rows are sorted by rising mean elevation, and a
/// row without a point stays beside the row before it. Where each of its columns has the points of
/// one ring, as in clouds of ROS drivers for Velodyne, the columns are taken for the rows.
/// Elevations are those about the axis of the sensor, if rows are level about that and not about z.
/// @param ring Null if the cloud does not say it.
/// @pre The cloud has x, y and z.
[[nodiscard]] SlotPlan SortedRowsPlan(const Cloud& cloud, const CloudField* ring);

/// Puts each point into the slot that its ring, column and return_index (0 if the file has none)
/// state.
/// @param shape Shape of the scan; if absent, the largest ring and column give it.
/// @throws InputError "name: ring: rule (got value)" if an index lies outside the shape, if two
///   points claim the same slot, or if a shape that is not given has so many more slots than points
///   (2^20) that the file must be damaged.
[[nodiscard]] SlotPlan PlacedPlan(const Cloud& cloud,
                                  const std::string& name,
                                  const std::optional<ScanShape>& shape);

/// Plans one row of all entries that are points.
/// @param why_no_grid As in RecordedFrame.
[[nodiscard]] SlotPlan LoosePlan(const Cloud& cloud, const std::string& why_no_grid);

}  // namespace railcast
