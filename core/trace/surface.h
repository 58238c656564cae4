#pragma once

#include <cstdint>

namespace railcast {

/// What a ray learns of the surface it hits. Index 0 of a surface table is "nothing".
struct Surface {
  std::uint32_t label{};
  std::uint32_t instance{};
  float reflectivity{};
  std::uint16_t material{};
  bool is_ego{};
};

}  // namespace railcast
