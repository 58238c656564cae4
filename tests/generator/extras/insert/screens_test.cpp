#include "generator/extras/insert/screens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace railcast {
namespace {

constexpr float kFar_m = 300.0F;

// A beam whose sub-rays have met nothing, but for the first ones, which have met surface 1.
BeamRays BeamWithHits(std::size_t num_hits, float range_m) {
  BeamRays beam{};
  beam.axis[0] = 1.0F;
  std::fill_n(beam.range_m, kNumSubRays, kFar_m);
  beam.facets[1] = {1, 1.0F, 0.0F, 0.0F};
  beam.num_facets = 2;
  for (std::size_t i = 0; i < num_hits; ++i) {
    beam.range_m[i] = range_m;
    beam.facet[i] = 1;
  }
  return beam;
}

std::size_t NumOn(const BeamRays& beam, std::uint32_t surface) {
  return static_cast<std::size_t>(
      std::count_if(beam.facet, beam.facet + beam.num_rays,
                    [&](std::uint32_t facet) { return beam.facets[facet].surface == surface; }));
}

TEST(Screens, DivideABeamInProportionToTheIntensities) {
  const std::vector<Screen> screens = {{.range_m = 10.0F, .intensity = 0.3F, .surface = 7},
                                       {.range_m = 20.0F, .intensity = 0.1F, .surface = 8}};
  const Screens all({0, 2}, screens);
  BeamRays beam = BeamWithHits(0, 0.0F);
  all.Meet(0, beam);
  EXPECT_EQ(NumOn(beam, 7), 48U);
  EXPECT_EQ(NumOn(beam, 8), 16U);
  EXPECT_EQ(all.met(0), 0U);
}

TEST(Screens, GiveTheWeakestReturnASixteenth) {
  const std::vector<Screen> screens = {{.range_m = 10.0F, .intensity = 5.0F},
                                       {.range_m = 20.0F, .intensity = 0.001F}};
  const ScreenParts parts = PartsOf(screens);
  EXPECT_EQ(parts[0], 15U);
  EXPECT_EQ(parts[1], 1U);
}

TEST(Screens, LeaveFreeWhatTheReturnDidNotTake) {
  const Screens all({0, 1}, {{.range_m = 10.0F, .intensity = 0.1F, .share = 0.25F, .surface = 7}});
  BeamRays beam = BeamWithHits(0, 0.0F);
  all.Meet(0, beam);
  EXPECT_EQ(NumOn(beam, 7), 16U);
  EXPECT_EQ(NumOn(beam, 0), 48U);
}

TEST(Screens, HideWhatIsFartherAndAreHiddenByWhatIsNearer) {
  const Screens all({0, 1, 2}, {{.range_m = 10.0F, .intensity = 0.1F, .surface = 7},
                                {.range_m = 10.0F, .intensity = 0.1F, .surface = 8}});
  BeamRays before = BeamWithHits(20, 9.0F);
  all.Meet(0, before);
  EXPECT_EQ(NumOn(before, 1), 20U);
  EXPECT_EQ(NumOn(before, 7), 44U);
  EXPECT_EQ(all.met(0), 1U);
  BeamRays behind = BeamWithHits(20, 11.0F);
  all.Meet(1, behind);
  EXPECT_EQ(NumOn(behind, 8), 64U);
  EXPECT_EQ(all.met(1), 0U);
}

TEST(Screens, LetThingsWithinTheNoiseStandBeforeThem) {
  const Screens all({0, 1}, {{.range_m = 10.0F, .intensity = 0.1F, .back_m = 0.04F, .surface = 7}});
  BeamRays beam = BeamWithHits(20, 10.03F);
  all.Meet(0, beam);
  EXPECT_EQ(NumOn(beam, 1), 20U);
}

TEST(Screens, AreMetByTheRaysOfTheirOwnFiringAlone) {
  const Screens all({0, 1, 1}, {{.range_m = 10.0F, .intensity = 0.1F, .surface = 7}});
  const auto rays = std::make_unique<RayTile>();
  rays->num_rays = 16;
  std::fill_n(rays->range_m, kTileSize, kFar_m);
  std::fill_n(rays->surface, kTileSize, 0U);
  std::fill_n(rays->direction_x, kTileSize, 1.0F);
  const std::uint32_t firings[] = {1, 0};
  all.Meet(firings, 2, *rays);
  EXPECT_EQ(rays->surface[0], 0U);
  EXPECT_EQ(rays->surface[1], 7U);
  EXPECT_EQ(rays->range_m[1], 10.0F);
  EXPECT_EQ(rays->normal_x[1], -1.0F);
}

}  // namespace
}  // namespace railcast
