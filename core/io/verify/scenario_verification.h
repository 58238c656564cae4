#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "core/io/recording/line_reader.h"
#include "core/io/run/sensors_record.h"
#include "core/io/verify/verification.h"

namespace railcast {

/// Compares the merged clouds of several sensors with merged.jsonl, this with sensors.json, and
/// looks for files that neither names.
/// @param on_progress Called from time to time with the completed share.
[[nodiscard]] Verification VerifyMerged(const MergedFolder& merged,
                                        const std::function<void(double)>& on_progress);

/// Compares the folder of a scenario of a data set with its line of scenarios.jsonl: verifies its
/// sequences, compares them with what the line says of them, and looks for files that belong to
/// none.
/// @param dataset The folder of the data set.
/// @param scenario The number that the line must have.
[[nodiscard]] Verification VerifyScenario(const std::filesystem::path& dataset,
                                          std::uint32_t scenario,
                                          const PlacedLine& line);

}  // namespace railcast
