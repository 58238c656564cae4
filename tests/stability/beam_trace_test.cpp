// Beams through our own trees against the same rays through Embree, in the scenes of real frames:
// instances of plants, ground at grazing incidence, rails, and a moving object.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/detect/base/beam_optics.h"
#include "core/detect/beam/sub_ray_pattern.h"
#include "core/detect/kernels/kernels.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_scene.h"
#include "core/trace/beam_tile.h"
#include "railcast/scenario.h"
#include "tests/stability/regime.h"

namespace railcast {
namespace {

/// How the sub-rays of a frame's beams compare.
struct Agreement {
  std::size_t num_rays{};
  std::size_t num_elsewhere{};  ///< Hit another surface, or the same one at another range.
  std::size_t num_lost{};       ///< Hit nothing where Embree hits something.
  float worst_m{};              ///< Largest difference in range of the others.

  void Compare(const BeamRays& beam, const RayTile& tile) {
    for (std::size_t i = 0; i < beam.num_rays; ++i) {
      ++num_rays;
      const float tolerance_m = 1e-5F * tile.range_m[i] + 1e-4F;
      const float off_m = std::fabs(beam.range_m[i] - tile.range_m[i]);
      const std::uint32_t surface = beam.facets[beam.facet[i]].surface;
      if (surface == 0 && tile.surface[i] != 0) {
        ++num_lost;
      } else if (surface != tile.surface[i] || off_m > tolerance_m) {
        ++num_elsewhere;
      } else {
        worst_m = std::max(worst_m, off_m);
      }
    }
  }
};

RayTile TileOf(const BeamRays& beam, float range_max_m) {
  RayTile tile{};
  tile.num_rays = beam.num_rays;
  tile.mask = beam.mask;
  CopySubRays(beam, beam.num_rays, tile);
  std::fill_n(tile.range_m, beam.num_rays, range_max_m);
  return tile;
}

Agreement AgreementOn(const std::string& scenario_name,
                      std::uint32_t frame_index,
                      const BeamSubRays& sub_rays,
                      const Wind& wind = {}) {
  const ScenarioSpec scenario =
      ReadScenario(std::string(RAILCAST_SOURCE_DIR "/scenarios/") + scenario_name);
  const auto simulator = MakeSimulator(scenario, 1);
  const SimulatorSpec& spec = simulator->spec();
  const auto range_max_m = static_cast<float>(spec.detector.range_max_m);
  const ScanPattern& pattern = simulator->pattern();
  const FiringTiles tiles(pattern);
  FrameScenes scenes(
      std::make_shared<SceneStore>(simulator->shared_world(), MaterialLibrary(scenario.materials)),
      {.range_max_m = spec.detector.range_max_m,
       .vehicle_from_sensor = spec.vehicle_from_sensor,
       .duration_ns = tiles.duration_ns()});
  scenes.UseWind(wind);
  BegunFrame begun = scenes.Begin(frame_index, pattern.StampNs(frame_index));
  const FrameScene& scene = scenes.SceneOf(begun);
  BeamFrame frame{};
  frame.sigma_h_rad = static_cast<float>(HorizontalSigma_rad(spec.detector.beam));
  frame.sigma_v_rad = static_cast<float>(VerticalSigma_rad(spec.detector.beam));
  const SubRayAim aim{sub_rays.num, sub_rays.h, sub_rays.v, 1.0001F * sub_rays.largest_offset,
                      1.0F,         0.0F};
  Agreement agreement;
  for (std::size_t t = 0; t < tiles.num_tiles(); ++t) {
    RayTile rays;
    tiles.Aim(t, scene.poses, range_max_m, rays);
    for (std::size_t lane = 0; lane < tiles.num_firings(t); ++lane) {
      BeamRays beam;
      AvailableKernels().back().aim_sub_rays(rays, lane, frame, aim, beam);
      beam.num_rays = sub_rays.num;
      std::fill_n(beam.range_m, sub_rays.num, range_max_m);
      std::fill_n(beam.facet, sub_rays.num, 0U);
      RayTile tile = TileOf(beam, range_max_m);
      scene.CastBeam(beam);
      scene.Cast(tile);
      agreement.Compare(beam, tile);
    }
  }
  RecordRegime(
      std::to_string(sub_rays.num) + " sub-rays a beam through our own trees, `" + scenario_name +
          "`",
      {"-", std::to_string(agreement.num_elsewhere) + " of " + std::to_string(agreement.num_rays) +
                " meet something else than Embree's rays, the others within " +
                TwoDigits(1e3 * static_cast<double>(agreement.worst_m)) + " mm"});
  return agreement;
}

void ExpectAgreement(const Agreement& agreement, double least_num = 1e6) {
  const auto num = static_cast<double>(agreement.num_rays);
  EXPECT_GT(num, least_num);
  EXPECT_LT(static_cast<double>(agreement.num_elsewhere), 2e-4 * num);
  EXPECT_LT(static_cast<double>(agreement.num_lost), 1e-5 * num);
  EXPECT_LT(agreement.worst_m, 3e-3F);
}

TEST(BeamTrace, AgreesWithEmbreeAmongGrassAndTrees) {
  ExpectAgreement(AgreementOn("open_line.json", 0, SubRaysOfBeam()));
}

TEST(BeamTrace, AgreesWithEmbreeInACloserLook) {
  ExpectAgreement(AgreementOn("brake_person.json", 40, SubRaysOfCloserLook()));
}

TEST(BeamTrace, AgreesWithEmbreeInACrowd) {
  ExpectAgreement(AgreementOn("open_line.json", 0, SubRaysOfCrowd()), 4e5);
}

TEST(BeamTrace, AgreesWithEmbreeWhereObjectsMove) {
  ExpectAgreement(AgreementOn("brake_person.json", 40, SubRaysOfBeam()));
}

TEST(BeamTrace, AgreesWithEmbreeWhereTreesAndWiresSway) {
  ExpectAgreement(AgreementOn("open_line.json", 0, SubRaysOfBeam(), Wind({6.0, 10.0, 0.0}, 1)));
}

}  // namespace
}  // namespace railcast
