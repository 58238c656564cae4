#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "core/rail/chunk/sweep.h"
#include "railcast/alignment.h"
#include "railcast/transform.h"
#include "tests/support/ray_cast.h"
#include "tests/support/world_specs.h"

namespace railcast {

/// Returns four uniform numbers in [0, 1) for each beam.
[[nodiscard]] inline std::array<double, 4> Uniforms(std::uint64_t beam) {
  const auto words = RandomWords(1, RandomUse::kFootprint, static_cast<std::uint32_t>(beam >> 32U),
                                 static_cast<std::uint32_t>(beam));
  std::array<double, 4> uniforms{};
  for (std::size_t i = 0; i < 4; ++i) uniforms[i] = words[i] * 0x1p-32;
  return uniforms;
}

/// Returns a direction that is uniform over the sphere.
[[nodiscard]] inline Vector3 RandomDirection(double u, double v) {
  const double z = 2.0 * u - 1.0;
  const double azimuth_rad = 2.0 * std::numbers::pi * v;
  const double plan = std::sqrt(1.0 - z * z);
  return {plan * std::cos(azimuth_rad), plan * std::sin(azimuth_rad), z};
}

/// A tunnel of two chunks, 20 m along a curve of 400 m radius at UTM coordinates. Each chunk is
/// swept in its own frame, as rails and ground are, and closed at the far end.
class Tunnel {
 public:
  explicit Tunnel(double overlap_m) {
    AlignmentSpec spec = AlignmentOf({{ElementType::kArc, 20.0, 400.0}});
    spec.origin_m = {4.5e5, 5.2e6, 431.7};
    spec.heading_deg = 37.0;
    spec.gradients_permil = {{0.0, 12.0}};
    alignment_ = std::make_unique<Alignment>(spec);
    std::vector<TracePlacement> placements;
    for (const int chunk : {0, 1}) {
      const double begin_s_m = chunk == 0 ? 0.0 : kSeam_m - 0.5 * overlap_m;
      const double end_s_m = chunk == 0 ? kSeam_m + 0.5 * overlap_m : 20.0;
      const Model model{"tunnel", {{SweepOf(chunk, begin_s_m, end_s_m), 1, 1}}};
      const Transform window_from_chunk = WindowFromWorld() * WorldFromChunk(chunk);
      placements.push_back({std::make_shared<TraceModel>(device_, model),
                            {Eigen::Affine3d(window_from_chunk.matrix())},
                            static_cast<std::uint32_t>(chunk + 1)});
    }
    scene_ = std::make_unique<TraceScene>(device_, placements);
  }

  [[nodiscard]] const TraceScene& scene() const { return *scene_; }

  /// Returns the point at the share `part` of the way round the wall, in the window frame.
  [[nodiscard]] Vector3 OnWall(double s_m, double part) const {
    const double corner = std::floor(4.0 * part);
    const auto i = static_cast<std::size_t>(corner);
    const Eigen::Vector2d place =
        kOutline_m[i] + (4.0 * part - corner) * (kOutline_m[i + 1] - kOutline_m[i]);
    return Inside(s_m, place);
  }
  [[nodiscard]] Vector3 Inside(double s_m, const Eigen::Vector2d& place_m) const {
    return WindowFromWorld() * alignment_->WorldFromTrack(s_m) *
           Vector3(0.0, place_m.x(), place_m.y());
  }

  /// Aims from within 4 m of the seam in any direction, at the seam, along the corners, or at the
  /// seam's corners.
  [[nodiscard]] Ray Aim(std::uint64_t beam) const {
    const auto [u, v, w, t] = Uniforms(beam);
    const Vector3 origin_m =
        Inside(kSeam_m + 8.0 * (u - 0.5), {2.0 * (v - 0.5), std::lerp(-0.5, 2.5, w)});
    switch (beam % 4) {
      case 0:
        return RayThrough(origin_m, origin_m + RandomDirection(std::fmod(1e3 * u, 1.0), t));
      case 1:
        return AtSeam(beam);
      case 2:
        return RayThrough(origin_m, OnWall(20.0 * t, 0.25 * static_cast<double>(beam / 4 % 4)));
      default:
        return RayThrough(origin_m, OnWall(kSeam_m, 0.25 * static_cast<double>(beam / 4 % 4)));
    }
  }
  [[nodiscard]] Ray AtSeam(std::uint64_t beam) const {
    const auto [u, v, w, t] = Uniforms(beam);
    return RayThrough(Inside(kSeam_m + 8.0 * (u - 0.5), {2.0 * (v - 0.5), std::lerp(-0.5, 2.5, w)}),
                      OnWall(kSeam_m, t));
  }

 private:
  static constexpr double kSeam_m = 10.0;
  inline static const std::array<Eigen::Vector2d, 5> kOutline_m = {
      Eigen::Vector2d{-2.1, -1.0}, {2.1, -1.0}, {2.1, 3.7}, {-2.1, 3.7}, {-2.1, -1.0}};

  [[nodiscard]] Transform WorldFromChunk(int chunk) const {
    const AxisPoint middle = alignment_->At(5.0 + 10.0 * chunk);
    return MakeTransform(RotationFromYawPitchRoll(middle.heading_rad, 0.0, 0.0), middle.position_m);
  }
  [[nodiscard]] Transform WindowFromWorld() const { return WorldFromChunk(0).inverse(); }

  [[nodiscard]] Mesh SweepOf(int chunk, double begin_s_m, double end_s_m) const {
    std::vector<Transform> stations;
    constexpr int kSteps = 8;
    for (int i = 0; i <= kSteps; ++i) {
      stations.push_back(WorldFromChunk(chunk).inverse() *
                         alignment_->WorldFromTrack(std::lerp(begin_s_m, end_s_m, i / 8.0)));
    }
    Mesh mesh;
    AppendSweep(stations, kOutline_m, mesh);
    const std::uint32_t cap = chunk == 0 ? 0 : kSteps * 5;
    // The sweep closes its outline with a fifth corner in the place of the first.
    mesh.triangles.push_back({cap, cap + 1, cap + 2});
    mesh.triangles.push_back({cap, cap + 2, cap + 3});
    return mesh;
  }

  TraceDevice device_;
  std::unique_ptr<Alignment> alignment_;
  std::unique_ptr<TraceScene> scene_;
};

}  // namespace railcast
