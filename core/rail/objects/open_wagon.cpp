#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/wagon_parts.h"

namespace railcast {
namespace {

constexpr double kOpenWagonPivotDistance_m = kOpenWagonMeasures.pivot_distance_m;
constexpr double kFloor_m = 1.24;

/// Adds doors with their posts, lock bars and stiffeners, and the plain posts in between, on one
/// side.
void AddOpenWagonSide(double side, const RailSurfaces& surfaces, Model& wagon) {
  constexpr double kDoorMiddle_m = 3.2;
  constexpr double kDoorHalfWidth_m = 0.9;
  const auto add = [&](const Vector3& min_m, const Vector3& max_m) {
    MeshOf(surfaces.wagon_body, wagon).Append(MakeSideBlock(side, min_m, max_m));
  };
  add({-6.46, 1.38, 1.20}, {6.46, 1.41, 3.30});  // Sheet.
  add({-6.56, 1.38, 3.22}, {6.56, 1.50, 3.34});  // Top chord.
  for (const double x_m : {-5.3, -1.1, 0.0, 1.1, 5.3}) {
    add({x_m - 0.06, 1.41, 1.0}, {x_m + 0.06, 1.49, 3.22});
  }
  for (const double end : kBothSides) {
    const double corner_m = end * 6.48;
    add({corner_m - 0.08, 1.38, 1.0}, {corner_m + 0.08, 1.50, 3.30});
    const double middle_m = end * kDoorMiddle_m;
    for (const double edge : {-kDoorHalfWidth_m - 0.08, kDoorHalfWidth_m + 0.08}) {
      add({middle_m + edge - 0.07, 1.41, 1.0}, {middle_m + edge + 0.07, 1.50, 3.22});
    }
    add({middle_m - 0.04, 1.41, 1.22}, {middle_m + 0.04, 1.46, 3.20});  // Where the leaves meet.
    for (const double z_m : {1.32, 1.80, 2.30, 2.75}) {
      add({middle_m - kDoorHalfWidth_m, 1.41, z_m},
          {middle_m + kDoorHalfWidth_m, 1.445, z_m + 0.09});
    }
    for (const double bar : {-0.45, 0.45}) {
      const double x_m = middle_m + bar;
      MeshOf(surfaces.wagon_frame, wagon)
          .Append(MakeBar({x_m, side * 1.465, 1.10}, {x_m, side * 1.465, 3.1}, 0.022));
    }
  }
}

void AddOpenWagonEnd(double end, Mesh& body) {
  const auto add = [&](const Vector3& min_m, const Vector3& max_m) {
    body.Append(MakeEndBlock(end, min_m, max_m));
  };
  add({6.40, -1.40, 1.20}, {6.43, 1.40, 3.30});
  add({6.40, -1.40, 3.20}, {6.56, 1.40, 3.34});
  for (const double z_m : {1.45, 2.05, 2.65}) {
    add({6.43, -1.38, z_m}, {6.50, 1.38, z_m + 0.12});
  }
  for (const double y_m : {-0.62, 0.62}) {
    add({6.43, y_m - 0.07, 1.20}, {6.56, y_m + 0.07, 3.20});
  }
}

void AddOpenWagonFrame(Mesh& frame) {
  for (const double side : kBothSides) {
    frame.Append(MakeSideBlock(side, {-6.40, 1.33, 0.98}, {6.40, 1.43, 1.20}));
  }
  for (int i = -3; i <= 3; ++i) {
    const double x_m = 1.0 * i;
    frame.Append(MakeBlock({x_m - 0.05, -1.34, 1.02}, {x_m + 0.05, 1.34, 1.18}));
  }
  frame.Append(MakeCentreSill(6.30, kOpenWagonPivotDistance_m, 1.18));
  frame.Append(MakeCornerSteps(6.0, 1.36, 1.0));
  frame.Append(MakeBrakeGear(kOpenWagonPivotDistance_m));
}

}  // namespace

RailVehicleModel MakeOpenWagon(const RailSurfaces& surfaces) {
  Model wagon{.name = "open_wagon", .parts = {}};
  AddOpenWagonFrame(MeshOf(surfaces.wagon_frame, wagon));
  MeshOf(surfaces.wagon_body, wagon)
      .Append(MakeBlock({-6.40, -1.38, 1.18}, {6.40, 1.38, kFloor_m}));
  for (const double side : kBothSides) {
    AddOpenWagonSide(side, surfaces, wagon);
    AddOpenWagonEnd(side, MeshOf(surfaces.wagon_body, wagon));
  }
  AddDrawAndBufferGear(kOpenWagonMeasures.length_m, surfaces.wagon_frame, wagon);
  return {std::move(wagon), MakeWagonBogie(surfaces)};
}

}  // namespace railcast
