#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene/object_contacts.h"
#include "railcast/lidar.h"
#include "railcast/scene.h"

namespace railcast {

/// Consecutive frames in which two objects touch or overlap.
struct ContactRun {
  std::uint32_t first_frame{};
  std::uint32_t last_frame{};
  std::uint32_t nearest_frame{};  ///< The first with the smallest gap or the greatest depth.
  ObjectContact nearest;          ///< In that frame.

  bool operator==(const ContactRun&) const = default;
};

/// Finds what touches or overlaps at the stamps of frames 0 to `last_frame`, by first frame and
/// then by object.
[[nodiscard]] std::vector<ContactRun> FindContactRuns(const World& world,
                                                      const ScanPattern& pattern,
                                                      std::uint32_t last_frame);

}  // namespace railcast
