#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/stats/names.h"
#include "core/frame/outcome.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// Firings that came to nothing, by cause: exact, from the outcomes that our frames hold.
///
/// Dropout is the share of the firings that met a surface within reach and brought no point of it
/// back. Firings into the open (no_surface) and onto the own vehicle (ego) had nothing to lose.
/// Where clutter answered the surface behind is unknown. These firings are counted as a whole, not
/// by range, incidence, label or material.
class Dropout {
 public:
  /// Frames without outcomes are passed over.
  void Add(const RecordedFrame& recorded);
  void Add(const Dropout& other);

  [[nodiscard]] bool is_empty() const { return all_.num == 0; }
  /// Over all firings that met a surface.
  [[nodiscard]] Estimate Share() const;
  [[nodiscard]] Section MakeSection(const Names& names) const;

  using Outcomes = std::array<std::uint64_t, kOutcomeNames.size()>;
  /// Firings of a kind and what became of them.
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
  Count surface_;  ///< Those whose surface is known.
  std::vector<Count> by_range_, by_incidence_, by_ring_;
  std::map<std::uint32_t, Count> by_label_;
  std::map<std::uint16_t, Count> by_material_;
};

}  // namespace railcast
