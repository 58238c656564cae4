#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "generator/extras/survey/surfel_maker.h"
#include "generator/extras/survey/survey_beams.h"
#include "generator/extras/survey/survey_voxels.h"

namespace railcast {

/// Finds surfels of things that moved: beams of frames before or after those that saw something in
/// a cell of 0.25 m pass through its surfels and reach something behind.
///
/// Thin things that stand are passed by, too, but in the frames that see them as well. With p, the
/// share of the frames within its time that hit a cell rather than only pass through its surfels, a
/// standing thing is passed n times outside its time without a hit with probability (1 - p)^n;
/// below kLeastProbability it has moved. Cells and not surfels are judged, because beams of a
/// sensor that stands meet the same surfels in every frame, and none of those beside.
class MovingThings {
 public:
  MovingThings(const std::vector<MadeSurfel>& surfels, const SurveyVoxels& cloud);

  /// Takes the frames with the indices that SurveyVoxels::Add() had.
  void Add(const SurveyFrame& frame, std::uint32_t frame_index);

  /// Whether a surfel is of something that moved.
  [[nodiscard]] bool HasMoved(std::size_t surfel) const;
  /// The share of the beams towards a surfel that end on it: less than 1 for fences and leaves, and
  /// where it reaches beyond an edge.
  [[nodiscard]] double ShareStopped(std::size_t surfel) const;

  static constexpr double kLeastProbability = 1e-2;

 private:
  /// The frames that hit a cell, and those that only pass through its surfels.
  struct Frames {
    std::uint32_t first = 0xFFFFFFFF;
    std::uint32_t last = 0;
    std::uint32_t num_hits = 0;
    std::uint32_t num_within = 0;
    std::uint32_t num_outside = 0;
    std::uint32_t last_hit = 0xFFFFFFFF;
    std::uint32_t last_passing = 0xFFFFFFFF;
  };
  struct Judged {
    std::uint64_t cell{};
    std::uint32_t num_passes = 0;
    std::uint32_t last_beam = 0xFFFFFFFF;  ///< Which a surfel in several cells may meet twice.
  };
  static constexpr std::size_t kCellsOfBlock = 16 * 16 * 16;
  void Pass(const SurveyBeam& beam, std::uint32_t frame_index, std::uint32_t surfel);

  const std::vector<MadeSurfel>& surfels_;
  const SurveyVoxels& cloud_;
  std::uint32_t num_beams_ = 0;
  std::vector<Judged> judged_;  ///< In the order of surfels.
  std::unordered_map<std::uint64_t, Frames> frames_of_cell_;
  /// Which cells of a block of 16 x 16 x 16 have any surfel: a beam asks this of each cell that it
  /// goes through, and most are empty.
  std::unordered_map<std::uint64_t, std::bitset<kCellsOfBlock>> cells_of_block_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> surfels_of_cell_;
};

}  // namespace railcast
