#include "core/mesh/mesh_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/base/text_encoding.h"
#include "core/mesh/mesh_readers.h"

namespace railcast {
namespace {

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
  // UTF-16 has two bytes for each letter.
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
  const std::size_t first = begin.find_first_not_of(" \t\r\n");
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

}  // namespace railcast
