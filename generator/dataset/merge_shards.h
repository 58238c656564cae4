#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace railcast {

/// Makes one data set of all its shards: the same bytes as one run without shards. Files are linked
/// where the file system can, so that they take no further space, and copied elsewhere. An
/// interrupted merge is continued by the same call.
/// @param on_progress Called with the number of scenarios done.
/// @return Number of scenarios.
/// @throws InputError with a line for each shard that is missing, unfinished, changed or of another
///   data set, and for each file of a scenario that is not as its shard's run wrote it; the
///   scenarios before that are merged.
std::uint32_t MergeShards(
    const std::vector<std::filesystem::path>& shards,
    const std::filesystem::path& out,
    const std::function<void(std::uint32_t num_done, std::uint32_t num_scenarios)>& on_progress);

}  // namespace railcast
