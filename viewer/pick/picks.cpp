#include "viewer/pick/picks.h"

#include "viewer/pick/point_facts.h"

namespace railcast {
namespace {

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
