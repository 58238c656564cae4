#include "core/extras/packets/velodyne/velodyne_packet.h"

#include <array>
#include <chrono>
#include <cstdio>

#include "core/io/field_layout.h"

namespace railcast {
namespace {

constexpr std::uint16_t kPositionPacketSize = 512;
constexpr std::size_t kClockPlace = 0xC6;
constexpr std::size_t kPulsePlace = 0xCA;
constexpr std::size_t kSentencePlace = 0xCE;
constexpr char kPulseLocked = 2;

}  // namespace

std::string GprmcSentence(std::int64_t time_ns) {
  using std::chrono::days;
  const std::chrono::sys_seconds time{
      std::chrono::seconds(kSimulationEpoch_s + time_ns / 1'000'000'000)};
  const auto midnight = std::chrono::floor<days>(time);
  const std::chrono::year_month_day date(midnight);
  const std::chrono::hh_mm_ss clock(time - midnight);
  // Reduces a number to two digits: the year to its last two, all others so that the compiler can
  // tell that the text fits.
  const auto two = [](auto number) { return static_cast<unsigned>(number) % 100U; };
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(),
                "GPRMC,%02u%02u%02u,V,0000.0000,N,00000.0000,E,000.0,000.0,%02u%02u%02u,000.0,E,N",
                two(clock.hours().count()), two(clock.minutes().count()),
                two(clock.seconds().count()), two(static_cast<unsigned>(date.day())),
                two(static_cast<unsigned>(date.month())), two(static_cast<int>(date.year())));
  unsigned checksum = 0;
  for (const char* c = text.data(); *c != '\0'; ++c) checksum ^= static_cast<unsigned char>(*c);
  std::array<char, 8> end{};
  std::snprintf(end.data(), end.size(), "*%02X\r\n", checksum & 0xFFU);
  std::string sentence("$");
  return sentence.append(text.data()).append(end.data());
}

void AppendPositionPacket(std::int64_t time_ns, std::int64_t clock_ahead_ns, Datagrams& datagrams) {
  const std::int64_t clock_ns = time_ns + clock_ahead_ns;
  const std::size_t offset = datagrams.bytes.size();
  datagrams.bytes.resize(offset + kPositionPacketSize);
  char* const packet = datagrams.bytes.data() + offset;
  StoreAt<std::uint32_t>(packet + kClockPlace, clock_ns / 1000 % kUsPerHour);
  packet[kPulsePlace] = kPulseLocked;
  const std::string sentence = GprmcSentence(clock_ns);
  sentence.copy(packet + kSentencePlace, sentence.size());
  datagrams.items.push_back({.offset = offset,
                             .size = kPositionPacketSize,
                             .port = DatagramPort::kPosition,
                             .due_ns = time_ns});
}

}  // namespace railcast
