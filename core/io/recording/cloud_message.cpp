#include "core/io/recording/cloud_message.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>

#include "core/base/error.h"
#include "core/base/number_type.h"
#include "core/base/text.h"

namespace railcast {
namespace {

std::size_t SizeOfNumber(NumberType type) {
  return VisitNumberType(type, [](auto zero) { return sizeof zero; });
}

PointColumn ColumnOf(const ros::PointField& field, std::size_t point_step) {
  const std::string place = "fields: " + Quoted(field.name) + ": ";
  if (field.datatype < ros::PointField::kInt8 || field.datatype > ros::PointField::kFloat64) {
    throw InputError(place + "datatype: must be 1 to 8" + Got(int{field.datatype}));
  }
  const auto type = static_cast<NumberType>(field.datatype);
  // Some drivers count a single number as none.
  const std::uint64_t size = SizeOfNumber(type) * std::uint64_t{std::max(field.count, 1U)};
  if (field.offset + size > point_step) {
    throw InputError(place + "must end within point_step, " + NumberText(point_step) +
                     Got(field.offset + size));
  }
  return {.name = field.name, .type = type, .offset = field.offset, .step = point_step};
}

/// Throws unless the data are rows of points of the sizes that the message states.
void CheckSizes(const ros::PointCloud2& cloud) {
  const std::uint64_t row_size = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.width > 0 && cloud.height > 0 && cloud.point_step == 0) {
    throw InputError("point_step: must be > 0 (got 0)");
  }
  if (cloud.height > 1 && cloud.row_step < row_size) {
    throw InputError("row_step: must be at least width x point_step, " + NumberText(row_size) +
                     Got(cloud.row_step));
  }
  const std::uint64_t size =
      cloud.height == 0 ? 0 : (cloud.height - 1U) * std::uint64_t{cloud.row_step} + row_size;
  if (cloud.data.size() < size) {
    throw InputError("data: must have " + NumberText(size) + " bytes" + Got(cloud.data.size()));
  }
}

/// Returns the points without what may stand between rows.
std::string PackedPoints(const ros::PointCloud2& cloud) {
  const std::size_t row_size = std::size_t{cloud.width} * cloud.point_step;
  std::string bytes;
  bytes.reserve(row_size * cloud.height);
  for (std::size_t row = 0; row < cloud.height && row_size > 0; ++row) {
    bytes.append(reinterpret_cast<const char*>(cloud.data.data()) + row * cloud.row_step, row_size);
  }
  return bytes;
}

/// Turns big-endian numbers into little-endian ones.
void SwapBytes(const ros::PointCloud2& cloud, PointTable& table) {
  std::set<std::size_t> swapped;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const PointColumn& column = table.columns[i];
    const std::size_t size = SizeOfNumber(column.type);
    const std::size_t num_bytes = size * std::max(cloud.fields[i].count, 1U);
    for (std::size_t at = column.offset; at < column.offset + num_bytes; ++at) {
      if (!swapped.insert(at).second) {
        throw InputError("fields: must not share bytes of a big-endian cloud (got " +
                         Quoted(column.name) + ")");
      }
    }
    for (std::size_t point = 0; point < table.num_points(); ++point) {
      char* const begin = table.bytes.data() + point * column.step + column.offset;
      for (char* at = begin; at < begin + num_bytes; at += size) std::reverse(at, at + size);
    }
  }
}

}  // namespace

PointTable MakePointTable(const ros::PointCloud2& cloud) {
  CheckSizes(cloud);
  PointTable table;
  table.width = cloud.width;
  table.height = cloud.height;
  for (const ros::PointField& field : cloud.fields) {
    table.columns.push_back(ColumnOf(field, cloud.point_step));
  }
  table.bytes = PackedPoints(cloud);
  if (cloud.is_bigendian) SwapBytes(cloud, table);
  return table;
}

}  // namespace railcast
