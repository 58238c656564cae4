#include "core/io/cloud/ply_header.h"

#include <pcl/PCLPointField.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_cursor.h"

namespace railcast {
namespace {

struct PlyType {
  std::string_view name;
  std::string_view alias;
  std::uint8_t pcl_type;
  std::size_t size;
};

constexpr std::array<PlyType, 8> kTypes = {{
    {"char", "int8", pcl::PCLPointField::INT8, 1},
    {"uchar", "uint8", pcl::PCLPointField::UINT8, 1},
    {"short", "int16", pcl::PCLPointField::INT16, 2},
    {"ushort", "uint16", pcl::PCLPointField::UINT16, 2},
    {"int", "int32", pcl::PCLPointField::INT32, 4},
    {"uint", "uint32", pcl::PCLPointField::UINT32, 4},
    {"float", "float32", pcl::PCLPointField::FLOAT32, 4},
    {"double", "float64", pcl::PCLPointField::FLOAT64, 8},
}};

[[noreturn]] void Fail(const std::string& file, const std::string& rule) {
  throw InputError(file + ": " + rule);
}

bool ReadFormat(const std::string& file, const std::vector<std::string_view>& words) {
  if (words.size() == 3 && words[1] == "ascii") return true;
  if (words.size() == 3 && words[1] == "binary_little_endian") return false;
  Fail(file, "format: must be ascii or binary_little_endian (got " +
                 (words.size() > 1 ? ShownText(words[1]) : "nothing") + ")");
}

PlyProperty ReadProperty(const std::string& file, const std::vector<std::string_view>& words) {
  if (words.size() != 3) Fail(file, "element vertex: every property must be one number");
  const auto type = std::find_if(kTypes.begin(), kTypes.end(), [&](const PlyType& known) {
    return words[1] == known.name || words[1] == known.alias;
  });
  if (type == kTypes.end()) {
    Fail(file, "property " + ShownText(words[2]) + ": unknown type " + ShownText(words[1]));
  }
  return {std::string(words[2]), type->pcl_type, type->size};
}

std::uint64_t ReadCount(const std::string& file, const std::vector<std::string_view>& words) {
  const auto count = words.size() == 3 ? ParseNumber<std::uint64_t>(words[2]) : std::nullopt;
  if (!count || *count > std::numeric_limits<std::uint32_t>::max()) {
    Fail(file, "element vertex: must be a whole number below 2^32 (got " +
                   (words.size() > 2 ? ShownText(words[2]) : "nothing") + ")");
  }
  return *count;
}

void CheckLength(const std::string& file, const PlyHeader& header, std::size_t size) {
  const std::size_t available = size - header.points_begin;
  const std::uint64_t step = header.is_ascii ? 2 * header.properties.size() : header.PointStep();
  // The least that ASCII needs is one digit and one separator per number; the last line end may be
  // missing.
  const std::uint64_t slack = header.is_ascii ? 1 : 0;
  if (header.num_points > (available + slack) / step) {
    Fail(file, "element vertex: " + std::to_string(header.num_points) + " points need " +
                   std::to_string(header.num_points * step) + " bytes" +
                   (header.is_ascii ? " or more" : "") + ", the file has " +
                   std::to_string(available));
  }
  if (header.num_points * header.PointStep() > std::numeric_limits<std::uint32_t>::max()) {
    Fail(file,
         "element vertex: " + std::to_string(header.num_points) + " points are 4 GiB or more");
  }
}

}  // namespace

std::size_t PlyHeader::PointStep() const {
  std::size_t step = 0;
  for (const PlyProperty& property : properties) step += property.size;
  return step;
}

PlyHeader CheckPly(const std::string& file, std::string_view bytes) {
  std::string_view rest = bytes;
  if (TakeLine(rest) != "ply") Fail(file, "is no PLY file: its first line must be \"ply\"");
  PlyHeader header;
  bool has_format = false;
  std::size_t num_elements = 0;
  while (true) {
    const auto line = TakeLine(rest);
    if (!line) Fail(file, "is no PLY file: its header has no end_header line");
    const auto words = Words(*line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      header.is_ascii = ReadFormat(file, words);
      has_format = true;
    } else if (words[0] == "element") {
      const bool is_vertex = words.size() > 1 && words[1] == "vertex";
      if (is_vertex != (num_elements == 0)) Fail(file, "element vertex: must come first, and once");
      if (is_vertex) header.num_points = ReadCount(file, words);
      ++num_elements;
    } else if (words[0] == "property" && num_elements == 1) {
      header.properties.push_back(ReadProperty(file, words));
    } else if (words[0] != "property" || num_elements == 0) {
      Fail(file, "is no PLY file: a header line begins with " + std::string(words[0]));
    }
  }
  if (!has_format) Fail(file, "format: missing");
  if (header.properties.empty()) Fail(file, "element vertex: must have properties");
  header.points_begin = bytes.size() - rest.size();
  CheckLength(file, header, bytes.size());
  return header;
}

}  // namespace railcast
