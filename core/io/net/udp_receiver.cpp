#include "core/io/net/udp_receiver.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

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
}

UdpReceiver::~UdpReceiver() {
  ::close(socket_);
  ::close(wake_);
}

std::optional<UdpReceiver::Received> UdpReceiver::Receive(int timeout_ms) {
  std::array<pollfd, 2> waits{pollfd{socket_, POLLIN, 0}, pollfd{wake_, POLLIN, 0}};
  if (::poll(waits.data(), waits.size(), timeout_ms) <= 0) return std::nullopt;
  if (waits[1].revents != 0) return std::nullopt;
  sockaddr_in from{};
  socklen_t from_size = sizeof from;
  const ssize_t size = ::recvfrom(socket_, buffer_.data(), buffer_.size(), 0,
                                  reinterpret_cast<sockaddr*>(&from), &from_size);
  // The datagram's checksum failed after poll() had announced it.
  if (size < 0) return std::nullopt;
  return Received{std::span(buffer_).first(static_cast<std::size_t>(size)), EndpointOf(from)};
}

void UdpReceiver::Interrupt() const {
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
