#include "core/rail/catenary/support_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/rail/structures/cleared.h"

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
  Tracks(const WorldSpec& spec, std::span<const TrackCourse> tracks, double s_m)
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

/// Builds a layout track by track.
class LayoutDraft {
 public:
  LayoutDraft(const WorldSpec& spec, std::span<const TrackCourse> tracks, double s_m)
      : courses_(tracks), s_m_(s_m), tracks_(spec, tracks, s_m) {
    for (std::size_t track = 0; track < tracks.size(); ++track) {
      if (HasWireAt(spec.tracks[track], tracks[track], s_m)) wired_.push_back(track);
    }
  }

  SupportLayout Make() {
    // Portals first, because masts of other tracks may be part of them.
    for (const std::size_t track : wired_) {
      if (!tracks_.OwnMast(Offset_m(track))) Hang(track);
    }
    for (const std::size_t track : wired_) AddCantilever(track);
    for (const PortalSite& portal : layout_.portals) {
      for (const double d_m : {portal.right_d_m, portal.left_d_m}) {
        AddMast({portal.structure, d_m - Offset_m(portal.structure), portal.structure});
      }
    }
    return std::move(layout_);
  }

 private:
  [[nodiscard]] double Offset_m(std::size_t track) const {
    return courses_[track].OffsetWithin_m(s_m_);
  }

  [[nodiscard]] static bool Spans(const PortalSite& portal, double offset_m) {
    return portal.right_d_m < offset_m && offset_m < portal.left_d_m;
  }

  void Hang(std::size_t track) {
    const double offset_m = Offset_m(track);
    PortalSite portal{.right_d_m = tracks_.NearestMast_d_m(offset_m, false),
                      .left_d_m = tracks_.NearestMast_d_m(offset_m, true),
                      .posts_d_m = {},
                      .structure = 0};
    auto& portals = layout_.portals;
    auto same = std::find_if(portals.begin(), portals.end(),
                             [&](const PortalSite& other) { return Spans(other, offset_m); });
    if (same == portals.end()) {
      portal.structure = *std::find_if(wired_.begin(), wired_.end(), [&](std::size_t other) {
        return Spans(portal, Offset_m(other));
      });
      same = portals.insert(same, portal);
    }
    const double post_d_m = offset_m + tracks_.PostFromAxis_m(offset_m);
    const bool is_there = std::ranges::any_of(same->posts_d_m, [&](double other_d_m) {
      return std::abs(other_d_m - post_d_m) < kSamePlace_m;
    });
    if (!is_there) same->posts_d_m.push_back(post_d_m);
  }

  void AddCantilever(std::size_t track) {
    const auto& portals = layout_.portals;
    const auto portal = std::find_if(portals.begin(), portals.end(), [&](const PortalSite& other) {
      return Spans(other, Offset_m(track));
    });
    const std::optional<double> mast_m = tracks_.OwnMast(Offset_m(track));
    std::size_t structure = portal == portals.end() ? track : portal->structure;
    if (mast_m) structure = AddMast({track, *mast_m, structure});
    const double from_axis_m = mast_m ? *mast_m : tracks_.PostFromAxis_m(Offset_m(track));
    layout_.cantilevers.push_back(
        {.track = track,
         .face_m = from_axis_m - std::copysign(kMastHalfDepth_m, from_axis_m),
         .hangs = !mast_m,
         .structure = structure});
  }

  /// Adds a mast unless there is one at that place.
  /// @return The structure of the mast there.
  std::size_t AddMast(const MastSite& site) {
    const auto d_m = [&](const MastSite& mast) { return Offset_m(mast.track) + mast.from_axis_m; };
    const auto same = std::find_if(
        layout_.masts.begin(), layout_.masts.end(),
        [&](const MastSite& other) { return std::abs(d_m(other) - d_m(site)) < kSamePlace_m; });
    if (same != layout_.masts.end()) return same->structure;
    layout_.masts.push_back(site);
    return site.structure;
  }

  std::span<const TrackCourse> courses_;
  double s_m_;
  Tracks tracks_;
  std::vector<std::size_t> wired_;
  SupportLayout layout_;
};

}  // namespace

SupportLayout LayOutSupport(const WorldSpec& spec,
                            std::span<const TrackCourse> tracks,
                            double s_m) {
  return LayoutDraft(spec, tracks, s_m).Make();
}

bool HasWireAt(const TrackSpec& track, const TrackCourse& course, double s_m) {
  return track.electrified && course.begin_s_m() <= s_m && s_m <= course.end_s_m();
}

}  // namespace railcast
