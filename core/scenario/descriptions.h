#pragma once

#include <string>
#include <vector>

#include "core/scenario/archive.h"
#include "railcast/camera.h"
#include "railcast/motion_sensors.h"
#include "railcast/scenario.h"

namespace railcast {

// Every spec has one description: `Describe(archive, spec)` names each field's key, value, meaning
// and rule (json_rules.h). Four archives (archive.h) visit it, so that reading, writing, checking
// and the published schema cannot drift apart: JsonReader fills the spec, JsonWriter writes the
// resolved scenario and the short files that are made for users, SpecChecker checks what was made
// in C++, SchemaWriter (tests/core/scenario) makes the schema.
//
// A value may be a bool, an unsigned integer, a double, a string, an enumeration with names
// (kEnumNames), an array, a vector, an optional, a struct with a description, or a variant of such
// structs, which "type" distinguishes (kTypeName).
//
// To add a field: add it, with its default, to the struct; add one line to its description;
// regenerate the schemas (see tests/core/scenario/scenario_schema_test.cpp).

/// A table of models as a file of its own.
struct ModelFile {
  std::vector<ModelSpec> models;
};

/// A label table as a file of its own.
struct LabelFile {
  std::vector<Label> labels;
};

// describe_lidar.cpp
void Describe(Archive& a, RasterSpec& s);
void Describe(Archive& a, ChannelSpec& s);
void Describe(Archive& a, SpinningSpec& s);
void Describe(Archive& a, PrismSpec& s);
void Describe(Archive& a, RisleySpec& s);
void Describe(Archive& a, FiringTableSpec& s);
void Describe(Archive& a, ScanSpec& s);
void Describe(Archive& a, MountSpec& s);
void Describe(Archive& a, MountErrorSpec& s);
void Describe(Archive& a, PlausibilitySpec& s);
void Describe(Archive& a, BeamSpec& s);
void Describe(Archive& a, ReceiverSpec& s);
void Describe(Archive& a, CoverSpec& s);
void Describe(Archive& a, VelocitySpec& s);
void Describe(Archive& a, LidarSpec& s);

// describe_weather.cpp
void Describe(Archive& a, SunSpec& s);
void Describe(Archive& a, WeatherSpec& s);

// describe_alignment.cpp
void Describe(Archive& a, CurvatureSection& s);
void Describe(Archive& a, AlignmentSectionsSpec& s);
void Describe(Archive& a, AlignmentElement& s);
void Describe(Archive& a, AlignmentElementsSpec& s);
void Describe(Archive& a, AlignmentSplineSpec& s);
void Describe(Archive& a, ChainageValue& s);
void Describe(Archive& a, MapSpec& s);
void Describe(Archive& a, AlignmentSpec& s);

// describe_lineside.cpp
void Describe(Archive& a, SignalSpec& s);
void Describe(Archive& a, BoardSpec& s);
void Describe(Archive& a, BaliseSpec& s);
void Describe(Archive& a, DerailerSpec& s);
void Describe(Archive& a, RelayBoxSpec& s);
void Describe(Archive& a, FurnitureSpec& s);
void Describe(Archive& a, BufferStopSpec& s);
void Describe(Archive& a, TimedValue& s);
void Describe(Archive& a, LevelCrossingSpec& s);
void Describe(Archive& a, BuildingSpec& s);

// describe_structures.cpp
void Describe(Archive& a, PlatformRoofSpec& s);
void Describe(Archive& a, PlatformSpec& s);
void Describe(Archive& a, NoiseWallSpec& s);
void Describe(Archive& a, FenceSpec& s);
void Describe(Archive& a, RetainingWallSpec& s);
void Describe(Archive& a, CableTroughSpec& s);
void Describe(Archive& a, TunnelSpec& s);
void Describe(Archive& a, BridgeSpec& s);
void Describe(Archive& a, OverbridgeSpec& s);
void Describe(Archive& a, ThirdRailSpec& s);
void Describe(Archive& a, SlabTrackSpec& s);

// describe_objects.cpp
void Describe(Archive& a, SpeedPoint& s);
void Describe(Archive& a, PathPoint& s);
void Describe(Archive& a, PathSpec& s);
void Describe(Archive& a, MotionSpec& s);
void Describe(Archive& a, MeshPartSpec& s);
void Describe(Archive& a, PersonSpec& s);
void Describe(Archive& a, ObjectSpec& s);
void Describe(Archive& a, TrainVehicleSpec& s);
void Describe(Archive& a, TrainSpec& s);

// describe_models.cpp
void Describe(Archive& a, RailVehicleSpec& s);
void Describe(Archive& a, OsdarSpec& s);
void Describe(Archive& a, ModelSpec& s);
void Describe(Archive& a, ModelFile& s);

// describe_motion_sensors.cpp
void Describe(Archive& a, ImuSpec& s);
void Describe(Archive& a, GnssSpec& s);
void Describe(Archive& a, OdometerSpec& s);
void Describe(Archive& a, MotionSensorsSpec& s);

// describe_world.cpp
void Describe(Archive& a, TurnoutSpec& s);
void Describe(Archive& a, TrackSpec& s);
void Describe(Archive& a, YardSpec& s);
void Describe(Archive& a, DiamondCrossingSpec& s);
void Describe(Archive& a, CatenarySpec& s);
void Describe(Archive& a, ElevationSpec& s);
void Describe(Archive& a, ReliefSpec& s);
void Describe(Archive& a, TerrainSpec& s);
void Describe(Archive& a, BallastSpec& s);
void Describe(Archive& a, VegetationSpec& s);
void Describe(Archive& a, RecordingWorldSpec& s);
void Describe(Archive& a, HalfWidth& s);
void Describe(Archive& a, WorldSpec& s);
void Describe(Archive& a, RideSpec& s);
void Describe(Archive& a, VehicleSpec& s);

// describe_scenario.cpp
void Describe(Archive& a, DistortionSpec& s);
void Describe(Archive& a, CameraSpec& s);
void Describe(Archive& a, SensorInterface& s);
void Describe(Archive& a, Ros2Spec& s);
void Describe(Archive& a, InterfacesSpec& s);
void Describe(Archive& a, ToleranceSpec& s);
void Describe(Archive& a, OutputSpec& s);
void Describe(Archive& a, Material& s);
void Describe(Archive& a, Label& s);
void Describe(Archive& a, LabelFile& s);
void Describe(Archive& a, ScenarioSpec& s);

template <>
inline constexpr const char* kTypeName<RasterSpec> = "raster";
template <>
inline constexpr const char* kTypeName<SpinningSpec> = "spinning";
template <>
inline constexpr const char* kTypeName<RisleySpec> = "risley";
template <>
inline constexpr const char* kTypeName<FiringTableSpec> = "table";
template <>
inline constexpr bool kElementMayBeFile<LidarSpec> = true;
template <>
inline constexpr const char* kTypeName<AlignmentSectionsSpec> = "sections";
template <>
inline constexpr const char* kTypeName<AlignmentElementsSpec> = "elements";
template <>
inline constexpr const char* kTypeName<AlignmentSplineSpec> = "spline";
template <>
inline constexpr const char* kTypeName<SignalSpec> = "signal";
template <>
inline constexpr const char* kTypeName<BoardSpec> = "board";
template <>
inline constexpr const char* kTypeName<BaliseSpec> = "balise";
template <>
inline constexpr const char* kTypeName<DerailerSpec> = "derailer";
template <>
inline constexpr const char* kTypeName<RelayBoxSpec> = "relay_box";
template <>
inline constexpr const char* kTypeName<FurnitureSpec> = "furniture";
template <>
inline constexpr const char* kTypeName<BufferStopSpec> = "buffer_stop";
template <>
inline constexpr const char* kTypeName<LevelCrossingSpec> = "level_crossing";
template <>
inline constexpr const char* kTypeName<BuildingSpec> = "building";
template <>
inline constexpr const char* kTypeName<PlatformSpec> = "platform";
template <>
inline constexpr const char* kTypeName<NoiseWallSpec> = "noise_wall";
template <>
inline constexpr const char* kTypeName<FenceSpec> = "fence";
template <>
inline constexpr const char* kTypeName<RetainingWallSpec> = "retaining_wall";
template <>
inline constexpr const char* kTypeName<CableTroughSpec> = "cable_trough";
template <>
inline constexpr const char* kTypeName<TunnelSpec> = "tunnel";
template <>
inline constexpr const char* kTypeName<BridgeSpec> = "bridge";
template <>
inline constexpr const char* kTypeName<OverbridgeSpec> = "overbridge";
template <>
inline constexpr const char* kTypeName<ThirdRailSpec> = "third_rail";
template <>
inline constexpr const char* kTypeName<SlabTrackSpec> = "slab_track";
template <>
inline constexpr bool kIsWrittenInPlace<RailVehicleSpec> = true;
template <>
inline constexpr bool kIsWrittenInPlace<OsdarSpec> = true;
/// Its key "file" does not name a file with its other keys.
template <>
inline constexpr bool kIsWrittenInPlace<ElevationSpec> = true;

}  // namespace railcast
