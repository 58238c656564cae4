#include "core/io/cloud/point_table.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/pcd_reader.h"
#include "core/io/cloud/ply_reader.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

constexpr std::string_view kCloudComparePrefix = "scalar_";

/// Adds a column for each field of the header.
/// @param begin Offset of the points in the table's bytes.
/// @param is_planar Whether the values of each field are stored together.
void AddColumns(const PcdHeader& header,
                std::size_t begin,
                bool is_planar,
                std::vector<PointColumn>& columns) {
  std::size_t offset = 0;
  for (const PcdField& field : header.fields) {
    const std::size_t size = field.size * field.count;
    columns.push_back({.name = field.name,
                       .type = field.number_type(),
                       .offset = begin + (is_planar ? header.points * offset : offset),
                       .step = is_planar ? size : header.PointStep()});
    offset += size;
  }
}

}  // namespace

std::string_view PointColumn::plain_name() const {
  std::string_view plain = name;
  if (plain.starts_with(kCloudComparePrefix)) plain.remove_prefix(kCloudComparePrefix.size());
  return plain;
}

const PointColumn* PointTable::Find(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &PointColumn::plain_name);
  return found == columns.end() ? nullptr : &*found;
}

PointTable ParsePcdTable(const std::string& file, std::string bytes) {
  PointTable table;
  std::string plain;
  const PcdHeader header = CheckPcd(file, bytes, &plain);
  table.width = static_cast<std::uint32_t>(header.width);
  table.height = static_cast<std::uint32_t>(header.height);
  if (header.data == "binary") {
    table.bytes = std::move(bytes);
    AddColumns(header, header.data_begin, false, table.columns);
  } else if (header.data == "ascii") {
    table.bytes = PackAscii(std::string_view(bytes).substr(header.data_begin), header);
    AddColumns(header, 0, false, table.columns);
  } else {
    table.bytes = std::move(plain);
    AddColumns(header, 0, true, table.columns);
  }
  return table;
}

PointTable ParsePlyTable(const std::string& file, const std::string& bytes) {
  const Cloud cloud = ParsePlyCloud(file, bytes);
  PointTable table;
  table.width = cloud.width;
  table.height = 1;
  for (const CloudField& field : cloud.fields) {
    table.columns.push_back(
        {.name = field.name, .type = field.type, .offset = field.offset, .step = cloud.point_step});
  }
  table.bytes.assign(cloud.data.begin(), cloud.data.end());
  return table;
}

PointTable ParseKittiTable(const std::string& file,
                           std::string bytes,
                           const std::optional<std::string>& labels) {
  constexpr std::size_t kStep = 4 * sizeof(float);
  const std::size_t num_points = bytes.size() / kStep;
  if (bytes.size() % kStep != 0 || num_points > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(file + ": must have 16 bytes for each point (got " + NumberText(bytes.size()) +
                     ")");
  }
  if (labels && labels->size() != num_points * sizeof(std::uint32_t)) {
    throw InputError(file + ": its .label file must have " +
                     NumberText(num_points * sizeof(std::uint32_t)) + " bytes (got " +
                     NumberText(labels->size()) + ")");
  }
  PointTable table{.width = static_cast<std::uint32_t>(num_points),
                   .height = 1,
                   .columns = {},
                   .bytes = std::move(bytes)};
  std::size_t offset = 0;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    table.columns.push_back({name, NumberType::kFloat, offset, kStep});
    offset += sizeof(float);
  }
  if (!labels) return table;
  const std::size_t begin = table.bytes.size();
  table.columns.push_back({"label", NumberType::kUint16, begin, sizeof(std::uint32_t)});
  table.columns.push_back({"instance", NumberType::kUint16, begin + 2, sizeof(std::uint32_t)});
  table.bytes += *labels;
  return table;
}

std::optional<std::filesystem::path> SecondFileOf(const std::filesystem::path& file) {
  const FrameFormat* const format = FindReader(file);
  if (format == nullptr || format->files.size() < 2) return std::nullopt;
  const std::filesystem::path folder(format->files[1].folder);
  // The folder of "a.bin", "./a.bin" or "../a.bin" is not named, nor is the one that it is in.
  const std::filesystem::path own = file.parent_path().lexically_normal();
  const bool is_named = !own.empty() && own.filename() != "." && own.filename() != "..";
  const std::filesystem::path above = is_named ? own.parent_path() : own / "..";
  auto beside = above / folder.parent_path().filename() / file.filename();
  beside.replace_extension(format->files[1].extension);
  return exists(beside) ? std::optional(beside) : std::nullopt;
}

PointTable ReadPointTable(const std::filesystem::path& file) {
  const FrameFormat* const format = FindReader(file);
  if (format == nullptr) {
    throw InputError(ShownPath(file) + ": must be a " + ReadableExtensions(true) + " file");
  }
  std::optional<std::string> second;
  if (const auto beside = SecondFileOf(file)) second = ReadFileWhole(*beside);
  return format->parse(ShownPath(file), ReadFileWhole(file), second);
}

}  // namespace railcast
