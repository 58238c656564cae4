#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/base/out_of_memory.h"
#include "core/simulate/beams_near_objects.h"
#include "core/simulate/simulator_parts.h"

namespace railcast {
namespace {

// In tracing order, all firings of those packets in which one is near: so each is traced as in a
// whole frame, to the last bit.
std::vector<std::uint32_t> PacketsWith(const ScanPattern& pattern,
                                       std::span<const std::uint32_t> near) {
  std::vector<bool> is_near(pattern.num_firings());
  for (const std::uint32_t firing : near) is_near[firing] = true;
  std::vector<std::uint32_t> firings;
  for (std::size_t begin = 0; begin < pattern.num_firings(); begin += kPacketSize) {
    const std::size_t end = std::min(begin + kPacketSize, pattern.num_firings());
    const auto first = pattern.packet_order.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = pattern.packet_order.begin() + static_cast<std::ptrdiff_t>(end);
    const bool is_wanted = std::any_of(first, last, [&](std::uint32_t i) { return is_near[i]; });
    if (is_wanted) firings.insert(firings.end(), first, last);
  }
  return firings;
}

// As of beams that meet nothing.
void ClearSlots(Frame& frame) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    ClearSlot(slot, frame);
    if (slot % frame.returns == 0) frame.outcome[slot] = Outcome::kNoSurface;
  }
  std::ranges::fill(frame.mixed_share, std::numeric_limits<float>::quiet_NaN());
  std::ranges::fill(frame.return_count, std::uint8_t{0});
}

BeamReach ReachInFrame(const SimulatorSpec& spec, std::int64_t stamp_ns) {
  return {.stamp_ns = stamp_ns,
          .vehicle_from_sensor = spec.vehicle_from_sensor * spec.nominal_from_true,
          .range_max_m = spec.detector.range_max_m};
}

}  // namespace

void Simulator::ScanNearObjects(BegunFrame& begun,
                                std::span<const std::size_t> objects,
                                Frame& frame) {
  Parts& parts = *parts_;
  // A halo reaches any beam.
  if (parts.own->halo) return Scan(begun, frame);
  WithinMemory(parts.Making(begun.index), [&] {
    const ScanPattern& pattern = parts.PatternOf(begun);
    const NearObjects near(world(), objects, pattern, ReachInFrame(parts.spec, begun.stamp_ns));
    const FiringTiles& all = parts.TilesOf(begun);
    frame.has_velocity = parts.spec.detector.velocity.has_value();
    parts.Prepare(begun.index, all, frame);
    frame.Resize(pattern.rows, pattern.columns, NumReturns(parts.own->return_mode()));
    ClearSlots(frame);
    std::vector<std::uint32_t> order =
        PacketsWith(pattern, near.Beams(BesideBeam_rad(parts.spec.detector)));
    if (!order.empty()) {
      const FiringTiles firings(pattern, std::move(order));
      const FrameScene& scene = parts.SceneOf(begun);
      parts.Fill(*parts.own, parts.CastOf(*parts.own, scene, firings), firings, frame);
    }
    all.StoreConstants(frame);
  });
}

std::vector<std::uint32_t> Simulator::FiringsNearObjects(
    BegunFrame& begun, std::span<const std::size_t> objects) const {
  Parts& parts = *parts_;
  double beside_rad = BesideBeam_rad(parts.spec.detector);
  parts.MakeOthers();
  for (const Detection& other : parts.others) {
    beside_rad = std::max(beside_rad, BesideBeam_rad(other.detector));
  }
  return WithinMemory(parts.Making(begun.index), [&] {
    const ScanPattern& pattern = parts.PatternOf(begun);
    const NearObjects near(world(), objects, pattern, ReachInFrame(parts.spec, begun.stamp_ns));
    std::vector<std::uint32_t> cells = near.Beams(beside_rad);
    for (std::uint32_t& cell : cells) {
      cell = pattern.row[cell] * pattern.columns + pattern.column[cell];
    }
    std::ranges::sort(cells);
    return cells;
  });
}

}  // namespace railcast
