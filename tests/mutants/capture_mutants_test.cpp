#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/core/extras/packets/ouster/made_ouster.h"
#include "tests/core/extras/packets/pcap/made_capture.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/mutants/mutants.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

std::vector<std::string> SentTurns(const char* format,
                                   const char* sensor,
                                   std::uint32_t first = 0) {
  const MadeScan scan(ReadSensor(sensor));
  return DataTexts(EncodeAll(
      format, scan, {scan.MakeFrame(first), scan.MakeFrame(first + 1), scan.MakeFrame(first + 2)}));
}

using Frames = std::vector<CapturedFrame>;

Frames FramesOf(const std::vector<std::string>& packets) {
  Frames frames;
  for (const std::string& packet : packets) {
    frames.push_back({EthernetOf(IpOf(packet)), 1'000'000 + 1000 * frames.size()});
  }
  return frames;
}

void TryFile(Mutants& mutants, const Frames& frames) {
  const std::string& good = mutants.good();
  for (std::size_t link = 0; link < 300; link += link < 20 ? 1 : 7) {
    mutants.Try("link type changed", NumberText(link), CaptureBytes(frames, link));
  }
  for (std::size_t place = 0; place < 24; ++place) {
    for (const char byte : {'\0', '\1', '\x7F', '\xFF'}) {
      if (place == 22 || place == 23) continue;
      mutants.Try("a byte of the header changed", NumberText(place), With(good, place, {byte}));
    }
  }
  const std::size_t record = 16 + frames[0].bytes.size();
  for (std::size_t i = 0; i < frames.size(); i += 1 + frames.size() / 8) {
    const std::size_t place = 24 + i * record;
    const std::string detail = "frame " + NumberText(i);
    for (const int more : {-1300, -700, -1, 1, 14, 5000, 2'000'000'000}) {
      const auto size = static_cast<std::uint32_t>(static_cast<int>(frames[0].bytes.size()) + more);
      mutants.Try("captured length changed", detail, With(good, place + 8, BytesOf(size)));
      mutants.Try("original length changed", detail, With(good, place + 12, BytesOf(size)));
    }
    for (const std::size_t size : {100U, 500U, 1000U, 1200U}) {
      std::string cut = With(good, place + 8, BytesOf(static_cast<std::uint32_t>(size)));
      mutants.Try("a frame captured in part", detail,
                  cut.erase(place + 16 + size, frames[0].bytes.size() - size));
    }
  }
  TryCuts(mutants, good.size() / 60);
}

void TryPackets(Mutants& mutants, const Frames& frames) {
  const auto moved = [&](std::size_t from, std::size_t to) {
    Frames others = frames;
    const CapturedFrame frame = others[from];
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(from));
    others.insert(others.begin() + static_cast<std::ptrdiff_t>(std::min(to, others.size())), frame);
    return CaptureBytes(others);
  };
  for (std::size_t i = 0; i + 1 < frames.size(); i += 1 + frames.size() / 12) {
    const std::string detail = "packet " + NumberText(i);
    for (const std::size_t num : {1U, 2U, 5U, 20U}) {
      Frames others = frames;
      const auto first = others.begin() + static_cast<std::ptrdiff_t>(i);
      others.erase(first, first + static_cast<std::ptrdiff_t>(std::min(num, frames.size() - i)));
      const bool is_end = i == 0 || i + num >= frames.size();
      if (!is_end)
        mutants.Try("packets lost", detail + ": " + NumberText(num), CaptureBytes(others));
    }
    for (const std::size_t later : {1U, 2U, 9U, 40U}) {
      if (i + later < frames.size())
        mutants.Try("a packet late", detail + ": by " + NumberText(later), moved(i, i + later));
    }
    for (const std::size_t later : {1U, 2U, 15U, 60U}) {
      Frames others = frames;
      others.insert(
          others.begin() + static_cast<std::ptrdiff_t>(std::min(i + later, others.size())),
          frames[i]);
      mutants.Try("a packet doubled", detail + ": after " + NumberText(later),
                  CaptureBytes(others));
    }
  }
}

/// Changes of one frame, with its length where that changes.
void TryFrames(Mutants& mutants, const Frames& frames, const std::vector<std::string>& packets) {
  for (std::size_t i = 1; i + 1 < frames.size(); i += 1 + frames.size() / 12) {
    const auto with = [&](const std::string& what, const std::string& detail,
                          const std::string& frame) {
      Frames others = frames;
      others[i].bytes = frame;
      mutants.Try(what, "packet " + NumberText(i) + ": " + detail, CaptureBytes(others));
    };
    const std::string& frame = frames[i].bytes;
    const std::string& packet = packets[i];
    for (const int more : {-600, -100, -1, 1, 7, 300}) {
      const auto length =
          static_cast<std::size_t>(std::max(20, static_cast<int>(frame.size()) - 14 + more));
      with("length of IP changed", NumberText(more), With(frame, 16, Big16(length)));
      with("length of UDP changed", NumberText(more), With(frame, 38, Big16(length - 20)));
      std::string other = packet;
      other.resize(static_cast<std::size_t>(std::max(0, static_cast<int>(packet.size()) + more)),
                   'x');
      with("a packet of another length", NumberText(more), EthernetOf(IpOf(other)));
    }
    with("a tag of a VLAN", "0x8100", EthernetOf(IpOf(packet), std::string("\x81\0\0\1", 4)));
    with("a tag of a VLAN", "two",
         EthernetOf(IpOf(packet), std::string("\x88\xA8\0\1\x81\0\0\2", 8)));
    with("an unknown type of Ethernet", "", With(frame, 12, Big16(0x1234)));
    with("another protocol than UDP", "", With(frame, 23, "\6"));
    with("version of IP changed", "", With(frame, 14, "\x65"));
    with("another sender", "", EthernetOf(IpOf(packet, '\x77')));
    with("another receiving port", "", EthernetOf(IpOf(packet, '\xC9', 2368, 9999)));
    with("an empty datagram", "", EthernetOf(IpOf({})));
    const std::string udp = Udp(packet);
    with("a fragment without the others", "first", FragmentOf(udp, 0, 800));
    with("a fragment without the others", "last", FragmentOf(udp, 800, 2000));
    Frames halves = frames;
    halves[i].bytes = FragmentOf(udp, 0, 800);
    halves.insert(halves.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                  {FragmentOf(udp, 800, 2000), frames[i].time_us});
    mutants.Try("a packet in fragments", NumberText(i), CaptureBytes(halves));
    std::swap(halves[i], halves[i + 1]);
    mutants.Try("fragments exchanged", NumberText(i), CaptureBytes(halves));
  }
}

/// Changes of what a packet states.
/// @param is_same Whether all packets have the same in these places.
void TryContent(Mutants& mutants,
                const std::vector<std::string>& packets,
                const std::string& what,
                const std::vector<std::size_t>& places,
                bool is_same = true) {
  for (std::size_t i = 1; i + 1 < packets.size(); i += 1 + packets.size() / 6) {
    for (const std::size_t place : places) {
      for (const int byte : {0, 1, 0x21, 0x37, 0x7F, 0xFF}) {
        std::vector<std::string> others = packets;
        others[i][place] = static_cast<char>(byte);
        mutants.Try(
            what, "packet " + NumberText(i) + ": " + NumberText(byte) + " at " + NumberText(place),
            CaptureBytes(FramesOf(others)));
        if (i > 1 || !is_same) continue;
        for (std::string& other : others) other[place] = static_cast<char>(byte);
        mutants.Try(what + " of all packets", NumberText(byte) + " at " + NumberText(place),
                    CaptureBytes(FramesOf(others)));
      }
    }
  }
}

void TryTwo(Mutants& mutants,
            const std::vector<std::string>& packets,
            const std::vector<std::string>& others) {
  const auto mixed = [&](char host, std::size_t from, std::size_t to) {
    Frames frames;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      frames.push_back({EthernetOf(IpOf(packets[i])), 1'000'000 + 1000 * i});
      frames.push_back(
          {EthernetOf(IpOf(others[i % others.size()], host, from, to)), 1'000'500 + 1000 * i});
    }
    return CaptureBytes(frames);
  };
  mutants.Try("a second sensor", "other address", mixed('\xCA', 2368, 2368));
  mutants.Try("a second sensor", "other port of its own", mixed('\xC9', 2369, 2368));
  mutants.Try("a second sensor", "other receiving port", mixed('\xC9', 2368, 2369));
  mutants.Try("a second sensor", "both ports the same", mixed('\xC9', 2368, 2368));
}

/// A block of pcapng, with its length at both ends.
std::string Block(std::uint32_t type, std::string body) {
  body.resize((body.size() + 3) / 4 * 4, '\0');
  const std::string size = Little32(body.size() + 12);
  return Little32(type) + size + body + size;
}

std::string SectionBlocks(const std::string& options = {}, char link = 1) {
  return Block(0x0A0D0D0A, std::string("\x4D\x3C\x2B\x1A\1\0\0\0", 8) + std::string(8, '\xFF')) +
         Block(1, std::string{link, '\0', '\0', '\0'} + Little32(0x40000) + options);
}

std::string PacketBlock(const CapturedFrame& frame, std::uint32_t interface = 0) {
  return Block(6, Little32(interface) + Little32(0) + Little32(frame.time_us) +
                      Little32(frame.bytes.size()) + Little32(frame.bytes.size()) + frame.bytes);
}

TEST(CaptureMutants, OfPcapngAreNeverReadWrongWithoutAWord) {
  Frames frames = FramesOf(SentTurns("vlp16", "vlp16"));
  frames.resize(90);
  std::string good = SectionBlocks();
  const std::size_t begin = good.size();
  for (const CapturedFrame& frame : frames) good += PacketBlock(frame);
  const std::size_t size = PacketBlock(frames[0]).size();
  Mutants mutants("VLP-16 in pcapng", "a.pcapng", good, ReadRecordingWhole);
  for (std::size_t i = 1; i + 1 < frames.size(); i += 9) {
    const std::size_t place = begin + i * size;
    const std::string detail = "packet " + NumberText(i) + " ";
    const auto change = [&](const std::string& what, std::size_t at, std::uint32_t number) {
      mutants.Try(what, detail + NumberText(number), With(good, place + at, Little32(number)));
    };
    for (const std::uint32_t number : {0U, 1U, 2U, 3U, 5U, 7U, 0xBADU, 0x0A0D0D0AU}) {
      change("type of a block changed", 0, number);
      change("interface of a packet changed", 8, number);
    }
    for (const std::uint32_t number : {0U, 12U, 100U, 1279U, 1281U, 1284U, 100'000U}) {
      change("length of a block changed", 4, number);
      change("last length of a block changed", size - 4, number);
      change("captured length of a packet changed", 20, number);
    }
    mutants.Try("a block lost", detail, std::string(good).erase(place, size));
    mutants.Try("a block doubled", detail,
                std::string(good).insert(place, good.substr(place, size)));
    mutants.Try("an unknown block put in", detail,
                std::string(good).insert(place, Block(0xBAD, "abcdefgh")));
    mutants.Try("a section put in", detail, std::string(good).insert(place, SectionBlocks()));
  }
  for (const char link : {'\0', '\6', '\x65', '\x69', '\x71', '\x7F'}) {
    mutants.Try("link type changed", NumberText(int{link}),
                SectionBlocks({}, link) + good.substr(begin));
  }
  for (std::size_t place = 0; place < begin; ++place) {
    mutants.Try("a byte of the first blocks changed", NumberText(place), With(good, place, "\x55"));
  }
  TryCuts(mutants, good.size() / 60);
  CheckSection("pcapng", {&mutants});
}

TEST(CaptureMutants, OfVelodyneAreNeverReadWrongWithoutAWord) {
  const auto packets = SentTurns("vlp16", "vlp16");
  const Frames frames = FramesOf(packets);
  Mutants mutants("VLP-16 in pcap", "a.pcap", CaptureBytes(frames), ReadRecordingWhole);
  TryFile(mutants, frames);
  TryPackets(mutants, frames);
  TryFrames(mutants, frames, packets);
  TryContent(mutants, packets, "mode or model changed", {1204, 1205});
  TryContent(mutants, packets, "flag of a block changed", {0, 1, 100, 501, 1101});
  TryContent(mutants, packets, "azimuth of a block changed", {103, 503}, false);
  TryContent(mutants, packets, "first or last azimuth of a packet changed", {3, 1103}, false);
  TryContent(mutants, packets, "time of a packet changed", {1203, 1202}, false);
  TryTwo(mutants, packets, SentTurns("vlp16", "vlp16", 7));
  TryTwo(mutants, packets, SentTurns("hdl32e", "hdl32e"));
  mutants.Excuse("mode or model changed of all packets", "nothing else says which sensor it is");
  mutants.Excuse("first or last azimuth of a packet changed", "it may be the edge of a window");
  mutants.Excuse("time of a packet changed", "a clock may be set ahead and back");
  CheckSection("Velodyne", {&mutants});
}

TEST(CaptureMutants, OfHesaiAreNeverReadWrongWithoutAWord) {
  const auto numbered = SentTurns("xt16", "xt16");
  const Frames frames = FramesOf(numbered);
  Mutants of_numbered("XT16 in pcap", "a.pcap", CaptureBytes(frames), ReadRecordingWhole);
  TryPackets(of_numbered, frames);
  TryFrames(of_numbered, frames, numbered);
  TryTwo(of_numbered, numbered, SentTurns("xt16", "xt16", 7));
  auto packets = SentTurns("qt128", "qt128");
  packets.resize(packets.size() / 5);
  Mutants mutants("QT128 in pcap", "a.pcap", CaptureBytes(FramesOf(packets)), ReadRecordingWhole);
  std::vector<std::size_t> all;
  for (std::size_t place = 0; place < packets[0].size(); place += 97) all.push_back(place);
  TryContent(mutants, packets, "a byte changed", all, false);
  CheckSection("Hesai", {&of_numbered, &mutants});
}

TEST(CaptureMutants, OfOusterAreNeverReadWrongWithoutAWord) {
  const std::string metadata = MadeOusterMetadataText();
  const std::vector<std::string> packets = DataTexts(MadeOuster(metadata).Encode({0, 1, 2}));
  const Frames frames = FramesOf(packets);
  const std::string capture = CaptureBytes(frames);
  Mutants mutants("Ouster in pcap", "a.pcap", capture, [&](const std::filesystem::path& file) {
    WriteFileWhole(file.parent_path() / "a.json", metadata);
    return ReadRecordingWhole(file);
  });
  TryPackets(mutants, frames);
  TryFrames(mutants, frames, packets);
  // After Ouster's description of packets: type, frame, initialization and serial number.
  TryContent(mutants, packets, "type, frame or sensor of a packet changed", {0, 2, 4, 8}, false);
  TryContent(mutants, packets, "number of a column changed", {40, 41, 32 + 60}, false);
  TryContent(mutants, packets, "status of a column changed", {42}, false);
  Mutants of_metadata("Ouster's metadata", "a.json", metadata,
                      [&](const std::filesystem::path& file) {
                        WriteFileWhole(file.parent_path() / "a.pcap", capture);
                        return ReadRecordingWhole(file.parent_path() / "a.pcap");
                      });
  TryChanges(
      of_metadata,
      {{"mode or format changed", "512x10", "1024x10"},
       {"mode or format changed", "512x10", "512x20"},
       {"mode or format changed", "\"columns_per_frame\": 512", "\"columns_per_frame\": 1024"},
       {"mode or format changed", "\"columns_per_packet\": 16", "\"columns_per_packet\": 8"},
       {"mode or format changed", "\"pixels_per_column\": 4", "\"pixels_per_column\": 8"},
       {"mode or format changed", "RNG19_RFL8_SIG16_NIR16", "RNG15_RFL8_NIR8"},
       {"another sensor", "122201000998", "122201000999"},
       {"another sensor", "7109750", "7109751"},
       {"an angle lost", "-3.75,", ""},
       {"an angle that is none", "-3.75", "\"a\""},
       {"an angle that is none", "-3.75", "375"},
       {"a transform that is none", "36.18", "null"},
       {"a member lost", "beam_altitude_angles", "angles"},
       {"a member lost", "beam_azimuth_angles", "angles"},
       {"a member lost", "lidar_to_sensor_transform", "transform"},
       {"a member lost", "lidar_origin_to_beam_origin_mm", "origin"},
       {"a member lost", "pixel_shift_by_row", "shift"},
       {"a member lost", "column_window", "window"},
       {"a window of columns", "      511", "      255"}});
  CheckSection("Ouster", {&mutants, &of_metadata});
}

}  // namespace
}  // namespace railcast
