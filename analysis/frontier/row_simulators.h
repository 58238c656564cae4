#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "analysis/frontier/rows.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// The simulators that make the frames of rows: one in full detail for most of them, and one more
/// for each choice of scene detail `auto`, which depends on whether the beams have a width.
class RowSimulators {
 public:
  /// @param scenario In full detail.
  /// @param full_detail Its simulator; must outlive this object.
  RowSimulators(const ScenarioSpec& scenario,
                Simulator& full_detail,
                const std::vector<FrontierRow>& rows);

  [[nodiscard]] Simulator& Of(const FrontierRow& row);
  /// Sets the number of threads of all of them.
  void UseThreads(int num_threads);
  /// Builds the windows of a frame, so that no row's time contains that.
  void BuildWindows(std::uint32_t frame);

 private:
  Simulator& full_detail_;
  std::map<bool, std::unique_ptr<Simulator>> auto_detail_;  ///< By whether beams have a width.
};

}  // namespace railcast
