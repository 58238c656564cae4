#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "railcast/alignment.h"
#include "railcast/enum_names.h"
#include "railcast/objects.h"
#include "railcast/structures.h"
#include "railcast/track_side.h"

namespace railcast {

/// Type of sleeper, which sets its shape and material.
enum class SleeperType {
  kConcrete,  ///< B70.
  kWood,
};
template <>
inline constexpr auto kEnumNames<SleeperType> = std::to_array<EnumName<SleeperType>>(
    {{SleeperType::kConcrete, "concrete"}, {SleeperType::kWood, "wood"}});

/// Types of turnout by the slope 1:n and the radius (m) of the diverging track (docs/world.md).
enum class TurnoutType { k9_190, k9_300, k12_500, k14_760 };
template <>
inline constexpr auto kEnumNames<TurnoutType> =
    std::to_array<EnumName<TurnoutType>>({{TurnoutType::k9_190, "1:9-190"},
                                          {TurnoutType::k9_300, "1:9-300"},
                                          {TurnoutType::k12_500, "1:12-500"},
                                          {TurnoutType::k14_760, "1:14-760"}});

/// Where the blades of a turnout lead.
enum class TurnoutPosition { kStraight, kDiverging };
template <>
inline constexpr auto kEnumNames<TurnoutPosition> = std::to_array<EnumName<TurnoutPosition>>(
    {{TurnoutPosition::kStraight, "straight"}, {TurnoutPosition::kDiverging, "diverging"}});

/// A turnout at which a track branches off another one.
struct TurnoutSpec {
  std::string track;  ///< The track in which it lies, whose way through it is the straight one.
  /// Chainage where it begins: at the tips of its blades (the Weichenanfang). May be absent at the
  /// end of a crossover between parallel tracks, where it follows from the crossover's beginning.
  std::optional<double> s_m{};
  TurnoutType turnout{};
  /// Side of `track` to which the branch leaves; absent = where the branch's offset lies.
  std::optional<TrackSide> side{};
  /// Absent = as the vehicle's route needs it, else straight.
  std::optional<TurnoutPosition> position{};

  bool operator==(const TurnoutSpec&) const = default;
};

/// A track along the alignment. Its course is a lateral offset from the alignment as a function of
/// chainage. Track 0 is usually "main" at offset 0.
///
/// The offset is constant, or changes with chainage, or follows from elements in the plane of
/// chainage and offset; with a turnout at its beginning or end the track joins another one there
/// (core/rail/network/network.h has the rules). With turnouts at both ends and neither offsets nor
/// elements it is a crossover.
struct TrackSpec {
  std::string name = "main";
  std::optional<double> offset_m{};          ///< Lateral, left positive; absent = 0.
  std::vector<ChainageValue> offsets_m{};    ///< Instead of offset_m: offsets by chainage.
  std::vector<AlignmentElement> elements{};  ///< In the plane of chainage and offset.
  double heading_deg = 0.0;  ///< Heading of the first element against the alignment; left positive.
  double start_s_m = 0.0;    ///< First chainage of the track, unless a turnout gives it.
  std::optional<double> end_s_m{};     ///< Last chainage of the track; absent = end of the line.
  std::optional<TurnoutSpec> begin{};  ///< Turnout that opens with rising chainage.
  std::optional<TurnoutSpec> end{};    ///< Turnout that opens with falling chainage.
  SleeperType sleeper = SleeperType::kConcrete;
  bool electrified = true;  ///< Whether the track has a contact line.

  bool operator==(const TrackSpec&) const = default;
};

inline constexpr std::uint32_t kMostYardTracks = 100;

/// A ladder of tracks parallel to the one that they branch off (core/rail/network/network_draft.h).
struct YardSpec {
  std::string name;
  /// The turnout from which the lead runs on at its angle; all tracks of the yard branch off the
  /// lead in turnouts of the same type.
  TurnoutSpec begin;
  std::uint32_t num_tracks = 1;  ///< From 1 to kMostYardTracks.
  double spacing_m = 4.5;        ///< Between its tracks, and from the first to the track it leaves.
  /// Length of each track from its fouling point to its end.
  double usable_length_m = 100.0;
  SleeperType sleeper = SleeperType::kWood;
  bool electrified = false;

  bool operator==(const YardSpec&) const = default;
};

/// A place where two tracks cross at the height of their rails, at an angle from 1:20 to 1:4.
struct DiamondCrossingSpec {
  std::vector<std::string> tracks;  ///< Names of the two tracks.
  double s_m{};                     ///< Chainage where their axes cross, to within 5 m.

  bool operator==(const DiamondCrossingSpec&) const = default;
};

/// Overhead contact line (docs/physics.md 7.2, Re 200). Span lengths follow a rule: at most
/// max_span_m, shorter in curves so that the wire stays within the lateral limit between supports.
struct CatenarySpec {
  bool enabled = true;
  double contact_height_m = 5.5;  ///< Height of the contact wire above top of rail.
  double system_height_m = 1.8;   ///< Messenger wire above contact wire, at supports.
  double max_span_m = 65.0;
  double stagger_m = 0.4;  ///< Stagger of the contact wire at supports.
  double dropper_spacing_m = 8.0;
  double mast_distance_m = 3.3;  ///< From the track axis to the face of the mast.

  bool operator==(const CatenarySpec&) const = default;
};

/// Heights of the terrain from a file, an ESRI ASCII grid in metres.
struct ElevationSpec {
  std::string file;
  /// The world's origin in the coordinates and heights of the file: world = file - origin_m.
  std::array<double, 3> origin_m{0, 0, 0};

  bool operator==(const ElevationSpec&) const = default;
};

/// Hills that the line passes through in cuttings and on embankments.
struct ReliefSpec {
  double sigma_m = 4.0;         ///< Standard deviation of their heights about the formation's.
  double wavelength_m = 200.0;  ///< Spacing of the lattice of their heights.

  bool operator==(const ReliefSpec&) const = default;
};

/// What the ground is covered with.
enum class GroundCover {
  kSoil,    ///< Soil everywhere.
  kFields,  ///< Gravel on the formation, meadow on its slopes, then meadows and fields.
};
template <>
inline constexpr auto kEnumNames<GroundCover> = std::to_array<EnumName<GroundCover>>(
    {{GroundCover::kSoil, "soil"}, {GroundCover::kFields, "fields"}});

/// The ground beside the tracks.
struct TerrainSpec {
  /// Half width of the ground strip. If it is at least the line's tightest radius, the strip is
  /// narrower inside tight curves (core/rail/landform/landform.h).
  double half_width_m = 80.0;
  double roughness_sigma_m = 0.04;      ///< Roughness of the ground beside the ballast.
  double roughness_wavelength_m = 2.0;  ///< Correlation length of the roughness.
  double undulation_sigma_m = 0.6;      ///< Large-scale relief away from the track.
  /// The terrain that the formation is cut into or raised above; at most one of the two. Without
  /// either, the terrain is as high as the formation.
  std::optional<ElevationSpec> elevation;
  std::optional<ReliefSpec> relief;
  GroundCover cover = GroundCover::kSoil;
  bool has_ditches = false;  ///< Whether ditches run between formation and slopes of cuttings.

  bool operator==(const TerrainSpec&) const = default;
};

/// How fine plants, ground and tracks are traced.
enum class SceneDetail {
  kAuto,  ///< Coarser far away, where the sensor cannot tell the difference.
  kFull,  ///< As fine as possible everywhere.
};
template <>
inline constexpr auto kEnumNames<SceneDetail> = std::to_array<EnumName<SceneDetail>>(
    {{SceneDetail::kAuto, "auto"}, {SceneDetail::kFull, "full"}});

/// The ballast of all tracks.
struct BallastSpec {
  double below_sleepers_m = 0.020;  ///< Its top is so much lower than the sleepers' tops.
  /// The same outside the rails; absent = as between them.
  std::optional<double> outside_below_sleepers_m{};
  double shoulder_m = 0.45;      ///< Its top extends so far beyond the sleepers' ends.
  double grain_sigma_m = 0.020;  ///< Standard deviation of the heights of its stones.

  bool operator==(const BallastSpec&) const = default;
};

/// Trees, bushes and grass beside the tracks.
struct VegetationSpec {
  double trees_per_hectare = 40.0;
  double tree_min_distance_m = 9.0;  ///< From the outermost track axis.
  double tree_height_min_m = 6.0;
  double tree_height_max_m = 14.0;
  /// Share of the land on which these trees stand, in woods about `woods_size_m` wide; the rest is
  /// clear of trees. 1 = everywhere.
  double woods_share = 1.0;
  double woods_size_m = 60.0;
  double bushes_per_hectare = 0.0;   ///< From 0.5 to 2.5 m high.
  double bush_min_distance_m = 6.0;  ///< From the outermost track axis.
  bool grass = true;
  double grass_min_distance_m = 3.6;  ///< From the outermost track axis.
  double grass_max_distance_m = 9.0;
  double grass_fade_m = 0.0;  ///< Distance beyond the maximum over which the grass thins out.

  bool operator==(const VegetationSpec&) const = default;
};

/// Where the poses of a recording's sensor come from.
enum class PoseSource {
  kRecorded,    ///< From the recording.
  kStanding,    ///< The sensor stands still; the vehicle is at the world's origin.
  kRegistered,  ///< Estimated from the clouds, each laid on the one before it.
};
template <>
inline constexpr auto kEnumNames<PoseSource> =
    std::to_array<EnumName<PoseSource>>({{PoseSource::kRecorded, "recorded"},
                                         {PoseSource::kStanding, "standing"},
                                         {PoseSource::kRegistered, "registered"}});

/// Where the mount of a recording's sensor comes from, if the plan does not give it.
enum class MountSource {
  kFound,  ///< From where the clouds show the track.
};
template <>
inline constexpr auto kEnumNames<MountSource> =
    std::to_array<EnumName<MountSource>>({{MountSource::kFound, "found"}});

/// A recording as a world: what a plan of railcast-generate insert has in place of an alignment.
struct RecordingWorldSpec {
  std::optional<PoseSource> poses{};         ///< Absent: recorded.
  std::optional<std::string> poses_file{};   ///< File that has the poses instead.
  std::optional<AlignmentSpec> alignment{};  ///< Absent: the line is the path of the vehicle.
  std::optional<MountSource> track{};        ///< Absent: the mount is that of the plan's sensor.

  bool operator==(const RecordingWorldSpec&) const = default;
};

/// Half the width of a space about a track at a height above top of rail.
struct HalfWidth {
  double height_m{};
  double half_width_m{};

  bool operator==(const HalfWidth&) const = default;
};

/// Section `world`: the line, its tracks, the land about them, and all that stands or runs there.
struct WorldSpec {
  /// Seed of the world's geometry: relief, stones, plants. The scenario's own seed drives the
  /// sensor and the weather.
  std::uint64_t seed = 1;
  AlignmentSpec alignment;
  std::vector<TrackSpec> tracks{TrackSpec{}};
  CatenarySpec catenary;
  TerrainSpec terrain;
  VegetationSpec vegetation;
  std::vector<StructureSpec> structures;
  std::vector<ObjectSpec> objects;
  std::vector<TrainSpec> trains{};
  SceneDetail detail = SceneDetail::kAuto;
  std::vector<YardSpec> yards{};
  std::vector<DiamondCrossingSpec> diamond_crossings{};
  /// In plans of railcast-generate insert, instead of `alignment`: no world can be made of it.
  std::optional<RecordingWorldSpec> recording{};
  /// File of a survey (core/extras/survey/survey_file.h), whose surfaces and wires take the place
  /// of ground, tracks, contact line and plants; absent = none.
  std::optional<std::string> survey{};
  BallastSpec ballast{};
  /// What must be clear of structures about straight track without cant, from the lowest row
  /// upwards; empty = kClearHalfWidths (core/rail/clearance/clear_space.h).
  std::vector<HalfWidth> clear_space{};

  bool operator==(const WorldSpec&) const = default;
};

/// State of the track that shakes the sensor's vehicle (core/rail/motion/ride.h).
enum class TrackQuality { kGood, kPoor };
template <>
inline constexpr auto kEnumNames<TrackQuality> = std::to_array<EnumName<TrackQuality>>(
    {{TrackQuality::kGood, "good"}, {TrackQuality::kPoor, "poor"}});

/// How the body of the sensor's vehicle moves on its springs.
struct RideSpec {
  TrackQuality track_quality = TrackQuality::kGood;

  bool operator==(const RideSpec&) const = default;
};

/// The vehicle that carries the sensor.
struct VehicleSpec {
  std::string track = "main";
  double start_s_m{};  ///< Chainage of the vehicle's origin at time 0.
  MotionSpec motion;
  /// Distance between the pivots on which the body rests on the track. The front one is at the
  /// vehicle's origin. 0 = the body follows the tangent at the origin.
  double pivot_distance_m = 10.4;
  /// Boxes of the vehicle's body in the vehicle frame: min x, y, z, max x, y, z. They block beams,
  /// which then have the outcome `ego`.
  std::vector<std::array<double, 6>> ego_boxes_m;
  /// Whether the boxes may stand or run inside objects. If not, `railcast-generate check` and
  /// `sequence` refuse a run in which they do.
  bool may_overlap = false;
  /// The train that the vehicle is part of, from its front to its rear in the direction of travel.
  /// If `ego_boxes_m` is empty, its shape follows from this.
  std::vector<TrainVehicleSpec> consist{};
  std::uint32_t sensor_vehicle = 0;  ///< Index in `consist` of the one that carries the sensor.
  std::optional<RideSpec> ride{};    ///< Absent: the body does not move on its springs.
  /// Instead of `track`: tracks that turnouts join, one after the other in the direction of travel.
  std::vector<std::string> route{};

  bool operator==(const VehicleSpec&) const = default;
};

}  // namespace railcast
