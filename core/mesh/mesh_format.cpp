#include "core/mesh/mesh_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/mesh/mesh_readers.h"

namespace railcast {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::string_view kWordBreaks = " \t\r\n\v\f";

/// The first `length` bytes.
std::string_view Begin(std::string_view bytes, std::size_t length) {
  return bytes.substr(0, std::min(length, bytes.size()));
}

std::string_view FirstWord(std::string_view bytes) {
  bytes.remove_prefix(std::min(bytes.find_first_not_of(kWordBreaks), bytes.size()));
  return bytes.substr(0, bytes.find_first_of(kWordBreaks));
}

/// Whether a line begins with a word.
bool HasWord(std::string_view bytes, std::string_view word) {
  for (std::size_t begin = bytes.find('\n'); begin != std::string_view::npos;
       begin = bytes.find('\n', begin + 1)) {
    if (FirstWord(bytes.substr(begin)) == word) return true;
  }
  return false;
}

/// Whether a line begins with one of the keywords of an OBJ file's geometry.
bool HasObjLine(std::string_view bytes) {
  std::size_t begin = 0;
  while (begin < bytes.size()) {
    const std::string_view line = bytes.substr(begin, bytes.find('\n', begin) - begin);
    const std::string_view word = FirstWord(line);
    if (word == "v" || word == "f") return true;
    begin += line.size() + 1;
  }
  return false;
}

bool HasExtension(const std::filesystem::path& file, std::string_view lower) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return extension == lower;
}

std::optional<MeshFormat> SceneFormatOf(const std::string& bytes) {
  constexpr std::size_t kSearched = 4096;
  // UTF-16 has a zero in every other byte.
  const std::string text = AsUtf8(std::string(Begin(bytes, 2 * kSearched)));
  const std::string_view begin = Begin(text, kSearched);
  const auto holds = [&](std::string_view word) {
    return begin.find(word) != std::string_view::npos;
  };
  if (begin.starts_with("glTF")) return MeshFormat::kGlb;
  if (begin.starts_with("Kaydara FBX Binary") || (begin.starts_with(";") && holds("FBX"))) {
    return MeshFormat::kFbx;
  }
  if (begin.starts_with("MM") && bytes.size() >= 16) return MeshFormat::k3ds;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  const std::size_t first = begin.find_first_not_of(
      " \t\r\n", begin.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
  if (first == std::string_view::npos) return std::nullopt;
  if (begin[first] == '<' && holds("<COLLADA")) return MeshFormat::kDae;
  if (begin[first] == '{' && bytes.find("\"asset\"") != std::string::npos) {
    return MeshFormat::kGltf;
  }
  return std::nullopt;
}

/// Whether all whole triangles of a binary STL file, at least one, have coordinates as models have
/// them. What is not STL has numbers without any bound in their place.
bool HasLikelyTriangles(const std::string& bytes) {
  constexpr float kLargest = 1e6F;
  constexpr float kSmallest = 1e-20F;
  std::size_t place = kStlHeaderBytes;
  for (; place + kStlTriangleBytes <= bytes.size(); place += kStlTriangleBytes) {
    std::array<float, 12> numbers{};
    std::memcpy(numbers.data(), bytes.data() + place, sizeof(numbers));
    const bool are_likely = std::ranges::all_of(numbers, [](float number) {
      return number == 0.0F || (std::abs(number) >= kSmallest && std::abs(number) <= kLargest);
    });
    if (!are_likely) return false;
  }
  return place > kStlHeaderBytes;
}

/// Appends a code point. What is none in UTF-16 becomes the replacement character.
void AppendUtf8(std::uint32_t code, std::string& text) {
  constexpr std::array<std::uint32_t, 3> kFirstOfLength = {0x80, 0x800, 0x10000};
  if (code < kFirstOfLength[0]) {
    text += static_cast<char>(code);
    return;
  }
  const int num_more = code < kFirstOfLength[1] ? 1 : code < kFirstOfLength[2] ? 2 : 3;
  const std::uint32_t mark = (0xFF00U >> static_cast<unsigned>(num_more + 1)) & 0xFFU;
  text += static_cast<char>(mark | (code >> static_cast<unsigned>(6 * num_more)));
  for (int i = num_more - 1; i >= 0; --i) {
    text += static_cast<char>(0x80U | ((code >> static_cast<unsigned>(6 * i)) & 0x3FU));
  }
}

}  // namespace

std::optional<MeshFormat> MeshFormatOf(const std::string& bytes,
                                       const std::filesystem::path& file) {
  const std::string_view word = FirstWord(Begin(bytes, 1024));
  const bool is_solid = word == "solid" || word == "SOLID";
  if (IsBinaryStl(bytes)) return MeshFormat::kBinaryStl;
  if (word == "ply") return MeshFormat::kPly;
  if (is_solid &&
      (HasWord(Begin(bytes, 65536), "facet") || HasWord(Begin(bytes, 65536), "FACET"))) {
    return MeshFormat::kAsciiStl;
  }
  if (IsOff(Begin(bytes, 4096))) return MeshFormat::kOff;
  if (const auto scene = SceneFormatOf(bytes)) return scene;
  if (HasExtension(file, ".obj") || HasObjLine(bytes)) return MeshFormat::kObj;
  if (is_solid && !UnevenStlOf(bytes, file)) return MeshFormat::kAsciiStl;
  return std::nullopt;
}

std::optional<UnevenStl> UnevenStlOf(const std::string& bytes, const std::filesystem::path& file) {
  const bool is_text = bytes.find('\0') == std::string::npos;
  if (bytes.size() < kStlHeaderBytes || is_text) return std::nullopt;
  const std::size_t num_triangles = NumBinaryTriangles(bytes);
  const std::size_t num_bytes = kStlHeaderBytes + kStlTriangleBytes * num_triangles;
  const bool is_cut = num_bytes > bytes.size() && HasLikelyTriangles(bytes);
  if (!is_cut && !HasExtension(file, ".stl")) return std::nullopt;
  return UnevenStl{num_triangles, num_bytes};
}

std::string AsUtf8(std::string bytes) {
  const std::string_view begin = Begin(bytes, 2);
  const bool is_little = begin == "\xFF\xFE"sv || begin == "<\0"sv;
  const bool is_big = begin == "\xFE\xFF"sv || begin == "\0<"sv;
  if (!is_little && !is_big) return bytes;
  const auto unit_at = [&](std::size_t place) {
    const auto first = static_cast<unsigned char>(bytes[place]);
    const auto second = static_cast<unsigned char>(bytes[place + 1]);
    return static_cast<std::uint32_t>(is_little ? second << 8U | first : first << 8U | second);
  };
  std::string text;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit_at(i);
    if (i == 0 && code == 0xFEFF) continue;
    const bool is_high = code >= 0xD800 && code < 0xDC00;
    const std::uint32_t low = is_high && i + 3 < bytes.size() ? unit_at(i + 2) : 0;
    if (low >= 0xDC00 && low < 0xE000) {
      code = 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00);
      i += 2;
    } else if (code >= 0xD800 && code < 0xE000) {
      code = 0xFFFD;
    }
    AppendUtf8(code, text);
  }
  return text;
}

}  // namespace railcast
