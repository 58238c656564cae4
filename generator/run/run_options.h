#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "railcast/lidar.h"

namespace railcast {

// Options that several commands share.

inline constexpr std::uint64_t kMaxFrame = 1'000'000'000;

/// Adds the option `--isa`.
void AddIsa(CLI::App& command, std::string& isa);

/// Checks a list of fields.
/// @throws CLI::ValidationError if `fields` is not a valid list: that is a usage error, like an
///   unknown format.
void CheckFields(const std::string& fields);

/// Checks that a frame's stamp fits into 64 bits.
/// @param option The option with which the user chose the frame.
/// @throws InputError if the frame is so late that it does not.
void CheckHasStamp(const std::string& option, const ScanPattern& pattern, std::uint32_t frame);

}  // namespace railcast
