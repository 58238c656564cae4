#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

#include "core/extras/ros/mcap/mcap_records.h"
#include "railcast/enum_names.h"

namespace railcast {
namespace mcap {

/// How the chunks of an MCAP file are compressed.
enum class McapCompression : std::uint8_t { kNone, kLz4, kZstd };

}  // namespace mcap

/// As the record of a chunk names it.
template <>
inline constexpr auto kEnumNames<mcap::McapCompression> =
    std::to_array<EnumName<mcap::McapCompression>>({{mcap::McapCompression::kNone, ""},
                                                    {mcap::McapCompression::kLz4, "lz4"},
                                                    {mcap::McapCompression::kZstd, "zstd"}});

}  // namespace railcast

namespace railcast::mcap {

/// The most bytes that anything compressed inside a bag may have: a chunk or a message.
inline constexpr std::size_t kMaxUncompressed_bytes = std::size_t{1} << 30U;

/// Returns the bytes compressed; the same bytes always give the same. Zstd's level is 1: clouds
/// become hardly smaller at higher ones.
[[nodiscard]] Bytes Compressed(ByteSpan bytes, McapCompression compression);

/// Returns the bytes uncompressed. Memory grows with what they turn out to be, not with what a file
/// states.
/// @param max_size The most bytes that they may become.
/// @throws InputError "rule (got value)" if they are damaged or become more.
[[nodiscard]] Bytes Uncompressed(ByteSpan bytes, McapCompression compression, std::size_t max_size);

/// Uncompresses a .zst file into an open one.
/// @param max_ratio How often as large it may become, beside 16 MiB, so that a hostile file does
///   not fill the disk.
/// @throws InputError "file: rule" if it is damaged or becomes larger, or if the system refuses.
void UncompressFile(const std::filesystem::path& file, int descriptor, std::uint64_t max_ratio);

/// Gives away a file's content compressed by zstd, block by block. The frame states its size, which
/// rosbag2 asks for.
/// @throws InputError "file: rule" if the system refuses.
void CompressFile(const std::filesystem::path& file, const std::function<void(ByteSpan)>& take);

}  // namespace railcast::mcap
