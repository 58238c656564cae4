// Measures what simplifying meshes costs and gains, for docs/results/detail.md. Prints a line for
// each file and tolerance, with tabs between: file, tolerance in mm, triangles, deviation in mm,
// time to read the file, to simplify it and to prepare it for tracing in ms, time of a ray and of a
// beam that meets its box in ns, root mean square and greatest difference of ranges in mm, and the
// share of rays in percent that meet it with or without simplification but not both, and the memory
// in MB that preparing it takes. Times are of the processor, summed over the threads.
//
//   railcast-measure meshes FILE... [--up y] [--unit 0.01] [--normals 20] [--tolerances 0,1,2.5]
//                           [--subdivide 3] [--noise 0.3]
//
// Rays run from six places 20 m from the middle of the mesh, 3 m above its foot, to a grid of
// points on its box.
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/mesh/mesh_import.h"
#include "core/mesh/simplify.h"
#include "core/program/command_line.h"
#include "core/trace/trace_scene.h"
#include "tests/bench/dense_mesh.h"
#include "tests/bench/measurements.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

constexpr double kDistance_m = 20.0;
constexpr double kEyeHeight_m = 3.0;
constexpr int kNumPlaces = 6;
constexpr int kRaysAcross = 256;  // A tile is a row.
constexpr int kNumTurns = 3;

struct MeshBenchOptions {
  std::vector<std::string> files;
  std::string up = "z";
  double unit_m = 1.0;
  double normal_deg = 20.0;
  int num_times = 0;
  double noise_mm = 0.0;
  std::vector<double> tolerances_mm = {0, 1, 2.5, 5, 10, 20};
};

Eigen::AlignedBox3d BoxOf(const std::vector<Mesh>& parts) {
  Eigen::AlignedBox3d box;
  for (const Mesh& part : parts) {
    for (const Eigen::Vector3f& vertex : part.vertices) box.extend(vertex.cast<double>());
  }
  return box;
}

/// Rays from one place to a grid on the side of a box's middle plane that faces it.
std::vector<RayTile> RaysAt(const Eigen::AlignedBox3d& box, int place) {
  const double angle_rad = 2.0 * std::numbers::pi * (place + 0.3) / kNumPlaces;
  const Vector3 middle = box.center();
  const Vector3 eye(middle.x() + kDistance_m * std::cos(angle_rad),
                    middle.y() + kDistance_m * std::sin(angle_rad), box.min().z() + kEyeHeight_m);
  const Vector3 right(-std::sin(angle_rad), std::cos(angle_rad), 0.0);
  const double half_m = 0.5 * box.sizes().head<2>().norm();
  std::vector<RayTile> tiles(kRaysAcross);
  for (int row = 0; row < kRaysAcross; ++row) {
    RayTile& tile = tiles[static_cast<std::size_t>(row)];
    tile.num_rays = kRaysAcross;
    for (int i = 0; i < kRaysAcross; ++i) {
      const Vector3 aim = Vector3(middle.x(), middle.y(), box.min().z()) +
                          half_m * (2.0 * (i + 0.5) / kRaysAcross - 1.0) * right +
                          Vector3(0.0, 0.0, box.sizes().z() * (row + 0.5) / kRaysAcross);
      const Eigen::Vector3f direction = (aim - eye).normalized().cast<float>();
      tile.origin_x[i] = static_cast<float>(eye.x());
      tile.origin_y[i] = static_cast<float>(eye.y());
      tile.origin_z[i] = static_cast<float>(eye.z());
      tile.direction_x[i] = direction.x();
      tile.direction_y[i] = direction.y();
      tile.direction_z[i] = direction.z();
      tile.range_m[i] = 1000.0F;
    }
  }
  return tiles;
}

std::vector<RayTile> AllRays(const Eigen::AlignedBox3d& box) {
  std::vector<RayTile> tiles;
  for (int place = 0; place < kNumPlaces; ++place) {
    const std::vector<RayTile> more = RaysAt(box, place);
    tiles.insert(tiles.end(), more.begin(), more.end());
  }
  return tiles;
}

std::unique_ptr<TraceScene> SceneOf(const TraceDevice& device, const std::vector<Mesh>& parts) {
  Model model{.name = "mesh", .parts = {}};
  for (const Mesh& part : parts) model.parts.push_back({.mesh = part, .material = 1, .label = 1});
  return std::make_unique<TraceScene>(
      device, std::vector<TracePlacement>{{.model = std::make_shared<TraceModel>(device, model),
                                           .window_from_model = {Eigen::Affine3d::Identity()},
                                           .first_surface = 1}});
}

struct TracedRanges {
  std::vector<float> ranges_m;
  double ray_ns{};
};

TracedRanges Traced(const TraceScene& scene, const std::vector<RayTile>& rays) {
  TracedRanges traced;
  std::vector<double> turns_ms;
  for (int turn = 0; turn < kNumTurns; ++turn) {
    std::vector<RayTile> tiles = rays;
    turns_ms.push_back(CpuTimeOf_ms([&] {
      for (RayTile& tile : tiles) scene.Cast(tile);
    }));
    if (turn > 0) continue;
    for (const RayTile& tile : tiles) {
      traced.ranges_m.insert(traced.ranges_m.end(), tile.range_m, tile.range_m + tile.num_rays);
    }
  }
  traced.ray_ns = 1e6 * Median(turns_ms) / static_cast<double>(traced.ranges_m.size());
  return traced;
}

/// Time of a beam of 3 mrad in every 16th row and column.
double BeamTime_ns(const TraceScene& scene, const std::vector<RayTile>& rays) {
  scene.PrepareBeams();
  std::vector<double> turns_ms;
  std::size_t num_beams = 0;
  for (int turn = 0; turn < kNumTurns; ++turn) {
    num_beams = 0;
    turns_ms.push_back(CpuTimeOf_ms([&] {
      for (std::size_t t = 0; t < rays.size(); t += 16) {
        for (std::size_t i = 0; i < rays[t].num_rays; i += 16, ++num_beams) {
          BeamRays beam{};
          const Vector3 axis(static_cast<double>(rays[t].direction_x[i]),
                             static_cast<double>(rays[t].direction_y[i]),
                             static_cast<double>(rays[t].direction_z[i]));
          constexpr double kHalfWidth = 1.5e-3;
          const Vector3 half_h = kHalfWidth * axis.cross(Vector3::UnitZ()).normalized();
          const Vector3 half_v = kHalfWidth * half_h.cross(axis).normalized();
          for (int k = 0; k < 3; ++k) {
            beam.axis[k] = static_cast<float>(axis[k]);
            beam.half_h[k] = static_cast<float>(half_h[k]);
            beam.half_v[k] = static_cast<float>(half_v[k]);
          }
          beam.origin[0] = rays[t].origin_x[i];
          beam.origin[1] = rays[t].origin_y[i];
          beam.origin[2] = rays[t].origin_z[i];
          for (std::size_t k = 0; k < kNumSubRays; ++k) {
            const double radius = std::sqrt((static_cast<double>(k) + 0.5) / kNumSubRays);
            const double turn_rad = 2.4 * static_cast<double>(k);  // A sunflower.
            const Eigen::Vector3f direction =
                (axis + radius * std::cos(turn_rad) * half_h + radius * std::sin(turn_rad) * half_v)
                    .normalized()
                    .cast<float>();
            beam.direction_x[k] = direction.x();
            beam.direction_y[k] = direction.y();
            beam.direction_z[k] = direction.z();
            beam.range_m[k] = 1000.0F;
          }
          scene.CastBeam(beam);
        }
      }
    }));
  }
  return 1e6 * Median(turns_ms) / static_cast<double>(num_beams);
}

/// What the process holds.
double Memory_mb() {
  malloc_trim(0);
  std::ifstream in("/proc/self/statm");
  double num_pages = 0.0;
  double num_resident = 0.0;
  in >> num_pages >> num_resident;
  return num_resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

void MeasureFile(const std::string& file, const MeshBenchOptions& options) {
  ImportedMesh imported;
  const double read_ms = CpuTimeOf_ms(
      [&] { imported = ReadMesh(file, {.unit_m = options.unit_m, .y_up = options.up == "y"}); });
  std::vector<Mesh> parts;
  Mesh whole;  // Materials do not matter here, and a scenario's merge parts of one material.
  for (const NamedMesh& part : imported.parts) whole.Append(part.mesh);
  whole = Subdivided(whole, options.num_times);
  if (options.noise_mm > 0.0) AddNoise(1e-3 * options.noise_mm, whole);
  parts.push_back(std::move(whole));
  const std::vector<RayTile> rays = AllRays(BoxOf(parts));
  const TraceDevice device;
  std::vector<float> exact_m;
  for (const double tolerance_mm : options.tolerances_mm) {
    SimplifiedParts made{.parts = parts};
    const double simplify_ms = CpuTimeOf_ms([&] {
      if (tolerance_mm > 0.0) made = Simplified(parts, {1e-3 * tolerance_mm, options.normal_deg});
    });
    std::unique_ptr<TraceScene> scene;
    const double before_mb = Memory_mb();
    const double prepare_ms = CpuTimeOf_ms([&] { scene = SceneOf(device, made.parts); });
    const double memory_mb = Memory_mb() - before_mb;
    const TracedRanges traced = Traced(*scene, rays);
    if (exact_m.empty()) exact_m = traced.ranges_m;
    double sum2 = 0.0;
    double most_m = 0.0;
    std::size_t num_both = 0;
    std::size_t num_one = 0;
    for (std::size_t i = 0; i < exact_m.size(); ++i) {
      const bool was_hit = exact_m[i] < 999.0F;
      const bool is_hit = traced.ranges_m[i] < 999.0F;
      num_one += was_hit != is_hit ? 1 : 0;
      if (!was_hit || !is_hit) continue;
      const double difference_m = std::abs(static_cast<double>(traced.ranges_m[i] - exact_m[i]));
      sum2 += difference_m * difference_m;
      most_m = std::max(most_m, difference_m);
      ++num_both;
    }
    std::printf("%s\t%g\t%zu\t%.2f\t%.1f\t%.1f\t%.1f\t%.1f\t%.0f\t%.2f\t%.0f\t%.3f\t%.1f\n",
                file.c_str(), tolerance_mm, made.parts[0].triangles.size(), 1e3 * made.deviation_m,
                read_ms, simplify_ms, prepare_ms, traced.ray_ns, BeamTime_ns(*scene, rays),
                1e3 * std::sqrt(sum2 / static_cast<double>(std::max<std::size_t>(1, num_both))),
                1e3 * most_m,
                100.0 * static_cast<double>(num_one) /
                    static_cast<double>(std::max<std::size_t>(1, num_both + num_one)),
                memory_mb);
    std::fflush(stdout);
  }
}

}  // namespace

void AddMeshes(ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions meshes =
      app.AddCommand("meshes", "Measure what simplifying meshes costs and gains");
  const auto options = std::make_shared<MeshBenchOptions>();
  meshes.AddOption("FILE", options->files, "Mesh files").Required().Check(NonEmpty());
  meshes.AddOption("--up", options->up, "Upward axis: y or z").ShowDefault();
  meshes.AddOption("--unit", options->unit_m, "Metres per file unit").ShowDefault();
  meshes.AddOption("--normals", options->normal_deg, "Deviation of normals").ShowDefault();
  meshes.AddOption("--subdivide", options->num_times, "Cut each triangle in four so many times");
  meshes.AddOption("--noise", options->noise_mm, "Of the vertices along their normals, in mm");
  meshes.AddOption("--tolerances", options->tolerances_mm, "In mm; 0 = as the file is")
      .SeparatedBy(',');
  meshes.WhenParsed([options, &command] {
    command = [options](const std::string&) {
      for (const std::string& file : options->files) MeasureFile(file, *options);
      return kExitSuccess;
    };
  });
}

}  // namespace railcast
