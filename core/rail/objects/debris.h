#pragma once

#include <vector>

#include "core/rail/objects/object_surfaces.h"
#include "railcast/objects.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// What falls, blows or is left on the line, up to 5,000 triangles each, always of the same shape.
/// Frame: origin below the middle of the footprint, on the ground; x along the object, y left, z
/// up; metres.

[[nodiscard]] constexpr bool IsDebris(ObjectType type) {
  return type == ObjectType::kPallet || type == ObjectType::kBranch ||
         type == ObjectType::kFallenTree || type == ObjectType::kTyre ||
         type == ObjectType::kBoulder || type == ObjectType::kBallastHeap ||
         type == ObjectType::kLandslide || type == ObjectType::kHangingWire ||
         type == ObjectType::kDragShoe;
}

/// @pre IsDebris(type).
[[nodiscard]] Model MakeDebris(ObjectType type, const DebrisSurfaces& surfaces);

/// A EUR pallet of 1200 x 800 x 144 mm (EN 13698-1): five deck boards, three cross boards, nine
/// blocks and three bottom boards, all 22 mm thick but the blocks of 78 mm.
[[nodiscard]] Model MakePallet(const DebrisSurfaces& surfaces);

/// A tyre 315/70 R 22.5 of a lorry, 1.014 m across (ETRTO), lying on its side.
[[nodiscard]] Model MakeTyre(const DebrisSurfaces& surfaces);

/// A drag shoe (Hemmschuh) on a rail, its tongue forward. Frame: z = 0 is top of rail, x along the
/// rail, y = 0 the middle of the rail head, so that `h_m` = 0 and `d_m` = +-0.753 put it on a rail
/// of 60E1 on standard gauge. 0.65 m long, 0.098 m wide, 0.125 m high (the most that EBO section 42
/// permits); its guides reach 20 mm down beside the head, which is 72 mm wide.
[[nodiscard]] Model MakeDragShoe(const DebrisSurfaces& surfaces);

/// A broken branch with twigs and leaves, 2.5 m long.
[[nodiscard]] Model MakeBranch(const DebrisSurfaces& surfaces);

/// A fallen tree of about 10 m with its root plate, branches and leaves. It lies along y, its top
/// to the left, so that it lies across the track at heading 0.
[[nodiscard]] Model MakeFallenTree(const DebrisSurfaces& surfaces);

/// An irregular, angular boulder, 0.80 m long, 0.68 m wide and 0.56 m high.
[[nodiscard]] Model MakeBoulder(const DebrisSurfaces& surfaces);

/// A cone of ballast stones (31.5 to 63 mm, EN 13450) at its angle of repose, 1.5 m wide.
[[nodiscard]] Model MakeBallastHeap(const DebrisSurfaces& surfaces);

/// Soil and stones of a slip that came from the left: a fan 8 m wide along x and 6 m long along y,
/// 1.2 m high where it comes from, on the left.
[[nodiscard]] Model MakeLandslide(const DebrisSurfaces& surfaces);

inline constexpr double kHangingWireDiameter_m = 0.012;
inline constexpr double kHangingWireTop_m = 5.7;
/// The axis of the wire of MakeHangingWire() from its top to its end, before its footprint is
/// centred.
[[nodiscard]] std::vector<Vector3> HangingWireAxis();

/// A torn contact wire of 12 mm that hangs from kHangingWireTop_m, which is 5.5 m above top of rail
/// if it stands on the sleepers, down to the ground as a catenary, lies there for a stretch along x
/// and ends in coils.
[[nodiscard]] Model MakeHangingWire(const DebrisSurfaces& surfaces);

}  // namespace railcast
