#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/io/bag/bag.h"

namespace railcast::bag {

/// Opens an MCAP file, also one that was cut off.
/// @param name Names it in messages.
/// @throws InputError as OpenBag() does.
[[nodiscard]] std::unique_ptr<BagReader> OpenMcapBag(const std::filesystem::path& file,
                                                     const std::string& name);

/// Makes a copy of an MCAP file, of which messages of a topic are replaced.
/// @param copy Its file; unfinished until Finish().
[[nodiscard]] std::unique_ptr<BagCopy> CopyMcapBag(const std::filesystem::path& file,
                                                   const std::string& name,
                                                   const std::filesystem::path& copy,
                                                   const BagTopic& topic);

}  // namespace railcast::bag
