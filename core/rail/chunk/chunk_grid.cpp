#include "core/rail/chunk/chunk_grid.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace railcast {
namespace {

// Distance in plan from a point to the cross-section of the ground at `axis`.
double DistanceToCrossSection(const Eigen::Vector2d& point_m,
                              const AxisPoint& axis,
                              double half_width_m) {
  const Eigen::Vector2d left(-std::sin(axis.heading_rad), std::cos(axis.heading_rad));
  const Eigen::Vector2d from_axis_m = point_m - axis.position_m.head<2>();
  const double across_m = std::clamp(from_axis_m.dot(left), -half_width_m, half_width_m);
  return (from_axis_m - across_m * left).norm();
}

// Half a step along the home axis plus half a step along the ground, whose outer edge is up to
// twice as long as the axis, or more if it is farther away than the tightest radius.
double SlackOf(const Alignment& alignment, double half_width_m) {
  const double lengthening = std::max(2.0, 1.0 + half_width_m / alignment.tightest_radius_m());
  return 0.5 * (1.0 + lengthening) * ChunkGrid::kSampling_m;
}

}  // namespace

ChunkGrid::ChunkGrid(const Alignment& alignment, double chunk_length_m, double ground_half_width_m)
    : alignment_(alignment),
      chunk_length_m_(chunk_length_m),
      ground_half_width_m_(ground_half_width_m),
      reach_slack_m_(SlackOf(alignment, ground_half_width_m)) {
  const auto count = static_cast<std::size_t>(std::ceil(alignment.length_m() / chunk_length_m));
  centres_m_.resize(count);
  for (int chunk = 0; chunk < num_chunks(); ++chunk) {
    centres_m_[static_cast<std::size_t>(chunk)] =
        alignment_.At(0.5 * (BeginOf(chunk) + EndOf(chunk))).position_m.head<2>();
  }
}

double ChunkGrid::EndOf(int chunk) const {
  return std::min((chunk + 1) * chunk_length_m_, alignment_.length_m());
}

int ChunkGrid::ChunkAt(double s_m) const {
  return static_cast<int>(
      std::clamp(std::floor(s_m / chunk_length_m_), 0.0, static_cast<double>(num_chunks() - 1)));
}

Transform ChunkGrid::WorldFromChunk(int chunk) const {
  Check(chunk >= 0 && chunk < num_chunks(), "the chunk is one of the line's");
  const AxisPoint middle = alignment_.At(0.5 * (BeginOf(chunk) + EndOf(chunk)));
  return MakeTransform(RotationFromYawPitchRoll(middle.heading_rad, 0.0, 0.0), middle.position_m);
}

std::vector<AxisPoint> ChunkGrid::AxisSamples(int chunk) const {
  const double length_m = EndOf(chunk) - BeginOf(chunk);
  const auto num_steps = static_cast<int>(std::ceil(length_m / kSampling_m));
  std::vector<AxisPoint> samples;
  for (int i = 0; i <= num_steps; ++i) {
    samples.push_back(alignment_.At(BeginOf(chunk) + length_m * i / num_steps));
  }
  return samples;
}

std::vector<int> ChunkGrid::WithinReach(int home_chunk, double reach_m) const {
  Check(home_chunk >= 0 && home_chunk < num_chunks(), "the home chunk is one of the line's");
  const std::vector<AxisPoint> home = AxisSamples(home_chunk);
  const auto reaches = [&](int chunk) {
    for (const AxisPoint& section : AxisSamples(chunk)) {
      for (const AxisPoint& sample : home) {
        if (DistanceToCrossSection(sample.position_m.head<2>(), section, ground_half_width_m_) <=
            reach_m + reach_slack_m_) {
          return true;
        }
      }
    }
    return false;
  };
  // Both axes lie within half a chunk's length of their middles.
  const double far_m = reach_m + chunk_length_m_ + ground_half_width_m_;
  std::vector<int> chunks;
  for (int chunk = 0; chunk < num_chunks(); ++chunk) {
    const double squared_m2 = (CentreOf(chunk) - CentreOf(home_chunk)).squaredNorm();
    if (squared_m2 <= far_m * far_m && reaches(chunk)) chunks.push_back(chunk);
  }
  return chunks;
}

}  // namespace railcast
