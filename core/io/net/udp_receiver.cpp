#include "core/io/net/udp_receiver.h"

#include <netinet/udp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "core/base/error.h"
#include "core/io/net/socket_address.h"

namespace railcast {
namespace {

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

}  // namespace railcast
