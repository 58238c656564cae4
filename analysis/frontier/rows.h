#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "railcast/effects.h"
#include "railcast/fidelity.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// The series of the chart that a row belongs to.
enum class RowGroup {
  kRawTrace,    ///< The reference of time: ray tracing only.
  kLadder,      ///< The rungs, and rung surface with wires.
  kBetween,     ///< A rung without one of its effects.
  kBruteForce,  ///< The same number of sub-rays in every beam, with wires as triangles.
  kReference,   ///< The reference of accuracy with fewer sub-rays.
  kChosen,      ///< What fidelity auto chooses.
  kAutoDetail,  ///< A rung with scene detail `auto`, whose echoes cannot be matched one by one.
};
[[nodiscard]] const char* RowGroupName(RowGroup group);

/// A way of making frames whose time and errors are measured.
struct FrontierRow {
  std::string name;
  RowGroup group{};
  EffectSet effects{};
  std::optional<int> sub_rays{};  ///< Sub-rays of dense_footprint beside the central ray.
  int footprint_rays = 64;        ///< BeamSpec::footprint_rays.

  /// Whether the scene is as coarse as detail `auto` permits; otherwise it is in full detail.
  [[nodiscard]] bool has_auto_detail() const { return group == RowGroup::kAutoDetail; }
  /// Whether its echoes are compared with those of the reference.
  [[nodiscard]] bool is_matched() const {
    return group != RowGroup::kRawTrace && group != RowGroup::kAutoDetail;
  }
};

/// Returns all rows in the order of the table. UseChoice() fills in the row `auto`.
[[nodiscard]] std::vector<FrontierRow> AllFrontierRows();

/// Chooses rows by a comma-separated list of names, or "all". The raw trace is always included,
/// since times are given as its multiples.
/// @throws InputError that names the unknown rows.
[[nodiscard]] std::vector<FrontierRow> ChooseFrontierRows(const std::string& names);

/// Gives the row `auto` what fidelity auto has chosen.
void UseChoice(const FidelityChoice& choice, std::vector<FrontierRow>& rows);

/// The scenario's spec with a row's effects. The published model's threshold comes from the same
/// data-sheet figure as the physical one: 10 % reflectance is just detected at
/// range_at_10_percent_m.
[[nodiscard]] SimulatorSpec SpecOfRow(const FrontierRow& row, const SimulatorSpec& scenario);

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
