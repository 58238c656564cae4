#include "core/io/net/udp_sender.h"

#include <netinet/udp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/io/net/socket_address.h"

namespace railcast {
namespace {

// The kernel's limits for one call with generic segmentation offload, GSO (UDP_MAX_SEGMENTS, and
// the length of an IPv4 packet).
constexpr std::size_t kMaxSegments = 64;
constexpr std::size_t kMaxRunBytes = 65'507;

/// Whether the error is one that a kernel or network device without GSO may report.
bool SaysNoGso(int error_number) {
  return error_number == EINVAL || error_number == EIO || error_number == EMSGSIZE ||
         error_number == ENOPROTOOPT || error_number == EOPNOTSUPP;
}

void CheckReachable(const Endpoint& to) {
  constexpr std::uint32_t kFirstMulticast = 0xE0000000;
  if (to.address >= kFirstMulticast && !to.is_broadcast()) {
    throw InputError("must be one host, or 255.255.255.255 for all (got " + EndpointText(to) + ")");
  }
  // Connecting a separate socket asks the routing table and sends nothing.
  const int probe = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  if (to.is_broadcast()) ::setsockopt(probe, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
  const sockaddr_in address = SocketAddressOf(to);
  const bool is_reachable =
      ::connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const int error = errno;
  ::close(probe);
  if (is_reachable) return;
  if (error == EACCES) {
    throw InputError("must not be a network's broadcast address; use 255.255.255.255 (got " +
                     EndpointText(to) + ")");
  }
  throw InputError("cannot be sent to: " + std::string(std::strerror(error)) + " (got " +
                   EndpointText(to) + ")");
}

}  // namespace

UdpSender::UdpSender(std::vector<Endpoint> to, std::uint16_t position_port, bool has_offload)
    : to_(std::move(to)), position_port_(position_port), has_gso_(has_offload) {
  for (const Endpoint& endpoint : to_) CheckReachable(endpoint);
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) throw InputError("no socket: " + std::string(std::strerror(errno)));
  const bool broadcasts =
      std::any_of(to_.begin(), to_.end(), [](const Endpoint& each) { return each.is_broadcast(); });
  const int yes = 1;
  if (broadcasts) ::setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
  // As large as a network card's queue; a kernel that allows less grants less.
  const int send_buffer_bytes = 4 << 20;
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDBUF, &send_buffer_bytes, sizeof send_buffer_bytes);
}

UdpSender::~UdpSender() {
  if (socket_ >= 0) ::close(socket_);
}

void UdpSender::Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
  while (!items.empty()) {
    const Datagrams::Item& first = items.front();
    // Collect a run: datagrams of equal size back to back, of which the last may be smaller.
    std::size_t count = 1;
    std::size_t run_bytes = first.size;
    while (count < items.size() && count < kMaxSegments && items[count - 1].size == first.size &&
           items[count].size <= first.size && items[count].port == first.port &&
           items[count].offset == first.offset + run_bytes &&
           run_bytes + items[count].size <= kMaxRunBytes) {
      run_bytes += items[count].size;
      ++count;
    }
    for (Endpoint to : to_) {
      if (first.port == DatagramPort::kPosition) to.port = position_port_;
      SendRun(datagrams.bytes.data() + first.offset, run_bytes, first.size, to);
    }
    items = items.subspan(count);
  }
}

void UdpSender::SendRun(const char* bytes,
                        std::size_t size,
                        std::size_t segment_size,
                        const Endpoint& to) {
  sockaddr_in address = SocketAddressOf(to);
  const std::uint64_t num_datagrams = (size + segment_size - 1) / segment_size;
  if (has_gso_ && num_datagrams > 1) {
    iovec data{const_cast<char*>(bytes), size};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(std::uint16_t))] = {};
    msghdr message{};
    message.msg_name = &address;
    message.msg_namelen = sizeof address;
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* option = CMSG_FIRSTHDR(&message);
    option->cmsg_level = SOL_UDP;
    option->cmsg_type = UDP_SEGMENT;
    option->cmsg_len = CMSG_LEN(sizeof(std::uint16_t));
    const auto segment = static_cast<std::uint16_t>(segment_size);
    std::memcpy(CMSG_DATA(option), &segment, sizeof segment);
    if (::sendmsg(socket_, &message, 0) == static_cast<ssize_t>(size)) {
      counts_.sent += num_datagrams;
      return;
    }
    if (!SaysNoGso(errno)) {
      counts_.refused += num_datagrams;
      return;
    }
    has_gso_ = false;
  }
  for (std::size_t offset = 0; offset < size; offset += segment_size) {
    const std::size_t length = std::min(segment_size, size - offset);
    const ssize_t sent = ::sendto(socket_, bytes + offset, length, 0,
                                  reinterpret_cast<const sockaddr*>(&address), sizeof address);
    ++(sent == static_cast<ssize_t>(length) ? counts_.sent : counts_.refused);
  }
}

}  // namespace railcast
