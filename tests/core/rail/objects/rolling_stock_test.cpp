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
