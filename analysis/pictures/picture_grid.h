#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// The size of a picture's place in a grid, without its title; rows may be lower.
inline constexpr int kPlaceWidth_px = 480;
inline constexpr int kPlaceHeight_px = 290;

/// What is drawn in one place of a grid.
struct GridPicture {
  std::string script{};             ///< gnuplot commands.
  int height_px = kPlaceHeight_px;  ///< What it needs of its place.
};

/// An image.
[[nodiscard]] GridPicture ImagePicture(const std::string& title, const std::filesystem::path& png);

/// Nothing but a title.
[[nodiscard]] GridPicture EmptyPicture(const std::string& title);

/// A picture of pictures in rows, each as high as its highest.
/// @pre There is a row, and each has a picture.
[[nodiscard]] Picture GridOf(const std::vector<std::vector<GridPicture>>& rows);

}  // namespace railcast
