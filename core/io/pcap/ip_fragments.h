#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace railcast {

/// A piece of what an IPv4 packet carries.
struct IpFragment {
  std::array<char, 10> packet{};  ///< Source, destination and identification, as they were sent.
  std::size_t offset{};           ///< Place of its bytes in the packet's data.
  bool is_last{};                 ///< Whether the data end with it.
  std::span<const char> bytes;
  std::int64_t time_ns{};  ///< Time of capture.
};

/// Puts together what was sent in fragments (RFC 791, 3.2), in whatever order these were captured.
///
/// Fragments that a capture holds twice count once. A packet of which a fragment is missing is
/// lost: it is given up when a fragment follows that was captured more than a second after its
/// first one, or when 64 newer ones are unfinished.
class IpFragments {
 public:
  /// Takes a fragment.
  /// @returns The packet's data if this completes them, valid until the next call.
  /// @throws InputError "rule (got value)" if the fragment overlaps one that differs from it, if it
  ///   lies behind the end of the packet, or if the packet would have more than 65,535 bytes.
  [[nodiscard]] std::optional<std::span<const char>> Add(const IpFragment& fragment);

  /// Number of packets that are unfinished or were given up.
  [[nodiscard]] std::size_t num_torn() const { return num_given_up_ + unfinished_.size(); }

 private:
  struct Packet {
    std::array<char, 10> name{};
    std::int64_t time_ns{};
    std::vector<char> bytes;
    std::map<std::size_t, std::size_t> parts;  ///< The end of each part by its begin.
    std::optional<std::size_t> end;            ///< Known once the last fragment is there.
  };

  Packet& PacketOf(const IpFragment& fragment);

  std::list<Packet> unfinished_;  ///< From the oldest on.
  std::vector<char> whole_;
  std::size_t num_given_up_{};
};

}  // namespace railcast
