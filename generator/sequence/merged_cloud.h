#pragma once

#include <pcl/PCLPointCloud2.h>

#include <cstdint>
#include <string>

#include "railcast/transform.h"

namespace railcast {

/// Points of several clouds with the same fields, one after another, with the field `sensor_index`
/// (uint8) behind the others:
///
///   MergedCloud merged;
///   merged.Add(front, {.sensor_index = 0, .merged_from_cloud = vehicle_from_front});
///   merged.Add(roof, {.sensor_index = 1, .merged_from_cloud = vehicle_from_roof});
///   const std::string pcd = merged.Pcd(/*is_compressed=*/false);
class MergedCloud {
 public:
  /// How a cloud becomes part of the merged one.
  struct Part {
    std::uint8_t sensor_index{};
    /// From the cloud's axes to those of the merged cloud; may mirror.
    Transform merged_from_cloud = Transform::Identity();
    std::uint32_t later_ns{};  ///< Added to the field time_ns, if there is one.
  };

  /// Adds the points of a cloud; slots without a point (x is NaN) are left out.
  /// @pre The cloud has the fields x, y and z as float32, and those of the clouds before it.
  void Add(const pcl::PCLPointCloud2& cloud, const Part& part);

  [[nodiscard]] std::uint32_t num_points() const { return merged_.width; }

  /// Returns a PCD file, binary or LZF-compressed, with HEIGHT 1.
  [[nodiscard]] std::string Pcd(bool is_compressed) const;

 private:
  pcl::PCLPointCloud2 merged_;
};

}  // namespace railcast
