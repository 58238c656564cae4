#pragma once

#include <pcl/for_each_type.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>
#include <pcl/type_traits.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "railcast/error.h"
#include "railcast/frame.h"

// PCL point types for the points of frames, so that programs with PCL can take railcast's PCD
// files, frames and streams as clouds of them. The members have the names, units and types of the
// fields of Frame (railcast/frame.h).
//
// PCL's libraries contain its algorithms for PCL's own point types only. To use them with the types
// below, define PCL_NO_PRECOMPILE before including any header of PCL, or copy the points to one of
// PCL's types with pcl::copyPointCloud().

namespace railcast {

/// The fields that a stream has unless others are asked for.
struct EIGEN_ALIGN16 LabelledPoint {
  PCL_ADD_POINT4D;
  LabelledPoint() : data{0.0F, 0.0F, 0.0F, 1.0F} {}

  float intensity = std::numeric_limits<float>::quiet_NaN();
  std::uint32_t time_ns = 0;
  std::uint32_t label = 0;
  std::uint32_t instance = 0;
  std::uint16_t ring = 0;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

/// Every field that frames of all sensors have, as PCD files hold them unless asked for others.
struct EIGEN_ALIGN16 FramePoint {
  PCL_ADD_POINT4D;
  FramePoint() : data{0.0F, 0.0F, 0.0F, 1.0F} {}

  float intensity = std::numeric_limits<float>::quiet_NaN();
  float power_ratio = std::numeric_limits<float>::quiet_NaN();
  float range_m = std::numeric_limits<float>::quiet_NaN();
  std::uint32_t time_ns = 0;
  std::uint16_t ring = 0;
  std::uint8_t return_index = 0;
  std::uint8_t return_count = 0;
  std::uint32_t column = 0;
  std::uint32_t label = 0;
  std::uint32_t instance = 0;
  float true_range_m = std::numeric_limits<float>::quiet_NaN();
  float incidence_rad = std::numeric_limits<float>::quiet_NaN();
  std::uint16_t material = 0;
  std::uint8_t outcome = 0;  ///< An Outcome (railcast/outcome.h).
  float footprint_share = std::numeric_limits<float>::quiet_NaN();
  float mixed_share = std::numeric_limits<float>::quiet_NaN();
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace railcast

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT(
    railcast::LabelledPoint,
    (float, x, x)(float, y, y)(float, z, z)(float, intensity, intensity)
    (std::uint32_t, time_ns, time_ns)(std::uint32_t, label, label)
    (std::uint32_t, instance, instance)(std::uint16_t, ring, ring))
POINT_CLOUD_REGISTER_POINT_STRUCT(
    railcast::FramePoint,
    (float, x, x)(float, y, y)(float, z, z)(float, intensity, intensity)
    (float, power_ratio, power_ratio)(float, range_m, range_m)(std::uint32_t, time_ns, time_ns)
    (std::uint16_t, ring, ring)(std::uint32_t, column, column)
    (std::uint8_t, return_index, return_index)(std::uint8_t, return_count, return_count)
    (std::uint32_t, label, label)(std::uint32_t, instance, instance)
    (std::uint8_t, outcome, outcome)(float, true_range_m, true_range_m)
    (float, incidence_rad, incidence_rad)(std::uint16_t, material, material)
    (float, footprint_share, footprint_share)(float, mixed_share, mixed_share))
// clang-format on

namespace railcast {

/// Copies the fields of a point type from a frame into a cloud, one field for each call.
template <typename Point>
class PointFieldCopy {
 public:
  PointFieldCopy(const Frame& frame, pcl::PointCloud<Point>& cloud)
      : frame_(frame), cloud_(cloud) {}

  /// Called by pcl::for_each_type() for each field.
  template <typename Tag>
  void operator()() {
    const std::string_view name = pcl::traits::name<Point, Tag>::value;
    bool is_found = false;
    ForEachField(frame_, [&](std::string_view field, std::string_view /*unit*/,
                             const auto& values) {
      if (field != name) return;
      using Value = typename std::decay_t<decltype(values)>::value_type;
      using Member = typename pcl::traits::datatype<Point, Tag>::type;
      is_found = sizeof(Value) == sizeof(Member) &&
                 std::is_floating_point_v<Value> == std::is_floating_point_v<Member>;
      for (std::size_t slot = 0; is_found && slot < values.size(); ++slot) {
        auto* const point = reinterpret_cast<std::uint8_t*>(&cloud_.points[slot]);
        std::memcpy(point + pcl::traits::offset<Point, Tag>::value, &values[slot], sizeof(Value));
      }
    });
    if (!is_found) {
      throw InputError("a cloud of points: frames must have its field " + std::string(name) +
                       " with that type");
    }
  }

 private:
  const Frame& frame_;
  pcl::PointCloud<Point>& cloud_;
};

/// The frame as an organised cloud of any point type all of whose fields frames have: the two
/// above, pcl::PointXYZ, PointXYZI, PointXYZL. Slots without a point have NaN coordinates. The
/// header has the stamp in microseconds and the frame's number.
/// @throws InputError if the point type has a field that frames lack or have in another type.
template <typename Point>
[[nodiscard]] pcl::PointCloud<Point> ToPointCloud(const Frame& frame) {
  pcl::PointCloud<Point> cloud(frame.width(), frame.rows);
  pcl::for_each_type<typename pcl::traits::fieldList<Point>::type>(
      PointFieldCopy<Point>(frame, cloud));
  cloud.is_dense = false;
  cloud.header.seq = frame.index;
  cloud.header.stamp = static_cast<std::uint64_t>(frame.stamp_ns / 1000);
  return cloud;
}

}  // namespace railcast
