#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/report/report.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The words of reports on detection (report/words.h).
extern const char* const kDetectabilityWords;

/// The rung that made the frames of one or several runs of a scenario.
struct RungUsed {
  std::string name;  ///< As the scenario names it.
  /// Whether every run has beams with a width (effect `footprint`). Absent: fidelity `auto` chose,
  /// and a run that has not finished, or clouds that are merged, do not record what.
  std::optional<bool> has_wide_beams;

  /// "surface: one ray per beam".
  [[nodiscard]] std::string InWords() const;
  /// What single rays do to objects far off; empty if the beams have a width.
  [[nodiscard]] std::string Warning() const;
};

/// @pre There is at least one run, and all are sequences of the same scenario.
[[nodiscard]] RungUsed RungOf(const std::vector<RecordingInfo>& runs);

/// Reports which objects are detected in time to stop: a verdict for each object over all runs,
/// each run's detection, and number of points against distance beside the distance needed.
/// @param command Command line that made the report.
/// @param facts Describe the scenario.
/// @param rung The rung of the runs, with a warning where it sends one ray per beam.
/// @pre There is at least one run.
[[nodiscard]] Report MakeDetectReport(const std::vector<DetectRun>& runs,
                                      const DetectSpec& spec,
                                      const std::string& command,
                                      std::vector<std::pair<std::string, std::string>> facts,
                                      const RungUsed& rung);

// Parts of it that other reports have, too.

/// Which objects in the way are detected in time, and the means of their distances.
[[nodiscard]] Table VerdictTable(const std::vector<Verdict>& verdicts);
[[nodiscard]] Table MeansTable(const std::vector<Verdict>& verdicts);
/// "in time", "too late", "not detected", ...
[[nodiscard]] std::string FateText(const ObjectDetection& detection);
/// How the distance needed follows from the spec, in sentences.
[[nodiscard]] std::string BrakingText(const DetectSpec& spec);

/// More charts of a section than this are too many to read; the tables hold the other objects.
inline constexpr std::size_t kMaxCharts = 12;

/// Bins of 10 m: the braking distances from 15 to 40 km/h lie 10 to 150 m apart, so the 50 m bins
/// usual in detection papers could not separate them; at these speeds and 10 Hz a bin still holds
/// 10 to 24 frames.
inline constexpr double kDistanceBin_m = 10.0;

/// Number of points on each object by distance, over the frames of all runs up to the closest
/// point. Defined in points_by_distance.cpp, as are the key and the chart below.
[[nodiscard]] Table PointsTable(const std::vector<DetectRun>& runs, const DetectionRule& rule);

/// Key such as "points_wagon_1", unique for each name of an object, since it becomes a file name.
[[nodiscard]] std::string KeyOfObject(const std::string& prefix, const std::string& name);

/// The points of one object, with the rule and the distances needed and reached.
[[nodiscard]] Chart PointsChart(const std::vector<DetectRun>& runs,
                                const Verdict& verdict,
                                const DetectionRule& rule);

/// A section with a picture for each object in the way, 12 at most: the scene when the object was
/// detected, with the camera's image if there is one, and what was seen of the object then and in
/// the last frame with too few points. It shows the first run that detected the object or, if none
/// did, the first that approached it. Defined in object_pictures.cpp.
/// @returns a section without pictures if nothing was approached that is in the way.
/// @throws InputError if a frame cannot be read.
[[nodiscard]] Section MakePictureSection(const std::vector<DetectRun>& runs);

}  // namespace railcast
