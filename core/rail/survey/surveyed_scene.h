#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/rail/chunk/chunk_grid.h"
#include "railcast/alignment.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Which tiles of a survey belong to which chunk of a line: those that its axis is nearest to.
struct TilesOfChunks {
  std::vector<std::vector<std::size_t>> tiles;  ///< By chunk.
  double half_width_m{};  ///< Farthest that a tile reaches from the axis of its chunk.
};

/// A survey with its surfaces' materials and labels in the tables of a scenario.
class SurveyedScene {
 public:
  virtual ~SurveyedScene() = default;

  [[nodiscard]] virtual TilesOfChunks AssignTiles(const Alignment& alignment,
                                                  const ChunkGrid& grid) const = 0;

  /// Adds the surfaces and wires of some tiles.
  virtual void Add(const std::vector<std::size_t>& tiles,
                   const Transform& chunk_from_world,
                   Chunk& chunk) const = 0;

  /// Height of the ground in the world; nothing where none was surveyed.
  [[nodiscard]] virtual std::optional<double> GroundHeight_m(
      const Eigen::Vector2d& place_m) const = 0;
};

/// What extras add to worlds. What this build lacks is null.
struct WorldExtras {
  /// @param file As `railcast-generate survey` writes it.
  /// @throws InputError with a line for every fault: the file's, or names that the tables lack.
  std::shared_ptr<const SurveyedScene> (*open_survey)(const std::filesystem::path& file,
                                                      const LabelTable& labels,
                                                      const MaterialLibrary& materials) = nullptr;

  /// The materials that the surfaces of surveys have.
  std::vector<Material> (*survey_materials)() = nullptr;

  /// All that this build has.
  [[nodiscard]] static const WorldExtras& Get();
};

}  // namespace railcast
