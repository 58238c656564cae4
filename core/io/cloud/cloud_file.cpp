#include "core/io/cloud/cloud_file.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/unit_comment.h"
#include "core/io/cloud/las_reader.h"
#include "core/io/cloud/pcd_encoder.h"
#include "core/io/cloud/text_cloud.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

/// Returns a header of a PCD or PLY file with another number of points.
std::string WithNumber(std::string_view header, std::size_t number) {
  std::string changed;
  const char* kept = header.data();
  const char* const end = kept + header.size();
  while (const auto line = TakeLine(header)) {
    const auto words = Words(*line);
    if (words.empty()) continue;
    const std::string key = LowerCase(words[0]);
    if (key == "end_header") break;
    const bool is_ply = key == "element" && words.size() == 3 && words[1] == "vertex";
    if (!is_ply && key != "width" && key != "points") continue;
    changed.append(kept, words.back().data()) += NumberText(number);
    kept = words.back().data() + words.back().size();
  }
  return changed.append(kept, end);
}

/// The lines of text that hold points, with their ends.
std::vector<std::string_view> LinesOf(const CloudFile& file) {
  std::vector<std::string_view> lines;
  std::string_view rest = file.points;
  while (lines.size() < file.cloud.num_points()) {
    const std::string_view before = rest;
    if (Words(*TakeLine(rest)).empty()) continue;
    lines.push_back(before.substr(0, before.size() - rest.size()));
  }
  return lines;
}

/// Appends a line for a point that keeps the words of those numbers that its source has, too.
/// @param source,line Of the point that it was; empty if there is none.
void AppendLine(const Cloud& cloud,
                std::string_view row,
                std::string_view source,
                std::string_view line,
                std::string& text) {
  const auto words = Words(TakeLine(line).value_or(""));
  std::size_t word = 0;
  for (const CloudField& field : cloud.fields) {
    const std::size_t size = SizeOf(field.type);
    for (std::size_t i = 0, at = field.offset; i < field.count; ++i, at += size, ++word) {
      if (word > 0) text += ' ';
      if (!source.empty() && row.substr(at, size) == source.substr(at, size)) {
        text += words[word];
        continue;
      }
      VisitNumberType(field.type, [&](auto number) {
        std::memcpy(&number, &row[at], sizeof number);
        AppendWord(number, text);
      });
    }
  }
  text += '\n';
}

std::string LinesOf(const CloudFile& file, const OtherPoints& points) {
  const std::vector<std::string_view> lines = LinesOf(file);
  std::string text;
  for (std::size_t i = 0; i < points.sources.size(); ++i) {
    const std::uint32_t source = points.sources[i];
    const std::string_view row = RowOf(points.data, file.cloud.point_step, i);
    const bool has_source = source != kNoSource;
    const std::string_view before = has_source ? file.cloud.Row(source) : std::string_view();
    if (!has_source || row != before) {
      AppendLine(file.cloud, row, before, has_source ? lines[source] : "", text);
    } else {
      text += lines[source];
      if (text.back() != '\n') text += '\n';
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> Rewritten(const CloudFile& file, const OtherPoints& points) {
  const Cloud& cloud = file.cloud;
  const std::size_t num = points.sources.size();
  std::string bytes =
      num == cloud.num_points() ? std::string(file.header) : WithNumber(file.header, num);
  std::string parts(points.data.size(), '\0');
  std::vector<std::uint8_t> rows = points.data;
  // Three times more make four.
  for (int i = 0; i < 3 && file.is_turned; ++i) TurnLeft(cloud, rows);
  if (file.label_bytes > 0) {
    const std::size_t point_bytes = cloud.point_step - file.label_bytes;
    Transpose({point_bytes, file.label_bytes}, num, rows.data(), false, parts.data());
    return {parts.substr(0, num * point_bytes), parts.substr(num * point_bytes)};
  }
  switch (file.storage) {
    case PointStorage::kRows:
      if (file.is_big_endian) SwapBytes(cloud, rows);
      bytes.append(reinterpret_cast<const char*>(rows.data()), rows.size());
      break;
    case PointStorage::kFields:
      Transpose(FieldSizes(cloud), num, points.data.data(), false, parts.data());
      AppendCompressed(parts, bytes);
      break;
    case PointStorage::kText:
      bytes += LinesOf(file, points);
      break;
  }
  return {bytes.append(file.tail)};
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

CloudFile ParseCloudFile(const std::filesystem::path& file,
                         std::string_view bytes,
                         const std::optional<std::string>& second,
                         const std::string& columns) {
  const FrameFormat* const format = FindReader(file);
  if (format == nullptr) {
    throw InputError(ShownPath(file) + ": must be a " + ReadableExtensions(true) + " file");
  }
  if (columns.empty()) return format->parse(ShownPath(file), bytes, second);
  if (!format->dataset || !IsKittiColumns(columns)) {
    const bool is_named = IsTextColumns(columns);
    throw InputError(ShownPath(file) + ": must be a " + (is_named ? "cloud in text" : ".bin file") +
                     " for its columns to be chosen (got " + columns + ")");
  }
  return ParseKittiColumns(ShownPath(file), bytes, second, columns);
}

void CheckUnitComment(const std::string& file, std::string_view comment) {
  if (!UnitOfComment_m(comment)) return;
  throw InputError(file + ": positions must be in metres, but a comment says " + Quoted(comment));
}

Cloud ReadCloud(const std::filesystem::path& file, const std::string& columns) {
  if (columns.empty() && IsLasFile(file)) return ReadLas(file);
  if (IsTextCloud(file)) return ReadTextCloud(file, columns);
  std::optional<std::string> second;
  if (const auto beside = SecondFileOf(file)) second = ReadFileWhole(*beside);
  return ParseCloudFile(file, ReadFileWhole(file), second, columns).cloud;
}

}  // namespace railcast
