#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/line/alignment_spec.h"
#include "core/rail/line/motion_spec.h"

namespace railcast {

/// A track parallel to the alignment. Track 0 is usually "main" at offset 0.
struct TrackSpec {
  std::string name = "main";
  double offset_m = 0.0;             ///< Lateral, left positive.
  double start_s_m = 0.0;            ///< The track exists from here ...
  std::optional<double> end_s_m;     ///< ... to here; absent = the end of the line.
  std::string sleeper = "concrete";  ///< "concrete" (B70) or "wood".
  bool electrified = true;           ///< Whether it has a contact line.

  bool operator==(const TrackSpec&) const = default;
};

/// Overhead contact line (physics.md 7.2, Re 200). Spans are chosen by rule: at most max_span_m,
/// shorter in curves so that the wire stays within the lateral limit between supports.
struct CatenarySpec {
  bool enabled = true;
  double contact_height_m = 5.5;
  double system_height_m = 1.8;
  double max_span_m = 65.0;
  double stagger_m = 0.4;
  double dropper_spacing_m = 8.0;
  double mast_distance_m = 3.3;  ///< Face to track axis.

  bool operator==(const CatenarySpec&) const = default;
};

struct TerrainSpec {
  double half_width_m = 80.0;           ///< Of the ground strip; less than the tightest radius.
  double roughness_sigma_m = 0.04;      ///< Of the ground beside the ballast.
  double roughness_wavelength_m = 2.0;  ///< Correlation length.
  double undulation_sigma_m = 0.6;      ///< Slow rise and fall away from the track.

  bool operator==(const TerrainSpec&) const = default;
};

struct VegetationSpec {
  double trees_per_hectare = 40.0;
  double tree_min_distance_m = 9.0;  ///< From the outermost axis.
  double tree_height_min_m = 6.0;
  double tree_height_max_m = 14.0;
  bool grass = true;
  double grass_min_distance_m = 3.6;  ///< From the outermost axis.
  double grass_max_distance_m = 9.0;

  bool operator==(const VegetationSpec&) const = default;
};

/// Something placed by track coordinates. Wagons follow gradient and cant; everything else stands
/// upright. What moves keeps its distance from its track; its speed is that of its chainage.
struct ObjectSpec {
  std::string name;  ///< Unique.
  std::string type;  ///< "box", "pole", "person", "open_wagon", "flat_wagon", "tank_wagon", "mesh".
  std::string track = "main";
  double s_m{};  ///< Chainage of the object's middle (at time 0 where it moves).
  double d_m{};  ///< Left of the track's axis.
  /// Of its foot, above top of rail. Absent: wagons stand on the rails, all else on the ground or
  /// the ballast below it.
  std::optional<double> h_m;
  double heading_deg{};  ///< Turned left against the direction of the chainage.
  /// Length, width, height: required for "box"; diameter, diameter, height for "pole"; for "person"
  /// and "mesh" scales to this height or size where given. Wagons have their own.
  std::optional<std::array<double, 3>> size_m;
  std::optional<std::string> file;   ///< Of "mesh": OBJ, metres, z up unless `up` says otherwise.
  std::string up = "z";              ///< Of "mesh": "y" or "z".
  double unit_m = 1.0;               ///< Of "mesh": metres per file unit.
  std::optional<std::string> label;  ///< Overrides the type's.
  std::optional<std::string> material;  ///< Overrides the type's.
  std::optional<MotionSpec> motion;     ///< Absent = stands.

  bool operator==(const ObjectSpec&) const = default;
};

struct WorldSpec {
  /// Of the world's shape: relief, stones, plants; the scenario's own seed is for the sensor and
  /// the weather.
  std::uint64_t seed = 1;
  AlignmentSpec alignment;
  std::vector<TrackSpec> tracks{TrackSpec{}};
  CatenarySpec catenary;
  TerrainSpec terrain;
  VegetationSpec vegetation;
  std::vector<ObjectSpec> objects;

  bool operator==(const WorldSpec&) const = default;
};

/// The sensor's own vehicle.
struct VehicleSpec {
  std::string track = "main";
  double start_s_m{};  ///< Chainage of its origin at time 0.
  MotionSpec motion;
  /// Boxes of the vehicle's body in the vehicle frame: min x, y, z, max x, y, z. They block beams
  /// and give outcome `ego`.
  std::vector<std::array<double, 6>> ego_boxes_m;

  bool operator==(const VehicleSpec&) const = default;
};

}  // namespace railcast
