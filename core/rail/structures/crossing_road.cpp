#include "core/rail/structures/crossing_road.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/rail/landform/ground_rise.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

constexpr double kLevelStretch_m = 3.0;
constexpr double kRamp_m = 12.0;
constexpr double kShortestRamp_m = 2.0;
/// Height of the road above the mean ground: more than twice the ground's usual roughness.
constexpr double kRoadAboveGround_m = 0.10;
/// Depth of the ground below the road, and how far beside the road it is kept down: as far as its
/// coarsest rows are apart.
constexpr double kGroundBelowRoad_m = 0.12;
constexpr double kGroundMargin_m = 1.0;
constexpr int kNumGroundRows = 5;

double SmoothStep(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// The mean of each value and its two neighbours.
std::vector<double> Smoothed(const std::vector<double>& values) {
  std::vector<double> smooth = values;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    smooth[i] = (values[i - 1] + values[i] + values[i + 1]) / 3.0;
  }
  return smooth;
}

}  // namespace

CrossingRoad::CrossingRoad(const ChunkContext& context, const LevelCrossingSpec& crossing)
    : context_(&context), middle_s_m_(crossing.s_m), half_width_m_(0.5 * crossing.road_width_m) {
  const StructureTrack own(context, crossing.track);
  right_d_m_ = own.offset_m(middle_s_m_) - crossing.road_length_m;
  left_d_m_ = own.offset_m(middle_s_m_) + crossing.road_length_m;
  for (std::size_t i = 0; i < context.tracks.size(); ++i) {
    const TrackCourse& track = context.tracks[i];
    const double d_m = track.OffsetWithin_m(middle_s_m_);
    if (track.begin_s_m() > begin_s_m() || track.end_s_m() < end_s_m()) continue;
    if (d_m - kPanelEdge_m < right_d_m_ || d_m + kPanelEdge_m > left_d_m_) continue;
    lanes_.push_back({StructureTrack(context, context.spec.tracks[i].name), d_m, kPanelEdge_m});
  }
  std::sort(lanes_.begin(), lanes_.end(),
            [](const Lane& a, const Lane& b) { return a.d_m < b.d_m; });
  for (std::size_t i = 1; i < lanes_.size(); ++i) {
    constexpr double kLeastGap_m = 0.1;
    constexpr double kLeastEdge_m = 0.9;  // Beyond the rail, however close the tracks are.
    const double room_m =
        std::max(kLeastEdge_m, 0.5 * (lanes_[i].d_m - lanes_[i - 1].d_m - kLeastGap_m));
    lanes_[i].edge_m = std::min(lanes_[i].edge_m, room_m);
    lanes_[i - 1].edge_m = std::min(lanes_[i - 1].edge_m, room_m);
  }
  const auto num_places = static_cast<std::size_t>(std::ceil(left_d_m_ - right_d_m_)) + 1;
  ground_m_.assign(num_places, 0.0);
  for (int row = 0; row < kNumGroundRows; ++row) {
    const double s_m = std::lerp(begin_s_m(), this->end_s_m(), (row + 0.5) / kNumGroundRows);
    const CrossSection section(context, s_m);
    for (std::size_t i = 0; i < num_places; ++i) {
      const double d_m = right_d_m_ + static_cast<double>(i);
      ground_m_[i] += (GroundPoint(context, section, s_m, d_m).z() - AxisHeight_m(s_m)) /
                      static_cast<double>(kNumGroundRows);
    }
  }
  ground_m_ = Smoothed(ground_m_);
}

double CrossingRoad::AxisHeight_m(double s_m) const {
  return (context_->chunk_from_world * context_->alignment.WorldFromTrack(s_m)).translation().z();
}

double CrossingRoad::GroundOnRoad_m(double d_m) const {
  const double place = std::clamp(d_m - right_d_m_, 0.0, static_cast<double>(ground_m_.size() - 1));
  const auto below = std::min(static_cast<std::size_t>(place), ground_m_.size() - 2);
  return std::lerp(ground_m_[below], ground_m_[below + 1], place - static_cast<double>(below));
}

Vector3 CrossingRoad::PanelEdge(const Lane& lane, double side, double s_m) const {
  return lane.track.Canted(s_m) * Vector3(0.0, side * lane.edge_m, 0.0);
}

double CrossingRoad::HeightBeyond_m(const Lane& lane, double side, double s_m, double d_m) const {
  const double end_d_m = side > 0.0 ? left_d_m_ : right_d_m_;
  const double edge_d_m = lane.d_m + side * lane.edge_m;
  const double room_m = std::abs(end_d_m - edge_d_m) - kLevelStretch_m;
  const double ramp_m = std::clamp(room_m, kShortestRamp_m, kRamp_m);
  const double down = SmoothStep((std::abs(d_m - edge_d_m) - kLevelStretch_m) / ramp_m);
  const double ground_m = AxisHeight_m(s_m) + GroundOnRoad_m(d_m) + kRoadAboveGround_m;
  return std::lerp(PanelEdge(lane, side, s_m).z(), ground_m, down);
}

Vector3 CrossingRoad::PointAt(double s_m, double d_m) const {
  Vector3 point_m =
      (context_->chunk_from_world * context_->alignment.WorldFromTrack(s_m, d_m)).translation();
  const auto left = std::find_if(lanes_.begin(), lanes_.end(),
                                 [&](const Lane& lane) { return d_m < lane.d_m + lane.edge_m; });
  if (left == lanes_.end()) {
    point_m.z() = HeightBeyond_m(lanes_.back(), 1.0, s_m, d_m);
  } else if (d_m >= left->d_m - left->edge_m) {
    const double across = (d_m - left->d_m + left->edge_m) / (2.0 * left->edge_m);
    point_m.z() =
        std::lerp(PanelEdge(*left, -1.0, s_m).z(), PanelEdge(*left, 1.0, s_m).z(), across);
  } else if (left == lanes_.begin()) {
    point_m.z() = HeightBeyond_m(lanes_.front(), -1.0, s_m, d_m);
  } else {
    const Lane& right = *(left - 1);
    const double begin_d_m = right.d_m + right.edge_m;
    const double across = (d_m - begin_d_m) / (left->d_m - left->edge_m - begin_d_m);
    point_m.z() =
        std::lerp(PanelEdge(right, 1.0, s_m).z(), PanelEdge(*left, -1.0, s_m).z(), across);
  }
  return point_m;
}

bool CrossingRoad::Covers(double s_m, double d_m) const {
  return s_m >= begin_s_m() && s_m <= end_s_m() && d_m >= right_d_m_ && d_m <= left_d_m_;
}

std::optional<double> CrossingRoad::GroundLimit_m(double s_m, double d_m) const {
  const double on_s_m = std::clamp(s_m, begin_s_m(), end_s_m());
  const double on_d_m = std::clamp(d_m, right_d_m_, left_d_m_);
  if (std::max(std::abs(s_m - on_s_m), std::abs(d_m - on_d_m)) > kGroundMargin_m) {
    return std::nullopt;
  }
  return PointAt(on_s_m, on_d_m).z() - kGroundBelowRoad_m;
}

std::vector<CrossingRoad> RoadsNear(const ChunkContext& context, const ChainageRange& range) {
  std::vector<CrossingRoad> roads;
  for (const StructureSpec& structure : context.spec.structures) {
    const auto* crossing = std::get_if<LevelCrossingSpec>(&structure);
    if (crossing == nullptr) continue;
    const double reach_m = 0.5 * crossing->road_width_m + kGroundMargin_m;
    if (crossing->s_m + reach_m < range.begin_s_m) continue;
    if (crossing->s_m - reach_m > range.end_s_m) continue;
    roads.emplace_back(context, *crossing);
  }
  return roads;
}

}  // namespace railcast
