#include "viewer/pick/picks.h"

#include <array>
#include <string_view>

namespace railcast {
namespace {

using AxisNames = std::array<std::string_view, 3>;
constexpr AxisNames kSensorAxes = {"dx", "dy", "dz"};
constexpr AxisNames kWorldAxes = {"east", "north", "up"};
constexpr int kNumDecimals = 3;

std::string WayText(const Vector3& way_m, const AxisNames& axes) {
  std::string text = FixedText(way_m.norm(), kNumDecimals);
  std::string_view before = " m (";
  for (int axis = 0; axis < 3; ++axis) {
    text.append(before).append(axes.at(static_cast<std::size_t>(axis))).append(" ");
    text.append(FixedText(way_m[axis], kNumDecimals));
    before = ", ";
  }
  text.append("; level ").append(FixedText(way_m.head<2>().norm(), kNumDecimals));
  return text.append(" m)");
}

constexpr Rgb kMarkColor = {255, 255, 255};
constexpr float kCrossArm_m = 0.25F;

/// Returns the position of a pick in a composition's axes.
std::optional<Eigen::Vector3f> PlaceOf(const Composition& composition, const Pick& pick) {
  for (const PlacedCloud& cloud : composition.clouds) {
    if (AreOfOneFrame(*cloud.shown->recorded, *pick.recorded)) {
      return (cloud.view_from_sensor * pick.at_stamp_m).cast<float>().eval();
    }
  }
  if (composition.clouds.empty()) return std::nullopt;
  const RecordedFrame& shown = *composition.clouds.front().shown->recorded;
  if (!shown.has_pose || !pick.recorded->has_pose) return std::nullopt;
  const Transform view_from_sensor =
      shown.frame.world_from_sensor.inverse() * pick.recorded->frame.world_from_sensor;
  return (view_from_sensor * pick.at_stamp_m).cast<float>().eval();
}

}  // namespace

bool AreOfOneFrame(const RecordedFrame& a, const RecordedFrame& b) {
  return a.name == b.name && a.frame.index == b.frame.index && a.frame.stamp_ns == b.frame.stamp_ns;
}

Pick PickOf(const ShownFrame& shown, std::size_t point) {
  const float* const at_m = shown.positions_m.data() + 3 * point;
  return {shown.recorded, Eigen::Map<const Eigen::Vector3f>(at_m).cast<double>()};
}

std::optional<std::string> DistanceText(const Pick& from, const Pick& to) {
  if (AreOfOneFrame(*from.recorded, *to.recorded)) {
    return WayText(to.at_stamp_m - from.at_stamp_m, kSensorAxes);
  }
  if (!from.recorded->has_pose || !to.recorded->has_pose) return std::nullopt;
  const auto in_world_m = [](const Pick& pick) -> Vector3 {
    return pick.recorded->frame.world_from_sensor * pick.at_stamp_m;
  };
  return WayText(in_world_m(to) - in_world_m(from), kWorldAxes);
}

void Picks::Add(const ShownFrame& shown,
                std::size_t point,
                const RecordingInfo& info,
                bool measures) {
  if (!measures) picks_.clear();
  if (picks_.size() > 1) picks_.erase(picks_.begin());
  picks_.push_back(PickOf(shown, point));
  slot_ = shown.slots[point];
  facts_.clear();
  for (const std::string& line : PointFacts(shown, info, point)) {
    facts_ += line;
    facts_ += '\n';
  }
  if (picks_.size() > 1) {
    facts_ += "\nfrom the point before\n";
    facts_ += DistanceText(picks_[0], picks_[1])
                  .value_or("not known: frames without poses have no place in common");
  }
}

void Picks::Clear() {
  picks_.clear();
  facts_.clear();
}

std::optional<std::uint32_t> Picks::label() const {
  if (picks_.empty() || !picks_.back().recorded->Has("label")) return std::nullopt;
  return picks_.back().recorded->frame.label[slot_];
}

std::optional<Eigen::Vector3f> Picks::PlaceIn(const Composition& composition) const {
  if (picks_.empty()) return std::nullopt;
  return PlaceOf(composition, picks_.back());
}

Overlay Picks::MarksIn(const Composition& composition) const {
  Overlay marks;
  std::vector<Eigen::Vector3f> places_m;
  for (const Pick& pick : picks_) {
    const auto place_m = PlaceOf(composition, pick);
    if (!place_m) continue;
    places_m.push_back(*place_m);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3f arm_m = kCrossArm_m * Eigen::Vector3f::Unit(axis);
      marks.segments.push_back(
          {.from_m = *place_m - arm_m, .to_m = *place_m + arm_m, .rgb = kMarkColor});
    }
  }
  if (places_m.size() == 2) {
    marks.segments.push_back({.from_m = places_m[0], .to_m = places_m[1], .rgb = kMarkColor});
  }
  return marks;
}

}  // namespace railcast
