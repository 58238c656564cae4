#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace railcast {

/// Half-open bins between rising edges.
class Bins {
 public:
  explicit Bins(std::vector<double> edges);

  [[nodiscard]] std::size_t size() const { return edges_.size() - 1; }
  /// Nothing for NaN and for what lies outside.
  [[nodiscard]] std::optional<std::size_t> Find(double value) const;
  [[nodiscard]] double low(std::size_t bin) const { return edges_[bin]; }
  [[nodiscard]] double high(std::size_t bin) const { return edges_[bin + 1]; }
  [[nodiscard]] double middle(std::size_t bin) const { return 0.5 * (low(bin) + high(bin)); }
  /// "20 to 30".
  [[nodiscard]] std::string Name(std::size_t bin) const;

 private:
  std::vector<double> edges_;
};

/// Of tables, in metres: narrow near the sensor, where most points are.
[[nodiscard]] const Bins& RangeBins();
/// Of power laws, in metres: four an octave.
[[nodiscard]] const Bins& FineRangeBins();
/// In degrees, 10 wide.
[[nodiscard]] const Bins& IncidenceBins();

}  // namespace railcast
