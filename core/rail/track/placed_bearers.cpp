#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/rail/line/rail_section.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/long_bearers.h"
#include "core/rail/track/switch_parts.h"

namespace railcast {
namespace {

/// Tracks whose planes differ by more than this at their axes do not share a part of a bearer.
constexpr double kSamePlane_m = 0.010;
/// Parts of a bearer are cut only where the rails on both sides keep their feet on it.
constexpr double kLeastApartForCut_m = 1.7;
constexpr double kHalfCut_m = 0.03;

/// A track on a bearer.
struct TrackOnBearer {
  std::size_t track{};
  double s_m{};       ///< Its chainage where its axis passes the bearer.
  double at_m{};      ///< How far left of the bearer's own place that is, along the bearer.
  double turn_rad{};  ///< From the track's heading to that to which the bearer is square.
};

/// Neighbouring tracks in one plane.
struct BearerPart {
  std::vector<TrackOnBearer> tracks;
  double right_m{};  ///< Its ends, along the bearer.
  double left_m{};
  bool is_cut_right{};
  bool is_cut_left{};
};

/// Places a bearer with its plates, part by part.
class BearerPlacing {
 public:
  BearerPlacing(const ChunkContext& context, const LongBearer& bearer)
      : context_(context), bearer_(bearer) {}

  [[nodiscard]] std::vector<BearerPart> Parts() const {
    std::vector<BearerPart> parts;
    for (const std::size_t index : bearer_.tracks) {
      const TrackOnBearer track = OnBearer(index, 0.0);
      if (parts.empty()) {
        parts.push_back({.tracks = {track}, .right_m = track.at_m - kSleeperHalfLength_m});
      } else if (AreInOnePlane(parts.back().tracks.front(), track) ||
                 track.at_m - parts.back().tracks.back().at_m < kLeastApartForCut_m) {
        parts.back().tracks.push_back(track);
      } else {
        const double cut_m = std::midpoint(parts.back().tracks.back().at_m, track.at_m);
        parts.back().left_m = cut_m - kHalfCut_m;
        parts.back().is_cut_left = true;
        parts.push_back({.tracks = {track}, .right_m = cut_m + kHalfCut_m, .is_cut_right = true});
      }
    }
    parts.back().left_m = parts.back().tracks.back().at_m + kSleeperHalfLength_m;
    return parts;
  }

  void Add(const BearerPart& part, const TrackModels& models, Chunk& chunk) const {
    const MadeBearer bearer = BearerOf(models, bearer_.sleeper, part.left_m - part.right_m,
                                       part.is_cut_left && part.is_cut_right);
    // What it is longer than needed is where it is not cut.
    double middle_m = 0.5 * (part.left_m + part.right_m);
    if (part.is_cut_left != part.is_cut_right) {
      middle_m = part.is_cut_right ? part.right_m + 0.5 * bearer.length_m
                                   : part.left_m - 0.5 * bearer.length_m;
    }
    const TrackOnBearer& held = *std::ranges::min_element(
        part.tracks, {}, [](const TrackOnBearer& track) { return std::abs(track.turn_rad); });
    PlaceModel(bearer.model, ChunkFromBearer(held, middle_m), chunk);
    for (const TrackOnBearer& track : part.tracks) {
      for (const double side : {-1.0, 1.0}) AddPlate(track.track, side, models, chunk);
    }
  }

 private:
  /// Where the bearer passes a track, `aside_m` left of its axis.
  [[nodiscard]] TrackOnBearer OnBearer(std::size_t index, double aside_m) const {
    const TrackCourse& course = context_.tracks[index];
    const double sin_turn = std::sin(bearer_.heading_rad);
    const double cos_turn = std::cos(bearer_.heading_rad);
    TrackOnBearer track{.track = index, .s_m = bearer_.s_m};
    constexpr int kNumSteps = 8;
    for (int i = 0; i < kNumSteps; ++i) {
      const TrackOffset offset = course.OffsetAt(track.s_m);
      const double heading_rad = std::atan(offset.slope);
      const double ahead_m = track.s_m - aside_m * std::sin(heading_rad) - bearer_.s_m;
      const double left_m = offset.d_m + aside_m * std::cos(heading_rad) - bearer_.d_m;
      track.at_m = left_m * cos_turn - ahead_m * sin_turn;
      track.turn_rad = bearer_.heading_rad - heading_rad;
      track.s_m -= ahead_m * cos_turn + left_m * sin_turn;
    }
    return track;
  }

  [[nodiscard]] Transform ChunkFromTrack(const TrackOnBearer& track, double d_m) const {
    return StationOf(context_, {track.track, track.track}, false, {track.s_m, d_m});
  }

  /// The frame of a bearer whose middle is there, in the plane of a track.
  [[nodiscard]] Transform ChunkFromBearer(const TrackOnBearer& held, double middle_m) const {
    return ChunkFromTrack(held, 0.0) * Eigen::AngleAxisd(held.turn_rad, Vector3::UnitZ()) *
           Eigen::Translation3d(0.0, middle_m - held.at_m, 0.0);
  }

  [[nodiscard]] bool AreInOnePlane(const TrackOnBearer& a, const TrackOnBearer& b) const {
    if (context_.alignment.At(bearer_.s_m).cant_rad == 0.0) return true;
    const Vector3 b_from_a =
        ChunkFromTrack(a, 0.0).inverse() * Vector3(ChunkFromTrack(b, 0.0).translation());
    return std::abs(b_from_a.z()) <= kSamePlane_m;
  }

  /// On the bearer, below a rail's foot.
  void AddPlate(std::size_t index, double side, const TrackModels& models, Chunk& chunk) const {
    const double foot_m = side * RailFootMiddle_m().x();
    PlaceModel(PlateOf(models, bearer_.sleeper), ChunkFromTrack(OnBearer(index, foot_m), foot_m),
               chunk);
  }

  const ChunkContext& context_;
  const LongBearer& bearer_;
};

}  // namespace

void AddLongBearer(const ChunkContext& context,
                   const LongBearer& bearer,
                   const TrackModels& models,
                   Chunk& chunk) {
  const BearerPlacing placing(context, bearer);
  for (const BearerPart& part : placing.Parts()) placing.Add(part, models, chunk);
}

}  // namespace railcast
