#include "core/scenario/descriptions.h"

#include <algorithm>

#include "core/scenario/shared_keys.h"
#include "railcast/lineside.h"

namespace railcast {

namespace {

/// Distances from the axis of a track at which something may stand: nothing nearer than rails and
/// sleepers leave room for.
[[nodiscard]] Limits StandingDistanceLimits() {
  return Within(1.0, 1000);
}

/// The keys of PointSpec.
template <class Structure>
void DescribePoint(Archive& a, Structure& s) {
  DescribeNameAndTrack(a, s, "The track beside or in which it stands.");
  a.Required("s_m", s.s_m, "Chainage of its middle.", ChainageLimits());
}

/// The keys of FacingSpec.
template <class Structure>
void DescribeFacing(Archive& a, Structure& s, KeyDoc height_doc) {
  DescribePoint(a, s);
  a.Required("kind", s.kind, "Its kind.");
  a.Optional("direction", s.direction,
             "It faces trains that run with rising or with falling chainage.");
  a.Optional("side", s.side,
             "Side of the track, towards increasing chainage; absent = right of those trains.");
  a.Optional("distance_m", s.distance_m, "From the track's axis; absent = by kind.",
             StandingDistanceLimits());
  a.Optional("height_m", s.height_m, height_doc, Within(0, 15));
}

}  // namespace

void Describe(Archive& a, SignalSpec& s) {
  DescribeFacing(a, s,
                 "Height of its top above top of rail: at least 2.5 for a main or distant signal, "
                 "0.4 for a shunting signal; absent = by kind.");
  // Else the screen and the boards below it would reach into the ground.
  const double least_m = s.kind == SignalKind::kShunting ? 0.4 : 2.5;
  a.Ensure({"height_m", "kind"}, !s.height_m || *s.height_m >= least_m,
           s.kind == SignalKind::kShunting ? "must be >= 0.4 for a shunting signal"
                                           : "must be >= 2.5 for a main or distant signal");
}

void Describe(Archive& a, BoardSpec& s) {
  DescribeFacing(a, s, "Height of its top above top of rail; absent = by kind.");
  a.Optional("size_m", s.size_m, "Width and height of its plate; absent = by kind.",
             Within(0.1, 5));
  a.Ensure({"size_m", "kind"}, !s.size_m || s.kind != BoardKind::kFoulingPoint,
           "must not be given for a fouling point marker");
}

void Describe(Archive& a, BaliseSpec& s) {
  DescribePoint(a, s);
}

void Describe(Archive& a, DerailerSpec& s) {
  DescribePoint(a, s);
  a.Optional("side", s.side, "The rail on which it lies, towards increasing chainage.");
}

void Describe(Archive& a, RelayBoxSpec& s) {
  DescribePoint(a, s);
  a.Optional("side", s.side, "Side of the track, towards increasing chainage.");
  a.Optional("distance_m", s.distance_m, "From the track's axis to its middle.",
             StandingDistanceLimits());
  a.Optional("size_m", s.size_m, "Length, depth, height.", Within(0.3, 10));
}

void Describe(Archive& a, FurnitureSpec& s) {
  DescribePoint(a, s);
  a.Required("kind", s.kind, "Its kind.");
  a.Optional("side", s.side, "Side of the track, towards increasing chainage.");
  a.Optional("distance_m", s.distance_m, "From the track's axis to its middle.",
             StandingDistanceLimits());
  a.Optional(
      "h_m", s.h_m,
      "Height of its foot above top of rail; absent = on the ground or on the platform there.",
      Within(-100, 100));
}

void Describe(Archive& a, BufferStopSpec& s) {
  DescribeNameAndTrack(a, s, "The track that ends.");
  a.Optional("at", s.at, "Whether it stands where the track begins or where it ends.");
}

void Describe(Archive& a, TimedValue& s) {
  a.Required("time_s", s.time_s, "Simulation time.", Within(0, 1e9));
  a.Required("value", s.value, "Value at that time.", Within(0, 90));
}

void Describe(Archive& a, LevelCrossingSpec& s) {
  DescribePoint(a, s);
  // Barriers and shoulders must not reach farther beyond a chunk than windows allow for.
  a.Optional("road_width_m", s.road_width_m, "Width of the road, along the track.", Within(2, 12));
  a.Optional("road_length_m", s.road_length_m,
             "Length of the road to either side of the track's axis.", Within(6, 200));
  a.Optional("barriers", s.barriers, "Half barriers: none, open or closed.");
  a.Optional(
      "barrier_angle_deg", s.barrier_angle_deg,
      "Angle of barriers that stand still half way, instead of barriers: 0 = closed, 90 = upright.",
      Within(0, 90));
  a.Optional(
      "barrier_angles_deg", s.barrier_angles_deg,
      "Angles of barriers that move while the scenario runs, by time, linear between the entries.");
  a.Optional("has_signs", s.has_signs, "Whether there are St Andrew's crosses with lamps.");
  a.Ensure({"barrier_angle_deg", "barriers"},
           !s.barrier_angle_deg || s.barriers != BarrierState::kNone,
           "must not be given for barriers \"none\"");
  a.Ensure({"barrier_angles_deg", "barriers"},
           s.barrier_angles_deg.empty() || s.barriers != BarrierState::kNone,
           "must not be given for barriers \"none\"");
  a.Ensure({"barrier_angles_deg", "barrier_angle_deg"},
           s.barrier_angles_deg.empty() || !s.barrier_angle_deg,
           "must not be given beside barrier_angle_deg");
  const auto is_not_after = [](const TimedValue& one, const TimedValue& next) {
    return one.time_s >= next.time_s;
  };
  a.Ensure(
      {"barrier_angles_deg"},
      std::ranges::adjacent_find(s.barrier_angles_deg, is_not_after) == s.barrier_angles_deg.end(),
      "must have rising times");
}

void Describe(Archive& a, BuildingSpec& s) {
  DescribeNameAndTrack(a, s, "The track in whose coordinates its footprint is given.");
  a.Required("footprint_m", s.footprint_m,
             "Corners in plan, one after the other: chainage, and distance from the track's axis, "
             "left positive.",
             EachNumber{.limits = Within(-1e7, 1e7), .at_least = 3});
  a.Optional("height_m", s.height_m, "Height of the walls above the lowest ground at a corner.",
             Within(1, 200));
  a.Optional("roof", s.roof, "Flat, or a gable over the longer sides of four corners.");
  a.Optional("roof_pitch_deg", s.roof_pitch_deg, "Pitch of a gable roof.", Within(5, 75));
  a.Optional("has_windows", s.has_windows, "Whether there are windows of glass in every storey.");
  a.Ensure({"footprint_m", "roof"}, s.roof == RoofKind::kFlat || s.footprint_m.size() == 4,
           "must have four corners under a gable roof");
}

}  // namespace railcast
