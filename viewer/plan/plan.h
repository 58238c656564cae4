#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "viewer/color/palette.h"

namespace railcast {

/// The part of a line that a plan shows.
struct PlanStretch {
  double from_s_m{};  ///< Chainages of the alignment: from_s_m < to_s_m.
  double to_s_m{};

  [[nodiscard]] double length_m() const { return to_s_m - from_s_m; }
  [[nodiscard]] bool Holds(double s_m) const { return s_m >= from_s_m && s_m <= to_s_m; }
};

/// How much of the line a plan shows by itself on either side of where its tracks branch.
inline constexpr double kPlanMargin_m = 50.0;

/// Returns the stretch that a plan shows unless told otherwise: all tracks that do not run along
/// the whole line, and all turnouts, with kPlanMargin_m on either side as far as the line extends.
/// The whole line, if there are none.
[[nodiscard]] PlanStretch NetworkStretch(const RailWorld& world);

/// Returns the stretch between two given chainages, or NetworkStretch() if none are given.
/// @throws InputError if they lie beyond the line's ends or the first is not the lesser.
[[nodiscard]] PlanStretch ChosenStretch(const RailWorld& world,
                                        const std::optional<std::array<double, 2>>& ends_m);

/// Returns the smallest of 1, 2, 5, 10, 20, 50, ... that is not less than `value` > 0.
[[nodiscard]] double RoundUp125(double value);

/// The sheet of a plan: metres in plan, the origin where the alignment is at the stretch's
/// beginning, x towards where it is at the stretch's end, y to the left of that.
struct PlanFrame {
  Eigen::Vector2d origin_m;
  Eigen::Vector2d ahead;  ///< A vector of length 1.

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
