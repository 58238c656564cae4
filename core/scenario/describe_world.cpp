#include "core/scenario/descriptions.h"

#include <algorithm>

#include "core/rail/catenary/support_layout.h"
#include "core/scenario/shared_keys.h"
#include "railcast/world_spec.h"

namespace railcast {

void Describe(Archive& a, TurnoutSpec& s) {
  a.Required("track", s.track, "The track in which it lies, which runs straight through it.",
             NonEmptyString());
  a.Optional("s_m", s.s_m,
             "Chainage of its beginning, at the tips of its blades; absent only at the end of a "
             "crossover, where it follows.",
             ChainageLimits());
  a.Required("turnout", s.turnout, "Its type: angle and radius.");
  a.Optional("side", s.side,
             "Side of that track, towards rising chainage, to which the branch leaves; absent = "
             "where its offset lies.");
  a.Optional("position", s.position,
             "Where its blades lead; absent = as the vehicle's route needs it, else straight.");
}

void Describe(Archive& a, TrackSpec& s) {
  a.Optional("name", s.name, "Objects and the vehicle name their track by it.", NonEmptyString());
  a.Optional("offset_m", s.offset_m, "From the alignment, left positive; absent = 0.",
             Within(-1000, 1000));
  a.Optional("offsets_m", s.offsets_m,
             "Offsets by chainage, instead of offset_m: constant between equal ones, an S-curve "
             "between others.",
             EachValue(Within(-1000, 1000)));
  a.Optional("elements", s.elements,
             "Elements as if the alignment were straight, from the turnout at its beginning on or "
             "from start_s_m and offset_m.");
  a.Optional(
      "heading_deg", s.heading_deg,
      "Heading of the first element against the alignment, left positive; without a turnout.",
      Within(-45, 45));
  a.Optional("start_s_m", s.start_s_m, "Chainage where the track begins.", ChainageLimits());
  a.Optional("end_s_m", s.end_s_m, "Chainage where it ends; absent = the end of the line.",
             ChainageLimits());
  a.Optional("begin", s.begin, "The turnout where it begins; opens with rising chainage.");
  a.Optional("end", s.end, "The turnout where it ends; opens with falling chainage.");
  a.Optional("sleeper", s.sleeper, "Kind of sleeper.");
  a.Optional("electrified", s.electrified, "Whether it has a contact line.");
  a.Ensure({"end_s_m", "start_s_m"}, !s.end_s_m || *s.end_s_m > s.start_s_m, "must be > start_s_m");
}

void Describe(Archive& a, YardSpec& s) {
  a.Required("name", s.name, "Its tracks are called NAME_lead, NAME_1, NAME_2 and so on.",
             NonEmptyString());
  a.Required("begin", s.begin,
             "The turnout where its lead begins; its type is that of all turnouts of the yard.");
  a.Required("num_tracks", s.num_tracks,
             "Number of tracks, of which the last is the lead itself, turned back.",
             Within(1, kMostYardTracks));
  a.Optional("spacing_m", s.spacing_m, "Between its tracks, and from the track that it leaves.",
             Within(3, 100));
  a.Required("usable_length_m", s.usable_length_m,
             "Length of each track from its fouling point to its end.", PositiveUpTo(1e4));
  a.Optional("sleeper", s.sleeper, "Kind of sleeper.");
  a.Optional("electrified", s.electrified, "Whether its tracks have a contact line.");
}

void Describe(Archive& a, DiamondCrossingSpec& s) {
  a.Required("tracks", s.tracks, "The two tracks that cross.", NonEmptyString());
  a.Required("s_m", s.s_m, "Chainage where their axes cross, within 5 m.", PlaceLimits());
  a.Ensure({"tracks"}, s.tracks.size() == 2, "must name two tracks");
}

void Describe(Archive& a, CatenarySpec& s) {
  a.Optional("enabled", s.enabled, "Whether there is a contact line.");
  a.Optional("contact_height_m", s.contact_height_m, "Above top of rail.", Within(4, 8));
  a.Optional("system_height_m", s.system_height_m,
             "Messenger wire above contact wire at a support.", PositiveUpTo(4));
  a.Optional("max_span_m", s.max_span_m, "Greatest span; spans are shorter in curves.",
             Within(10, 100));
  a.Optional("stagger_m", s.stagger_m, "Stagger of the contact wire at supports.", Within(0, 1));
  a.Optional("dropper_spacing_m", s.dropper_spacing_m, "Distance between droppers, about.",
             Within(1, 50));
  a.Optional("mast_distance_m", s.mast_distance_m, "From the face of the mast to the track axis.",
             Within(kMastClearance_m, 20));
}

void Describe(Archive& a, ElevationSpec& s) {
  a.Required("file", s.file, "ESRI ASCII grid (.asc) of heights in metres.", ExistingFile());
  a.Optional("origin_m", s.origin_m,
             "The file's coordinates and height of the world's origin, which are subtracted.",
             CoordinateLimits());
}

void Describe(Archive& a, ReliefSpec& s) {
  a.Optional("sigma_m", s.sigma_m, "Standard deviation of the hills' heights.", Within(0, 100));
  a.Optional("wavelength_m", s.wavelength_m, "Spacing of hills and valleys, about half of it.",
             Within(50, 10'000));
}

void Describe(Archive& a, TerrainSpec& s) {
  a.Optional("half_width_m", s.half_width_m,
             "Half width of the ground strip; it narrows inside curves that are tighter.",
             Within(5, 1000));
  a.Optional("roughness_sigma_m", s.roughness_sigma_m,
             "Standard deviation of the ground's small heights.", Within(0, 1));
  a.Optional("roughness_wavelength_m", s.roughness_wavelength_m,
             "Correlation length of the ground's small heights.", Within(0.1, 100));
  a.Optional("undulation_sigma_m", s.undulation_sigma_m, "Slow rise and fall away from the track.",
             Within(0, 20));
  a.OneOfTwo("relief", "elevation");
  a.Optional("relief", s.relief,
             "Hills, with cuttings and embankments; absent = as high as the formation.");
  a.Optional("elevation", s.elevation,
             "Terrain of a file, with cuttings and embankments; not together with relief.");
  a.Optional("cover", s.cover, "What the ground is covered with.");
  a.Optional("has_ditches", s.has_ditches,
             "Whether ditches run between the formation and the slopes of cuttings.");
  a.Ensure({"elevation", "relief"}, !s.elevation || !s.relief, "must not be given with relief");
}

namespace {

/// The upper limit exceeds the widest ground strip.
[[nodiscard]] Limits DistanceLimits() {
  return Within(0, 10'000);
}

}  // namespace

void Describe(Archive& a, BallastSpec& s) {
  a.Optional("below_sleepers_m", s.below_sleepers_m,
             "How much lower its top is than the sleepers' tops; below 0, it covers them.",
             Within(-0.1, 0.2));
  a.Optional("outside_below_sleepers_m", s.outside_below_sleepers_m,
             "The same outside the rails; absent = as between them.", Within(-0.1, 0.2));
  a.Optional("shoulder_m", s.shoulder_m,
             "How far its top extends beyond the sleepers' ends; a wide one fills the space "
             "between tracks.",
             Within(0, 2));
  a.Optional("grain_sigma_m", s.grain_sigma_m, "Standard deviation of the heights of its stones.",
             Within(0, 0.1));
}

void Describe(Archive& a, VegetationSpec& s) {
  a.Optional("trees_per_hectare", s.trees_per_hectare, "0 = none.", Within(0, 5000));
  a.Optional("tree_min_distance_m", s.tree_min_distance_m,
             "Distance from the outermost track axis.", DistanceLimits());
  a.Optional("tree_height_min_m", s.tree_height_min_m, "Height of the smallest tree.",
             PositiveUpTo(60));
  a.Optional("tree_height_max_m", s.tree_height_max_m, "Height of the tallest tree.",
             PositiveUpTo(60));
  a.Optional("woods_share", s.woods_share,
             "Share of the land on which trees stand, in woods; 1 = everywhere.", Within(0, 1));
  a.Optional("woods_size_m", s.woods_size_m, "Width of woods and clearings, about.",
             Within(5, 10'000));
  a.Optional("bushes_per_hectare", s.bushes_per_hectare, "0 = none.", Within(0, 5000));
  a.Optional("bush_min_distance_m", s.bush_min_distance_m,
             "Distance from the outermost track axis.", DistanceLimits());
  a.Optional("grass", s.grass, "Whether there is grass.");
  a.Optional("grass_min_distance_m", s.grass_min_distance_m,
             "Distance from the outermost track axis.", DistanceLimits());
  a.Optional("grass_max_distance_m", s.grass_max_distance_m,
             "Distance from the outermost track axis.", DistanceLimits());
  a.Optional("grass_fade_m", s.grass_fade_m,
             "Distance beyond grass_max_distance_m over which the grass thins out.",
             DistanceLimits());
  a.Ensure({"tree_height_min_m", "tree_height_max_m"}, s.tree_height_min_m <= s.tree_height_max_m,
           "must be <= tree_height_max_m");
  a.Ensure({"grass_min_distance_m", "grass_max_distance_m"},
           s.grass_min_distance_m <= s.grass_max_distance_m, "must be <= grass_max_distance_m");
}

void Describe(Archive& a, RecordingWorldSpec& s) {
  a.OneOfTwo("poses_file", "poses");
  a.Optional("poses", s.poses,
             "Where the sensor's poses come from: recorded; standing, for a sensor that does not "
             "move; registered, estimated by laying each cloud on the one before it. Absent = "
             "recorded.");
  a.Optional("poses_file", s.poses_file,
             "The sensor's poses in the world, one for each frame: lines of KITTI's; .csv, as "
             "railcast's poses.csv; .json, OpenLABEL with transforms.",
             ExistingFile());
  a.Ensure({"poses_file", "poses"}, !s.poses_file || !s.poses, "must not be given with poses");
  a.Optional("alignment", s.alignment,
             "The line along which chainages count; absent = the way of the sensor's vehicle, from "
             "where it is in the first frame.");
  a.Optional("track", s.track,
             "found: the sensor is where the clouds show it above a track, and lidar.mount is left "
             "out. Absent = the sensor is where lidar.mount says.");
}

void Describe(Archive& a, HalfWidth& s) {
  a.Required("height_m", s.height_m, "Above top of rail.", Within(0, 10));
  a.Required("half_width_m", s.half_width_m, "From the axis.", Within(0.5, 10));
}

void Describe(Archive& a, WorldSpec& s) {
  a.Optional("seed", s.seed, "Seed of the world's shape: relief, stones, plants.");
  a.OneOfTwo("alignment", "recording");
  const bool has_alignment =
      a.OptionalUnless("alignment", s.alignment, {}, "The axis of the line.");
  a.Optional("recording", s.recording,
             "In plans of railcast-generate insert, instead of alignment: the world is a "
             "recording.");
  a.Ensure({"", "alignment", "recording"}, has_alignment != s.recording.has_value(),
           "must have either alignment or recording");
  a.Optional("tracks", s.tracks, "Along the alignment.", NonEmptyList());
  a.Optional("yards", s.yards, "Ladders of tracks.");
  a.Optional("diamond_crossings", s.diamond_crossings,
             "Where two tracks cross at the height of their rails, at an angle from 1:20 to 1:4.");
  a.Optional("catenary", s.catenary, "Overhead contact line.");
  a.Optional("terrain", s.terrain, "The ground.");
  a.Optional("vegetation", s.vegetation, "Trees and grass.");
  a.Optional("structures", s.structures, "Platforms and the like, by chainage along a track.");
  a.Optional("objects", s.objects, "Things placed beside tracks or on the map.");
  a.Optional("trains", s.trains, "Coupled vehicles that stand on the tracks or run along them.");
  a.Optional("survey", s.survey,
             "File of railcast-generate survey, whose surfaces and wires take the place of ground, "
             "tracks, contact line and plants.",
             ExistingFile());
  a.OptionalUnless("ballast", s.ballast, {}, "The bed of all tracks; absent = the defaults.");
  a.OptionalUnless("clear_space", s.clear_space, {},
                   "What must be clear of structures: half widths on straight track without cant, "
                   "linear between the heights; absent = the outline of EBO, Anlage 2.",
                   NonEmptyList());
  a.Ensure({"clear_space"}, std::ranges::is_sorted(s.clear_space, {}, &HalfWidth::height_m),
           "must have heights that do not fall");
  a.Ensure({"clear_space"}, s.clear_space.empty() || s.clear_space.back().height_m >= 2.0,
           "must reach 2 m or higher");
  a.Optional(
      "detail", s.detail,
      "auto: far away, where the sensor cannot tell the difference, plants, ground and tracks are "
      "coarser and persons who walk have fewer poses; full: as fine as possible everywhere.");
  a.Unique("tracks", s.tracks, "name", &TrackSpec::name);
  a.Unique("yards", s.yards, "name", &YardSpec::name);
  a.Unique("objects", s.objects, "name", &ObjectSpec::name);
  a.Unique("trains", s.trains, "name", &TrainSpec::name);
}

void Describe(Archive& a, RideSpec& s) {
  a.Optional("track_quality", s.track_quality, "State of the track that shakes the vehicle.");
}

void Describe(Archive& a, VehicleSpec& s) {
  DescribeTracks(a, s.track, s.route);
  a.Optional("start_s_m", s.start_s_m, "Chainage of its origin at time 0.", PlaceLimits());
  a.OptionalUnless("motion", s.motion, {}, "Along its track; absent = stands.");
  a.Ensure({"motion"}, !s.motion.path, "must have a profile: the vehicle keeps to its track");
  a.OneOfTwo("pivot_distance_m", "consist");
  const bool has_pivot_distance = a.OptionalUnless(
      "pivot_distance_m", s.pivot_distance_m, VehicleSpec().pivot_distance_m,
      "Between the pivots on which its body rests; the front one is at its origin. 0 = it "
      "follows the tangent; absent = 10.4, or as in consist.",
      Within(0, 30));
  a.Optional("ego_boxes_m", s.ego_boxes_m,
             "Its body in the vehicle frame: min x, y, z, max x, y, z.",
             EachNumber{Within(-1000, 1000)});
  a.Optional(
      "may_overlap", s.may_overlap,
      "Whether it may stand or run inside objects, which check and sequence otherwise refuse.");
  a.Optional(
      "consist", s.consist,
      "The train that the vehicle is part of, from front to rear in its direction of travel.");
  a.Optional("sensor_vehicle", s.sensor_vehicle,
             "Index of the one in consist that carries the sensor.");
  a.Ensure({"pivot_distance_m", "consist"}, s.consist.empty() || !has_pivot_distance,
           "must not be given beside consist");
  a.Ensure({"sensor_vehicle", "consist"},
           s.sensor_vehicle < std::max<std::size_t>(s.consist.size(), 1),
           "must be the index of a vehicle in consist");
  a.Optional("ride", s.ride, "How its body moves on its springs; absent = it does not.");
}

}  // namespace railcast
