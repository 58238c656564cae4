#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "railcast/scene.h"

namespace railcast {

/// A square of half side `half_m` at distance `x_m`, facing -x.
[[nodiscard]] inline Mesh MakeWall(float x_m, float half_m) {
  return {{{x_m, -half_m, -half_m},
           {x_m, half_m, -half_m},
           {x_m, half_m, half_m},
           {x_m, -half_m, half_m}},
          {{0, 1, 2}, {0, 2, 3}}};
}

/// A square of half side `half_m` at height `z_m`, facing +z.
[[nodiscard]] inline Mesh MakeFloor(float z_m, float half_m) {
  return {{{-half_m, -half_m, z_m},
           {half_m, -half_m, z_m},
           {half_m, half_m, z_m},
           {-half_m, half_m, z_m}},
          {{0, 1, 2}, {0, 2, 3}}};
}

/// A sphere about the origin, of rings and sectors. Its facets lie inside by at most
/// radius * (1 - cos(pi / sectors)), plus the corresponding term for rings.
[[nodiscard]] inline Mesh MakeSphere(double radius_m, int rings, int sectors) {
  Mesh mesh;
  for (int ring = 0; ring <= rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int sector = 0; sector < sectors; ++sector) {
      const double azimuth = 2.0 * std::numbers::pi * sector / sectors;
      mesh.vertices.emplace_back(
          (radius_m * Vector3(std::sin(polar) * std::cos(azimuth),
                              std::sin(polar) * std::sin(azimuth), std::cos(polar)))
              .cast<float>());
    }
  }
  const auto vertex = [&](int ring, int sector) {
    return static_cast<std::uint32_t>(ring * sectors + sector % sectors);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      mesh.triangles.push_back(
          {vertex(ring, sector), vertex(ring + 1, sector), vertex(ring + 1, sector + 1)});
      mesh.triangles.push_back(
          {vertex(ring, sector), vertex(ring + 1, sector + 1), vertex(ring, sector + 1)});
    }
  }
  return mesh;
}

/// An upright cylinder about the origin without caps.
[[nodiscard]] inline Mesh MakeCylinder(double radius_m, double half_height_m, int sides) {
  Mesh mesh;
  for (int side = 0; side < sides; ++side) {
    const double azimuth = 2.0 * std::numbers::pi * side / sides;
    const auto x = static_cast<float>(radius_m * std::cos(azimuth));
    const auto y = static_cast<float>(radius_m * std::sin(azimuth));
    mesh.vertices.emplace_back(x, y, static_cast<float>(-half_height_m));
    mesh.vertices.emplace_back(x, y, static_cast<float>(half_height_m));
  }
  for (int side = 0; side < sides; ++side) {
    const auto a = static_cast<std::uint32_t>(2 * side);
    const auto b = static_cast<std::uint32_t>(2 * ((side + 1) % sides));
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
  return mesh;
}

}  // namespace railcast
