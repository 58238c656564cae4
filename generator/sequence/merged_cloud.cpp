#include "generator/sequence/merged_cloud.h"

#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/io/field_layout.h"
#include "core/io/merged_files.h"

namespace railcast {
namespace {

std::size_t OffsetOf(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  const int field = pcl::getFieldIndex(cloud, name);
  Check(field >= 0 &&
            cloud.fields[static_cast<std::size_t>(field)].datatype == pcl::PCLPointField::FLOAT32,
        "a cloud that is merged has coordinates");
  return cloud.fields[static_cast<std::size_t>(field)].offset;
}

template <typename T>
T ValueAt(const std::uint8_t* place) {
  T value{};
  std::memcpy(&value, place, sizeof value);
  return value;
}

}  // namespace

void MergedCloud::Add(const pcl::PCLPointCloud2& cloud, const Part& part) {
  const std::size_t step = cloud.point_step;
  if (merged_.fields.empty()) {
    merged_.fields = cloud.fields;
    pcl::PCLPointField index;
    index.name = kSensorIndexField;
    index.offset = cloud.point_step;
    index.datatype = pcl::PCLPointField::UINT8;
    index.count = 1;
    merged_.fields.push_back(index);
    merged_.point_step = cloud.point_step + 1;
    merged_.height = 1;
  }
  Check(merged_.point_step == step + 1, "clouds that are merged have the same fields");
  const std::size_t x = OffsetOf(cloud, "x");
  const std::size_t y = OffsetOf(cloud, "y");
  const std::size_t z = OffsetOf(cloud, "z");
  const int time = pcl::getFieldIndex(cloud, "time_ns");
  const std::size_t num_slots = std::size_t{cloud.width} * cloud.height;
  merged_.data.reserve(merged_.data.size() + num_slots * (step + 1));
  for (std::size_t slot = 0; slot < num_slots; ++slot) {
    const std::uint8_t* const from = cloud.data.data() + slot * step;
    if (std::isnan(ValueAt<float>(from + x))) continue;
    const std::size_t begin = merged_.data.size();
    merged_.data.insert(merged_.data.end(), from, from + step);
    merged_.data.push_back(part.sensor_index);
    char* const to = reinterpret_cast<char*>(merged_.data.data() + begin);
    const Vector3 point =
        part.merged_from_cloud *
        Vector3(ValueAt<float>(from + x), ValueAt<float>(from + y), ValueAt<float>(from + z));
    StoreAt<float>(to + x, point.x());
    StoreAt<float>(to + y, point.y());
    StoreAt<float>(to + z, point.z());
    if (time >= 0) {
      const std::size_t offset = cloud.fields[static_cast<std::size_t>(time)].offset;
      StoreAt<std::uint32_t>(to + offset, ValueAt<std::uint32_t>(from + offset) + part.later_ns);
    }
  }
  merged_.width = static_cast<std::uint32_t>(merged_.data.size() / merged_.point_step);
  merged_.row_step = static_cast<std::uint32_t>(merged_.data.size());
}

std::string MergedCloud::Pcd(bool is_compressed) const {
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  pcl::PCDWriter writer;
  // PCL compresses no empty cloud.
  if (!is_compressed || num_points() == 0) {
    std::string bytes = writer.generateHeaderBinary(merged_, origin, orientation) + "DATA binary\n";
    bytes.append(merged_.data.begin(), merged_.data.end());
    return bytes;
  }
  std::ostringstream stream;
  Check(writer.writeBinaryCompressed(stream, merged_, origin, orientation) == 0,
        "a merged cloud can be compressed");
  return std::move(stream).str();
}

}  // namespace railcast
