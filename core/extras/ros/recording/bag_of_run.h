#pragma once

#include <filesystem>
#include <functional>

#include "core/base/error.h"
#include "core/io/recording/recording_extras.h"

namespace railcast {

/// RecordingExtras::clouds_of_bag.
[[nodiscard]] std::function<CloudInBag()> CloudsOfBag(const SequenceSummary& summary);

/// RecordingExtras::verify_bag.
void VerifyBag(const std::filesystem::path& bag,
               const BagRecord& record,
               const NextClouds& next_frame,
               bool is_finished,
               ErrorList& faults);

/// Adds a fault if a file is an MCAP file without its end.
/// @throws InputError if it cannot be read.
void CheckHasItsEnd(const std::filesystem::path& file, ErrorList& faults);

}  // namespace railcast
