#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/track/found_track.h"
#include "core/track/track_search.h"

namespace railcast {
namespace {

constexpr double kNarrowest_m = 0.6;
constexpr double kWidest_m = 1.7;
constexpr double kGaugeStep_m = 0.03;
constexpr double kMostGaugeError_m = 0.03;

/// Gauges to try at once, the likelier ones before others.
std::vector<std::vector<double>> GaugesToTry(std::optional<double> gauge_m) {
  if (gauge_m) return {{*gauge_m}};
  std::vector<double> any;
  for (double each_m = kNarrowest_m; each_m < kWidest_m; each_m += kGaugeStep_m)
    any.push_back(each_m);
  return {{kNamedGauges_m.begin(), kNamedGauges_m.end()}, any};
}

/// Gives the angles of the sensor in the track's axes, whose x is turned to where the sensor faces.
void Describe(const Eigen::Matrix3d& local_from_sensor, FoundTrack& track) {
  Transform& track_from_sensor = track.track_from_sensor;
  track_from_sensor.linear() = track_from_sensor.linear() * local_from_sensor;
  Eigen::Matrix3d turn = track_from_sensor.linear();
  const Vector3 place_m = track_from_sensor.translation();
  // A sensor that faces across the track, or along its own axis up, has no direction of travel; its
  // y then decides.
  const bool faces_along = std::abs(turn(0, 0)) > 0.2;
  const double ahead = faces_along ? turn(0, 0) : turn(0, 1);
  if (ahead < 0.0) {
    Eigen::Matrix3d about;
    about << -1, 0, 0, 0, -1, 0, 0, 0, 1;
    track_from_sensor.linear() = about * turn;
    track_from_sensor.translation() = about * place_m;
    track.curvature_per_m.value = -track.curvature_per_m.value;
    std::swap(track.points[0], track.points[1]);
    track.first_m = -std::exchange(track.last_m, -track.first_m);
    turn = track_from_sensor.linear();
  }
  track.height_m.value = track_from_sensor.translation().z();
  track.sideways_m.value = track_from_sensor.translation().y();
  track.yaw_rad.value = std::atan2(turn(1, 0), turn(0, 0));
  track.pitch_rad.value = std::asin(std::clamp(-turn(2, 0), -1.0, 1.0));
  track.roll_rad.value = std::atan2(turn(2, 1), turn(2, 2));
}

/// Whether one is where the other is seen: tracks are 3 m apart, except at turnouts.
bool AreSame(const FoundTrack& a, const FoundTrack& b) {
  constexpr double kSame_m = 0.6;
  const double x_m = 0.5 * (b.first_m + b.last_m);
  const Vector3 middle_m(x_m, ArcRise_m(b.curvature_per_m.value, x_m), 0.0);
  return std::abs(a.Place_m(b.track_from_sensor.inverse() * middle_m).y()) < kSame_m;
}

/// The points in axes that a track may have.
struct SeenPoints {
  Eigen::Matrix3d local_from_sensor;
  std::vector<Vector3> local_m;
  std::vector<Vector3> raised_m;
};

SeenPoints SeenIn(const Eigen::Matrix3d& local_from_sensor,
                  const std::vector<Eigen::Vector3f>& points_m) {
  SeenPoints seen{.local_from_sensor = local_from_sensor, .local_m = {}, .raised_m = {}};
  std::vector<Eigen::Vector3f> float_m;
  for (const Eigen::Vector3f& point_m : points_m) {
    seen.local_m.emplace_back(local_from_sensor * point_m.cast<double>());
    float_m.emplace_back(seen.local_m.back().cast<float>());
  }
  seen.raised_m = RaisedPoints(float_m);
  return seen;
}

/// The pair of ridges with the highest score that is no track.
struct BestRefused {
  double score{};
  std::string why_not;
};

std::vector<FoundTrack> TracksIn(const SeenPoints& seen,
                                 const std::vector<double>& gauges_m,
                                 BestRefused& refused) {
  std::vector<double> apart_m;
  for (const double each_m : gauges_m) apart_m.push_back(each_m + kHeadWidth_m);
  std::vector<TrackFit> fits;
  for (const TrackGuess& guess : GuessTracks(seen.raised_m, apart_m)) {
    TrackFit fit = FitTrack(seen.local_m, seen.raised_m, guess);
    const bool is_gauge = std::ranges::any_of(gauges_m, [&](double each_m) {
      return std::abs(fit.track.gauge_m.value - each_m) < kMostGaugeError_m;
    });
    if (fit.why_not.empty() && !is_gauge) fit.why_not = "its ridges are not a gauge apart";
    if (!fit.why_not.empty()) {
      if (guess.score > refused.score) refused = {guess.score, fit.why_not};
      continue;
    }
    Describe(seen.local_from_sensor, fit.track);
    const auto same = std::ranges::find_if(
        fits, [&](const TrackFit& other) { return AreSame(other.track, fit.track); });
    if (same == fits.end()) {
      fits.push_back(std::move(fit));
    } else if (fit.quality > same->quality) {
      *same = std::move(fit);
    }
  }
  std::vector<FoundTrack> tracks;
  for (TrackFit& fit : fits) tracks.push_back(std::move(fit.track));
  std::ranges::stable_sort(
      tracks, {}, [](const FoundTrack& track) { return std::abs(track.sideways_m.value); });
  return tracks;
}

}  // namespace

FoundTracks FindTracks(const std::vector<Eigen::Vector3f>& points_m,
                       std::optional<double> gauge_m) {
  const std::vector<Eigen::Matrix3d> axes = FindGroundAxes(points_m);
  if (axes.empty()) return {{}, "no ground is seen"};
  BestRefused refused;
  std::vector<SeenPoints> seen;
  for (const std::vector<double>& gauges_m : GaugesToTry(gauge_m)) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (i == seen.size()) seen.push_back(SeenIn(axes[i], points_m));
      auto tracks = TracksIn(seen[i], gauges_m, refused);
      if (!tracks.empty()) return {std::move(tracks), ""};
    }
  }
  return {{},
          refused.why_not.empty() ? "no pair of ridges stands out of the ground"
                                  : "of the likeliest pair of ridges, " + refused.why_not};
}

}  // namespace railcast
