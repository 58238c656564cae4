#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/estimate/estimate.h"
#include "core/fidelity/echoes_by_range.h"
#include "railcast/frame.h"
#include "railcast/simulator.h"

namespace railcast {

/// Width of the range bins.
inline constexpr double kDetailBin_m = 50.0;
/// With fewer echoes in full detail an interval is wider than what it is for.
inline constexpr double kLeastDetailEchoes = 400.0;
/// With fewer frames the differences between them give no interval.
inline constexpr std::size_t kLeastDetailFrames = 10;

/// How the echoes of one label in one range bin differ from those of the same row in full detail:
/// relative changes, of which 0 is none. Intervals are of 95 %, from the differences between
/// frames; their numbers are those of the echoes in full detail.
struct DetailDifference {
  std::uint32_t label{};
  int bin{};           ///< In steps of kDetailBin_m.
  Estimate first;      ///< Difference in the number of nearest echoes of their firings.
  Estimate further;    ///< Difference in the number of all others.
  Estimate intensity;  ///< Difference in the mean intensity of the first ones.
};

/// The differences wherever there are enough first echoes in full detail, by label and by range.
/// @pre Both hold the same frames, in bins of kDetailBin_m.
[[nodiscard]] std::vector<DetailDifference> DifferencesOfDetail(const EchoesByRange& full,
                                                                const EchoesByRange& coarser);

/// How one frame sees an object on the way to it.
struct ApproachPoints {
  double distance_m{};  ///< From the sensor to the nearest point of the object's box.
  std::uint32_t points_in_reference{};
  std::uint32_t points{};
};

/// An object that comes nearer, as the reference and a row see it.
struct Approach {
  std::string object;
  std::uint32_t instance{};
  std::vector<ApproachPoints> points;  ///< By frame, in order of time.
};

/// The distance from which on an object has enough points: between the
/// first frame that has them and the one before, it is interpolated in the logarithms of points and
/// distance. NaN if the first frame has them already or if it comes no nearer than the frame before
/// has been; 0 if no frame has them.
/// @param points ApproachPoints::points_in_reference or ::points.
[[nodiscard]] double DetectionDistance_m(const Approach& approach,
                                         std::uint32_t ApproachPoints::*points,
                                         std::uint32_t min_points = DetectionRule{}.min_points);

/// Mean over the objects whose detection distance the reference tells of |distance / distance of
/// the reference - 1|; NaN if there is none.
[[nodiscard]] double DetectionDistanceError(const std::vector<Approach>& approaches);

/// The objects of a world except the sensor's own vehicle, without any points.
[[nodiscard]] std::vector<Approach> ApproachesIn(const World& world);

/// Adds a frame's points on each object that is nearer than in the frame before.
/// @param reference, other The same frame of the simulator.
void AddApproach(const Simulator& simulator,
                 const Frame& reference,
                 const Frame& other,
                 std::vector<Approach>& approaches);

}  // namespace railcast
