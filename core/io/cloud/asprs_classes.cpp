#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/io/cloud/las_reader.h"

namespace railcast {
namespace {

/// A class of points, by its number, and what scenarios call it; empty if they do not know it.
struct AsprsClass {
  std::string_view name;
  std::array<std::uint8_t, 3> rgb{};
  std::string_view of_scenarios{};
};
constexpr std::array<AsprsClass, 23> kClasses = {{{"unlabeled", {77, 83, 90}},
                                                  {"unclassified", {150, 150, 150}},
                                                  {"ground", {103, 87, 54}, "ground"},
                                                  {"low_vegetation", {115, 167, 57}, "grass"},
                                                  {"medium_vegetation", {77, 156, 61}, "bush"},
                                                  {"high_vegetation", {33, 147, 101}, "tree"},
                                                  {"building", {143, 148, 171}, "building"},
                                                  {"low_noise", {255, 30, 255}},
                                                  {"model_key_point", {129, 110, 70}, "ground"},
                                                  {"water", {0, 114, 178}},
                                                  {"rail", {234, 172, 41}, "rail"},
                                                  {"road_surface", {118, 105, 109}, "road"},
                                                  {"overlap", {200, 190, 170}},
                                                  {"wire_guard", {255, 213, 26}},
                                                  {"wire_conductor", {252, 234, 103}},
                                                  {"transmission_tower", {0, 141, 228}, "mast"},
                                                  {"wire_connector", {102, 188, 239}},
                                                  {"bridge_deck", {118, 171, 151}, "bridge"},
                                                  {"high_noise", {191, 49, 152}},
                                                  {"overhead_structure", {186, 158, 0}},
                                                  {"ignored_ground", {146, 95, 40}, "ground"},
                                                  {"snow", {223, 233, 243}},
                                                  {"temporal_exclusion", {113, 107, 126}}}};

}  // namespace

const LabelTable& AsprsLabels() {
  static const LabelTable labels = [] {
    std::vector<Label> table;
    for (const AsprsClass& known : kClasses) {
      table.push_back({.id = static_cast<std::uint32_t>(table.size()),
                       .name = std::string(known.name),
                       .rgb = known.rgb,
                       .whu_railway3d = {},
                       .osdar23 = {}});
    }
    return LabelTable(std::move(table));
  }();
  return labels;
}

std::string_view ScenarioLabelOf(std::string_view asprs_name) {
  const auto known = std::ranges::find(kClasses, asprs_name, &AsprsClass::name);
  return known == kClasses.end() ? asprs_name : known->of_scenarios;
}

}  // namespace railcast
