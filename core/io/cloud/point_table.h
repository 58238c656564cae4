#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/number_type.h"

namespace railcast {

/// One number of every point: a field, or the first element of a field that has several.
struct PointColumn {
  std::string name;
  NumberType type{};
  std::size_t offset{};  ///< Offset of the first point's value.
  std::size_t step{};    ///< Distance in bytes from one point's value to the next.

  /// Returns the name without CloudCompare's prefix `scalar_`.
  [[nodiscard]] std::string_view plain_name() const;
};

/// The points of a cloud file as they are stored, without conversion.
struct PointTable {
  std::uint32_t width{};
  std::uint32_t height{};
  std::vector<PointColumn> columns;
  std::string bytes;  ///< The whole file, or its points alone; the columns' offsets fit either.

  [[nodiscard]] std::size_t num_points() const { return std::size_t{width} * height; }
  /// Returns the first column of this plain name, or null if there is none.
  [[nodiscard]] const PointColumn* Find(std::string_view name) const;
};

/// Reads a .pcd file held in `bytes`, of any encoding.
/// @param file Named in errors.
/// @throws InputError with one line if it is damaged.
[[nodiscard]] PointTable ParsePcdTable(const std::string& file, std::string bytes);
/// Reads a .ply file held in `bytes`, ASCII or binary little-endian.
/// @throws InputError with one line if it is damaged.
[[nodiscard]] PointTable ParsePlyTable(const std::string& file, const std::string& bytes);

/// Reads KITTI's velodyne/*.bin held in `bytes`: float32 x, y, z, remission of each point. With
/// `labels`, the bytes of SemanticKITTI's .label (one uint32 per point: label in the lower half,
/// instance in the upper), label and instance become columns as well.
/// @throws InputError with one line if the lengths do not fit.
[[nodiscard]] PointTable ParseKittiTable(const std::string& file,
                                         std::string bytes,
                                         const std::optional<std::string>& labels);

/// Returns the file of the labels of a .bin file, ../labels/NAME.label, if it is there.
[[nodiscard]] std::optional<std::filesystem::path> SecondFileOf(const std::filesystem::path& file);

/// Reads a cloud file. A .bin file takes its labels from ../labels if they are there.
/// @throws InputError with one line if the file is not a .pcd, .ply or .bin, cannot be read or is
///   damaged.
[[nodiscard]] PointTable ReadPointTable(const std::filesystem::path& file);

/// Calls `visit(point, value)` for every point, with the value in its stored type.
template <typename Visitor>
void VisitColumn(const PointTable& table, const PointColumn& column, Visitor&& visit) {
  VisitNumberType(column.type, [&](auto zero) {
    const char* place = table.bytes.data() + column.offset;
    const std::size_t num_points = table.num_points();
    for (std::size_t i = 0; i < num_points; ++i, place += column.step) {
      auto value = zero;
      std::memcpy(&value, place, sizeof value);
      visit(i, value);
    }
  });
}

}  // namespace railcast
