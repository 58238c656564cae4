#include "core/detect/clutter/ghost.h"

#include <array>

#include "core/detect/base/beam_optics.h"
#include "core/detect/clutter/added_echo.h"
#include "core/detect/clutter/bright_echo.h"

namespace railcast {
namespace {

// An echo weaker than a third of the threshold is detected in at most one case of 1000.
constexpr float kLeastGhostRatio = 0.3F;

}  // namespace

Ghost::Ghost(const DetectorSpec& spec)
    : label_(spec.clutter_labels.ghost),
      power_min_(static_cast<float>(LeastPower(spec.receiver))),
      range_min_m_(static_cast<float>(spec.range_min_m)) {
  if (!spec.effects.ghost) return;
  const double radius_m = 0.5e-3 * spec.cover.aperture_mm;
  gain_ = static_cast<float>(spec.receiver.ghost_reflectance * radius_m * radius_m *
                             LeastPower(spec.receiver));
}

void Ghost::AddEchoes(EchoTiles& echoes) const {
  if (!is_on()) return;
  std::array<float, kTileSize> ratio{};
  std::array<float, kTileSize> range_m{};
  const auto look_at = [&](const DetectTile& tile, std::size_t lane, std::size_t beam) {
    if (!IsRetroreflected(tile, lane, range_min_m_) || tile.power_ratio[lane] <= ratio[beam]) {
      return;
    }
    ratio[beam] = tile.power_ratio[lane];
    range_m[beam] = tile.true_range_m[lane] + tile.peak_shift_m[lane];
  };
  const std::size_t num_beams = echoes.first.num_rays;
  for (std::size_t beam = 0; beam < num_beams; ++beam) look_at(echoes.first, beam, beam);
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    const auto [tile, lane] = echoes.more(i);
    look_at(tile, lane, echoes.beam_of(i));
  }
  for (std::size_t beam = 0; beam < num_beams; ++beam) {
    const float ghost = gain_ * ratio[beam] * ratio[beam];
    if (ghost < kLeastGhostRatio) continue;
    const float far_m = 2.0F * range_m[beam];
    AddEcho(beam, {label_, EchoTiles::kGhost, far_m, ghost, ghost * power_min_ * far_m * far_m},
            echoes);
  }
}

}  // namespace railcast
