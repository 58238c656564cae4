#pragma once

#include <array>
#include <string_view>

#include "viewer/color/palette.h"

namespace railcast {

/// The colour behind the points, and the colour of words on it.
struct Background {
  std::string_view name;
  Rgb rgb{};
  Rgb words{};
};

inline constexpr std::array<Background, 3> kBackgrounds = {{
    {"dark", {26, 26, 28}, {225, 225, 225}},
    {"black", {0, 0, 0}, {225, 225, 225}},
    {"white", {255, 255, 255}, {30, 30, 30}},
}};

inline constexpr int kMaxPointSize_px = 20;

/// How compositions are drawn.
struct Look {
  int point_size_px = 3;
  Background background = kBackgrounds[0];
};

}  // namespace railcast
