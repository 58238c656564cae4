#pragma once

#include <filesystem>
#include <memory>

#include "generator/insert/packets/inserted_datagrams.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Reads what a plan puts into a recording whose frames are numbered from 0, as those of packets.
/// @param recording As OpenRecording() takes it.
/// @throws InputError as ReadInsertPlan() and Inserter do; the result as FiringFinder does.
[[nodiscard]] InsertIntoFrame MakeInsertion(const std::filesystem::path& plan,
                                            const std::filesystem::path& recording);

/// The recording with what a plan puts into its frames, for readers that take them one by one.
/// @param recording Of which nothing was read yet. @param source As OpenRecording() took it.
[[nodiscard]] std::unique_ptr<Recording> WithInsertion(std::unique_ptr<Recording> recording,
                                                       const std::filesystem::path& plan,
                                                       const std::filesystem::path& source);

}  // namespace railcast
