#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "railcast/frame.h"

namespace railcast {

/// Counts the echoes of frames by label and range, to compare those of the same scene in full
/// detail and with coarser forms far away.
class EchoesByRange {
 public:
  static constexpr double kBin_m = 30.0;

  /// Height of a slot's point above the mean surface with its label; absent where there is none.
  using HeightAbove = std::function<std::optional<double>(const Frame&, std::size_t slot)>;

  /// @param height_above If empty, no heights are summed.
  explicit EchoesByRange(HeightAbove height_above = {}) : height_above_(std::move(height_above)) {}

  struct Sums {
    double first{};             ///< Nearest echoes of their firings.
    double further{};           ///< All others.
    double intensity{};         ///< Of the first ones.
    double heights{};           ///< Of the first ones that have any: their number,
    double height_m{};          ///< sum,
    double square_height_m2{};  ///< and sum of squares.
    /// Firings whose neighbour in the next column has its first return on the same label, too ...
    double neighbours{};
    double near_neighbours{};  ///< ... and at the same range within 0.1 m.
  };

  void AddFrame(const Frame& frame);

  [[nodiscard]] const std::vector<Sums>& Of(std::uint32_t label, int bin) const;

 private:
  void AddNeighbours(const Frame& frame);
  void AddHeight(const Frame& frame, std::size_t slot, Sums& sums) const;

  HeightAbove height_above_;
  std::size_t num_frames_ = 0;
  // One element for each frame.
  std::map<std::pair<std::uint32_t, int>, std::vector<Sums>> sums_;
};

/// A relative change with the half width of its 95 % interval, from the differences between frames.
struct RelativeChange {
  double change{};
  double half_width{};
};

/// The change of a sum over all frames.
/// @pre Both have the same number of frames, and neither sum is 0.
[[nodiscard]] RelativeChange ChangeOfSum(const std::vector<EchoesByRange::Sums>& from,
                                         const std::vector<EchoesByRange::Sums>& to,
                                         double EchoesByRange::Sums::*of);

/// The change of the mean intensity.
[[nodiscard]] RelativeChange ChangeOfIntensity(const std::vector<EchoesByRange::Sums>& from,
                                               const std::vector<EchoesByRange::Sums>& to);

/// The change of the standard deviation of heights.
[[nodiscard]] RelativeChange ChangeOfHeights(const std::vector<EchoesByRange::Sums>& from,
                                             const std::vector<EchoesByRange::Sums>& to);

}  // namespace railcast
