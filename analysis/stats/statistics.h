#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/stats/difficulty.h"
#include "analysis/stats/holes.h"
#include "analysis/stats/neighbour_noise.h"
#include "analysis/stats/range_noise.h"
#include "analysis/stats/sums.h"
#include "core/io/cloud/track_fields.h"
#include "railcast/outcome.h"

namespace railcast {

/// Firings without a point, by cause: exact, from the outcomes stored in railcast frames.
///
/// Dropout is the share of the firings that met a surface within reach but yielded no point of it.
/// Firings into the open (no_surface) and onto the own vehicle (ego) had nothing to lose. Where
/// clutter answered, the surface behind is unknown; these firings are counted in the total only,
/// not by range, incidence, label or material.
class Dropout {
 public:
  /// Frames without outcomes are skipped.
  void Add(const RecordedFrame& recorded);
  static auto Sums(auto& of) { return std::tie(of.all_, of.surface_, of.groups_); }
  void ForgetRings() { groups_.Forget(GroupBy::kRing); }

  [[nodiscard]] bool is_empty() const { return all_.num == 0; }
  /// Share over all firings that met a surface.
  [[nodiscard]] Estimate Share() const;
  [[nodiscard]] Section MakeSection(const Names& names) const;

  using Outcomes = std::array<std::uint64_t, kOutcomeNames.size()>;
  /// Firings of one kind and their outcomes.
  struct Count {
    std::uint64_t num{};
    Outcomes outcomes{};

    void Add(Outcome outcome) {
      ++num;
      ++outcomes[static_cast<std::size_t>(outcome)];
    }
    static auto Sums(auto& of) { return std::tie(of.num, of.outcomes); }
    [[nodiscard]] std::uint64_t num_lost() const { return num - of(Outcome::kReturned); }
    [[nodiscard]] std::uint64_t of(Outcome outcome) const {
      return outcomes[static_cast<std::size_t>(outcome)];
    }
  };

 private:
  Count all_;              ///< All firings.
  Count surface_;          ///< Firings whose surface is known.
  Grouped<Count> groups_;  ///< These by every key.
};

/// How densely points lie on surfaces, against range.
///
/// A firing of solid angle W that meets a surface at range R under incidence i stands for W R^2 /
/// cos(i) of it. Density = points / area of the firings' surfaces, in bins of range. With the truth
/// in the frames every firing counts that met the surface, with a point or not, by label; without
/// it, every firing with points above, below, left and right of it on one surface, whose area is
/// half of that between them, and with a point on the same surface or none, by how the surface
/// stands: level (normal within 20 deg of up), upright (beyond 70 deg) or slanted.
///
/// With a uniform raster and no losses the slope is -3 on level ground (the incidence grows with
/// range) and -2 on faces met under the same incidence everywhere (docs/physics.md 1.5).
class Density {
 public:
  /// Frames without a grid are skipped.
  /// @param scan Of the frame; null if it has none.
  void Add(const RecordedFrame& recorded, const ScanTable* scan);
  static auto Sums(auto& of) { return std::tie(of.by_label_, of.by_attitude_); }

  /// Counts in one bin of range on one kind of surface.
  struct Count {
    std::uint64_t num_firings{};  ///< Firings that met the surface ...
    std::uint64_t num_points{};   ///< ... and their points.
    double area_m2{};
    double solid_angle_sr{};
    double sum_of_logs{};  ///< Sum of the logarithms of the firings' ranges in metres.

    /// Geometric mean of the firings' ranges, which need not be centred in the bin.
    [[nodiscard]] double range_m() const {
      return std::exp(sum_of_logs / static_cast<double>(num_firings));
    }
    static auto Sums(auto& of) {
      return std::tie(of.num_firings, of.num_points, of.area_m2, of.solid_angle_sr, of.sum_of_logs);
    }
  };
  /// By bin of FineRangeBins().
  using Curve = std::vector<Count>;

  [[nodiscard]] bool is_empty() const { return by_label_.empty() && by_attitude_.empty(); }
  /// Power law fitted to the bins with at least kMinSamples points.
  [[nodiscard]] static PowerLaw LawOf(const Curve& curve);
  /// By label, from the truth.
  [[nodiscard]] const std::map<std::uint32_t, Curve>& by_label() const { return by_label_; }
  /// By "level", "slanted" or "upright", from the points alone.
  [[nodiscard]] const std::map<std::string, Curve>& by_attitude() const { return by_attitude_; }

  [[nodiscard]] Section MakeSection(const Names& names) const;

 private:
  void AddFromTruth(const RecordedFrame& recorded, const ScanTable& scan);
  void AddFromPoints(const Frame& frame, const ScanTable& scan);

  std::map<std::uint32_t, Curve> by_label_;
  std::map<std::string, Curve> by_attitude_;
};

/// Intensity of points against range and incidence, and by label.
///
/// The incidence is the true one where frames have it, else that of flat pieces of surface
/// (plane_patches.h), whose samples are pieces rather than points.
class Intensity {
 public:
  /// Frames without intensity are skipped.
  void Add(const RecordedFrame& recorded, const std::vector<PlanePatch>& patches);
  static auto Sums(auto& of) { return std::tie(of.has_true_incidence_, of.all_, of.groups_); }

  [[nodiscard]] bool is_empty() const { return all_.num() == 0; }
  /// By range, incidence and label.
  [[nodiscard]] const Grouped<Scatter>& groups() const { return groups_; }
  [[nodiscard]] Section MakeSection(const Names& names) const;

 private:
  bool has_true_incidence_{};
  Scatter all_;
  Grouped<Scatter> groups_;
};

/// Where the points are: number per frame, by ring and azimuth, and the ground area they
/// cover.
class Coverage {
 public:
  /// @param scan Null if the frame is not a grid.
  void Add(const RecordedFrame& recorded, const ScanTable* scan);
  static auto Sums(auto& of) {
    return std::tie(of.num_points_, of.points_, of.cells_, of.rings_, of.sectors_);
  }
  void ForgetRings() { rings_.clear(); }

  [[nodiscard]] std::uint64_t num_frames() const { return points_.num(); }
  [[nodiscard]] std::uint64_t num_points() const { return num_points_; }
  /// Mean over frames.
  [[nodiscard]] Estimate PointsPerFrame() const { return points_.Mean(); }
  /// Number of 1 m squares, seen from above, with at least one point; mean over frames.
  [[nodiscard]] Estimate OccupiedCells() const { return cells_.Mean(); }
  [[nodiscard]] Section MakeSection() const;

 private:
  struct Ring {
    Moments elevation_deg;
    std::uint64_t num_firings{};
    std::uint64_t num_points{};

    static auto Sums(auto& of) { return std::tie(of.elevation_deg, of.num_firings, of.num_points); }
  };

  std::uint64_t num_points_{};
  Moments points_, cells_;  ///< Per frame.
  std::vector<Ring> rings_;
  std::vector<std::uint64_t> sectors_;  ///< Points by azimuth, 5 deg each from -180.
};

/// How the points are divided among the labels, in all and by range.
class ClassBalance {
 public:
  /// Frames without labels are skipped.
  void Add(const RecordedFrame& recorded);
  static auto Sums(auto& of) { return std::tie(of.classes_, of.num_frames_); }

  [[nodiscard]] bool is_empty() const { return classes_.empty(); }
  [[nodiscard]] Section MakeSection(const Names& names) const;

 private:
  struct Class {
    Moments points;  ///< Per frame that has any.
    RangeCounts by_range{};

    static auto Sums(auto& of) { return std::tie(of.points, of.by_range); }
    [[nodiscard]] std::uint64_t num_points() const;
  };
  /// Labels with the largest number of points first.
  [[nodiscard]] std::vector<std::pair<std::uint32_t, const Class*>> Sorted() const;
  [[nodiscard]] Table LabelsTable(const Names& names) const;

  std::map<std::uint32_t, Class> classes_;
  std::uint64_t num_frames_{};  ///< Frames with labels.
};

/// Points on each object by its distance, from objects.jsonl of railcast sequences, and, from the
/// frames' truth, the share of the beams that met it and returned.
class ObjectPoints {
 public:
  void Add(const RecordedFrame& recorded);
  static auto Sums(auto& of) { return std::tie(of.objects_); }

  [[nodiscard]] bool is_empty() const { return objects_.empty(); }
  [[nodiscard]] Section MakeSection() const;

 private:
  /// Counts in one bin of distance, over frames.
  struct Bin {
    Moments points;
    std::uint64_t num_met{};       ///< Firings that met it ...
    std::uint64_t num_returned{};  ///< ... and those that returned a point.

    static auto Sums(auto& of) { return std::tie(of.points, of.num_met, of.num_returned); }
  };
  struct Object {
    std::string label;
    std::map<std::size_t, Bin> bins;  ///< By RangeBins(), with the distance of the box's middle.

    void Add(const Object& other) {
      label = other.label;
      AddTo(bins, other.bins);
    }
  };
  std::map<std::string, Object> objects_;  ///< By name.
};

/// The points in the vehicle's outline on a given track, by label and range.
class GaugePoints {
 public:
  /// @param track Of the vehicle, in the world of the frame's pose.
  /// @throws InputError if the frame has no pose.
  void Add(const RecordedFrame& recorded, const FrameTrack& track);
  static auto Sums(auto& of) {
    return std::tie(of.in_gauge_, of.all_, of.num_frames_, of.num_frames_with_any_);
  }

  [[nodiscard]] bool is_empty() const { return num_frames_ == 0; }
  [[nodiscard]] Section MakeSection(const Names& names) const;

 private:
  std::map<std::uint32_t, RangeCounts> in_gauge_;  ///< By label; 0 of clouds without.
  RangeCounts all_{};  ///< Points beside the track and beyond its ends, too.
  std::uint64_t num_frames_{};
  std::uint64_t num_frames_with_any_{};
};

/// Velocities along the beams, of sensors that measure them: how many points have one, which ones
/// there are, and how far they are from the truth where frames have it.
class Velocity {
 public:
  /// Frames without velocities are skipped.
  void Add(const RecordedFrame& recorded);
  static auto Sums(auto& of) { return std::tie(of.has_truth_, of.by_range_, of.distribution_); }

  /// The points in one bin of range.
  struct Sum {
    std::uint64_t num_points{};
    Moments measured_mps;
    /// Measured minus true velocity, of points that have both.
    Scatter errors_mps;

    static auto Sums(auto& of) { return std::tie(of.num_points, of.measured_mps, of.errors_mps); }
  };

  [[nodiscard]] bool is_empty() const { return by_range_.empty(); }
  /// By bin of RangeBins(), of the measured range.
  [[nodiscard]] const std::vector<Sum>& by_range() const { return by_range_; }
  /// Whether any frame held the truth.
  [[nodiscard]] bool has_truth() const { return has_truth_; }
  /// Points by velocity, in bins of kVelocityBin_mps: bin 2 begins at twice that.
  [[nodiscard]] const std::map<std::int64_t, std::uint64_t>& distribution() const {
    return distribution_;
  }
  [[nodiscard]] Section MakeSection() const;

 private:
  bool has_truth_{};
  std::vector<Sum> by_range_;
  std::map<std::int64_t, std::uint64_t> distribution_;
};

inline constexpr double kVelocityBin_mps = 2.0;

/// All results of `railcast-analyze stats` for a recording. Its size does not depend on the
/// recording's length.
struct Statistics {
  Dropout dropout;
  Holes holes;
  Density density;
  Noise noise;
  NeighbourNoise neighbour_noise;
  TemporalNoise temporal_noise;
  Intensity intensity;
  Coverage coverage;
  ClassBalance classes;
  ObjectPoints objects;
  Difficulty difficulty;
  GaugePoints gauge;  ///< Empty without a track.
  Velocity velocity;

  /// Adds everything except temporal noise, which needs two frames, and points in the gauge, which
  /// need a track.
  /// @param scan Of the frame; null if it is not a grid.
  void Add(const RecordedFrame& recorded, const ScanTable* scan);
  static auto Sums(auto& of) {
    return std::tie(of.dropout, of.holes, of.density, of.noise, of.neighbour_noise,
                    of.temporal_noise, of.intensity, of.coverage, of.classes, of.objects,
                    of.difficulty, of.gauge, of.velocity);
  }
  /// Drops what is counted by ring: rings of different sensors have nothing in common but their
  /// numbers.
  void ForgetRings();
};

/// Called after each pair of frames, on one thread at a time.
using StatisticsProgress = std::function<void(std::size_t num_frames)>;

/// Reads a recording to its end. Frames are processed in parallel and summed in their order, so
/// that the figures do not depend on the number of threads.
/// @param track Of the vehicle, in the world of the recording's poses; null = not known.
/// @throws InputError as the recording does, and if a frame has no pose although there is a track.
[[nodiscard]] Statistics MeasureStatistics(Recording& recording,
                                           const StatisticsProgress& on_progress,
                                           const FrameTrack* track = nullptr);

/// @param sources The recordings measured, one or more, all with the same labels and materials.
/// @param command Command line, for a reader to repeat.
[[nodiscard]] Report MakeStatisticsReport(const Statistics& statistics,
                                          const std::vector<RecordingInfo>& sources,
                                          const std::string& command);

/// What became of the packets of captures, sensor by sensor; nothing if no source is one. Defined
/// in capture_section.cpp.
/// @throws InputError if a capture cannot be read.
[[nodiscard]] std::optional<Section> CaptureSection(
    const std::vector<std::filesystem::path>& sources);

/// Makes a sheet of pictures of recordings: a row for each sensor, by its name, and for each
/// camera, of frames spread evenly over all its recordings. Defined in sheet.cpp.
/// @throws InputError if a recording cannot be read.
[[nodiscard]] Picture MakeSheet(const std::vector<std::filesystem::path>& recordings);

}  // namespace railcast
