#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "railcast/scene.h"

namespace railcast {

/// A square plate on z = 0 about the origin, of 2 x `num_across`^2 triangles; with a square hole in
/// its middle those within are left out.
inline Mesh Plate(double length_m, int num_across, double hole_m = 0.0) {
  Mesh mesh;
  const double step_m = length_m / num_across;
  for (int row = 0; row <= num_across; ++row) {
    for (int column = 0; column <= num_across; ++column) {
      mesh.vertices.push_back(
          Vector3(column * step_m - 0.5 * length_m, row * step_m - 0.5 * length_m, 0.0)
              .cast<float>());
    }
  }
  const auto number = [&](int row, int column) {
    return static_cast<std::uint32_t>(row * (num_across + 1) + column);
  };
  const auto is_in_hole = [&](int index) {
    return std::abs((index + 0.5) * step_m - 0.5 * length_m) < 0.5 * hole_m;
  };
  for (int row = 0; row < num_across; ++row) {
    for (int column = 0; column < num_across; ++column) {
      if (is_in_hole(row) && is_in_hole(column)) continue;
      mesh.triangles.push_back(
          {number(row, column), number(row, column + 1), number(row + 1, column + 1)});
      mesh.triangles.push_back(
          {number(row, column), number(row + 1, column + 1), number(row + 1, column)});
    }
  }
  return mesh;
}

/// About the origin: `num_around` meridians, half as many parallels, corners on the sphere.
inline Mesh Sphere(double radius_m, int num_around) {
  Mesh mesh;
  const int num_rows = num_around / 2;
  for (int row = 0; row <= num_rows; ++row) {
    const double polar_rad = std::numbers::pi * row / num_rows;
    for (int column = 0; column < num_around; ++column) {
      const double azimuth_rad = 2.0 * std::numbers::pi * column / num_around;
      const bool is_pole = row == 0 || row == num_rows;
      const double across = is_pole ? 0.0 : std::sin(polar_rad);
      const Vector3 direction(across * std::cos(azimuth_rad), across * std::sin(azimuth_rad),
                              std::cos(polar_rad));
      mesh.vertices.push_back((radius_m * direction).cast<float>());
    }
  }
  const auto number = [&](int row, int column) {
    return static_cast<std::uint32_t>(row * num_around + column % num_around);
  };
  for (int row = 0; row < num_rows; ++row) {
    for (int column = 0; column < num_around; ++column) {
      if (row > 0) {
        mesh.triangles.push_back(
            {number(row, column), number(row + 1, column), number(row, column + 1)});
      }
      if (row + 1 < num_rows) {
        mesh.triangles.push_back(
            {number(row, column + 1), number(row + 1, column), number(row + 1, column + 1)});
      }
    }
  }
  return mesh;
}

}  // namespace railcast
