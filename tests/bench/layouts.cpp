#include "tests/bench/layouts.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

/// Keeps the rays that a simulator casts.
class RayKeeper final : public RayCaster {
 public:
  void Cast(RayTile& tile) const override { tiles.push_back(tile); }
  mutable std::vector<RayTile> tiles;
};

PlacedKind KindOf(const Placement& placement) {
  if (placement.sway_height_m > 0.0) return PlacedKind::kTree;
  const bool is_grass = std::string_view(placement.model->name).starts_with("grass");
  return is_grass ? PlacedKind::kGrass : PlacedKind::kPiece;
}

Eigen::Affine3d AffineOf(const Transform& transform) {
  return Eigen::Affine3d(transform.matrix());
}

using Corner = std::array<float, 3>;

/// Adds the triangles of a model to a scene, moved as given.
void AttachModel(RTCDevice device,
                 RTCScene scene,
                 const Model& model,
                 const Eigen::Affine3d& scene_from_model) {
  for (const Part& part : model.parts) {
    const Mesh& mesh = part.mesh;
    if (mesh.triangles.empty()) continue;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Corner*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Corner), mesh.vertices.size()));
    std::ranges::transform(mesh.vertices, vertices, [&](const Eigen::Vector3f& vertex) {
      const Eigen::Vector3f moved = (scene_from_model * vertex.cast<double>()).cast<float>();
      return Corner{moved.x(), moved.y(), moved.z()};
    });
    void* const triangles =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(mesh.triangles.front()), mesh.triangles.size());
    std::memcpy(triangles, mesh.triangles.data(),
                mesh.triangles.size() * sizeof(mesh.triangles.front()));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
}

RTCScene NewLaidOutScene(RTCDevice device, RTCBuildQuality quality, RTCSceneFlags flags) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneBuildQuality(scene, quality);
  rtcSetSceneFlags(scene, flags);
  return scene;
}

}  // namespace

LayoutScene MakeLayoutScene(const ScenarioSpec& scenario) {
  const auto simulator = MakeSimulator(scenario, 1);
  const World& world = simulator->world();
  const int home = world.HomeChunk(0);
  const Transform window_from_world = world.WorldFromChunk(home).inverse();
  LayoutScene scene;
  for (const int index : world.ChunksInReach(home, scenario.lidar.range_max_m)) {
    Chunk chunk = world.BuildChunk(index);
    const Eigen::Affine3d window_from_chunk =
        AffineOf(window_from_world * world.WorldFromChunk(index));
    scene.models.push_back({std::make_shared<const Model>(std::move(chunk.ground)),
                            window_from_chunk, PlacedKind::kGround, index});
    for (const Placement& placement : chunk.placements) {
      scene.models.push_back({placement.model, window_from_chunk * placement.chunk_from_model,
                              KindOf(placement), index});
    }
  }
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    if (object.moves || object.is_ego) continue;
    scene.models.push_back({object.model, AffineOf(window_from_world * world.WorldFromObject(i, 0)),
                            PlacedKind::kObject, -1});
  }
  const RayKeeper keeper;
  const std::vector<Surface> no_surfaces(1);
  Frame frame;
  simulator->Scan(0, HostScene{keeper, window_from_world, no_surfaces}, frame);
  scene.rays.tiles = keeper.tiles;
  for (const std::uint32_t firing : simulator->pattern().packet_order) {
    scene.rays.rows.push_back(simulator->pattern().row[firing]);
    scene.rays.columns.push_back(simulator->pattern().column[firing]);
  }
  return scene;
}

OrderedRays FrameRays::In(RayOrder order) const {
  OrderedRays ordered;
  ordered.places.resize(rows.size());
  std::iota(ordered.places.begin(), ordered.places.end(), std::size_t{0});
  if (order == RayOrder::kSquares) {
    ordered.tiles = tiles;
    return ordered;
  }
  const auto& outer = order == RayOrder::kRows ? rows : columns;
  const auto& inner = order == RayOrder::kRows ? columns : rows;
  std::ranges::stable_sort(ordered.places, {},
                           [&](std::size_t ray) { return std::pair(outer[ray], inner[ray]); });
  for (std::size_t ray = 0; ray < ordered.places.size(); ++ray) {
    const std::size_t to = ray % kTileSize;
    if (to == 0) ordered.tiles.emplace_back();
    RayTile& tile = ordered.tiles.back();
    tile.num_rays = to + 1;
    const std::size_t place = ordered.places[ray];
    const RayTile& from = tiles[place / kTileSize];
    for (const auto array :
         {&RayTile::origin_x, &RayTile::origin_y, &RayTile::origin_z, &RayTile::direction_x,
          &RayTile::direction_y, &RayTile::direction_z, &RayTile::shutter}) {
      (tile.*array)[to] = (from.*array)[place % kTileSize];
    }
  }
  return ordered;
}

void OrderedRays::Restore(float range_max_m) {
  for (RayTile& tile : tiles) std::fill_n(tile.range_m, tile.num_rays, range_max_m);
}

std::vector<float> OrderedRays::Ranges_m() const {
  std::vector<float> ranges_m(places.size());
  for (std::size_t ray = 0; ray < places.size(); ++ray) {
    ranges_m[places[ray]] = tiles[ray / kTileSize].range_m[ray % kTileSize];
  }
  return ranges_m;
}

struct LaidOutScene::Memory {
  std::atomic<std::int64_t> bytes{0};

  static bool Count(void* memory, ssize_t bytes, bool /*is_done*/) {
    static_cast<Memory*>(memory)->bytes += bytes;
    return true;
  }
};

RTCScene LaidOutScene::SceneOf(const PlacedModel& placed, const Layout& layout) {
  const auto it =
      std::ranges::find(models_, placed.model.get(), &std::pair<const Model*, RTCScene>::first);
  if (it != models_.end()) return it->second;
  const bool is_plant = (BitOf(placed.kind) & kPlants) != 0;
  RTCScene scene = NewLaidOutScene(device_, is_plant ? layout.plant_quality : layout.quality,
                                   is_plant ? layout.plant_flags : layout.flags);
  AttachModel(device_, scene, *placed.model, Eigen::Affine3d::Identity());
  rtcCommitScene(scene);
  models_.emplace_back(placed.model.get(), scene);
  return scene;
}

void LaidOutScene::AttachInstance(RTCScene model, const Eigen::Affine3d& window_from_model) {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, model);
  const Eigen::Matrix<float, 3, 4> matrix = window_from_model.matrix().topRows<3>().cast<float>();
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
}

LaidOutScene::LaidOutScene(const std::vector<PlacedModel>& models, const Layout& layout)
    : memory_(std::make_unique<Memory>()), device_(rtcNewDevice("")) {
  rtcSetDeviceMemoryMonitorFunction(device_, &Memory::Count, memory_.get());
  const auto build = [&] {
    scene_ = NewLaidOutScene(device_, layout.top_quality, layout.top_flags);
    std::map<std::pair<int, PlacedKind>, std::vector<const PlacedModel*>> baked;
    for (const PlacedModel& placed : models) {
      if ((layout.kinds & BitOf(placed.kind)) == 0) continue;
      if (layout.is_flat) {
        AttachModel(device_, scene_, *placed.model, placed.window_from_model);
      } else if ((layout.baked & BitOf(placed.kind)) != 0) {
        baked[{placed.chunk, placed.kind}].push_back(&placed);
      } else {
        AttachInstance(SceneOf(placed, layout), placed.window_from_model);
      }
    }
    for (const auto& [key, of_chunk] : baked) {
      const bool is_plant = (BitOf(key.second) & kPlants) != 0;
      RTCScene scene = NewLaidOutScene(device_, is_plant ? layout.plant_quality : layout.quality,
                                       is_plant ? layout.plant_flags : layout.flags);
      for (const PlacedModel* placed : of_chunk) {
        AttachModel(device_, scene, *placed->model, placed->window_from_model);
      }
      rtcCommitScene(scene);
      models_.emplace_back(nullptr, scene);
      AttachInstance(scene, Eigen::Affine3d::Identity());
    }
    rtcCommitScene(scene_);
  };
  tbb::task_arena one_thread(1);
  build_s_ = 1e-3 * TimeOf_ms([&] { one_thread.execute(build); });
}

LaidOutScene::~LaidOutScene() {
  rtcReleaseScene(scene_);
  for (const auto& [model, scene] : models_) rtcReleaseScene(scene);
  rtcReleaseDevice(device_);
}

double LaidOutScene::memory_mb() const {
  return 1e-6 * static_cast<double>(memory_->bytes);
}

namespace {

// Lanes [first, first + N) of a tile.
template <unsigned N, typename RayHitN>
void LoadPacket(const RayTile& tile, std::size_t first, RayHitN& packet) {
  constexpr std::size_t kBytes = N * sizeof(float);
  std::memcpy(&packet.ray.org_x, tile.origin_x + first, kBytes);
  std::memcpy(&packet.ray.org_y, tile.origin_y + first, kBytes);
  std::memcpy(&packet.ray.org_z, tile.origin_z + first, kBytes);
  std::memcpy(&packet.ray.dir_x, tile.direction_x + first, kBytes);
  std::memcpy(&packet.ray.dir_y, tile.direction_y + first, kBytes);
  std::memcpy(&packet.ray.dir_z, tile.direction_z + first, kBytes);
  std::memcpy(&packet.ray.time, tile.shutter + first, kBytes);
  std::memcpy(&packet.ray.tfar, tile.range_m + first, kBytes);
  std::memset(&packet.ray.tnear, 0, kBytes);
  std::memset(&packet.ray.flags, 0, kBytes);
  std::memset(&packet.ray.mask, 0xFF, kBytes);
  std::memset(&packet.hit.geomID, 0xFF, kBytes);
  std::memset(&packet.hit.instID, 0xFF, kBytes);
}

template <unsigned N, typename RayHitN, typename Intersect>
void CastPackets(std::vector<RayTile>& tiles, const Intersect& intersect) {
  for (RayTile& tile : tiles) {
    for (std::size_t first = 0; first < tile.num_rays; first += N) {
      alignas(64) RayHitN packet;
      LoadPacket<N>(tile, first, packet);
      intersect(packet);
      std::memcpy(tile.range_m + first, &packet.ray.tfar, N * sizeof(float));
    }
  }
}

}  // namespace

void CastRanges(const LaidOutScene& scene, const CastForm& form, std::vector<RayTile>& tiles) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = form.is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                   : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  RTCScene embree = scene.scene();
  alignas(64) int valid[16];
  std::ranges::fill(valid, -1);
  switch (form.width) {
    case 16:
      return CastPackets<16, RTCRayHit16>(
          tiles, [&](RTCRayHit16& rays) { rtcIntersect16(valid, embree, &context, &rays); });
    case 8:
      return CastPackets<8, RTCRayHit8>(
          tiles, [&](RTCRayHit8& rays) { rtcIntersect8(valid, embree, &context, &rays); });
    case 4:
      return CastPackets<4, RTCRayHit4>(
          tiles, [&](RTCRayHit4& rays) { rtcIntersect4(valid, embree, &context, &rays); });
    default:
      return CastPackets<1, RTCRayHit>(
          tiles, [&](RTCRayHit& ray) { rtcIntersect1(embree, &context, &ray); });
  }
}

}  // namespace railcast
