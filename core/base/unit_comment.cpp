#include "core/base/unit_comment.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/base/text.h"

namespace railcast {
namespace {

struct Unit {
  double metres;
  std::array<std::string_view, 5> names;
};

constexpr std::array<Unit, 8> kUnits = {{
    {1e-6, {"micron", "microns", "micrometre", "micrometres", "micrometers"}},
    {0.001, {"mm", "millimetre", "millimetres", "millimeter", "millimeters"}},
    {0.01, {"cm", "centimetre", "centimetres", "centimeter", "centimeters"}},
    {0.1, {"dm", "decimetre", "decimetres", "decimeter", "decimeters"}},
    {1000.0, {"km", "kilometre", "kilometres", "kilometer", "kilometers"}},
    {0.0254, {"in", "inch", "inches"}},
    {0.3048, {"ft", "foot", "feet"}},
    {0.9144, {"yd", "yard", "yards"}},
}};

}  // namespace

std::optional<double> UnitOfComment_m(std::string_view comment) {
  constexpr auto kBetween =
      std::to_array<std::string_view>({"of", "length", "lengths", "is", "are", "in", "all", "x",
                                       "y", "z", "xyz", "positions", "coordinates", "distances"});
  std::string letters = LowerCase(comment);
  // A number is a word of its own, which names no unit.
  std::ranges::replace_if(
      letters, [](char c) { return (c < 'a' || c > 'z') && (c < '0' || c > '9'); }, ' ');
  const auto words = Words(letters);
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (*word != "unit" && *word != "units") continue;
    const auto said = std::find_if(word + 1, words.end(), [&](std::string_view next) {
      return std::ranges::find(kBetween, next) == kBetween.end();
    });
    // "units: in" ends with a word that else stands between.
    const std::string_view name = said != words.end() ? *said : words.back();
    for (const Unit& unit : kUnits) {
      if (std::ranges::find(unit.names, name) != unit.names.end()) return unit.metres;
    }
  }
  return std::nullopt;
}

}  // namespace railcast
