#include "viewer/composition/composer.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <compare>
#include <string_view>
#include <utility>

#include "viewer/color/palette.h"
#include "viewer/composition/coloring.h"

namespace railcast {
namespace {

/// A recorded point, before the motion within the scan is undone: the same object may move by other
/// ways in two recordings.
struct RecordedPoint {
  std::array<double, 3> at_m;  ///< Without the offset that was subtracted from far positions.
  std::uint32_t point;
  auto operator<=>(const RecordedPoint&) const = default;
};

std::vector<RecordedPoint> SortedPoints(const ShownFrame& shown) {
  const Frame& frame = shown.frame();
  const Vector3& origin_m = shown.recorded->origin_m;
  std::vector<RecordedPoint> points;
  points.reserve(shown.num_points());
  for (const std::uint32_t slot : shown.slots) {
    const Vector3 own_m(frame.x[slot], frame.y[slot], frame.z[slot]);
    const Vector3 at_m = own_m + origin_m;
    points.push_back({{at_m.x(), at_m.y(), at_m.z()}, static_cast<std::uint32_t>(points.size())});
  }
  tbb::parallel_sort(points);
  return points;
}

/// Compares the intensities of points that are in both frames.
class IntensityComparison {
 public:
  IntensityComparison(const ShownFrame& first, const ShownFrame& second)
      : first_(first),
        second_(second),
        are_known_(first.recorded->Has("intensity") && second.recorded->Has("intensity")) {}

  [[nodiscard]] Change Of(std::uint32_t in_first, std::uint32_t in_second) const {
    if (!are_known_) return Change::kSame;
    const float before = first_.frame().intensity[first_.slots[in_first]];
    const float after = second_.frame().intensity[second_.slots[in_second]];
    if (after < before) return Change::kWeaker;
    return after > before ? Change::kStronger : Change::kSame;
  }

 private:
  const ShownFrame& first_;
  const ShownFrame& second_;
  bool are_known_;
};

struct ChangeLook {
  std::string_view name;
  Rgb rgb;
};
constexpr std::array<ChangeLook, 5> kLooks = {{{"in both", kNoValueColor},
                                               {"weaker", kYellow},
                                               {"stronger", kBluishGreen},
                                               {"added", kVermillion},
                                               {"removed", kSkyBlue}}};

ShownFrame PartOf(const ShownFrame& shown, const std::vector<std::uint32_t>& points) {
  ShownFrame part{.recorded = shown.recorded, .positions_m = {}, .slots = {}};
  part.positions_m.reserve(3 * points.size());
  part.slots.reserve(points.size());
  for (const std::uint32_t point : points) {
    const float* const at_m = shown.positions_m.data() + 3 * std::size_t{point};
    part.positions_m.insert(part.positions_m.end(), at_m, at_m + 3);
    part.slots.push_back(shown.slots[point]);
  }
  return part;
}

Coloring ColorByChange(const ChangedPoints& changed) {
  std::array<std::size_t, kLooks.size()> counts{};
  counts[static_cast<std::size_t>(Change::kRemoved)] = changed.removed.size();
  Coloring coloring{.title = "change"};
  coloring.colors.reserve(changed.of_second.size());
  for (const Change change : changed.of_second) {
    const auto kind = static_cast<std::size_t>(change);
    ++counts[kind];
    coloring.colors.push_back(kLooks[kind].rgb);
  }
  for (std::size_t kind = 0; kind < kLooks.size(); ++kind) {
    if (counts[kind] == 0) continue;
    coloring.categories.push_back({.value = static_cast<double>(kind),
                                   .name = std::string(kLooks[kind].name),
                                   .rgb = kLooks[kind].rgb,
                                   .num_points = counts[kind]});
  }
  return coloring;
}

}  // namespace

ChangedPoints CompareFrames(const ShownFrame& first, const ShownFrame& second) {
  const std::vector<RecordedPoint> before = SortedPoints(first);
  const std::vector<RecordedPoint> after = SortedPoints(second);
  const IntensityComparison intensities(first, second);
  ChangedPoints changed;
  changed.of_second.assign(after.size(), Change::kAdded);
  auto now = after.begin();
  for (const RecordedPoint& old : before) {
    while (now != after.end() && now->at_m < old.at_m) ++now;
    if (now == after.end() || old.at_m < now->at_m) {
      changed.removed.push_back(old.point);
    } else {
      changed.of_second[now->point] = intensities.Of(old.point, now->point);
      ++now;
    }
  }
  std::ranges::sort(changed.removed);
  return changed;
}

Composition ComposeChanges(const std::shared_ptr<const ShownFrame>& first,
                           const std::shared_ptr<const ShownFrame>& second,
                           const Choices& choices) {
  const ChangedPoints changed = CompareFrames(*first, *second);
  const auto removed = std::make_shared<const ShownFrame>(PartOf(*first, changed.removed));
  Composition composition;
  composition.coloring = ColorByChange(changed);
  composition.clouds.push_back({.shown = second,
                                .colors = std::move(composition.coloring.colors),
                                .is_faint = FaintPoints(*second, choices.labels),
                                .source = 1});
  const Rgb& removed_rgb = kLooks[static_cast<std::size_t>(Change::kRemoved)].rgb;
  composition.clouds.push_back(
      {.shown = removed,
       .view_from_sensor = FirstFromSecond(*second, *first).value_or(Transform::Identity()),
       .colors = std::vector<Rgb>(removed->num_points(), removed_rgb),
       .is_faint = FaintPoints(*removed, choices.labels)});
  return composition;
}

}  // namespace railcast
