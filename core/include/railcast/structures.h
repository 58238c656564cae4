#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "railcast/enum_names.h"

namespace railcast {

/// A side of a track, seen towards increasing chainage.
enum class TrackSide { kLeft, kRight };
template <>
inline constexpr auto kEnumNames<TrackSide> =
    std::to_array<EnumName<TrackSide>>({{TrackSide::kLeft, "left"}, {TrackSide::kRight, "right"}});

/// +1 for left, -1 for right: the sign of d.
[[nodiscard]] constexpr double SignOf(TrackSide side) {
  return side == TrackSide::kLeft ? 1.0 : -1.0;
}

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
  double height_m = 3.5;            ///< Of its lower side above the platform.
  double column_spacing_m = 8.0;    ///< At most.

  bool operator==(const PlatformRoofSpec&) const = default;
};

/// A platform. Its edge lies in the frame of the track, so that it follows the cant; its top is
/// level across.
struct PlatformSpec : SideStretchSpec {
  double height_m = 0.76;         ///< Of the edge above top of rail.
  double edge_distance_m = 1.65;  ///< Of the edge from the track's axis.
  double width_m = 3.0;
  bool has_edge_strip = true;  ///< Whether a white tactile strip runs along the edge.
  std::optional<PlatformRoofSpec> roof;

  bool operator==(const PlatformSpec&) const = default;
};

/// Structures of which a world may have any number. Each type has its own struct.
using StructureSpec = std::variant<PlatformSpec>;

/// The part that all structures along a stretch have in common.
[[nodiscard]] inline const StretchSpec* StretchOf(const StructureSpec& structure) {
  return std::visit(
      []<class T>(const T& spec) -> const StretchSpec* {
        if constexpr (std::is_base_of_v<StretchSpec, T>) return &spec;
        return nullptr;
      },
      structure);
}

}  // namespace railcast
