#include <algorithm>
#include <cmath>

#include "core/rail/track/cross_section.h"
#include "core/rail/track/rail_section.h"
#include "core/rail/turnout/switch_parts.h"
#include "core/rail/turnout/turnout_structure.h"

namespace railcast {
namespace {

/// A straight across both tracks, square to the middle between them, in the plane of chainage and
/// offset.
struct AcrossLine {
  double s_m{};
  double d_m{};
  double heading_rad{};

  /// How far a place of the plane lies ahead of it.
  [[nodiscard]] double Ahead_m(double place_s_m, double place_d_m) const {
    return (place_s_m - s_m) * std::cos(heading_rad) + (place_d_m - d_m) * std::sin(heading_rad);
  }
};

/// The bearers of a diamond with the plates of its rails.
class DiamondBearers {
 public:
  DiamondBearers(const ChunkContext& context,
                 const LaidDiamond& diamond,
                 const InfrastructureModels& models)
      : context_(context), site_(diamond.site), models_(models) {}

  void AddAt(double s_m, Chunk& chunk) const {
    const TrackOffset first = context_.tracks[site_.first].OffsetAt(s_m);
    const TrackOffset second = context_.tracks[site_.second].OffsetAt(s_m);
    const double heading_rad = 0.5 * (std::atan(first.slope) + std::atan(second.slope));
    const AcrossLine line{s_m, 0.5 * (first.d_m + second.d_m), heading_rad};
    const double apart_m = (second.d_m - first.d_m) * std::cos(heading_rad);
    const SleeperType sleeper = context_.spec.tracks[site_.first].sleeper;
    const MadeBearer bearer =
        BearerOf(models_, sleeper, std::abs(apart_m) + 2.0 * kSleeperHalfLength_m);
    const double turn_rad = heading_rad - std::atan(first.slope);
    // From the first track's axis, whose frame is turned against the bearer.
    const Transform chunk_from_first = StationOf(
        context_, Pair(), false, {s_m, 0.5 * (second.d_m - first.d_m) * std::cos(turn_rad)});
    PlaceModel(bearer.model,
               Transform(chunk_from_first * Eigen::AngleAxisd(turn_rad, Vector3::UnitZ())), chunk);
    for (const bool on_second : {false, true}) {
      for (const double side : {-1.0, 1.0}) AddPlate(line, on_second, side, chunk);
    }
  }

 private:
  [[nodiscard]] PairOfTracks Pair() const { return {site_.first, site_.second}; }

  /// Where the bearer passes below a rail's foot.
  void AddPlate(const AcrossLine& line, bool on_second, double side, Chunk& chunk) const {
    const TrackCourse& course = context_.tracks[on_second ? site_.second : site_.first];
    const double foot_m = side * RailFootMiddle_m().x();
    double s_m = line.s_m;
    constexpr int kNumSteps = 8;
    for (int i = 0; i < kNumSteps; ++i) {
      const TrackOffset offset = course.OffsetAt(s_m);
      const double heading_rad = std::atan(offset.slope);
      s_m -= line.Ahead_m(s_m - foot_m * std::sin(heading_rad),
                          offset.d_m + foot_m * std::cos(heading_rad));
    }
    const SleeperType sleeper = context_.spec.tracks[site_.first].sleeper;
    PlaceModel(PlateOf(models_, sleeper), StationOf(context_, Pair(), on_second, {s_m, foot_m}),
               chunk);
  }

  const ChunkContext& context_;
  const DiamondSite& site_;
  const InfrastructureModels& models_;
};

bool IsNearDiamond(const ChunkContext& context, const DiamondSite& site) {
  // Its bearers may reach a little farther than its rails.
  return site.s_m > context.begin_s_m - 2.0 * kDiamondReach_m &&
         site.s_m < context.end_s_m + 2.0 * kDiamondReach_m;
}

}  // namespace

void AddDiamonds(const ChunkContext& context, const InfrastructureModels& models, Chunk& chunk) {
  for (const LaidDiamond& diamond : context.diamonds) {
    const DiamondSite& site = diamond.site;
    if (!IsNearDiamond(context, site)) continue;
    const DiamondCourses courses{site, context.tracks[site.first], context.tracks[site.second]};
    const PairOfTracks pair{site.first, site.second};
    for (const TurnoutRail& rail : RailsOf(courses)) AddRailPiece(context, pair, rail, chunk);
    for (const CheckRail& rail : CheckRailsOf(courses)) AddCheckRail(context, pair, rail, chunk);
    const DiamondBearers bearers(context, diamond, models);
    for (const double s_m : BearerPlaces(context, diamond.extent.bearers)) {
      bearers.AddAt(s_m, chunk);
    }
  }
}

}  // namespace railcast
