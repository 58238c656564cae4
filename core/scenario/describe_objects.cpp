#include "core/scenario/descriptions.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/shared_keys.h"
#include "railcast/objects.h"

namespace railcast {

namespace {

/// Describes where something is on the map: ObjectSpec, PathPoint.
template <class Placed>
void DescribeMapPlace(Archive& a, Placed& s) {
  a.Optional("x_m", s.x_m,
             "With y_m instead of s_m and d_m: easting in the projection of the alignment's map, "
             "or x of the world if it has none.",
             CoordinateLimits());
  a.Optional("y_m", s.y_m, "Northing, or y of the world.", CoordinateLimits());
  a.Optional("longitude_deg", s.longitude_deg,
             "With latitude_deg instead of s_m and d_m (WGS 84); needs the alignment's map.",
             Within(-180, 180));
  a.Optional("latitude_deg", s.latitude_deg, "Latitude.", Within(-90, 90));
}

/// Whether a place is given in exactly one of three ways.
/// @param is_in_track Whether what is needed of s_m and d_m is given.
/// @param is_free_of_track Whether nothing of it is given.
template <class Placed>
[[nodiscard]] bool HasOnePlace(bool is_in_track, bool is_free_of_track, const Placed& s) {
  const int num_projected = (s.x_m ? 1 : 0) + (s.y_m ? 1 : 0);
  const int num_geographic = (s.longitude_deg ? 1 : 0) + (s.latitude_deg ? 1 : 0);
  return (is_in_track && num_projected + num_geographic == 0) ||
         (is_free_of_track && std::max(num_projected, num_geographic) == 2 &&
          std::min(num_projected, num_geographic) == 0);
}

/// Describes where an object is.
void DescribePlace(Archive& a, ObjectSpec& s) {
  // What the reader is to fill has no place yet, not the one at 0.
  const bool has_track_place = !a.is_reading() && !s.x_m && !s.longitude_deg;
  std::optional<double> s_m;
  std::optional<double> d_m;
  if (has_track_place) s_m = s.s_m;
  if (has_track_place) d_m = s.d_m;
  a.Optional("s_m", s_m, "Chainage of its middle, at time 0 where it moves.", PlaceLimits());
  a.Optional("d_m", d_m, "With s_m: distance from the track's axis, left positive; absent = 0.",
             Within(-1000, 1000));
  DescribeMapPlace(a, s);
  a.Ensure({"", "s_m", "d_m", "x_m", "y_m", "longitude_deg", "latitude_deg"},
           HasOnePlace(s_m.has_value(), !s_m && !d_m, s),
           "must have either s_m (and d_m), or x_m and y_m, or longitude_deg and latitude_deg");
  a.Optional("frame", s.frame,
             "In plans for recordings only: s_m counts ahead from where the vehicle is in this "
             "frame, and x_m and y_m are in the axes of the sensor there.");
  a.Ensure({"frame", "longitude_deg"}, !s.frame || !s.longitude_deg,
           "must not be given beside longitude_deg");
  s.s_m = s_m.value_or(0.0);
  s.d_m = d_m.value_or(0.0);
}

}  // namespace

void DescribeTracks(Archive& a, std::string& track, std::vector<std::string>& route) {
  std::optional<std::string> given_track;
  if (route.empty() && track != "main") given_track = track;
  a.OneOfTwo("track", "route");
  a.Optional("track", given_track, "The track that it runs or stands on; absent = main.");
  const bool has_route = a.OptionalUnless(
      "route", route, {},
      "Instead of track: tracks that turnouts join, one after the other in the direction of "
      "travel.",
      NonEmptyString());
  a.Ensure({"track", "route"}, !given_track || !has_route, "must not be given beside route");
  a.Ensure({"route"}, !has_route || !route.empty(), "must name a track");
  if (given_track) track = *given_track;
}

void Describe(Archive& a, SpeedPoint& s) {
  a.Optional("time_s", s.time_s, "Simulation time of the point; or s_m instead.", Within(0, 1e9));
  a.Optional("s_m", s.s_m, "Chainage of the point; or time_s instead.", PlaceLimits());
  a.Required("speed_mps", s.speed_mps, "Speed at the point.", Within(0, 200));
  a.Ensure({"", "time_s", "s_m"}, s.time_s.has_value() != s.s_m.has_value(),
           "must have either time_s or s_m");
}

void Describe(Archive& a, PathPoint& s) {
  a.Optional("s_m", s.s_m, "Chainage.", PlaceLimits());
  a.Optional("d_m", s.d_m, "Left of its track's axis.", Within(-1000, 1000));
  DescribeMapPlace(a, s);
  a.Optional("speed_mps", s.speed_mps, "Speed on the way to the point; absent = the path's.",
             PositiveUpTo(200));
  a.Optional("wait_s", s.wait_s, "How long it stands there; 0 = it does not stop.", Within(0, 1e9));
  a.Ensure({"", "s_m", "d_m", "x_m", "y_m", "longitude_deg", "latitude_deg"},
           HasOnePlace(s.s_m && s.d_m, !s.s_m && !s.d_m, s),
           "must have either s_m and d_m, or x_m and y_m, or longitude_deg and latitude_deg");
}

void Describe(Archive& a, PathSpec& s) {
  a.Required("points", s.points, "Where it goes from its place, one after the other.",
             NonEmptyList());
  a.Required("speed_mps", s.speed_mps, "Between the points.", PositiveUpTo(200));
  a.Optional("acceleration_mps2", s.acceleration_mps2,
             "At which it sets off, stops and changes its speed.", Within(0.01, 100));
  a.Optional("start_s", s.start_s, "When it sets off; absent = at time 0.", Within(0, 1e9));
  a.Optional("start_at_vehicle_s_m", s.start_at_vehicle_s_m,
             "It sets off when the origin of the sensor's vehicle is at this chainage.",
             PlaceLimits());
  a.Optional("is_smooth", s.is_smooth, "Whether a spline leads through the points.");
  a.Optional("turns_back", s.turns_back,
             "Whether it goes to and fro between its place and the last point.");
  a.Ensure({"points"}, s.turns_back || s.points.empty() || s.points.back().wait_s == 0.0,
           "must not have wait_s at the last point unless turns_back is true: it stays there");
  a.Ensure({"start_s", "start_at_vehicle_s_m"}, !s.start_s || !s.start_at_vehicle_s_m,
           "must not be given beside start_at_vehicle_s_m");
}

void Describe(Archive& a, MotionSpec& s) {
  a.OneOfTwo("profile", "path");
  const bool has_profile = a.OptionalUnless(
      "profile", s.profile, {},
      "Along its track, at constant acceleration between the points; all by time or all by "
      "chainage.",
      NonEmptyListIf{true, "; leave motion out to stand still"});
  a.Optional("path", s.path, "Instead of profile: a way across the tracks.");
  a.Ensure({"", "profile", "path"}, has_profile != s.path.has_value(),
           "must have either profile or path");
  a.Optional("reverse", s.reverse, "Runs against the chainage.");
  a.Ensure({"reverse", "path"}, !s.reverse || !s.path, "must not be given beside path");
  const auto by_time = [](const SpeedPoint& point) { return point.time_s.has_value(); };
  a.Ensure({"profile"},
           std::all_of(s.profile.begin(), s.profile.end(), by_time) ||
               std::none_of(s.profile.begin(), s.profile.end(), by_time),
           "must be all by time_s or all by s_m");
}

void Describe(Archive& a, MeshPartSpec& s) {
  a.Required("of", s.of, "Name of a material or of a group in the mesh's file.", NonEmptyString());
  a.Optional("material", s.material, "Name of a material; absent = the object's.");
  a.Optional("label", s.label, "Name in the label table; absent = the object's.");
  a.Ensure({"", "material", "label"}, s.material || s.label, "must have a material or a label");
}

void Describe(Archive& a, PersonSpec& s) {
  a.Optional("posture", s.posture, "The limbs of a walking person move while the person does.");
  a.Optional("physique", s.physique,
             "Proportions of the body, and its height unless size_m is given.");
  a.Optional("clothing", s.clothing, "Clothes; hi_vis has retroreflective bands.");
  a.Optional("luggage", s.luggage, "What it pulls or pushes.");
}

// NOLINTNEXTLINE(readability-function-size): a table
void Describe(Archive& a, ObjectSpec& s) {
  a.Required("name", s.name, "Unique.", NonEmptyString());
  a.Required("type", s.type, "What it is.");
  DescribeTracks(a, s.track, s.route);
  DescribePlace(a, s);
  a.Optional(
      "h_m", s.h_m,
      "Above top of rail; absent: rail vehicles and drag shoes are on the rails, all else is on "
      "the ground.",
      Within(-1000, 1000));
  a.Optional("heading_deg", s.heading_deg, "Turned left against the chainage's direction.",
             HeadingLimits());
  a.Optional("size_m", s.size_m,
             "Length, width, height. Required for box and pole; scales a person or mesh.",
             Within(1e-3, 1000));
  a.Optional("roll_deg", s.roll_deg, "It leans to the right, about its x axis.", Within(-180, 180));
  a.Optional("pitch_deg", s.pitch_deg, "After roll_deg, it leans forwards, about its y axis.",
             Within(-180, 180));
  a.Optional("follow", s.follow,
             "What it stands upright on; absent: track for rail vehicles, otherwise upright.");
  a.Optional("file", s.file, "File of a mesh: OBJ, PLY, STL, OFF, glTF, FBX, DAE or 3DS.",
             ExistingFile());
  a.Optional("up", s.up, "Upward axis of a mesh; absent: as its file says, otherwise z.");
  a.Optional("unit_m", s.unit_m,
             "Metres per file unit of a mesh; absent: as its file says, otherwise 1.",
             Within(1e-6, 1e6));
  a.Optional(
      "origin", s.origin,
      "Point of a mesh that stands at the object's place: the foot of its bounding box or the "
      "origin of its file.");
  a.Optional("parts", s.parts,
             "Materials and labels of parts of a mesh; the others have those of the object.");
  a.Optional(
      "tolerance_mm", s.tolerance_mm,
      "How far the surfaces of a simplified mesh may be from those of its file; 0 = it stays "
      "as it is.",
      Within(0, 100));
  a.Optional("person", s.person, "How a person looks.");
  a.Optional("label", s.label, "Name of a label, in place of the type's.");
  a.Optional("material", s.material, "Name of a material, in place of the type's.");
  a.Optional("motion", s.motion, "Along its track or a path; absent = stands.");

  const bool is_mesh = s.type == ObjectType::kMesh;
  const bool is_pole = s.type == ObjectType::kPole;
  const bool needs_size = s.type == ObjectType::kBox || is_pole;
  const std::string type = '"' + std::string(NameOf(s.type)) + '"';
  a.Ensure({"size_m", "type"}, s.size_m || !needs_size, "must be given for type " + type);
  const bool has_size = needs_size || is_mesh || s.type == ObjectType::kPerson;
  a.Ensure({"size_m", "type"}, !s.size_m || has_size, "must not be given for type " + type);
  a.Ensure({"size_m", "type"}, !is_pole || !s.size_m || (*s.size_m)[0] == (*s.size_m)[1],
           "must have the same length and width for type \"pole\"");
  a.Ensure({"file", "type"}, s.file || !is_mesh, "must be given for type \"mesh\"");
  a.Ensure({"file", "type"}, !s.file || is_mesh, "must be given for type \"mesh\" only");
  a.Ensure({"origin", "type"}, s.origin == MeshOrigin::kFoot || is_mesh,
           "must be given for type \"mesh\" only");
  a.Ensure({"parts", "type"}, s.parts.empty() || is_mesh, "must be given for type \"mesh\" only");
  a.Ensure({"tolerance_mm", "type"}, s.tolerance_mm == 0.0 || is_mesh,
           "must be given for type \"mesh\" only");
  a.Ensure({"follow", "h_m"}, s.follow != Follow::kGround || !s.h_m,
           "must not be \"ground\" beside h_m, which puts it above the rails");
  a.Ensure({"motion", "type"}, !IsRailVehicle(s.type) || !s.motion || !s.motion->path,
           "must have a profile: a vehicle on rails keeps to its track");
  a.Ensure({"person", "type"}, !s.person || s.type == ObjectType::kPerson,
           "must be given for type \"person\" only");
}

void Describe(Archive& a, TrainVehicleSpec& s) {
  a.Required("type", s.type, "A rail vehicle.");
  a.Optional("name", s.name, "Unique; absent = TRAIN/1, TRAIN/2 and so on.", NonEmptyString());
  a.Optional("is_turned", s.is_turned, "Whether its front faces the train's rear.");
  a.Ensure({"type"}, IsRailVehicle(s.type), "must be a vehicle that runs on rails");
}

void Describe(Archive& a, TrainSpec& s) {
  a.Required("name", s.name, "Unique.", NonEmptyString());
  DescribeTracks(a, s.track, s.route);
  a.Required("s_m", s.s_m, "Chainage of its foremost buffers, at time 0 where it moves.",
             PlaceLimits());
  a.Required("vehicles", s.vehicles, "From front to rear.", NonEmptyList());
  a.Optional("motion", s.motion, "Along its track; absent = stands.");
  a.Ensure({"motion"}, !s.motion || !s.motion->path,
           "must have a profile: a train keeps to its track");
}

}  // namespace railcast
