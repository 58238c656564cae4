#include "core/io/cloud/cloud_rows.h"

#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/pcd_encoder.h"
#include "core/io/cloud/pcd_reader.h"
#include "core/io/cloud/ply_reader.h"
#include "core/io/cloud/woven_cloud.h"

namespace railcast {
namespace {

// Of a point in KITTI's .bin, and of its label in the .label file.
constexpr std::size_t kPointBytes = 16;
constexpr std::size_t kLabelBytes = 4;

/// Splits text into its lines that hold anything.
void FindLines(CloudRows& rows) {
  std::string_view rest = rows.bytes;
  std::string kept;
  while (!rest.empty()) {
    const std::string_view before = rest;
    const auto line = TakeLine(rest);
    if (Words(*line).empty()) continue;
    rows.line_begins.push_back(kept.size());
    kept += before.substr(0, before.size() - rest.size());
    if (kept.back() != '\n') kept += '\n';
  }
  rows.line_begins.push_back(kept.size());
  rows.bytes = std::move(kept);
}

/// Gives cells one after another, of which each has `sizes[i]` places.
void AddCells(const std::vector<std::size_t>& sizes, CloudRows& rows) {
  std::size_t place = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    rows.cells.push_back({rows.table.columns[i].type, place});
    place += sizes[i];
  }
  (rows.line_begins.empty() ? rows.row_bytes : rows.num_words) = place;
}

void TakePcdApart(const std::string& file, const std::string& bytes, CloudParts& parts) {
  const PcdHeader header = CheckPcd(file, bytes);
  CloudRows& rows = parts.rows;
  rows.table = ParsePcdTable(file, bytes);
  parts.header = bytes.substr(0, header.data_begin);
  parts.is_compressed = header.data == "binary_compressed";
  std::vector<std::size_t> counts;
  for (const PcdField& field : header.fields) {
    counts.push_back(field.count);
    parts.field_bytes.push_back(field.size * field.count);
  }
  if (parts.is_compressed) {
    Transpose(parts.field_bytes, header.points, rows.table.bytes, true, rows.bytes);
  } else {
    rows.bytes = bytes.substr(header.data_begin);
    if (header.data == "binary") rows.bytes.resize(header.points * header.PointStep());
  }
  if (header.data == "ascii") FindLines(rows);
  AddCells(header.data == "ascii" ? counts : parts.field_bytes, rows);
}

void TakePlyApart(const std::string& file, const std::string& bytes, CloudParts& parts) {
  const PlyHeader header = CheckPly(file, bytes);
  CloudRows& rows = parts.rows;
  rows.table = ParsePlyTable(file, bytes);
  parts.header = bytes.substr(0, header.points_begin);
  std::string_view points = std::string_view(bytes).substr(header.points_begin);
  std::vector<std::size_t> sizes;
  for (const PlyProperty& property : header.properties) {
    sizes.push_back(header.is_ascii ? 1 : property.size);
  }
  std::size_t length = header.num_points * header.PointStep();
  if (header.is_ascii) {
    std::string_view rest = points;
    for (std::uint64_t i = 0; i < header.num_points; ++i) (void)TakeLine(rest);
    length = points.size() - rest.size();
  }
  parts.tail = points.substr(length);
  rows.bytes = points.substr(0, length);
  if (header.is_ascii) FindLines(rows);
  AddCells(sizes, rows);
}

void TakeKittiApart(const std::string& file,
                    const std::string& bytes,
                    const std::optional<std::string>& labels,
                    CloudParts& parts) {
  CloudRows& rows = parts.rows;
  rows.table = ParseKittiTable(file, bytes, labels);
  parts.has_labels = labels.has_value();
  std::vector<std::size_t> sizes(4, sizeof(float));
  if (!labels) {
    rows.bytes = bytes;
  } else {
    sizes.insert(sizes.end(), 2, sizeof(std::uint16_t));
    Transpose({kPointBytes, kLabelBytes}, rows.table.num_points(), bytes + *labels, true,
              rows.bytes);
  }
  AddCells(sizes, rows);
}

/// Returns a header with the number of its points changed: the last word of the lines that begin
/// so.
std::string WithNumber(std::string_view header,
                       const std::vector<std::string_view>& begins,
                       std::size_t number) {
  std::string changed;
  while (!header.empty()) {
    const std::string_view before = header;
    const std::string_view line = *TakeLine(header);
    const std::string_view whole = before.substr(0, before.size() - header.size());
    bool is_number = false;
    for (const std::string_view begin : begins) is_number = is_number || line.starts_with(begin);
    if (is_number) {
      changed += line.substr(0, line.find_last_of(" \t") + 1);
      changed += NumberText(number);
      changed += whole.substr(line.size());
    } else {
      changed += whole;
    }
  }
  return changed;
}

}  // namespace

CloudParts TakeCloudApart(const std::string& file,
                          std::string bytes,
                          const std::optional<std::string>& labels) {
  const std::string extension = std::filesystem::path(file).extension().string();
  CloudParts parts;
  if (extension == ".pcd") {
    parts.extension = ".pcd";
    TakePcdApart(file, bytes, parts);
  } else if (extension == ".ply") {
    parts.extension = ".ply";
    TakePlyApart(file, bytes, parts);
  } else {
    parts.extension = ".bin";
    TakeKittiApart(file, bytes, labels, parts);
  }
  return parts;
}

std::vector<std::string> PutCloudTogether(const CloudParts& parts,
                                          const std::string& rows,
                                          std::size_t num_rows) {
  if (parts.has_labels) {
    std::string fields;
    Transpose({kPointBytes, kLabelBytes}, num_rows, rows, false, fields);
    const std::size_t begin = num_rows * kPointBytes;
    return {fields.substr(0, begin), fields.substr(begin)};
  }
  if (parts.extension == ".bin") return {rows};
  if (parts.extension == ".ply") {
    return {WithNumber(parts.header, {"element vertex "}, num_rows) + rows + parts.tail};
  }
  const bool has_same_number = num_rows == parts.rows.table.num_points();
  std::string file =
      has_same_number ? parts.header : WithNumber(parts.header, {"WIDTH ", "POINTS "}, num_rows);
  if (!parts.is_compressed) return {file + rows};
  std::string fields;
  Transpose(parts.field_bytes, num_rows, rows, false, fields);
  AppendCompressed(fields, file);
  return {std::move(file)};
}

}  // namespace railcast
