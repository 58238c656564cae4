
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/rail/objects/mesh_object.h"
#include "railcast/scenario.h"
#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/shipped_models.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

constexpr double kRounding_m = 1e-6;  // Half a unit in the last place of float32 at 10 m.

/// What the data sheets say (docs/things.md).
struct DataSheet {
  ObjectType type{};
  RailVehicleMeasures measures;
  double axle_base_m{};
  double wheel_radius_m{};
  std::string label;
};

const std::vector<DataSheet>& DataSheets() {
  static const std::vector<DataSheet> sheets = {
      {TypeNamed("open_wagon"), {14.04, 9.0, 3.0, 3.34}, 1.8, 0.46, "wagon"},
      {TypeNamed("flat_wagon"), {19.74, 14.2, 2.6, 1.285}, 1.8, 0.46, "wagon"},
      {TypeNamed("tank_wagon"), {16.0, 10.5, 3.1, 4.27}, 1.8, 0.46, "wagon"},
      {TypeNamed("container_wagon"), {19.74, 14.2, 2.6, 1.16 + 2.591}, 1.8, 0.46, "wagon"},
      {TypeNamed("covered_wagon"), {23.264, 17.7, 2.9, 4.28}, 1.8, 0.46, "wagon"},
      {TypeNamed("hopper_wagon"), {13.5, 7.2, 3.068, 3.996}, 1.8, 0.46, "wagon"},
      {TypeNamed("shunting_locomotive"), {14.32, 7.0, 3.115, 4.25}, 2.5, 0.55, "train"},
      {TypeNamed("electric_locomotive"), {18.98, 9.5, 3.012, 5.5}, 3.0, 0.625, "train"},
      {TypeNamed("multiple_unit"), {25.835, 17.375, 2.95, 3.89}, 2.5, 0.46, "train"},
      {TypeNamed("coach"), {26.4, 19.0, 2.825, 4.05}, 2.5, 0.46, "train"},
      {TypeNamed("metro_car"), {37.15 / 2.0, 12.0, 2.9, 3.55}, 2.1, 0.45, "train"}};
  return sheets;
}

class RailVehicles : public testing::TestWithParam<DataSheet> {
 protected:
  const DataSheet& sheet_ = GetParam();
  const std::vector<Model> pieces_ = PiecesOfModel(sheet_.type);
  const Model& body_ = pieces_.at(0);
  const Model& bogie_ = pieces_.at(1);
  const Model whole_ = WholeModel(sheet_.type);
  const SurfaceClass wheel_ = SurfaceNamed("wheel_steel", sheet_.label);
};

INSTANTIATE_TEST_SUITE_P(Types,
                         RailVehicles,
                         testing::ValuesIn(DataSheets()),
                         [](const auto& type) { return std::string(NameOf(type.param.type)); });

TEST_P(RailVehicles, HaveTheMeasuresOfTheirDataSheets) {
  const RailVehicleMeasures measures = MeasuresOf(sheet_.type);
  EXPECT_DOUBLE_EQ(measures.length_m, sheet_.measures.length_m);
  EXPECT_DOUBLE_EQ(measures.pivot_distance_m, sheet_.measures.pivot_distance_m);
  EXPECT_DOUBLE_EQ(measures.width_m, sheet_.measures.width_m);
  EXPECT_DOUBLE_EQ(measures.height_m, sheet_.measures.height_m);
}

TEST_P(RailVehicles, AreAsLongWideAndHighAsTheirDataSheetsSay) {
  constexpr double kTolerance_m = 0.02;
  const Eigen::AlignedBox3d box = whole_.Bounds();
  EXPECT_NEAR(box.sizes().x(), sheet_.measures.length_m, kTolerance_m);
  EXPECT_NEAR(box.sizes().y(), sheet_.measures.width_m, kTolerance_m);
  EXPECT_NEAR(box.max().z(), sheet_.measures.height_m, kTolerance_m);
  EXPECT_NEAR(box.center().x(), 0.0, kTolerance_m / 2.0);
  EXPECT_NEAR(box.center().y(), 0.0, kTolerance_m / 2.0);
}

TEST_P(RailVehicles, StandOnTheRailsWithAllEightWheels) {
  std::map<int, int> num_contacts_by_x_mm;
  for (const Vector3& p : VerticesOf(whole_, wheel_)) {
    const bool is_on_tape_circle =
        std::abs(std::abs(p.y()) - kTapeCircleDistance_m / 2.0) < kRounding_m;
    if (is_on_tape_circle && std::abs(p.z()) < kRounding_m) {
      ++num_contacts_by_x_mm[static_cast<int>(std::lround(1e3 * p.x()))];
    }
  }
  std::map<int, int> expected;
  for (const double end : kBothSides) {
    for (const double axle : kBothSides) {
      const double x_m =
          end * sheet_.measures.pivot_distance_m / 2.0 + axle * sheet_.axle_base_m / 2.0;
      expected[static_cast<int>(std::lround(1e3 * x_m))] = 2;
    }
  }
  EXPECT_EQ(num_contacts_by_x_mm, expected);
}

TEST_P(RailVehicles, HaveWheelsOfTheirDataSheets) {
  double highest_m = 0.0;
  for (const Vector3& p : VerticesOf(whole_, wheel_)) {
    if (std::abs(std::abs(p.y()) - kTapeCircleDistance_m / 2.0) < kRounding_m) {
      highest_m = std::max(highest_m, p.z());
    }
  }
  EXPECT_NEAR(highest_m, 2.0 * sheet_.wheel_radius_m, kRounding_m);
}

TEST_P(RailVehicles, HaveNothingButFlangesBelowTopOfRail) {
  for (const Part& part : whole_.parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      const Vector3 p = vertex.cast<double>();
      if (p.z() > -kRounding_m) continue;
      EXPECT_EQ(part.material, wheel_.material);
      EXPECT_GE(p.z(), -kFlangeHeight_m - kRounding_m);
      EXPECT_LT(std::abs(p.y()), 1.435 / 2.0) << "beside the rail's head";
      EXPECT_GE(std::abs(p.y()), kFlangeBackDistance_m / 2.0 - kRounding_m);
    }
  }
}

/// Half the width of the reference profile of gauge G1, above 400 mm (EN 15273-2, Annex C).
double HalfWidthOfG1_m(double z_m) {
  constexpr std::array<std::pair<double, double>, 5> kProfile_m = {
      {{0.0, 1.645}, {3.25, 1.645}, {3.70, 1.425}, {4.01, 1.12}, {4.31, 0.525}}};
  for (std::size_t i = 0; i + 1 < kProfile_m.size(); ++i) {
    const auto& [z0, y0] = kProfile_m[i];
    const auto& [z1, y1] = kProfile_m[i + 1];
    if (z_m <= z1) return y0 + (y1 - y0) * (z_m - z0) / (z1 - z0);
  }
  return 0.0;
}

TEST_P(RailVehicles, KeepWithinGaugeG1ExceptForPantographs) {
  for (const Part& part : whole_.parts) {
    if (part.material == SurfaceNamed("galvanised_steel", "train").material &&
        sheet_.type == TypeNamed("electric_locomotive")) {
      continue;
    }
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      const Vector3 p = vertex.cast<double>();
      ASSERT_LE(std::abs(p.y()), HalfWidthOfG1_m(p.z()))
          << p.transpose() << ", material " << part.material;
      ASSERT_LE(std::abs(p.y()), 3.15 / 2.0) << p.transpose();
    }
  }
}

TEST_P(RailVehicles, AreMadeOfFewAndSoundTrianglesWithTheirLabel) {
  EXPECT_GE(whole_.num_triangles(), 2000U);
  EXPECT_LE(whole_.num_triangles(), 9500U);
  EXPECT_EQ(CountBadTriangles(whole_), 0U);
  for (const Part& part : whole_.parts) {
    EXPECT_EQ(part.label, RailLabels().Id(sheet_.label));
    EXPECT_FALSE(part.mesh.triangles.empty());
  }
}

TEST_P(RailVehicles, AreMadeOfClosedBodies) {
  EXPECT_EQ(CountOpenEdges(body_), 0U);
  // The side frames of wagon bogies have three corners on one line, where a triangle without area
  // is left out.
  if (sheet_.label == "train") {
    EXPECT_EQ(CountOpenEdges(bogie_), 0U);
  }
}

TEST_P(RailVehicles, AreWholeWithOneBodyAndTwoBogies) {
  EXPECT_EQ(whole_.num_triangles(), body_.num_triangles() + 2 * bogie_.num_triangles());
  const Eigen::AlignedBox3d bogie = bogie_.Bounds();
  const double reach_m = sheet_.axle_base_m / 2.0 + sheet_.wheel_radius_m + kFlangeHeight_m;
  EXPECT_GE(bogie.max().x(), reach_m - kRounding_m) << "with its wheels";
  EXPECT_LT(bogie.max().x(), reach_m + 0.3) << "about its pivot";
  EXPECT_LT(-bogie.min().x(), reach_m + 0.3);
  EXPECT_GT(body_.Bounds().min().z(), 0.1) << "without wheels";
}

TEST(TrainVehicles, HaveWindowsOfGlass) {
  for (const DataSheet& sheet : DataSheets()) {
    const auto glass = VerticesOf(WholeModel(sheet.type), SurfaceNamed("glass", "train"));
    EXPECT_EQ(glass.empty(), sheet.label == "wagon") << NameOf(sheet.type);
    for (const Vector3& p : glass) EXPECT_GT(p.z(), 1.0) << NameOf(sheet.type);
  }
}

TEST(TrainVehicles, RecessTheWindowsOfTheCoachBy2CentimetresInItsWalls) {
  double outermost_m = 0.0;
  for (const Vector3& p :
       VerticesOf(WholeModel(TypeNamed("coach")), SurfaceNamed("glass", "train"))) {
    if (std::abs(p.x()) < 9.5) outermost_m = std::max(outermost_m, std::abs(p.y()));
  }
  EXPECT_NEAR(outermost_m, 2.825 / 2.0 - 0.02, kRounding_m);
}

TEST(TrainVehicles, RaiseOnePantographOfTheElectricLocomotiveToTheContactWire) {
  constexpr double kContactWire_m = 5.5;      // The default of CatenarySpec.
  constexpr double kLowered_m = 4.248;        // The locomotive's height with both lowered.
  constexpr double kHalfHeadWidth_m = 0.975;  // Heads of 1950 mm.
  double widest_m = 0.0;
  std::map<bool, double> highest_m;
  const Model locomotive = WholeModel(TypeNamed("electric_locomotive"));
  for (const Vector3& p : VerticesOf(locomotive, SurfaceNamed("galvanised_steel", "train"))) {
    highest_m[p.x() > 0.0] = std::max(highest_m[p.x() > 0.0], p.z());
    widest_m = std::max(widest_m, std::abs(p.y()));
  }
  EXPECT_NEAR(highest_m[false], kContactWire_m, kRounding_m);
  EXPECT_NEAR(highest_m[true], kLowered_m, kRounding_m);
  EXPECT_NEAR(widest_m, kHalfHeadWidth_m, 0.02);
}

TEST(TrainVehicles, StandContainersOfTheirIsoSizesOnTheSupports) {
  const Model wagon = WholeModel(TypeNamed("container_wagon"));
  for (const auto& [surface, length_m] : {std::pair(SurfaceNamed("red_paint", "wagon"), 12.192),
                                          std::pair(SurfaceNamed("white_paint", "wagon"), 6.058)}) {
    Eigen::AlignedBox3d box;
    for (const Vector3& p : VerticesOf(wagon, surface)) box.extend(p);
    EXPECT_NEAR(box.sizes().x(), length_m, kRounding_m);
    EXPECT_NEAR(box.sizes().y(), 2.438, kRounding_m);
    EXPECT_NEAR(box.sizes().z(), 2.591, kRounding_m);
    EXPECT_NEAR(box.min().z(), 1.16, kRounding_m);
  }
}

TEST(TrainVehicles, LeaveTheHopperOpenAtTheTop) {
  for (const Part& part : WholeModel(TypeNamed("hopper_wagon")).parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      const Vector3 p = vertex.cast<double>();
      const bool is_in_opening = std::abs(p.x()) < 11.94 / 2.0 - 1e-3 && p.z() > 3.5 &&
                                 std::abs(p.y()) < 1.94 / 2.0 - 1e-3;
      ASSERT_FALSE(is_in_opening) << p.transpose();
    }
  }
}

TEST(MayHaveMaterial, KnowsThePartsOfShippedModels) {
  EXPECT_TRUE(MayHaveMaterial(TypeNamed("coach"), "glass"));
  EXPECT_FALSE(MayHaveMaterial(TypeNamed("open_wagon"), "glass"));
  EXPECT_FALSE(MayHaveMaterial(ObjectType::kBox, "glass"));
  EXPECT_TRUE(MayHaveMaterial(ObjectType::kMesh, "glass")) << "by a word in its file";
}

}  // namespace
}  // namespace railcast
