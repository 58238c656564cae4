#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/track/found_track.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// The tracks of a frame, with the sensor's motion during the scan undone where it is known.
/// @param gauge_m As FindTracks() takes it.
[[nodiscard]] FoundTracks FindTracks(const RecordedFrame& recorded, std::optional<double> gauge_m);

/// What a frame of a recording shows of tracks.
struct TracksOfFrame {
  std::string name;         ///< Names the frame in messages.
  std::int64_t stamp_ns{};  ///< 0 where the recording has no stamps.
  FoundTracks found;
  /// Which of `found.tracks` is that of the whole recording; nothing where none fits what the
  /// frames before and behind show.
  std::optional<std::size_t> own;
  bool has_pose{};
  /// The own track's rise per metre, and the height of its right head above the left one, by the
  /// world's z; 0 without poses.
  double gradient{}, cant_m{};

  [[nodiscard]] const FoundTrack* track() const { return own ? &found.tracks[*own] : nullptr; }
};

/// A figure over many frames.
struct FigureOfFrames {
  /// The median, and its interval: that of how frames differ, and what the best of them leaves
  /// open, since all share it.
  BoundedFigure median;
  double sway{};   ///< Robust standard deviation from frame to frame.
  double drift{};  ///< From the first quarter of the frames to the last one.
};

/// Where the track is in a recording, and where its sensor is on the track.
struct TrackSurvey {
  std::vector<TracksOfFrame> frames;
  std::size_t num_own{};  ///< Frames that show the recording's own track.
  FigureOfFrames height_m, sideways_m, yaw_rad, pitch_rad, roll_rad, gauge_m, curvature_per_m;
  double first_m{}, last_m{};  ///< From where to where along the track heads are seen: medians.
  double known_m{};  ///< How far along the track is known to kMostTrackMargin_m: the median.
  std::size_t num_in_straight{};  ///< Frames that the mount is of, unless it is 0.

  /// Whether the sensor is above the own track or beside it.
  [[nodiscard]] bool is_on_track() const;
  /// The sensor's mount on a vehicle whose origin is on the track beside the sensor.
  [[nodiscard]] MountSpec Mount() const;
  /// Middles of further tracks from that of the own one, left positive, medians of those that are
  /// seen in a quarter of its frames.
  [[nodiscard]] std::vector<double> OtherTracks_m() const;
};

struct TrackSurveySpec {
  std::optional<double> gauge_m;  ///< As FindTracks() takes it.
  std::size_t num_frames = 100;   ///< To look at, from the first on.
};

/// Finds the track of a recording. A single frame may take something else for a track, or the
/// branch of a turnout for the main line; the own track is the one that lies alike in most frames.
/// Height, place and angles of the sensor are of frames on straight track where a fifth of the
/// frames are: a vehicle leans across curves on its pivots.
/// @param on_progress Gets the number of frames that were looked at.
/// @throws InputError "recording: rule" if no frame shows a track, with the reason, or as reading
///   does.
[[nodiscard]] TrackSurvey SurveyTracks(Recording& recording,
                                       const TrackSurveySpec& spec,
                                       const std::function<void(std::size_t)>& on_progress);

}  // namespace railcast
