#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "railcast/material.h"
#include "railcast/transform.h"

namespace railcast {

/// Surveyed surfaces have one of so many reflectivities, each a tenth greater than the one before,
/// so that none is more than 5 % off.
inline constexpr std::uint8_t kNumSurveyLevels = 50;

/// How a surveyed surface reflects, and what it is called.
struct SurveySurface {
  std::uint8_t level{};   ///< Below kNumSurveyLevels.
  std::uint16_t label{};  ///< Index into the survey's labels.

  auto operator<=>(const SurveySurface&) const = default;
};

/// The level nearest to a reflectivity. Those beyond the first and the last, 0.01 and 1.07, have
/// these.
[[nodiscard]] std::uint8_t SurveyLevelOf(double reflectivity);

/// The material of a level, "surveyed_00" for the first: Lambertian, alike at all wavelengths.
[[nodiscard]] Material MaterialOfLevel(std::uint8_t level);

/// Edge of a tile in plan. Tiles lie at multiples of it in the world.
inline constexpr double kSurveyTile_m = 16.0;
/// Cells along a tile's edge in which the height of the ground is known.
inline constexpr std::size_t kGroundCells = 32;

/// A small piece of a surface that was surveyed: a rectangle.
struct Surfel {
  Eigen::Vector3f center_m;  ///< In the tile's frame.
  Eigen::Vector3f half_u_m;  ///< From the centre to the middle of an edge, ...
  Eigen::Vector3f half_v_m;  ///< ... and to that of a neighbouring edge.
  SurveySurface surface;
};

/// A wire that was surveyed.
struct SurveyedWire {
  SurveySurface surface;
  float radius_m{};
  std::vector<Eigen::Vector3f> points_m;  ///< In the tile's frame; at least two.
};

/// What was surveyed in a square of the world. Its frame has its origin at the square's corner of
/// least x and y, and the world's axes.
struct SurveyTile {
  std::array<std::int32_t, 2> cell{};  ///< Coordinates of the corner in units of kSurveyTile_m.
  double base_m{};                     ///< Height of the frame's origin in the world.
  std::vector<Surfel> surfels;
  std::vector<SurveyedWire> wires;
  /// Heights of the ground above `base_m` in kGroundCells rows of as many cells by x, rows by y.
  /// NaN where no ground was surveyed.
  std::vector<float> ground_m;

  [[nodiscard]] Vector3 Origin_m() const {
    return {cell[0] * kSurveyTile_m, cell[1] * kSurveyTile_m, base_m};
  }
};

/// The cell of the tile with a place of the world.
[[nodiscard]] std::array<std::int32_t, 2> SurveyCellAt(const Eigen::Vector2d& place_m);
/// Height of the ground in the world at a place within the tile; nothing where none was surveyed.
[[nodiscard]] std::optional<double> GroundHeight_m(const SurveyTile& tile,
                                                   const Eigen::Vector2d& place_m);

/// A survey as the scene of a scenario, in a file that `railcast-generate survey` has written:
/// labels, an index of tiles with their ground, then the surfels and wires of each. Numbers are
/// little-endian. The class keeps all but the surfels and wires in memory. Thread-safe.
class SurveyFile {
 public:
  /// @throws InputError with one line if the file cannot be read or is damaged.
  explicit SurveyFile(std::filesystem::path file);

  /// Names of the labels that surfaces count.
  [[nodiscard]] const std::vector<std::string>& labels() const { return labels_; }
  /// The tiles without surfels and wires.
  [[nodiscard]] const std::vector<SurveyTile>& tiles() const { return tiles_; }
  [[nodiscard]] std::size_t num_surfels() const;

  /// Reads a tile as a whole.
  /// @throws InputError with one line if the file cannot be read or is damaged.
  [[nodiscard]] SurveyTile Read(std::size_t tile) const;

 private:
  struct Place {
    std::uint64_t offset{};
    std::uint64_t num_bytes{};
    std::uint32_t num_surfels{};
    std::uint32_t num_wires{};
  };
  std::filesystem::path file_;
  std::vector<std::string> labels_;
  std::vector<SurveyTile> tiles_;
  std::vector<Place> places_;
};

/// The bytes of a file for SurveyFile.
[[nodiscard]] std::string EncodeSurvey(const std::vector<std::string>& labels,
                                       const std::vector<SurveyTile>& tiles);

}  // namespace railcast
