#pragma once

#include <functional>

#include "core/io/run/sensor_folders.h"
#include "core/io/verify/verification.h"

namespace railcast {

/// Compares the merged clouds of several sensors with merged.jsonl, this with sensors.json, and
/// looks for files that neither names.
/// @param on_progress Called from time to time with the completed share.
[[nodiscard]] Verification VerifyMerged(const MergedFolder& merged,
                                        const std::function<void(double)>& on_progress);

}  // namespace railcast
