#include "core/extras/ros/recording/cloud_message.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
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

std::size_t RowSizeOf(const ros::PointCloud2& cloud) {
  return std::size_t{cloud.width} * cloud.point_step;
}

/// Throws unless the data are rows of points of the sizes that the message states.
void CheckSizes(const ros::PointCloud2& cloud) {
  const std::uint64_t row_size = RowSizeOf(cloud);
  if (cloud.width > 0 && cloud.height > 0 && cloud.point_step == 0) {
    throw InputError("point_step: must be > 0 (got 0)");
  }
  if (cloud.height > 1 && RowStepOf(cloud) < row_size) {
    throw InputError("row_step: must be at least width x point_step, " + NumberText(row_size) +
                     Got(cloud.row_step));
  }
  const std::uint64_t size =
      cloud.height == 0 ? 0 : (cloud.height - 1U) * RowStepOf(cloud) + row_size;
  if (cloud.data.size() < size) {
    throw InputError("data: must have " + NumberText(size) + " bytes" + Got(cloud.data.size()));
  }
}

/// Takes out what may stand between rows, and tells what points are there. Zeros are padding.
/// @param message Its data are those of the cloud.
void PackRows(const ros::PointCloud2& message, std::size_t row_step, Cloud& cloud) {
  const std::size_t row_size = RowSizeOf(message);
  std::vector<std::uint8_t>& data = cloud.data;
  std::uint64_t num_beyond = 0;
  std::uint64_t num_bytes = 0;
  const auto count = [&](std::size_t begin, std::size_t end) {
    const std::size_t point_step = message.point_step == 0 ? end - begin : message.point_step;
    for (; begin < end; begin += point_step) {
      const auto stop = std::min(end, begin + point_step);
      const bool is_padding = std::all_of(data.data() + begin, data.data() + stop,
                                          [](std::uint8_t byte) { return byte == 0; });
      const bool is_point = message.point_step > 0 && stop - begin == point_step;
      if (!is_padding) (is_point ? num_beyond : num_bytes) += is_point ? 1 : stop - begin;
    }
  };
  for (std::size_t row = 0; row_size > 0 && row < message.height; ++row) {
    const std::size_t begin = row * row_step;
    const bool is_last = row + 1 == message.height;
    count(begin + row_size, is_last ? data.size() : begin + row_step);
    if (row * row_size != begin) std::copy_n(&data[begin], row_size, &data[row * row_size]);
  }
  if (row_size == 0 || message.height == 0) count(0, data.size());
  AddRemark({.kind = RemarkKind::kPointsBeyondData, .place = {}, .number = num_beyond},
            cloud.remarks);
  AddRemark({.kind = RemarkKind::kSurplusBytes, .place = {}, .number = num_bytes}, cloud.remarks);
  data.resize(row_size * message.height);
}

/// Throws if fields share bytes: an offset or a type is wrong. Colours have two names for theirs.
void CheckOverlaps(const Cloud& cloud) {
  std::vector<const CloudField*> by_place;
  for (const CloudField& field : cloud.fields) {
    if (field.name != "rgba") by_place.push_back(&field);
  }
  std::ranges::sort(by_place, {}, &CloudField::offset);
  for (std::size_t i = 1; i < by_place.size(); ++i) {
    const CloudField& before = *by_place[i - 1];
    if (before.offset + before.num_bytes() <= by_place[i]->offset) continue;
    throw InputError("fields: must not share bytes (got " + Quoted(before.name) + " and " +
                     Quoted(by_place[i]->name) + ")");
  }
}

/// Turns big-endian numbers into little-endian ones.
void SwapBytes(Cloud& cloud) {
  if (cloud.num_points() == 0) return;  // The size of a point is not limited by the data.
  for (const CloudField& field : cloud.fields) {
    if (field.name == "rgba" && cloud.Find("rgb") != nullptr) continue;
    const std::size_t size = SizeOf(field.type);
    for (std::size_t point = 0; point < cloud.num_points(); ++point) {
      std::uint8_t* const begin = cloud.data.data() + point * cloud.point_step + field.offset;
      for (auto* at = begin; at < begin + field.num_bytes(); at += size) {
        std::reverse(at, at + size);
      }
    }
  }
}

/// Whether numbers are coordinates, m: those of the other byte order have any exponent.
class CoordinateCheck {
 public:
  template <typename Number>
  void Add(Number value) {
    const double size_m = std::abs(static_cast<double>(value));
    ++num_;
    num_fitting_ += std::isnan(size_m) || size_m == 0.0 || (size_m > 1e-9 && size_m < 1e4) ? 1 : 0;
  }
  [[nodiscard]] bool Fits() const { return 100 * num_fitting_ >= 99 * num_; }

 private:
  std::size_t num_{};
  std::size_t num_fitting_{};
};

/// Whether the coordinates are such in the other byte order only.
bool HasOtherByteOrder(const Cloud& cloud, bool is_bigendian) {
  CoordinateCheck little;
  CoordinateCheck big;
  for (const char* axis : {"x", "y", "z"}) {
    const CloudField* const field = cloud.Find(axis);
    if (field == nullptr) return false;
    VisitField(cloud, *field, [&](std::size_t, auto value) {
      if constexpr (std::is_floating_point_v<decltype(value)>) {
        little.Add(value);
        auto bytes = std::bit_cast<std::array<std::byte, sizeof value>>(value);
        std::ranges::reverse(bytes);
        big.Add(std::bit_cast<decltype(value)>(bytes));
      }
    });
  }
  return is_bigendian ? !big.Fits() && little.Fits() : !little.Fits() && big.Fits();
}

}  // namespace

std::size_t RowStepOf(const ros::PointCloud2& message) {
  const std::size_t row_size = RowSizeOf(message);
  const std::size_t size = message.data.size();
  const bool is_packed = row_size > 0 && size % row_size == 0 && size / row_size == message.height;
  return is_packed ? row_size : message.row_step;
}

Cloud MakeCloud(ros::PointCloud2 message) {
  CheckSizes(message);
  const std::size_t row_step = RowStepOf(message);
  Cloud cloud{.height = message.height,
              .width = message.width,
              .fields = {},
              .point_step = message.point_step,
              .is_dense = message.is_dense,
              .data = std::move(message.data)};
  for (const ros::PointField& field : message.fields) {
    cloud.fields.push_back(FieldOf(field, cloud.point_step));
  }
  CheckOverlaps(cloud);
  PackRows(message, row_step, cloud);
  if (cloud.num_points() == 0 && cloud.Find("x") == nullptr) {
    // Not all drivers fill in what points have if a message has no points.
    for (const char* axis : {"x", "y", "z"}) cloud.AddField(axis, NumberType::kFloat);
  }
  bool is_bigendian = message.is_bigendian;
  if (HasOtherByteOrder(cloud, is_bigendian)) {
    is_bigendian = !is_bigendian;
    AddRemark({.kind = RemarkKind::kByteOrderGuessed,
               .place = {},
               .detail = std::string("is_bigendian is ") + (is_bigendian ? "false" : "true")},
              cloud.remarks);
  }
  if (is_bigendian) SwapBytes(cloud);
  return cloud;
}

Cloud MakeCloud(const ros::LivoxCloud& message, std::int64_t& first_ns) {
  const std::size_t num = message.point_num;
  if (num > message.points.size()) {
    throw InputError("point_num: must be at most the number of points, " +
                     NumberText(message.points.size()) + Got(num));
  }
  Cloud cloud{.height = 1,
              .width = message.point_num,
              .fields = {},
              .point_step = 0,
              .is_dense = false,
              .data = {}};
  for (const char* axis : {"x", "y", "z"}) cloud.AddField(axis, NumberType::kFloat);
  cloud.AddField("time_ns", NumberType::kUint32);
  for (const char* name : {"reflectivity", "tag", "line"}) cloud.AddField(name, NumberType::kUint8);
  cloud.data.resize(num * cloud.point_step);
  const std::span points = std::span(message.points).first(num);
  const auto first = std::ranges::min_element(points, {}, &ros::LivoxPoint::offset_time);
  const std::uint32_t first_offset_ns = num == 0 ? 0 : first->offset_time;
  first_ns = first_offset_ns;
  std::uint8_t* place = cloud.data.data();
  const auto put = [&](const auto& value) {
    std::memcpy(place, &value, sizeof value);
    place += sizeof value;
  };
  for (const ros::LivoxPoint& point : points) {
    for (const float position_m : {point.x, point.y, point.z}) put(position_m);
    put(point.offset_time - first_offset_ns);
    for (const std::uint8_t value : {point.reflectivity, point.tag, point.line}) put(value);
  }
  AddRemark(
      {.kind = RemarkKind::kPointsBeyondData, .place = {}, .number = message.points.size() - num},
      cloud.remarks);
  return cloud;
}

}  // namespace railcast
