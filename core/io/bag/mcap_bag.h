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

}  // namespace railcast::bag
