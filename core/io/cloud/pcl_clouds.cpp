#include <pcl/PCLPointCloud2.h>

#include <cmath>
#include <type_traits>
#include <utility>

#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

/// What PCL calls dense.
bool IsFinite(const Cloud& cloud) {
  for (CloudField number : cloud.fields) {
    for (; number.count > 0; --number.count, number.offset += SizeOf(number.type)) {
      bool is_finite = true;
      VisitField(cloud, number, [&](std::size_t, auto value) {
        if constexpr (std::is_floating_point_v<decltype(value)>) {
          is_finite = is_finite && std::isfinite(value);
        }
      });
      if (!is_finite) return false;
    }
  }
  return true;
}

}  // namespace

static_assert(static_cast<int>(NumberType::kInt64) == pcl::PCLPointField::INT64 &&
                  static_cast<int>(NumberType::kUint64) == pcl::PCLPointField::UINT64 &&
                  static_cast<int>(NumberType::kFloat) == pcl::PCLPointField::FLOAT32,
              "PCL gives the types the same numbers");

pcl::PCLPointCloud2 ToPcl(Cloud cloud) {
  pcl::PCLPointCloud2 pcl_cloud;
  for (CloudField& field : cloud.fields) {
    pcl::PCLPointField& pcl_field = pcl_cloud.fields.emplace_back();
    pcl_field.name = std::move(field.name);
    pcl_field.offset = field.offset;
    pcl_field.datatype = static_cast<std::uint8_t>(field.type);
    pcl_field.count = field.count;
  }
  pcl_cloud.height = cloud.height;
  pcl_cloud.width = cloud.width;
  pcl_cloud.point_step = cloud.point_step;
  pcl_cloud.row_step = cloud.width * cloud.point_step;
  pcl_cloud.is_dense = cloud.is_dense ? 1 : 0;
  pcl_cloud.data = std::move(cloud.data);
  return pcl_cloud;
}

pcl::PCLPointCloud2 ReadPcd(const std::filesystem::path& file) {
  return WithinMemory([&] { return ReadingText(file); },
                      [&] {
                        Cloud cloud = ParsePcdFile(ShownPath(file), ReadFileWhole(file)).cloud;
                        cloud.is_dense = IsFinite(cloud);
                        return ToPcl(std::move(cloud));
                      });
}

pcl::PCLPointCloud2 ReadPly(const std::filesystem::path& file) {
  return WithinMemory([&] { return ReadingText(file); },
                      [&] { return ParsePly(ShownPath(file), ReadFileWhole(file)); });
}

pcl::PCLPointCloud2 ParsePly(const std::string& file, const std::string& bytes) {
  return ToPcl(ParsePlyFile(file, bytes).cloud);
}

}  // namespace railcast
