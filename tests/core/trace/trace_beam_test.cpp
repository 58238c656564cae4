// The trace of beams against RayCaster::Cast(), that is against Embree.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/trace/beam_kernels.h"
#include "core/trace/beam_tree.h"
#include "core/trace/trace_scene.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/ray_cast.h"
#include "tests/support/recorded_bytes.h"

namespace railcast {
namespace {

constexpr float kFarthest_m = 200.0F;

// The scenes and beams are made of sums, products and roots, which have the same bits on every
// processor; sines and cosines of its library need not. Draws stand in braces, where their order
// is that of the text: arguments in parentheses are evaluated in any order.

// Eigen sums squares in an order of its own on each processor.
template <typename Scalar>
Eigen::Matrix<Scalar, 3, 1> Unit(const Eigen::Matrix<Scalar, 3, 1>& v) {
  return v / std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
}

/// Unit vectors, each turned by the golden angle from the one before.
class GoldenTurns {
 public:
  Eigen::Vector2f Next() {
    const Eigen::Vector2d now = here_;
    constexpr double kCosine = -0.7373688780783197;
    constexpr double kSine = 0.6754902942615238;
    here_ =
        Eigen::Vector2d(kCosine * now.x() - kSine * now.y(), kSine * now.x() + kCosine * now.y());
    return now.cast<float>();
  }

 private:
  Eigen::Vector2d here_ = Eigen::Vector2d::UnitX();
};

/// A beam from the origin, with sub-rays spread over an ellipse as a sensor's are.
BeamRays BeamAlong(const Eigen::Vector3f& axis, float half_h_rad, float half_v_rad) {
  BeamRays beam{};
  const Eigen::Vector3f h = Unit<float>(Eigen::Vector3f::UnitZ().cross(axis)) * half_h_rad;
  const Eigen::Vector3f v = Unit<float>(axis.cross(h)) * half_v_rad;
  Eigen::Map<Eigen::Vector3f>(beam.axis) = axis;
  Eigen::Map<Eigen::Vector3f>(beam.half_h) = h;
  Eigen::Map<Eigen::Vector3f>(beam.half_v) = v;
  GoldenTurns turns;
  for (std::size_t i = 0; i < kNumSubRays; ++i) {
    const float radius = 0.9999F * std::sqrt((static_cast<float>(i) + 0.5F) / kNumSubRays);
    const Eigen::Vector2f at = radius * turns.Next();
    const Eigen::Vector3f ray = Unit<float>(axis + at.x() * h + at.y() * v);
    beam.direction_x[i] = ray.x();
    beam.direction_y[i] = ray.y();
    beam.direction_z[i] = ray.z();
    beam.range_m[i] = kFarthest_m;
    beam.facet[i] = 0;
  }
  return beam;
}

/// The same sub-rays as a tile.
RayTile TileOf(const BeamRays& beam) {
  RayTile tile{};
  tile.num_rays = kNumSubRays;
  tile.mask = beam.mask;
  for (std::size_t i = 0; i < kNumSubRays; ++i) {
    SetRay(tile, i,
           {{beam.origin[0], beam.origin[1], beam.origin[2]},
            {beam.direction_x[i], beam.direction_y[i], beam.direction_z[i]}},
           kFarthest_m);
    tile.shutter[i] = beam.shutter;
  }
  return tile;
}

/// Triangles of up to `size_m` in a ball of 1 m.
Mesh Confetti(int num, float size_m, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  Mesh mesh;
  for (int i = 0; i < num; ++i) {
    const Eigen::Vector3f middle{uniform(random), uniform(random), uniform(random)};
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 3; ++corner) {
      mesh.vertices.push_back(
          middle + size_m * Eigen::Vector3f{uniform(random), uniform(random), uniform(random)});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Clouds of triangles all around, one of which moves and turns, with wires among them, in front of
/// a wall on one side.
class Clouds {
 public:
  Clouds() {
    std::mt19937 random(7);
    const auto model = std::make_shared<TraceModel>(
        device_,
        Model{"cloud",
              {{Confetti(60, 0.4F, random), 1, 1},
               {.mesh = Confetti(15, 0.2F, random), .material = 1, .label = 2, .is_wire = true}}});
    const auto wall =
        std::make_shared<TraceModel>(device_, Model{"wall", {{MakeWall(60.0F, 40.0F), 1, 1}}});
    std::vector<TracePlacement> placements;
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::uint32_t surface = 1;
    for (int i = 0; i < 120; ++i) {
      TracePlacement placement{model, {}, surface};
      surface += 2;
      const Eigen::Vector3d at =
          30.0 * Eigen::Vector3d{uniform(random), uniform(random), 0.3 * uniform(random)};
      const Eigen::Vector3d axis =
          Unit<double>({uniform(random), uniform(random), uniform(random)});
      const int num_steps = i % 3 == 0 ? 3 : 1;
      for (int step = 0; step < num_steps; ++step) {
        Eigen::Affine3d place = Eigen::Affine3d::Identity();
        place.translate(at + 0.5 * step * axis);
        const Eigen::Vector3d turn = uniform(random) * (step == 0 ? 1.0 : 0.005) * axis;
        const double length =
            std::sqrt(1.0 + turn.x() * turn.x() + turn.y() * turn.y() + turn.z() * turn.z());
        place.rotate(Eigen::Quaterniond(1.0 / length, turn.x() / length, turn.y() / length,
                                        turn.z() / length));
        place.scale(0.5 + 0.01 * i);
        placement.window_from_model.push_back(place);
      }
      placements.push_back(std::move(placement));
    }
    placements.push_back({wall, {Eigen::Affine3d::Identity()}, surface});
    scene_ = std::make_unique<TraceScene>(device_, placements);
  }

  [[nodiscard]] const TraceScene& scene() const { return *scene_; }

 private:
  TraceDevice device_;
  std::unique_ptr<TraceScene> scene_;
};

/// Beams in all directions, of several widths, at several times.
std::vector<BeamRays> BeamsAround(std::size_t num) {
  std::vector<BeamRays> beams;
  GoldenTurns turns;
  for (std::size_t i = 0; i < num; ++i) {
    const float z = 0.6F * (2.0F * (static_cast<float>(i) + 0.5F) / static_cast<float>(num) - 1.0F);
    const Eigen::Vector2f across = std::sqrt(1.0F - z * z) * turns.Next();
    const float width_rad = i % 2 == 0 ? 3e-3F : 3e-4F;
    BeamRays beam = BeamAlong({across.x(), across.y(), z}, width_rad, 0.5F * width_rad);
    beam.shutter = static_cast<float>(i % 11) / 10.0F;
    beam.mask = i % 5 == 0 ? kAllButWires : kAllSurfaces;
    beam.origin[2] = 0.1F * static_cast<float>(i % 7);
    beams.push_back(beam);
  }
  return beams;
}

TEST(TraceBeam, HitsWhatEmbreeHits) {
  const Clouds clouds;
  std::size_t num = 0;
  std::size_t num_hits = 0;
  std::size_t num_different = 0;
  for (BeamRays& beam : BeamsAround(20'000)) {
    RayTile tile = TileOf(beam);
    clouds.scene().Cast(tile);
    clouds.scene().CastBeam(beam);
    for (std::size_t i = 0; i < beam.num_rays; ++i) {
      ++num;
      const Facet& facet = beam.facets[beam.facet[i]];
      num_hits += tile.surface[i] != 0 ? 1U : 0U;
      if (facet.surface != tile.surface[i] ||
          std::fabs(beam.range_m[i] - tile.range_m[i]) > 1e-5F * tile.range_m[i] + 1e-5F) {
        ++num_different;
        continue;
      }
      if (facet.surface == 0) continue;
      const Eigen::Vector3f ours(facet.normal_x, facet.normal_y, facet.normal_z);
      const Eigen::Vector3f theirs(tile.normal_x[i], tile.normal_y[i], tile.normal_z[i]);
      // Cast() takes a moving instance's normal between its first and last step.
      if (beam.shutter == 0.0F || beam.shutter == 1.0F) {
        EXPECT_NEAR(std::fabs(ours.normalized().dot(theirs.normalized())), 1.0F, 1e-4F);
      }
    }
  }
  EXPECT_GT(num, 1'000'000U);
  EXPECT_GT(num_hits, num / 5);
  // Rays within rounding of an edge.
  EXPECT_LT(static_cast<double>(num_different), 5e-5 * static_cast<double>(num));
}

// The labels of the surfaces of Clouds, of which each odd one is of confetti and each even one of
// wires.
std::uint32_t LabelIn(std::uint32_t surface) {
  return surface % 2 == 0 ? 2 : 1;
}

TEST(MayMeet, IsTrueOfEveryBeamThatHitsWhatHasTheLabel) {
  const Clouds clouds;
  for (const std::uint32_t label : {1U, 2U}) {
    const BeamScenes scenes = clouds.scene().OnlyLabels({label});
    std::size_t num_met = 0;
    std::size_t num_hits = 0;
    for (BeamRays& beam : BeamsAround(20'000)) {
      beam.mask = kAllSurfaces;
      const bool may_meet = MayMeet(scenes, beam);
      num_met += may_meet ? 1U : 0U;
      for (const BeamKernel& kernel : AvailableBeamKernels()) {
        const BeamScene& of_label = label == 1 ? scenes.solid : scenes.wires;
        EXPECT_EQ(kernel.may_meet(of_label, beam), may_meet) << kernel.isa;
      }
      clouds.scene().CastBeam(beam);
      bool is_hit = false;
      for (std::size_t i = 0; i < beam.num_rays; ++i) {
        const std::uint32_t surface = beam.facets[beam.facet[i]].surface;
        is_hit = is_hit || (surface != 0 && LabelIn(surface) == label);
      }
      num_hits += is_hit ? 1U : 0U;
      EXPECT_TRUE(may_meet || !is_hit);
    }
    EXPECT_GT(num_hits, 200U);
    // Others pass behind something else, or between sub-rays.
    EXPECT_LT(num_met, 20'000U) << label;
  }
}

// A round beam meets a ball of radius r at a distance d if its axis passes less than its half angle
// beside it, seen from the origin: asin(r / d). The ball's facets lie up to 1 % further inside.
TEST(MayMeet, IsTrueOfNoBeamThatPassesBesideABall) {
  constexpr float kHalfAngle_rad = 4e-3F;
  constexpr float kDistance_m = 50.0F;
  const TraceDevice device;
  const auto ball =
      std::make_shared<TraceModel>(device, Model{"ball", {{MakeSphere(0.5, 48, 96), 1, 7}}});
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  place.translate(Eigen::Vector3d(kDistance_m, 0.0, 0.0));
  const TraceScene scene(device, {{ball, {place}, 1}});
  const float ball_rad = std::asin(0.5F / kDistance_m);
  for (int i = 0; i < 400; ++i) {
    const float beside_rad = 1e-4F * static_cast<float>(i);
    BeamRays beam = BeamAlong({std::cos(beside_rad), std::sin(beside_rad), 0.0F}, kHalfAngle_rad,
                              kHalfAngle_rad);
    const bool may_meet = MayMeet(scene.OnlyLabels({7}), beam);
    EXPECT_TRUE(may_meet || beside_rad > 0.99F * ball_rad + kHalfAngle_rad) << i;
    EXPECT_FALSE(may_meet && beside_rad > 1.03F * ball_rad + kHalfAngle_rad) << i;
    EXPECT_FALSE(MayMeet(scene.OnlyLabels({8}), beam)) << i;
    beam.range_m[0] = kDistance_m - 1.0F;
    EXPECT_FALSE(MayMeet(scene.OnlyLabels({7}), beam)) << i;
  }
}

TEST(TraceBeam, GivesTheSameBytesOnEveryInstructionSet) {
  const Clouds clouds;
  const std::vector<BeamKernel>& kernels = AvailableBeamKernels();
  std::string aims, ranges;
  const auto append = [](const auto& values, std::string& bytes) {
    bytes.append(reinterpret_cast<const char*>(&values), sizeof values);
  };
  for (BeamRays& beam : BeamsAround(500)) {
    BeamRays first = beam;
    append(beam.direction_x, aims);
    clouds.scene().CastBeamWith(kernels.front(), first);
    append(first.range_m, ranges);
    for (const BeamKernel& kernel : kernels) {
      BeamRays other = beam;
      clouds.scene().CastBeamWith(kernel, other);
      ASSERT_EQ(std::memcmp(first.range_m, other.range_m, sizeof first.range_m), 0) << kernel.isa;
      ASSERT_EQ(std::memcmp(first.facet, other.facet, sizeof first.facet), 0) << kernel.isa;
      ASSERT_EQ(first.num_facets, other.num_facets);
      for (std::uint32_t f = 0; f < first.num_facets; ++f) {
        ASSERT_EQ(std::memcmp(&first.facets[f], &other.facets[f], sizeof(Facet)), 0) << kernel.isa;
      }
    }
  }
  RecordBytes("aims", aims);
  RecordBytes("ranges", ranges);
}

/// `num` plates of 1 m behind each other from 20 m on, the nearest last in the mesh. Each has its
/// own slope, so that plates far behind pass in front of others somewhere.
Mesh Plates(int num) {
  Mesh mesh;
  for (int i = num; i-- > 0;) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const float x = 20.0F + 0.01F * static_cast<float>(i);
    const float slope = i % 2 == 0 ? 3.0F : -3.0F;
    mesh.vertices.insert(mesh.vertices.end(),
                         {{x - slope, -1.0F, -1.0F}, {x + slope, 1.0F, -1.0F}, {x, 0.0F, 1.5F}});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(TraceBeam, FindsTheNearestOfACrowdWithFewerSubRays) {
  const TraceDevice device;
  const auto model = std::make_shared<TraceModel>(device, Model{"plates", {{Plates(2000), 1, 1}}});
  const TraceScene scene(device, {{model, {Eigen::Affine3d::Identity()}, 1}});
  BeamRays beam = BeamAlong(Eigen::Vector3f::UnitX(), 0.02F, 0.02F);
  RayTile tile = TileOf(beam);
  scene.Cast(tile);
  scene.CastBeam(beam);
  EXPECT_GT(beam.num_met, 64U);
  ASSERT_EQ(beam.num_rays, kNumCrowdedSubRays);
  for (std::size_t i = 0; i < beam.num_rays; ++i) {
    EXPECT_NEAR(beam.range_m[i], tile.range_m[i], 1e-4F);
    EXPECT_EQ(beam.facets[beam.facet[i]].surface, 1U);
  }
}

TEST(TraceBeam, NamesEveryFacetOnce) {
  const TraceDevice device;
  const auto model = std::make_shared<TraceModel>(
      device, Model{"ball", {{MakeSphere(1.0, 16, 16), 1, 1}, {MakeWall(30.0F, 9.0F), 1, 1}}});
  Eigen::Affine3d ahead = Eigen::Affine3d::Identity();
  ahead.translation() = Eigen::Vector3d(10.0, 0.9, 0.0);
  const TraceScene scene(device, {{model, {ahead}, 5}});
  BeamRays beam = BeamAlong(Eigen::Vector3f::UnitX(), 0.02F, 0.02F);
  scene.CastBeam(beam);
  std::vector<int> num_rays(beam.num_facets);
  for (std::size_t i = 0; i < beam.num_rays; ++i) ++num_rays[beam.facet[i]];
  EXPECT_EQ(num_rays[0], 0);
  std::size_t num_walls = 0;
  for (std::uint32_t f = 1; f < beam.num_facets; ++f) {
    EXPECT_GT(num_rays[f], 0);
    num_walls += beam.facets[f].surface == 6U ? 1U : 0U;
  }
  EXPECT_GT(beam.num_facets, 4U);
  EXPECT_EQ(num_walls, 1U);
}

/// A host's caster, which knows rays only.
struct OnlyRays final : RayCaster {
  explicit OnlyRays(const RayCaster& of_host) : caster(of_host) {}
  void Cast(RayTile& tile) const override { caster.Cast(tile); }
  const RayCaster& caster;
};

TEST(TraceBeam, OfAHostThatKnowsRaysOnlyGivesTheSameFacets) {
  const Clouds clouds;
  const OnlyRays host(clouds.scene());
  std::size_t num = 0;
  std::size_t num_different = 0;
  for (BeamRays& beam : BeamsAround(300)) {
    BeamRays ours = beam;
    clouds.scene().CastBeam(ours);
    host.CastBeam(beam);
    ASSERT_EQ(beam.num_rays, kNumSubRays);
    for (std::size_t i = 0; i < ours.num_rays; ++i) {
      ++num;
      const bool is_same =
          ours.facets[ours.facet[i]].surface == beam.facets[beam.facet[i]].surface &&
          std::fabs(ours.range_m[i] - beam.range_m[i]) < 1e-3F;
      num_different += is_same ? 0U : 1U;
    }
  }
  EXPECT_EQ(num, 300 * kNumSubRays);
  // Rays within rounding of an edge.
  EXPECT_LE(num_different, 2U);
}

TEST(TraceBeam, LeavesBeamsAloneInAnEmptyScene) {
  const TraceDevice device;
  const TraceScene scene(device, {});
  BeamRays beam = BeamAlong(Eigen::Vector3f::UnitX(), 0.02F, 0.02F);
  scene.CastBeam(beam);
  EXPECT_EQ(beam.num_facets, 1U);
  for (std::size_t i = 0; i < kNumSubRays; ++i) EXPECT_EQ(beam.range_m[i], kFarthest_m);
}

// A short cylinder stretched to a thin rod, at which beams look end-on: in its frame, the beams'
// own width is much greater than the distance.
TEST(TraceBeam, MissesNothingOfAStretchedModel) {
  const TraceDevice device;
  const auto rod =
      std::make_shared<TraceModel>(device, Model{"rod", {{MakeCylinder(1.0, 1.0, 64), 1, 1}}});
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  place.linear() << 0.0, 0.0, 2.5, 0.02, 0.0, 0.0, 0.0, 0.02, 0.0;
  place.translation() = Vector3(10.0, 0.0, 0.0);
  const TraceScene scene(device, {{rod, {place}, 1}});
  std::size_t num_hits = 0;
  std::size_t num_different = 0;
  for (int i = 0; i < 4000; ++i) {
    const float tilt = 1.5e-5F * static_cast<float>(i - 2000);
    BeamRays beam = BeamAlong(Eigen::Vector3f(1.0F, 0.3F * tilt, tilt).normalized(), 0.02F, 0.02F);
    RayTile tile = TileOf(beam);
    scene.Cast(tile);
    scene.CastBeam(beam);
    for (std::size_t ray = 0; ray < beam.num_rays; ++ray) {
      num_hits += tile.surface[ray] != 0 ? 1U : 0U;
      const bool is_same = beam.facets[beam.facet[ray]].surface == tile.surface[ray] &&
                           std::fabs(beam.range_m[ray] - tile.range_m[ray]) < 1e-3F;
      num_different += is_same ? 0U : 1U;
    }
  }
  EXPECT_GT(num_hits, 1000U);
  // At such a slant, rounding moves edges: some rays in ten thousand.
  EXPECT_LT(static_cast<double>(num_different), 1e-3 * static_cast<double>(num_hits));
}

}  // namespace
}  // namespace railcast
