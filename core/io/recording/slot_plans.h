#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/point_table.h"

namespace railcast {

/// How many firings a scan has.
struct ScanShape {
  std::uint32_t rows{};
  std::uint32_t columns{};
};

/// Every point has its own index as its slot. @param returns Must divide the width.
[[nodiscard]] SlotPlan OrganisedPlan(const PointTable& table, std::uint32_t returns);

/// An organised cloud of anybody's: its rows by rising mean elevation; one without a point stays
/// beside the row before it. @pre The table has x, y and z.
[[nodiscard]] SlotPlan SortedRowsPlan(const PointTable& table);

/// Each point goes where its ring, column and return_index (0 if the file has none) say.
/// @param shape Of the scan; nothing: as large as its largest ring and column.
/// @throws InputError "name: ring: rule (got value)" if one lies outside, if two points are of one
///   slot, or if a shape that nobody states has so many more slots than points (2^20) that the file
///   must be damaged.
[[nodiscard]] SlotPlan PlacedPlan(const PointTable& table,
                                  const std::string& name,
                                  const std::optional<ScanShape>& shape);

/// One row of all that are points.
[[nodiscard]] SlotPlan LoosePlan(const PointTable& table);

}  // namespace railcast
