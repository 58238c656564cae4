#pragma once

#include <memory>
#include <vector>

#include "core/io/bag/bag.h"

namespace railcast::bag {

/// Reads the parts of a bag as one. Topics of several parts that are the same in all but their
/// definitions are one; messages come in the order of their times.
[[nodiscard]] std::unique_ptr<BagReader> Merged(std::vector<std::unique_ptr<BagReader>> parts);

/// Reads a bag of which each message is compressed by zstd.
/// @param name Names it in messages.
[[nodiscard]] std::unique_ptr<BagReader> WithUncompressedMessages(std::unique_ptr<BagReader> bag,
                                                                  std::string name);

}  // namespace railcast::bag
