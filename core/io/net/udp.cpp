#include "core/io/net/udp.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include <netinet/in.h>
#include <netinet/udp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.h"

namespace railcast {
namespace {

// Holds several seconds of data from any sensor. The kernel grants less where this much is not
// allowed.
constexpr int kReceiveBufferBytes = 32 << 20;
constexpr std::size_t kMaxDatagramBytes = 65'536;

void GrowReceiveBuffer(const UdpSocket& socket) {
  static_cast<void>(socket.Set(SOL_SOCKET, SO_RCVBUFFORCE, kReceiveBufferBytes) ||
                    socket.Set(SOL_SOCKET, SO_RCVBUF, kReceiveBufferBytes));
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
  if (to.address.is_ipv4() && to.address.ipv4() >= kBehindMulticast && !to.is_broadcast()) {
    throw InputError("must be one host, a multicast group, or 255.255.255.255 for all (got " +
                     EndpointText(to) + ")");
  }
  // Connecting a separate socket asks the routing table and sends nothing.
  const UdpSocket probe = SocketTo(to, 1);
  const SocketAddress address = SocketAddressOf(to);
  if (::connect(probe.get(), address.get(), address.size) == 0) return;
  const int error = errno;
  if (error == EACCES) {
    throw InputError("must not be a network's broadcast address; use 255.255.255.255 (got " +
                     EndpointText(to) + ")");
  }
  throw InputError("cannot be sent to: " + std::string(std::strerror(error)) + " (got " +
                   EndpointText(to) + ")");
}

/// Binds a socket and, if the address is that of a group, joins it.
/// @returns Whether the system does, else errno says why not.
bool Bind(const UdpSocket& socket, const Endpoint& at) {
  const int yes = 1;
  const SocketAddress address = SocketAddressOf(at);
  // Beside 0.0.0.0, [::] is for IPv6 alone.
  if (!at.address.is_ipv4()) static_cast<void>(socket.Set(IPPROTO_IPV6, IPV6_V6ONLY, yes));
  // Every program of a machine may hear a group.
  if (at.address.is_multicast()) static_cast<void>(socket.Set(SOL_SOCKET, SO_REUSEADDR, yes));
  return ::bind(socket.get(), address.get(), address.size) == 0 &&
         (!at.address.is_multicast() || JoinGroup(socket, at.address));
}

}  // namespace

UdpReceiver::UdpReceiver(const Endpoint& at)
    : socket_(at.address),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      at_(at),
      buffer_(kMaxDatagramBytes) {
  SocketAddress bound;
  if (!wake_.is_open() || !Bind(socket_, at) ||
      ::getsockname(socket_.get(), bound.get(), &bound.size) != 0) {
    const int error = errno;
    throw InputError("cannot listen: " + std::string(std::strerror(error)) + " (got " +
                     EndpointText(at) + ")");
  }
  at_.port = EndpointOf(bound).port;
  GrowReceiveBuffer(socket_);
  // A kernel that does not know of it gives single datagrams.
  const int yes = 1;
  static_cast<void>(socket_.Set(SOL_UDP, UDP_GRO, yes));
}

bool UdpReceiver::TakeFromSocket() {
  SocketAddress from;
  iovec data{buffer_.data(), buffer_.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  message.msg_name = from.get();
  message.msg_namelen = from.size;
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t size = ::recvmsg(socket_.get(), &message, 0);
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
  std::array<pollfd, 2> waits{pollfd{socket_.get(), POLLIN, 0}, pollfd{wake_.number(), POLLIN, 0}};
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
  static_cast<void>(!::write(wake_.number(), &one, sizeof one));
}

bool UdpReceiver::is_interrupted() const {
  pollfd wake{wake_.number(), POLLIN, 0};
  return ::poll(&wake, 1, 0) > 0;
}

void UdpReceiver::Answer(std::span<const char> bytes, const Endpoint& to) const {
  const SocketAddress address = SocketAddressOf(to);
  ::sendto(socket_.get(), bytes.data(), bytes.size(), 0, address.get(), address.size);
}

UdpSender::UdpSender(const std::vector<Endpoint>& to,
                     std::uint16_t position_port,
                     const SendOptions& options)
    : position_port_(position_port), has_gso_(options.has_offload) {
  for (const Endpoint& endpoint : to) {
    CheckReachable(endpoint);
    targets_.push_back({SocketTo(endpoint, options.multicast_hops), endpoint});
    // As large as a network card's queue; a kernel that allows less grants less.
    const int send_buffer_bytes = 4 << 20;
    static_cast<void>(targets_.back().socket.Set(SOL_SOCKET, SO_SNDBUF, send_buffer_bytes));
  }
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
    const std::span<const char> run(datagrams.bytes.data() + first.offset, run_bytes);
    for (const Target& target : targets_) {
      Endpoint to = target.to;
      if (first.port == DatagramPort::kPosition) to.port = position_port_;
      SendRun(run, first.size, target.socket, SocketAddressOf(to));
    }
    items = items.subspan(count);
  }
}

void UdpSender::SendRun(std::span<const char> run,
                        std::size_t segment_size,
                        const UdpSocket& socket,
                        SocketAddress to) {
  const std::uint64_t num_datagrams = (run.size() + segment_size - 1) / segment_size;
  if (has_gso_ && num_datagrams > 1) {
    iovec data{const_cast<char*>(run.data()), run.size()};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(std::uint16_t))] = {};
    msghdr message{};
    message.msg_name = to.get();
    message.msg_namelen = to.size;
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
    if (::sendmsg(socket.get(), &message, 0) == static_cast<ssize_t>(run.size())) {
      counts_.sent += num_datagrams;
      return;
    }
    if (!SaysNoGso(errno)) {
      counts_.refused += num_datagrams;
      return;
    }
    has_gso_ = false;
  }
  for (std::size_t offset = 0; offset < run.size(); offset += segment_size) {
    const auto datagram = run.subspan(offset, std::min(segment_size, run.size() - offset));
    const ssize_t sent =
        ::sendto(socket.get(), datagram.data(), datagram.size(), 0, to.get(), to.size);
    ++(sent == static_cast<ssize_t>(datagram.size()) ? counts_.sent : counts_.refused);
  }
}

}  // namespace railcast
