#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "generator/extras/import/fit/line_fit.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/rail_map.h"
#include "railcast/alignment.h"

namespace railcast {

/// A point of the map that lies far from the line that all the others make.
struct Contradiction {
  double s_m{};       ///< Chainage of its foot.
  double offset_m{};  ///< Left positive.
  Eigen::Vector2d geographic_deg = Eigen::Vector2d::Zero();
};

/// How well a line fits its points, and what it is made of.
struct LineQuality {
  std::size_t num_points{};
  std::size_t num_elements{};
  double length_m{};
  double median_m{};  ///< Median of the points' distances from the line.
  double p99_m{};
  double largest_m{};
  /// For a cubic spline through the points, as they were; 0 if it has a cusp.
  double tightest_radius_before_m{};
  double tightest_radius_m{};           ///< Infinite if the line is straight.
  double needed_radius_m{};             ///< For the speed at the tightest place.
  double sign_changes_before_per_km{};  ///< Changes of sign of the spline's curvature.
  double sign_changes_per_km{};
};

/// Heights farther from the gradients are told; if one in a hundred is farther than the other, they
/// are none of the line.
inline constexpr double kFarHeight_m = 5.0;
inline constexpr double kFarthestHeight_m = 20.0;

/// How well a line's gradients fit its heights.
struct HeightQuality {
  std::size_t num_points{};
  double median_m{};  ///< Median of the heights' distances from the line.
  double p99_m{};
  std::size_t num_far{};  ///< Heights farther off than kFarHeight_m.
  double far_s_m{};       ///< Chainage of the first of them.
  std::size_t num_gradients{};
  double steepest_permil{};
  /// The smallest radius of a vertical curve as a share of the one that its speed needs; infinite
  /// without any.
  double least_roundness{};
};

/// A line of the map as an alignment.
struct ImportedLine {
  std::string name;
  AlignmentSpec alignment;
  LineQuality quality;
  std::vector<Contradiction> contradictions;  ///< Points farther away than 1.5 m.
  std::vector<double> chainages_m;            ///< Chainages of the feet of the TrackLine's nodes.
  std::vector<double> offsets_m;              ///< Offsets of these nodes, left positive.
  double height_sigma_m{};                    ///< ImportOptions::height_sigma_m.
  std::optional<HeightQuality>
      height_quality;  ///< Absent if the line is level for want of heights.
};

struct ImportOptions {
  double sigma_m = 0.3;          ///< Standard deviation of mapped points across the track.
  double height_sigma_m = 2.0;   ///< Sigma of the heights.
  double otherwise_kmph = 80.0;  ///< For running tracks where the map gives no speed.
};

/// The value a share of the way through ascending ones; 0 if there are none.
[[nodiscard]] double QuantileOf(const std::vector<double>& sorted, double share);

/// Fits straights, arcs and clothoids to a line (FitLine). Its speed limits are the map's or, where
/// that has none, those of its kind and its arcs (SpeedLimitsOf). Its heights are all 0 until
/// SetHeights.
[[nodiscard]] ImportedLine ImportLine(const RailMap& map,
                                      const TrackLine& line,
                                      const ImportOptions& options,
                                      const TellShare& tell = {});

}  // namespace railcast
