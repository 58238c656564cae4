#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "generator/extras/import/heights/elevation_map.h"
#include "generator/extras/import/map/map_projection.h"
#include "tests/mutants/mutants.h"

namespace railcast {
namespace {

/// An ESRI ASCII grid of 12 x 12 cells of 10 m.
std::string Grid() {
  std::string text =
      "ncols 12\nnrows 12\nxllcorner 499940\nyllcorner 5339940\ncellsize 10\nNODATA_value -9999\n";
  for (int row = 0; row < 12; ++row) {
    for (int column = 0; column < 12; ++column) {
      text += (column == 0 ? "" : " ") + NumberText(250.5 + row + 0.1 * column);
    }
    text += "\n";
  }
  return text;
}

Reading ReadGrid(const std::filesystem::path& file) {
  const MapProjection metres{.definition = "EPSG:32633", .origin_m = {500000.0, 5340000.0}};
  const Eigen::AlignedBox2d bounds_m(Eigen::Vector2d(-50.0, -50.0), Eigen::Vector2d(50.0, 50.0));
  const ElevationMap elevation(file, "EPSG:32633", metres, bounds_m);
  Reading reading;
  if (elevation.num_void() > 0) {
    reading.remarks.push_back({RemarkKind::kHeightsVoid, "", elevation.num_void()});
  }
  std::vector<Eigen::Vector2d> places_m;
  for (int i = -45; i <= 45; i += 10) {
    for (int k = -45; k <= 45; k += 10) places_m.emplace_back(i, k);
  }
  for (const Eigen::Vector2d& place_m : places_m) {
    if (!elevation.Covers(place_m)) throw InputError("heights: must cover the map");
  }
  for (const auto& height_m : elevation.HeightsAt(places_m)) {
    reading.values.push_back(height_m.value_or(-9999.0));
  }
  return reading;
}

TEST(ElevationMutants, OfModelsAreNeverReadWrongWithoutAWord) {
  Mutants mutants("ESRI ASCII grid", "a.asc", Grid(), ReadGrid);
  for (const char* height : {"-32768", "32767", "1e38", "x", "nan", "", "25x", "-99999"}) {
    for (int row = 0; row < 12; row += 3) {
      const std::string cell = " " + NumberText(250.5 + row + 0.1 * 5) + " ";
      mutants.Try("a height that is none", cell + height,
                  Replaced(mutants.good(), cell, " " + std::string(height) + " "));
    }
  }
  for (const auto& [part, other] :
       std::vector<std::array<const char*, 2>>{{"ncols 12", "ncols 11"},
                                               {"ncols 12", "ncols 13"},
                                               {"ncols 12", "ncols -1"},
                                               {"nrows 12", "nrows 11"},
                                               {"nrows 12", "nrows 13"},
                                               {"nrows 12", "nrows 0"},
                                               {"ncols 12\n", ""},
                                               {"nrows 12\n", ""},
                                               {"cellsize 10\n", ""},
                                               {"xllcorner 499940\n", ""},
                                               {"yllcorner 5339940\n", ""},
                                               {"cellsize 10", "cellsize 0"},
                                               {"cellsize 10", "cellsize -10"},
                                               {"cellsize 10", "cellsize 1,0"},
                                               {"xllcorner 499940", "xllcorner 15.6"},
                                               {"NODATA_value -9999\n", ""}}) {
    mutants.Try("a line of the header changed", std::string(part) + other,
                Replaced(mutants.good(), part, other));
  }
  mutants.Try("decimal commas", "", AllReplaced(mutants.good(), ".", ","));
  mutants.Try("commas for blanks", "", AllReplaced(mutants.good(), " ", ","));
  mutants.Try("line ends of Windows", "", AllReplaced(mutants.good(), "\n", "\r\n"));
  for (std::size_t size = 1; size + 1 < mutants.good().size(); size += 5) {
    mutants.Try("cut off", NumberText(size), mutants.good().substr(0, size));
  }
  CheckSection("Elevation models", {&mutants});
}

}  // namespace
}  // namespace railcast
