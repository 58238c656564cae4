#pragma once

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "viewer/color/palette.h"

namespace railcast {

/// Colour of the background "dark".
inline constexpr Rgb kDark = {26, 26, 28};

/// A pixel of a picture: column from the left, row from the top.
struct Pixel {
  int x{};
  int y{};
  bool operator==(const Pixel&) const = default;
  auto operator<=>(const Pixel&) const = default;
};

/// A PNG drawn by the program.
struct Picture {
  int width{};
  int height{};
  std::vector<Rgb> pixels;  ///< Row by row, from the top.

  [[nodiscard]] const Rgb& At(int x, int y) const {
    return pixels.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x));
  }
  [[nodiscard]] bool Holds(const Pixel& place) const {
    return place.x >= 0 && place.x < width && place.y >= 0 && place.y < height;
  }
  [[nodiscard]] std::vector<Pixel> PlacesOf(const Rgb& rgb) const {
    std::vector<Pixel> places;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (At(x, y) == rgb) places.push_back({x, y});
      }
    }
    return places;
  }
  [[nodiscard]] std::size_t Count(const Rgb& rgb) const {
    return static_cast<std::size_t>(std::ranges::count(pixels, rgb));
  }
  /// Returns the part of that size whose upper left corner is `from`.
  [[nodiscard]] Picture Part(const Pixel& from, int part_width, int part_height) const {
    Picture part{part_width, part_height, {}};
    for (int y = 0; y < part_height; ++y) {
      for (int x = 0; x < part_width; ++x) part.pixels.push_back(At(from.x + x, from.y + y));
    }
    return part;
  }
  bool operator==(const Picture&) const = default;
};

/// Returns an empty picture if the file is no PNG.
inline Picture ReadPicture(const std::filesystem::path& file) {
  Picture picture;
  vtkNew<vtkPNGReader> reader;
  if (!std::filesystem::exists(file) || reader->CanReadFile(file.c_str()) == 0) return picture;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkImageData& image = *reader->GetOutput();
  picture.width = image.GetDimensions()[0];
  picture.height = image.GetDimensions()[1];
  for (int y = picture.height - 1; y >= 0; --y) {
    for (int x = 0; x < picture.width; ++x) {
      const auto* const rgb = static_cast<const unsigned char*>(image.GetScalarPointer(x, y, 0));
      picture.pixels.push_back({rgb[0], rgb[1], rgb[2]});
    }
  }
  return picture;
}

/// Returns the pixels in which two pictures of the same size differ.
inline std::vector<Pixel> Differences(const Picture& a, const Picture& b) {
  std::vector<Pixel> places;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (a.At(x, y) != b.At(x, y)) places.push_back({x, y});
    }
  }
  return places;
}

}  // namespace railcast
