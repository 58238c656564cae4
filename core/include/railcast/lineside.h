#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "railcast/enum_names.h"
#include "railcast/track_side.h"

namespace railcast {

/// What every structure at one place of a track has. The chainage is that of the line.
struct PointSpec {
  std::string name;  ///< Unique among the structures.
  std::string track = "main";
  double s_m{};

  bool operator==(const PointSpec&) const = default;
};

/// The trains for which something stands beside a track: it faces them.
enum class RunningDirection {
  kRising,   ///< Trains that run with rising chainage.
  kFalling,  ///< Trains that run with falling chainage.
};
template <>
inline constexpr auto kEnumNames<RunningDirection> = std::to_array<EnumName<RunningDirection>>(
    {{RunningDirection::kRising, "rising"}, {RunningDirection::kFalling, "falling"}});

/// Something upright that trains of one direction should see.
struct FacingSpec : PointSpec {
  RunningDirection direction = RunningDirection::kRising;
  std::optional<TrackSide> side;     ///< Absent = on the right of those trains.
  std::optional<double> distance_m;  ///< From the track's axis to its middle; absent = by kind.
  std::optional<double> height_m;    ///< Height of its top above top of rail; absent = by kind.

  bool operator==(const FacingSpec&) const = default;
};

/// Kind of a signal, which sets its height and its face.
enum class SignalKind { kMain, kDistant, kShunting };
template <>
inline constexpr auto kEnumNames<SignalKind> =
    std::to_array<EnumName<SignalKind>>({{SignalKind::kMain, "main"},
                                         {SignalKind::kDistant, "distant"},
                                         {SignalKind::kShunting, "shunting"}});

/// A signal on its post.
struct SignalSpec : FacingSpec {
  SignalKind kind{};

  bool operator==(const SignalSpec&) const = default;
};

/// Kind of a board, which sets its shape, size and height.
enum class BoardKind {
  kSpeed,              ///< A rectangle, as where a speed begins (Lf 7).
  kSpeedAnnouncement,  ///< A triangle on its tip, as ahead of it (Lf 6).
  kKilometre,          ///< A low rectangle.
  kFoulingPoint,       ///< A painted post between tracks (Ra 12); all other boards retroreflect.
};
template <>
inline constexpr auto kEnumNames<BoardKind> =
    std::to_array<EnumName<BoardKind>>({{BoardKind::kSpeed, "speed"},
                                        {BoardKind::kSpeedAnnouncement, "speed_announcement"},
                                        {BoardKind::kKilometre, "kilometre"},
                                        {BoardKind::kFoulingPoint, "fouling_point"}});

/// A signal board on its post.
struct BoardSpec : FacingSpec {
  BoardKind kind{};
  std::optional<std::array<double, 2>> size_m;  ///< Width, height; absent = by kind.

  bool operator==(const BoardSpec&) const = default;
};

/// A balise in the middle of the track, on the sleeper nearest to its chainage.
struct BaliseSpec : PointSpec {
  bool operator==(const BaliseSpec&) const = default;
};

/// A derailer on one rail.
struct DerailerSpec : PointSpec {
  TrackSide side = TrackSide::kRight;

  bool operator==(const DerailerSpec&) const = default;
};

/// A cabinet beside the track, on the ground.
struct RelayBoxSpec : PointSpec {
  TrackSide side = TrackSide::kRight;
  double distance_m = 4.0;                         ///< From the track's axis to its middle.
  std::array<double, 3> size_m{1.20, 0.50, 1.25};  ///< Length, depth, height.

  bool operator==(const RelayBoxSpec&) const = default;
};

/// Kind of furniture, which sets its shape and size.
enum class FurnitureKind { kLamp, kBench, kShelter };
template <>
inline constexpr auto kEnumNames<FurnitureKind> =
    std::to_array<EnumName<FurnitureKind>>({{FurnitureKind::kLamp, "lamp"},
                                            {FurnitureKind::kBench, "bench"},
                                            {FurnitureKind::kShelter, "shelter"}});

/// What stands on platforms and beside tracks, its front towards the track.
struct FurnitureSpec : PointSpec {
  FurnitureKind kind{};
  TrackSide side = TrackSide::kRight;
  double distance_m = 5.0;  ///< From the track's axis to its middle.
  /// Height of its foot above top of rail; absent = on the ground, or on the platform there.
  std::optional<double> h_m;

  bool operator==(const FurnitureSpec&) const = default;
};

/// One of the two ends of a track.
enum class TrackTip { kBegin, kEnd };
template <>
inline constexpr auto kEnumNames<TrackTip> =
    std::to_array<EnumName<TrackTip>>({{TrackTip::kBegin, "begin"}, {TrackTip::kEnd, "end"}});

/// A buffer stop on the first or last metres of a track.
struct BufferStopSpec {
  std::string name;  ///< Unique among the structures.
  std::string track = "main";
  TrackTip at = TrackTip::kEnd;

  bool operator==(const BufferStopSpec&) const = default;
};

/// Barriers of a level crossing and where they stand.
enum class BarrierState { kNone, kOpen, kClosed };
template <>
inline constexpr auto kEnumNames<BarrierState> =
    std::to_array<EnumName<BarrierState>>({{BarrierState::kNone, "none"},
                                           {BarrierState::kOpen, "open"},
                                           {BarrierState::kClosed, "closed"}});

/// A value at a time of the simulation.
struct TimedValue {
  double time_s{};
  double value{};

  bool operator==(const TimedValue&) const = default;
};

/// A road that crosses all tracks at a right angle, at the height of their rails. Road traffic
/// keeps to the right.
struct LevelCrossingSpec : PointSpec {
  double road_width_m = 6.0;                      ///< Along the track.
  double road_length_m = 20.0;                    ///< To either side of the track's axis.
  BarrierState barriers = BarrierState::kClosed;  ///< Half barriers.
  /// Angle of barriers that stand half way, instead of `barriers`: 0 = closed, 90 = upright.
  std::optional<double> barrier_angle_deg;
  /// Angles by time, of barriers that move while the scenario runs: linear between the entries,
  /// constant before the first and after the last. The booms are then objects of the world.
  std::vector<TimedValue> barrier_angles_deg{};
  bool has_signs = true;  ///< Whether there are St Andrew's crosses with lamps.

  bool operator==(const LevelCrossingSpec&) const = default;
};

/// Shape of a building's roof.
enum class RoofKind { kFlat, kGable };
template <>
inline constexpr auto kEnumNames<RoofKind> =
    std::to_array<EnumName<RoofKind>>({{RoofKind::kFlat, "flat"}, {RoofKind::kGable, "gable"}});

/// A building with straight walls between the corners of its footprint.
struct BuildingSpec {
  std::string name;  ///< Unique among the structures.
  std::string track = "main";
  /// Corners in plan, one after the other: chainage, and distance left of the track's axis.
  std::vector<std::array<double, 2>> footprint_m;
  double height_m = 6.0;  ///< Height of the walls above the lowest ground at a corner.
  RoofKind roof = RoofKind::kFlat;
  double roof_pitch_deg = 35.0;  ///< Pitch of a gable roof, which covers four corners.
  bool has_windows = true;

  bool operator==(const BuildingSpec&) const = default;
};

}  // namespace railcast
