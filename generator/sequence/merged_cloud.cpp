#include "generator/sequence/merged_cloud.h"

#include <pcl/io/pcd_io.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <sstream>
#include <string_view>

#include "core/base/error.h"
#include "core/io/merged_files.h"

namespace railcast {
namespace {

// The place of a field within a point, or nothing.
const pcl::PCLPointField* FieldOf(const pcl::PCLPointCloud2& cloud, std::string_view name) {
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

std::size_t OffsetOf(const pcl::PCLPointCloud2& cloud, std::string_view name) {
  const pcl::PCLPointField* const field = FieldOf(cloud, name);
  Check(field != nullptr && field->datatype == pcl::PCLPointField::FLOAT32,
        "a cloud that is merged has coordinates");
  return field->offset;
}

template <typename T>
T ValueAt(const std::uint8_t* place) {
  T value{};
  std::memcpy(&value, place, sizeof value);
  return value;
}

template <typename T>
void StoreValue(std::uint8_t* place, T value) {
  std::memcpy(place, &value, sizeof value);
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
  const pcl::PCLPointField* const time = FieldOf(cloud, "time_ns");
  const std::size_t num_slots = std::size_t{cloud.width} * cloud.height;
  merged_.data.reserve(merged_.data.size() + num_slots * (step + 1));
  for (std::size_t slot = 0; slot < num_slots; ++slot) {
    const std::uint8_t* const from = cloud.data.data() + slot * step;
    if (std::isnan(ValueAt<float>(from + x))) continue;
    const std::size_t begin = merged_.data.size();
    merged_.data.insert(merged_.data.end(), from, from + step);
    merged_.data.push_back(part.sensor_index);
    std::uint8_t* const to = merged_.data.data() + begin;
    const Vector3 point =
        part.merged_from_cloud *
        Vector3(ValueAt<float>(from + x), ValueAt<float>(from + y), ValueAt<float>(from + z));
    StoreValue(to + x, static_cast<float>(point.x()));
    StoreValue(to + y, static_cast<float>(point.y()));
    StoreValue(to + z, static_cast<float>(point.z()));
    if (time != nullptr) {
      StoreValue(to + time->offset, ValueAt<std::uint32_t>(from + time->offset) + part.later_ns);
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
