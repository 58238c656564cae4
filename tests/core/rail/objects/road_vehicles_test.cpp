#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "railcast/scenario.h"
#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/shipped_models.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

struct RoadVehicle {
  ObjectType type{};
  Vector3 size_m;          ///< Over everything.
  double body_width_m{};   ///< Without mirrors.
  double tyre_radius_m{};  ///< Of its largest tyre.
  double front_axle_x_m{};
  double wheelbase_m{};
};

// Data sheets as in scenarios/models/README.md; tyres by their names: 205/55 R 16 has 0.055 x 205 x
// 2 / 100
// + 16 inches of diameter.
const std::vector<RoadVehicle> kRoadVehicles = {
    {TypeNamed("car"), {4.284, 2.073, 1.456}, 1.789, 0.316, 1.272, 2.636},
    {TypeNamed("lorry"), {16.5, 2.55, 4.0}, 2.55, 0.536, 6.83, 3.70},
    {TypeNamed("bus"), {12.135, 2.95, 3.12}, 2.55, 0.478, 3.2625, 5.9},
    {TypeNamed("tractor"), {4.150, 2.275, 2.760}, 2.275, 0.783, 1.295, 2.35},
    {TypeNamed("bicycle"), {1.80, 0.60, 1.07}, 0.60, 0.348, 0.552, 1.104},
    {TypeNamed("motorcycle"), {2.080, 0.790, 1.060}, 0.790, 0.312, 0.740, 1.410}};

constexpr double kOfDataSheet_m = 0.02;
constexpr double kVehicleRounding_m = 1e-5;  // Of float32 at 16 m.

class RoadVehicles : public testing::Test {
 protected:
  [[nodiscard]] static Model Make(const RoadVehicle& vehicle) { return WholeModel(vehicle.type); }

  const SurfaceClass tyre_ = SurfaceNamed("black_rubber", "road_vehicle");
  const SurfaceClass reflector_ = SurfaceNamed("retro_sheeting", "road_vehicle");
};

TEST_F(RoadVehicles, HaveTheSizesOfTheirDataSheets) {
  for (const RoadVehicle& vehicle : kRoadVehicles) {
    const Model model = Make(vehicle);
    const Eigen::AlignedBox3d box = model.Bounds();
    EXPECT_LT((box.sizes() - vehicle.size_m).cwiseAbs().maxCoeff(), kOfDataSheet_m)
        << model.name << ": " << box.sizes().transpose();
    EXPECT_LT((box.center().head<2>().norm()), kVehicleRounding_m) << model.name;
    EXPECT_NEAR(box.min().z(), 0.0, kVehicleRounding_m) << model.name;
  }
}

/// Mirrors are the widest parts, and only bodies reach below them.
TEST_F(RoadVehicles, AreAsWideAsTheirDataSheetsSayBelowTheirMirrors) {
  for (const RoadVehicle& vehicle : kRoadVehicles) {
    if (vehicle.type == TypeNamed("bicycle") || vehicle.type == TypeNamed("motorcycle")) continue;
    double half_width_m = 0.0;
    const Model model = Make(vehicle);
    const double mirrors_m = vehicle.type == TypeNamed("car") ? 0.85 : 1.9;
    for (const Part& part : model.parts) {
      for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
        if (static_cast<double>(vertex.z()) > mirrors_m) continue;
        half_width_m = std::max(half_width_m, std::abs(static_cast<double>(vertex.y())));
      }
    }
    EXPECT_NEAR(2.0 * half_width_m, vehicle.body_width_m, kOfDataSheet_m) << model.name;
  }
}

TEST_F(RoadVehicles, StandOnTheirTyresAtTheirWheelbase) {
  for (const RoadVehicle& vehicle : kRoadVehicles) {
    const Model model = Make(vehicle);
    double highest_m = 0.0;
    double front_m = 0.0;
    double rear_m = 0.0;
    for (const Vector3& p : VerticesOf(model, tyre_)) {
      highest_m = std::max(highest_m, p.z());
      if (p.z() > kVehicleRounding_m) continue;
      if (std::abs(p.x() - vehicle.front_axle_x_m) < 0.01) front_m = p.x();
      if (std::abs(p.x() - vehicle.front_axle_x_m + vehicle.wheelbase_m) < 0.01) rear_m = p.x();
    }
    EXPECT_NEAR(front_m - rear_m, vehicle.wheelbase_m, kVehicleRounding_m) << model.name;
    EXPECT_NEAR(highest_m, 2.0 * vehicle.tyre_radius_m, kVehicleRounding_m) << model.name;
  }
}

TEST_F(RoadVehicles, AreClosedBodiesOfAFewThousandTriangles) {
  for (const RoadVehicle& vehicle : kRoadVehicles) {
    const Model model = Make(vehicle);
    EXPECT_GE(model.num_triangles(), 500U) << model.name;
    EXPECT_LE(model.num_triangles(), 5000U) << model.name;
    EXPECT_EQ(CountBadTriangles(model), 0U) << model.name;
    EXPECT_EQ(CountOpenEdges(model), 0U) << model.name;
    for (const Part& part : model.parts) EXPECT_EQ(part.label, tyre_.label);
  }
}

/// Area of the surface's faces that look along `direction` at the model's end there.
double EndArea_m2(const Model& model, const SurfaceClass& surface, const Vector3& direction) {
  constexpr double kDepth_m = 0.001;
  const double end_m = model.Bounds().max().cwiseProduct(direction.cwiseAbs()).sum();
  double area_m2 = 0.0;
  for (const Part& part : model.parts) {
    if (part.material != surface.material) continue;
    for (const auto& [a, b, c] : part.mesh.triangles) {
      const Vector3 pa = part.mesh.vertices[a].cast<double>();
      const Vector3 twice_m2 = (part.mesh.vertices[b].cast<double>() - pa)
                                   .cross(part.mesh.vertices[c].cast<double>() - pa);
      const bool is_at_end = pa.dot(direction) > end_m - kDepth_m;
      if (is_at_end && twice_m2.normalized().dot(direction) > 0.99) {
        area_m2 += 0.5 * twice_m2.norm();
      }
    }
  }
  return area_m2;
}

TEST_F(RoadVehicles, CarryRetroreflectivePlatesOf520By110MillimetresAtBothEnds) {
  for (const Model& model : {WholeModel(TypeNamed("car")), WholeModel(TypeNamed("bus"))}) {
    const double front_m2 = EndArea_m2(model, reflector_, Vector3::UnitX());
    EXPECT_NEAR(front_m2, 0.520 * 0.110, 1e-6) << model.name;
  }
  const double rear_m2 = EndArea_m2(WholeModel(TypeNamed("car")), reflector_, -Vector3::UnitX());
  EXPECT_NEAR(rear_m2, 0.520 * 0.110, 1e-6);
}

TEST_F(RoadVehicles, HaveWindowsAllAroundWhereTheyHaveABody) {
  for (const ObjectType& type : {TypeNamed("car"), TypeNamed("bus"), TypeNamed("tractor")}) {
    const Model model = WholeModel(type);
    Eigen::AlignedBox3d windows;
    for (const Vector3& p : VerticesOf(model, SurfaceNamed("glass", "road_vehicle")))
      windows.extend(p);
    const Vector3 share = windows.sizes().cwiseQuotient(model.Bounds().sizes());
    EXPECT_GT(share.x(), 0.4) << model.name;
    EXPECT_GT(share.y(), 0.6) << model.name;
    EXPECT_GT(share.z(), 0.3) << model.name;
  }
}

constexpr double kFloat32_m = 1e-6;  // Half a unit in the last place at 10 m.

struct Wagon {
  Model model;
  double length_m{};
  double pivot_distance_m{};
};

class RollingStock : public testing::Test {
 protected:
  const SurfaceClass wheel_ = SurfaceNamed("wheel_steel", "wagon");
  const std::vector<Wagon> wagons_ = {{WholeModel(TypeNamed("open_wagon")), 14.04, 9.0},
                                      {WholeModel(TypeNamed("flat_wagon")), 19.74, 14.2},
                                      {WholeModel(TypeNamed("tank_wagon")), 16.0, 10.5}};
};

TEST_F(RollingStock, HasItsLengthOverBuffersInTheMiddleOfTheFrame) {
  for (const Wagon& wagon : wagons_) {
    const Eigen::AlignedBox3d box = wagon.model.Bounds();
    EXPECT_NEAR(box.max().x(), wagon.length_m / 2.0, kFloat32_m) << wagon.model.name;
    EXPECT_NEAR(box.min().x(), -wagon.length_m / 2.0, kFloat32_m) << wagon.model.name;
  }
}

TEST_F(RollingStock, HasWheelsOf920MillimetresWithTheirFlangesBacks1360Apart) {
  double least_m = std::numeric_limits<double>::infinity();
  double highest_tread_m = 0.0;
  for (const Vector3& p : VerticesOf(wagons_[0].model, wheel_)) {
    const bool is_rim = std::abs(p.z() - kWheelRadius_m) > 0.9 * kWheelRadius_m;
    if (is_rim) least_m = std::min(least_m, std::abs(p.y()));
    if (std::abs(std::abs(p.y()) - kTapeCircleDistance_m / 2.0) < kFloat32_m) {
      highest_tread_m = std::max(highest_tread_m, p.z());
    }
  }
  EXPECT_NEAR(2.0 * least_m, 1.360, kFloat32_m);
  EXPECT_NEAR(highest_tread_m, 0.920, kFloat32_m);
}

TEST_F(RollingStock, HasBuffersAtUicHeightAndDistance) {
  for (const Wagon& wagon : wagons_) {
    Eigen::AlignedBox3d left;
    for (const Vector3& p : VerticesOf(wagon.model, SurfaceNamed("rusty_steel", "wagon"))) {
      // Only buffers extend into the last 50 mm of the wagon.
      if (p.x() > wagon.length_m / 2.0 - 0.05 && p.y() > 0.0) left.extend(p);
    }
    EXPECT_NEAR(left.center().y(), 1.750 / 2.0, kFloat32_m) << wagon.model.name;
    EXPECT_NEAR(left.center().z(), 1.060, kFloat32_m) << wagon.model.name;
    EXPECT_NEAR(left.sizes().y(), 0.450, kFloat32_m) << wagon.model.name;
    EXPECT_NEAR(left.sizes().z(), 0.450, kFloat32_m) << wagon.model.name;
  }
}

TEST_F(RollingStock, LeavesTheOpenWagonsHoldEmpty) {
  // 12.8 x 2.76 x 2.10 from the floor, less a millimetre on all sides.
  const Eigen::AlignedBox3d hold(Vector3(-6.399, -1.379, 1.241), Vector3(6.399, 1.379, 3.339));
  Eigen::AlignedBox3d walls;
  for (const Vector3& p : VerticesOf(wagons_[0].model, SurfaceNamed("wagon_paint", "wagon"))) {
    EXPECT_FALSE(hold.contains(p)) << p.transpose();
    walls.extend(p);
  }
  EXPECT_NEAR(walls.sizes().y(), 3.0, kFloat32_m);
  EXPECT_NEAR(walls.max().z(), 1.24 + 2.10, kFloat32_m);
}

TEST_F(RollingStock, CarriesContainersAt1160Millimetres) {
  const std::vector<Vector3> body =
      VerticesOf(wagons_[1].model, SurfaceNamed("wagon_paint", "wagon"));
  const auto num_supports = std::count_if(body.begin(), body.end(), [](const Vector3& p) {
    return std::abs(p.z() - 1.16) < kFloat32_m;
  });
  EXPECT_GE(num_supports, 16 * 4);  // Corners of sixteen supports and of the spigots on them.
  for (const Vector3& p : body) EXPECT_LE(p.z(), 1.26 + kFloat32_m);
}

TEST_F(RollingStock, GivesTheTankItsDiameterAndHeight) {
  Eigen::AlignedBox3d shell;
  for (const Vector3& p : VerticesOf(wagons_[2].model, SurfaceNamed("tank_paint", "wagon"))) {
    if (std::abs(p.x()) > 2.0) shell.extend(p);  // Away from the fittings.
  }
  EXPECT_NEAR(shell.sizes().y(), 2.9, kFloat32_m);
  EXPECT_NEAR(shell.sizes().z(), 2.9, kFloat32_m);
  EXPECT_NEAR(wagons_[2].model.Bounds().max().z(), 4.27, kFloat32_m);
}

}  // namespace
}  // namespace railcast
