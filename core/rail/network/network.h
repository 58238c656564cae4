#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/line/track_course.h"
#include "railcast/world_spec.h"

namespace railcast {

/// A turnout of the network.
struct TurnoutSite {
  std::size_t track{};   ///< Index of the track in which it lies.
  std::size_t branch{};  ///< Index of the track that begins or ends in it.
  TurnoutType type{};
  double s_m{};  ///< Chainage of its beginning, at the tips of its blades.
  /// Chainage of `track` at its end; less than s_m if it opens with falling chainage.
  double end_s_m{};
  TrackSide side{};  ///< Side of `track` to which the branch leaves, towards rising chainage.
  TurnoutPosition position{};
  /// Chainage of its fouling point, where the axes of both tracks are kFoulingDistance_m apart;
  /// absent if they never are.
  std::optional<double> fouling_s_m;
  bool has_given_position{};  ///< Whether the spec gives the position.

  /// Whether it opens with rising chainage: the branch begins in it. Otherwise the branch ends in
  /// it.
  [[nodiscard]] bool opens_ahead() const { return end_s_m > s_m; }
};

/// A place where two tracks cross at the height of their rails.
struct DiamondSite {
  std::size_t entry{};   ///< Index in WorldSpec::diamond_crossings.
  std::size_t first{};   ///< Index of the track that comes from the right of the other one.
  std::size_t second{};  ///< The track from its left, seen towards rising chainage.
  double s_m{};          ///< Where their axes cross.
  double angle_rad{};    ///< Between the axes there.
  double begin_s_m{};    ///< Between these chainages lie its frogs and check rails.
  double end_s_m{};
};

/// The tracks of a line and the turnouts that join them, in the order of WorldSpec::tracks; at most
/// two turnouts for each track, first that of its beginning; and where tracks cross.
///
/// Tracks with neither turnouts, elements nor offsets_m are parallel to the alignment. For all
/// others these rules hold:
/// - With offsets_m, the offset is constant between equal entries and beyond the first and the
///   last; between different ones it is an S-curve without slope or curvature at the entries.
/// - At a turnout, the branch has the curvature of the track in which the turnout lies (in the
///   plane of chainage and offset) plus or minus that of the turnout's arc; from the turnout's end
///   it runs straight on and turns back with the turnout's radius until it is parallel at its own
///   offset.
/// - With elements it continues with these from the turnout's end, or begins with them at
///   start_s_m and offset_m; two arcs (BiarcBetween) lead on to the turnout at its end, if any.
/// - A crossover runs straight on to the turnout at its end, whose chainage follows; if that is
///   given, two arcs lead there.
/// - Where the curvature of a track changes within a turnout, that of the branch is sampled at 64
///   places, and linear between them.
/// - Over a turnout, the branch lies in the canted plane of the track (InPlanesOfTurnouts).
struct Network {
  std::vector<TrackCourse> courses;
  std::vector<TurnoutSite> turnouts;
  std::vector<DiamondSite> diamonds{};
};

/// The parts of a network that could be made: courses of tracks with faults are absent, and so are
/// their turnouts.
struct NetworkDraft {
  std::vector<std::optional<TrackCourse>> courses;
  std::vector<TurnoutSite> turnouts;
  std::vector<DiamondSite> diamonds{};
};

/// Whether the track is parallel to the alignment by its specification.
[[nodiscard]] inline bool IsParallel(const TrackSpec& track) {
  return !track.begin && !track.end && track.elements.empty() && track.offsets_m.empty();
}

/// The pointer of a track of the world: "/world/tracks/2".
[[nodiscard]] inline std::string TrackPointer(std::size_t index) {
  return "/world/tracks/" + std::to_string(index);
}

/// Index of the track of that name; absent if there is none.
[[nodiscard]] inline std::optional<std::size_t> TrackIndex(const WorldSpec& world,
                                                           const std::string& name) {
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    if (world.tracks[i].name == name) return i;
  }
  return std::nullopt;
}

}  // namespace railcast
