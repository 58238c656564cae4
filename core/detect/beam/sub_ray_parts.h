#pragma once

#include <cstddef>
#include <vector>

#include "core/detect/beam/echo_finder.h"
#include "core/detect/beam/part_batch.h"
#include "core/detect/beam/sub_ray_pattern.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"

namespace railcast {

/// Effect `dense_footprint`: every sub-ray of a dense pattern is a part of its own, and passes
/// through RayCaster::Cast(). This is the slow method that FacetParts is compared with.
///
/// Not thread-safe: keeps its working memory.
class SubRayParts {
 public:
  SubRayParts(const DetectorSpec& spec, const Kernels& kernels);

  /// As FacetParts::Find(), for every beam.
  void Find(const WideBeams& beams, const DetectTile& first, PartLists& lists);

 private:
  void Flush(const WideBeams& beams, std::size_t num_rays);

  DetectorSpec spec_;
  Kernels kernels_;
  SubRayPattern pattern_;
  PartBatch batch_;
  std::vector<Component> found_;  // Responses of the batches so far.
};

}  // namespace railcast
