#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/landform/landform.h"
#include "core/rail/line/piecewise_linear.h"
#include "core/rail/network/network.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/network/turnout_place.h"
#include "railcast/alignment.h"
#include "railcast/world_spec.h"

namespace railcast {

/// So far apart are the axes of tracks that no turnout joins: half the width of the vehicles on
/// either one (VehicleOutline), so that trains on them pass each other.
inline constexpr double kApart_m = 3.15;

/// Where a track crosses another one at the height of its rails.
struct TrackCrossing {
  DiamondSite site;
  JoinedSection close;      ///< Where the two may be nearer to each other than tracks elsewhere.
  Eigen::Vector2d place_m;  ///< Where the map has it: chainage and offset.
};

/// A track as it would be in a world.
struct TrackDraft {
  TrackSpec spec;
  TrackCourse course;
  std::vector<TurnoutSite> turnouts;  ///< At its ends; `branch` is the number of the next track.
  std::vector<double> offsets_m;      ///< At every whole metre of chainage from first_m on.
  int first_m{};
  std::vector<TrackCrossing> crossings{};  ///< Crossings of tracks before it.

  [[nodiscard]] bool Has(double s_m) const {
    return s_m >= course.begin_s_m() && s_m <= course.end_s_m();
  }
  /// Linear between whole metres, and beyond the first and the last of them as there.
  [[nodiscard]] double OffsetNear_m(double s_m) const;
  [[nodiscard]] int end_m() const { return first_m + static_cast<int>(offsets_m.size()); }
};

/// The tracks of a world that is being made, by the rules of Network and CheckNetwork.
class TrackNetwork {
 public:
  /// Begins with "main" at offset 0.
  /// @param crossings_m Chainages and offsets of the places at which tracks cross on the map.
  explicit TrackNetwork(const AlignmentSpec& line, std::vector<Eigen::Vector2d> crossings_m = {});

  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] const std::vector<TrackDraft>& tracks() const { return tracks_; }

  /// The place of a turnout on one of the tracks.
  [[nodiscard]] TurnoutPlace PlaceOf(const TurnoutSpec& spec, bool opens_ahead) const;
  /// Whether no turnout and no crossing lies between two chainages of a track, in either order.
  [[nodiscard]] bool IsFree(std::size_t track, double one_s_m, double other_s_m) const;
  /// How much of the stretch between two chainages of a track, in either order, is where crossings
  /// of the map would have their frogs that can be made and are not yet.
  [[nodiscard]] double InMappedCrossings_m(std::size_t track,
                                           double one_s_m,
                                           double other_s_m) const;

  /// A track by its specification, with all crossings of others that can be made; absent if it
  /// cannot be, or its turnouts overlap with others.
  [[nodiscard]] std::optional<TrackDraft> Make(const TrackSpec& spec) const;
  /// The first chainage, or with `backwards` the last one, at which a draft has no room (HasRoom)
  /// or is too near to a track that no turnout or crossing joins to it.
  [[nodiscard]] std::optional<double> FirstConflict_m(const TrackDraft& draft,
                                                      bool backwards = false) const;
  /// A track that is nearer to a place than kApart_m: the nearest one.
  [[nodiscard]] std::optional<std::size_t> TrackNear(double s_m, double d_m) const;
  /// Whether a place is far enough from all tracks for a track that no turnout joins to them.
  [[nodiscard]] bool IsApartAt(double s_m, double d_m) const { return !TrackNear(s_m, d_m); }
  /// The name of a track that crosses one before it at a place of the map.
  [[nodiscard]] std::optional<std::string> TrackCrossingAt(const Eigen::Vector2d& place_m) const;
  /// Why none does.
  [[nodiscard]] std::string ReasonAgainstCrossing(const Eigen::Vector2d& place_m) const;
  /// Whether a place lies on the line's ground with all of a track's formation.
  [[nodiscard]] bool IsOnGround(double s_m, double d_m) const;
  /// Whether a track may be at a place beside the line: on its ground, and with a radius of at
  /// least 100 m, or of two thirds of the line's there.
  [[nodiscard]] bool HasRoom(double s_m, const TrackOffset& at) const;
  void Add(TrackDraft draft);

 private:
  void AddCrossings(TrackDraft& draft) const;
  /// The crossing of a track and the draft of the next one at a place of the map; absent if it
  /// cannot be.
  [[nodiscard]] std::optional<TrackCrossing> CrossingAt(const Eigen::Vector2d& place_m,
                                                        std::size_t track,
                                                        const TrackDraft& draft,
                                                        double s_m) const;

  Alignment alignment_;
  std::vector<Eigen::Vector2d> crossings_m_;
  PiecewiseLinear curvature_;  ///< Curvature of the line, by chainage.
  double length_m_;
  StripWidth ground_;
  std::vector<TrackDraft> tracks_;
  std::vector<JoinedSection> joined_;
};

}  // namespace railcast
