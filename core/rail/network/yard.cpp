#include "core/rail/network/network_draft.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/text.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {
namespace {

AlignmentElement StraightElement(double length_m) {
  return {ElementType::kStraight, length_m, std::nullopt};
}

TrackSpec TrackOf(const YardSpec& yard, const std::string& suffix, const TurnoutSpec& begin) {
  TrackSpec track;
  track.name = yard.name + "_" + suffix;
  track.sleeper = yard.sleeper;
  track.electrified = yard.electrified;
  track.begin = begin;
  return track;
}

/// Lengths of a ladder. Behind the point where the tangents of a turnout meet, its tracks part at
/// the angle.
struct Ladder {
  TurnoutGeometry turnout;
  double spacing_m{};
  double sine{};
  double cosine{};

  explicit Ladder(const YardSpec& yard)
      : turnout(GeometryOf(yard.begin.turnout)),
        spacing_m(yard.spacing_m),
        sine(std::sin(turnout.angle_rad)),
        cosine(std::cos(turnout.angle_rad)) {}

  [[nodiscard]] double behind_m() const { return turnout.length_m - turnout.tangent_m; }
  /// From where the tangents of a turnout meet to its fouling point, along the track that leads
  /// back.
  [[nodiscard]] double fouling_m() const { return kFoulingDistance_m * cosine / sine; }
  /// As fouling_m(), for the last turnout: the lead may turn back before its fouling point.
  [[nodiscard]] double last_fouling_m() const {
    const double below_m = spacing_m - kFoulingDistance_m;
    const double radius_m = turnout.radius_m;
    if (below_m >= radius_m * (1.0 - cosine)) return fouling_m();
    const double left_rad = std::acos(1.0 - below_m / radius_m);
    const double arc_begin_m = (spacing_m / sine - turnout.tangent_m) * cosine;
    return arc_begin_m + radius_m * (sine - std::sin(left_rad));
  }
};

TrackSpec LeadOf(const YardSpec& yard, const Ladder& ladder) {
  const TurnoutGeometry& turnout = ladder.turnout;
  const bool is_left = yard.begin.side != TrackSide::kRight;
  TrackSpec lead = TrackOf(yard, "lead", yard.begin);
  // The arc back begins a tangent before the lead meets the line of the last track, and ends as far
  // behind.
  const double to_last_m = yard.num_tracks * yard.spacing_m / ladder.sine;
  const double fouling_m =
      yard.num_tracks > 1 ? ladder.last_fouling_m() - yard.spacing_m * ladder.cosine / ladder.sine
                          : 0.0;
  lead.elements = {
      StraightElement(to_last_m - turnout.tangent_m - ladder.behind_m()),
      {ElementType::kArc, turnout.arc_m(), is_left ? -turnout.radius_m : turnout.radius_m},
      StraightElement(std::max(1.0, fouling_m + yard.usable_length_m - turnout.tangent_m))};
  return lead;
}

void AddTracksOf(const YardSpec& yard, std::vector<TrackSpec>& tracks) {
  const Ladder ladder(yard);
  const double meet_s_m = yard.begin.s_m.value_or(0.0) + ladder.turnout.tangent_m;
  const bool is_left = yard.begin.side != TrackSide::kRight;
  tracks.push_back(LeadOf(yard, ladder));
  if (yard.num_tracks > kMostYardTracks) return;  // A fault that reading the spec reports.
  for (std::uint32_t k = 1; k < yard.num_tracks; ++k) {
    const double along_m = k * yard.spacing_m / ladder.sine - ladder.turnout.tangent_m;
    const TurnoutSpec begin{.track = yard.name + "_lead",
                            .s_m = meet_s_m + along_m * ladder.cosine,
                            .turnout = yard.begin.turnout,
                            .side = is_left ? TrackSide::kRight : TrackSide::kLeft,
                            .position = {}};
    TrackSpec track = TrackOf(yard, std::to_string(k), begin);
    const double fouling_m =
        k + 1 == yard.num_tracks ? ladder.last_fouling_m() : ladder.fouling_m();
    track.elements = {
        StraightElement(std::max(1.0, fouling_m - ladder.behind_m() + yard.usable_length_m))};
    tracks.push_back(std::move(track));
  }
}

}  // namespace

std::vector<TrackSpec> TracksOfYards(const WorldSpec& world) {
  std::vector<TrackSpec> tracks;
  for (const YardSpec& yard : world.yards) AddTracksOf(yard, tracks);
  return tracks;
}

WorldSpec WithTracksOfYards(const WorldSpec& world) {
  WorldSpec result = world;
  for (TrackSpec& track : TracksOfYards(world)) result.tracks.push_back(std::move(track));
  result.yards.clear();
  return result;
}

void CheckYards(const WorldSpec& world, ErrorList& errors) {
  for (std::size_t i = 0; i < world.yards.size(); ++i) {
    const YardSpec& yard = world.yards[i];
    const std::string place = "/world/yards/" + std::to_string(i);
    if (!yard.begin.s_m) {
      errors.Add({place + "/begin", "must have s_m, the chainage of the turnout's beginning", ""});
    }
    if (!yard.begin.side) errors.Add({place + "/begin", "must have a side", ""});
    const TurnoutGeometry turnout = GeometryOf(yard.begin.turnout);
    // A millimetre more, so that there is something between two turnouts.
    const double least_m =
        std::max(kFoulingDistance_m, (turnout.length_m + 1e-3) * std::sin(turnout.angle_rad));
    if (!(yard.spacing_m >= least_m)) {
      errors.Add({place + "/spacing_m",
                  "must be at least " + MetresText(std::ceil(least_m * 1e3) * 1e-3) +
                      " m, for fouling points and for turnouts " +
                      std::string(NameOf(yard.begin.turnout)) + " to follow each other in the lead",
                  NumberText(yard.spacing_m)});
    }
  }
}

Fault FaultOfYard(const WorldSpec& world, const Fault& fault) {
  constexpr std::string_view kTracks = "/world/tracks/";
  if (!fault.place.starts_with(kTracks)) return fault;
  std::size_t index = 0;
  std::from_chars(fault.place.data() + kTracks.size(), fault.place.data() + fault.place.size(),
                  index);
  if (index < world.tracks.size()) return fault;
  index -= world.tracks.size();
  for (std::size_t i = 0; i < world.yards.size(); ++i) {
    const YardSpec& yard = world.yards[i];
    if (index < yard.num_tracks) {
      const std::string name = yard.name + "_" + (index == 0 ? "lead" : std::to_string(index));
      return {"/world/yards/" + std::to_string(i), "track " + Quoted(name) + " " + fault.rule,
              fault.value};
    }
    index -= yard.num_tracks;
  }
  return fault;
}

}  // namespace railcast
