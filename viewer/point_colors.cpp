#include "viewer/point_colors.h"

#include <cmath>
#include <map>

namespace railcast {
namespace {

constexpr Rgb kNoValue = {110, 110, 110};

std::vector<Rgb> ColorsOf(const CategoryColoring& coloring) {
  std::map<double, Rgb> rgb_of;
  for (const Category& category : coloring.categories) rgb_of[category.value] = category.rgb;
  std::vector<Rgb> colors;
  colors.reserve(coloring.values.size());
  for (const double value : coloring.values) colors.push_back(rgb_of.at(value));
  return colors;
}

std::vector<Rgb> ColorsOf(const ScalarColoring& coloring) {
  const double span = coloring.highest - coloring.lowest;
  std::vector<Rgb> colors;
  colors.reserve(coloring.values.size());
  for (const double value : coloring.values) {
    const double place = span > 0.0 ? (value - coloring.lowest) / span : 0.5;
    colors.push_back(std::isfinite(value) ? ScaleColor(place) : kNoValue);
  }
  return colors;
}

}  // namespace

std::vector<Rgb> PointColors(const Coloring& coloring) {
  return std::visit([](const auto& kind) { return ColorsOf(kind); }, coloring);
}

}  // namespace railcast
