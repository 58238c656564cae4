#include "tests/bench/peers.h"

#include <dlfcn.h>
#include <embree3/rtcore.h>
#include <open3d/core/Tensor.h>
#include <open3d/t/geometry/RaycastingScene.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <vtkCellArray.h>
#include <vtkCellLocator.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "tests/bench/scene_cost.h"
#include "tests/support/plain_embree.h"

// Takes the place of Embree's function in this program, and calls it.
extern "C" void rtcIntersect1M(RTCScene scene,
                               RTCIntersectContext* context,
                               RTCRayHit* rays,
                               unsigned int num_rays,
                               std::size_t stride) {
  using Function = decltype(&rtcIntersect1M);
  static const auto in_embree = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "rtcIntersect1M"));
  auto* bytes = reinterpret_cast<unsigned char*>(rays);
  for (unsigned int i = 0; i < num_rays; ++i) {
    reinterpret_cast<RTCRayHit*>(bytes + i * stride)->ray.mask = ~0U;
  }
  in_embree(scene, context, rays, num_rays, stride);
}

namespace railcast {
namespace {

constexpr double kSameStructure_s = std::numeric_limits<double>::quiet_NaN();
constexpr float kNoHit_m = std::numeric_limits<float>::infinity();

// Calls job(begin, end) for blocks of rays on so many threads.
template <typename Job>
void ForEachBlock(std::size_t num_rays, int num_threads, const Job& job) {
  const std::size_t num_blocks = (num_rays + kTileSize - 1) / kTileSize;
  const auto do_block = [&](std::size_t block) {
    job(block * kTileSize, std::min(num_rays, (block + 1) * kTileSize));
  };
  if (num_threads == 1) {
    for (std::size_t block = 0; block < num_blocks; ++block) do_block(block);
    return;
  }
  tbb::task_arena arena(num_threads);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, num_blocks, do_block); });
}

/// Adds a peer that traces block by block, on one thread and on all.
class PeerList {
 public:
  PeerList(const PeerScene& scene, int num_threads) : scene_(scene), num_threads_(num_threads) {}

  template <typename Job>
  void AddBlocks(const std::string& name, double build_s, const Job& job) {
    for (const int threads : {1, num_threads_}) {
      Add(name, threads, threads == 1 ? build_s : kSameStructure_s,
          [job, threads, num_rays = scene_.rays.size()](std::span<float> ranges_m) {
            ForEachBlock(num_rays, threads, [&](std::size_t begin, std::size_t end) {
              job(begin, ranges_m.subspan(begin, end - begin));
            });
          });
    }
  }

  void Add(const std::string& name,
           int num_threads,
           double build_s,
           std::function<void(std::span<float>)> trace) {
    peers_.push_back({name, num_threads, build_s, std::move(trace)});
  }

  [[nodiscard]] std::vector<Peer> Take() { return std::move(peers_); }
  [[nodiscard]] const PeerScene& scene() const { return scene_; }
  [[nodiscard]] int num_threads() const { return num_threads_; }

 private:
  const PeerScene& scene_;
  int num_threads_;
  std::vector<Peer> peers_;
};

std::vector<RayTile> TilesOf(std::span<const Ray> rays) {
  std::vector<RayTile> tiles((rays.size() + kTileSize - 1) / kTileSize);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RayTile& tile = tiles[i / kTileSize];
    const std::size_t lane = i % kTileSize;
    tile.num_rays = lane + 1;
    tile.origin_x[lane] = rays[i].origin_m.x();
    tile.origin_y[lane] = rays[i].origin_m.y();
    tile.origin_z[lane] = rays[i].origin_m.z();
    tile.direction_x[lane] = rays[i].direction.x();
    tile.direction_y[lane] = rays[i].direction.y();
    tile.direction_z[lane] = rays[i].direction.z();
    tile.shutter[lane] = 0.0F;
  }
  return tiles;
}

void AddOurs(PeerList& peers) {
  const PeerScene& scene = peers.scene();
  const auto device = std::make_shared<TraceDevice>();
  std::shared_ptr<const TraceScene> built;
  const double build_s = 1e-3 * TimeOf_ms([&] { built = SceneOf(*device, scene.mesh); });
  const auto tiles = std::make_shared<std::vector<RayTile>>(TilesOf(scene.rays));
  const float range_max_m = scene.range_max_m;
  peers.AddBlocks("raw trace", build_s, [=](std::size_t begin, std::span<float> ranges_m) {
    RayTile& tile = (*tiles)[begin / kTileSize];
    std::fill_n(tile.range_m, tile.num_rays, range_max_m);
    built->CastRanges(tile);
    std::copy_n(tile.range_m, ranges_m.size(), ranges_m.begin());
  });
  peers.AddBlocks("railcast", kSameStructure_s,
                  [device, built, &scene](std::size_t begin, std::span<float> ranges_m) {
                    RayHit hits[kTileSize];
                    const std::span<const Ray> rays(&scene.rays[begin], ranges_m.size());
                    CastRays(*built, rays, scene.range_max_m, hits);
                    for (std::size_t i = 0; i < rays.size(); ++i) ranges_m[i] = hits[i].range_m;
                  });
}

void AddEmbree(PeerList& peers, const std::string& name, RTCSceneFlags flags) {
  const PeerScene& scene = peers.scene();
  std::shared_ptr<const PlainEmbree> built;
  const double build_s =
      1e-3 * TimeOf_ms([&] { built = std::make_shared<PlainEmbree>(scene.mesh.parts, flags, 1); });
  peers.AddBlocks(name, build_s, [built, &scene](std::size_t begin, std::span<float> ranges_m) {
    const auto hits = built->Cast({&scene.rays[begin], ranges_m.size()});
    for (std::size_t i = 0; i < hits.size(); ++i) ranges_m[i] = hits[i].range_m;
  });
}

// All parts as one mesh.
Mesh WholeMesh(const Model& model) {
  Mesh mesh;
  for (const Part& part : model.parts) mesh.Append(part.mesh);
  return mesh;
}

void AddOpen3d(PeerList& peers, const Mesh& mesh) {
  namespace core = open3d::core;
  const PeerScene& scene = peers.scene();
  const auto rows = [](std::size_t count) { return static_cast<std::int64_t>(count); };
  const core::Tensor vertices(&mesh.vertices.front().x(), {rows(mesh.vertices.size()), 3},
                              core::Float32);
  const core::Tensor triangles(mesh.triangles.front().data(), {rows(mesh.triangles.size()), 3},
                               core::UInt32);
  std::vector<float> numbers;
  for (const Ray& ray : scene.rays) {
    for (const Eigen::Vector3f& vector : {ray.origin_m, ray.direction}) {
      numbers.insert(numbers.end(), vector.data(), vector.data() + 3);
    }
  }
  const core::Tensor rays(numbers.data(), {rows(scene.rays.size()), 6}, core::Float32);
  const auto built = std::make_shared<open3d::t::geometry::RaycastingScene>();
  const double build_s = 1e-3 * TimeOf_ms([&] {
                           built->AddTriangles(vertices, triangles);
                           built->CastRays(rays);  // The first call builds the tree.
                         });
  for (const int threads : {1, peers.num_threads()}) {
    peers.Add("Open3D, mask repaired", threads, threads == 1 ? build_s : kSameStructure_s,
              [=](std::span<float> ranges_m) {
                const core::Tensor ranges = built->CastRays(rays, threads).at("t_hit");
                std::copy_n(ranges.GetDataPtr<float>(), ranges_m.size(), ranges_m.begin());
              });
  }
}

vtkNew<vtkPolyData> PolyData(const Mesh& mesh) {
  const vtkNew<vtkPoints> points;
  for (const Eigen::Vector3f& vertex : mesh.vertices) points->InsertNextPoint(vertex.data());
  const vtkNew<vtkCellArray> cells;
  for (const auto& triangle : mesh.triangles) {
    cells->InsertNextCell({triangle[0], triangle[1], triangle[2]});
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

// VTK traces the finite line from the sensor to where the ray ends.
struct Line {
  Line(const Ray& ray, float range_max_m) {
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = static_cast<double>(ray.origin_m[axis]);
      to[axis] = from[axis] + static_cast<double>(range_max_m * ray.direction[axis]);
    }
  }
  double from[3], to[3];
};

void AddStaticLocator(PeerList& peers, vtkPolyData* data) {
  const PeerScene& scene = peers.scene();
  const vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(data);
  const double build_s = 1e-3 * TimeOf_ms([&] { locator->BuildLocator(); });
  const vtkSmartPointer<vtkStaticCellLocator> kept = locator;
  peers.AddBlocks("VTK, static cell locator", build_s,
                  [kept, &scene](std::size_t begin, std::span<float> ranges_m) {
                    const vtkNew<vtkGenericCell> cell;
                    for (std::size_t i = 0; i < ranges_m.size(); ++i) {
                      const Line line(scene.rays[begin + i], scene.range_max_m);
                      double t = 0.0, x[3], of_cell[3];
                      int sub_id = 0;
                      vtkIdType id = 0;
                      const bool is_hit = kept->IntersectWithLine(line.from, line.to, 0.0, t, x,
                                                                  of_cell, sub_id, id, cell) != 0;
                      ranges_m[i] = is_hit ? static_cast<float>(t) * scene.range_max_m : kNoHit_m;
                    }
                  });
}

// As tools/virtual_scanner.cpp of PCL 1.13 does, which is not part of Debian's libpcl-dev.
void AddVirtualScanner(PeerList& peers, vtkPolyData* data) {
  const PeerScene& scene = peers.scene();
  const vtkNew<vtkCellLocator> locator;
  locator->SetDataSet(data);
  locator->CacheCellBoundsOn();
  locator->SetTolerance(0.0);
  locator->SetNumberOfCellsPerBucket(1);
  locator->AutomaticOn();
  const double build_s = 1e-3 * TimeOf_ms([&] { locator->BuildLocator(); });
  const vtkSmartPointer<vtkCellLocator> kept = locator;
  peers.Add("PCL's virtual scanner (VTK, cell locator)", 1, build_s,
            [kept, &scene](std::span<float> ranges_m) {
              for (std::size_t i = 0; i < ranges_m.size(); ++i) {
                Line line(scene.rays[i], scene.range_max_m);
                double t = 0.0, x[3], of_cell[3];
                int sub_id = 0;
                vtkIdType id = 0;
                const bool is_hit = kept->IntersectWithLine(line.from, line.to, 0.0, t, x, of_cell,
                                                            sub_id, id) != 0;
                ranges_m[i] = is_hit ? static_cast<float>(t) * scene.range_max_m : kNoHit_m;
              }
            });
}

}  // namespace

std::vector<Peer> MakePeers(const PeerScene& scene, int num_threads) {
  PeerList peers(scene, num_threads);
  AddOurs(peers);
  AddEmbree(peers, "Embree, ray by ray", RTC_SCENE_FLAG_NONE);
  AddEmbree(peers, "Embree, ray by ray, robust", RTC_SCENE_FLAG_ROBUST);
  const Mesh mesh = WholeMesh(scene.mesh);
  AddOpen3d(peers, mesh);
  const vtkNew<vtkPolyData> data = PolyData(mesh);
  AddStaticLocator(peers, data);
  AddVirtualScanner(peers, data);
  return peers.Take();
}

}  // namespace railcast
