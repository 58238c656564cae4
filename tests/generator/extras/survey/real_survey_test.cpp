#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/trace/trace_scene.h"
#include "generator/extras/survey/survey.h"
#include "generator/extras/survey/survey_voxels.h"
#include "railcast/io/recording.h"
#include "tests/generator/extras/survey/survey_proof.h"

namespace railcast {
namespace {

constexpr double kSurveyRange_m = 60.0;

/// The turns of a capture of a sensor that stands, without those at its ends that are not whole.
std::vector<SurveyFrame> WholeTurns(const std::filesystem::path& file) {
  SurveySource source;
  source.is_standing = true;
  source.range_max_m = kSurveyRange_m;
  SurveyLabels labels;
  const auto recording = OpenRecording(file);
  std::vector<SurveyFrame> turns;
  std::size_t most = 0;
  while (const auto read = recording->Next()) {
    turns.push_back(BeamsOf((*read)(), recording->info(), source, labels));
    most = std::max(most, turns.back().beams.size());
  }
  std::erase_if(turns, [&](const SurveyFrame& turn) { return turn.beams.size() < most * 9 / 10; });
  return turns;
}

Survey SurveyOf(const std::vector<SurveyFrame>& turns) {
  SurveyOptions options;
  options.sensor_height_m = 0.0;  // Only a line would need it.
  return MakeSurvey([&](const auto& visit) { std::ranges::for_each(turns, visit); }, {}, options);
}

/// The surfels of a survey as one mesh, around the sensor.
Model ModelOf(const Survey& survey) {
  Part part{.mesh = {}, .material = 1, .label = 1};
  for (const SurveyTile& tile : survey.tiles) {
    for (const Surfel& surfel : tile.surfels) {
      const Eigen::Vector3f center_m = tile.Origin_m().cast<float>() + surfel.center_m;
      const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
      for (const auto& [u, v] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        part.mesh.vertices.emplace_back(center_m + static_cast<float>(u) * surfel.half_u_m +
                                        static_cast<float>(v) * surfel.half_v_m);
      }
      part.mesh.triangles.push_back({first, first + 1, first + 2});
      part.mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
  return {"survey", {part}};
}

/// Ranges at which the beams of a turn meet the surfels; NaN where they meet none.
std::vector<double> Cast(const Survey& survey, const SurveyFrame& turn) {
  const TraceDevice device;
  const auto model = std::make_shared<TraceModel>(device, ModelOf(survey));
  const TraceScene scene(device, {{model, {Eigen::Affine3d::Identity()}, 1}});
  std::vector<double> ranges_m;
  const auto tile = std::make_unique<RayTile>();
  for (std::size_t begin = 0; begin < turn.beams.size(); begin += kTileSize) {
    tile->num_rays = kTileSize;
    const std::size_t num = std::min(kTileSize, turn.beams.size() - begin);
    for (std::size_t i = 0; i < kTileSize; ++i) {
      const SurveyBeam& beam = turn.beams[begin + std::min(i, num - 1)];
      const Eigen::Vector3f origin_m = beam.origin_m.cast<float>();
      const Eigen::Vector3f ahead = (beam.point_m - beam.origin_m).normalized().cast<float>();
      tile->origin_x[i] = origin_m.x();
      tile->origin_y[i] = origin_m.y();
      tile->origin_z[i] = origin_m.z();
      tile->direction_x[i] = ahead.x();
      tile->direction_y[i] = ahead.y();
      tile->direction_z[i] = ahead.z();
      tile->shutter[i] = 0.0F;
      tile->range_m[i] = 300.0F;
      tile->surface[i] = 0;
      tile->normal_x[i] = tile->normal_y[i] = tile->normal_z[i] = 0.0F;
    }
    scene.Cast(*tile);
    for (std::size_t i = 0; i < num; ++i) {
      ranges_m.push_back(tile->surface[i] == 0 ? std::numeric_limits<double>::quiet_NaN()
                                               : double{tile->range_m[i]});
    }
  }
  return ranges_m;
}

/// Bars just below what was measured.
struct RealSurvey {
  const char* file;
  double least_hits;
  double least_near;  ///< Within 0.3 m.
  double most_median_m;
};

class RealTurns : public testing::TestWithParam<RealSurvey> {};

TEST_P(RealTurns, ArePredictedByThoseBefore) {
  const std::filesystem::path file =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / GetParam().file;
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  std::vector<SurveyFrame> turns = WholeTurns(file);
  ASSERT_GE(turns.size(), 2U);
  const SurveyFrame last = std::move(turns.back());
  turns.pop_back();
  RecordedCells cells;
  for (const SurveyFrame& turn : turns) {
    for (const SurveyBeam& beam : turn.beams) cells.Add(beam.point_m);
  }
  const std::vector<double> found_m = Cast(SurveyOf(turns), last);
  const std::vector<float> spacings_rad = SpacingsOf_rad(last);
  std::vector<ProvenBeam> beams;
  for (std::size_t i = 0; i < last.beams.size(); ++i) {
    const SurveyBeam& beam = last.beams[i];
    const double range_m = (beam.point_m - beam.origin_m).norm();
    const bool is_within = cells.HasWithin(double{spacings_rad[i]} * range_m, beam.point_m);
    if (!is_within) continue;
    beams.push_back({"", range_m, 0.0, cells.NumAbout(beam.point_m), true, found_m[i] - range_m});
  }
  const Proven proven = ProvenBy(beams, [](const ProvenBeam& /*beam*/) { return true; });
  if (std::getenv("RAILCAST_PRINT_SURVEY") != nullptr) {
    PrintRow(std::string(GetParam().file) + ", " + std::to_string(turns.size()) +
                 " turns before, " + std::to_string(last.beams.size()) + " points",
             proven);
  }
  EXPECT_GE(beams.size(), last.beams.size() / 2);
  EXPECT_GE(proven.hit_share, GetParam().least_hits);
  EXPECT_GE(proven.near_share, GetParam().least_near);
  EXPECT_LE(proven.median_error_m, GetParam().most_median_m);
}

INSTANTIATE_TEST_SUITE_P(
    Survey,
    RealTurns,
    testing::Values(RealSurvey{"lidar_packets_nebula/vls128_single.pcap", 0.95, 0.86, 0.03},
                    RealSurvey{"lidar_packets_nebula/vlp16_dual.pcap", 0.965, 0.9, 0.015},
                    RealSurvey{"lidar_packets_nebula/pandar64.pcap", 0.98, 0.855, 0.04},
                    RealSurvey{"lidar_hesai/captures/xt32.db3", 0.985, 0.87, 0.01},
                    RealSurvey{"lidar_hesai/captures/qt128.db3", 0.985, 0.89, 0.015}),
    [](const auto& test) { return std::filesystem::path(test.param.file).stem().string(); });

}  // namespace
}  // namespace railcast
