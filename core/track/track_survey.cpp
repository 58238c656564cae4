#include "core/track/track_survey.h"

#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/recorded_motion.h"
#include "core/track/track_points.h"

namespace railcast {
namespace {

double MedianOfCopy(std::vector<double> values) {
  return MedianOf(values);
}

FigureOfFrames OverFrames(const std::vector<const FoundTrack*>& tracks,
                          BoundedFigure FoundTrack::*figure) {
  std::vector<double> values;
  FigureOfFrames over;
  double least = 0.0;
  for (const FoundTrack* track : tracks) {
    const BoundedFigure& each = track->*figure;
    least = values.empty() ? each.margin : std::min(least, each.margin);
    values.push_back(each.value);
  }
  over.median.value = MedianOfCopy(values);
  std::vector<double> off;
  for (const double value : values) off.push_back(std::abs(value - over.median.value));
  over.sway = values.size() < 2 ? 0.0 : 1.4826 * MedianOf(off);
  // A median's standard error is 1.2533 times that of a mean.
  const double chance = 1.96 * 1.2533 * over.sway / std::sqrt(static_cast<double>(values.size()));
  over.median.margin = std::hypot(least, chance);
  const auto quarter = static_cast<std::ptrdiff_t>(values.size() / 4);
  if (quarter > 0) {
    over.drift = MedianOfCopy({values.end() - quarter, values.end()}) -
                 MedianOfCopy({values.begin(), values.begin() + quarter});
  }
  return over;
}

/// The track of each frame that lies like the most others do.
void ChooseOwn(std::vector<TracksOfFrame>& frames) {
  constexpr double kMostAside_m = 0.3;
  constexpr double kMostHeight_m = 0.15;
  constexpr double kMostTurn_rad = RadFromDeg(3.0);
  const auto is_like = [](const FoundTrack& a, const FoundTrack& b) {
    return std::abs(a.sideways_m.value - b.sideways_m.value) < kMostAside_m &&
           std::abs(a.height_m.value - b.height_m.value) < kMostHeight_m &&
           std::abs(a.yaw_rad.value - b.yaw_rad.value) < kMostTurn_rad;
  };
  // The nearest one of those that are seen in most frames.
  const FoundTrack* best = nullptr;
  std::size_t most = 0;
  for (const TracksOfFrame& of : frames) {
    for (const FoundTrack& track : of.found.tracks) {
      std::size_t num = 0;
      for (const TracksOfFrame& other : frames) {
        num += std::ranges::any_of(other.found.tracks,
                                   [&](const FoundTrack& each) { return is_like(each, track); })
                   ? 1U
                   : 0U;
      }
      const bool is_nearer =
          best == nullptr || std::abs(track.sideways_m.value) < std::abs(best->sideways_m.value);
      // The own track is hidden now and then, and others are not: a tenth less is as many.
      if (num * 10 > most * 11 || (num * 11 >= most * 10 && is_nearer)) best = &track;
      most = std::max(most, num);
    }
  }
  if (best == nullptr) return;
  for (TracksOfFrame& of : frames) {
    for (std::size_t i = 0; i < of.found.tracks.size() && !of.own; ++i)
      if (is_like(of.found.tracks[i], *best)) of.own = i;
  }
}

void AddWorld(const Transform& world_from_sensor, TracksOfFrame& of) {
  const FoundTrack* track = of.track();
  if (track == nullptr || !of.has_pose) return;
  const Eigen::Matrix3d world_from_track =
      world_from_sensor.linear() * track->track_from_sensor.linear().transpose();
  of.gradient = world_from_track(2, 0) / world_from_track.col(0).head<2>().norm();
  of.cant_m = -world_from_track(2, 1) * (track->gauge_m.value + kHeadWidth_m);
}

/// Why most frames show none.
std::string MostCommonReason(const std::vector<TracksOfFrame>& frames) {
  std::map<std::string, int> reasons;
  for (const TracksOfFrame& of : frames) ++reasons[of.found.why_not];
  return std::ranges::max_element(reasons, {}, [](const auto& reason) { return reason.second; })
      ->first;
}

struct ReadTracks {
  TracksOfFrame tracks;
  Transform world_from_sensor;
};

}  // namespace

FoundTracks FindTracks(const RecordedFrame& recorded, std::optional<double> gauge_m) {
  const RecordedMotion motion(recorded, Compensation::kSensor);
  std::vector<Eigen::Vector3f> points_m;
  for (std::size_t i = 0; i < recorded.frame.num_slots(); ++i)
    if (std::isfinite(recorded.frame.x[i])) points_m.push_back(motion.PointOf(i));
  return FindTracks(points_m, gauge_m);
}

bool TrackSurvey::is_on_track() const {
  // Half a vehicle's width.
  constexpr double kMostAside_m = 1.5;
  return std::abs(sideways_m.median.value) < kMostAside_m;
}

MountSpec TrackSurvey::Mount() const {
  const auto rounded = [](double value, double per_unit) {
    return std::round(value * per_unit) / per_unit + 0.0;  // No -0.
  };
  return {.position_m = {0.0, rounded(sideways_m.median.value, 1e3),
                         rounded(height_m.median.value, 1e3)},
          .yaw_deg = rounded(DegFromRad(yaw_rad.median.value), 100.0),
          .pitch_deg = rounded(DegFromRad(pitch_rad.median.value), 100.0),
          .roll_deg = rounded(DegFromRad(roll_rad.median.value), 100.0)};
}

std::vector<double> TrackSurvey::OtherTracks_m() const {
  constexpr double kSame_m = 0.5;
  std::vector<double> offsets_m;
  for (const TracksOfFrame& of : frames) {
    const FoundTrack* own = of.track();
    if (own == nullptr) continue;
    for (const FoundTrack& other : of.found.tracks) {
      if (&other == own) continue;
      // The middle of the other track where the sensor is.
      const Vector3 middle_m = other.track_from_sensor.inverse() * Vector3::Zero();
      offsets_m.push_back(own->Place_m(middle_m).y());
    }
  }
  std::ranges::sort(offsets_m);
  std::vector<double> tracks_m;
  for (std::size_t i = 0, end = 0; i < offsets_m.size(); i = end) {
    end = i + 1;
    while (end < offsets_m.size() && offsets_m[end] - offsets_m[end - 1] < kSame_m) ++end;
    if (4 * (end - i) >= num_own) tracks_m.push_back(offsets_m[i + (end - i) / 2]);
  }
  return tracks_m;
}

TrackSurvey SurveyTracks(Recording& recording,
                         const TrackSurveySpec& spec,
                         const std::function<void(std::size_t)>& on_progress) {
  TrackSurvey survey;
  std::vector<Transform> poses;
  std::size_t num_read = 0;
  const auto read = tbb::make_filter<void, Recording::FrameReader>(
      tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) -> Recording::FrameReader {
        auto next = num_read < spec.num_frames ? recording.Next() : std::nullopt;
        if (!next) {
          control.stop();
          return {};
        }
        ++num_read;
        return std::move(*next);
      });
  const auto find = tbb::make_filter<Recording::FrameReader, ReadTracks>(
      tbb::filter_mode::parallel, [&](const Recording::FrameReader& reader) -> ReadTracks {
        const RecordedFrame recorded = reader();
        return {{.name = recorded.name,
                 .stamp_ns = recorded.frame.stamp_ns,
                 .found = FindTracks(recorded, spec.gauge_m),
                 .own = {},
                 .has_pose = recorded.has_pose},
                recorded.frame.world_from_sensor};
      });
  const auto keep = tbb::make_filter<ReadTracks, void>(tbb::filter_mode::serial_in_order,
                                                       [&](const ReadTracks& of) {
                                                         survey.frames.push_back(of.tracks);
                                                         poses.push_back(of.world_from_sensor);
                                                         on_progress(survey.frames.size());
                                                       });
  tbb::parallel_pipeline(2 * static_cast<std::size_t>(tbb::info::default_concurrency()),
                         read & find & keep);
  const std::string place = ShownPath(recording.info().source) + ": ";
  if (survey.frames.empty()) throw InputError(place + "must hold a frame");
  ChooseOwn(survey.frames);
  std::vector<const FoundTrack*> own;
  std::vector<const FoundTrack*> in_straight;
  std::vector<double> first_m;
  std::vector<double> last_m;
  std::vector<double> known_m;
  for (std::size_t i = 0; i < survey.frames.size(); ++i) {
    AddWorld(poses[i], survey.frames[i]);
    const FoundTrack* track = survey.frames[i].track();
    if (track == nullptr) continue;
    constexpr double kStraight_per_m = 5e-4;
    own.push_back(track);
    if (std::abs(track->curvature_per_m.value) < kStraight_per_m) in_straight.push_back(track);
    first_m.push_back(track->first_m);
    last_m.push_back(track->last_m);
    known_m.push_back(track->KnownFor_m(kMostTrackMargin_m));
  }
  if (own.empty()) {
    throw InputError(place + "no frame shows a track: " + MostCommonReason(survey.frames));
  }
  survey.num_own = own.size();
  survey.gauge_m = OverFrames(own, &FoundTrack::gauge_m);
  survey.curvature_per_m = OverFrames(own, &FoundTrack::curvature_per_m);
  survey.first_m = MedianOf(first_m);
  survey.last_m = MedianOf(last_m);
  survey.known_m = MedianOf(known_m);
  if (5 * in_straight.size() >= own.size()) {
    survey.num_in_straight = in_straight.size();
    own = in_straight;
  }
  survey.height_m = OverFrames(own, &FoundTrack::height_m);
  survey.sideways_m = OverFrames(own, &FoundTrack::sideways_m);
  survey.yaw_rad = OverFrames(own, &FoundTrack::yaw_rad);
  survey.pitch_rad = OverFrames(own, &FoundTrack::pitch_rad);
  survey.roll_rad = OverFrames(own, &FoundTrack::roll_rad);
  return survey;
}

}  // namespace railcast
