#include "core/rail/structures/lineside_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/core/rail/model_checks.h"

namespace railcast {
namespace {

constexpr double kLinesideRounding_m = 1e-6;  // Half a unit in the last place at 10 m.

/// Surfaces that differ from each other.
LinesideSurfaces DistinctSurfaces() {
  LinesideSurfaces surfaces;
  std::uint16_t next = 1;
  for (SurfaceClass* surface :
       {&surfaces.signal_mast,    &surfaces.signal_foot,      &surfaces.signal_screen,
        &surfaces.signal_lamp,    &surfaces.signal_board,     &surfaces.board_face,
        &surfaces.board_steel,    &surfaces.marker_white,     &surfaces.marker_red,
        &surfaces.balise,         &surfaces.relay_box,        &surfaces.relay_foot,
        &surfaces.buffer_frame,   &surfaces.buffer_beam,      &surfaces.buffer_board,
        &surfaces.derailer,       &surfaces.derailer_machine, &surfaces.barrier_white,
        &surfaces.barrier_red,    &surfaces.crossing_steel,   &surfaces.crossing_screen,
        &surfaces.crossing_lamp,  &surfaces.furniture_steel,  &surfaces.furniture_wood,
        &surfaces.furniture_glass}) {
    surface->material = next++;
  }
  return surfaces;
}

class LinesideModels : public testing::Test {
 protected:
  [[nodiscard]] Eigen::AlignedBox3d BoundsOf(const Model& model,
                                             const SurfaceClass& surface) const {
    Eigen::AlignedBox3d box;
    for (const Vector3& vertex : VerticesOf(model, surface)) box.extend(vertex);
    return box;
  }
  const LinesideSurfaces surfaces_ = DistinctSurfaces();
};

TEST_F(LinesideModels, AreMadeOfAsManySoundTrianglesAsTheirDocumentationSays) {
  struct Row {
    Model model;
    std::size_t num_triangles;
  };
  const std::vector<Row> rows = {
      {MakeLinesideModel("main_signal", surfaces_, {.height_m = 5.5}), 232},
      {MakeLinesideModel("distant_signal", surfaces_, {.height_m = 4.5}), 176},
      {MakeLinesideModel("shunting_signal", surfaces_, {.height_m = 0.8}), 208},
      {MakeBoard({0.7, 0.9}, 2.4, surfaces_), 52},
      {MakeTriangularBoard({1.0, 0.85}, 2.4, surfaces_), 44},
      {MakeLinesideModel("fouling_marker", surfaces_, {.height_m = 0.35}), 36},
      {MakeLinesideModel("balise", surfaces_), 12},
      {MakeLinesideModel("relay_box", surfaces_, {1.2, 0.5, 1.25}), 36},
      {MakeLinesideModel("buffer_stop", surfaces_), 252},
      {MakeLinesideModel("derailer", surfaces_), 36},
      {MakeLinesideModel("lamp", surfaces_, {.height_m = 6.0}), 60},
      {MakeLinesideModel("bench", surfaces_), 48},
      {MakeLinesideModel("shelter", surfaces_, {4.0, 1.5, 2.5}), 108},
      {MakeHalfBarrier(3.6, 0.0, surfaces_), 36 + 6 * 12},
      {MakeLinesideModel("crossing_sign", surfaces_), 176}};
  for (const Row& row : rows) {
    EXPECT_EQ(row.model.num_triangles(), row.num_triangles) << row.model.name;
    EXPECT_EQ(CountBadTriangles(row.model), 0U) << row.model.name;
  }
}

TEST_F(LinesideModels, GiveSignalsTheHeightAndTheScreenOfTheirKind) {
  for (const double height_m : {3.5, 6.0}) {
    const Model main = MakeLinesideModel("main_signal", surfaces_, {.height_m = height_m});
    const Eigen::AlignedBox3d screen = BoundsOf(main, surfaces_.signal_screen);
    EXPECT_NEAR(main.Bounds().max().z(), height_m, kLinesideRounding_m);
    EXPECT_NEAR(screen.sizes().y(), 0.80, kLinesideRounding_m);
    EXPECT_NEAR(screen.sizes().z(), 1.40, kLinesideRounding_m);
    EXPECT_LT(screen.max().x(), 0.0) << "It must hang in front of the mast.";
    const Model distant = MakeLinesideModel("distant_signal", surfaces_, {.height_m = height_m});
    EXPECT_NEAR(distant.Bounds().max().z(), height_m, kLinesideRounding_m);
    EXPECT_NEAR(BoundsOf(distant, surfaces_.signal_board).sizes().y(), 0.45, kLinesideRounding_m);
    EXPECT_NEAR(BoundsOf(distant, surfaces_.signal_board).sizes().z(), 0.90, kLinesideRounding_m);
  }
  const Model low = MakeLinesideModel("shunting_signal", surfaces_, {.height_m = 0.8});
  EXPECT_NEAR(low.Bounds().max().z(), 0.8, kLinesideRounding_m);
  EXPECT_NEAR(low.Bounds().sizes().y(), 0.50, kLinesideRounding_m);
}

TEST_F(LinesideModels, PutTheLampsIntoTheScreenInFrontOfEverythingElse) {
  for (const Model& signal : {MakeLinesideModel("main_signal", surfaces_, {.height_m = 5.5}),
                              MakeLinesideModel("distant_signal", surfaces_, {.height_m = 4.5}),
                              MakeLinesideModel("shunting_signal", surfaces_, {.height_m = 0.8})}) {
    const Eigen::AlignedBox3d lamps = BoundsOf(signal, surfaces_.signal_lamp);
    const Eigen::AlignedBox3d screen = BoundsOf(signal, surfaces_.signal_screen);
    EXPECT_NEAR(lamps.min().x(), signal.Bounds().min().x(), kLinesideRounding_m) << signal.name;
    EXPECT_GT(lamps.min().z(), screen.min().z()) << signal.name;
    EXPECT_LT(lamps.max().z(), screen.max().z()) << signal.name;
  }
}

TEST_F(LinesideModels, GiveBoardsTheSizeAskedForAndRetroreflectInFrontOnly) {
  for (const Model& board :
       {MakeBoard({0.7, 0.9}, 2.4, surfaces_), MakeTriangularBoard({0.7, 0.9}, 2.4, surfaces_)}) {
    const Eigen::AlignedBox3d face = BoundsOf(board, surfaces_.board_face);
    EXPECT_NEAR(face.sizes().y(), 0.7, kLinesideRounding_m);
    EXPECT_NEAR(face.sizes().z(), 0.9, kLinesideRounding_m);
    EXPECT_NEAR(face.max().z(), 2.4, kLinesideRounding_m);
    EXPECT_NEAR(face.min().x(), board.Bounds().min().x(), kLinesideRounding_m);
    EXPECT_LE(face.max().x(),
              BoundsOf(board, surfaces_.board_steel).min().x() + kLinesideRounding_m);
  }
  EXPECT_NEAR(MakeLinesideModel("fouling_marker", surfaces_, {.height_m = 0.35}).Bounds().max().z(),
              0.35, kLinesideRounding_m);
}

TEST_F(LinesideModels, GiveTheBaliseTheNormsSize) {
  const Eigen::AlignedBox3d box = MakeLinesideModel("balise", surfaces_).Bounds();
  EXPECT_TRUE(box.sizes().isApprox(Vector3(0.358, 0.488, 0.050), kLinesideRounding_m));
  EXPECT_NEAR(box.min().z(), 0.0, kLinesideRounding_m);
}

TEST_F(LinesideModels, GiveTheRelayBoxTheSizeAskedFor) {
  const Model box = MakeLinesideModel("relay_box", surfaces_, {1.2, 0.5, 1.25});
  EXPECT_NEAR(box.Bounds().sizes().x(), 1.2, kLinesideRounding_m);
  EXPECT_NEAR(box.Bounds().sizes().y(), 0.5, kLinesideRounding_m);
  EXPECT_NEAR(box.Bounds().max().z(), 1.25, kLinesideRounding_m);
  EXPECT_NEAR(BoundsOf(box, surfaces_.relay_box).min().z(), 0.15, kLinesideRounding_m);
}

TEST_F(LinesideModels, MeetWagonsAtTheBufferStopWithBuffersAtUicHeightAndDistance) {
  const Model stop = MakeLinesideModel("buffer_stop", surfaces_);
  Eigen::AlignedBox3d left;
  for (const Vector3& p : VerticesOf(stop, surfaces_.buffer_frame)) {
    if (p.x() < 0.05 && p.y() > 0.0) left.extend(p);
  }
  EXPECT_NEAR(left.min().x(), 0.0, kLinesideRounding_m);
  EXPECT_NEAR(left.center().y(), 1.750 / 2.0, kLinesideRounding_m);
  EXPECT_NEAR(left.center().z(), 1.060, kLinesideRounding_m);
  EXPECT_NEAR(left.sizes().z(), 0.450, kLinesideRounding_m);
  const Eigen::AlignedBox3d box = stop.Bounds();
  EXPECT_NEAR(box.max().x(), kBufferStopLength_m, kLinesideRounding_m);
  EXPECT_NEAR(box.sizes().y(), 2.5, kLinesideRounding_m);
  EXPECT_NEAR(box.max().z(), 1.60, kLinesideRounding_m);
  EXPECT_NEAR(box.min().z(), 0.0, kLinesideRounding_m) << "It must stand on the rails.";
}

TEST_F(LinesideModels, GiveFurnitureItsHeightAboveTheGround) {
  EXPECT_NEAR(MakeLinesideModel("lamp", surfaces_, {.height_m = 6.0}).Bounds().max().z(), 6.0,
              kLinesideRounding_m);
  EXPECT_NEAR(MakeLinesideModel("lamp", surfaces_, {.height_m = 6.0}).Bounds().min().y(), -1.0,
              kLinesideRounding_m);
  const Eigen::AlignedBox3d bench = MakeLinesideModel("bench", surfaces_).Bounds();
  EXPECT_NEAR(bench.sizes().x(), 1.80, kLinesideRounding_m);
  EXPECT_NEAR(bench.sizes().y(), 0.55, kLinesideRounding_m);
  EXPECT_NEAR(bench.max().z(), 0.80, kLinesideRounding_m);
  const Model shelter = MakeLinesideModel("shelter", surfaces_, {4.0, 1.5, 2.5});
  EXPECT_NEAR(shelter.Bounds().sizes().x(), 4.0, kLinesideRounding_m);
  EXPECT_NEAR(shelter.Bounds().sizes().y(), 1.5, kLinesideRounding_m);
  EXPECT_NEAR(shelter.Bounds().max().z(), 2.5, kLinesideRounding_m);
  for (const Vector3& p : VerticesOf(shelter, surfaces_.furniture_glass)) {
    EXPECT_GT(p.y(), -0.70) << "Its front must be open.";
  }
}

TEST_F(LinesideModels, CloseTheRoadWithTheBarriersBoomAndOpenItUpwards) {
  const auto stripes = [&](double angle_rad) {
    const Model barrier = MakeHalfBarrier(3.6, angle_rad, surfaces_);
    Eigen::AlignedBox3d box = BoundsOf(barrier, surfaces_.barrier_red);
    return box.merged(BoundsOf(barrier, surfaces_.barrier_white));
  };
  const Eigen::AlignedBox3d closed = stripes(0.0);
  EXPECT_NEAR(closed.min().x(), 0.0, kLinesideRounding_m);
  EXPECT_NEAR(closed.max().x(), 3.6, kLinesideRounding_m);
  EXPECT_NEAR(closed.center().z(), 0.95, kLinesideRounding_m);
  const Eigen::AlignedBox3d open = stripes(0.5 * std::numbers::pi);
  EXPECT_NEAR(open.max().z(), 0.95 + 3.6, kLinesideRounding_m);
  EXPECT_LT(open.max().x(), 0.1);
  const Eigen::AlignedBox3d half = stripes(std::numbers::pi / 6.0);
  EXPECT_NEAR(half.max().z(), 0.95 + 3.6 * 0.5, 0.06);  // Half the boom's height.
}

TEST_F(LinesideModels, CrossTheBeamsOfStAndrewsAboveTheLamps) {
  const Model sign = MakeLinesideModel("crossing_sign", surfaces_);
  const Eigen::AlignedBox3d cross = BoundsOf(sign, surfaces_.barrier_white);
  EXPECT_NEAR(cross.center().z(), 3.25, kLinesideRounding_m);
  // A beam of 1.20 x 0.15 m at 55 degrees.
  EXPECT_NEAR(cross.sizes().z(), 1.20 * std::sin(0.96) + 0.15 * std::cos(0.96), 1e-4);
  EXPECT_NEAR(cross.sizes().y(), 1.20 * std::cos(0.96) + 0.15 * std::sin(0.96), 1e-4);
  EXPECT_LT(BoundsOf(sign, surfaces_.crossing_lamp).max().z(), cross.min().z());
}

}  // namespace
}  // namespace railcast
