#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/io/datagrams.h"

namespace railcast {

/// Appends a datagram with these bytes.
inline void AddDatagram(std::span<const char> bytes,
                        Datagrams& datagrams,
                        DatagramPort port = DatagramPort::kData,
                        std::int64_t due_ns = 0) {
  datagrams.Append(bytes, {.port = port, .due_ns = due_ns});
}

/// Returns a datagram for the data port with each of these bytes.
template <typename Payloads>
[[nodiscard]] Datagrams DatagramsWith(const Payloads& payloads) {
  Datagrams datagrams;
  for (const auto& payload : payloads) AddDatagram(payload, datagrams);
  return datagrams;
}

/// Returns the bytes of each datagram.
[[nodiscard]] inline std::vector<std::string> PayloadTexts(const Datagrams& datagrams) {
  std::vector<std::string> texts;
  for (const Datagrams::Item& item : datagrams.items) {
    const std::span<const char> bytes = datagrams.BytesOf(item);
    texts.emplace_back(bytes.begin(), bytes.end());
  }
  return texts;
}

/// Returns the bytes of each datagram for the data port.
[[nodiscard]] inline std::vector<std::string> DataTexts(Datagrams datagrams) {
  std::erase_if(datagrams.items,
                [](const Datagrams::Item& item) { return item.port != DatagramPort::kData; });
  return PayloadTexts(datagrams);
}

}  // namespace railcast
