#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/number_type.h"
#include "railcast/remark.h"

namespace pcl {
struct PCLPointCloud2;
}

namespace railcast {

/// The type of a C++ number.
template <typename Number>
[[nodiscard]] constexpr NumberType NumberTypeOf() {
  if (std::is_floating_point_v<Number>) {
    return sizeof(Number) == sizeof(float) ? NumberType::kFloat : NumberType::kDouble;
  }
  constexpr std::array<NumberType, 4> kSigned = {NumberType::kInt8, NumberType::kInt16,
                                                 NumberType::kInt32, NumberType::kInt64};
  const auto is_signed = kSigned[std::bit_width(sizeof(Number)) - 1];
  return std::is_signed_v<Number> ? is_signed : NumberType(static_cast<int>(is_signed) + 1);
}

/// Positions farther from 0 are stored from an origin near them, or in double precision.
inline constexpr double kFarPosition_m = 10e3;

/// Whether a number can be a coordinate in metres, seen from the sensor: finite, below
/// kFarPosition_m, and not so small that it is no length but other data.
[[nodiscard]] inline bool IsLikelyPosition(double value_m) {
  constexpr double kLeast_m = 1e-20;
  const double size_m = std::abs(value_m);
  return value_m == 0.0 || (size_m >= kLeast_m && size_m < kFarPosition_m);
}

/// The name of fields without a meaning, as in PCD.
inline constexpr std::string_view kPaddingField = "_";

/// What every point has: a number, or several of one type.
struct CloudField {
  std::string name;
  std::uint32_t offset{};  ///< In a point, bytes.
  NumberType type{};
  std::uint32_t count = 1;  ///< Numbers of a point.
  /// Whether text had numbers beyond kFarPosition_m with digits that the type cannot hold.
  bool is_rounded{};

  /// Returns the name without CloudCompare's prefix `scalar_`.
  [[nodiscard]] std::string_view plain_name() const;
  [[nodiscard]] std::size_t num_bytes() const { return std::size_t{SizeOf(type)} * count; }
};

/// The bytes of a point.
[[nodiscard]] inline std::string_view RowOf(const std::vector<std::uint8_t>& data,
                                            std::size_t point_step,
                                            std::size_t point) {
  return {reinterpret_cast<const char*>(data.data()) + point * point_step, point_step};
}

/// Points with named fields, stored point after point as files and messages have them, without
/// conversion: of the shape of pcl::PCLPointCloud2, so that only what speaks to PCL needs its
/// headers.
struct Cloud {
  std::uint32_t height{};
  std::uint32_t width{};
  std::vector<CloudField> fields;
  std::uint32_t point_step{};      ///< Bytes of a point.
  bool is_dense{};                 ///< Whether all coordinates are known to be finite.
  std::vector<std::uint8_t> data;  ///< Rows without gaps between them.
  std::vector<Remark> remarks{};   ///< Remarks of its reader.

  [[nodiscard]] std::size_t num_points() const { return std::size_t{width} * height; }
  [[nodiscard]] std::string_view Row(std::size_t point) const {
    return RowOf(data, point_step, point);
  }
  /// Returns the first field of this plain name, or null if there is none.
  [[nodiscard]] const CloudField* Find(std::string_view name) const;
  /// Adds a field behind the others.
  void AddField(std::string name, NumberType type, std::uint32_t count = 1);
  /// Appends the numbers that the words of a line give to the fields one after another. A field
  /// that is no position becomes padding, with a remark, if one of its words is no value of its
  /// type.
  /// @return Whether there are enough words.
  /// @throws InputError "place: name: no value of its type (got 256)" about a position.
  bool AppendWords(const std::string& place, const std::vector<std::string_view>& words);
  /// Makes fields double whose words were rounded (CloudField::is_rounded), so that the lines can
  /// be read again with all their digits.
  /// @return Whether there are any; then the cloud has no data any more.
  bool WidenRounded();
};

/// Calls `visit(point, value)` for the field's (first) number of every point, in its stored type.
template <typename Visitor>
void VisitField(const Cloud& cloud, const CloudField& field, Visitor&& visit) {
  const std::size_t num_points = cloud.num_points();
  if (num_points == 0) return;  // Then there are no data to point to.
  VisitNumberType(field.type, [&](auto zero) {
    const std::uint8_t* place = cloud.data.data() + field.offset;
    const std::size_t step = cloud.point_step;
    for (std::size_t i = 0; i < num_points; ++i, place += step) {
      auto value = zero;
      std::memcpy(&value, place, sizeof value);
      visit(i, value);
    }
  });
}

/// Appends a number as text.
template <typename Number>
void AppendWord(Number number, std::string& text) {
  if constexpr (std::is_floating_point_v<Number>) {
    // to_chars may print the sign of a NaN, but readers expect "nan".
    if (std::isnan(number)) {
      text += "nan";
      return;
    }
  }
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  text.append(digits.data(), end);
}

/// The bytes of each field of a point.
[[nodiscard]] std::vector<std::size_t> FieldSizes(const Cloud& cloud);

/// Copies values stored part by part, each for all rows, to rows, or back.
/// @param part_sizes Bytes of each part of a row.
/// @pre `to` has room for all rows.
void Transpose(const std::vector<std::size_t>& part_sizes,
               std::size_t num_rows,
               const void* from,
               bool is_to_rows,
               void* to);

/// Turns the byte order of all numbers of rows that a cloud's fields describe.
void SwapBytes(const Cloud& cloud, std::vector<std::uint8_t>& rows);

/// The cloud as PCL has it; the header stays empty.
[[nodiscard]] pcl::PCLPointCloud2 ToPcl(Cloud cloud);

}  // namespace railcast
