#include "core/rail/catenary/support_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/rail/clearance/cleared.h"

namespace railcast {
namespace {

/// Half the length of a long wagon: a wagon whose middle is at the end of its track extends this
/// far beyond it.
constexpr double kBeyondEnd_m = 10.0;
/// Mast places closer than this differ by rounding only.
constexpr double kSamePlace_m = 1e-6;

/// Tracks that are closer to each other belong together: between tracks that run side by side there
/// are at least 3 m.
constexpr double kTogether_m = 3.0 - 1e-9;

/// Tracks at one support that are too close for anything between them; most often a single one.
struct TrackGroup {
  double right_m{};  ///< Offset of the rightmost of them.
  double left_m{};

  [[nodiscard]] bool Has(double offset_m) const {
    return right_m <= offset_m && offset_m <= left_m;
  }
  [[nodiscard]] double Edge_m(bool on_left) const { return on_left ? left_m : right_m; }
};

/// The tracks at one support, and the room between and beside them.
class Tracks {
 public:
  Tracks(const WorldSpec& spec,
         std::span<const TrackCourse> tracks,
         double s_m,
         const std::vector<HungWire>& wires)
      : tracks_{spec, tracks},
        s_m_(s_m),
        to_mast_m_(spec.catenary.mast_distance_m + kMastHalfDepth_m),
        num_tracks_(tracks.size()) {
    std::vector<double> offsets_m;
    for (const TrackCourse& track : tracks) {
      const double offset_m = track.OffsetWithin_m(s_m);
      const bool is_here =
          track.begin_s_m() - kBeyondEnd_m <= s_m && s_m <= track.end_s_m() + kBeyondEnd_m;
      if (is_here) offsets_m.push_back(offset_m);
      if (is_here || track.is_parallel()) leftmost_m_ = std::max(leftmost_m_, offset_m);
    }
    for (const HungWire& wire : wires) offsets_m.push_back(wire.axis_d_m);
    std::ranges::sort(offsets_m);
    for (const double offset_m : offsets_m) {
      if (groups_.empty() || offset_m - groups_.back().left_m >= kTogether_m) {
        groups_.push_back({offset_m, offset_m});
      } else {
        groups_.back().left_m = offset_m;
      }
    }
  }

  [[nodiscard]] const TrackGroup& GroupOf(double offset_m) const {
    const auto found =
        std::ranges::find_if(groups_, [&](const TrackGroup& group) { return group.Has(offset_m); });
    Check(found != groups_.end(), "a track with a wire is one of those at its support");
    return *found;
  }

  /// The next group on that side.
  [[nodiscard]] const TrackGroup* Next(const TrackGroup& group, bool on_left) const {
    const auto index = &group - groups_.data();
    if (on_left) return index + 1 < std::ssize(groups_) ? &group + 1 : nullptr;
    return index > 0 ? &group - 1 : nullptr;
  }

  /// Place for a mast at its nominal distance from the outermost track of a group, if it is clear:
  /// from that track's axis, left positive.
  [[nodiscard]] std::optional<double> MastBeside(const TrackGroup& group, bool on_left) const {
    const double from_axis_m =
        BehindStructures_m(group.Edge_m(on_left), on_left ? to_mast_m_ : -to_mast_m_);
    return IsClear(group, group.Edge_m(on_left) + from_axis_m) ? std::optional(from_axis_m)
                                                               : std::nullopt;
  }

  /// As MastBeside(), halfway to the next group.
  [[nodiscard]] std::optional<double> MastMidway(const TrackGroup& group, bool on_left) const {
    const TrackGroup* next = Next(group, on_left);
    if (next == nullptr) return std::nullopt;
    const double edge_m = group.Edge_m(on_left);
    const double next_m = next->Edge_m(!on_left);
    if (!IsClear(group, 0.5 * (edge_m + next_m))) return std::nullopt;
    return 0.5 * (next_m - edge_m);
  }

  /// The mast of a track: left of that track's axis.
  [[nodiscard]] std::optional<double> OwnMast(double offset_m) const {
    const TrackGroup& group = GroupOf(offset_m);
    const auto from_axis_m = [&](double from_edge_m, bool on_left) {
      return (group.Edge_m(on_left) - offset_m) + from_edge_m;
    };
    const bool is_leftmost = num_tracks_ > 1 && group.left_m == leftmost_m_;
    for (const bool on_left : {is_leftmost, !is_leftmost}) {
      if (const auto mast_m = MastBeside(group, on_left)) return from_axis_m(*mast_m, on_left);
    }
    for (const bool on_left : {false, true}) {
      if (const auto mast_m = MastMidway(group, on_left)) return from_axis_m(*mast_m, on_left);
    }
    return std::nullopt;
  }

  /// The nearest place for a mast on that side of a track, beyond other tracks if necessary.
  /// Measured left of the alignment.
  [[nodiscard]] double NearestMast_d_m(double offset_m, bool on_left) const {
    for (const TrackGroup* at = &GroupOf(offset_m); at != nullptr; at = Next(*at, on_left)) {
      auto mast_m = MastBeside(*at, on_left);
      if (!mast_m) mast_m = MastMidway(*at, on_left);
      if (mast_m) return at->Edge_m(on_left) + *mast_m;
    }
    Check(false, "there is room beyond the outermost track");
    return offset_m;
  }

  /// Where the room of a group ends: left of the alignment, on its left or right.
  [[nodiscard]] double RoomEnd_d_m(const TrackGroup& group, bool on_left) const {
    // Half a post and some air.
    constexpr double kBesideMiddle_m = kMastHalfDepth_m + 0.05;
    const double side = on_left ? 1.0 : -1.0;
    const TrackGroup* next = Next(group, on_left);
    if (next == nullptr) return side * std::numeric_limits<double>::infinity();
    return 0.5 * (group.Edge_m(on_left) + next->Edge_m(!on_left)) - side * kBesideMiddle_m;
  }

  /// The post of a track without a mast, halfway to the group on its right: left of its axis.
  [[nodiscard]] double PostFromAxis_m(double offset_m) const {
    const TrackGroup& group = GroupOf(offset_m);
    const TrackGroup* next = Next(group, false);
    Check(next != nullptr, "a track without a place for a mast lies between others");
    return (group.right_m - offset_m) + 0.5 * (next->left_m - group.right_m);
  }

 private:
  /// Whether the mast is clear of all tracks but those of its own group.
  [[nodiscard]] bool IsClear(const TrackGroup& own, double mast_m) const {
    return std::ranges::none_of(groups_, [&](const TrackGroup& group) {
      if (&group == &own) return false;
      const auto obstructs = [&](double other_m) {
        const double own_m = own.Edge_m(mast_m > own.left_m);
        const bool is_beyond = (other_m - own_m) * (other_m - mast_m) < 0.0;
        return is_beyond || std::abs(other_m - mast_m) < kMastClearance_m + kMastHalfDepth_m;
      };
      return obstructs(group.right_m) || obstructs(group.left_m);
    });
  }

  /// The place for a mast, or one farther out where a structure, such as a platform, leaves no room
  /// for it; the same place if there is none within reach of a cantilever.
  [[nodiscard]] double BehindStructures_m(double offset_m, double from_axis_m) const {
    constexpr double kStep_m = 0.1;
    constexpr int kNumSteps = 30;
    for (int step = 0; step <= kNumSteps; ++step) {
      const double farther_m = from_axis_m + std::copysign(kStep_m * step, from_axis_m);
      if (!IsCleared(tracks_, s_m_, offset_m + farther_m, Clearing::kMast)) return farther_m;
    }
    return from_axis_m;
  }

  WorldTracks tracks_;
  double s_m_;
  double to_mast_m_;
  std::size_t num_tracks_;
  std::vector<TrackGroup> groups_;  ///< From right to left.
  double leftmost_m_ = -std::numeric_limits<double>::infinity();
};

/// Builds a layout wire by wire.
class LayoutDraft {
 public:
  LayoutDraft(const WorldSpec& spec,
              std::span<const TrackCourse> tracks,
              double s_m,
              const std::vector<HungWire>& wires)
      : tracks_(spec, tracks, s_m, wires), wires_(wires) {}

  SupportLayout Make() {
    // Portals first, because masts of other tracks may be part of them.
    for (const HungWire& wire : wires_) {
      if (!tracks_.OwnMast(wire.axis_d_m)) Hang(wire.axis_d_m);
    }
    for (const HungWire& wire : wires_) AddCantilever(wire);
    for (const PortalSite& portal : layout_.portals) {
      const double axis_d_m =
          std::ranges::find(wires_, portal.structure, &HungWire::track)->axis_d_m;
      for (const double d_m : {portal.right_d_m, portal.left_d_m}) {
        AddMast({portal.structure, axis_d_m, d_m - axis_d_m, portal.structure});
      }
    }
    return std::move(layout_);
  }

 private:
  [[nodiscard]] static bool Spans(const PortalSite& portal, double offset_m) {
    return portal.right_d_m < offset_m && offset_m < portal.left_d_m;
  }

  void Hang(double offset_m) {
    PortalSite portal{.right_d_m = tracks_.NearestMast_d_m(offset_m, false),
                      .left_d_m = tracks_.NearestMast_d_m(offset_m, true),
                      .posts_d_m = {},
                      .lowest_lift_m = 0.0,
                      .structure = 0};
    auto& portals = layout_.portals;
    auto same = std::find_if(portals.begin(), portals.end(),
                             [&](const PortalSite& other) { return Spans(other, offset_m); });
    if (same == portals.end()) {
      portal.structure = std::find_if(wires_.begin(), wires_.end(), [&](const HungWire& other) {
                           return Spans(portal, other.axis_d_m);
                         })->track;
      same = portals.insert(same, portal);
    }
    const double post_d_m = offset_m + tracks_.PostFromAxis_m(offset_m);
    const bool is_there = std::ranges::any_of(same->posts_d_m, [&](double other_d_m) {
      return std::abs(other_d_m - post_d_m) < kSamePlace_m;
    });
    if (!is_there) same->posts_d_m.push_back(post_d_m);
  }

  void AddCantilever(const HungWire& wire) {
    const TrackGroup& group = tracks_.GroupOf(wire.axis_d_m);
    const auto shared = std::ranges::find_if(
        layout_.cantilevers, [&](const CantileverSite& site) { return group.Has(site.axis_d_m); });
    if (shared != layout_.cantilevers.end()) {
      shared->wires.push_back(wire);
      return;
    }
    auto& portals = layout_.portals;
    const auto portal = std::find_if(portals.begin(), portals.end(), [&](const PortalSite& other) {
      return Spans(other, wire.axis_d_m);
    });
    if (portal != portals.end()) {
      portal->lowest_lift_m = std::min(portal->lowest_lift_m, wire.axis_lift_m);
    }
    const std::optional<double> mast_m = tracks_.OwnMast(wire.axis_d_m);
    std::size_t structure = portal == portals.end() ? wire.track : portal->structure;
    if (mast_m) structure = AddMast({wire.track, wire.axis_d_m, *mast_m, structure});
    const double from_axis_m = mast_m ? *mast_m : tracks_.PostFromAxis_m(wire.axis_d_m);
    layout_.cantilevers.push_back(
        {.track = wire.track,
         .axis_d_m = wire.axis_d_m,
         .lift_m = wire.axis_lift_m,
         .face_m = from_axis_m - std::copysign(kMastHalfDepth_m, from_axis_m),
         .hangs = !mast_m,
         .structure = structure,
         .wires = {wire},
         .room_m = tracks_.RoomEnd_d_m(group, from_axis_m < 0.0) - wire.axis_d_m});
  }

  /// Adds a mast unless there is one at that place.
  /// @return The structure of the mast there.
  std::size_t AddMast(const MastSite& site) {
    const auto same = std::find_if(
        layout_.masts.begin(), layout_.masts.end(),
        [&](const MastSite& other) { return std::abs(other.d_m() - site.d_m()) < kSamePlace_m; });
    if (same != layout_.masts.end()) return same->structure;
    layout_.masts.push_back(site);
    return site.structure;
  }

  Tracks tracks_;
  const std::vector<HungWire>& wires_;
  SupportLayout layout_;
};

}  // namespace

SupportLayout LayOutSupport(const WorldSpec& spec,
                            std::span<const TrackCourse> tracks,
                            double s_m,
                            const std::vector<HungWire>& wires) {
  return LayoutDraft(spec, tracks, s_m, wires).Make();
}

}  // namespace railcast
