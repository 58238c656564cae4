#include "tests/bench/beam_ways_scene.h"

#include <algorithm>
#include <map>
#include <string>

#include "core/detect/base/beam_optics.h"
#include "core/detect/beam/sub_ray_pattern.h"
#include "core/trace/beam_tree_build.h"
#include "core/trace/embree_error.h"

namespace railcast {
namespace {

using Matrix = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

Rows RowsOf(const Eigen::Affine3d& transform) {
  Rows rows{};
  Eigen::Map<Matrix>(rows.m) = transform.matrix().topRows<3>().cast<float>();
  return rows;
}

std::vector<BeamTriangle> SolidTrianglesOf(const Model& model) {
  std::vector<BeamTriangle> triangles;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const Part& part = model.parts[p];
    if (part.is_wire) continue;
    for (const auto& corners : part.mesh.triangles) {
      BeamTriangle& triangle = triangles.emplace_back();
      triangle.part = static_cast<std::uint32_t>(p);
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners[k] = part.mesh.vertices[corners[k]];
      }
    }
  }
  return triangles;
}

}  // namespace

struct BeamWaysScene::Trees {
  RTCDevice device = rtcNewDevice("");
  std::map<const Model*, BeamTree> models;
  BeamTree places;
  std::vector<Rows> window_from_model;
  std::vector<BeamInstance> instances;
  BeamScene scene;

  void Build(const std::vector<PlacedModel>& placed_models);
};

BeamWaysScene::BeamWaysScene(const ScenarioSpec& scenario)
    : layout_(MakeLayoutScene(scenario)),
      range_max_m_(static_cast<float>(scenario.lidar.range_max_m)),
      seed_(scenario.seed),
      kernels_(AvailableKernels().back()),
      trees_(std::make_unique<Trees>()) {
  frame_.sigma_h_rad = static_cast<float>(HorizontalSigma_rad(scenario.lidar.beam));
  frame_.sigma_v_rad = static_cast<float>(VerticalSigma_rad(scenario.lidar.beam));
  frame_.up[2] = 1.0F;
  frame_.vertical[2] = 1.0F;
  BuildWithEmbree(
      trees_->device, [] { return std::string("building trees for beams"); },
      [this] { trees_->Build(layout_.models); });
}

void BeamWaysScene::Trees::Build(const std::vector<PlacedModel>& placed_models) {
  std::vector<Eigen::AlignedBox3f> boxes;
  std::uint32_t surface = 1;
  for (const PlacedModel& placed : placed_models) {
    const auto [it, is_new] = models.try_emplace(placed.model.get());
    if (is_new) it->second = BuildModelTree(device, SolidTrianglesOf(*placed.model));
    const Eigen::AlignedBox3f& bounds = it->second.bounds();
    Eigen::AlignedBox3f& box = boxes.emplace_back();
    for (int k = 0; k < 8 && !bounds.isEmpty(); ++k) {
      const auto corner = static_cast<Eigen::AlignedBox3f::CornerType>(k);
      box.extend((placed.window_from_model * bounds.corner(corner).cast<double>()).cast<float>());
    }
    window_from_model.push_back(RowsOf(placed.window_from_model));
    instances.push_back({.root = it->second.root(),
                         .first_surface = surface,
                         .num_steps = 1,
                         .model_from_window = RowsOf(placed.window_from_model.inverse())});
    surface += static_cast<std::uint32_t>(placed.model->parts.size());
  }
  for (std::size_t i = 0; i < instances.size(); ++i) {
    instances[i].window_from_model = &window_from_model[i];
  }
  places = BuildSceneTree(device, boxes);
  scene = {places.root(), instances.data()};
}

BeamWaysScene::~BeamWaysScene() {
  RTCDevice device = trees_->device;
  trees_.reset();
  rtcReleaseDevice(device);
}

const BeamScene& BeamWaysScene::beams() const {
  return trees_->scene;
}

void BeamWaysScene::Aim(std::size_t firing, BeamRays& beam) const {
  const BeamSubRays& pattern = SubRaysOfBeam();
  const PatternTurn turn = TurnOfPattern(seed_, 0, static_cast<std::uint32_t>(firing));
  constexpr float kMargin = 1.0001F;
  const RayTile& tile = layout_.rays.tiles[firing / kTileSize];
  kernels_.aim_sub_rays(
      tile, firing % kTileSize, frame_,
      {pattern.h, pattern.v, kMargin * pattern.largest_offset, turn.cosine, turn.sine}, beam);
  std::fill_n(beam.range_m, kNumSubRays, range_max_m_);
  std::fill_n(beam.facet, kNumSubRays, 0U);
  beam.num_rays = kNumSubRays;
  beam.num_met = 0;
  beam.num_facets = 1;
  beam.facets[0] = {};
}

}  // namespace railcast
