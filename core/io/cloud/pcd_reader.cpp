#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/pcd_encoder.h"

// The header of liblzf is one of C.
extern "C" {
#include <lzf.h>
}

namespace railcast {
namespace {

constexpr std::uint64_t kMaxCloudBytes = std::numeric_limits<std::uint32_t>::max();

char UpperLetter(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

// Collects the lines of one header, by their keys in upper case; errors name the file.
class HeaderReader {
 public:
  HeaderReader(const std::string& file, std::string_view bytes) : file_(file), rest_(bytes) {
    const std::size_t size = bytes.size();
    while (const auto line = TakeLine(rest_)) {
      const auto words = Words(*line);
      if (words.empty()) continue;
      if (words[0].starts_with('#')) {
        CheckUnitComment(file_, *line);
        continue;
      }
      std::string key(words[0]);
      std::ranges::transform(key, key.begin(), UpperLetter);
      if (key == "COLUMNS") key = "FIELDS";
      if (key != "VERSION" && key != "FIELDS" && key != "SIZE" && key != "TYPE" && key != "COUNT" &&
          key != "WIDTH" && key != "HEIGHT" && key != "VIEWPOINT" && key != "POINTS" &&
          key != "DATA") {
        Fail("is no PCD file: a header line begins with none of its keys");
      }
      if (!lines_.emplace(key, std::vector(words.begin() + 1, words.end())).second) {
        Fail(key + ": comes twice");
      }
      if (key != "DATA") continue;
      data_begin_ = size - rest_.size();
      return;
    }
    Fail("is no PCD file: its header has no DATA line");
  }

  [[noreturn]] void Fail(const std::string& rule) const { throw InputError(file_ + ": " + rule); }

  [[nodiscard]] bool Has(const std::string& key) const { return lines_.contains(key); }

  [[nodiscard]] const std::vector<std::string_view>& Entries(const std::string& key) const {
    const auto line = lines_.find(key);
    if (line == lines_.end()) Fail(key + ": missing");
    return line->second;
  }

  [[nodiscard]] std::uint64_t Number(const std::string& key) const {
    const auto& words = Entries(key);
    if (words.size() != 1) Fail(key + ": must be one number");
    return Number(key, words[0]);
  }

  [[nodiscard]] std::uint64_t Number(const std::string& key, std::string_view word) const {
    const auto number = ParseTextNumber<std::uint64_t>(word);
    if (!number || *number > kMaxCloudBytes) {
      Fail(key + ": must be a whole number below 2^32 (got " + ShownText(word) + ")");
    }
    return *number;
  }

  [[nodiscard]] std::size_t data_begin() const { return data_begin_; }

 private:
  const std::string& file_;
  std::string_view rest_;
  std::map<std::string, std::vector<std::string_view>> lines_;
  std::size_t data_begin_{};
};

/// The type that a letter of TYPE and a size in bytes stand for.
NumberType TypeOf(const HeaderReader& reader, std::string_view word, std::uint64_t size) {
  const std::string letter(1, word.size() == 1 ? UpperLetter(word[0]) : ' ');
  if (letter != "I" && letter != "U" && letter != "F") {
    reader.Fail("TYPE: must be I, U or F (got " + ShownText(word) + ")");
  }
  for (int i = 1; i <= static_cast<int>(NumberType::kUint64); ++i) {
    const auto type = static_cast<NumberType>(i);
    if (letter[0] == PcdLetter(type) && size == SizeOf(type)) return type;
  }
  reader.Fail("SIZE: no " + letter + " has " + std::to_string(size) + " bytes");
}

/// Adds the fields to the cloud.
/// @return The bytes of a point, which point_step need not hold.
std::uint64_t ReadFields(const HeaderReader& reader, Cloud& cloud) {
  const auto& names = reader.Entries("FIELDS");
  if (names.empty()) reader.Fail("FIELDS: must name at least one field");
  for (const std::string key : {"SIZE", "TYPE", "COUNT"}) {
    if (key == "COUNT" && !reader.Has(key)) continue;
    const std::size_t count = reader.Entries(key).size();
    if (count != names.size()) {
      reader.Fail(key + ": must have " + std::to_string(names.size()) +
                  " entries, one for each of FIELDS (got " + std::to_string(count) + ")");
    }
  }
  std::uint64_t step = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::uint64_t size = reader.Number("SIZE", reader.Entries("SIZE")[i]);
    const std::uint64_t count =
        reader.Has("COUNT") ? reader.Number("COUNT", reader.Entries("COUNT")[i]) : 1;
    const NumberType type = TypeOf(reader, reader.Entries("TYPE")[i], size);
    if (count == 0) continue;  // It has no bytes and no words.
    cloud.AddField(std::string(names[i]), type, static_cast<std::uint32_t>(count));
    step += cloud.fields.back().num_bytes();
  }
  if (cloud.fields.empty()) reader.Fail("COUNT: must not be 0 for all of FIELDS");
  return step;
}

void CheckViewpoint(const HeaderReader& reader, const std::string& file, Cloud& cloud) {
  constexpr std::array<double, 7> kOrigin = {0, 0, 0, 1, 0, 0, 0};
  if (!reader.Has("VIEWPOINT")) return;
  const auto& words = reader.Entries("VIEWPOINT");
  bool is_origin = true;
  for (std::size_t i = 0; i < words.size() && i < kOrigin.size(); ++i) {
    const auto number = ParseTextNumber<double>(words[i]);
    if (!number) reader.Fail("VIEWPOINT: must have 7 numbers (got " + ShownText(words[i]) + ")");
    is_origin = is_origin && *number == kOrigin[i];
  }
  if (words.size() != kOrigin.size()) reader.Fail("VIEWPOINT: must have 7 numbers");
  if (!is_origin) AddRemark({.kind = RemarkKind::kViewpointUnused, .place = file}, cloud.remarks);
}

void ReadPcdLines(const HeaderReader& reader, const std::string& file, CloudFile& read) {
  const std::uint64_t num_points = read.cloud.num_points();
  std::uint64_t num_values = 0;
  for (const CloudField& field : read.cloud.fields) num_values += field.count;
  std::uint64_t num_lines = 0;
  std::string_view rest = read.points;
  while (const auto line = TakeLine(rest)) {
    const auto words = Words(*line);
    if (words.empty()) continue;
    // The data grow with the text, whatever the header says.
    if (!read.cloud.AppendWords(file, words)) {
      reader.Fail("a point has fewer values than FIELDS asks for");
    }
    if (words.size() > num_values) reader.Fail("a point has more values than FIELDS asks for");
    ++num_lines;
  }
  if (num_lines != num_points) {
    reader.Fail("POINTS: " + std::to_string(num_points) + " need as many lines, the file has " +
                std::to_string(num_lines));
  }
}

void ReadPcdText(const HeaderReader& reader, const std::string& file, CloudFile& read) {
  ReadPcdLines(reader, file, read);
  if (read.cloud.WidenRounded()) ReadPcdLines(reader, file, read);
}

/// Whether data have this size, or end in the zeros that PCL's writer of PCLPointCloud2 leaves
/// behind them, up to a page, or in the end of a line.
bool HasSize(std::string_view data, std::uint64_t expected) {
  constexpr std::size_t kMostPadding = 65536;  // The largest page that Linux has, on ARM.
  return data.size() >= expected && data.size() - expected <= kMostPadding &&
         data.find_first_not_of(std::string_view("\0\r\n", 3), expected) == std::string_view::npos;
}

void ReadBinary(const HeaderReader& reader, CloudFile& read) {
  const std::size_t num_points = read.cloud.num_points();
  const std::size_t expected = num_points * read.cloud.point_step;
  if (!HasSize(read.points, expected)) {
    reader.Fail("POINTS: " + std::to_string(num_points) + " need " + std::to_string(expected) +
                " bytes, the file has " + std::to_string(read.points.size()));
  }
  const auto* const rows = reinterpret_cast<const std::uint8_t*>(read.points.data());
  read.cloud.data.assign(rows, rows + expected);
}

void ReadCompressed(const HeaderReader& reader, CloudFile& read) {
  if (read.cloud.num_points() == 0) return;
  std::array<std::uint32_t, 2> sizes{};  // Sizes of the compressed and of the plain data.
  if (read.points.size() < sizeof sizes) reader.Fail("DATA: the compressed sizes are missing");
  std::memcpy(sizes.data(), read.points.data(), sizeof sizes);
  const auto [packed, plain] = sizes;
  const std::string_view data = read.points.substr(sizeof sizes);
  if (!HasSize(data, packed)) {
    reader.Fail("DATA: " + std::to_string(packed) + " compressed bytes announced, the file has " +
                std::to_string(data.size()));
  }
  const std::size_t num_points = read.cloud.num_points();
  const std::uint64_t expected = num_points * read.cloud.point_step;
  if (plain != expected) {
    reader.Fail("POINTS: " + std::to_string(num_points) + " need " + std::to_string(expected) +
                " bytes, the compressed data hold " + std::to_string(plain));
  }
  // Three bytes of LZF expand to at most 264, so a larger claim is false and must not be given
  // memory.
  constexpr std::uint32_t kMaxRatio = 88;
  if (plain / kMaxRatio > packed) reader.Fail("DATA: the compressed data are damaged");
  std::string by_field(plain, '\0');
  if (lzf_decompress(data.data(), packed, by_field.data(), plain) != plain) {
    reader.Fail("DATA: the compressed data are damaged");
  }
  read.cloud.data.resize(plain);
  Transpose(FieldSizes(read.cloud), num_points, by_field.data(), true, read.cloud.data.data());
}

}  // namespace

CloudFile ParsePcdFile(const std::string& file,
                       std::string_view bytes,
                       const std::optional<std::string>& /*second*/) {
  if (IsUtf16(bytes)) throw InputError(file + ": is UTF-16; save as UTF-8");
  bytes = WithoutMark(bytes);
  const HeaderReader reader(file, bytes);
  CloudFile read{.cloud = {},
                 .header = bytes.substr(0, reader.data_begin()),
                 .points = bytes.substr(reader.data_begin()),
                 .tail = {}};
  const std::uint64_t step = ReadFields(reader, read.cloud);
  const std::uint64_t width = reader.Number("WIDTH");
  const std::uint64_t height = reader.Number("HEIGHT");
  const std::uint64_t points = reader.Has("POINTS") ? reader.Number("POINTS") : width * height;
  const auto& data = reader.Entries("DATA");
  CheckViewpoint(reader, file, read.cloud);
  // Width and height are below 2^32 each, so their product cannot wrap.
  if (points != width * height) {
    reader.Fail("POINTS: must be WIDTH x HEIGHT (got " + std::to_string(points) + " for " +
                std::to_string(width) + " x " + std::to_string(height) + ")");
  }
  if (points > kMaxCloudBytes || step > kMaxCloudBytes / std::max<std::uint64_t>(1, points)) {
    reader.Fail("POINTS: " + std::to_string(points) + " points of " + std::to_string(step) +
                " bytes are 4 GiB or more");
  }
  read.cloud.width = static_cast<std::uint32_t>(width);
  read.cloud.height = static_cast<std::uint32_t>(height);
  const std::string encoding = data.size() == 1 ? LowerCase(data[0]) : "";
  if (encoding == "ascii") {
    read.storage = PointStorage::kText;
    ReadPcdText(reader, file, read);
  } else if (encoding == "binary") {
    ReadBinary(reader, read);
  } else if (encoding == "binary_compressed") {
    read.storage = PointStorage::kFields;
    ReadCompressed(reader, read);
  } else {
    reader.Fail("DATA: must be ascii, binary or binary_compressed");
  }
  return read;
}

}  // namespace railcast
