#include "core/rail/world/gauge_entries.h"

#include <oneapi/tbb/parallel_for.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/rail/chunk/chunk_grid.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/network/network.h"
#include "core/rail/network/route.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/structures.h"
#include "core/rail/traffic/trains.h"

namespace railcast {
namespace {

/// Probes for all tracks.
class Probes {
 public:
  /// @param own_tracks Names of tracks to leave out.
  /// @param platform If it is one that is probed.
  Probes(const WorldTracks& tracks,
         const Alignment& alignment,
         Asked asked,
         const std::vector<std::string>& own_tracks,
         const PlatformSpec* platform = nullptr)
      : alignment_(alignment) {
    for (std::size_t i = 0; i < tracks.courses.size(); ++i) {
      const std::string& name = tracks.world.tracks[i].name;
      const bool is_own = std::ranges::find(own_tracks, name) != own_tracks.end();
      if (!is_own) probes_.emplace_back(tracks, i, alignment, asked, platform);
    }
  }

  void Add(const Model& model, const Transform& world_from_model, double guess_s_m) {
    for (const Part& part : model.parts) {
      std::vector<ProbedCorner> corners;
      for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
        corners.push_back(
            CornerAt(alignment_, world_from_model * vertex.cast<double>(), guess_s_m));
        guess_s_m = corners.back().s_m;
      }
      const Eigen::AlignedBox2d bounds_m = BoundsOf(corners, part.mesh.triangles);
      for (GaugeProbe& probe : probes_) {
        if (!probe.MayReach(bounds_m)) continue;
        for (const auto& [a, b, c] : part.mesh.triangles) {
          probe.Add({corners[a], corners[b], corners[c]});
        }
      }
    }
  }

  [[nodiscard]] std::size_t num_comparisons() const {
    std::size_t num = 0;
    for (const GaugeProbe& probe : probes_) num += probe.num_comparisons();
    return num;
  }

  void Report(const std::string& name, std::vector<GaugeEntry>& entries) const {
    for (const GaugeProbe& probe : probes_) {
      if (auto entry = probe.Entry(name)) entries.push_back(std::move(*entry));
    }
  }

 private:
  /// In chainage and offset, as far as chords of curves may reach.
  template <class Triangles>
  [[nodiscard]] Eigen::AlignedBox2d BoundsOf(const std::vector<ProbedCorner>& corners,
                                             const Triangles& triangles) const {
    Eigen::AlignedBox2d bounds_m;
    for (const ProbedCorner& corner : corners) {
      bounds_m.extend(Eigen::Vector2d(corner.s_m, corner.d_m));
    }
    double longest_m = 0.0;
    for (const auto& [a, b, c] : triangles) {
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        longest_m = std::max(longest_m, (corners[to].place_m - corners[from].place_m).norm());
      }
    }
    const double sagitta_m = longest_m * longest_m / (8.0 * alignment_.tightest_radius_m());
    bounds_m.min().y() -= sagitta_m;
    bounds_m.max().y() += sagitta_m;
    return bounds_m;
  }

  const Alignment& alignment_;
  std::vector<GaugeProbe> probes_;
};

template <class Structure>
void ProbeStructure(const Structure& structure,
                    const WorldTracks& tracks,
                    const Alignment& alignment,
                    const ChunkGrid& grid,
                    Probes& probes) {
  const RailSurfaces surfaces;
  double first_s_m = 0.0;
  double last_s_m = alignment.length_m();
  if constexpr (std::is_base_of_v<StretchSpec, Structure>) {
    first_s_m = structure.begin_s_m;
    last_s_m = structure.end_s_m;
  } else if constexpr (std::is_base_of_v<PointSpec, Structure>) {
    // It stands in the chunk of its place, and reaches a few metres along the track.
    first_s_m = structure.s_m - RailWorld::kChunkLength_m;
    last_s_m = structure.s_m + RailWorld::kChunkLength_m;
  }
  const int last = grid.ChunkAt(last_s_m);
  for (int chunk = grid.ChunkAt(first_s_m); chunk <= last; ++chunk) {
    const Transform world_from_chunk = grid.WorldFromChunk(chunk);
    const double begin_s_m = grid.BeginOf(chunk);
    const double end_s_m = grid.EndOf(chunk);
    const ChunkContext context{.spec = tracks.world,
                               .alignment = alignment,
                               .tracks = tracks.courses,
                               .turnouts = {},
                               .surfaces = surfaces,
                               .seed = tracks.world.seed,
                               .chunk = chunk,
                               .begin_s_m = begin_s_m,
                               .end_s_m = end_s_m,
                               .chunk_from_world = world_from_chunk.inverse()};
    Chunk built;
    AddStructure(context, structure, built);
    const double middle_s_m = 0.5 * (begin_s_m + end_s_m);
    probes.Add(built.ground, world_from_chunk, middle_s_m);
    for (const Placement& placement : built.placements) {
      Transform chunk_from_model;
      chunk_from_model.matrix() = placement.chunk_from_model.matrix();
      probes.Add(*placement.model, world_from_chunk * chunk_from_model, middle_s_m);
    }
  }
}

/// The structure as it stands; barriers that move, at their lowest.
template <class Structure>
Structure AtRest(Structure structure) {
  if constexpr (std::is_same_v<Structure, LevelCrossingSpec>) {
    std::vector<TimedValue>& angles_deg = structure.barrier_angles_deg;
    if (!angles_deg.empty()) {
      structure.barrier_angle_deg =
          std::ranges::min_element(angles_deg, {}, &TimedValue::value)->value;
      angles_deg.clear();
    }
  }
  return structure;
}

/// Names of the tracks of an object's route on which a wagon there has its wheels.
std::vector<std::string> TracksUnder(const RailWorld& world, std::size_t object, double s_m) {
  constexpr double kHalfWagon_m = 10.0;
  std::vector<std::string> names;
  for (const RouteSection& section : world.object_route(object).sections) {
    if (s_m + kHalfWagon_m < section.begin_s_m || s_m - kHalfWagon_m > section.end_s_m) continue;
    names.push_back(world.tracks()[section.track].name);
  }
  return names;
}

struct ProbedObject {
  std::size_t index{};
  bool is_on_its_track{};
  std::int64_t time_ns{};
};

std::vector<GaugeEntry> EntriesOfObject(const WorldTracks& tracks,
                                        const RailWorld& world,
                                        const ProbedObject& object,
                                        Asked asked) {
  const double s_m = world.ObjectChainage_m(object.index, object.time_ns);
  std::vector<std::string> own_tracks;
  if (object.is_on_its_track) own_tracks = TracksUnder(world, object.index, s_m);
  Probes probes(tracks, world.alignment(), asked, own_tracks);
  const SceneObject& probed = world.objects()[object.index];
  probes.Add(*probed.model, world.WorldFromObject(object.index, object.time_ns), s_m);
  std::vector<GaugeEntry> entries;
  probes.Report(probed.name, entries);
  return entries;
}

}  // namespace

std::vector<GaugeEntry> FindObjectInTheWay(const WorldSpec& given_spec,
                                           const RailWorld& world,
                                           std::size_t object,
                                           bool is_on_its_track,
                                           std::int64_t time_ns) {
  WorldSpec spec = given_spec;
  spec.tracks = world.tracks();
  const WorldTracks tracks{spec, world.network().courses};
  return EntriesOfObject(tracks, world, {object, is_on_its_track, time_ns}, Asked::kWhatIsInTheWay);
}

StructuresInGauge FindStructuresInGauge(const WorldSpec& spec,
                                        const Alignment& alignment,
                                        std::span<const TrackCourse> courses) {
  const WorldTracks tracks{spec, courses};
  const ChunkGrid grid(alignment, RailWorld::kChunkLength_m, spec.terrain.half_width_m);
  std::vector<StructuresInGauge> of_structures(spec.structures.size());
  oneapi::tbb::parallel_for(std::size_t{0}, spec.structures.size(), [&](std::size_t i) {
    std::visit(
        [&]<class Structure>(const Structure& given) {
          std::vector<std::string> own_tracks;
          if (kBelongsIntoGauge<Structure>) own_tracks.push_back(given.track);
          const PlatformSpec* platform = nullptr;
          if constexpr (std::is_same_v<Structure, PlatformSpec>) platform = &given;
          Probes probes(tracks, alignment, Asked::kWhatIsNotClear, own_tracks, platform);
          ProbeStructure(AtRest(given), tracks, alignment, grid, probes);
          probes.Report(given.name, of_structures[i].entries);
          of_structures[i].num_comparisons = probes.num_comparisons();
        },
        spec.structures[i]);
  });
  StructuresInGauge all;
  for (const StructuresInGauge& some : of_structures) {
    all.entries.insert(all.entries.end(), some.entries.begin(), some.entries.end());
    all.num_comparisons += some.num_comparisons;
  }
  return all;
}

std::vector<GaugeEntry> FindGaugeEntries(const WorldSpec& given_spec, const RailWorld& world) {
  WorldSpec spec = given_spec;
  spec.tracks = world.tracks();
  const WorldTracks tracks{spec, world.network().courses};
  std::vector<GaugeEntry> entries =
      FindStructuresInGauge(spec, world.alignment(), world.network().courses).entries;
  const std::size_t num_objects = spec.objects.size();
  for (std::size_t i = 0; i < num_objects + NumVehicles(spec.trains); ++i) {
    if (world.objects()[i].moves) continue;
    // A wagon on its rails is where it belongs, but it may stand foul of another track.
    const bool is_on_its_track =
        i >= num_objects || (IsRailVehicle(spec.objects[i].type) && spec.objects[i].d_m == 0.0);
    for (GaugeEntry& entry :
         EntriesOfObject(tracks, world, {i, is_on_its_track}, Asked::kWhatIsNotClear)) {
      entries.push_back(std::move(entry));
    }
  }
  return entries;
}

}  // namespace railcast
