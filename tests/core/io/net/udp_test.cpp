#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <netinet/udp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <future>
#include <optional>
#include <string>

#include "core/io/net/socket.h"
#include "core/io/net/udp.h"
#include "tests/core/io/message_of.h"
#include "tests/support/loopback.h"
#include "tests/support/made_datagrams.h"

namespace railcast {
namespace {

constexpr int kPatience_ms = 10'000;

// Makes datagrams of these sizes, each filled with its own index.
Datagrams MakeDatagrams(const std::vector<std::uint16_t>& sizes) {
  Datagrams datagrams;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    AddDatagram(std::string(sizes[i], static_cast<char>(i)), datagrams);
  }
  return datagrams;
}

std::vector<std::string> ReceiveAll(UdpReceiver& receiver, std::size_t count) {
  std::vector<std::string> received;
  while (received.size() < count) {
    const auto next = receiver.Receive(kPatience_ms);
    if (!next) break;
    received.emplace_back(next->bytes.begin(), next->bytes.end());
  }
  return received;
}

TEST(UdpSender, DeliversDatagramsOfAnySizesWholeAndInOrder) {
  UdpReceiver receiver(kAnyLoopbackPort);
  UdpSender sender({receiver.at()}, 1);
  const Datagrams datagrams = MakeDatagrams({10, 10, 10, 3, 1400, 7, 7, 9, 1206, 1206, 512});
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(receiver, datagrams.items.size()), PayloadTexts(datagrams));
  EXPECT_EQ(sender.counts().sent, datagrams.items.size());
  EXPECT_EQ(sender.counts().refused, 0U);
}

TEST(UdpSender, CutsRunsThatAreLongerThanTheKernelTakes) {
  UdpReceiver receiver(kAnyLoopbackPort);
  UdpSender sender({receiver.at()}, 1);
  // One GSO call takes at most 65,507 bytes, which hold 46 of the large datagrams, and at most 64
  // of the small ones.
  std::vector<std::uint16_t> sizes(47, 1400);
  sizes.insert(sizes.end(), 65, 20);
  sizes.push_back(1);
  const Datagrams datagrams = MakeDatagrams(sizes);
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(receiver, sizes.size()), PayloadTexts(datagrams));
}

/// Returns the sizes of what the kernel delivers to a socket that accepts whole runs; a capture on
/// this machine shows the same sizes.
std::vector<std::size_t> DeliveredSizes(bool has_offload, std::size_t num_datagrams) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  const timeval patience{kPatience_ms / 1000, 0};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size), 0);
  EXPECT_EQ(::setsockopt(socket, SOL_UDP, UDP_GRO, &yes, sizeof yes), 0);
  EXPECT_EQ(::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience), 0);
  const Datagrams datagrams = MakeDatagrams(std::vector<std::uint16_t>(num_datagrams, 100));
  UdpSender sender({{INADDR_LOOPBACK, ntohs(address.sin_port)}}, 1, {.has_offload = has_offload});
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(sender.counts().sent, num_datagrams);
  std::vector<std::size_t> sizes;
  std::vector<char> buffer(65'536);
  for (std::size_t bytes = 0; bytes < 100 * num_datagrams; bytes += sizes.back()) {
    const ssize_t got = ::recv(socket, buffer.data(), buffer.size(), 0);
    if (got <= 0) break;
    sizes.push_back(static_cast<std::size_t>(got));
  }
  ::close(socket);
  return sizes;
}

TEST(UdpSender, SendsSingleDatagramsWithoutOffload) {
  EXPECT_EQ(DeliveredSizes(false, 5), std::vector<std::size_t>(5, 100));
  EXPECT_EQ(DeliveredSizes(true, 5), std::vector<std::size_t>{500});
}

TEST(UdpSender, ServesEveryReceiver) {
  UdpReceiver first(kAnyLoopbackPort);
  UdpReceiver second(kAnyLoopbackPort);
  UdpSender sender({first.at(), second.at()}, 1);
  const Datagrams datagrams = MakeDatagrams({5, 5, 5});
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(first, 3), PayloadTexts(datagrams));
  EXPECT_EQ(ReceiveAll(second, 3), PayloadTexts(datagrams));
  EXPECT_EQ(sender.counts().sent, 6U);
}

TEST(UdpSender, SendsPositionsToTheirOwnPort) {
  UdpReceiver data(kAnyLoopbackPort);
  UdpReceiver position(kAnyLoopbackPort);
  UdpSender sender({data.at()}, position.at().port);
  Datagrams datagrams = MakeDatagrams({4, 4, 4});
  datagrams.items[1].port = DatagramPort::kPosition;
  sender.Send(datagrams, datagrams.items);
  const auto expected = PayloadTexts(datagrams);
  EXPECT_EQ(ReceiveAll(data, 2), (std::vector{expected[0], expected[2]}));
  EXPECT_EQ(ReceiveAll(position, 1), (std::vector{expected[1]}));
}

TEST(UdpSender, NeverWaitsForAReceiverThatDoesNotRead) {
  UdpReceiver receiver(kAnyLoopbackPort);
  UdpSender sender({receiver.at()}, 1);
  // This exceeds any receive buffer: what does not fit is lost at the receiver, and sending
  // continues.
  const Datagrams datagrams = MakeDatagrams(std::vector<std::uint16_t>(1000, 1400));
  for (int i = 0; i < 100; ++i) sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(sender.counts().sent + sender.counts().refused, 100'000U);
}

TEST(UdpSender, NeverMindsAReceiverThatIsGone) {
  Endpoint gone;
  {
    UdpReceiver receiver(kAnyLoopbackPort);
    gone = receiver.at();
  }
  UdpReceiver alive(kAnyLoopbackPort);
  UdpSender sender({gone, alive.at()}, 1);
  const Datagrams datagrams = MakeDatagrams({8, 8});
  for (int i = 0; i < 50; ++i) sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(alive, 100).size(), 100U);
}

TEST(UdpSender, BroadcastsOnlyWhereAskedByName) {
  const auto said_of = [](const Endpoint& to) {
    return MessageOf([&] { static_cast<void>(UdpSender({to}, 1).counts()); });
  };
  EXPECT_EQ(said_of(Endpoint{0x7FFFFFFF, 2368}),
            "must not be a network's broadcast address; use 255.255.255.255 (got "
            "127.255.255.255:2368)");
  EXPECT_EQ(said_of(Endpoint{0xF0000001, 2368}),
            "must be one host, a multicast group, or 255.255.255.255 for all (got "
            "240.0.0.1:2368)");
  const std::string said = said_of(Endpoint{0xFFFFFFFF, 2368});
  if (said.find("unreachable") != std::string::npos) GTEST_SKIP() << "no network: " << said;
  EXPECT_EQ(said, "no error");
}

TEST(UdpSender, SendsByIpv4AndByIpv6) {
  const auto ipv6 = AnyIpv6LoopbackPort();
  if (!ipv6) GTEST_SKIP() << "this machine has no IPv6 at ::1";
  UdpReceiver first(kAnyLoopbackPort);
  UdpReceiver second(*ipv6);
  UdpSender sender({first.at(), second.at()}, second.at().port);
  // Runs that the kernel cuts, and a position.
  Datagrams datagrams = MakeDatagrams({1206, 1206, 1206, 1206, 512, 24'832});
  datagrams.items[4].port = DatagramPort::kPosition;
  const auto expected = PayloadTexts(datagrams);
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(second, 6), expected);
  EXPECT_EQ(ReceiveAll(first, 5).size(), 5U);
  EXPECT_EQ(sender.counts().refused, 0U);
}

TEST(UdpReceiver, AnswersWhoAskedByIpv6) {
  const auto ipv6 = AnyIpv6LoopbackPort();
  if (!ipv6) GTEST_SKIP() << "this machine has no IPv6 at ::1";
  UdpReceiver server(*ipv6);
  UdpReceiver client(*ipv6);
  client.Answer(std::string("?"), server.at());
  const auto asked = server.Receive(kPatience_ms);
  ASSERT_TRUE(asked.has_value());
  EXPECT_EQ(asked->from, client.at());
  EXPECT_TRUE(asked->from.is_loopback());
  server.Answer(std::string("!"), asked->from);
  EXPECT_EQ(ReceiveAll(client, 1), std::vector<std::string>{"!"});
}

// [::] and 0.0.0.0 may be listened to side by side.
TEST(UdpReceiver, HearsOneFamilyAlone) {
  if (!AnyIpv6LoopbackPort()) GTEST_SKIP() << "this machine has no IPv6 at ::1";
  UdpReceiver ipv6({ParseEndpoint("::", 1).address, 0});
  const std::uint16_t port = ipv6.at().port;
  UdpReceiver ipv4({0, port});
  UdpSender sender({{0x7F000001, port}}, 1);
  const Datagrams datagrams = MakeDatagrams({3});
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(ipv4, 1), PayloadTexts(datagrams));
  EXPECT_FALSE(ipv6.Receive(50));
}

/// The hop limit with which a datagram to a group arrived; nothing if it did not.
std::optional<int> ReceivedHops(const UdpReceiver& group, int multicast_hops) {
  const UdpSocket member(group.at().address);
  const int yes = 1;
  const SocketAddress at = SocketAddressOf(group.at());
  const bool is_ready =
      member.Set(SOL_SOCKET, SO_REUSEADDR, yes) && member.Set(IPPROTO_IP, IP_RECVTTL, yes) &&
      ::bind(member.get(), at.get(), at.size) == 0 && JoinGroup(member, group.at().address);
  EXPECT_TRUE(is_ready);
  UdpSender sender({group.at()}, 1, {.multicast_hops = multicast_hops});
  const Datagrams datagrams = MakeDatagrams({8});
  sender.Send(datagrams, datagrams.items);
  std::array<char, 100> bytes{};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  iovec data{bytes.data(), bytes.size()};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  pollfd wait{member.get(), POLLIN, 0};
  if (::poll(&wait, 1, kPatience_ms) != 1 || ::recvmsg(member.get(), &message, 0) != 8) return {};
  int hops = 0;
  std::memcpy(&hops, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof hops);
  return hops;
}

// On loopback, which no routing table has for groups.
TEST(UdpSender, ReachesAGroupByTheInterfaceThatIsNamed) {
  const IpAddress group = ParseEndpoint("239.255.23.69%lo", 1).address;
  UdpReceiver first({group, 0});
  UdpReceiver second(first.at());
  EXPECT_EQ(EndpointText(first.at()).substr(0, 17), "239.255.23.69%lo:");
  UdpSender sender({first.at()}, 1);
  const Datagrams datagrams = MakeDatagrams({8, 8, 3});
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(first, 3), PayloadTexts(datagrams));
  EXPECT_EQ(ReceiveAll(second, 3), PayloadTexts(datagrams));
  EXPECT_EQ(ReceivedHops(first, 1), 1);
  EXPECT_EQ(ReceivedHops(first, 7), 7);
}

/// A network interface other than loopback that has groups, and IPv6.
std::optional<std::string> InterfaceWithGroups() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return {};
  std::optional<std::string> name;
  for (const ifaddrs* each = all; each != nullptr && !name; each = each->ifa_next) {
    constexpr unsigned kWanted = IFF_UP | IFF_RUNNING | IFF_MULTICAST;
    const bool has_groups = (each->ifa_flags & (kWanted | IFF_LOOPBACK)) == kWanted;
    if (has_groups && each->ifa_addr != nullptr && each->ifa_addr->sa_family == AF_INET6) {
      name = each->ifa_name;
    }
  }
  ::freeifaddrs(all);
  return name;
}

// What is sent to ff01::/16 stays on this machine (RFC 4291, 2.7).
TEST(UdpSender, ReachesAGroupOfIpv6) {
  const auto name = InterfaceWithGroups();
  if (!name) GTEST_SKIP() << "no network interface has groups of IPv6";
  UdpReceiver member({ParseEndpoint("ff01::4a%" + *name, 1).address, 0});
  UdpSender sender({member.at()}, 1);
  const Datagrams datagrams = MakeDatagrams({8, 8, 3});
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(member, 3), PayloadTexts(datagrams));
}

/// A socket that hears a multicast group on this machine.
class GroupMember {
 public:
  explicit GroupMember(std::uint32_t group) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in any{};
    any.sin_family = AF_INET;
    socklen_t size = sizeof any;
    (void)::bind(socket_, reinterpret_cast<const sockaddr*>(&any), size);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&any), &size);
    port_ = ntohs(any.sin_port);
    ip_mreq membership{};
    membership.imr_multiaddr.s_addr = htonl(group);
    has_joined_ =
        ::setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
    const timeval patience{10, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  ~GroupMember() { ::close(socket_); }
  GroupMember(const GroupMember&) = delete;
  GroupMember& operator=(const GroupMember&) = delete;

  [[nodiscard]] bool has_joined() const { return has_joined_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string Receive() const {
    std::string bytes(100, '\0');
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
    return bytes;
  }

 private:
  int socket_;
  std::uint16_t port_{};
  bool has_joined_{};
};

TEST(UdpSender, ReachesTheMembersOfAMulticastGroup) {
  constexpr std::uint32_t kGroup = 0xEFFF1744;  // 239.255.23.68, of this site's own.
  const GroupMember member(kGroup);
  if (!member.has_joined()) GTEST_SKIP() << "no network has a multicast route";
  UdpSender sender({{kGroup, member.port()}}, 1);
  const Datagrams datagrams = MakeDatagrams({8, 8, 3});
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(sender.counts().sent, 3U);
  for (const std::string& expected : PayloadTexts(datagrams)) {
    EXPECT_EQ(member.Receive(), expected);
  }
}

TEST(UdpReceiver, RefusesAPortThatIsTaken) {
  UdpReceiver first(kAnyLoopbackPort);
  EXPECT_EQ(MessageOf([&] { return UdpReceiver(first.at()).at(); }),
            "cannot listen: Address already in use (got " + EndpointText(first.at()) + ")");
}

TEST(UdpReceiver, GivesNothingWhenNothingComes) {
  UdpReceiver receiver(kAnyLoopbackPort);
  EXPECT_FALSE(receiver.Receive(1).has_value());
}

TEST(UdpReceiver, IsInterruptedWhileItWaits) {
  UdpReceiver receiver(kAnyLoopbackPort);
  auto waiting = std::async(std::launch::async, [&] { return receiver.Receive(-1).has_value(); });
  receiver.Interrupt();
  ASSERT_EQ(waiting.wait_for(std::chrono::seconds(10)), std::future_status::ready);
  EXPECT_FALSE(waiting.get());
  EXPECT_FALSE(receiver.Receive(-1).has_value());
}

TEST(UdpReceiver, GivesNothingMoreOnceInterruptedOfWhatCameTogether) {
  UdpReceiver receiver(kAnyLoopbackPort);
  UdpSender sender({receiver.at()}, 1);
  const Datagrams datagrams = MakeDatagrams({100, 100, 100});
  sender.Send(datagrams, datagrams.items);
  EXPECT_EQ(ReceiveAll(receiver, 1).size(), 1U);
  receiver.Interrupt();
  EXPECT_FALSE(receiver.Receive(kPatience_ms));
}

TEST(UdpReceiver, AnswersWhoAsked) {
  UdpReceiver server(kAnyLoopbackPort);
  UdpReceiver client(kAnyLoopbackPort);
  const std::string question = "?";
  client.Answer(question, server.at());
  const auto asked = server.Receive(kPatience_ms);
  ASSERT_TRUE(asked.has_value());
  EXPECT_EQ(asked->from, client.at());
  const std::string answer = "!";
  server.Answer(answer, asked->from);
  EXPECT_EQ(ReceiveAll(client, 1), std::vector<std::string>{"!"});
}

}  // namespace
}  // namespace railcast
