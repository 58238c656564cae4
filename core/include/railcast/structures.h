#pragma once

#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "railcast/lineside.h"
#include "railcast/track_side.h"

namespace railcast {

/// What every structure along a stretch of track has. Chainages are those of the line.
struct StretchSpec {
  std::string name;  ///< Unique among the structures.
  std::string track = "main";
  double begin_s_m{};
  double end_s_m{};

  bool operator==(const StretchSpec&) const = default;
};

/// A stretch beside one side of its track.
struct SideStretchSpec : StretchSpec {
  TrackSide side{};

  bool operator==(const SideStretchSpec&) const = default;
};

/// A roof of steel on a row of columns in the middle of a platform.
struct PlatformRoofSpec {
  std::optional<double> begin_s_m;  ///< Absent = where the platform begins.
  std::optional<double> end_s_m;    ///< Absent = where the platform ends.
  double height_m = 3.5;            ///< Height of its lower side above the platform.
  double column_spacing_m = 8.0;    ///< At most.

  bool operator==(const PlatformRoofSpec&) const = default;
};

/// A platform. Its edge lies in the frame of the track, so that it follows the cant; its top is
/// level across. In curves, it is farther from the axis (EN 15273-3).
struct PlatformSpec : SideStretchSpec {
  double height_m = 0.76;         ///< Height of the edge above top of rail.
  double edge_distance_m = 1.65;  ///< Distance of the edge from the axis of straight track.
  double width_m = 3.0;
  bool has_edge_strip = true;  ///< Whether a white tactile strip runs along the edge.
  /// Whether its ends are ramps of 1:12, down to 0.08 m below top of rail. They are part of it.
  bool has_ramps = false;
  std::optional<PlatformRoofSpec> roof;

  bool operator==(const PlatformSpec&) const = default;
};

/// A wall against noise: panels between steel posts.
struct NoiseWallSpec : SideStretchSpec {
  double distance_m = 3.8;      ///< Distance of its face from the track's axis.
  double height_m = 3.0;        ///< Above top of rail.
  double post_spacing_m = 5.0;  ///< At most.

  bool operator==(const NoiseWallSpec&) const = default;
};

/// What is stretched between the posts of a fence.
enum class FenceType {
  kWires,  ///< Line wires.
  kMesh,   ///< Mats of upright and lying rods.
};
template <>
inline constexpr auto kEnumNames<FenceType> =
    std::to_array<EnumName<FenceType>>({{FenceType::kWires, "wires"}, {FenceType::kMesh, "mesh"}});

/// A fence on the ground. It is straight between its posts.
struct FenceSpec : SideStretchSpec {
  double distance_m = 6.0;  ///< From the track's axis.
  double height_m = 1.8;    ///< Above the ground.
  FenceType fence = FenceType::kMesh;
  double post_spacing_m = 2.5;  ///< At most.

  bool operator==(const FenceSpec&) const = default;
};

/// A wall that holds back the ground behind it, which is as high as the wall's top. Its face leans
/// away from the track by 1:10.
struct RetainingWallSpec : SideStretchSpec {
  double distance_m = 4.0;  ///< Distance of its face from the track's axis, at top of rail.
  double height_m = 2.0;    ///< Above top of rail.
  double depth_m = 1.7;     ///< Depth of its foot below top of rail.

  bool operator==(const RetainingWallSpec&) const = default;
};

/// A concrete trough for cables with its lid.
struct CableTroughSpec : SideStretchSpec {
  double distance_m = 2.6;  ///< Distance of its nearer side from the track's axis.
  double width_m = 0.4;

  bool operator==(const CableTroughSpec&) const = default;
};

/// A tunnel around its track and the neighbouring one, if that is at most 7.4 m away.
struct TunnelSpec : StretchSpec {
  std::optional<double> radius_m;  ///< Inner radius of its vault; absent = as the tracks need.
  bool has_portals = true;         ///< Whether a wall closes the hill about either mouth.
  double niche_spacing_m = 25.0;   ///< On both sides; 0 = none.
  bool has_handrail = true;

  bool operator==(const TunnelSpec&) const = default;
};

/// A bridge that carries the line over a gap in the ground.
struct BridgeSpec : StretchSpec {
  double depth_m = 6.0;           ///< Depth of the gap's bottom below top of rail.
  double edge_distance_m = 3.5;   ///< From its edges to the axes of the outermost tracks on it.
  double deck_thickness_m = 1.0;  ///< Below the ballast.
  double railing_height_m = 1.1;  ///< Above the edge beam; 0 = none.

  bool operator==(const BridgeSpec&) const = default;
};

/// A bridge that carries a road over the line, straight and level.
struct OverbridgeSpec : StretchSpec {
  double clearance_m = 6.9;  ///< Height of its lower side above top of rail in the middle.
  double deck_thickness_m = 0.9;
  double left_m = 15.0;   ///< Extent to the left of the track's axis.
  double right_m = 15.0;  ///< Extent to the right.
  /// Distance of the piers' or abutments' faces from the axis of the outermost track on each side.
  double pier_distance_m = 5.0;
  double crossing_deg = 90.0;  ///< From the track's direction to the road's, counterclockwise.

  bool operator==(const OverbridgeSpec&) const = default;
};

/// Side of a conductor rail that the vehicle's shoes touch.
enum class ContactSide {
  kTop,     ///< Shoes run on top; boards stand to either side.
  kBottom,  ///< Shoes run below; a cover lies over the rail.
};
template <>
inline constexpr auto kEnumNames<ContactSide> = std::to_array<EnumName<ContactSide>>(
    {{ContactSide::kTop, "top"}, {ContactSide::kBottom, "bottom"}});

/// A conductor rail beside the track, in the plane of the rails.
struct ThirdRailSpec : SideStretchSpec {
  ContactSide contact = ContactSide::kTop;
  /// Distance of its middle from the track's axis, and height of its contact surface above top of
  /// rail; absent = as usual for the contact side.
  std::optional<double> distance_m;
  std::optional<double> height_m;
  bool has_shield = true;

  bool operator==(const ThirdRailSpec&) const = default;
};

/// A concrete slab in place of ballast; sleepers are set in it.
struct SlabTrackSpec : StretchSpec {
  double width_m = 3.2;

  bool operator==(const SlabTrackSpec&) const = default;
};

/// Structures of which a world may have any number. Each type has its own struct.
using StructureSpec = std::variant<PlatformSpec,
                                   NoiseWallSpec,
                                   FenceSpec,
                                   RetainingWallSpec,
                                   CableTroughSpec,
                                   TunnelSpec,
                                   BridgeSpec,
                                   OverbridgeSpec,
                                   ThirdRailSpec,
                                   SlabTrackSpec,
                                   SignalSpec,
                                   BoardSpec,
                                   BaliseSpec,
                                   DerailerSpec,
                                   RelayBoxSpec,
                                   FurnitureSpec,
                                   BufferStopSpec,
                                   LevelCrossingSpec,
                                   BuildingSpec>;

/// The part that all structures along a stretch have in common; null for any other structure.
[[nodiscard]] inline const StretchSpec* StretchOf(const StructureSpec& structure) {
  return std::visit(
      []<class T>(const T& spec) -> const StretchSpec* {
        if constexpr (std::is_base_of_v<StretchSpec, T>) return &spec;
        return nullptr;
      },
      structure);
}

/// The part that all structures at one place have in common; null for any other structure.
[[nodiscard]] inline const PointSpec* PointOf(const StructureSpec& structure) {
  return std::visit(
      []<class T>(const T& spec) -> const PointSpec* {
        if constexpr (std::is_base_of_v<PointSpec, T>) return &spec;
        return nullptr;
      },
      structure);
}

}  // namespace railcast
