#include "core/simulate/frame_poses.h"

#include <algorithm>

namespace railcast {
namespace {

constexpr std::uint32_t kKnotSpacing_ns = 10'000'000;

PoseF ToPoseF(const Transform& transform) {
  PoseF pose{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      pose.r[3 * row + column] = static_cast<float>(transform.linear()(row, column));
    }
    pose.t[row] = static_cast<float>(transform.translation()(row));
  }
  return pose;
}

}  // namespace

std::vector<ScanPose> PosesBetween(
    std::uint32_t duration_ns, const std::function<Transform(std::uint32_t)>& world_from_sensor) {
  constexpr std::uint64_t kSpacing_ns = 20'000'000;
  const std::uint64_t num_intervals = (duration_ns + kSpacing_ns - 1) / kSpacing_ns;
  std::vector<ScanPose> poses;
  for (std::uint64_t i = 1; i < num_intervals; ++i) {
    const auto time_ns = static_cast<std::uint32_t>(duration_ns * i / num_intervals);
    poses.push_back({time_ns, world_from_sensor(time_ns)});
  }
  return poses;
}

FramePoses::FramePoses(std::uint32_t duration_ns,
                       const std::function<Transform(std::uint32_t)>& window_from_sensor) {
  // 64 bits, because sums of 32-bit times may overflow: a pattern may last nearly 2^32 ns.
  const std::uint64_t duration = duration_ns;
  const auto num_intervals = static_cast<std::uint32_t>(
      std::max<std::uint64_t>(1, (duration + kKnotSpacing_ns - 1) / kKnotSpacing_ns));
  spacing_ns_ = static_cast<std::uint32_t>(
      std::max<std::uint64_t>(1, (duration + num_intervals - 1) / num_intervals));
  knots_.reserve(num_intervals + 1);
  for (std::uint32_t i = 0; i <= num_intervals; ++i) {
    knots_.push_back(ToPoseF(window_from_sensor(i * spacing_ns_)));
  }
}

PoseF FramePoses::At(std::uint32_t time_ns, PoseF& change_per_ns) const {
  const std::size_t index = std::min<std::size_t>(time_ns / spacing_ns_, knots_.size() - 2);
  const PoseF& begin = knots_[index];
  const PoseF& end = knots_[index + 1];
  const auto since_knot_ns =
      static_cast<float>(time_ns - static_cast<std::uint32_t>(index) * spacing_ns_);
  const float inverse_spacing = 1.0F / static_cast<float>(spacing_ns_);
  PoseF pose{};
  for (int i = 0; i < 9; ++i) {
    change_per_ns.r[i] = (end.r[i] - begin.r[i]) * inverse_spacing;
    pose.r[i] = begin.r[i] + change_per_ns.r[i] * since_knot_ns;
  }
  for (int i = 0; i < 3; ++i) {
    change_per_ns.t[i] = (end.t[i] - begin.t[i]) * inverse_spacing;
    pose.t[i] = begin.t[i] + change_per_ns.t[i] * since_knot_ns;
  }
  return pose;
}

}  // namespace railcast
