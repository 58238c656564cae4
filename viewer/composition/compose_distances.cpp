#include "viewer/composition/compose_distances.h"

#include <array>
#include <utility>
#include <vector>

#include "viewer/composition/cloud_distances.h"
#include "viewer/composition/coloring.h"
#include "viewer/composition/faint_points.h"
#include "viewer/frames/field_values.h"

namespace railcast {
namespace {

std::array<double, 2> FitDistances_m(const FieldValues& distances) {
  return {0.0, FitScale(distances)[1]};
}

FieldValues DistancesField(const ShownFrame& of, const ShownFrame& other) {
  const std::vector<float> distances_m = DistancesToNearest_m(of, other);
  return {.kind = FieldValues::Kind::kAmount,
          .title = "to the other's nearest point [m]",
          .values = {distances_m.begin(), distances_m.end()}};
}

}  // namespace

Composition ComposeDistances(const std::shared_ptr<const ShownFrame>& a,
                             const std::shared_ptr<const ShownFrame>& b,
                             const Choices& choices) {
  Composition composition;
  const FieldValues of_a = DistancesField(*a, *b);
  const FieldValues of_b = DistancesField(*b, *a);
  const ColorMap map = choices.map.value_or(ColorMap::kViridis);
  const auto ends_m = choices.distance_ends_m ? *choices.distance_ends_m : FitDistances_m(of_a);
  composition.coloring = ColorByScale(of_a, map, ends_m);
  composition.clouds.push_back({.shown = a,
                                .view_from_sensor = Transform::Identity(),
                                .colors = std::move(composition.coloring.colors),
                                .is_faint = FaintPoints(*a, choices.labels)});
  composition.clouds.push_back(
      {.shown = b,
       .view_from_sensor = FirstFromSecond(*a, *b).value_or(Transform::Identity()),
       .colors = ColorByScale(of_b, map, ends_m).colors,
       .is_faint = FaintPoints(*b, choices.labels)});
  return composition;
}

}  // namespace railcast
