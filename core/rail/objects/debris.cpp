#include "core/rail/objects/debris.h"

#include "core/base/error.h"

namespace railcast {

Model MakeDebris(ObjectType type, const DebrisSurfaces& surfaces) {
  switch (type) {
    case ObjectType::kPallet:
      return MakePallet(surfaces);
    case ObjectType::kBranch:
      return MakeBranch(surfaces);
    case ObjectType::kFallenTree:
      return MakeFallenTree(surfaces);
    case ObjectType::kTyre:
      return MakeTyre(surfaces);
    case ObjectType::kBoulder:
      return MakeBoulder(surfaces);
    case ObjectType::kBallastHeap:
      return MakeBallastHeap(surfaces);
    case ObjectType::kLandslide:
      return MakeLandslide(surfaces);
    case ObjectType::kHangingWire:
      return MakeHangingWire(surfaces);
    default:
      break;
  }
  Check(type == ObjectType::kDragShoe, "debris has a model");
  return MakeDragShoe(surfaces);
}

}  // namespace railcast
