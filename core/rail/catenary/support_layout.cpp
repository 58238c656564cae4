#include "core/rail/catenary/support_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/rail/structures/cleared.h"
#include "core/rail/track/sweep.h"

namespace railcast {
namespace {

/// Half the length of a long wagon: a wagon whose middle is at the end of its track extends this
/// far beyond it.
constexpr double kBeyondEnd_m = 10.0;
/// Mast places closer than this differ by rounding only.
constexpr double kSamePlace_m = 1e-6;

/// The tracks at one support, and the room between and beside them.
class Tracks {
 public:
  Tracks(const WorldSpec& spec, const Alignment& alignment, double s_m)
      : spec_(spec), s_m_(s_m), to_mast_m_(spec.catenary.mast_distance_m + kMastHalfDepth_m) {
    for (const TrackSpec& track : spec.tracks) {
      if (track.start_s_m - kBeyondEnd_m <= s_m &&
          s_m <= TrackEnd_m(track, alignment) + kBeyondEnd_m) {
        offsets_m_.push_back(track.offset_m);
      }
      leftmost_m_ = std::max(leftmost_m_, track.offset_m);
    }
  }

  /// Offset of the next track on that side of the track at `offset_m`.
  [[nodiscard]] std::optional<double> Next(double offset_m, bool on_left) const {
    std::optional<double> next_m;
    for (const double other_m : offsets_m_) {
      if (on_left ? other_m <= offset_m : other_m >= offset_m) continue;
      if (!next_m || std::abs(other_m - offset_m) < std::abs(*next_m - offset_m)) next_m = other_m;
    }
    return next_m;
  }

  /// Place for a mast at its nominal distance from its track, if it is clear: from the track's
  /// axis, left positive.
  [[nodiscard]] std::optional<double> MastBeside(double offset_m, bool on_left) const {
    const double from_axis_m = BehindStructures_m(offset_m, on_left ? to_mast_m_ : -to_mast_m_);
    return IsClear(offset_m, offset_m + from_axis_m) ? std::optional(from_axis_m) : std::nullopt;
  }

  /// As MastBeside(), halfway to the next track.
  [[nodiscard]] std::optional<double> MastMidway(double offset_m, bool on_left) const {
    const std::optional<double> next_m = Next(offset_m, on_left);
    if (!next_m || !IsClear(offset_m, 0.5 * (offset_m + *next_m))) return std::nullopt;
    return 0.5 * (*next_m - offset_m);
  }

  [[nodiscard]] std::optional<double> OwnMast(double offset_m) const {
    const bool is_leftmost = spec_.tracks.size() > 1 && offset_m == leftmost_m_;
    for (const bool on_left : {is_leftmost, !is_leftmost}) {
      if (const auto mast_m = MastBeside(offset_m, on_left)) return mast_m;
    }
    for (const bool on_left : {false, true}) {
      if (const auto mast_m = MastMidway(offset_m, on_left)) return mast_m;
    }
    return std::nullopt;
  }

  /// The nearest place for a mast on that side of a track, beyond other tracks if necessary.
  /// Measured left of the alignment.
  [[nodiscard]] double NearestMast_d_m(double offset_m, bool on_left) const {
    std::optional<double> at_m = offset_m;
    while (at_m) {
      auto mast_m = MastBeside(*at_m, on_left);
      if (!mast_m) mast_m = MastMidway(*at_m, on_left);
      if (mast_m) return *at_m + *mast_m;
      at_m = Next(*at_m, on_left);
    }
    Check(false, "there is room beyond the outermost track");
    return offset_m;
  }

 private:
  /// The place for a mast, or one farther out where a structure, such as a platform, leaves no room
  /// for it; the same place if there is none within reach of a cantilever.
  [[nodiscard]] double BehindStructures_m(double offset_m, double from_axis_m) const {
    constexpr double kStep_m = 0.1;
    constexpr int kNumSteps = 30;
    for (int step = 0; step <= kNumSteps; ++step) {
      const double farther_m = from_axis_m + std::copysign(kStep_m * step, from_axis_m);
      if (!IsCleared(spec_, s_m_, offset_m + farther_m, Clearing::kMast)) return farther_m;
    }
    return from_axis_m;
  }

  /// Whether the mast is clear of all tracks but its own.
  [[nodiscard]] bool IsClear(double own_m, double mast_m) const {
    return std::none_of(offsets_m_.begin(), offsets_m_.end(), [&](double other_m) {
      if (other_m == own_m) return false;
      const bool is_beyond = (other_m - own_m) * (other_m - mast_m) < 0.0;
      return is_beyond || std::abs(other_m - mast_m) < kMastClearance_m + kMastHalfDepth_m;
    });
  }

  const WorldSpec& spec_;
  double s_m_;
  double to_mast_m_;
  std::vector<double> offsets_m_;
  double leftmost_m_ = -std::numeric_limits<double>::infinity();  ///< Of the whole line.
};

/// Builds a layout track by track.
class LayoutDraft {
 public:
  LayoutDraft(const WorldSpec& spec, const Alignment& alignment, double s_m)
      : spec_(spec), tracks_(spec, alignment, s_m) {
    for (std::size_t track = 0; track < spec.tracks.size(); ++track) {
      if (HasWireAt(spec.tracks[track], alignment, s_m)) wired_.push_back(track);
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
  [[nodiscard]] double Offset_m(std::size_t track) const { return spec_.tracks[track].offset_m; }

  [[nodiscard]] static bool Spans(const PortalSite& portal, double offset_m) {
    return portal.right_d_m < offset_m && offset_m < portal.left_d_m;
  }

  [[nodiscard]] double PostFromAxis_m(std::size_t track) const {
    const std::optional<double> next_m = tracks_.Next(Offset_m(track), false);
    Check(next_m.has_value(), "a track without a place for a mast lies between others");
    return 0.5 * (*next_m - Offset_m(track));
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
    same->posts_d_m.push_back(offset_m + PostFromAxis_m(track));
  }

  void AddCantilever(std::size_t track) {
    const auto& portals = layout_.portals;
    const auto portal = std::find_if(portals.begin(), portals.end(), [&](const PortalSite& other) {
      return Spans(other, Offset_m(track));
    });
    const std::optional<double> mast_m = tracks_.OwnMast(Offset_m(track));
    std::size_t structure = portal == portals.end() ? track : portal->structure;
    if (mast_m) structure = AddMast({track, *mast_m, structure});
    const double from_axis_m = mast_m ? *mast_m : PostFromAxis_m(track);
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

  const WorldSpec& spec_;
  Tracks tracks_;
  std::vector<std::size_t> wired_;
  SupportLayout layout_;
};

}  // namespace

SupportLayout LayOutSupport(const WorldSpec& spec, const Alignment& alignment, double s_m) {
  return LayoutDraft(spec, alignment, s_m).Make();
}

bool HasWireAt(const TrackSpec& track, const Alignment& alignment, double s_m) {
  return track.electrified && track.start_s_m <= s_m && s_m <= TrackEnd_m(track, alignment);
}

}  // namespace railcast
