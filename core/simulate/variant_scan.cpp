#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/simulate/simulator_parts.h"

namespace railcast {

void Simulator::Parts::MakeOthers() {
  const std::scoped_lock lock(others_mutex);
  if (others.size() == variants.size()) return;
  for (const FiringVariant& variant : variants) {
    SimulatorSpec varied = spec;
    varied.detector.effects = variant.effects;
    varied.detector.beam.footprint_rays = variant.footprint_rays;
    if (!variant.has_footprint_of) varied.detector.footprint_labels.clear();
    others.emplace_back(varied, materials, pattern);
    // What meets a beam from beside it is found by the beams around it, which are not traced here.
    others.back().halo.reset();
  }
}

void Simulator::UseVariants(std::vector<FiringVariant> variants) {
  Parts& parts = *parts_;
  parts.variants = std::move(variants);
  parts.others.clear();
  parts.MakeOthers();
  if (!std::ranges::any_of(parts.variants, &FiringVariant::has_full_detail)) {
    parts.full_scenes.reset();
  } else if (parts.full_scenes == nullptr && !parts.scenes.has_full_detail()) {
    parts.full_scenes = parts.scenes.InFullDetail();
  }
  parts.PrepareScenes();
}

void Simulator::ScanFirings(BegunFrame& begun,
                            std::span<const std::uint32_t> cells,
                            std::span<Frame> frames) {
  Parts& parts = *parts_;
  parts.MakeOthers();
  Check(frames.size() == parts.others.size(), "there is a frame for each variant");
  Check(!cells.empty() && std::ranges::is_sorted(cells), "cells are in order");
  WithinMemory(parts.Making(begun.index), [&] {
    const ScanPattern& pattern = parts.PatternOf(begun);
    const FiringTiles firings = FiringTiles::OfCells(pattern, cells);
    const FrameScene& own_scene = parts.SceneOf(begun);
    BegunFrame full;
    if (parts.full_scenes != nullptr) {
      parts.arena.execute([&] {
        full = parts.full_scenes->Begin(begun.index, begun.stamp_ns);
        static_cast<void>(parts.full_scenes->SceneOf(full));
      });
    }
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const bool is_full = parts.variants[i].has_full_detail && full.scene != nullptr;
      const FrameScene& scene = is_full ? *full.scene : own_scene;
      const Detection& by = parts.others[i];
      Frame& frame = frames[i];
      frame.has_velocity = false;
      parts.Prepare(begun.index, firings, frame);
      frame.Resize(1, static_cast<std::uint32_t>(cells.size()), NumReturns(by.return_mode()));
      parts.Fill(by, parts.CastOf(by, scene, firings), firings, frame);
    }
  });
}

}  // namespace railcast
