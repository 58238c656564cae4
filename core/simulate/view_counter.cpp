#include "core/simulate/view_counter.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/trace/beam_tile.h"

namespace railcast {
namespace {

static_assert(kNumCrowdedSubRays == kPacketSize, "a beam's rays are one packet");

void ForgetHits(RayTile& rays, float range_max_m) {
  std::fill_n(rays.range_m, kPacketSize, range_max_m);
  std::fill_n(rays.surface, kPacketSize, 0U);
}

// The packet stays as it is traced for the frame, so that its rays hit the same.
void CopyPacket(const RayTile& from, std::size_t first, RayTile& to) {
  const auto copy = [&](auto member) {
    std::copy_n(from.*member + first, kPacketSize, to.*member);
  };
  for (const auto member :
       {&RayTile::origin_x, &RayTile::origin_y, &RayTile::origin_z, &RayTile::direction_x,
        &RayTile::direction_y, &RayTile::direction_z, &RayTile::shutter}) {
    copy(member);
  }
}

}  // namespace

ViewCounter::ViewCounter(const CastFrame& frame, const World& world, std::vector<LoneObjects> alone)
    : frame_(frame),
      objects_(world.objects()),
      alone_(std::move(alone)),
      counts_(world.objects().size()) {}

void ViewCounter::Add(const BeamTracer& tracer,
                      const FiringTiles& tiles,
                      std::size_t tile,
                      BeamTracer::Work& work) {
  if (alone_.empty()) return;
  tracer.AimCenters(frame_, tiles, tile, work);
  const std::size_t num_firings = tiles.num_firings(tile);
  if (!tracer.has_wide_beams()) {
    AddCenters(work, tracer.range_max_m(), num_firings, false);
    return;
  }
  Packet packet;
  packet.rays.num_rays = kPacketSize;
  packet.rays.mask = kAllSurfaces;
  packet.is_one_beam = true;
  packet.lanes = (1U << kPacketSize) - 1U;
  const BeamFrame beam_frame = tracer.BeamFrameOf(frame_);
  BeamRays beam;
  for (std::size_t lane = 0; lane < num_firings; ++lane) {
    tracer.AimSubRays(work, beam_frame, lane, beam);
    CopySubRays(beam, kPacketSize, packet.rays);
    ForgetHits(packet.rays, tracer.range_max_m());
    packet.firings.fill(work.echoes.first.firing[lane]);
    if (!FindAlone(packet)) continue;
    Cast(packet);
    Count(packet);
  }
}

void ViewCounter::AddTraced(const BeamTracer& tracer,
                            const FiringTiles& tiles,
                            std::size_t tile,
                            BeamTracer::Work& work) {
  if (!tracer.casts_all_centers()) {
    Add(tracer, tiles, tile, work);
  } else if (!alone_.empty()) {
    AddCenters(work, tracer.range_max_m(), tiles.num_firings(tile), true);
  }
}

void ViewCounter::AddCenters(const BeamTracer::Work& work,
                             float range_max_m,
                             std::size_t num_firings,
                             bool are_known) {
  Packet packet;
  packet.rays.num_rays = kPacketSize;
  packet.rays.mask = kAllSurfaces;
  packet.is_one_beam = false;
  for (std::size_t first = 0; first < num_firings; first += kPacketSize) {
    packet.lanes = (1U << std::min(kPacketSize, num_firings - first)) - 1U;
    CopyPacket(work.rays, first, packet.rays);
    std::copy_n(work.echoes.first.firing + first, kPacketSize, packet.firings.begin());
    ForgetHits(packet.rays, range_max_m);
    if (!FindAlone(packet)) continue;
    if (are_known) {
      std::copy_n(work.rays.surface + first, kPacketSize, packet.rays.surface);
    } else {
      Cast(packet);
    }
    Count(packet);
  }
}

bool ViewCounter::FindAlone(Packet& packet) const {
  packet.hits.clear();
  for (const LoneObjects& objects : alone_) objects.AddHits(packet.rays, 0, packet.hits);
  return !packet.hits.empty();
}

void ViewCounter::Cast(Packet& packet) const {
  frame_.caster.Cast(packet.rays);
  if (frame_.besides == nullptr) return;
  // The lanes beyond hold what was there before them, maybe firings of a longer frame.
  const auto num_firings = static_cast<std::size_t>(std::popcount(packet.lanes));
  frame_.besides->Meet(packet.firings.data(), num_firings, packet.rays);
}

void ViewCounter::Count(const Packet& packet) {
  for (const ObjectHits& hit : packet.hits) {
    const std::uint32_t alone = hit.lanes & packet.lanes;
    if (alone == 0) continue;
    std::uint32_t visible = 0;
    for (std::uint32_t rest = alone; rest != 0; rest &= rest - 1U) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      const Surface& first = frame_.surfaces[packet.rays.surface[lane]];
      if (first.instance == objects_[hit.object].instance) visible |= 1U << lane;
    }
    const auto count = [&](std::uint32_t lanes) {
      return static_cast<std::uint32_t>(std::popcount(lanes));
    };
    const auto firings = [&](std::uint32_t lanes) {
      return packet.is_one_beam ? std::min(lanes, 1U) : count(lanes);
    };
    Counts& counts = counts_[hit.object];
    counts.firings_alone += firings(alone);
    counts.firings_visible += firings(visible);
    counts.rays_alone += count(alone);
    counts.rays_visible += count(visible);
  }
}

std::vector<ObjectView> ViewCounter::Total() const {
  std::vector<ObjectView> views;
  for (const Counts& counts : counts_) {
    views.push_back(
        {counts.firings_alone, counts.firings_visible, counts.rays_alone, counts.rays_visible});
  }
  return views;
}

}  // namespace railcast
