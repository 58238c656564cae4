#include "generator/extras/insert/screens.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

// Sub-ray i belongs to this sixteenth of its beam: neighbours are as far apart as can be.
constexpr std::array<std::uint32_t, kScreenParts> kPartOfRay{0, 8, 4, 12, 2, 10, 6, 14,
                                                             1, 9, 5, 13, 3, 11, 7, 15};

constexpr float kNever_m = std::numeric_limits<float>::infinity();

}  // namespace

ScreenParts PartsOf(std::span<const Screen> screens) {
  Check(screens.size() <= kMostScreens, "a firing has few recorded returns");
  ScreenParts parts{};
  if (screens.empty()) return parts;
  float total = 0.0F;
  for (const Screen& screen : screens) total += screen.intensity;
  const auto taken =
      static_cast<std::uint32_t>(screens.front().share * static_cast<float>(kScreenParts) + 0.5F);
  std::uint32_t left = std::clamp(taken, static_cast<std::uint32_t>(screens.size()), kScreenParts);
  const auto all = static_cast<float>(left);
  std::size_t largest = 0;
  for (std::size_t i = 0; i < screens.size(); ++i) {
    const float share =
        total > 0.0F ? screens[i].intensity / total : 1.0F / static_cast<float>(screens.size());
    const auto rounded = static_cast<std::uint32_t>(share * all + 0.5F);
    const auto others = static_cast<std::uint32_t>(screens.size() - i - 1);
    parts[i] = std::clamp(rounded, 1U, left - others);
    left -= parts[i];
    if (parts[i] > parts[largest]) largest = i;
  }
  parts[largest] += left;
  return parts;
}

Screens::Screens(std::vector<std::uint32_t> first, std::vector<Screen> screens)
    : first_(std::move(first)), screens_(std::move(screens)) {
  Check(!first_.empty() && first_.back() == screens_.size(), "every screen is of a firing");
  met_.resize(num_firings());
}

void Screens::Meet(const std::uint32_t* firings, std::size_t num, RayTile& rays) const {
  for (std::size_t i = 0; i < num; ++i) {
    const std::uint32_t firing = firings[i];
    for (const Screen& screen : of(firing)) {
      if (!(screen.range_m + screen.back_m < rays.range_m[i])) continue;
      rays.range_m[i] = screen.range_m + screen.back_m;
      rays.surface[i] = screen.surface;
      rays.normal_x[i] = -rays.direction_x[i];
      rays.normal_y[i] = -rays.direction_y[i];
      rays.normal_z[i] = -rays.direction_z[i];
    }
    const bool is_own = rays.surface[i] != 0 && std::ranges::any_of(of(firing), [&](auto& screen) {
                          return screen.surface == rays.surface[i];
                        });
    if (rays.surface[i] != 0 && !is_own) met_[firing] = rays.surface[i];
  }
}

void Screens::Meet(std::uint32_t firing, BeamRays& beam) const {
  const std::span<const Screen> screens = of(firing);
  constexpr std::uint32_t kFree = kMostScreens;
  std::array<std::uint32_t, kScreenParts> screen_of_part;
  screen_of_part.fill(kFree);
  const ScreenParts parts = PartsOf(screens);
  std::uint32_t part = 0;
  for (std::uint32_t k = 0; k < screens.size(); ++k) {
    for (std::uint32_t n = 0; n < parts[k]; ++n) screen_of_part[part++] = k;
  }
  std::array<std::uint32_t, kMostScreens> facet_of{};  // 0 = not added yet.
  for (std::size_t i = 0; i < beam.num_rays; ++i) {
    const std::uint32_t k = screen_of_part[kPartOfRay[i % kScreenParts]];
    const float range_m = k == kFree ? kNever_m : screens[k].range_m + screens[k].back_m;
    if (!(range_m < beam.range_m[i])) {
      if (beam.facet[i] != 0) met_[firing] = beam.facets[beam.facet[i]].surface;
      continue;
    }
    if (facet_of[k] == 0) {
      Check(beam.num_facets < BeamRays::kMaxFacets, "a beam has room for the facets of screens");
      facet_of[k] = beam.num_facets++;
      beam.facets[facet_of[k]] = {screens[k].surface, -beam.axis[0], -beam.axis[1], -beam.axis[2]};
    }
    beam.range_m[i] = range_m;
    beam.facet[i] = facet_of[k];
  }
}

}  // namespace railcast
