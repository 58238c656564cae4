#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/ply.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/io/cloud/cloud_file.h"

namespace railcast {
namespace {

void CheckLength(const PlyWalk& ply, const CloudFile& read) {
  const Cloud& cloud = read.cloud;
  const bool is_text = read.storage == PointStorage::kText;
  const std::size_t available = read.points.size();
  const std::uint64_t step = is_text ? 2 * cloud.fields.size() : cloud.point_step;
  // The least that ASCII needs is one digit and one separator per number; the last line end may be
  // missing.
  const std::uint64_t slack = is_text ? 1 : 0;
  if (cloud.width > (available + slack) / step) {
    ply.Fail("element vertex: " + NumberText(cloud.width) + " points need " +
             NumberText(cloud.width * step) + " bytes" + (is_text ? " or more" : "") +
             ", the file has " + NumberText(available));
  }
  if (std::uint64_t{cloud.width} * cloud.point_step > std::numeric_limits<std::uint32_t>::max()) {
    ply.Fail("element vertex: " + NumberText(cloud.width) + " points are 4 GiB or more");
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

/// Makes the fields of the cloud.
/// @return Where its element is.
std::size_t ReadVertexFields(const PlyWalk& ply, Cloud& cloud) {
  const std::vector<PlyElement>& elements = ply.elements();
  const auto vertex = std::ranges::find(elements, "vertex", &PlyElement::name);
  if (std::ranges::count(elements, "vertex", &PlyElement::name) != 1) {
    ply.Fail("element vertex: must come once");
  }
  for (const PlyProperty& property : vertex->properties) {
    if (property.length) ply.Fail("element vertex: every property must be one number");
    cloud.AddField(property.name, property.type);
  }
  if (cloud.fields.empty()) ply.Fail("element vertex: must have properties");
  cloud.width = vertex->count;
  return static_cast<std::size_t>(vertex - elements.begin());
}

/// Passes over the elements that are behind the points, tells if they are cut, and refuses what is
/// left.
void CheckTail(const std::string& file,
               std::size_t vertex,
               PlyWalk& ply,
               std::vector<Remark>& remarks) {
  for (std::size_t i = vertex + 1; i < ply.elements().size(); ++i) {
    const PlyElement& element = ply.elements()[i];
    if (ply.Skip(element)) continue;
    return AddRemark({.kind = RemarkKind::kRecordingCut,
                      .place = file,
                      .detail = "it lacks elements " + ShownText(element.name)},
                     remarks);
  }
  using std::string_view_literals::operator""sv;
  std::string_view surplus = ply.rest();
  if (surplus.find_first_not_of(" \t\r\n\0"sv) == std::string_view::npos) return;
  std::string amount = NumberText(surplus.size()) + " bytes";
  if (ply.encoding() == PlyEncoding::kAscii) {
    std::size_t num_lines = 0;
    while (const auto line = TakeLine(surplus)) num_lines += Words(*line).empty() ? 0 : 1;
    amount = NumberText(num_lines) + " lines";
  }
  ply.Fail("element vertex: " + NumberText(ply.elements()[vertex].count) +
           " points, but the file has " + amount + " more than its elements need");
}

}  // namespace

CloudFile ParsePlyFile(const std::string& file,
                       std::string_view bytes,
                       const std::optional<std::string>& /*second*/) {
  if (IsUtf16(bytes)) throw InputError(file + ": is UTF-16; save as UTF-8");
  bytes = WithoutMark(bytes);
  PlyWalk ply(file, bytes, [&](std::string_view line) { CheckUnitComment(file, line); });
  CloudFile read;
  read.storage = ply.encoding() == PlyEncoding::kAscii ? PointStorage::kText : PointStorage::kRows;
  read.is_big_endian = ply.encoding() == PlyEncoding::kBigEndian;
  Cloud& cloud = read.cloud;
  cloud.height = 1;
  const std::size_t vertex = ReadVertexFields(ply, cloud);
  for (std::size_t i = 0; i < vertex; ++i) {
    if (!ply.Skip(ply.elements()[i])) ply.FailShort(ply.elements()[i]);
  }
  read.points = ply.rest();
  read.header = bytes.substr(0, bytes.size() - read.points.size());
  CheckLength(ply, read);
  if (read.storage == PointStorage::kText) {
    read.tail = ReadPlyText(file, read.points, cloud);
    if (cloud.WidenRounded()) read.tail = ReadPlyText(file, read.points, cloud);
  } else {
    const std::size_t size = std::size_t{cloud.width} * cloud.point_step;
    read.tail = read.points.substr(size);
    const auto* const rows = reinterpret_cast<const std::uint8_t*>(read.points.data());
    cloud.data.assign(rows, rows + size);
    if (read.is_big_endian) SwapBytes(cloud, cloud.data);
  }
  read.points.remove_suffix(read.tail.size());
  ply.SkipBytes(read.points.size());
  CheckTail(file, vertex, ply, cloud.remarks);
  return read;
}

}  // namespace railcast
