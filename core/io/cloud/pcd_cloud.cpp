#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/io/cloud/pcd_reader.h"
#include "core/io/cloud/woven_cloud.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

// The points of a file, point after point.
std::string PackRows(const PcdHeader& header, std::string_view points, const std::string& plain) {
  if (header.data == "binary") {
    return std::string(points.substr(0, header.points * header.PointStep()));
  }
  if (header.data == "ascii") return PackAscii(points, header);
  std::vector<std::size_t> field_bytes;
  for (const PcdField& field : header.fields) field_bytes.push_back(field.size * field.count);
  std::string rows;
  Transpose(field_bytes, header.points, plain, true, rows);
  return rows;
}

// What PCL calls dense.
bool IsFinite(const PcdHeader& header, const std::string& rows) {
  const std::uint64_t step = header.PointStep();
  std::size_t offset = 0;
  for (const PcdField& field : header.fields) {
    const bool is_finite = VisitNumberType(field.number_type(), [&](auto zero) {
      if constexpr (std::is_floating_point_v<decltype(zero)>) {
        for (std::size_t point = 0; point < header.points; ++point) {
          for (std::uint64_t i = 0; i < field.count; ++i) {
            std::memcpy(&zero, &rows[point * step + offset + i * sizeof zero], sizeof zero);
            if (!std::isfinite(zero)) return false;
          }
        }
      }
      return true;
    });
    if (!is_finite) return false;
    offset += field.size * field.count;
  }
  return true;
}

Cloud ParsePcd(const std::filesystem::path& file, const std::string& bytes) {
  std::string plain;
  const PcdHeader header = CheckPcd(ShownPath(file), bytes, &plain);
  const std::string rows =
      PackRows(header, std::string_view(bytes).substr(header.data_begin), plain);
  Cloud cloud;
  for (const PcdField& field : header.fields) {
    cloud.AddField(field.name, field.number_type(), static_cast<std::uint32_t>(field.count));
  }
  cloud.width = static_cast<std::uint32_t>(header.width);
  cloud.height = static_cast<std::uint32_t>(header.height);
  cloud.is_dense = IsFinite(header, rows);
  cloud.data.assign(rows.begin(), rows.end());
  return cloud;
}

}  // namespace

Cloud ReadPcdCloud(const std::filesystem::path& file) {
  return WithinMemory([&] { return ReadingText(file); },
                      [&] { return ParsePcd(file, ReadFileWhole(file)); });
}

}  // namespace railcast
