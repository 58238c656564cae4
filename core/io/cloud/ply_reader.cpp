#include "railcast/io/cloud_files.h"

#include <pcl/PCLPointField.h>

#include <cstring>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/base/text_cursor.h"
#include "core/io/cloud/ply_header.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

pcl::PCLPointCloud2 Describe(const PlyHeader& header) {
  pcl::PCLPointCloud2 cloud;
  for (const PlyProperty& property : header.properties) {
    pcl::PCLPointField field;
    field.name = property.name;
    field.offset = cloud.point_step;
    field.datatype = property.pcl_type;
    field.count = 1;
    cloud.fields.push_back(field);
    cloud.point_step += static_cast<std::uint32_t>(property.size);
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(header.num_points);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  return cloud;
}

template <typename Number>
bool StoreWord(std::string_view word, std::uint8_t* place) {
  const auto number = ParseNumber<Number>(word);
  if (number) std::memcpy(place, &*number, sizeof *number);
  return number.has_value();
}

bool StoreWord(std::string_view word, std::uint8_t pcl_type, std::uint8_t* place) {
  switch (pcl_type) {
    case pcl::PCLPointField::INT8:
      return StoreWord<std::int8_t>(word, place);
    case pcl::PCLPointField::UINT8:
      return StoreWord<std::uint8_t>(word, place);
    case pcl::PCLPointField::INT16:
      return StoreWord<std::int16_t>(word, place);
    case pcl::PCLPointField::UINT16:
      return StoreWord<std::uint16_t>(word, place);
    case pcl::PCLPointField::INT32:
      return StoreWord<std::int32_t>(word, place);
    case pcl::PCLPointField::UINT32:
      return StoreWord<std::uint32_t>(word, place);
    case pcl::PCLPointField::FLOAT32:
      return StoreWord<float>(word, place);
    default:
      return StoreWord<double>(word, place);
  }
}

void ParsePoints(const std::string& file, std::string_view text, pcl::PCLPointCloud2& cloud) {
  for (std::uint32_t point = 0; point < cloud.width; ++point) {
    const auto line = TakeLine(text);
    const auto words = line ? Words(*line) : std::vector<std::string_view>{};
    const std::string place = ": point " + std::to_string(point);
    if (words.size() != cloud.fields.size()) {
      throw InputError(file + place + ": must have " + std::to_string(cloud.fields.size()) +
                       " values (got " + std::to_string(words.size()) + ")");
    }
    std::uint8_t* row = cloud.data.data() + std::size_t{point} * cloud.point_step;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const pcl::PCLPointField& field = cloud.fields[i];
      if (StoreWord(words[i], field.datatype, row + field.offset)) continue;
      throw InputError(file + place + ": " + ShownText(field.name) +
                       ": no value of its type (got " + ShownText(words[i]) + ")");
    }
  }
}

}  // namespace

pcl::PCLPointCloud2 ReadPly(const std::filesystem::path& file) {
  return WithinMemory([&] { return ReadingText(file); },
                      [&] { return ParsePly(ShownPath(file), ReadFileWhole(file)); });
}

pcl::PCLPointCloud2 ParsePly(const std::string& file, const std::string& bytes) {
  const PlyHeader header = CheckPly(file, bytes);
  pcl::PCLPointCloud2 cloud = Describe(header);
  if (header.is_ascii) {
    ParsePoints(file, std::string_view(bytes).substr(header.points_begin), cloud);
  } else if (!cloud.data.empty()) {
    std::memcpy(cloud.data.data(), bytes.data() + header.points_begin, cloud.data.size());
  }
  return cloud;
}

}  // namespace railcast
