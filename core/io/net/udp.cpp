#include "core/io/net/udp.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <netinet/in.h>
#include <netinet/udp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.h"

namespace railcast {
namespace {

sockaddr_in SocketAddressOf(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(endpoint.address);
  address.sin_port = htons(endpoint.port);
  return address;
}

Endpoint EndpointOf(const sockaddr_in& address) {
  return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
}

// Holds several seconds of data from any sensor. The kernel grants less where this much is not
// allowed.
constexpr int kReceiveBufferBytes = 32 << 20;
constexpr std::size_t kMaxDatagramBytes = 65'536;

void GrowReceiveBuffer(int socket) {
  if (::setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBufferBytes,
                   sizeof kReceiveBufferBytes) != 0) {
    ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes);
  }
}

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
  constexpr std::uint32_t kBehindMulticast = 0xF0000000;
  if (to.address >= kBehindMulticast && !to.is_broadcast()) {
    throw InputError("must be one host, a multicast group, or 255.255.255.255 for all (got " +
                     EndpointText(to) + ")");
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

UdpReceiver::UdpReceiver(const Endpoint& at) : at_(at), buffer_(kMaxDatagramBytes) {
  const sockaddr_in address = SocketAddressOf(at);
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  sockaddr_in bound{};
  socklen_t size = sizeof bound;
  if (socket_ < 0 || wake_ < 0 ||
      ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size) != 0) {
    const int error = errno;
    if (socket_ >= 0) ::close(socket_);
    if (wake_ >= 0) ::close(wake_);
    throw InputError("cannot listen: " + std::string(std::strerror(error)) + " (got " +
                     EndpointText(at) + ")");
  }
  at_ = EndpointOf(bound);
  GrowReceiveBuffer(socket_);
  // A kernel that does not know of it gives single datagrams.
  const int yes = 1;
  ::setsockopt(socket_, SOL_UDP, UDP_GRO, &yes, sizeof yes);
}

UdpReceiver::~UdpReceiver() {
  ::close(socket_);
  ::close(wake_);
}

bool UdpReceiver::TakeFromSocket() {
  sockaddr_in from{};
  iovec data{buffer_.data(), buffer_.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof from;
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t size = ::recvmsg(socket_, &message, 0);
  // The datagram's checksum failed after poll() had announced it.
  if (size < 0) return false;
  waiting_ = std::span(buffer_).first(static_cast<std::size_t>(size));
  segment_size_ = waiting_.size();
  from_ = EndpointOf(from);
  const cmsghdr* const option = CMSG_FIRSTHDR(&message);
  if (option != nullptr && option->cmsg_level == SOL_UDP && option->cmsg_type == UDP_GRO) {
    int segment = 0;
    std::memcpy(&segment, CMSG_DATA(option), sizeof segment);
    if (segment > 0) segment_size_ = static_cast<std::size_t>(segment);
  }
  return true;
}

std::optional<UdpReceiver::Received> UdpReceiver::Receive(int timeout_ms) {
  if (is_ended_) return std::nullopt;
  if (!waiting_.empty()) return NextWaiting();
  std::array<pollfd, 2> waits{pollfd{socket_, POLLIN, 0}, pollfd{wake_, POLLIN, 0}};
  if (::poll(waits.data(), waits.size(), timeout_ms) <= 0) return std::nullopt;
  if (waits[1].revents != 0) return std::nullopt;
  if (!TakeFromSocket()) return std::nullopt;
  return NextWaiting();
}

UdpReceiver::Received UdpReceiver::NextWaiting() {
  const std::size_t size = std::min(segment_size_, waiting_.size());
  const Received next{waiting_.first(size), from_};
  waiting_ = waiting_.subspan(size);
  return next;
}

void UdpReceiver::Interrupt() const {
  is_ended_ = true;
  const std::uint64_t one = 1;
  // The counter is never read back, so it stays set and every later wait ends at once.
  static_cast<void>(!::write(wake_, &one, sizeof one));
}

bool UdpReceiver::is_interrupted() const {
  pollfd wake{wake_, POLLIN, 0};
  return ::poll(&wake, 1, 0) > 0;
}

void UdpReceiver::Answer(std::span<const char> bytes, const Endpoint& to) const {
  const sockaddr_in address = SocketAddressOf(to);
  ::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
           sizeof address);
}

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
