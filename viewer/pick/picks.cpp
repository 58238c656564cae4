#include "viewer/pick/picks.h"

#include <array>
#include <cmath>
#include <limits>
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

// About the accuracy with which a user clicks.
constexpr double kOnPoint_px = 5.0;
constexpr double kBesidePoint_px = 12.0;

/// The point with the least value so far.
struct Found {
  std::optional<std::size_t> point;
  double least = std::numeric_limits<double>::infinity();

  void Offer(std::size_t i, double value) {
    if (value >= least) return;
    point = i;
    least = value;
  }
};

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

std::optional<std::size_t> PointAt(std::span<const float> positions_m,
                                   const Eigen::Matrix4d& clip_from_points,
                                   const std::array<int, 2>& size_px,
                                   double x_px,
                                   double y_px) {
  // The offset from the click in pixels, times w.
  const Eigen::Vector2d half_px(0.5 * size_px[0], 0.5 * size_px[1]);
  const Eigen::Vector2d click_px(x_px, y_px);
  Eigen::Matrix<double, 2, 4> offset_from_points;
  for (int axis = 0; axis < 2; ++axis) {
    offset_from_points.row(axis) = half_px[axis] * clip_from_points.row(axis) +
                                   (half_px[axis] - click_px[axis]) * clip_from_points.row(3);
  }
  const Eigen::RowVector4d w_from_points = clip_from_points.row(3);

  Found nearest_to_eye;
  Found nearest_on_screen;
  for (std::size_t i = 0; 3 * i + 2 < positions_m.size(); ++i) {
    const float* const at_m = positions_m.data() + 3 * i;
    const Eigen::Vector4d point(static_cast<double>(at_m[0]), static_cast<double>(at_m[1]),
                                static_cast<double>(at_m[2]), 1.0);
    const double w = w_from_points.dot(point);
    const double reach = kBesidePoint_px * w;
    const Eigen::Vector2d offset = offset_from_points * point;
    // Most points are rejected here, before any division, and so are points behind the eye and
    // points of NaN.
    if (!(w > 0.0 && std::abs(offset.x()) <= reach && std::abs(offset.y()) <= reach)) continue;
    const Eigen::Vector3d seen = (clip_from_points * point).head<3>() / w;
    if (!(seen.cwiseAbs().maxCoeff() <= 1.0)) continue;
    const double distance_px = offset.norm() / w;
    if (distance_px <= kOnPoint_px) nearest_to_eye.Offer(i, seen.z());
    if (distance_px <= kBesidePoint_px) nearest_on_screen.Offer(i, distance_px);
  }
  return nearest_to_eye.point ? nearest_to_eye.point : nearest_on_screen.point;
}

}  // namespace railcast
