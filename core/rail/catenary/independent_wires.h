#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/rail/line/track_course.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/alignment.h"
#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Supports stand at multiples of this part of the longest span.
inline constexpr std::size_t kStepsOfASpan = 26;

/// What the wire of a track hangs above: its axis, and before its beginning and behind its end that
/// of the track which it leaves or joins in a turnout. The courses must outlive it.
class WireAxis {
 public:
  WireAxis(const WorldTracks& tracks, std::size_t track);

  /// Left of the alignment. Beyond a free end it stays.
  [[nodiscard]] double OffsetAt_m(double s_m) const;
  /// Above the alignment (TrackCourse::LiftAt).
  [[nodiscard]] double LiftAt_m(const Alignment& alignment, double s_m) const;

 private:
  struct Section {
    const TrackCourse* course{};
    double end_s_m{};  ///< Where the next one begins.
  };
  [[nodiscard]] const TrackCourse& CourseAt(double s_m) const;

  std::vector<Section> sections_;
};

/// Stagger towards the outside of a curve; nothing where the line is straight enough for staggers
/// to alternate.
[[nodiscard]] std::optional<double> StaggerInCurve(const CatenarySpec& spec,
                                                   double curvature_per_m);

/// Lateral displacement of a pantograph's middle by cant, at the height of the contact line, left
/// positive.
[[nodiscard]] double PantographShift_m(const CatenarySpec& spec, const AxisPoint& axis);

/// A track's axis at a support: left of the alignment, and above it.
struct AxisOffset {
  double d_m{};
  double lift_m = 0.0;
};

/// The level frame of one track at one support, in which cantilever and wires are described: x
/// along the heading, z up. The origin lies below the middle of a pantograph by the height of the
/// contact line, at PantographShift_m() from the track's axis.
[[nodiscard]] Transform WorldFromSupport(const Alignment& alignment,
                                         const WorldSpec& spec,
                                         const AxisOffset& axis,
                                         double s_m);

/// A wire at a support.
struct HungWire {
  std::size_t track{};  ///< Index of the track that it belongs to.
  /// Axis that it hangs above, left of the alignment. Before the beginning and behind the end of
  /// its own track, that of the track which it leaves or joins in a turnout.
  double axis_d_m{};
  double stagger_m{};
  /// Whether it is the wire of a branch beside that of its turnout's other track. Its contact wire
  /// is higher then by kRunInLift_m and its messenger by kMessengerLift_m, so that pantographs and
  /// other wires pass below.
  bool is_lifted{};
  /// How much higher than the alignment that axis lies: a branch of a canted turnout lies in the
  /// plane of the track in which that was built.
  double axis_lift_m{};

  [[nodiscard]] double d_m() const { return axis_d_m + stagger_m; }
};

inline constexpr double kRunInLift_m = 0.04;
inline constexpr double kMessengerLift_m = 0.15;

/// Whether the track's wire follows the alignment's staggers: it is parallel to it, without a
/// turnout at its ends.
[[nodiscard]] bool FollowsAlignment(const TrackSpec& track, const TrackCourse& course);

/// Whether the track has a contact line at chainage `s_m`.
[[nodiscard]] bool HasWireAt(const TrackSpec& track, const TrackCourse& course, double s_m);

/// A span between two supports.
struct SpanTrial {
  double first_s_m{};
  double last_s_m{};
  /// Staggers on the tracks that are parallel to the alignment.
  double first_stagger_m{};
  double last_stagger_m{};
};

/// What wires of tracks with courses of their own must keep.
struct WireRules {
  double reach_m{};  ///< Greatest distance of a wire from the middle of its pantograph.
  double apart_m{};  ///< Least distance between two wires, in plan.
};

/// The contact line above the tracks that are not parallel to the alignment or that turnouts join
/// to others: branches, crossovers, tracks that draw apart. Each has staggers of its own at the
/// supports that all tracks share. Where a track begins in a turnout, its wire begins at the
/// support before; there and where it ends it lies beside the wire of the turnout's other track, on
/// its own side, so that wires never cross.
class IndependentWires {
 public:
  /// All must outlive it.
  IndependentWires(const WorldTracks& tracks, const Alignment& alignment);

  /// Staggers at a support, one for each track of the world; absent where it has no wire of this
  /// kind.
  using Staggers = std::vector<std::optional<double>>;
  /// Staggers at both ends of a span.
  using SpanStaggers = std::vector<std::optional<std::pair<double, double>>>;

  /// Where a track's wire hangs at a support, whatever its stagger.
  struct Hanger {
    HungWire wire;  ///< Without stagger and lift.
    Transform world_from_support;
    std::optional<double> curve_stagger_m;  ///< StaggerInCurve() of the track.
  };
  /// Hangers by chainage and track. A search asks for most of them a hundred times.
  using KnownHangers = std::map<std::pair<double, std::size_t>, Hanger>;

  /// Whether any wire of this kind hangs between two chainages.
  [[nodiscard]] bool HangIn(double first_s_m, double last_s_m) const;
  /// Staggers with which all wires of this kind keep the rules in the span; nothing if there are
  /// none.
  /// @param first At the first support; those of wires that begin there are chosen, too.
  /// @param known Receives what is computed.
  [[nodiscard]] std::optional<SpanStaggers> Place(const SpanTrial& span,
                                                  const Staggers& first,
                                                  const WireRules& rules,
                                                  KnownHangers& known) const;
  /// The wire of a track at a support, with the lift of its axis.
  [[nodiscard]] HungWire WireAt(std::size_t track, double s_m, double stagger_m) const;

 private:
  /// The pantograph's middle in the world and the direction to the left of its track.
  struct Pantograph {
    Eigen::Vector2d middle_m;
    Eigen::Vector2d left;
  };
  struct Own {
    std::size_t track{};
    std::ptrdiff_t first_sample{};
    std::vector<Pantograph> samples;
  };
  struct Turnouts {
    std::optional<std::size_t> begin;  ///< Track in which the turnout at the beginning lies.
    std::optional<std::size_t> end;
  };
  class Trial;

  [[nodiscard]] bool HangsIn(std::size_t track, double first_s_m, double last_s_m) const;
  /// As WireAt(), with no lift, which does not matter in plan.
  [[nodiscard]] HungWire WireInPlan(std::size_t track, double s_m, double stagger_m) const;
  [[nodiscard]] const Hanger& HangerAt(std::size_t track, double s_m, KnownHangers& known) const;
  [[nodiscard]] std::vector<double> CandidatesAt(const Hanger& hanger, double before_m) const;
  [[nodiscard]] std::size_t DepthOf(std::size_t track) const;
  [[nodiscard]] Own SampledCourse(std::size_t track) const;

  WorldTracks tracks_;
  const Alignment& alignment_;
  double step_m_;
  std::vector<Turnouts> turnouts_;
  std::vector<WireAxis> axes_;
  std::vector<Own> own_;  ///< Wires that branch off others come after these.
};

}  // namespace railcast
