#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/write_file.h"

namespace railcast {

inline std::string Big16(std::size_t value) {
  return {static_cast<char>(value >> 8U), static_cast<char>(value & 0xFFU)};
}

inline std::string Little32(std::size_t value) {
  return {static_cast<char>(value), static_cast<char>(value >> 8U), static_cast<char>(value >> 16U),
          static_cast<char>(value >> 24U)};
}

/// A datagram to port 2368, as IP carries it.
inline std::string Udp(const std::string& payload) {
  return Big16(2368) + Big16(2368) + Big16(payload.size() + 8) + Big16(0) + payload;
}

/// An Ethernet frame with a fragment of a datagram, after RFC 791.
inline std::string FragmentOf(const std::string& udp,
                              std::size_t begin,
                              std::size_t size,
                              std::size_t identification = 7) {
  const bool is_last = begin + size >= udp.size();
  const std::string bytes = begin < udp.size() ? udp.substr(begin, size) : std::string();
  const std::string header = std::string("\x45\0", 2) + Big16(20 + bytes.size()) +
                             Big16(identification) + Big16((is_last ? 0U : 0x2000U) + begin / 8) +
                             std::string("\x40\x11\0\0\xC0\xA8\1\xC9\xFF\xFF\xFF\xFF", 12);
  return std::string(12, '\xAA') + std::string("\x08\0", 2) + header + bytes;
}

/// The same after RFC 8200 (4.5), with options that are in every piece before the fragment header.
inline std::string FragmentOfIpv6(const std::string& udp,
                                  std::size_t begin,
                                  std::size_t size,
                                  std::size_t identification = 7) {
  const bool is_last = begin + size >= udp.size();
  const std::string bytes = begin < udp.size() ? udp.substr(begin, size) : std::string();
  const std::string headers = std::string("\x2C\0\1\4\0\0\0\0\x11\0", 10) +
                              Big16(begin + (is_last ? 0U : 1U)) + Big16(0) + Big16(identification);
  const std::string ip = std::string("\x60\0\0\0", 4) + Big16(headers.size() + bytes.size()) +
                         std::string("\0\x40", 2) + std::string(16, '\x20') +
                         std::string(16, '\x21');
  return std::string(12, '\xAA') + std::string("\x86\xDD", 2) + ip + headers + bytes;
}

/// A packet of IPv4 with a datagram from 192.168.1.X.
inline std::string IpOf(const std::string& payload,
                        char host = '\xC9',
                        std::size_t from = 2368,
                        std::size_t to = 2368) {
  const std::string udp = Big16(from) + Big16(to) + Big16(payload.size() + 8) + Big16(0) + payload;
  return std::string("\x45\0", 2) + Big16(20 + udp.size()) + std::string(4, '\0') +
         std::string("\x40\x11\0\0\xC0\xA8\1", 7) + host + std::string(4, '\xFF') + udp;
}

inline std::string EthernetOf(const std::string& ip, const std::string& tags = {}) {
  return std::string(12, '\xAA') + tags + std::string("\x08\0", 2) + ip;
}

struct CapturedFrame {
  std::string bytes;
  std::size_t time_us{};
};

/// The bytes of a capture.
/// @param link Type of the frames; 1 = Ethernet.
inline std::string CaptureBytes(const std::vector<CapturedFrame>& frames, std::size_t link = 1) {
  std::string bytes("\xD4\xC3\xB2\xA1\2\0\4\0\0\0\0\0\0\0\0\0\0\0\4\0", 20);
  bytes += Little32(link);
  for (const auto& [frame, time_us] : frames) {
    bytes += Little32(time_us / 1'000'000) + Little32(time_us % 1'000'000) +
             Little32(frame.size()) + Little32(frame.size()) + frame;
  }
  return bytes;
}

/// Writes that capture.
/// @return `file`.
inline std::filesystem::path WriteCapture(const std::filesystem::path& file,
                                          const std::vector<CapturedFrame>& frames,
                                          std::size_t link = 1) {
  WriteFileWhole(file, CaptureBytes(frames, link));
  return file;
}

}  // namespace railcast
