#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/io/cloud/cloud_file.h"

namespace railcast {
namespace {

[[noreturn]] void Fail(const std::string& file, const std::string& rule) {
  throw InputError(file + ": " + rule);
}

/// A property of an element: a number, or a list of numbers behind their count.
struct PlyProperty {
  std::string name;
  NumberType type{};
  std::optional<NumberType> length;  ///< The type of a list's count.
};

struct PlyElement {
  std::string name;
  std::uint32_t count{};
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool is_text{};
  bool is_big_endian{};
  std::vector<PlyElement> elements;
};

void ReadFormat(const std::string& file,
                const std::vector<std::string_view>& words,
                PlyHeader& header) {
  const std::string_view name = words.size() == 3 ? words[1] : std::string_view();
  header.is_text = name == "ascii";
  header.is_big_endian = name == "binary_big_endian";
  if (header.is_text || header.is_big_endian || name == "binary_little_endian") return;
  Fail(file, "format: must be ascii, binary_little_endian or binary_big_endian (got " +
                 (words.size() > 1 ? ShownText(words[1]) : "nothing") + ")");
}

PlyProperty ReadProperty(const std::string& file, const std::vector<std::string_view>& words) {
  const auto type_of = [&](std::string_view name) {
    const auto type = PlyTypeNamed(name);
    if (!type)
      Fail(file, "property " + ShownText(words.back()) + ": unknown type " + ShownText(name));
    return *type;
  };
  if (words.size() == 5 && words[1] == "list") {
    return {std::string(words[4]), type_of(words[3]), type_of(words[2])};
  }
  if (words.size() != 3) Fail(file, "is no PLY file: a property must have a type and a name");
  return {std::string(words[2]), type_of(words[1]), {}};
}

PlyElement ReadElement(const std::string& file, const std::vector<std::string_view>& words) {
  const auto count = words.size() == 3 ? ParseNumber<std::uint32_t>(words[2]) : std::nullopt;
  if (!count) {
    Fail(file, "element " + ShownText(words.size() > 1 ? words[1] : "") +
                   ": must be a whole number below 2^32 (got " +
                   (words.size() > 2 ? ShownText(words[2]) : "nothing") + ")");
  }
  return {std::string(words[1]), *count, {}};
}

/// The number that binary data begin with, such as the count of a list.
double NumberAt(std::string_view data, NumberType type, bool is_big_endian) {
  return VisitNumberType(type, [&](auto number) {
    std::array<char, sizeof number> bytes{};
    std::copy_n(data.begin(), bytes.size(), bytes.begin());
    if (is_big_endian) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&number, bytes.data(), sizeof number);
    return static_cast<double>(number);
  });
}

/// Takes an element off the data: as many lines, or its bytes.
/// @return Whether the data have all of it.
bool TakeElement(const PlyHeader& header, const PlyElement& element, std::string_view& data) {
  const auto take = [&](double size) {
    if (!(size >= 0.0 && size <= static_cast<double>(data.size()))) return false;
    data.remove_prefix(static_cast<std::size_t>(size));
    return true;
  };
  if (element.properties.empty()) return true;
  for (std::uint32_t i = 0; i < element.count; ++i) {
    if (header.is_text) {
      if (!TakeLine(data)) return false;
      continue;
    }
    for (const PlyProperty& property : element.properties) {
      double num = 1.0;
      if (property.length) {
        const std::size_t size = SizeOf(*property.length);
        if (data.size() < size) return false;
        num = NumberAt(data, *property.length, header.is_big_endian);
        data.remove_prefix(size);
      }
      if (!take(num * SizeOf(property.type))) return false;
    }
  }
  return true;
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
    auto line = TakeLine(text);
    while (line && Words(*line).empty()) line = TakeLine(text);
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
PlyHeader ReadPlyHeader(const std::string& file, std::string_view& rest) {
  if (TakeLine(rest) != "ply") Fail(file, "is no PLY file: its first line must be \"ply\"");
  PlyHeader header;
  bool has_format = false;
  while (true) {
    const auto line = TakeLine(rest);
    if (!line) Fail(file, "is no PLY file: its header has no end_header line");
    const auto words = Words(*line);
    if (words.empty()) continue;
    if (words[0] == "comment" || words[0] == "obj_info") {
      CheckUnitComment(file, *line);
      continue;
    }
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      ReadFormat(file, words, header);
      has_format = true;
    } else if (words[0] == "element") {
      header.elements.push_back(ReadElement(file, words));
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(ReadProperty(file, words));
    } else {
      Fail(file, "is no PLY file: a header line begins with " + std::string(words[0]));
    }
  }
  if (!has_format) Fail(file, "format: missing");
  return header;
}

/// Makes the fields of the cloud.
/// @return Where its element is.
std::size_t ReadVertexFields(const std::string& file, const PlyHeader& header, Cloud& cloud) {
  const auto vertex = std::ranges::find(header.elements, "vertex", &PlyElement::name);
  if (std::ranges::count(header.elements, "vertex", &PlyElement::name) != 1) {
    Fail(file, "element vertex: must come once");
  }
  for (const PlyProperty& property : vertex->properties) {
    if (property.length) Fail(file, "element vertex: every property must be one number");
    cloud.AddField(property.name, property.type);
  }
  if (cloud.fields.empty()) Fail(file, "element vertex: must have properties");
  cloud.width = vertex->count;
  return static_cast<std::size_t>(vertex - header.elements.begin());
}

/// Takes those elements off the tail that are behind the points, tells if they are cut, and refuses
/// what is left.
void CheckTail(const std::string& file,
               const PlyHeader& header,
               std::size_t vertex,
               std::string_view tail,
               std::vector<Remark>& remarks) {
  for (std::size_t i = vertex + 1; i < header.elements.size(); ++i) {
    const PlyElement& element = header.elements[i];
    if (TakeElement(header, element, tail)) continue;
    return AddRemark({.kind = RemarkKind::kRecordingCut,
                      .place = file,
                      .detail = "it lacks elements " + ShownText(element.name)},
                     remarks);
  }
  using std::string_view_literals::operator""sv;
  if (tail.find_first_not_of(" \t\r\n\0"sv) == std::string_view::npos) return;
  const std::size_t num_bytes = tail.size();
  const std::string num = NumberText(header.elements[vertex].count);
  std::size_t num_lines = 0;
  while (const auto line = TakeLine(tail)) num_lines += Words(*line).empty() ? 0 : 1;
  Fail(file,
       "element vertex: " + num + " points, but the file has " +
           (header.is_text ? NumberText(num_lines) + " lines" : NumberText(num_bytes) + " bytes") +
           " more than its elements need");
}

}  // namespace

CloudFile ParsePlyFile(const std::string& file,
                       std::string_view bytes,
                       const std::optional<std::string>& /*second*/) {
  if (IsUtf16(bytes)) Fail(file, "is UTF-16; save as UTF-8");
  bytes = WithoutMark(bytes);
  CloudFile read;
  Cloud& cloud = read.cloud;
  cloud.height = 1;
  read.points = bytes;
  const PlyHeader header = ReadPlyHeader(file, read.points);
  read.storage = header.is_text ? PointStorage::kText : PointStorage::kRows;
  read.is_big_endian = header.is_big_endian;
  const std::size_t vertex = ReadVertexFields(file, header, cloud);
  for (std::size_t i = 0; i < vertex; ++i) {
    const PlyElement& element = header.elements[i];
    if (TakeElement(header, element, read.points)) continue;
    Fail(file,
         "ends within its " + NumberText(element.count) + " elements " + ShownText(element.name));
  }
  read.header = bytes.substr(0, bytes.size() - read.points.size());
  CheckLength(file, read);
  if (header.is_text) {
    read.tail = ReadPlyText(file, read.points, cloud);
    if (cloud.WidenRounded()) read.tail = ReadPlyText(file, read.points, cloud);
  } else {
    const std::size_t size = std::size_t{cloud.width} * cloud.point_step;
    read.tail = read.points.substr(size);
    const auto* const rows = reinterpret_cast<const std::uint8_t*>(read.points.data());
    cloud.data.assign(rows, rows + size);
    if (header.is_big_endian) SwapBytes(cloud, cloud.data);
  }
  read.points.remove_suffix(read.tail.size());
  CheckTail(file, header, vertex, read.tail, cloud.remarks);
  return read;
}

}  // namespace railcast
