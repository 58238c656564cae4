#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"

namespace railcast {
namespace {

[[noreturn]] void Fail(const std::string& file, const std::string& rule) {
  throw InputError(file + ": " + rule);
}

bool ReadFormat(const std::string& file, const std::vector<std::string_view>& words) {
  if (words.size() == 3 && words[1] == "ascii") return true;
  if (words.size() == 3 && words[1] == "binary_little_endian") return false;
  Fail(file, "format: must be ascii or binary_little_endian (got " +
                 (words.size() > 1 ? ShownText(words[1]) : "nothing") + ")");
}

void ReadProperty(const std::string& file,
                  const std::vector<std::string_view>& words,
                  Cloud& cloud) {
  if (words.size() != 3) Fail(file, "element vertex: every property must be one number");
  const auto type = PlyTypeNamed(words[1]);
  if (!type) {
    Fail(file, "property " + ShownText(words[2]) + ": unknown type " + ShownText(words[1]));
  }
  cloud.AddField(std::string(words[2]), *type);
}

std::uint32_t ReadCount(const std::string& file, const std::vector<std::string_view>& words) {
  const auto count = words.size() == 3 ? ParseNumber<std::uint32_t>(words[2]) : std::nullopt;
  if (!count) {
    Fail(file, "element vertex: must be a whole number below 2^32 (got " +
                   (words.size() > 2 ? ShownText(words[2]) : "nothing") + ")");
  }
  return *count;
}

void CheckLength(const std::string& file, const CloudFile& read) {
  const Cloud& cloud = read.cloud;
  const bool is_text = read.storage == PointStorage::kText;
  const std::size_t available = read.points.size();
  const std::uint64_t step = is_text ? 2 * cloud.fields.size() : cloud.point_step;
  // The least that ASCII needs is one digit and one separator per number; the last line end may be
  // missing.
  const std::uint64_t slack = is_text ? 1 : 0;
  if (cloud.width > (available + slack) / step) {
    Fail(file, "element vertex: " + std::to_string(cloud.width) + " points need " +
                   std::to_string(cloud.width * step) + " bytes" + (is_text ? " or more" : "") +
                   ", the file has " + std::to_string(available));
  }
  if (std::uint64_t{cloud.width} * cloud.point_step > std::numeric_limits<std::uint32_t>::max()) {
    Fail(file, "element vertex: " + std::to_string(cloud.width) + " points are 4 GiB or more");
  }
}

/// Reads the lines of the points and returns what is behind them.
std::string_view ReadPlyText(const std::string& file, std::string_view text, Cloud& cloud) {
  for (std::uint32_t point = 0; point < cloud.width; ++point) {
    const auto line = TakeLine(text);
    const auto words = line ? Words(*line) : std::vector<std::string_view>{};
    const std::string place = file + ": point " + std::to_string(point);
    if (words.size() != cloud.fields.size()) {
      throw InputError(place + ": must have " + std::to_string(cloud.fields.size()) +
                       " values (got " + std::to_string(words.size()) + ")");
    }
    (void)cloud.AppendWords(place, words);
  }
  return text;
}

/// Reads the header up to `rest`.
void ReadPlyHeader(const std::string& file, std::string_view& rest, CloudFile& read) {
  if (TakeLine(rest) != "ply") Fail(file, "is no PLY file: its first line must be \"ply\"");
  bool has_format = false;
  std::size_t num_elements = 0;
  while (true) {
    const auto line = TakeLine(rest);
    if (!line) Fail(file, "is no PLY file: its header has no end_header line");
    const auto words = Words(*line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      read.storage = ReadFormat(file, words) ? PointStorage::kText : PointStorage::kRows;
      has_format = true;
    } else if (words[0] == "element") {
      const bool is_vertex = words.size() > 1 && words[1] == "vertex";
      if (is_vertex != (num_elements == 0)) Fail(file, "element vertex: must come first, and once");
      if (is_vertex) read.cloud.width = ReadCount(file, words);
      ++num_elements;
    } else if (words[0] == "property" && num_elements == 1) {
      ReadProperty(file, words, read.cloud);
    } else if (words[0] != "property" || num_elements == 0) {
      Fail(file, "is no PLY file: a header line begins with " + std::string(words[0]));
    }
  }
  if (!has_format) Fail(file, "format: missing");
  if (read.cloud.fields.empty()) Fail(file, "element vertex: must have properties");
}

}  // namespace

CloudFile ParsePlyFile(const std::string& file,
                       std::string_view bytes,
                       const std::optional<std::string>& /*second*/) {
  CloudFile read;
  read.cloud.height = 1;
  read.points = bytes;
  ReadPlyHeader(file, read.points, read);
  read.header = bytes.substr(0, bytes.size() - read.points.size());
  CheckLength(file, read);
  const std::size_t size = std::size_t{read.cloud.width} * read.cloud.point_step;
  if (read.storage == PointStorage::kText) {
    read.cloud.data.reserve(size);
    read.tail = ReadPlyText(file, read.points, read.cloud);
  } else {
    read.tail = read.points.substr(size);
    const auto* const rows = reinterpret_cast<const std::uint8_t*>(read.points.data());
    read.cloud.data.assign(rows, rows + size);
  }
  read.points.remove_suffix(read.tail.size());
  return read;
}

}  // namespace railcast
