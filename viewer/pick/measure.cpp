#include "viewer/pick/measure.h"

#include <array>
#include <string_view>

#include "viewer/pick/fixed_text.h"

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

}  // namespace railcast
