#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/stats/names.h"
#include "railcast/io/recording.h"
#include "railcast/outcome.h"

namespace railcast {

/// Firings without a point, by cause: exact, from the outcomes stored in railcast frames.
///
/// Dropout is the share of the firings that met a surface within reach but yielded no point of it.
/// Firings into the open (no_surface) and onto the own vehicle (ego) had nothing to lose. Where
/// clutter answered, the surface behind is unknown; these firings are counted in the total only,
/// not by range, incidence, label or material.
class Dropout {
 public:
  /// Frames without outcomes are skipped.
  void Add(const RecordedFrame& recorded);
  void Add(const Dropout& other);
  void ForgetRings() { by_ring_.clear(); }

  [[nodiscard]] bool is_empty() const { return all_.num == 0; }
  /// Share over all firings that met a surface.
  [[nodiscard]] Estimate Share() const;
  [[nodiscard]] Section MakeSection(const Names& names) const;

  using Outcomes = std::array<std::uint64_t, kOutcomeNames.size()>;
  /// Firings of one kind and their outcomes.
  struct Count {
    std::uint64_t num{};
    Outcomes outcomes{};

    void Add(Outcome outcome) {
      ++num;
      ++outcomes[static_cast<std::size_t>(outcome)];
    }
    void Add(const Count& other);
    [[nodiscard]] std::uint64_t of(Outcome outcome) const {
      return outcomes[static_cast<std::size_t>(outcome)];
    }
  };

 private:
  Count all_;      ///< All firings.
  Count surface_;  ///< Firings whose surface is known.
  std::vector<Count> by_range_, by_incidence_, by_ring_;
  std::map<std::uint32_t, Count> by_label_;
  std::map<std::uint16_t, Count> by_material_;
};

}  // namespace railcast
