#include "core/mesh/mesh_readers.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_number.h"

namespace railcast {
namespace {

/// The lines of a file that say something.
class Lines {
 public:
  explicit Lines(std::string_view bytes) : rest_(bytes) {}

  /// Goes on to the next line with words other than a comment; false if there is none.
  bool Next() {
    do {
      const auto line = TakeLine(rest_);
      if (!line) return false;
      ++number_;
      words_ = Words(line->substr(0, line->find('#')));
    } while (words_.empty());
    return true;
  }

  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  [[nodiscard]] std::size_t number() const { return number_; }
  [[nodiscard]] std::size_t num_bytes_left() const { return rest_.size(); }
  void DropFirstWord() { words_.erase(words_.begin()); }

 private:
  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::size_t number_ = 0;
};

bool IsKeyword(std::string_view word) {
  return word.ends_with("OFF") &&
         word.substr(0, word.size() - 3).find_first_not_of("STCN4n") == std::string_view::npos;
}

class OffReader {
 public:
  OffReader(const std::string& shown, std::string_view bytes, double largest)
      : shown_(shown), lines_(bytes), largest_(largest), faults_(shown) {}

  PolygonSoup Read() {
    ReadCounts();
    for (std::size_t i = 0; i < num_vertices_; ++i) {
      NextLine();
      faults_.Try([&] { ReadVertex(); });
    }
    for (std::size_t i = 0; i < num_faces_; ++i) {
      NextLine();
      faults_.Try([&] { ReadFace(); });
    }
    if (lines_.Next()) faults_.Try([&] { Fail("must end behind its faces", lines_.words()[0]); });
    faults_.ThrowIfAny();
    return std::move(soup_);
  }

 private:
  [[noreturn]] void Fail(const std::string& rule, std::string_view got) const {
    throw InputError(shown_ + ": line " + std::to_string(lines_.number()) + ": " + rule +
                     " (got \"" + ShownText(got) + "\")");
  }

  void NextLine() {
    if (lines_.Next()) return;
    faults_.Try([&] {
      throw InputError(shown_ + ": ends within its " + std::to_string(num_vertices_) +
                       " vertices and " + std::to_string(num_faces_) + " faces");
    });
    faults_.ThrowIfAny();
  }

  template <typename Number>
  [[nodiscard]] Number NumberAt(std::size_t i, const char* rule) const {
    const std::string_view word = i < lines_.words().size() ? lines_.words()[i] : "";
    const auto number = ParseTextNumber<Number>(word);
    if (!number) Fail(rule, word);
    return *number;
  }

  /// The keyword and, in the same line or in the next, the numbers of vertices and faces.
  void ReadCounts() {
    NextLine();
    const std::string_view keyword = lines_.words()[0];
    if (keyword.find_first_of("4n") != std::string_view::npos) {
      Fail("vertices must have three coordinates", keyword);
    }
    lines_.DropFirstWord();
    if (lines_.words().empty()) NextLine();
    constexpr const char* kRule = "must give the numbers of vertices and faces";
    num_vertices_ = NumberAt<std::uint32_t>(0, kRule);
    num_faces_ = NumberAt<std::uint32_t>(1, kRule);
  }

  void ReadVertex() {
    constexpr const char* kRule = "a vertex must have three finite coordinates";
    // Behind the coordinates may be a normal or a colour.
    if (words_of_vertex_ == 0) words_of_vertex_ = lines_.words().size();
    if (lines_.words().size() != words_of_vertex_) {
      Fail("a vertex must have as many numbers as the first", NumberText(lines_.words().size()));
    }
    Vector3 point;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      point[axis] = NumberAt<double>(i, kRule);
      if (!(std::abs(point[axis]) <= largest_)) Fail(kRule, lines_.words()[i]);
    }
    soup_.points.push_back(point);
  }

  void ReadFace() {
    const auto num = NumberAt<std::uint32_t>(0, "a face must begin with its number of corners");
    if (num >= lines_.words().size()) Fail("a face must name its corners", lines_.words()[0]);
    std::vector<std::uint32_t> corners;
    const std::string rule = "a face must name one of the " + std::to_string(num_vertices_) +
                             " vertices, counted from 0";
    for (std::size_t i = 1; i <= num; ++i) {
      const auto corner = NumberAt<std::uint32_t>(i, rule.c_str());
      if (corner >= num_vertices_) Fail(rule, lines_.words()[i]);
      corners.push_back(corner);
    }
    soup_.AddFace(std::move(corners));
  }

  const std::string& shown_;
  Lines lines_;
  double largest_;
  LineFaults faults_;
  std::size_t num_vertices_ = 0;
  std::size_t num_faces_ = 0;
  std::size_t words_of_vertex_ = 0;
  PolygonSoup soup_;
};

}  // namespace

bool IsOff(std::string_view bytes) {
  Lines lines(bytes);
  return lines.Next() && IsKeyword(lines.words()[0]);
}

PolygonSoup ReadOff(const std::string& shown, std::string_view bytes, double largest) {
  return OffReader(shown, bytes, largest).Read();
}

}  // namespace railcast
