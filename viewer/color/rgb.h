#pragma once

#include <array>
#include <cstdint>

namespace railcast {

using Rgb = std::array<std::uint8_t, 3>;

}  // namespace railcast
