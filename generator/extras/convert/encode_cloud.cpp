#include "generator/extras/convert/encode_cloud.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/text.h"
#include "core/io/cloud/pcd_encoder.h"
#include "core/io/recording/cloud_fields.h"

namespace railcast {
namespace {

bool IsPly(const FrameFormat& format) {
  return !format.files.empty() && format.files.front().extension == ".ply";
}

/// Calls `visit` with each number of the point in turn.
template <typename Visit>
void ForEachNumber(const Cloud& cloud, std::size_t point, const Visit& visit) {
  const std::string_view row = cloud.Row(point);
  for (const CloudField& field : cloud.fields) {
    for (std::size_t i = 0; i < field.count; ++i) {
      VisitNumberType(field.type, [&](auto number) {
        std::memcpy(&number, row.data() + field.offset + i * sizeof number, sizeof number);
        visit(number);
      });
    }
  }
}

std::string PcdText(const Cloud& cloud) {
  std::string text = PcdHeaderOf(cloud, "ascii");
  for (std::size_t point = 0; point < cloud.num_points(); ++point) {
    ForEachNumber(cloud, point, [&](auto number) {
      AppendWord(number, text);
      text += ' ';
    });
    text.back() = '\n';
  }
  return text;
}

/// The type in which CloudCompare and Open3D read numbers of this one without loss.
NumberType CommonType(NumberType type) {
  const bool is_small = type < NumberType::kUint32;
  return is_small ? NumberType::kInt32 : type == NumberType::kFloat ? type : NumberType::kDouble;
}

std::string EncodePlyCloud(const Cloud& cloud, bool is_common) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      NumberText(cloud.num_points()) + "\n";
  for (const CloudField& field : cloud.fields) {
    const std::string name(field.plain_name());
    const bool is_position = name.size() == 1 && std::string_view("xyzXYZ").find(name) < 6;
    bytes.append("property ").append(PlyTypeName(is_common ? CommonType(field.type) : field.type));
    bytes.append(is_common && !is_position ? " scalar_" : " ").append(name).append("\n");
  }
  bytes += "end_header\n";
  const auto put = [&](auto number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  for (std::size_t point = 0; point < cloud.num_points(); ++point) {
    ForEachNumber(cloud, point, [&](auto number) {
      switch (is_common ? CommonType(NumberTypeOf<decltype(number)>()) : NumberType()) {
        case NumberType::kInt32:
          return put(static_cast<std::int32_t>(number));
        case NumberType::kDouble:
          return put(static_cast<double>(number));
        default:
          return put(number);
      }
    });
  }
  return bytes;
}

}  // namespace

bool Holds(const FrameFormat& format, const CloudField& field) {
  const bool is_long = field.type == NumberType::kInt64 || field.type == NumberType::kUint64;
  if (!format.bag.empty()) return !is_long;
  const std::string_view name = field.plain_name();
  const auto ends_word = [](unsigned char letter) { return letter <= ' ' || letter == 0x7F; };
  if (name.empty() || std::ranges::any_of(name, ends_word)) return false;
  return !IsPly(format) || (!is_long && field.count == 1);
}

std::uint64_t NumRowsAlone(const Cloud& cloud) {
  const bool is_stored = FindFieldOf(cloud, "ring") != nullptr && cloud.Find("column") != nullptr;
  return cloud.height > 1 && !is_stored ? cloud.height : 0;
}

std::uint64_t DropAbsentPoints(Cloud& cloud) {
  std::vector<bool> is_absent(cloud.num_points());
  for (const char* axis : {"x", "y", "z"}) {
    VisitField(cloud, NeedFieldOf(cloud, axis, "cloud"), [&](std::size_t point, auto value) {
      if (!std::isfinite(static_cast<double>(value))) is_absent[point] = true;
    });
  }
  const auto num_absent = static_cast<std::uint64_t>(std::ranges::count(is_absent, true));
  std::vector<std::uint8_t> kept;
  for (std::size_t point = 0; point < is_absent.size(); ++point) {
    if (is_absent[point]) continue;
    const std::string_view row = cloud.Row(point);
    kept.insert(kept.end(), row.begin(), row.end());
  }
  cloud.width = static_cast<std::uint32_t>(cloud.num_points() - num_absent);
  cloud.height = 1;
  cloud.data = std::move(kept);
  return num_absent;
}

std::string EncodeCloud(const Cloud& cloud, const FrameFormat& format) {
  if (IsPly(format)) return EncodePlyCloud(cloud, format.name == "ply-cloudcompare");
  if (format.name == "pcd-ascii") return PcdText(cloud);
  return EncodePcd(cloud, format.name == "pcd-compressed");
}

ros::PointCloud2 MessageOf(Cloud cloud, ros::Header header) {
  ros::PointCloud2 message;
  message.header = std::move(header);
  message.height = cloud.height;
  message.width = cloud.width;
  for (const CloudField& field : cloud.fields) {
    message.fields.push_back(
        {field.name, field.offset, static_cast<std::uint8_t>(field.type), field.count});
  }
  message.point_step = cloud.point_step;
  message.row_step = cloud.width * cloud.point_step;
  message.is_dense = cloud.is_dense;
  message.data = std::move(cloud.data);
  return message;
}

}  // namespace railcast
