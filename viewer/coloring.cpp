#include "viewer/coloring.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/frame/outcome.h"

namespace railcast {
namespace {

// Viridis at 2/8, 3/8, ..., 1.
constexpr std::array<Rgb, 7> kViridis = {{{59, 81, 139},
                                          {44, 113, 142},
                                          {33, 144, 141},
                                          {39, 173, 129},
                                          {92, 200, 99},
                                          {170, 220, 50},
                                          {253, 231, 37}}};

// Okabe and Ito's palette, which the colour-blind can tell apart.
constexpr std::array<Rgb, 8> kPalette = {{{86, 180, 233},
                                          {230, 159, 0},
                                          {0, 158, 115},
                                          {240, 228, 66},
                                          {213, 94, 0},
                                          {204, 121, 167},
                                          {0, 114, 178},
                                          {200, 200, 200}}};

constexpr double kMaxId = 4294967295.0;

Category LabelCategory(double value, const LabelTable& labels) {
  const Label* const label = labels.Find(static_cast<std::uint32_t>(value));
  if (label != nullptr) return {value, label->name, label->rgb};
  const auto id = static_cast<std::uint32_t>(value);
  return {value, "label " + std::to_string(id), kPalette[id % kPalette.size()]};
}

Category OutcomeCategory(double value) {
  const auto index = static_cast<std::size_t>(value);
  return {value,
          index < kOutcomeNames.size() ? std::string(kOutcomeNames[index])
                                       : "outcome " + std::to_string(index),
          kPalette[index % kPalette.size()]};
}

const std::vector<double>& FieldOf(const Cloud& cloud, const std::string& name) {
  const auto field = cloud.fields.find(name);
  if (field == cloud.fields.end()) throw InputError("has no field " + name + " to color by");
  return field->second;
}

/// A field that names kinds, not amounts.
const std::vector<double>& KindsOf(const Cloud& cloud, const std::string& name) {
  const std::vector<double>& values = FieldOf(cloud, name);
  for (const double value : values) {
    if (value >= 0.0 && value <= kMaxId && value == std::floor(value)) continue;
    throw InputError("field " + name + " must hold whole numbers (got " + std::to_string(value) +
                     ")");
  }
  return values;
}

std::vector<double> RangesOf(const Cloud& cloud) {
  const auto field = cloud.fields.find("range_m");
  if (field != cloud.fields.end()) return field->second;
  std::vector<double> ranges_m(cloud.size());
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    const float* const p = &cloud.positions_m[3 * i];
    ranges_m[i] = std::hypot(double{p[0]}, double{p[1]}, double{p[2]});
  }
  return ranges_m;
}

std::vector<double> HeightsOf(const Cloud& cloud) {
  std::vector<double> heights_m(cloud.size());
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    heights_m[i] = double{cloud.positions_m[3 * i + 2]};
  }
  return heights_m;
}

ScalarColoring OnScale(std::vector<double> values, std::string title) {
  std::vector<double> sorted;
  std::ranges::copy_if(values, std::back_inserter(sorted),
                       [](double v) { return std::isfinite(v); });
  std::ranges::sort(sorted);
  ScalarColoring coloring{
      .values = std::move(values), .lowest = 0.0, .highest = 1.0, .title = title};
  if (!sorted.empty()) {
    const std::size_t one_percent = sorted.size() / 100;
    coloring.lowest = sorted[one_percent];
    coloring.highest = sorted[sorted.size() - 1 - one_percent];
  }
  return coloring;
}

}  // namespace

Coloring ColorCloud(const Cloud& cloud, const std::string& color_by, const LabelTable& labels) {
  if (color_by == "range") return OnScale(RangesOf(cloud), "range [m]");
  if (color_by == "height") return OnScale(HeightsOf(cloud), "z [m]");
  if (color_by == "intensity") return OnScale(FieldOf(cloud, "intensity"), "intensity");
  CategoryColoring coloring{.values = KindsOf(cloud, color_by), .categories = {}};
  for (const double value : std::set<double>(coloring.values.begin(), coloring.values.end())) {
    coloring.categories.push_back(color_by == "label" ? LabelCategory(value, labels)
                                                      : OutcomeCategory(value));
  }
  return coloring;
}

Rgb ScaleColor(double place) {
  const double scaled = std::clamp(place, 0.0, 1.0) * (kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(scaled), kViridis.size() - 2);
  const double share = scaled - static_cast<double>(below);
  Rgb rgb;
  for (std::size_t i = 0; i < 3; ++i) {
    rgb[i] = static_cast<std::uint8_t>(
        std::lround((1.0 - share) * kViridis[below][i] + share * kViridis[below + 1][i]));
  }
  return rgb;
}

}  // namespace railcast
