#pragma once

#include <cstdint>
#include <vector>

#include "core/detect/base/echo_tiles.h"
#include "core/detect/beam/mirrors.h"
#include "core/detect/beam/part_batch.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Whether anything may mirror: there are puddles, or the world has smooth surfaces.
[[nodiscard]] bool HasMirrorPaths(const DetectorSpec& spec);

/// Effect `mirror_paths`: a beam that meets a mirror (mirrors.h) at range R1 goes on along the
/// reflected direction, meets a surface R2 further on and comes back the same way. That is an echo
/// in the beam's own direction at R1 + R2, where the mirror image of that surface is:
///
///   power ratio = (m F)^2 x that of the image, met directly at the range R1 + R2
///
/// The image is the surface reflected in the mirror's plane, so that incidence, spread and
/// extinction are those along the folded path. One ray for each beam, one reflection. An echo
/// nearer to the mirror than two sigmas of the pulse is part of the mirror's own. Immutable;
/// thread-safe.
class MirrorPaths {
 public:
  MirrorPaths(const DetectorSpec& spec, const Kernels& kernels);

  /// Working memory of one thread.
  struct Work {
    std::vector<MirrorHit> hits;  ///< Filled by DimMirrors().
    RayTile bounced;              ///< From the mirrors on.
    RayTile images;               ///< The same surfaces, as the beams see them.
    DetectTile tile;
  };

  /// Adds the echoes of the beams in `work.hits` to their firings.
  /// @param beams With its mirrors.
  void AddEchoes(const WideBeams& beams, Work& work, EchoTiles& echoes) const;

 private:
  void Bounce(const WideBeams& beams, Work& work) const;
  static void Unfold(const WideBeams& beams, Work& work);
  void Respond(const WideBeams& beams, Work& work) const;

  Kernels kernels_;
  std::uint32_t label_;
  float range_min_m_;
  float range_max_m_;
  float same_echo_m_;  // Echoes closer together are one.
  float least_ratio_;
};

}  // namespace railcast
