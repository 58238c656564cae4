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
/// detail and with coarser forms far away, which cannot be matched one by one.
class EchoesByRange {
 public:
  /// Height of a slot's point above the mean surface with its label; absent where there is none.
  using HeightAbove = std::function<std::optional<double>(const Frame&, std::size_t slot)>;

  /// @param bin_m Width of a range bin.
  /// @param height_above If empty, no heights are summed.
  explicit EchoesByRange(double bin_m, HeightAbove height_above = {})
      : bin_m_(bin_m), height_above_(std::move(height_above)) {}

  /// A label and the number of a range bin.
  using Place = std::pair<std::uint32_t, int>;
  struct Sums {
    double first{};             ///< Nearest echoes of their firings.
    double further{};           ///< All others.
    double intensity{};         ///< Sum over the first ones.
    double num_surveyed{};      ///< First ones that have a height: their number,
    double height_m{};          ///< sum,
    double square_height_m2{};  ///< and sum of squares.
    /// Firings whose neighbour in the next column has its first return on the same label, too ...
    double neighbours{};
    double near_neighbours{};  ///< ... and at the same range within 0.1 m.
  };

  void AddFrame(const Frame& frame);

  [[nodiscard]] double bin_m() const { return bin_m_; }
  /// The sums of each frame; empty if no frame has an echo there.
  [[nodiscard]] const std::vector<Sums>& Of(std::uint32_t label, int bin) const;
  /// Where any frame has an echo, by label and then by range.
  [[nodiscard]] std::vector<Place> Places() const;

 private:
  [[nodiscard]] int BinOf(float range_m) const;
  void AddNeighbours(const Frame& frame);
  void AddHeight(const Frame& frame, std::size_t slot, Sums& sums) const;

  double bin_m_;
  HeightAbove height_above_;
  std::size_t num_frames_ = 0;
  // One element for each frame.
  std::map<Place, std::vector<Sums>> sums_;
};

/// The sum over all frames.
[[nodiscard]] double TotalOf(const std::vector<EchoesByRange::Sums>& sums,
                             double EchoesByRange::Sums::*of);

/// A relative change with half of its 95 % interval, from the differences between frames.
struct RelativeChange {
  double change{};
  double margin{};
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
