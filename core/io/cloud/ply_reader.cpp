#include "core/io/cloud/ply_reader.h"

#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

Cloud Describe(const PlyHeader& header) {
  Cloud cloud;
  for (const PlyProperty& property : header.properties) {
    cloud.AddField(property.name, property.type);
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(header.num_points);
  cloud.data.resize(header.num_points * cloud.point_step);
  return cloud;
}

bool StoreWord(std::string_view word, NumberType type, std::uint8_t* place) {
  return VisitNumberType(type, [&](auto zero) {
    const auto number = ParseNumber<decltype(zero)>(word);
    if (number) std::memcpy(place, &*number, sizeof *number);
    return number.has_value();
  });
}

void ParsePoints(const std::string& file, std::string_view text, Cloud& cloud) {
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
      const CloudField& field = cloud.fields[i];
      if (StoreWord(words[i], field.type, row + field.offset)) continue;
      throw InputError(file + place + ": " + ShownText(field.name) +
                       ": no value of its type (got " + ShownText(words[i]) + ")");
    }
  }
}

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
  const auto type = PlyTypeNamed(words[1]);
  if (!type) {
    Fail(file, "property " + ShownText(words[2]) + ": unknown type " + ShownText(words[1]));
  }
  return {std::string(words[2]), *type,
          VisitNumberType(*type, [](auto zero) { return sizeof zero; })};
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

Cloud ParsePlyCloud(const std::string& file, const std::string& bytes) {
  const PlyHeader header = CheckPly(file, bytes);
  Cloud cloud = Describe(header);
  if (header.is_ascii) {
    ParsePoints(file, std::string_view(bytes).substr(header.points_begin), cloud);
  } else if (!cloud.data.empty()) {
    std::memcpy(cloud.data.data(), bytes.data() + header.points_begin, cloud.data.size());
  }
  return cloud;
}

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
