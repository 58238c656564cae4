#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/simulate/simulator_spec.h"

namespace railcast {

/// Which line of the chart a row belongs to.
enum class RowGroup {
  kRawTrace,    ///< The yardstick of time: rays and nothing else.
  kLadder,      ///< The rungs, and surface with wires.
  kBetween,     ///< A rung without one of its effects.
  kBruteForce,  ///< The same number of sub-rays in every beam, wires by their triangles.
  kReference,   ///< The yardstick of accuracy with fewer sub-rays.
};
[[nodiscard]] const char* RowGroupName(RowGroup group);

/// A way of making frames whose time and errors are measured.
struct FrontierRow {
  std::string name;
  RowGroup group{};
  EffectSet effects{};
  std::optional<int> sub_rays{};  ///< Of dense_footprint, beside the central ray.
};

/// All rows, in the order of the table.
[[nodiscard]] std::vector<FrontierRow> AllFrontierRows();

/// Those that a list of names, separated by commas, asks for; "all" = all. The raw trace is always
/// among them, since times are given as its multiples.
/// @throws InputError that names what is unknown.
[[nodiscard]] std::vector<FrontierRow> ChooseFrontierRows(const std::string& names);

/// The scenario's spec with a row's effects. The published model's threshold comes from the same
/// number of the data sheet as the physical one: 10 % are just detected at range_at_10_percent_m.
[[nodiscard]] SimulatorSpec SpecOfRow(const FrontierRow& row, const SimulatorSpec& scenario);

}  // namespace railcast
