#include "generator/import/map/map_formats.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

namespace railcast {
namespace {

// The wire types of protocol buffers that the format uses.
constexpr std::uint64_t kVarint = 0;
constexpr std::uint64_t kBytes = 2;

/// Takes the next number; absent if the bytes end before it does.
std::optional<std::uint64_t> TakeVarint(std::string_view& bytes) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64 && !bytes.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if (byte < 0x80) return value;
  }
  return std::nullopt;
}

/// A field of a message: a number, or the length of its bytes.
struct PbfField {
  std::uint64_t number{};
  bool is_bytes{};
  std::uint64_t value{};
};

std::optional<PbfField> TakeField(std::string_view& bytes) {
  const auto key = TakeVarint(bytes);
  if (!key || ((*key & 7U) != kVarint && (*key & 7U) != kBytes)) return std::nullopt;
  const auto value = TakeVarint(bytes);
  if (!value) return std::nullopt;
  return PbfField{*key >> 3U, (*key & 7U) == kBytes, *value};
}

/// The field `datasize` of a blob's header.
std::optional<std::uint64_t> BlobSizeIn(std::string_view header) {
  constexpr std::uint64_t kDataSize = 3;
  while (const auto field = TakeField(header)) {
    if (!field->is_bytes && field->number == kDataSize) return field->value;
    if (!field->is_bytes) continue;
    if (field->value > header.size()) return std::nullopt;
    header.remove_prefix(field->value);
  }
  return std::nullopt;
}

/// The name of a compression that GDAL does not read; empty if it reads the blob, or cannot know.
std::string_view UnreadCompressionOf(std::string_view blob_begin) {
  constexpr std::array<std::string_view, 8> kCompressions = {"",     "",      "",    "",
                                                             "lzma", "bzip2", "lz4", "zstd"};
  while (const auto field = TakeField(blob_begin)) {
    // Before the data stands their length, at most.
    if (field->is_bytes) {
      return field->number < kCompressions.size() ? kCompressions[field->number] : "";
    }
  }
  return "";
}

}  // namespace

bool IsPbf(std::string_view begin) {
  // The length of a header, its first field, the length of this, and the text.
  constexpr std::size_t kTextAt = 6;
  constexpr std::string_view kText = "OSMHeader";
  return begin.size() > kTextAt && begin.substr(kTextAt).starts_with(kText);
}

void CheckPbfBlobs(const std::filesystem::path& file) {
  constexpr std::uint64_t kLongestHeader = 64 * 1024;
  constexpr std::size_t kLengthBytes = 4;
  constexpr std::size_t kBlobBegin = 32;
  std::ifstream stream = OpenInput(file);
  std::string bytes;
  const auto take = [&](std::size_t num) {
    bytes.resize(num);
    stream.read(bytes.data(), static_cast<std::streamsize>(num));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes.size() == num;
  };
  for (int blob = 1; take(kLengthBytes); ++blob) {
    std::uint64_t length = 0;
    for (const char byte : bytes) length = length << 8U | static_cast<unsigned char>(byte);
    if (length > kLongestHeader || !take(length)) return;
    const auto size = BlobSizeIn(bytes);
    if (!size) return;
    const std::streamoff begin = stream.tellg();
    take(kBlobBegin);
    const std::string_view compression = UnreadCompressionOf(bytes);
    if (!compression.empty()) {
      throw InputError(ShownPath(file) + ": blob " + std::to_string(blob) +
                       ": must be compressed with zlib, or not at all (got " +
                       std::string(compression) + ")");
    }
    stream.clear();
    stream.seekg(begin + static_cast<std::streamoff>(*size));
  }
}

}  // namespace railcast
