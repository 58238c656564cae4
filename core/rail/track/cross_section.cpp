#include "core/rail/track/cross_section.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/error.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/line/rail_section.h"

namespace railcast {
namespace {

constexpr double kBallastSlope = 1.0 / 1.5;

/// Depth and extent of the hollow in the ballast around a sleeper.
constexpr double kSleeperHollow_m = 0.020;
constexpr double kSleeperHollowReach_m = 0.2;

/// Where the hollow beyond a sleeper's end has faded out.
constexpr double kHollowEnd_m = kSleeperHalfLength_m + 0.45;

/// The rails of standard gauge, and where the ballast has its height outside them.
constexpr double kRailMiddle_m = 0.75;
constexpr double kOutsideBegin_m = 0.90;

/// Between the rails, the ballast follows the lower middle part of a concrete sleeper.
constexpr double kMiddleEnd_m = 0.45;
constexpr double kSeatBegin_m = 0.60;

/// 1 at the middle of a sleeper, falling to 0 within kSleeperHollowReach_m.
double ClosenessToASleeper(double s_m) {
  const double distance_m = std::abs(s_m - kSleeperSpacing_m * std::round(s_m / kSleeperSpacing_m));
  return std::max(0.0, 1.0 - distance_m / kSleeperHollowReach_m);
}

/// From the shoulder, the slope takes about 0.8 m to reach the formation.
constexpr double kBallastReach_m = 3.0;

/// Beyond the end of a track that is not as high as the line there, the formation returns to the
/// height of the line over this length.
constexpr double kLiftFades_m = 30.0;

// As RotationFromYawPitchRoll() without pitch and roll, at a third of its cost: persons are placed
// on the ground many times a frame.
Eigen::Matrix3d LevelRotation(double yaw_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ())).toRotationMatrix();
}

bool IsBallasted(const ChunkContext& context, double s_m, double d_m) {
  if (context.unballasted != nullptr && context.unballasted->Know(s_m)) {
    return !context.unballasted->Cover(s_m, d_m);
  }
  return !IsCleared(context, s_m, d_m, Clearing::kBallast);
}

}  // namespace

std::vector<double> SleeperPlaces(const ChunkContext& context) {
  // One step beyond the chunk on either side, so that rounding neither loses nor duplicates a
  // sleeper.
  const auto first = static_cast<std::int64_t>(std::floor(context.begin_s_m / kSleeperSpacing_m));
  const auto last = static_cast<std::int64_t>(std::ceil(context.end_s_m / kSleeperSpacing_m));
  std::vector<double> places_m;
  for (std::int64_t k = first; k <= last; ++k) {
    const double s_m = static_cast<double>(k) * kSleeperSpacing_m;
    if (s_m >= context.begin_s_m && s_m < context.end_s_m) places_m.push_back(s_m);
  }
  return places_m;
}

SleeperSeat SeatOf(SleeperType sleeper) {
  // B70: 214 mm high below the rail on a 10 mm pad, 175 mm in the middle. Wood: level, below a
  // baseplate 18 mm thick.
  if (sleeper == SleeperType::kConcrete) return {.top_m = -0.182, .middle_drop_m = 0.039};
  return {.top_m = -0.190, .middle_drop_m = 0.0};
}

double ShoulderOf_m(const WorldSpec& spec) {
  return kSleeperHalfLength_m + spec.ballast.shoulder_m + RailShift_m(spec.alignment);
}

CrossSection::CrossSection(const ChunkContext& context, double s_m)
    : s_m_(s_m),
      shift_m_(RailShift_m(context.spec.alignment)),
      shoulder_m_(ShoulderOf_m(context.spec)),
      below_sleepers_m_(context.spec.ballast.below_sleepers_m),
      outside_below_m_(context.spec.ballast.outside_below_sleepers_m.value_or(below_sleepers_m_)),
      sleeper_closeness_(ClosenessToASleeper(s_m)) {
  Check(!context.spec.tracks.empty(), "a line has a track");
  const AxisPoint axis = context.alignment.At(s_m);
  const Transform world_from_axis = MakeTransform(LevelRotation(axis.heading_rad), axis.position_m);
  chunk_from_axis_ = context.chunk_from_world * world_from_axis;
  const Transform axis_from_world = world_from_axis.inverse();
  const Vector3 left(-std::sin(axis.heading_rad), std::cos(axis.heading_rad), 0.0);
  for (std::size_t i = 0; i < context.tracks.size(); ++i) {
    const TrackCourse& track = context.tracks[i];
    const double on_s_m = std::clamp(s_m, track.begin_s_m(), track.end_s_m());
    const TrackOffset offset = track.OffsetAt(on_s_m);
    const double lift_share = std::max(0.0, 1.0 - std::abs(s_m - on_s_m) / kLiftFades_m);
    const TrackLift lift = lift_share > 0.0 ? track.LiftAt(context.alignment, on_s_m) : TrackLift{};
    // As Alignment::WorldFromTrack() has it, which would evaluate the axis once more.
    const Vector3 middle_m = axis_from_world * (axis.position_m + offset.d_m * left);
    tracks_.push_back({.d_m = middle_m.y(),
                       .height_m = middle_m.z() + lift_share * lift.h_m,
                       .cant_rad = axis.cant_rad,
                       .turn_rad = TurnFromAlignment_rad(axis, offset),
                       .begin_s_m = track.begin_s_m(),
                       .end_s_m = track.end_s_m(),
                       .seat = SeatOf(context.spec.tracks[i].sleeper),
                       .has_ballast = std::max(track.begin_s_m() - s_m, s_m - track.end_s_m()) <
                                          kBallastReach_m &&
                                      IsBallasted(context, s_m, offset.d_m),
                       .is_everywhere = track.is_parallel()});
  }
  std::sort(tracks_.begin(), tracks_.end(),
            [](const TrackHere& a, const TrackHere& b) { return a.d_m < b.d_m; });
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].has_ballast) ballasted_.push_back(i);
  }
}

double CrossSection::FormationHeight_m(double d_m) const {
  const auto left = std::find_if(tracks_.begin(), tracks_.end(),
                                 [&](const TrackHere& track) { return track.d_m > d_m; });
  if (left == tracks_.begin()) return left->height_m - kFormationDepth_m;
  const auto right = left - 1;
  if (left == tracks_.end()) return right->height_m - kFormationDepth_m;
  const double fraction = (d_m - right->d_m) / (left->d_m - right->d_m);
  return std::lerp(right->height_m, left->height_m, fraction) - kFormationDepth_m;
}

double CrossSection::BallastHeight_m(double d_m) const {
  double height_m = -std::numeric_limits<double>::infinity();
  for (const std::size_t index : ballasted_) {
    const TrackHere& track = tracks_[index];
    if (std::abs(d_m - track.d_m) - shoulder_m_ < kBallastReach_m) {
      height_m = std::max(height_m, BallastHeightOf(track, d_m));
    }
  }
  return height_m;
}

double CrossSection::BeyondEnd_m(const TrackHere& track, double s_m) {
  return std::max({0.0, track.begin_s_m - s_m, s_m - track.end_s_m});
}

double CrossSection::BallastHeightOf(const TrackHere& track, double d_m) const {
  double lateral_m = (d_m - track.d_m) / std::cos(track.cant_rad);
  double foot_s_m = s_m_;
  double sleeper_closeness = sleeper_closeness_;
  if (track.turn_rad != 0.0) {
    // The nearest point of the track, beside which the sleeper that matters lies.
    foot_s_m += (d_m - track.d_m) * std::sin(track.turn_rad) * std::cos(track.turn_rad);
    sleeper_closeness = ClosenessToASleeper(foot_s_m);
    lateral_m *= std::cos(track.turn_rad);
  }
  const double on_top_m = std::clamp(lateral_m, -shoulder_m_, shoulder_m_);
  // Where it would be on standard gauge, but for the middle of the sleeper.
  const double on_standard_m = std::abs(on_top_m) - shift_m_;
  const double beyond_m = std::max(std::abs(lateral_m - on_top_m), BeyondEnd_m(track, foot_s_m));
  const double seat_fraction =
      std::clamp((on_standard_m - kMiddleEnd_m) / (kSeatBegin_m - kMiddleEnd_m), 0.0, 1.0);
  const double sleeper_fraction =
      std::clamp((kHollowEnd_m - on_standard_m) / (kHollowEnd_m - kSleeperHalfLength_m), 0.0, 1.0);
  const double outside_fraction =
      std::clamp((on_standard_m - kRailMiddle_m) / (kOutsideBegin_m - kRailMiddle_m), 0.0, 1.0);
  const double top_m = track.seat.top_m - (1.0 - seat_fraction) * track.seat.middle_drop_m -
                       std::lerp(below_sleepers_m_, outside_below_m_, outside_fraction) -
                       sleeper_fraction * sleeper_closeness * kSleeperHollow_m;
  return track.height_m + top_m * std::cos(track.cant_rad) + on_top_m * std::sin(track.cant_rad) -
         beyond_m * kBallastSlope;
}

double CrossSection::DistanceFromTracks_m(double d_m) const {
  return DistanceFromTracksIf_m(d_m, [](double) { return true; });
}

Vector3 CrossSection::PointAt(double d_m, double height_m) const {
  return chunk_from_axis_ * Vector3(0.0, d_m, height_m);
}

}  // namespace railcast
