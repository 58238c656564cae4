#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "core/rail/chunk/chunk_grid.h"
#include "core/rail/survey/survey_file.h"
#include "railcast/alignment.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// A survey with its surfaces' materials and labels in the tables of a scenario.
class SurveyedScene {
 public:
  /// @throws InputError with a line for every fault: the file's, or names that the tables lack.
  SurveyedScene(const std::filesystem::path& file,
                const LabelTable& labels,
                const MaterialLibrary& materials);

  [[nodiscard]] const SurveyFile& file() const { return file_; }

  /// Adds the surfaces and wires of some tiles.
  void Add(const std::vector<std::size_t>& tiles,
           const Transform& chunk_from_world,
           Chunk& chunk) const;

  /// Height of the ground in the world; nothing where none was surveyed.
  [[nodiscard]] std::optional<double> GroundHeight_m(const Eigen::Vector2d& place_m) const;

 private:
  SurveyFile file_;
  std::map<std::array<std::int32_t, 2>, std::size_t> tile_of_cell_;
  std::vector<std::uint32_t> labels_;
  std::vector<std::uint16_t> materials_;
};

/// Which tiles of a survey belong to which chunk of a line: those that its axis is nearest to.
struct TilesOfChunks {
  std::vector<std::vector<std::size_t>> tiles;  ///< By chunk.
  double half_width_m{};  ///< Farthest that a tile reaches from the axis of its chunk.
};
[[nodiscard]] TilesOfChunks AssignTiles(const std::vector<SurveyTile>& tiles,
                                        const Alignment& alignment,
                                        const ChunkGrid& grid);

}  // namespace railcast
