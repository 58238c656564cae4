#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/detect/base/echo_tiles.h"
#include "core/detect/detector/effect_table.h"
#include "core/simulate/returns.h"
#include "core/simulate/simulator_parts.h"
#include "railcast/ray_caster.h"
#include "railcast/simulator.h"

namespace railcast {
namespace {

/// Adds the echoes of one firing to its story, with the slots of those that become returns.
/// @param beam A lane of `echoes.first`.
/// @pre story.slot is set.
void TellEchoes(const std::vector<Surface>& surfaces,
                const ReturnRule& rule,
                std::size_t beam,
                EchoTiles& echoes,
                FiringStory& story) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const auto returns = ReturnsOf(rule, echoes, beam);
  for (const auto& [tile, lane] : EchoesOf(echoes, beam)) {
    const bool is_clutter = tile.clutter[lane] != kNoClutter;
    story.echoes.push_back(
        {.label = is_clutter ? tile.clutter[lane] : surfaces[tile.surface[lane]].label,
         .true_range_m = tile.true_range_m[lane],
         .range_m = tile.range_m[lane],
         .power_ratio = tile.power_ratio[lane],
         .footprint_share = tile.surface[lane] != 0 ? tile.share[lane] : kNaN,
         .outcome = static_cast<Outcome>(tile.outcome[lane]),
         .slot = {}});
    for (std::uint32_t r = 0; r < returns.size(); ++r) {
      const bool is_this = &returns[r].tile == &tile && returns[r].lane == lane;
      if (is_this) story.echoes.back().slot = story.slot + r;
    }
  }
}

}  // namespace

FiringStory Simulator::Explain(std::uint32_t frame_index, std::uint32_t firing) {
  Parts& parts = *parts_;
  BegunFrame begun = parts.Begin(frame_index);
  const FrameScene& scene = parts.SceneOf(begun);
  const FiringTiles& firings = parts.TilesOf(begun);
  const CastFrame cast = parts.CastOf(*parts.own, scene, firings);
  const FiringTiles::Place place = firings.PlaceOf(firing);
  const std::size_t tile = place.tile;
  const std::size_t lane = place.lane;
  BeamTracer::Work work(*parts.own->tracer);
  DetectTile& first = work.echoes.first;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (float* unknown : {first.intensity, first.power_ratio, first.range_m}) {
    std::fill_n(unknown, kTileSize, kNaN);
  }
  FiringStory story;
  std::size_t num_echoes = 1;
  const auto record = [&](std::string_view effect) {
    const std::size_t num_before = std::exchange(num_echoes, EchoesOf(work.echoes, lane).size());
    story.steps.push_back({.effect = std::string(effect),
                           .outcome = static_cast<Outcome>(first.outcome[lane]),
                           .true_range_m = first.true_range_m[lane],
                           .cos_incidence = first.cos_incidence[lane],
                           .intensity = first.intensity[lane],
                           .power_ratio = first.power_ratio[lane],
                           .range_m = first.range_m[lane],
                           .num_added_echoes = num_echoes - num_before});
  };
  parts.own->tracer->MakeEchoes(cast, firings, tile, work, record);
  const RayTile& rays = work.rays;
  if (parts.own->halo) {
    parts.own->halo->AddEchoes(work.echoes, parts.FindHaloSources(cast, firings));
    record(EffectBetweenBeams(spec().detector)->name);
  }
  const Transform world_from_window = scene.window->window_from_world.inverse();
  const double time_s = SecondsFromNs(parts.pattern.StampNs(frame_index));
  parts.own->tracer->detector().Detect({rays, world_from_window, time_s}, work.echoes, record);
  const Surface& surface = scene.surfaces()[first.surface[lane]];
  story.firing = firing;
  story.time_ns = firings.times_ns(tile)[lane];
  story.slot = firings.slots(tile)[lane] * NumReturns(parts.own->return_mode());
  story.direction_sensor = Vector3(static_cast<double>(first.direction_x[lane]),
                                   static_cast<double>(first.direction_y[lane]),
                                   static_cast<double>(first.direction_z[lane]));
  story.origin_world = world_from_window * Vector3(static_cast<double>(rays.origin_x[lane]),
                                                   static_cast<double>(rays.origin_y[lane]),
                                                   static_cast<double>(rays.origin_z[lane]));
  story.label = surface.label;
  story.instance = surface.instance;
  story.material = surface.material;
  story.reflectivity = surface.reflectivity;
  TellEchoes(scene.surfaces(), parts.own->return_rule(), lane, work.echoes, story);
  return story;
}

}  // namespace railcast
