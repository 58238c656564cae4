#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace railcast {

// The encoding of https://wiki.openstreetmap.org/wiki/PBF_Format, with blobs that are not
// compressed.

inline std::string Varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>((value & 0x7F) | 0x80);
  return bytes + static_cast<char>(value);
}
inline std::string Signed(std::int64_t value) {
  return Varint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}
inline std::string VarintField(int field, const std::string& value) {
  return Varint(static_cast<std::uint64_t>(field) << 3) + value;
}
inline std::string BytesField(int field, const std::string& value) {
  return Varint((static_cast<std::uint64_t>(field) << 3) | 2) + Varint(value.size()) + value;
}

/// The fields of a blob that hold its data, by how this is compressed.
inline constexpr int kRaw = 1;
inline constexpr int kZlib = 3;
inline constexpr int kLzma = 4;
inline constexpr int kLz4 = 6;
inline constexpr int kZstd = 7;

inline std::string FileBlock(const std::string& type,
                             const std::string& content,
                             int compression = kRaw) {
  const std::string raw_size = compression == kRaw ? "" : VarintField(2, Varint(content.size()));
  const std::string blob = raw_size + BytesField(compression, content);
  const std::string header = BytesField(1, type) + VarintField(3, Varint(blob.size()));
  std::string block(3, '\0');
  return block + static_cast<char>(header.size()) + header + blob;
}

inline std::string NodeOfMap(std::int64_t id, double longitude_deg, double latitude_deg) {
  const auto units = [](double angle_deg) {
    return Signed(static_cast<std::int64_t>(angle_deg * 1e7 + 0.5));
  };
  return BytesField(1, VarintField(1, Signed(id)) + VarintField(8, units(latitude_deg)) +
                           VarintField(9, units(longitude_deg)));
}

inline constexpr const char* kPbfTexts[] = {"", "railway", "rail", "maxspeed", "90", "ele", "250"};

inline std::string FileOfGroups(const std::string& groups, const std::string& header = "") {
  std::string texts;
  for (const char* text : kPbfTexts) texts += BytesField(1, text);
  return FileBlock("OSMHeader", BytesField(4, "OsmSchema-V0.6") + header) +
         FileBlock("OSMData", BytesField(1, texts) + groups);
}

/// A way with railway=rail through the nodes with these ids.
inline std::string Way(const std::vector<std::int64_t>& nodes, const std::string& more = "") {
  std::string differences;
  std::int64_t before = 0;
  for (const std::int64_t node : nodes) differences += Signed(node - std::exchange(before, node));
  return BytesField(
      2, BytesField(3, VarintField(1, Varint(7)) + BytesField(2, Varint(1)) +
                           BytesField(3, Varint(2)) + BytesField(8, differences) + more));
}

/// Nodes 1 to `num` as dense ones, each 0.01 degrees east of the one before; the second has a
/// height.
/// @param granularity Unit of their places, 1e-9 degrees: 100, unless the block states another.
inline std::string DenseNodes(int num, const std::string& more = "", int granularity = 100) {
  std::string ids;
  std::string latitudes;
  std::string longitudes;
  std::string words;
  for (int i = 0; i < num; ++i) {
    ids += Signed(1);
    latitudes += Signed(i == 0 ? 48'200'000'000 / granularity : 0);
    longitudes += Signed((i == 0 ? 15'600'000'000 : 10'000'000) / granularity);
    words += i == 1 ? Varint(5) + Varint(6) + Varint(0) : Varint(0);
  }
  return BytesField(2, BytesField(2, BytesField(1, ids) + BytesField(8, latitudes) +
                                         BytesField(9, longitudes) + BytesField(10, words) + more));
}

}  // namespace railcast
