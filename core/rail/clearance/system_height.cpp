#include "core/rail/clearance/system_height.h"

#include <algorithm>
#include <type_traits>

#include "core/rail/catenary/catenary_plan.h"

namespace railcast {
namespace {

/// Whether the contact line passes below it.
template <class Structure>
constexpr bool kIsAboveTheWire =
    std::is_same_v<Structure, TunnelSpec> || std::is_same_v<Structure, OverbridgeSpec>;

}  // namespace

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
