#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/enum_names.h"

namespace railcast {

/// One point of a speed profile: a speed at a time or at a chainage (exactly one of them is given).
struct SpeedPoint {
  std::optional<double> time_s;
  std::optional<double> s_m;  ///< Chainage.
  double speed_mps{};         ///< >= 0.

  bool operator==(const SpeedPoint&) const = default;
};

/// A place that a path leads to: in track coordinates (s_m and d_m), in those of the map's
/// projection (x_m and y_m) or on the Earth (longitude_deg and latitude_deg), as for ObjectSpec.
struct PathPoint {
  std::optional<double> s_m;        ///< Chainage.
  std::optional<double> d_m;        ///< Left of the axis of the object's track.
  std::optional<double> x_m;        ///< Easting.
  std::optional<double> y_m;        ///< Northing.
  std::optional<double> speed_mps;  ///< On the way there; absent = the path's.
  double wait_s = 0.0;              ///< How long the object stands there; 0 = it does not stop.
  std::optional<double> longitude_deg{};
  std::optional<double> latitude_deg{};

  bool operator==(const PathPoint&) const = default;
};

/// A way across the tracks, from the object's own place (ObjectSpec::s_m, d_m) to one point after
/// the other (core/rail/motion/path_way.h).
struct PathSpec {
  std::vector<PathPoint> points;
  double speed_mps{};  ///< > 0.
  double acceleration_mps2 = 1.0;
  /// When the object sets off: at a time or when the origin of the sensor's vehicle comes to a
  /// chainage of its route. Absent: at time 0. At most one of the two.
  std::optional<double> start_s;
  std::optional<double> start_at_vehicle_s_m;
  bool is_smooth = false;  ///< Whether a spline leads through the points; otherwise straight lines.
  bool turns_back = false;  ///< Whether the object goes to and fro; otherwise it stays at the end.

  bool operator==(const PathSpec&) const = default;
};

/// Motion along a track, or along a path of its own.
///
/// Acceleration is constant between the points of the profile; before the first and after the last
/// point, speed is constant. A profile is either all in time or all in chainage; an empty one means
/// standing still. `reverse` moves against the chainage. The sensor's own vehicle then also faces
/// that way, whereas an object faces as its heading says.
struct MotionSpec {
  std::vector<SpeedPoint> profile;
  bool reverse = false;
  std::optional<PathSpec> path{};  ///< Instead of `profile`; only for objects.

  bool operator==(const MotionSpec&) const = default;
};

/// The axis of a mesh file that points upwards.
enum class UpAxis { kY, kZ };
template <>
inline constexpr auto kEnumNames<UpAxis> = std::to_array<EnumName<UpAxis>>({{UpAxis::kY, "y"},
                                                                            {UpAxis::kZ, "z"}});

/// The point of a mesh that stands at the object's place.
enum class MeshOrigin {
  kFoot,  ///< The middle of its bounding box in plan, at its lowest point.
  kFile,  ///< The origin of the file's coordinates.
};
template <>
inline constexpr auto kEnumNames<MeshOrigin> =
    std::to_array<EnumName<MeshOrigin>>({{MeshOrigin::kFoot, "foot"}, {MeshOrigin::kFile, "file"}});

/// What the z axis of an object is normal to.
enum class Follow {
  kUpright,  ///< The horizontal plane.
  kTrack,    ///< The plane of the rails, with gradient and cant.
  kGround,   ///< The plane through the ground below it.
};
template <>
inline constexpr auto kEnumNames<Follow> = std::to_array<EnumName<Follow>>(
    {{Follow::kUpright, "upright"}, {Follow::kTrack, "track"}, {Follow::kGround, "ground"}});

/// The material and the label of one part of a mesh file.
struct MeshPartSpec {
  std::string of;  ///< Name of a material or of a group in the file.
  std::optional<std::string> material;
  std::optional<std::string> label;

  bool operator==(const MeshPartSpec&) const = default;
};

/// What makes a model a rail vehicle: it runs on two bogies, follows gradient and cant on their
/// pivots, and couples to others at both ends of its length.
struct RailVehicleSpec {
  double pivot_distance_m{};  ///< Between the pivots of the two bogies.
  std::string bogie;  ///< Mesh file of either bogie; its origin is on the pivot, at top of rail.

  bool operator==(const RailVehicleSpec&) const = default;
};

/// What OSDaR's ontologies call a model: class and attributes.
struct OsdarSpec {
  std::string class_name;  ///< As in OSDaR23.
  std::optional<std::string> type;
  std::optional<std::string> species;
  std::optional<std::string> pose;

  bool operator==(const OsdarSpec&) const = default;
};

/// A thing of fixed shape: an entry of a table of models (docs/models.md). Frame of its mesh: x
/// forward, y left, z up; metres. Of a rail vehicle the origin is midway between the pivots, at top
/// of rail; of all others it is what stands at the object's place.
struct ModelSpec {
  std::string name;   ///< The `type` of objects and of trains' vehicles.
  std::string file;   ///< Its mesh, of any format that objects of type mesh may have.
  std::string label;  ///< Label of the whole, and of parts that have none of their own.
  /// Length, width, and height above the origin. The mesh must have them within 2 cm, or 1 % where
  /// that is more. Vehicles couple at the ends of their length.
  std::array<double, 3> size_m{};
  std::vector<MeshPartSpec> parts{};
  /// Material of parts that get none by `parts` or by a word in their names (docs/things.md).
  std::optional<std::string> material{};
  std::optional<UpAxis> up{};
  std::optional<double> unit_m{};
  MeshOrigin origin = MeshOrigin::kFile;
  double tolerance_mm{};
  std::optional<RailVehicleSpec> rail_vehicle{};
  bool lies_on_rail{};                 ///< Without `h_m` it is at top of rail, not on the ground.
  std::optional<OsdarSpec> osdar{};    ///< Absent: as its label.
  std::optional<std::string> kitti{};  ///< Class in KITTI's benchmark; absent: as its label.

  bool operator==(const ModelSpec&) const = default;
};

/// What an object is: one of four shapes that its own keys describe, or a model.
struct ObjectType {
  static const ObjectType kBox, kPole, kPerson, kMesh;

  std::string_view shape = "box";            ///< Counts only without a model.
  std::shared_ptr<const ModelSpec> model{};  ///< Null for the four shapes.
  std::optional<std::size_t> entry{};        ///< Index in the scenario's table; absent: shipped.
};
inline const ObjectType ObjectType::kBox{.shape = "box"};
inline const ObjectType ObjectType::kPole{.shape = "pole"};
inline const ObjectType ObjectType::kPerson{.shape = "person"};
inline const ObjectType ObjectType::kMesh{.shape = "mesh"};

/// The name of a type in scenarios.
[[nodiscard]] inline std::string_view NameOf(const ObjectType& type) {
  return type.model ? std::string_view(type.model->name) : type.shape;
}
/// Types are equal if their names are: within a scenario, a name stands for one type.
[[nodiscard]] inline bool operator==(const ObjectType& a, const ObjectType& b) {
  return NameOf(a) == NameOf(b);
}

/// Whether the type runs on rails: wagons, locomotives, coaches and cars of trains. They follow
/// gradient and cant on their two pivots, stand on the rails and have fixed sizes.
[[nodiscard]] inline bool IsRailVehicle(const ObjectType& type) {
  return type.model && type.model->rail_vehicle;
}

/// Posture of a person.
enum class Posture { kWalking, kStanding, kCrouching, kSitting, kLying };
template <>
inline constexpr auto kEnumNames<Posture> =
    std::to_array<EnumName<Posture>>({{Posture::kWalking, "walking"},
                                      {Posture::kStanding, "standing"},
                                      {Posture::kCrouching, "crouching"},
                                      {Posture::kSitting, "sitting"},
                                      {Posture::kLying, "lying"}});

/// Build of a person, which sets the body's size.
enum class Physique { kMan, kWoman, kChild };
template <>
inline constexpr auto kEnumNames<Physique> = std::to_array<EnumName<Physique>>(
    {{Physique::kMan, "man"}, {Physique::kWoman, "woman"}, {Physique::kChild, "child"}});

/// What a person wears.
enum class Clothing {
  kPlain,
  kHiVis,  ///< With retroreflective bands (EN ISO 20471).
};
template <>
inline constexpr auto kEnumNames<Clothing> =
    std::to_array<EnumName<Clothing>>({{Clothing::kPlain, "plain"}, {Clothing::kHiVis, "hi_vis"}});

/// What a person pulls or pushes.
enum class Luggage { kNone, kSuitcase, kPram, kBicycle };
template <>
inline constexpr auto kEnumNames<Luggage> =
    std::to_array<EnumName<Luggage>>({{Luggage::kNone, "none"},
                                      {Luggage::kSuitcase, "suitcase"},
                                      {Luggage::kPram, "pram"},
                                      {Luggage::kBicycle, "bicycle"}});

/// How a person looks.
struct PersonSpec {
  Posture posture = Posture::kWalking;  ///< Limbs of a walking person move while the person does.
  Physique physique = Physique::kMan;
  Clothing clothing = Clothing::kPlain;
  Luggage luggage = Luggage::kNone;

  bool operator==(const PersonSpec&) const = default;
};

/// An object placed in track coordinates or on the map (core/rail/traffic/object_draft.h). Unless
/// `follow` says otherwise, rail vehicles follow gradient and cant, and all other objects stand
/// upright. An object that moves along its track keeps its lateral distance from it, and its speed
/// is measured along the chainage.
struct ObjectSpec {
  std::string name;  ///< Unique.
  ObjectType type{};
  std::string track = "main";
  double s_m{};  ///< Chainage of the object's middle; at time 0 if it moves.
  double d_m{};  ///< Lateral position of the middle, left of the track's axis.
  /// Height of the object's foot above top of rail. If absent, rail vehicles stand on the rails and
  /// everything else on the ground or ballast below it.
  std::optional<double> h_m;
  double heading_deg{};  ///< Counterclockwise from the direction of increasing chainage.
  /// Length, width, height. Required for a box; diameter, diameter, height for a pole. For a person
  /// or a mesh, scales the model to this height or size if given. All others have fixed sizes.
  std::optional<std::array<double, 3>> size_m;
  std::optional<std::string> file;  ///< Meshes only: OBJ, PLY, STL, OFF, glTF, FBX, DAE, 3DS.
  /// Meshes only; absent = as a glTF, FBX, DAE or 3DS file says, for others z.
  std::optional<UpAxis> up;
  /// Meshes only: metres per file unit; absent = as the file says, for other formats 1.
  std::optional<double> unit_m;
  std::optional<std::string> label;     ///< Overrides the default of the type.
  std::optional<std::string> material;  ///< Overrides the default of the type.
  std::optional<MotionSpec> motion;     ///< Absent = stationary.
  /// Instead of `track`: tracks that turnouts join, one after the other in the direction of travel.
  std::vector<std::string> route{};
  MeshOrigin origin = MeshOrigin::kFoot;  ///< Meshes only.
  std::vector<MeshPartSpec> parts{};      ///< Meshes only.
  std::optional<Follow> follow{};         ///< Absent: rail vehicles track, all others upright.
  /// Lean of the object: first about its x axis, positive to the right, then about its y axis,
  /// positive forwards. The object's foot is then its lowest point as it leans.
  double roll_deg{};
  double pitch_deg{};
  std::optional<PersonSpec> person{};  ///< Persons only; absent = all defaults.
  /// Meshes only: how far simplified surfaces may be from those of the file; 0 = not simplified.
  double tolerance_mm{};
  /// Instead of s_m and d_m: easting and northing of the alignment's map (MapSpec), or x and y of
  /// the world if that has none.
  std::optional<double> x_m{};
  std::optional<double> y_m{};
  /// Instead of s_m and d_m: WGS 84; needs the alignment's map.
  std::optional<double> longitude_deg{};
  std::optional<double> latitude_deg{};
  /// In plans of railcast-generate insert only: a frame of the recording. s_m counts ahead from
  /// where the vehicle is in this frame; x_m and y_m are in the sensor's axes in this frame.
  std::optional<std::uint32_t> frame{};

  bool operator==(const ObjectSpec&) const = default;
};

/// One vehicle of a train.
struct TrainVehicleSpec {
  ObjectType type{};  ///< A rail vehicle.
  /// Absent: "TRAIN/1", "TRAIN/2", ... in the order of the train. The sensor's own vehicles have no
  /// names.
  std::optional<std::string> name;
  bool is_turned = false;  ///< Whether its front faces the train's rear.

  bool operator==(const TrainVehicleSpec&) const = default;
};

/// Coupled vehicles that follow one route at one speed, each on its own two pivots.
struct TrainSpec {
  std::string name;  ///< Unique among trains and objects.
  std::string track = "main";
  std::vector<std::string> route{};  ///< Instead of `track`.
  double s_m{};                      ///< Chainage of the foremost buffers; at time 0 if it moves.
  /// From front to rear. The front faces rising chainage, or falling chainage if the train's motion
  /// is in reverse.
  std::vector<TrainVehicleSpec> vehicles;
  std::optional<MotionSpec> motion{};  ///< Absent = stationary.

  bool operator==(const TrainSpec&) const = default;
};

}  // namespace railcast
