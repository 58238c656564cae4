#include "core/mesh/mesh_readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <istream>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_number.h"
#include "core/mesh/polygon_soup.h"

namespace railcast {
namespace {

/// The luminance in a Kd line; nothing of one by a spectrum or CIE XYZ.
std::optional<double> LuminanceOfKd(const std::vector<std::string_view>& words,
                                    std::string_view line,
                                    const std::string& place) {
  if (words.size() > 1 && (words[1] == "spectral" || words[1] == "xyz")) return std::nullopt;
  std::array<double, 3> parts{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // "If only r is given, g and b are as r."
    const std::string_view word = i + 1 < words.size() ? words[i + 1]
                                  : words.size() == 2  ? words[1]
                                                       : std::string_view();
    const auto number = ParseTextNumber<double>(word);
    if (!number || !(*number >= 0.0 && *number <= 1.0)) {
      throw InputError(place + ": Kd must be three numbers from 0 to 1 (got \"" + ShownText(line) +
                       "\")");
    }
    parts[i] = *number;
  }
  return LuminanceOf(parts[0], parts[1], parts[2]);
}

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view NextToken(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const std::string_view token = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(token.size());
  return token;
}

/// The rest of a line as a name, which may contain blanks. Without one, what the line before it
/// began ends.
std::string Name(std::string_view rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  return std::string(rest.substr(0, rest.find_last_not_of(kBlanks) + 1));
}

/// The names of files in a text, without quotes about them and backslashes before blanks.
/// @param divides Whether other blanks divide names; otherwise there is one.
std::vector<std::string> NamesIn(std::string_view text, bool divides) {
  std::vector<std::string> names(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_blank = kBlanks.find(text[i]) != std::string_view::npos;
    const bool is_escape = text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ' ';
    if (text[i] == '"') {
      is_quoted = !is_quoted;
    } else if (is_blank && divides && !is_quoted) {
      if (!names.back().empty()) names.emplace_back();
    } else {
      names.back() += text[is_escape ? ++i : i];
    }
  }
  return names;
}

/// Whether a line holds a vertex, a face or the like, rather than a name.
bool IsGeometry(std::string_view line) {
  const std::string_view keyword = NextToken(line);
  return keyword != "usemtl" && keyword != "g" && keyword != "o" && keyword != "mtllib";
}

}  // namespace

std::vector<std::vector<std::string>> MaterialLibrariesOf(const std::string& obj) {
  std::vector<std::vector<std::string>> lines;
  std::string_view rest = obj;
  while (const auto line = TakeLine(rest)) {
    // Most lines are of coordinates and faces.
    if (line->find("mtllib") == std::string_view::npos) continue;
    const auto words = Words(*line);
    if (words.size() < 2 || words[0] != "mtllib") continue;
    const std::string_view rest_of_line(words[0].end(), line->end());
    const std::string whole = Name(rest_of_line.substr(0, rest_of_line.find(" #")));
    std::vector<std::string>& names = lines.emplace_back();
    names = NamesIn(whole, false);
    const std::vector<std::string> several = NamesIn(whole, true);
    if (several.size() > 1) names.insert(names.end(), several.begin(), several.end());
  }
  return lines;
}

void ReadMtl(const std::string& shown,
             const std::string& bytes,
             std::map<std::string, std::optional<double>>& luminances) {
  LineFaults faults(shown);
  std::map<std::string, std::optional<double>> found;
  std::set<std::string> pictured;
  std::string material;
  std::string_view rest = bytes;
  for (std::size_t number = 1; const auto line = TakeLine(rest); ++number) {
    const auto words = Words(*line);
    if (words.empty()) continue;
    if (words[0] == "newmtl") {
      material = Name({words[0].end(), line->end()});
      found.try_emplace(material);
    }
    if (words[0] == "map_Kd") pictured.insert(material);
    if (words[0] != "Kd") continue;
    faults.Try([&] {
      const auto luminance =
          LuminanceOfKd(words, *line, shown + ": line " + std::to_string(number));
      if (!found[material]) found[material] = luminance;
    });
  }
  faults.ThrowIfAny();
  for (const auto& [name, luminance] : found) {
    luminances.try_emplace(name, pictured.contains(name) ? std::nullopt : luminance);
  }
}

ObjReader::ObjReader(std::string shown, double largest)
    : shown_(std::move(shown)), largest_(largest), faults_(shown_) {}

PolygonSoup ObjReader::Read(std::istream& in) {
  std::string line;
  while (ReadLogicalLine(in, line)) {
    std::string_view rest = line;
    const std::string_view keyword = NextToken(rest);
    faults_.Try([&] { ReadKeyword(keyword, rest); });
  }
  // Faces may name vertices that come later, so that the highest index can be checked only here.
  if (highest_index_ > static_cast<int>(soup_.points.size())) {
    line_ = highest_index_line_;
    faults_.Try([&] { FailIndex(std::to_string(highest_index_)); });
  }
  faults_.ThrowIfAny();
  return std::move(soup_);
}

void ObjReader::ReadKeyword(std::string_view keyword, std::string_view rest) {
  if (keyword == "v") ReadVertex(rest);
  if (keyword == "f") ReadFace(rest);
  if (keyword == "usemtl") material_ = materials_.Of(Name(rest));
  if (keyword == "g" || keyword == "o") group_ = groups_.Of(Name(rest));
  if (keyword.empty() || keyword.starts_with('#')) return;
  // Free-form surfaces and misspelt words are none of these.
  constexpr auto kKnown = std::to_array<std::string_view>(
      {"v",     "f",        "usemtl",   "g",   "o",  "mtllib",     "vt",
       "vn",    "vp",       "s",        "l",   "p",  "usemap",     "maplib",
       "bevel", "c_interp", "d_interp", "lod", "mg", "shadow_obj", "trace_obj"});
  if (std::ranges::find(kKnown, keyword) != kKnown.end()) return;
  AddRemark({.kind = RemarkKind::kExtensionUnread, .place = {}, .detail = ShownText(keyword)},
            soup_.remarks);
}

/// Reads a line, joined with the next if it ends with a backslash.
bool ObjReader::ReadLogicalLine(std::istream& in, std::string& line) {
  line_ = next_line_;
  line.clear();
  std::string piece;
  bool any = false;
  while (std::getline(in, piece)) {
    any = true;
    ++next_line_;
    if (piece.ends_with('\r')) piece.pop_back();
    line += piece;
    // In comments and names it is a letter like any other.
    if (!line.ends_with('\\') || line.find('#') != std::string::npos || !IsGeometry(line))
      return true;
    line.back() = ' ';
  }
  return any;
}

void ObjReader::ReadVertex(std::string_view rest) {
  // One with a fault counts, too: faces would name others than they mean.
  Vector3& point = soup_.points.emplace_back(Vector3::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view token = NextToken(rest);
    const std::optional<double> number = ParseTextNumber<double>(token);
    if (!number || !(std::abs(*number) <= largest_)) {
      Fail("a vertex must have three finite coordinates", token);
    }
    point[axis] = *number;
  }
}

void ObjReader::ReadFace(std::string_view rest) {
  std::vector<std::uint32_t> corners;
  rest = rest.substr(0, rest.find('#'));
  for (std::string_view token = NextToken(rest); !token.empty(); token = NextToken(rest)) {
    corners.push_back(static_cast<std::uint32_t>(VertexOf(token)) - 1);
  }
  soup_.AddFace(std::move(corners), material_, group_);
}

/// The vertex index of a face corner: 1 is the first vertex, and -1 is the last one read so far.
int ObjReader::VertexOf(std::string_view corner) {
  const std::string_view index = corner.substr(0, corner.find('/'));
  const std::optional<int> number = ParseTextNumber<int>(index);
  if (!number) Fail("a face must name vertices by number", corner);
  const auto num_vertices = static_cast<int>(soup_.points.size());
  if (*number == 0 || *number < -num_vertices) FailIndex(index);
  if (*number > highest_index_) {
    highest_index_ = *number;
    highest_index_line_ = line_;
  }
  return *number > 0 ? *number : num_vertices + 1 + *number;
}

void ObjReader::FailIndex(std::string_view index) const {
  Fail("a face must name one of the " + std::to_string(soup_.points.size()) + " vertices", index);
}

void ObjReader::Fail(const std::string& rule, std::string_view got) const {
  throw InputError(shown_ + ": line " + std::to_string(line_) + ": " + rule + " (got \"" +
                   ShownText(got) + "\")");
}

}  // namespace railcast
