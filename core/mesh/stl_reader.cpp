#include "core/mesh/mesh_readers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_number.h"

namespace railcast {
namespace {

/// Whether a word is a keyword, which some programs write in capitals.
bool IsStlWord(std::string_view word, std::string_view keyword) {
  return std::ranges::equal(word, keyword, {}, [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
}

/// Reads the words of an ASCII STL file, which may be spread over lines in any way.
class AsciiStlReader {
 public:
  AsciiStlReader(const std::string& shown, std::string_view text) : shown_(shown), rest_(text) {}

  PolygonSoup Read() {
    for (; const auto line = TakeLine(rest_); ++line_) {
      const auto words = Words(*line);
      // What follows is a name, which may be anything.
      if (words.empty()) continue;
      const bool is_end =
          IsStlWord(words[0], "endsolid") ||
          (words.size() > 1 && IsStlWord(words[0], "end") && IsStlWord(words[1], "solid"));
      const bool begins = IsStlWord(words[0], "solid");
      if (is_end || begins || IsStlWord(words[0], "facet")) has_end_ = is_end;
      if (is_end || begins) continue;
      for (std::size_t i = 0; i < words.size(); ++i) {
        if (IsStlWord(words[i], "vertex")) ReadVertex(std::span(words).subspan(i + 1), *line);
        if (IsStlWord(words[i], "endloop")) EndLoop();
      }
    }
    if (!loop_.empty()) throw InputError(shown_ + ": ends within a facet");
    // Some programs leave it out.
    if (!has_end_) {
      AddRemark({.kind = RemarkKind::kRecordingCut, .place = {}, .detail = "it has no endsolid"},
                soup_.remarks);
    }
    return std::move(soup_);
  }

 private:
  [[noreturn]] void Fail(const std::string& rule, std::string_view got) const {
    throw InputError(shown_ + ": line " + std::to_string(line_) + ": " + rule + " (got \"" +
                     ShownText(got) + "\")");
  }

  void ReadVertex(std::span<const std::string_view> words, std::string_view line) {
    Vector3 point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view word = axis < words.size() ? words[axis] : std::string_view();
      const auto number = ParseTextNumber<double>(word);
      if (!number || !std::isfinite(*number)) {
        Fail("a vertex must have three finite coordinates", line);
      }
      point[static_cast<Eigen::Index>(axis)] = *number;
    }
    loop_.push_back(static_cast<std::uint32_t>(soup_.points.size()));
    soup_.points.push_back(point);
  }

  void EndLoop() {
    if (loop_.size() != 3) Fail("a facet must have three vertices", std::to_string(loop_.size()));
    soup_.AddFace(std::exchange(loop_, {}));
  }

  const std::string& shown_;
  std::string_view rest_;
  std::size_t line_ = 1;
  bool has_end_ = false;
  PolygonSoup soup_;
  std::vector<std::uint32_t> loop_;
};

}  // namespace

std::uint32_t NumBinaryTriangles(const std::string& bytes) {
  std::uint32_t num = 0;
  if (bytes.size() >= kStlHeaderBytes) std::memcpy(&num, bytes.data() + 80, sizeof(num));
  return num;
}

bool IsBinaryStl(const std::string& bytes) {
  if (bytes.size() < kStlHeaderBytes) return false;
  const std::size_t num_bytes = kStlHeaderBytes + kStlTriangleBytes * NumBinaryTriangles(bytes);
  return bytes.size() >= num_bytes &&
         bytes.find_first_not_of(" \t\r\n", num_bytes) == std::string::npos;
}

PolygonSoup ReadBinaryStl(const std::string& shown, const std::string& bytes) {
  constexpr std::size_t kNormalBytes = 12;
  using Corner = std::array<float, 3>;
  PolygonSoup soup;
  std::map<Corner, std::uint32_t> index_of;
  const std::size_t num_bytes = kStlHeaderBytes + kStlTriangleBytes * NumBinaryTriangles(bytes);
  AddRemark({.kind = RemarkKind::kSurplusBytes, .place = {}, .number = bytes.size() - num_bytes},
            soup.remarks);
  for (std::size_t i = 0; i < NumBinaryTriangles(bytes); ++i) {
    std::array<Corner, 3> corners{};
    std::memcpy(corners.data(),
                bytes.data() + kStlHeaderBytes + i * kStlTriangleBytes + kNormalBytes,
                sizeof corners);
    std::vector<std::uint32_t> face;
    for (const Corner& corner : corners) {
      for (const float value : corner) {
        if (std::isfinite(value)) continue;
        throw InputError(shown + ": triangle " + std::to_string(i) +
                         " must have finite coordinates" + Got(value));
      }
      const auto next = static_cast<std::uint32_t>(soup.points.size());
      const auto [known, is_new] = index_of.try_emplace(corner, next);
      if (is_new) soup.points.emplace_back(corner[0], corner[1], corner[2]);
      face.push_back(known->second);
    }
    // Others have no area, and do not count as faces.
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) {
      soup.AddFace(std::move(face));
    }
  }
  return soup;
}

PolygonSoup ReadAsciiStl(const std::string& shown, const std::string& bytes) {
  return AsciiStlReader(shown, bytes).Read();
}

}  // namespace railcast
