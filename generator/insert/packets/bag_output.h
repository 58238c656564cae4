#pragma once

#include <filesystem>
#include <memory>

#include "core/io/recording/recording_kinds.h"
#include "generator/insert/inserted_output.h"

namespace railcast {

/// MakeCopyOutput() of a bag.
[[nodiscard]] std::unique_ptr<InsertedOutput> MakeBagOutput(const BagSource& source,
                                                            const std::filesystem::path& folder);

}  // namespace railcast
