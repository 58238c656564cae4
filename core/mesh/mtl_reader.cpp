#include "core/mesh/mtl_reader.h"

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_cursor.h"
#include "core/mesh/face_colors.h"
#include "core/mesh/line_faults.h"

namespace railcast {
namespace {

/// What follows a line's first word, without blanks at its ends, as ObjReader reads names.
std::string RestOf(std::string_view line, std::string_view word) {
  constexpr std::string_view kSpaces = " \t\r\v\f";
  line.remove_prefix(static_cast<std::size_t>(word.data() - line.data()) + word.size());
  const std::size_t first = line.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) return "";
  return std::string(line.substr(first, line.find_last_not_of(kSpaces) - first + 1));
}

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
    const auto number = ParseSignedNumber<double>(word);
    if (!number || !(*number >= 0.0 && *number <= 1.0)) {
      throw InputError(place + ": Kd must be three numbers from 0 to 1 (got \"" + ShownText(line) +
                       "\")");
    }
    parts[i] = *number;
  }
  return LuminanceOf(parts[0], parts[1], parts[2]);
}

}  // namespace

std::vector<std::string> MaterialLibrariesOf(const std::string& obj) {
  std::vector<std::string> names;
  std::string_view rest = obj;
  while (const auto line = TakeLine(rest)) {
    // Most lines are of coordinates and faces.
    if (line->find("mtllib") == std::string_view::npos) continue;
    const auto words = Words(*line);
    if (words.size() < 2 || words[0] != "mtllib") continue;
    names.push_back(RestOf(*line, words[0]));
    if (words.size() > 2) names.insert(names.end(), words.begin() + 1, words.end());
  }
  return names;
}

void ReadMtl(const std::string& shown,
             const std::string& bytes,
             std::map<std::string, double>& luminances) {
  LineFaults faults(shown);
  std::map<std::string, double> found;
  std::set<std::string> pictured;
  std::string material;
  std::string_view rest = bytes;
  for (std::size_t number = 1; const auto line = TakeLine(rest); ++number) {
    const auto words = Words(*line);
    if (words.empty()) continue;
    if (words[0] == "newmtl") material = RestOf(*line, words[0]);
    if (words[0] == "map_Kd") pictured.insert(material);
    if (words[0] != "Kd") continue;
    faults.Try([&] {
      const auto luminance =
          LuminanceOfKd(words, *line, shown + ": line " + std::to_string(number));
      if (luminance) found.try_emplace(material, *luminance);
    });
  }
  faults.ThrowIfAny();
  for (const auto& [name, luminance] : found) {
    if (!pictured.contains(name)) luminances.try_emplace(name, luminance);
  }
}

}  // namespace railcast
