#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/track/found_track.h"
#include "railcast/transform.h"

// The steps of FindTracks().

namespace railcast {

/// Returns axes that a track may have, the most likely first: rotations into axes whose z is the
/// normal, up to the sensor, of a plane that many of the points are in, and whose x is nearest to
/// the sensor's x, or to its y where x is nearly the normal. Planes whose normal is within 35
/// degrees of the sensor's z come first.
/// @param points_m In the sensor's axes, finite. Those up to 30 m away count.
[[nodiscard]] std::vector<Eigen::Matrix3d> FindGroundAxes(
    const std::vector<Eigen::Vector3f>& points_m);

/// Points that lie 0.06 to 0.4 m above the ground about them and are among the highest there, one
/// for each square of 5 cm, by their distance from the sensor. Where most points are so high, as in
/// grass, there are none.
/// @param points_m In axes with z up and the sensor at 0.
[[nodiscard]] std::vector<Vector3> RaisedPoints(const std::vector<Eigen::Vector3f>& points_m);

/// A pair of ridges that may be a track, in axes with z up and the sensor at 0.
struct TrackGuess {
  double heading_rad{};      ///< Where the pair leads beside the sensor, from x to the left.
  double curvature_per_m{};  ///< Left positive.
  double sideways_m{};  ///< From the sensor to the pair's middle, left of the heading positive.
  double apart_m{};     ///< From middle to middle of the ridges.
  /// Points of one of the ridges, whichever has fewer, less those beside it: one for each 5 cm.
  double score{};
};

/// Finds pairs of ridges, those with the highest score first, by counting raised points in strips
/// along curves of all headings with radii from 170 m.
/// @param apart_m Distances that their middles may have.
[[nodiscard]] std::vector<TrackGuess> GuessTracks(const std::vector<Vector3>& raised_m,
                                                  const std::vector<double>& apart_m);

/// Weighted least squares with prior knowledge of its parameters, and with errors that points of a
/// cluster have in common.
class ClusteredFit {
 public:
  using Row = Eigen::Matrix<double, 5, 1>;
  using Square = Eigen::Matrix<double, 5, 5>;

  /// @param prior Standard deviations about 0.
  explicit ClusteredFit(const Row& prior) : information_(prior.array().square().inverse()) {}

  void Add(const Row& row, double value, double weight, int cluster) {
    rows_.push_back({row, value, weight, cluster});
  }

  /// @return False where there are too few.
  bool Solve();

  Row solution = Row::Zero();
  Square covariance = Square::Zero();

 private:
  struct Sample {
    Row row;
    double value{}, weight{};
    int cluster{};
  };
  Row information_;
  std::vector<Sample> rows_;
};

/// Standard deviation of a track's vertical curvature. Vertical curves have radii from 3 km. A
/// canted curve leaves the plane that touches it: it bends in plan, not in that plane, by the sine
/// of a cant of up to 160 mm.
[[nodiscard]] double BendSigma_per_m(double curvature_per_m);

/// A track that was laid on the points, in axes with z up and the sensor at 0.
struct TrackFit {
  FoundTrack track{};
  /// Points near the middle of the head that has fewer of them, weighted by how near: the more, the
  /// better the curve of the track follows its heads.
  double quality{};
  std::string why_not{};  ///< Why it is no track, as a clause; empty if it is one.
};

/// Lays the heads of two rails on the points near a guess, by weighted least squares in turn for
/// their height and for their place across, and says whether they are rails.
///
/// Points within a few centimetres of the top are those of a head. Where the head is across follows
/// from its edge that faces the sensor: near the other one, beams return from what is behind. The
/// fit begins near the sensor and goes on along what it has found. Intervals come from how the
/// residuals of each half metre of a head differ (a sandwich estimate), and from what the shape of
/// heads leaves open.
///
/// @param points_m In axes with z up and the sensor at 0.
/// @param raised_m RaisedPoints() of them.
[[nodiscard]] TrackFit FitTrack(const std::vector<Vector3>& points_m,
                                const std::vector<Vector3>& raised_m,
                                const TrackGuess& guess);

/// Says why two ridges are no rails, as a clause; empty if they are. Rails have lower ground on
/// both sides, which tells them from kerbs and platforms; it is a rail's height below, which tells
/// them from cables and wires; they are no wider than a head, which tells them from pipes and
/// troughs; and both are seen where the ground between them is.
/// @param places_m Points beside the ridges: along, left of their middle, above their tops.
/// @param apart_m Of the ridges' middles. @param scatter_m Of the points on the tops.
/// @param track Receives where and how continuously the ridges are seen.
[[nodiscard]] std::string WhyNoRails(const std::vector<Vector3>& places_m,
                                     double apart_m,
                                     double scatter_m,
                                     FoundTrack& track);

}  // namespace railcast
