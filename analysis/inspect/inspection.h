#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "analysis/stats/neighbour_noise.h"
#include "core/io/recording/found_sensor.h"
#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/transform.h"

namespace railcast {

/// A ring of a recording's frames: a row of their grids, or what their field `ring` numbers.
struct InspectedRing {
  std::uint64_t num_points{};
  Moments elevation_deg;  ///< Only of points 3 m away and farther, positive upward.
};

/// Values of a field, over all points.
struct InspectedValues {
  std::uint64_t num{};
  std::uint64_t num_missing{};  ///< NaN.
  std::uint64_t num_zero{};
  std::uint64_t num_highest{};  ///< As high as any.
  double least = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  bool is_whole = true;  ///< Whether all are whole numbers.

  void Add(double value);
};

/// What the poses of two frames say of the motion between them, and what their clouds say.
struct MotionBetween {
  std::size_t frame{};    ///< The second of the two.
  double distance_m{};    ///< Between the poses.
  double off_m{};         ///< From where registration lays the second cloud.
  double registered_m{};  ///< Distance by registration.
};

/// One of a recording's frames, and what sets it apart from the others.
struct InspectedFrame {
  std::string name;  ///< As in messages.
  std::uint64_t num_points{};
  std::uint64_t num_doubled{};  ///< Points in places where the frame has one already.
  /// Points of the file or message without a position; none of captures.
  std::uint64_t num_missing{};
  std::size_t num_rings{};       ///< With a hundredth of the median ring's points, or more.
  std::uint64_t num_sparsest{};  ///< Points of the ring of these that has the fewest.
  bool is_grid{};
  std::int64_t stamp_ns{};
  std::uint64_t hash{};                ///< Hash of positions and intensities.
  std::optional<std::size_t> same_as;  ///< The first frame with the same.
  /// Height of the sensor above the ground (core/points/level_areas.h); NaN if it is not found.
  double height_m = std::numeric_limits<double>::quiet_NaN();

  std::vector<std::string> odd;  ///< JudgeFrames(): "has 200 points, where others have 57,734".
  /// Whether its points are odd, rather than its time or that they came before.
  bool has_odd_points{};
};

/// @param ring_points Number of points by ring; empty without rings.
[[nodiscard]] InspectedFrame InspectFrame(const RecordedFrame& recorded,
                                          std::vector<std::uint64_t> ring_points);

/// Says what is odd of which frame: a number of points, of doubled or missing ones, or a height
/// that is farther from the median over all frames than six robust standard deviations, a tenth of
/// it, and what chance does; fewer or more rings than the median, where even the sparsest have 20
/// points; steps of time of more than 1.5 times the median, or none, or back; points of a frame
/// before. With fewer than three frames, nothing but the last two is odd.
void JudgeFrames(bool has_stamps, std::vector<InspectedFrame>& frames);

/// The table by frame, odd ones first; of many frames the first.
[[nodiscard]] Section FramesSection(bool has_stamps, const std::vector<InspectedFrame>& frames);

/// What the first frames of a recording show of it.
struct RecordingLook {
  std::size_t num_frames{};
  std::size_t num_empty{};  ///< Without a point.
  std::size_t num_grids{};
  std::size_t num_with_beams{};  ///< Whose packets state where each firing went.
  std::size_t num_with_pose{};
  std::size_t num_with_objects{};
  bool is_cut_short{};  ///< Whether the recording goes on.
  std::uint64_t num_points{};
  std::string why_no_grid;                    ///< Why the first frame that is none is no grid.
  std::map<std::string, std::size_t> fields;  ///< Number of frames that have it.
  std::vector<std::string> foreign;           ///< Fields of others, of the first frame.
  Vector3 origin_m = Vector3::Zero();         ///< Origin of the first frame.
  std::string why_no_ranges;                  ///< Why the first frame that has none lacks them.

  std::vector<std::int64_t> stamps_ns;
  std::vector<double> durations_s;           ///< For frames whose points have times.
  std::vector<Transform> world_from_sensor;  ///< For frames that have one.
  std::vector<std::int64_t> pose_stamps_ns;  ///< For the same frames.
  std::vector<MotionBetween> motions;        ///< For some pairs of frames with poses.

  /// From the frames whose grids have as many rows as most: rows that are told by elevations have
  /// other numbers where a ring is missing.
  std::vector<InspectedRing> rings;
  /// What the points show of the first ten frames whose points are not odd; of the first ten if
  /// those of the first twenty are all odd.
  SensorSearch sensor;
  std::vector<InspectedFrame> frames;
  double range_step_m{};      ///< Median of RangeStep_m().
  NeighbourNoise neighbours;  ///< Frames that are grids and know their ranges add to it.
  InspectedValues intensity;
  LogHistogram range_m;
  std::uint64_t num_near{};  ///< Points nearer than kNear_m.
  /// Points by azimuth, sectors of 5 deg from -180 deg, positive to the left.
  static constexpr std::size_t kNumSectors = 72;
  static constexpr double kNear_m = 0.5;
  std::array<std::uint64_t, kNumSectors> sectors{};

  /// Whether the frames have stamps of their own, rather than none at all.
  [[nodiscard]] bool HasStamps() const;
};

/// Looks at frames from the first on.
/// @param most_frames Frames that are read at most.
/// @throws InputError as the recording does.
[[nodiscard]] RecordingLook Inspect(Recording& recording, std::size_t most_frames);

/// A sensor of railcast's presets whose channels a recording's rings could be.
struct SensorGuess {
  std::string name;    ///< "VLP-16".
  double error_deg{};  ///< Root mean square of the differences of elevations.
};

/// The presets that have a channel for each ring, and at most a quarter more, the best first.
[[nodiscard]] std::vector<SensorGuess> GuessSensor(const std::vector<InspectedRing>& rings);

/// Elevations that differ by less from a preset's are that sensor's, those beyond are another's.
inline constexpr double kSureGuess_deg = 0.1;
inline constexpr double kLikelyGuess_deg = 0.5;

/// What a recording can be used for.
enum class Fitness : std::uint8_t { kYes, kWithOption, kNo };

struct JobFitness {
  std::string job;  ///< "stats".
  Fitness fitness{};
  std::string why;  ///< The option, or the reason; may be empty for kYes.
};

/// The jobs that JobsOf() knows.
inline constexpr std::array<const char*, 7> kJobs = {"view",   "stats",    "insert", "weather",
                                                     "survey", "evaluate", "fit"};

/// Says for each of kJobs whether the recording is fit.
[[nodiscard]] std::vector<JobFitness> JobsOf(const RecordingLook& inspection,
                                             const RecordingInfo& info);

/// @param command Command line, for a reader to repeat.
[[nodiscard]] Report MakeInspectionReport(const RecordingLook& inspection,
                                          const RecordingInfo& info,
                                          const std::string& command);

}  // namespace railcast
