#pragma once

#include <memory>

#include "core/io/recording/recording_kinds.h"
#include "generator/insert/inserted_output.h"

namespace railcast {

/// MakeCopyOutput() of a capture.
[[nodiscard]] std::unique_ptr<InsertedOutput> MakeCaptureOutput(
    const DatagramPlace& capture, const std::filesystem::path& folder);

/// The checksum of a UDP datagram after bytes of it have changed (RFC 1624): right if it was right
/// before, and 0, which stands for none, if it was 0.
/// @param place Of the first byte, counted from UDP's header.
[[nodiscard]] std::uint16_t ChangedChecksum(std::uint16_t checksum,
                                            std::size_t place,
                                            std::span<const char> before,
                                            std::span<const char> after);

}  // namespace railcast
