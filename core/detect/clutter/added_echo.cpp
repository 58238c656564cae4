#include "core/detect/clutter/added_echo.h"

#include <limits>

#include "railcast/outcome.h"

namespace railcast {

EchoTiles::Place AddEcho(std::size_t beam, const AddedEcho& added, EchoTiles& echoes) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const EchoTiles::Place place = echoes.Add(beam, added.echo);
  const auto [tile, lane] = place;
  tile.surface[lane] = 0;
  tile.true_range_m[lane] = added.range_m;
  tile.cos_incidence[lane] = kNaN;
  tile.spread_m[lane] = 0.0F;
  tile.share[lane] = kNaN;
  tile.peak_shift_m[lane] = 0.0F;
  const DetectTile& first = echoes.first;
  tile.reflectivity[lane] = first.surface[beam] != 0 ? first.reflectivity[beam] : 0.0F;
  tile.outcome[lane] = static_cast<std::uint32_t>(Outcome::kClutter);
  tile.clutter[lane] = added.label;
  tile.intensity[lane] = added.intensity;
  tile.power_ratio[lane] = added.power_ratio;
  tile.busy_m[lane] = added.busy_m;
  return place;
}

void AddMeasuredEcho(std::size_t beam, const AddedEcho& added, EchoTiles& echoes) {
  const auto [tile, lane] = AddEcho(beam, added, echoes);
  tile.incidence_rad[lane] = std::numeric_limits<float>::quiet_NaN();
  tile.range_m[lane] = added.range_m;
  tile.x[lane] = added.range_m * tile.direction_x[lane];
  tile.y[lane] = added.range_m * tile.direction_y[lane];
  tile.z[lane] = added.range_m * tile.direction_z[lane];
}

}  // namespace railcast
