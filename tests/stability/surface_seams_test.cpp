// Beams at the seams of chunks of which one is in its finest form and the other in its coarser one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "railcast/scenario.h"
#include "tests/stability/regime.h"
#include "tests/stability/tunnel.h"
#include "tests/support/ray_cast.h"

namespace railcast {
namespace {

constexpr int kNumChunks = 8;
constexpr std::size_t kLevels[] = {1, 2};

/// A line, and the first of the chunks.
struct Place {
  const char* scenario;
  int home;
};
constexpr Place kDemo{"st_gallen_approach.json", 20};  // In a curve, with two tracks.
/// The seam is in a curve of 190 m, with ground 152 m wide on its inside and 300 m on its outside.
constexpr Place kHills{"hills.json", 10};

Eigen::Affine3d Placed(const Transform& transform) {
  return Eigen::Affine3d(transform.matrix());
}

/// The surfaces of some chunks, every other one in a coarser form, without anything on them.
class Seams {
 public:
  Seams(const Place& place, bool begins_coarse, std::size_t level)
      : home_(place.home),
        world_(MakeWorld(
            ReadScenario(std::string(RAILCAST_SOURCE_DIR "/scenarios/") + place.scenario))) {
    const Transform window_from_world = world_->WorldFromChunk(home_).inverse();
    std::vector<TracePlacement> placements;
    for (int i = 0; i < kNumChunks; ++i) {
      const Chunk chunk = (i % 2 == 0) == begins_coarse
                              ? world_->BuildCoarserChunk(home_ + i, level)
                              : world_->BuildChunk(home_ + i);
      placements.push_back({std::make_shared<TraceModel>(device_, chunk.ground),
                            {Placed(window_from_world * world_->WorldFromChunk(home_ + i))},
                            1});
    }
    scene_ = std::make_unique<TraceScene>(device_, placements);
  }

  /// From 0.5 to 6 m above the track, 10 to 150 m before a seam, at the surface there: half of the
  /// beams at the ballast, half also at the ground beside it, where it is nearly level.
  [[nodiscard]] Ray Aim(std::uint64_t beam) const {
    const auto [u, v, w, t] = Uniforms(beam);
    const double seam_s_m = SeamChainage_m();
    const double d_m = beam % 2 == 0 ? std::lerp(-4.5, 8.5, u) : std::lerp(-12.0, 16.0, u);
    const double height_m = std::lerp(-0.9, -0.1, std::fmod(1e3 * u, 1.0));
    const double along_m = std::lerp(-0.01, 0.01, std::fmod(1e3 * v, 1.0));
    const Transform window_from_world = world_->WorldFromChunk(home_).inverse();
    const auto place = [&](double s_m, double lateral_m, double above_m) -> Vector3 {
      return (window_from_world * world_->alignment().WorldFromTrack(s_m, lateral_m, above_m))
          .translation();
    };
    return RayThrough(place(seam_s_m - std::lerp(10.0, 150.0, v), std::lerp(-2.0, 6.0, w),
                            std::lerp(0.5, 6.0, t)),
                      place(seam_s_m + along_m, d_m, height_m));
  }

  /// From 100 m above a place at the seam downwards, anywhere on wide ground.
  [[nodiscard]] Ray AimDown(std::uint64_t beam) const {
    const auto [u, v, w, t] = Uniforms(beam);
    const double s_m = SeamChainage_m() + std::lerp(-0.002, 0.002, v);
    const double d_m = std::lerp(-299.0, 151.0, u);
    const Vector3 place_m = (world_->WorldFromChunk(home_).inverse() *
                             world_->alignment().WorldFromTrack(s_m, d_m, 0.0))
                                .translation();
    return RayThrough(place_m + Vector3(0, 0, 100.0), place_m);
  }

  template <class Aiming>
  [[nodiscard]] std::size_t CountEscapes(std::uint64_t num_beams, const Aiming& aim) const {
    std::vector<Ray> rays;
    for (std::uint64_t beam = 0; beam < num_beams; ++beam) rays.push_back(aim(beam));
    const std::vector<RayHit> hits = CastRays(*scene_, rays, 1000.0F);
    return static_cast<std::size_t>(
        std::ranges::count_if(hits, [](const RayHit& hit) { return hit.surface == 0; }));
  }

 private:
  [[nodiscard]] double SeamChainage_m() const { return RailWorld::kChunkLength_m * (home_ + 4); }

  int home_;
  std::shared_ptr<const RailWorld> world_;
  TraceDevice device_;
  std::unique_ptr<TraceScene> scene_;
};

TEST(SurfaceSeams, LetNoBeamThroughWhereTheFormOfChunksChanges) {
  RecordRegime("seams between fine and coarse ground", {"-", "none of 800,000 beams escapes"});
  for (const std::size_t level : kLevels) {
    for (const bool begins_coarse : {false, true}) {
      const Seams seams(kDemo, begins_coarse, level);
      EXPECT_EQ(seams.CountEscapes(200'000, [&](std::uint64_t beam) { return seams.Aim(beam); }),
                0U)
          << begins_coarse << ' ' << level;
    }
  }
}

TEST(SurfaceSeams, LetNoBeamThroughWideGroundInATightCurve) {
  for (const std::size_t level : kLevels) {
    for (const bool begins_coarse : {false, true}) {
      const Seams seams(kHills, begins_coarse, level);
      EXPECT_EQ(
          seams.CountEscapes(200'000, [&](std::uint64_t beam) { return seams.AimDown(beam); }), 0U)
          << begins_coarse << ' ' << level;
    }
  }
}

}  // namespace
}  // namespace railcast
