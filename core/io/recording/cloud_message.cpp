#include "core/io/recording/cloud_message.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/number_type.h"
#include "core/base/text.h"

namespace railcast {
namespace {

CloudField FieldOf(const ros::PointField& field, std::size_t point_step) {
  const std::string place = "fields: " + Quoted(field.name) + ": ";
  if (field.datatype < ros::PointField::kInt8 || field.datatype > ros::PointField::kFloat64) {
    throw InputError(place + "datatype: must be 1 to 8" + Got(int{field.datatype}));
  }
  // Some drivers count a single number as none.
  CloudField read{.name = field.name,
                  .offset = field.offset,
                  .type = static_cast<NumberType>(field.datatype),
                  .count = std::max(field.count, 1U)};
  if (field.offset + read.num_bytes() > point_step) {
    throw InputError(place + "must end within point_step, " + NumberText(point_step) +
                     Got(field.offset + read.num_bytes()));
  }
  return read;
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

/// Takes out what may stand between rows.
void PackRows(const ros::PointCloud2& message, std::vector<std::uint8_t>& data) {
  const std::size_t row_size = std::size_t{message.width} * message.point_step;
  if (row_size != message.row_step && row_size > 0) {
    for (std::size_t row = 1; row < message.height; ++row) {
      std::copy_n(data.data() + row * message.row_step, row_size, data.data() + row * row_size);
    }
  }
  data.resize(row_size * message.height);
}

/// Turns big-endian numbers into little-endian ones.
void SwapBytes(Cloud& cloud) {
  if (cloud.num_points() == 0) return;  // The size of a point is not limited by the data.
  std::set<std::size_t> swapped;
  for (const CloudField& field : cloud.fields) {
    const std::size_t size = SizeOf(field.type);
    for (std::size_t at = field.offset; at < field.offset + field.num_bytes(); ++at) {
      if (!swapped.insert(at).second) {
        throw InputError("fields: must not share bytes of a big-endian cloud (got " +
                         Quoted(field.name) + ")");
      }
    }
    for (std::size_t point = 0; point < cloud.num_points(); ++point) {
      std::uint8_t* const begin = cloud.data.data() + point * cloud.point_step + field.offset;
      for (auto* at = begin; at < begin + field.num_bytes(); at += size) {
        std::reverse(at, at + size);
      }
    }
  }
}

}  // namespace

Cloud MakeCloud(ros::PointCloud2 message) {
  CheckSizes(message);
  Cloud cloud{.height = message.height,
              .width = message.width,
              .fields = {},
              .point_step = message.point_step,
              .is_dense = message.is_dense,
              .data = std::move(message.data)};
  for (const ros::PointField& field : message.fields) {
    cloud.fields.push_back(FieldOf(field, cloud.point_step));
  }
  PackRows(message, cloud.data);
  if (message.is_bigendian) SwapBytes(cloud);
  return cloud;
}

}  // namespace railcast
