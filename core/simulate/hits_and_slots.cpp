#include "core/simulate/hits_and_slots.h"

#include <limits>

#include "core/frame/outcome.h"

namespace railcast {

void ResolveHits(const RayTile& rays, const std::vector<Surface>& surfaces, DetectTile& detect) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < rays.num_rays; ++i) {
    const Surface& surface = surfaces[rays.surface[i]];
    const bool hit = rays.surface[i] != 0;
    const Outcome outcome = !hit             ? Outcome::kNoSurface
                            : surface.is_ego ? Outcome::kEgo
                                             : Outcome::kReturned;
    detect.true_range_m[i] = hit ? rays.range_m[i] : kNaN;
    detect.cos_incidence[i] = hit ? rays.cos_incidence[i] : kNaN;
    detect.reflectivity[i] = hit ? surface.reflectivity : kNaN;
    detect.outcome[i] = static_cast<std::uint32_t>(outcome);
  }
}

void StoreReturns(const RayTile& rays,
                  const DetectTile& detect,
                  const SurfaceNames& names,
                  const SlotRange& slots,
                  Frame& frame) {
  for (std::size_t i = 0; i < slots.num_firings; ++i) {
    const std::size_t slot = slots.slots[i];
    const auto outcome = static_cast<Outcome>(detect.outcome[i]);
    const Surface& surface = names.surfaces[rays.surface[i]];
    const bool is_flake = detect.is_flake[i] != 0;
    frame.x[slot] = detect.x[i];
    frame.y[slot] = detect.y[i];
    frame.z[slot] = detect.z[i];
    frame.intensity[slot] = detect.intensity[i];
    frame.power_ratio[slot] = detect.power_ratio[i];
    frame.range_m[slot] = detect.range_m[i];
    frame.true_range_m[slot] = detect.true_range_m[i];
    frame.outcome[slot] = outcome;
    frame.return_count[slot] = HasPoint(outcome) ? 1 : 0;
    frame.label[slot] = is_flake ? names.snow_label : surface.label;
    frame.instance[slot] = is_flake ? 0 : surface.instance;
    frame.material[slot] = is_flake ? std::uint16_t{0} : surface.material;
    frame.incidence_rad[slot] =
        is_flake ? std::numeric_limits<float>::quiet_NaN() : detect.incidence_rad[i];
  }
}

}  // namespace railcast
