#include "generator/check/scene_audit.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "core/simulate/detail_choice.h"
#include "railcast/lidar.h"
#include "railcast/simulator.h"

namespace railcast {
namespace {

void AddMaterials(const Model& model, const MaterialLibrary& library, std::set<std::string>& used) {
  for (const Part& part : model.parts) used.insert(library.materials().at(part.material).name);
}

// Scans all directions within one microsecond.
ScanPattern AllAround() {
  return BuildScanPattern({1e6, RasterSpec{360.0, 180.0, 1.0, RasterOrder::kColumns}});
}

// Returns the nearest surface among a frame's slots in [begin, end).
std::optional<SightedSurface> NearestOf(const Frame& frame, std::size_t begin, std::size_t end) {
  std::optional<SightedSurface> nearest;
  for (std::size_t slot = begin; slot < end; ++slot) {
    const auto range_m = static_cast<double>(frame.true_range_m[slot]);
    if (range_m < (nearest ? nearest->range_m : std::numeric_limits<double>::infinity())) {
      nearest = {range_m, frame.label[slot], frame.instance[slot]};
    }
  }
  return nearest;
}

}  // namespace

std::vector<BuiltChunk> BuildChunksInReach(const World& world,
                                           std::int64_t time_ns,
                                           double range_m) {
  const std::vector<int> indices = world.ChunksInReach(world.HomeChunk(time_ns), range_m);
  std::vector<BuiltChunk> chunks(indices.size());
  oneapi::tbb::parallel_for(std::size_t{0}, indices.size(), [&](std::size_t i) {
    chunks[i] = {indices[i], world.BuildChunk(indices[i])};
  });
  return chunks;
}

SceneAudit AuditScene(const World& world,
                      const MaterialLibrary& materials,
                      std::int64_t time_ns,
                      std::span<const BuiltChunk> chunks) {
  SceneAudit audit;
  audit.home_chunk = world.HomeChunk(time_ns);
  std::set<std::shared_ptr<const Model>> models;
  for (const auto& [index, chunk] : chunks) {
    ++audit.num_chunks;
    audit.ground_triangles += chunk.ground.num_triangles();
    AddMaterials(chunk.ground, materials, audit.materials);
    for (const Placement& placement : chunk.placements) {
      ++audit.num_placements;
      audit.placed_triangles += placement.model->num_triangles();
      models.insert(placement.model);
    }
  }
  for (const auto& model : models) {
    audit.model_triangles += model->num_triangles();
    AddMaterials(*model, materials, audit.materials);
  }
  audit.num_models = models.size();
  for (const SceneObject& object : world.objects()) {
    audit.object_triangles += object.model->num_triangles();
    AddMaterials(*object.model, materials, audit.materials);
  }
  return audit;
}

DetailAudit AuditDetail(const World& world,
                        std::int64_t time_ns,
                        std::span<const BuiltChunk> chunks,
                        const DetailRule& rule) {
  DetailAudit audit;
  if (!(rule.ray_spacing_rad > 0.0)) return audit;
  const int home_chunk = world.HomeChunk(time_ns);
  const Transform window_from_world = world.WorldFromChunk(home_chunk).inverse();
  DetailChoice choice(world, home_chunk, rule);
  std::vector<std::pair<int, std::size_t>> coarser_chunks;  // With their levels.
  for (const auto& [index, chunk] : chunks) {
    const Eigen::Affine3d window_from_chunk(
        (window_from_world * world.WorldFromChunk(index)).matrix());
    const std::size_t surface_level = choice.LevelOf(
        world.CoarserSurfacesOf(index), window_from_world * world.WorldFromChunk(index));
    ++audit.num_chunks;
    audit.full_surfaces += chunk.ground.num_triangles();
    if (surface_level > 0) {
      coarser_chunks.emplace_back(index, surface_level);
    } else {
      audit.traced_surfaces += chunk.ground.num_triangles();
    }
    for (const Placement& placement : chunk.placements) {
      if (placement.coarser == nullptr) continue;
      const Eigen::Affine3d window_from_model = window_from_chunk * placement.chunk_from_model;
      const std::size_t level = choice.LevelOf(placement, window_from_model);
      const double distance_m = choice.Distance_m(placement, window_from_model);
      audit.full_triangles += placement.model->num_triangles();
      audit.traced_triangles += ModelAt(placement, level)->num_triangles();
      const auto [found, is_new] = audit.levels[placement.model->parts.front().label].try_emplace(
          level, DetailAudit::Level{0, distance_m});
      ++found->second.num_placements;
      found->second.nearest_m = std::min(found->second.nearest_m, distance_m);
    }
  }
  std::vector<std::size_t> coarser_triangles(coarser_chunks.size());
  oneapi::tbb::parallel_for(std::size_t{0}, coarser_chunks.size(), [&](std::size_t i) {
    const auto& [index, level] = coarser_chunks[i];
    coarser_triangles[i] = world.BuildCoarserChunk(index, level).ground.num_triangles();
  });
  audit.num_coarser_chunks = coarser_chunks.size();
  for (const std::size_t num_triangles : coarser_triangles) audit.traced_surfaces += num_triangles;
  return audit;
}

SensorSurroundings LookAround(const std::shared_ptr<const World>& world,
                              const MaterialLibrary& materials,
                              const Vector3& position_vehicle,
                              double range_m) {
  SimulatorSpec spec;
  spec.detector.range_min_m = 0.0;
  spec.detector.range_max_m = range_m;
  spec.vehicle_from_sensor =
      MakeTransform(world->WorldFromVehicle(0).linear().transpose(), position_vehicle);
  Simulator simulator(world, AllAround(), materials, spec, 0);
  Frame frame;
  simulator.Scan(0, frame);

  SensorSurroundings around;
  around.position_world = frame.world_from_sensor.translation();
  around.nearest = NearestOf(frame, 0, frame.num_slots());
  around.below = NearestOf(frame, 0, frame.width());
  around.above = NearestOf(frame, frame.num_slots() - frame.width(), frame.num_slots());
  const std::uint32_t first = frame.instance.front();
  const auto is_first = [&](std::uint32_t instance) { return instance == first; };
  if (std::all_of(frame.instance.begin(), frame.instance.end(), is_first)) around.inside = first;
  return around;
}

OwnHits CountOwnHits(const std::shared_ptr<const World>& world,
                     const MaterialLibrary& materials,
                     const ScanPattern& pattern,
                     const Transform& vehicle_from_sensor,
                     double range_m) {
  if (std::ranges::none_of(world->objects(), &SceneObject::is_ego)) return {};
  OwnHits hits{pattern.num_firings(), 0};
  SimulatorSpec spec;
  spec.detector.range_min_m = 0.0;
  spec.detector.range_max_m = range_m;
  spec.vehicle_from_sensor = vehicle_from_sensor;
  Simulator simulator(world, pattern, materials, spec, 0);
  Frame frame;
  simulator.Scan(0, frame);
  hits.num_on_vehicle = static_cast<std::size_t>(std::ranges::count(frame.outcome, Outcome::kEgo));
  return hits;
}

std::vector<ContactRun> FindContactRuns(const World& world,
                                        const ScanPattern& pattern,
                                        std::uint32_t last_frame) {
  ContactFinder finder(world);
  std::vector<ContactRun> runs;
  // The run of each pair that is in contact in the latest frame, as an index.
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> open;
  for (std::uint32_t frame = 0;; ++frame) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> still_open;
    for (const ObjectContact& contact : finder.FindAll(pattern.StampNs(frame))) {
      const std::pair pair{contact.one, contact.other};
      const auto known = open.find(pair);
      const std::size_t index = known == open.end() ? runs.size() : known->second;
      if (known == open.end()) runs.push_back({frame, frame, frame, contact});
      ContactRun& run = runs[index];
      run.last_frame = frame;
      if (contact.gap_m < run.nearest.gap_m) {
        run.nearest = contact;
        run.nearest_frame = frame;
      }
      still_open.emplace(pair, index);
    }
    open = std::move(still_open);
    if (frame == last_frame) return runs;
    if (AreStillBetween(world, pattern.StampNs(frame), pattern.StampNs(last_frame))) break;
  }
  for (const auto& [pair, index] : open) runs[index].last_frame = last_frame;
  return runs;
}

}  // namespace railcast
