#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace railcast {

/// A script with which gnuplot draws a sheet of pictures, and the size of the sheet.
struct SheetScript {
  std::string text;
  int width_px{};
  int height_px{};
};

/// Makes a sheet of pictures of recordings: a row for each sensor, by its name, and for each
/// camera, of frames spread evenly over all its recordings. Clouds are seen from the sensor, 60 deg
/// to either side of its x axis where there are points, in the colours of their labels or, without
/// labels, by range.
/// @throws InputError if a recording cannot be read.
[[nodiscard]] SheetScript MakeSheet(const std::vector<std::filesystem::path>& recordings);

}  // namespace railcast
