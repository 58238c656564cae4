#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "viewer/color/palette.h"
#include "viewer/plan/plan_stretch.h"

namespace railcast {

/// The sheet of a plan: metres in plan, the origin where the alignment is at the stretch's
/// beginning, x towards where it is at the stretch's end, y to the left of that.
struct PlanFrame {
  Eigen::Vector2d origin_m;
  Eigen::Vector2d ahead;  ///< Of length 1.

  [[nodiscard]] Eigen::Vector2d Turned(const Eigen::Vector2d& world) const;
  [[nodiscard]] Eigen::Vector2d At(const Vector3& world_m) const;
};

/// What a plan draws, in the frame of its sheet.
struct Plan {
  struct Line {
    std::vector<Eigen::Vector2d> points_m;
    Rgb rgb{};
    double width_px = 1.0;
    float opacity = 1.0F;
  };
  /// A triangle of fixed size on paper, its tip at `at_m`, or a square about it.
  struct Mark {
    Eigen::Vector2d at_m;
    Eigen::Vector2d from_tip;  ///< Unit vector from the tip to the base; 0 for squares.
    Rgb rgb{};
  };
  /// A word above its place, or to the right of it.
  struct Word {
    Eigen::Vector2d at_m;
    std::string text;
    Rgb rgb{};
    bool is_above{};
  };
  enum class Sample : std::uint8_t { kLine, kBand, kTriangle, kSquare };
  /// A line of the legend.
  struct Entry {
    std::string text;
    Rgb rgb{};
    Sample sample{};
  };
  PlanStretch stretch;
  Eigen::Vector2d north;    ///< Direction of the world's y axis on the sheet.
  std::vector<Line> lines;  ///< Later ones lie over those before.
  std::vector<Mark> marks;
  std::vector<Word> words;
  std::vector<Entry> entries;
};

/// What a plan is drawn of.
struct PlanScene {
  const ScenarioSpec& scenario;
  const RailWorld& world;
  PlanStretch stretch;
  PlanFrame frame;
};

[[nodiscard]] PlanScene ScenePlanned(const ScenarioSpec& scenario,
                                     const RailWorld& world,
                                     const PlanStretch& stretch);

/// Colour of a track: those with neighbouring indices differ, also for the colour-blind.
[[nodiscard]] Rgb PlanTrackRgb(std::size_t track);

inline constexpr Rgb kPlanStraightRgb{235, 235, 235};
inline constexpr Rgb kPlanDivergingRgb{255, 70, 70};

/// The line `d_m` left of a track's axis between two chainages, as far as the track and the stretch
/// extend: the ends and points at most 1 m or a 4000th of the stretch apart. Empty if nothing of it
/// lies in the stretch.
[[nodiscard]] std::vector<Eigen::Vector2d> PlanPoints(const PlanScene& scene,
                                                      const TrackCourse& course,
                                                      const PlanStretch& part,
                                                      double d_m);

/// Adds the structures in the stretch: outlines, lines and marks in the colour of their type, and
/// the legend's entries of the types that are there.
void AddStructuresToPlan(const PlanScene& scene, Plan& plan);

/// Makes the plan of a scenario at time 0.
[[nodiscard]] Plan MakePlan(const ScenarioSpec& scenario,
                            const RailWorld& world,
                            const PlanStretch& stretch);

}  // namespace railcast
