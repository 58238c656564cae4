#include "generator/extras/survey/moving_things.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace railcast {
namespace {

constexpr double kFineCell_m = 0.25;
constexpr double kBlock_m = 16.0 * kFineCell_m;
/// A beam has passed through a surface if it ends so far behind its plane: noise and the ground's
/// own roughness do not reach so far.
constexpr float kBehind_m = 0.15F;
constexpr float kLeastCosineOfPassing = 0.1F;
/// The edges of surfels are not certain.
constexpr float kInnerPart = 0.8F;

using Cell = std::array<std::int64_t, 3>;

std::uint64_t KeyOf(const Cell& cell) {
  constexpr std::int64_t kMiddle = 1 << 20;
  std::uint64_t key = 0;
  for (const std::int64_t coordinate : cell) {
    key = (key << 21U) | (static_cast<std::uint64_t>(coordinate + kMiddle) & 0x1FFFFFU);
  }
  return key;
}

/// The place of a fine cell among those of its block.
std::size_t PlaceInBlock(const Cell& cell) {
  return static_cast<std::size_t>((cell[0] & 15) << 8 | (cell[1] & 15) << 4 | (cell[2] & 15));
}

Cell FineCellOf(const Vector3& point_m) {
  const auto coordinate = [&](Eigen::Index axis) {
    return static_cast<std::int64_t>(std::floor(point_m[axis] / kFineCell_m));
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

/// Calls `visit(cell, begin_m, end_m)` for each cell of a grid that a ray meets between two ranges,
/// in order, with the ranges within the cell (Amanatides and Woo 1987).
template <class Visit>
// NOLINTNEXTLINE(readability-function-size): a ray and a grid
void WalkCells(const Vector3& origin_m,
               const Vector3& direction,
               double begin_m,
               double end_m,
               double edge_m,
               const Visit& visit) {
  const Vector3 start_m = origin_m + begin_m * direction;
  Cell cell{};
  std::array<std::int64_t, 3> step{};
  std::array<double, 3> next_m{};
  std::array<double, 3> across_m{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    cell[axis] = static_cast<std::int64_t>(std::floor(start_m[k] / edge_m));
    step[axis] = direction[k] > 0.0 ? 1 : -1;
    across_m[axis] = edge_m / std::max(std::abs(direction[k]), 1e-12);
    const double edge = edge_m * static_cast<double>(cell[axis] + (step[axis] > 0 ? 1 : 0));
    next_m[axis] = begin_m + (edge - start_m[k]) / (std::abs(direction[k]) < 1e-12
                                                        ? 1e-12 * static_cast<double>(step[axis])
                                                        : direction[k]);
  }
  for (double at_m = begin_m; at_m < end_m;) {
    const auto axis = static_cast<std::size_t>(std::ranges::min_element(next_m) - next_m.begin());
    const double leave_m = std::min(next_m[axis], end_m);
    visit(cell, at_m, leave_m);
    at_m = next_m[axis];
    cell[axis] += step[axis];
    next_m[axis] += across_m[axis];
  }
}

}  // namespace

MovingThings::MovingThings(const std::vector<MadeSurfel>& surfels, const SurveyVoxels& cloud)
    : surfels_(surfels), cloud_(cloud), judged_(surfels.size()) {
  for (std::uint32_t i = 0; i < surfels.size(); ++i) {
    const MadeSurfel& surfel = surfels[i];
    judged_[i].cell = KeyOf(FineCellOf(cloud.MeanOf(cloud.voxels()[surfel.voxel])));
    Frames& frames = frames_of_cell_[judged_[i].cell];
    frames.first = std::min(frames.first, cloud.voxels()[surfel.voxel].first_frame);
    frames.last = std::max(frames.last, cloud.voxels()[surfel.voxel].last_frame);
    const Vector3 half_m = (surfel.half_u_m.cwiseAbs() + surfel.half_v_m.cwiseAbs()).cast<double>();
    const Cell low = FineCellOf(surfel.center_m - half_m);
    const Cell high = FineCellOf(surfel.center_m + half_m);
    Cell cell{};
    for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
      for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
        for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
          const Cell block = {cell[0] >> 4, cell[1] >> 4, cell[2] >> 4};
          surfels_of_cell_[KeyOf(cell)].push_back(i);
          cells_of_block_[KeyOf(block)].set(PlaceInBlock(cell));
        }
      }
    }
  }
}

void MovingThings::Pass(const SurveyBeam& beam, std::uint32_t frame_index, std::uint32_t surfel) {
  Judged& judged = judged_[surfel];
  if (judged.last_beam == num_beams_) return;
  const MadeSurfel& piece = surfels_[surfel];
  const Eigen::Vector3f normal = piece.Normal();
  const Eigen::Vector3f origin_m = (beam.origin_m - piece.center_m).cast<float>();
  const Eigen::Vector3f end_m = (beam.point_m - piece.center_m).cast<float>();
  const float before_m = normal.dot(origin_m);
  const float behind_m = normal.dot(end_m);
  if (before_m * behind_m > 0.0F || std::abs(behind_m) < kBehind_m) return;
  const float length_m = (end_m - origin_m).norm();
  if (std::abs(before_m - behind_m) < kLeastCosineOfPassing * length_m) return;
  const Eigen::Vector3f at_m = origin_m + before_m / (before_m - behind_m) * (end_m - origin_m);
  if (std::abs(at_m.dot(piece.half_u_m)) > kInnerPart * piece.half_u_m.squaredNorm()) return;
  if (std::abs(at_m.dot(piece.half_v_m)) > kInnerPart * piece.half_v_m.squaredNorm()) return;
  judged.last_beam = num_beams_;
  ++judged.num_passes;
  Frames& frames = frames_of_cell_.at(judged.cell);
  if (frames.last_passing == frame_index || frames.last_hit == frame_index) return;
  frames.last_passing = frame_index;
  const bool is_within = frame_index >= frames.first && frame_index <= frames.last;
  ++(is_within ? frames.num_within : frames.num_outside);
}

void MovingThings::Add(const SurveyFrame& frame, std::uint32_t frame_index) {
  if (!frame.has_origins) return;
  for (const SurveyBeam& beam : frame.beams) {
    const auto hit = frames_of_cell_.find(KeyOf(FineCellOf(beam.point_m)));
    if (hit == frames_of_cell_.end() || hit->second.last_hit == frame_index) continue;
    hit->second.last_hit = frame_index;
    ++hit->second.num_hits;
  }
  for (const SurveyBeam& beam : frame.beams) {
    ++num_beams_;
    const Vector3 way_m = beam.point_m - beam.origin_m;
    const double range_m = way_m.norm();
    const Vector3 direction = way_m / range_m;
    const double end_m = range_m - double{kBehind_m};
    WalkCells(beam.origin_m, direction, 0.0, end_m, kBlock_m,
              [&](const Cell& block, double block_begin_m, double block_end_m) {
                const auto cells = cells_of_block_.find(KeyOf(block));
                if (cells == cells_of_block_.end()) return;
                WalkCells(beam.origin_m, direction, block_begin_m, block_end_m, kFineCell_m,
                          [&](const Cell& cell, double, double) {
                            if (!cells->second.test(PlaceInBlock(cell))) return;
                            const auto found = surfels_of_cell_.find(KeyOf(cell));
                            if (found == surfels_of_cell_.end()) return;
                            for (const std::uint32_t surfel : found->second) {
                              Pass(beam, frame_index, surfel);
                            }
                          });
              });
  }
}

bool MovingThings::HasMoved(std::size_t surfel) const {
  const Frames& frames = frames_of_cell_.at(judged_[surfel].cell);
  // Nothing is certain to be hit, least of all what was seen once.
  const double share = frames.num_hits / (frames.num_hits + frames.num_within + 1.0);
  return std::pow(1.0 - share, frames.num_outside) < kLeastProbability;
}

double MovingThings::ShareStopped(std::size_t surfel) const {
  const double num_hits = cloud_.voxels()[surfels_[surfel].voxel].num_points;
  return num_hits / (num_hits + judged_[surfel].num_passes);
}

}  // namespace railcast
