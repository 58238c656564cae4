#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// The size of a picture's place in a grid, without its title.
inline constexpr int kPlaceWidth_px = 480;
inline constexpr int kPlaceHeight_px = 290;

/// gnuplot commands that draw an image in the place.
[[nodiscard]] std::string ImagePicture(const std::string& title, const std::filesystem::path& png);

/// gnuplot commands that draw nothing but a title in the place.
[[nodiscard]] std::string EmptyPicture(const std::string& title);

/// A picture of pictures in rows, each drawn by its commands.
/// @pre There is a row, and each has a picture.
[[nodiscard]] Picture GridOf(const std::vector<std::vector<std::string>>& rows);

}  // namespace railcast
