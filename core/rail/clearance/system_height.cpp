#include "core/rail/clearance/system_height.h"

#include <algorithm>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kShortestDropper_m = 0.3;

/// Whether the contact line passes below it.
template <class Structure>
constexpr bool kIsAboveTheWire =
    std::is_same_v<Structure, TunnelSpec> || std::is_same_v<Structure, OverbridgeSpec>;

}  // namespace

bool HasContactLine(const WorldSpec& world) {
  return world.catenary.enabled &&
         std::any_of(world.tracks.begin(), world.tracks.end(),
                     [](const TrackSpec& track) { return track.electrified; });
}

double LeastSystemHeight_m(const WorldSpec& world) {
  const CatenarySpec& spec = world.catenary;
  const double sag_m =
      kWireWeight_n_per_m * spec.max_span_m * spec.max_span_m / (8.0 * kMessengerTension_n);
  return sag_m - kContactPresag * spec.max_span_m + kShortestDropper_m;
}

void CheckSystemHeight(const WorldSpec& world) {
  if (!HasContactLine(world)) return;
  const CatenarySpec& spec = world.catenary;
  const double needed_m = LeastSystemHeight_m(world);
  if (spec.system_height_m >= needed_m) return;
  throw InputError({{"/catenary/system_height_m",
                     "must be >= " + NumberText(needed_m) +
                         ", the messenger's sag over max_span_m and a shortest dropper",
                     NumberText(spec.system_height_m)}});
}

double SystemHeightAt_m(const WorldSpec& world, double s_m) {
  const double span_m = world.catenary.max_span_m;
  const bool is_low = std::ranges::any_of(world.structures, [&](const StructureSpec& structure) {
    return std::visit(
        [&]<class Structure>(const Structure& spec) {
          if constexpr (kIsAboveTheWire<Structure>) {
            return s_m > spec.begin_s_m - span_m && s_m < spec.end_s_m + span_m;
          }
          return false;
        },
        structure);
  });
  // Longer spans sag more than the usual ones.
  const double low_m = std::max(kLowSystemHeight_m, LeastSystemHeight_m(world));
  return is_low ? std::min(world.catenary.system_height_m, low_m) : world.catenary.system_height_m;
}

}  // namespace railcast
