#pragma once

#include <functional>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/track/cross_section.h"
#include "railcast/structures.h"

namespace railcast {

/// The face of a retaining wall leans back by this share of its height; at its top, it is so thick.
inline constexpr double kRetainingBatter = 0.1;
inline constexpr double kRetainingThickness_m = 0.4;
/// Distance of the wall's back, which is upright, from its track's axis.
[[nodiscard]] inline double BackOf_m(const RetainingWallSpec& wall) {
  return wall.distance_m + kRetainingBatter * wall.height_m + kRetainingThickness_m;
}

/// Heights of the ground at a place, above the formation there.
struct GroundHeights {
  double terrain_m{};  ///< Of the land as it was before the line was built.
  double built_m{};    ///< With cuttings and embankments, but without walls.
};

struct GroundPlace {
  double s_m{};
  double d_m{};  ///< Left of the alignment.
};

/// The ground behind the retaining walls along a stretch of the line. At the wall's back it is as
/// high as the top, and from there it rises or falls at 1:1.5 to the terrain. Towards the ends of
/// the wall, it passes at 1:1.5 to the ground without it; where one wall continues another, it does
/// not. Tracks behind a wall keep their formation. The world must outlive it.
class RetainedGround {
 public:
  /// Where the ground changes its height at one chainage, left of the alignment: the ground before
  /// the wall ends at `front_m` and that behind it at `back_m`, both inside the wall.
  struct Step {
    double front_m{};
    double back_m{};
  };

  RetainedGround(const ChunkContext& context, double begin_s_m, double end_s_m);

  [[nodiscard]] bool empty() const { return walls_.empty(); }
  [[nodiscard]] bool AnyIn(double from_s_m, double to_s_m) const;
  [[nodiscard]] std::size_t num_walls() const { return walls_.size(); }
  /// Height of the ground above the formation at (s, d), d being left of the alignment.
  /// @param is_in_tunnel Tells by its d which tracks have a hill above them instead of a formation.
  [[nodiscard]] double Height_m(const CrossSection& section,
                                const GroundPlace& place,
                                const GroundHeights& without,
                                const std::function<bool(double)>& is_in_tunnel) const;
  /// From 0 at the back of a wall to 1 a metre and more behind it, and wherever there is none.
  [[nodiscard]] double Roughness(double s_m, double d_m) const;
  /// Whether a wall stands all along a stretch.
  [[nodiscard]] bool Stands(std::size_t wall, double from_s_m, double to_s_m) const;
  [[nodiscard]] Step StepAt(std::size_t wall, double s_m) const;

 private:
  struct Wall {
    const RetainingWallSpec* spec;
    const TrackCourse* track;
    double back_m{};      ///< From the track's axis, left positive.
    bool goes_on_before;  ///< Another wall ends where it begins.
    bool goes_on_behind;
  };

  /// Distance behind the back of a wall; negative before the step.
  [[nodiscard]] static double Behind_m(const Wall& wall, double s_m, double d_m);

  const ChunkContext* context_;
  std::vector<Wall> walls_;  ///< Those nearer to their tracks first.
};

}  // namespace railcast
