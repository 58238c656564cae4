#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "core/rail/landform/elevation_grid.h"
#include "core/rail/landform/strip_width.h"
#include "railcast/alignment.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Heights of ElevationSpec in the world. Cheap to copy, immutable, thread-safe.
class DemHeights {
 public:
  /// @throws InputError as ElevationGrid does.
  explicit DemHeights(const ElevationSpec& spec);

  [[nodiscard]] double Height_m(const Eigen::Vector2d& place_m) const;
  [[nodiscard]] bool Covers(const Eigen::Vector2d& place_m) const;
  [[nodiscard]] double cell_m() const { return grid_->cell_m(); }

 private:
  std::shared_ptr<const ElevationGrid> grid_;
  std::array<double, 3> origin_m_;
};

/// What is wrong, if the file does not cover the ground of the whole line, "must cover the ground
/// of the whole line: ends at chainage 1240 m". Ground is examined at places as far apart as its
/// cells and at least 5 m; gaps between them are filled (ElevationGrid).
[[nodiscard]] std::optional<std::string> CoverageFault(const DemHeights& elevation,
                                                       const Alignment& alignment,
                                                       const StripWidth& width);

}  // namespace railcast
