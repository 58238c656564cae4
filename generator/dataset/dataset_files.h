#pragma once

#include <cstdint>

#include "core/recipe/split_quota.h"
#include "generator/dataset/dataset_directory.h"

namespace railcast {

/// Writes the files about all scenarios of a data set whose sequences are complete: index.jsonl,
/// split/*.txt, report.json and, last, manifest.json with the hashes of all. They depend on the
/// files of the sequences alone, so that a merged data set has the same bytes as one that was made
/// at once. Removes an index.sqlite, which was made of an earlier index.
/// @return The scenarios of each part.
/// @throws InputError if a sequence cannot be read or the system refuses.
PerPart<std::uint32_t> WriteDatasetFiles(const DatasetSpec& spec);

/// Writes the manifest.json of a shard whose sequences are complete.
/// @throws InputError if a file cannot be read or the system refuses.
void WriteShardManifest(const DatasetSpec& spec);

}  // namespace railcast
