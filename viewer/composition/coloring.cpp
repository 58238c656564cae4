#include "viewer/composition/coloring.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/frame.h"
#include "viewer/color/palette.h"

namespace railcast {
namespace {

constexpr std::array<Rgb, 8> kPalette = {{kSkyBlue,
                                          kOrange,
                                          kBluishGreen,
                                          kYellow,
                                          kVermillion,
                                          kReddishPurple,
                                          kBlue,
                                          {200, 200, 200}}};
constexpr Rgb kNoObject = {120, 120, 120};

Rgb PaletteColor(std::uint32_t id) {
  return kPalette[id % kPalette.size()];
}

Category LabelCategory(std::uint32_t id, const LabelTable& labels) {
  if (const Label* const label = labels.Find(id)) return {.name = label->name, .rgb = label->rgb};
  return {.name = "label " + NumberText(id), .rgb = PaletteColor(id)};
}

Category InstanceCategory(std::uint32_t id, const std::vector<RecordedObject>& objects) {
  if (id == 0) return {.name = "no object", .rgb = kNoObject};
  const auto object = std::ranges::find(objects, id, &RecordedObject::instance);
  return {.name = object == objects.end() ? "instance " + NumberText(id) : object->name,
          .rgb = PaletteColor(id)};
}

Category OutcomeCategory(std::uint32_t id) {
  if (id >= kOutcomeNames.size()) return {.name = "outcome " + NumberText(id), .rgb = kNoObject};
  return {.name = std::string(kOutcomeNames[id]), .rgb = OutcomeRgb(static_cast<Outcome>(id))};
}

Category MaterialCategory(std::uint32_t id, const std::vector<std::string>& names) {
  const bool is_named = id < names.size() && !names[id].empty();
  return {.name = is_named ? names[id] : "material " + NumberText(id), .rgb = PaletteColor(id)};
}

Category CategoryOf(std::uint32_t id,
                    const std::string& field,
                    const RecordingInfo& info,
                    const RecordedFrame& recorded) {
  if (field == "label") return LabelCategory(id, info.labels);
  if (field == "instance") return InstanceCategory(id, recorded.objects);
  if (field == "outcome") return OutcomeCategory(id);
  if (field == "material") return MaterialCategory(id, info.materials);
  return {.name = NumberText(id), .rgb = PaletteColor(id)};
}

void CheckWhole(double value, const std::string& field) {
  constexpr double kMaxId = 4294967295.0;
  if (value >= 0.0 && value <= kMaxId && value == std::floor(value)) return;
  throw InputError("field " + field + " must hold whole numbers (got " + NumberText(value) + ")");
}

}  // namespace

std::vector<bool> FaintPoints(const ShownFrame& shown, const std::set<std::uint32_t>& labels) {
  std::vector<bool> is_faint;
  if (labels.empty()) return is_faint;
  is_faint.reserve(shown.num_points());
  for (const std::uint32_t slot : shown.slots) {
    is_faint.push_back(!labels.contains(shown.frame().label[slot]));
  }
  return is_faint;
}

std::array<double, 2> FitScale(const FieldValues& field) {
  std::vector<double> sorted;
  std::ranges::copy_if(field.values, std::back_inserter(sorted),
                       [](double value) { return std::isfinite(value); });
  std::ranges::sort(sorted);
  std::array<double, 2> ends = {0.0, 1.0};
  if (!sorted.empty()) {
    const std::size_t one_percent = sorted.size() / 100;
    ends = {sorted[one_percent], sorted[sorted.size() - 1 - one_percent]};
    // If few points bear a mark, both percentiles are the value of all others.
    if (ends[0] == ends[1]) ends = {sorted.front(), sorted.back()};
  }
  if (field.kind == FieldValues::Kind::kDifference) {
    const double end = std::max(std::abs(ends[0]), std::abs(ends[1]));
    ends = {-end, end};
  }
  if (!(ends[0] < ends[1])) {
    // A margin of 0.5 would be lost in the rounding of large values.
    const double margin = std::max(0.5, 1e-6 * std::abs(ends[0]));
    ends = {ends[0] - margin, ends[1] + margin};
  }
  return ends;
}

Coloring ColorByScale(const FieldValues& field, ColorMap map, const std::array<double, 2>& ends) {
  constexpr std::size_t kSteps = 1024;
  std::array<Rgb, kSteps> table{};
  for (std::size_t i = 0; i < kSteps; ++i) {
    table[i] = MapColor(map, static_cast<double>(i) / (kSteps - 1));
  }
  Coloring coloring{.title = field.title, .ends = ends, .map = map};
  coloring.colors.reserve(field.values.size());
  for (const double value : field.values) {
    const double place = std::clamp((value - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0);
    coloring.colors.push_back(
        std::isnan(value) ? kNoValueColor
                          : table[static_cast<std::size_t>(std::lround(place * (kSteps - 1)))]);
  }
  return coloring;
}

Coloring ColorByCategory(const FieldValues& field,
                         const std::string& name,
                         const RecordingInfo& info,
                         const RecordedFrame& recorded) {
  std::map<double, Category> categories;
  Coloring coloring{.title = field.title};
  coloring.colors.reserve(field.values.size());
  // Neighbouring points are mostly of the same category, so the last one is tried first.
  Category* last = nullptr;
  for (const double value : field.values) {
    if (last == nullptr || last->value != value) {
      CheckWhole(value, name);
      const auto [found, is_new] = categories.try_emplace(value);
      if (is_new) {
        found->second = CategoryOf(static_cast<std::uint32_t>(value), name, info, recorded);
        found->second.value = value;
      }
      last = &found->second;
    }
    ++last->num_points;
    coloring.colors.push_back(last->rgb);
  }
  for (auto& [value, category] : categories) coloring.categories.push_back(std::move(category));
  return coloring;
}

}  // namespace railcast
