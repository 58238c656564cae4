#include "generator/import/map/map_formats.h"

#include <expat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// The parts of a text between any of some separators; empty parts count unless `joins_empty`.
std::vector<std::string_view> Parts(std::string_view text,
                                    std::string_view separators,
                                    bool joins_empty) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (end > 0 || !joins_empty) parts.push_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

/// XML schemas allow a sign, and blanks about numbers.
std::optional<double> XmlNumber(std::string_view text) {
  text = Trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  return NumberIn(text);
}

/// The value of an attribute; null if there is none.
const char* ValueOf(const char** attributes, std::string_view name) {
  for (; *attributes != nullptr; attributes += 2) {
    if (name == *attributes) return attributes[1];
  }
  return nullptr;
}

/// A name without the prefix of its namespace.
std::string_view LocalName(std::string_view name) {
  return name.substr(name.find(':') + 1);
}

/// Takes the elements of a file one by one.
class XmlPlaceCheck {
 public:
  explicit XmlPlaceCheck(XML_Parser parser) : parser_(parser) {}

  void Begin(std::string_view name, const char** attributes);
  void Take(std::string_view text) {
    if (takes_text_) text_ += text;
  }
  void End(std::string_view name);
  /// Finds what only the whole file shows.
  void Finish();
  [[nodiscard]] ErrorList& errors() { return errors_; }

 private:
  using Line = std::uint64_t;
  struct ElementId {
    std::string id;  ///< With its kind: "node 12".
    Line line{};
  };

  [[nodiscard]] Line line() const { return XML_GetCurrentLineNumber(parser_); }
  void AddFault(Line line, const std::string& what, std::string rule, std::string got) {
    errors_.Add({"line " + std::to_string(line) + ", " + what, std::move(rule), std::move(got)});
  }
  void CheckDegrees(std::string_view element,
                    std::string_view key,
                    const char* value,
                    double most_deg);
  void CheckTuple(std::string_view tuple, Line line, std::string_view separators);
  /// Whether a point's line has heights must be the same for all of its points.
  void AddToLine(Line line, std::string_view element, bool has_height);

  XML_Parser parser_;
  ErrorList errors_;
  std::vector<ElementId> ids_;  ///< Of nodes and ways.
  bool takes_text_ = false;
  std::string text_;
  Line text_line_{};
  bool point_has_height_ = false;
  Line point_line_{};
  std::optional<bool> line_has_heights_;
};

/// The points of GPX.
bool IsGpxPoint(std::string_view name) {
  return name == "trkpt" || name == "rtept" || name == "wpt";
}

/// Elements of which each is a line with points of its own.
bool IsPointList(std::string_view name) {
  return name == "trkseg" || name == "rte" || name == "coordinates" || name == "Track";
}

void XmlPlaceCheck::CheckDegrees(std::string_view element,
                                 std::string_view key,
                                 const char* value,
                                 double most_deg) {
  const std::optional<double> value_deg = value == nullptr ? std::nullopt : XmlNumber(value);
  if (value_deg && std::abs(*value_deg) <= most_deg) return;
  AddFault(line(), std::string(element) + "/" + std::string(key), DegreesRule(most_deg),
           value == nullptr ? "none" : Quoted(value));
}

void XmlPlaceCheck::AddToLine(Line line, std::string_view element, bool has_height) {
  if (!line_has_heights_) line_has_heights_ = has_height;
  if (*line_has_heights_ == has_height) return;
  AddFault(line, std::string(element), "must have a height if other points of its line do",
           has_height ? "one, but others have none" : "none");
}

void XmlPlaceCheck::CheckTuple(std::string_view tuple, Line line, std::string_view separators) {
  const std::string shown = Quoted(tuple);
  const std::vector<std::string_view> parts = Parts(tuple, separators, false);
  const bool has_height = parts.size() == 3;
  bool is_place = parts.size() == 2 || has_height;
  constexpr std::array kMost = {kMostLongitude_deg, kMostLatitude_deg};
  for (std::size_t i = 0; i < parts.size() && is_place; ++i) {
    const std::optional<double> value = XmlNumber(parts[i]);
    is_place = value && (i >= kMost.size() || std::abs(*value) <= kMost[i]);
  }
  if (is_place) return AddToLine(line, "coordinates", has_height);
  AddFault(line, "coordinates", "must be longitude, latitude in degrees and, if known, height in m",
           shown);
}

void XmlPlaceCheck::Begin(std::string_view full_name, const char** attributes) {
  const std::string_view name = LocalName(full_name);
  if (IsPointList(name)) line_has_heights_.reset();
  const auto check_place = [&] {
    CheckDegrees(name, "lon", ValueOf(attributes, "lon"), kMostLongitude_deg);
    CheckDegrees(name, "lat", ValueOf(attributes, "lat"), kMostLatitude_deg);
  };
  if (IsGpxPoint(name)) {
    check_place();
    point_line_ = line();
    point_has_height_ = false;
  } else if (name == "node") {
    // JOSM and histories keep what was deleted, without a place.
    const char* visible = ValueOf(attributes, "visible");
    if (visible == nullptr || std::strcmp(visible, "false") != 0) check_place();
  }
  const char* id = ValueOf(attributes, "id");
  if (id != nullptr && (name == "node" || name == "way")) {
    ids_.push_back({std::string(name) + " " + id, line()});
  }
  takes_text_ = name == "ele" || name == "coordinates" || name == "coord";
  text_.clear();
  text_line_ = line();
}

void XmlPlaceCheck::End(std::string_view full_name) {
  const std::string_view name = LocalName(full_name);
  if (takes_text_ && name == "ele") {
    point_has_height_ = true;
    if (!XmlNumber(text_)) AddFault(text_line_, "ele", "must be a number of metres", Quoted(text_));
  } else if (takes_text_ && name == "coordinates") {
    Line line = text_line_;
    for (const std::string_view row : Parts(text_, "\n", false)) {
      for (const std::string_view tuple : Parts(row, kBlanks, true)) CheckTuple(tuple, line, ",");
      ++line;
    }
  } else if (takes_text_ && name == "coord") {
    CheckTuple(Trimmed(text_), text_line_, " ");
  } else if (name == "trkpt" || name == "rtept") {
    AddToLine(point_line_, name, point_has_height_);
  }
  takes_text_ = false;
}

void XmlPlaceCheck::Finish() {
  std::ranges::stable_sort(ids_, {}, &ElementId::id);
  for (std::size_t i = 1; i < ids_.size(); ++i) {
    if (ids_[i].id != ids_[i - 1].id) continue;
    AddFault(ids_[i].line, ShownText(ids_[i].id), "must be there once",
             "also in line " + std::to_string(ids_[i - 1].line));
  }
}

using XmlParser = std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)>;

/// Letters beyond ASCII do not matter to numbers, so that any encoding that contains ASCII will do.
int XMLCALL TakeAnyEncoding(void* /*data*/, const char* /*name*/, XML_Encoding* encoding) {
  constexpr int kReplacement = 0xFFFD;
  for (int byte = 0; byte < 256; ++byte) encoding->map[byte] = byte < 0x80 ? byte : kReplacement;
  encoding->data = nullptr;
  encoding->convert = nullptr;
  encoding->release = nullptr;
  return XML_STATUS_OK;
}

}  // namespace

void CheckXmlPlaces(const std::filesystem::path& file) {
  std::ifstream stream = OpenInput(file);
  const XmlParser parser(XML_ParserCreate(nullptr), &XML_ParserFree);
  XmlPlaceCheck check(parser.get());
  XML_SetUserData(parser.get(), &check);
  XML_SetUnknownEncodingHandler(parser.get(), TakeAnyEncoding, nullptr);
  XML_SetElementHandler(
      parser.get(),
      [](void* data, const char* name, const char** attributes) {
        static_cast<XmlPlaceCheck*>(data)->Begin(name, attributes);
      },
      [](void* data, const char* name) { static_cast<XmlPlaceCheck*>(data)->End(name); });
  XML_SetCharacterDataHandler(parser.get(), [](void* data, const char* text, int length) {
    static_cast<XmlPlaceCheck*>(data)->Take({text, static_cast<std::size_t>(length)});
  });
  constexpr std::size_t kBlock = 1 << 16;
  std::vector<char> block(kBlock);
  bool is_last = false;
  while (!is_last) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    is_last = !stream;
    if (XML_Parse(parser.get(), block.data(), static_cast<int>(stream.gcount()), is_last ? 1 : 0) ==
        XML_STATUS_ERROR) {
      check.errors().Add({"line " + std::to_string(XML_GetCurrentLineNumber(parser.get())),
                          "must be XML to its end",
                          XML_ErrorString(XML_GetErrorCode(parser.get()))});
      break;
    }
  }
  check.Finish();
  AtPlace(ShownPath(file) + ": ", [&] { check.errors().ThrowIfAny(); });
}

}  // namespace railcast
