#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/rail/base/noise_field.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Where trees stand: in woods with clearings between them, which are the high places of a noise
/// over the plan on a lattice of the spec's size, with half of its variance on one of a third of
/// it. A share of the land of VegetationSpec::woods_share is wooded; the edges are ragged.
class Woods {
 public:
  Woods(const VegetationSpec& spec, std::uint64_t seed);

  /// Whether a tree at a place of the world stands in a wood. @param draw Uniform in [0, 1).
  [[nodiscard]] bool HaveTreeAt(const Eigen::Vector2d& place_m, float draw) const;

 private:
  double share_;
  double size_m_;
  NoiseField outline_;
  NoiseField edge_;
};

}  // namespace railcast
