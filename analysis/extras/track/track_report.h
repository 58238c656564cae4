#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "analysis/report/report.h"
#include "core/track/track_survey.h"
#include "railcast/io/recording.h"

namespace railcast {

extern const char* const kTrackWords;

/// The report of `railcast-analyze track`: mount, track and further tracks with their intervals,
/// and the figures of every frame.
/// @param command The command line.
[[nodiscard]] Report MakeTrackReport(const TrackSurvey& survey, const std::string& command);

/// Writes where the points of each frame are on the own track (PlacePoints()): `folder`/000012.npy,
/// a structured NumPy array with a row for each point of the file in its order, or for each slot of
/// a capture. They are nowhere in a frame that does not show the track.
/// @param recording The one that was surveyed, opened once more.
/// @param on_progress Gets the number of frames that were done.
/// @return What is in the way in each frame that shows the track.
[[nodiscard]] Section PlaceRecordedPoints(const TrackSurvey& survey,
                                          Recording& recording,
                                          const std::filesystem::path& folder,
                                          const std::function<void(std::size_t)>& on_progress);

/// Removes what PlaceRecordedPoints() wrote in an earlier run, from a frame on.
void RemovePlacedPoints(const std::filesystem::path& folder, std::size_t first);

/// The mount of a recording's sensor as JSON, as scenarios and plans take it.
[[nodiscard]] std::string MountText(const TrackSurvey& survey);

/// A scenario like what was recorded: the recording's sensor where it is on the track, the track's
/// gauge, curvature and cant, and the tracks beside it. The vehicle stands.
/// @param source The recording, which is opened once more for its sensor where no scenario says it.
/// @throws InputError "recording: rule" if it does not show its sensor.
[[nodiscard]] std::string TwinText(const TrackSurvey& survey, const std::filesystem::path& source);

}  // namespace railcast
