#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

#include "core/trace/trace_scene.h"
#include "railcast/lidar.h"
#include "tests/support/analytic_meshes.h"

namespace railcast {
namespace {

constexpr float kFanRange_m = 50.0F;
constexpr std::uint32_t kNumSteps = 3;
constexpr std::uint32_t kFirstSurface = 5;

/// Piece 0, a ball, crosses the fan below at 15 m; piece 1, a small ball and a box, turns beside
/// it.
Eigen::Affine3d PlaceOf(std::size_t piece, std::uint32_t step) {
  const auto k = static_cast<double>(step);
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  place.translate(Eigen::Vector3d(15.0 + 0.1 * k * k, piece == 0 ? -2.0 + k : 3.0 - k, 0.0));
  place.rotate(Eigen::AngleAxisd(0.1 * k, Eigen::Vector3d::UnitZ()));
  return place;
}

/// The same thing as a figure and, in every pose from the start, as two placements.
class BothWays {
 public:
  BothWays() {
    Mesh ball;
    ball.Append(MakeSphere(1.0, 24, 24), Transform::Identity());
    Mesh small;
    small.Append(MakeSphere(0.4, 24, 24), Transform::Identity());
    const std::vector<TracePiece> pieces = {
        {std::make_shared<TraceModel>(device_, Model{"ball", {{ball, 1, 1}}}, true), 0},
        {std::make_shared<TraceModel>(device_, Model{"pair", {{small, 1, 1}, {ball, 1, 2}}}, true),
         1}};
    std::vector<TracePlacement> placements;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      placements.push_back({pieces[i].model, {}, kFirstSurface + pieces[i].first_surface});
      for (std::uint32_t step = 0; step < kNumSteps; ++step) {
        placements.back().window_from_model.push_back(PlaceOf(i, step));
      }
    }
    placed_ = std::make_unique<TraceScene>(device_, placements);
    TraceFigures figures;
    figures.figures.push_back(
        {.pieces = std::make_shared<const std::vector<TracePiece>>(pieces),
         .window_box_m = {Eigen::Vector3f(13, -4, -1), Eigen::Vector3f(17, 5, 1)},
         .num_steps = kNumSteps,
         .first_surface = kFirstSurface});
    figures.window_from_pieces = [this](std::size_t, std::uint32_t step, std::uint32_t num_steps) {
      EXPECT_EQ(num_steps, kNumSteps);
      ++num_posed_;
      return std::vector{PlaceOf(0, step), PlaceOf(1, step)};
    };
    posed_ =
        std::make_unique<TraceScene>(device_, std::vector<TracePlacement>(), std::move(figures));
  }

  [[nodiscard]] const TraceScene& placed() const { return *placed_; }
  [[nodiscard]] const TraceScene& posed() const { return *posed_; }
  [[nodiscard]] int num_posed() const { return num_posed_; }

 private:
  TraceDevice device_;
  std::atomic<int> num_posed_ = 0;
  std::unique_ptr<TraceScene> placed_;
  std::unique_ptr<TraceScene> posed_;
};

/// Rays to the left and right at various times, `rise` upwards.
RayTile Fan(float rise = 0.01F, float shutter_end = 1.0F) {
  RayTile rays{};
  rays.num_rays = kTileSize;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const float share = (static_cast<float>(i) + 0.5F) / kTileSize;
    const Eigen::Vector3f ray = Eigen::Vector3f(1.0F, 0.8F * (share - 0.5F), rise).normalized();
    rays.direction_x[i] = ray.x();
    rays.direction_y[i] = ray.y();
    rays.direction_z[i] = ray.z();
    rays.shutter[i] = shutter_end * static_cast<float>(i % 16) / 15.0F;
    rays.range_m[i] = kFanRange_m;
  }
  return rays;
}

Eigen::Vector3f NormalOf(const RayTile& rays, std::size_t i) {
  return Eigen::Vector3f(rays.normal_x[i], rays.normal_y[i], rays.normal_z[i]).normalized();
}

TEST(PosedFigures, AreHitAsTheSamePiecesPlacedFromTheStart) {
  const BothWays both;
  RayTile placed = Fan();
  RayTile posed = Fan();
  both.placed().Cast(placed);
  both.posed().Cast(posed);
  int num_hits = 0;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    ASSERT_EQ(posed.surface[i], placed.surface[i]) << i;
    ASSERT_NEAR(posed.range_m[i], placed.range_m[i], 1e-4F) << i;
    if (placed.surface[i] == 0) continue;
    ++num_hits;
    // The placed pieces' normals turn from the first pose straight to the last one: by less than
    // (0.2 rad)^2 / 8.
    ASSERT_GT(NormalOf(posed, i).dot(NormalOf(placed, i)), std::cos(0.01F)) << i;
  }
  EXPECT_GT(num_hits, 40);
}

TEST(PosedFigures, HaveTheSameRangesWhereOnlyRangesAreWanted) {
  const BothWays both;
  RayTile hits = Fan();
  RayTile ranges = Fan();
  both.posed().Cast(hits);
  both.posed().CastRanges(ranges);
  EXPECT_TRUE(std::equal(ranges.range_m, ranges.range_m + kTileSize, hits.range_m));
}

TEST(PosedFigures, AreGoneThroughAsOnePlacement) {
  const BothWays both;
  const RayTile rays = Fan();
  std::vector<PlacementHits> placed;
  std::vector<PlacementHits> posed;
  int num_hits = 0;
  for (std::size_t first = 0; first < kTileSize; first += kPacketSize) {
    both.placed().CastThrough(rays, first, placed);
    both.posed().CastThrough(rays, first, posed);
    std::uint32_t lanes = 0;
    for (const PlacementHits& hit : placed) lanes |= hit.lanes;
    ASSERT_EQ(posed.size(), lanes == 0 ? 0U : 1U);
    if (lanes == 0) continue;
    ++num_hits;
    EXPECT_EQ(posed.front().placement, 0U);
    EXPECT_EQ(posed.front().lanes, lanes);
  }
  EXPECT_GT(num_hits, 4);
}

TEST(PosedFigures, AreTheSameForBeamsToTheBit) {
  const BothWays both;
  // Towards the ball's edge, which a part of the sub-rays misses.
  constexpr float kHalfWidth_rad = 0.02F;
  const Eigen::Vector3f axis = Eigen::Vector3f(15.0F, -2.4F, 0.0F).normalized();
  const Eigen::Vector3f across = kHalfWidth_rad * Eigen::Vector3f::UnitZ().cross(axis);
  const Eigen::Vector3f upwards = kHalfWidth_rad * Eigen::Vector3f::UnitZ();
  BeamRays placed{};
  placed.shutter = 0.3F;
  Eigen::Map<Eigen::Vector3f>(placed.axis) = axis;
  Eigen::Map<Eigen::Vector3f>(placed.half_h) = across;
  Eigen::Map<Eigen::Vector3f>(placed.half_v) = upwards;
  for (std::size_t i = 0; i < kNumSubRays; ++i) {
    const auto k = static_cast<float>(i);
    const float radius = 0.99F * std::sqrt((k + 0.5F) / kNumSubRays);
    const Eigen::Vector3f ray =
        (axis + radius * (std::cos(k) * across + std::sin(k) * upwards)).normalized();
    placed.direction_x[i] = ray.x();
    placed.direction_y[i] = ray.y();
    placed.direction_z[i] = ray.z();
    placed.range_m[i] = kFanRange_m;
  }
  BeamRays posed = placed;
  both.placed().CastBeam(placed);
  both.posed().CastBeam(posed);
  EXPECT_LT(*std::min_element(placed.range_m, placed.range_m + kNumSubRays), 20.0F);
  EXPECT_EQ(*std::max_element(placed.range_m, placed.range_m + kNumSubRays), kFanRange_m);
  EXPECT_TRUE(std::equal(posed.range_m, posed.range_m + kNumSubRays, placed.range_m));
}

TEST(PosedFigures, ArePosedOnlyWhenARayComesNearThemAndOnlyOnce) {
  const BothWays both;
  RayTile above = Fan(0.5F);
  both.posed().Cast(above);
  EXPECT_EQ(both.num_posed(), 0);
  for (int turn = 0; turn < 2; ++turn) {
    RayTile early = Fan(0.01F, 0.4F);
    both.posed().Cast(early);
    EXPECT_EQ(both.num_posed(), 2) << "the first two of three poses";
  }
  RayTile all = Fan();
  both.posed().Cast(all);
  EXPECT_EQ(both.num_posed(), 3);
}

}  // namespace
}  // namespace railcast
