#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "core/io/write_file.h"
#include "generator/extras/import/map/read_map.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/import/made_pbf.h"
#include "tests/generator/extras/import/written_maps.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string Gzipped(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY),
            Z_OK);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  std::string in = text;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<unsigned>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<unsigned>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::string Bzipped(const std::string& text) {
  std::string packed(text.size() + text.size() / 100 + 600, '\0');
  std::string in = text;
  auto size = static_cast<unsigned>(packed.size());
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, in.data(),
                                     static_cast<unsigned>(in.size()), 1, 0, 0),
            BZ_OK);
  packed.resize(size);
  return packed;
}

/// A program that packs.
struct PackerCase {
  const char* ending;
  const char* name;
  std::string (*pack)(const std::string& text);
};

class PackedMap : public ::testing::TestWithParam<PackerCase>, public WrittenMaps {
 protected:
  [[nodiscard]] static std::string Pack(const std::string& text) { return GetParam().pack(text); }
  [[nodiscard]] static std::string Name() { return std::string("map.osm.") + GetParam().ending; }
  /// The message of a packed map that ends otherwise than its packer ends data.
  [[nodiscard]] static std::string EndFault(const std::string& got) {
    return Name() + ": must be " + GetParam().name + " data to its end (got " + got + ")";
  }
};

INSTANTIATE_TEST_SUITE_P(Both,
                         PackedMap,
                         ::testing::Values(PackerCase{"gz", "gzip", &Gzipped},
                                           PackerCase{"bz2", "bzip2", &Bzipped}),
                         [](const auto& test) { return std::string(test.param.ending); });

constexpr const char* kCannot =
    ": must be a map: Overpass JSON, .osm, .pbf, GeoJSON, GPX, KML or railML 3, also as .gz or "
    ".bz2";

/// A track of 3 km through so many nodes, by which the text is longer than the reader's buffers.
std::string OsmTrack(int num_nodes) {
  std::string nodes;
  std::string way;
  for (int i = 0; i < num_nodes; ++i) {
    const std::string id = std::to_string(i + 1);
    nodes += "<node id=\"" + id + "\" lat=\"48.2\" lon=\"" +
             std::to_string(15.6 + 0.04 * i / (num_nodes - 1)) + "\"/>\n";
    way += "<nd ref=\"" + id + "\"/>";
  }
  return "<osm version=\"0.6\">\n" + nodes + "<way id=\"7\">" + way +
         "<tag k=\"railway\" v=\"rail\"/></way></osm>\n";
}

/// Letters that hardly pack.
std::string Noise(std::size_t num) {
  std::string letters;
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < num; ++i) {
    state = state * 1664525U + 1013904223U;
    letters += static_cast<char>('A' + (state >> 24U) % 26U);
  }
  return letters;
}

/// Packed data, and behind them a track with a comment by which all are a multiple of some bytes.
std::string FilledUp(std::string begin,
                     std::size_t bytes,
                     std::string (*pack)(const std::string&)) {
  for (std::size_t num = 0; num < 50 * bytes;) {
    const std::string packed = pack("<!--" + Noise(num) + "-->" + OsmTrack(3));
    const std::size_t num_over = (begin.size() + packed.size()) % bytes;
    if (num_over == 0) return begin + packed;
    // A letter more is a byte more at most, nearly always.
    num += bytes - num_over;
  }
  ADD_FAILURE() << "no length fits";
  return {};
}

std::map<std::string, std::string> FilesOf(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) files[entry.path().filename()] = ReadFileWhole(entry.path());
  }
  return files;
}

TEST_P(PackedMap, GivesTheSameWorldAsThePlainOne) {
  const std::string text = OsmTrack(1200);
  // The second member is empty; the cut is within an element.
  const std::string packed = Pack(text.substr(0, 40000)) + Pack("") + Pack(text.substr(40000));
  const TemporaryDirectory out;
  const auto import = [&](const std::string& name, const std::string& bytes) {
    EXPECT_THAT(Generate("import " + Write(name, bytes).string() + " --out " +
                         (out.path() / name).string()),
                ExitsWith(0, HasSubstr("Wrote 1 line")));
    return FilesOf(out.path() / name);
  };
  const auto plain = import("map.osm", text);
  EXPECT_THAT(plain, SizeIs(9));
  EXPECT_EQ(import(Name(), packed), plain);
}

TEST_P(PackedMap, MayEndWhereABufferEnds) {
  // libosmium's reader of bzip2 has a buffer of 5,000 bytes, ours has 65,536.
  const std::string long_begin = Pack("<!--" + Noise(100000) + "-->");
  for (const std::string& packed :
       {FilledUp("", 5000, GetParam().pack), FilledUp(long_begin, 1 << 16, GetParam().pack)}) {
    EXPECT_THAT(Read(Name(), packed).nodes, SizeIs(3)) << packed.size();
    EXPECT_THAT(Read(Name(), packed + Pack("<!-- more -->")).nodes, SizeIs(3)) << packed.size();
    EXPECT_EQ(Fault(Name(), packed + "?"),
              EndFault("other data from byte " + std::to_string(packed.size()) + " on"));
  }
}

TEST_P(PackedMap, IsKnownByItsContent) {
  const std::string text = OsmTrack(3);
  EXPECT_THAT(Read("map.osm", Pack(text)).nodes, SizeIs(3));
  EXPECT_THAT(Read(Name(), text).nodes, SizeIs(3));
  EXPECT_THAT(Read(Name(), Gzipped(text)).nodes, SizeIs(3));
  EXPECT_THAT(Read("map.pbf", Pack(FileOfGroups(DenseNodes(4) + Way({1, 2, 3, 4})))).nodes,
              SizeIs(4));
  EXPECT_THAT(Read("map.json", Pack(R"({"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20]]})"))
                  .nodes,
              SizeIs(2));
  std::string utf16;
  for (const char letter : text) utf16 += {letter, '\0'};
  EXPECT_THAT(Read(Name(), Pack(utf16)).nodes, SizeIs(3));
}

TEST_P(PackedMap, CountsLinesAsThePlainOne) {
  std::string text = OsmTrack(1200);
  text.replace(text.find("<way"), 4, "<node id=\"x\" lat=\"48\" lon=\"15\"/><way");
  const std::string message = Fault("map.osm", text);
  EXPECT_THAT(message, HasSubstr("map.osm: line 1202, node/id: must be a whole number"));
  EXPECT_EQ(Fault(Name(), Pack(text)), Name() + message.substr(std::string("map.osm").size()));
}

TEST_P(PackedMap, IsRefusedWhereverItIsCutOff) {
  const std::string packed = Pack(OsmTrack(3));
  for (std::size_t num = 3; num < packed.size(); ++num) {
    EXPECT_EQ(Fault(Name(), packed.substr(0, num)), EndFault("the file's end within the data"))
        << num;
  }
  EXPECT_EQ(Fault(Name(), packed + packed.substr(0, packed.size() - 1)),
            EndFault("the file's end within the data"));
}

TEST_P(PackedMap, IsRefusedIfItIsDamaged) {
  std::string packed = Pack(OsmTrack(300));
  // The checksum of all data is followed by at most four bytes.
  packed[packed.size() - 6] = static_cast<char>(packed[packed.size() - 6] ^ 0x10);
  EXPECT_EQ(Fault(Name(), packed), EndFault("damaged data"));
}

TEST_P(PackedMap, IsReadAsItWasOrRefusedWhateverBitChanges) {
  const std::string packed = Pack(OsmTrack(3));
  std::size_t num_read = 0;
  for (std::size_t i = 0; i < 8 * packed.size(); ++i) {
    std::string changed = packed;
    changed[i / 8] = static_cast<char>(changed[i / 8] ^ (1 << (i % 8)));
    const std::string message = Fault(Name(), changed);
    if (message == "no error") {
      ++num_read;
      EXPECT_EQ(Read(Name(), changed).nodes.back().geographic_deg, Eigen::Vector2d(15.64, 48.2));
    } else {
      EXPECT_THAT(message,
                  AnyOf(EndFault("damaged data"), EndFault("the file's end within the data"),
                        HasSubstr("other data from byte "), Name() + kCannot))
          << i;
    }
  }
  // The time, system and a flag of gzip, the size of blocks of bzip2, and bits that fill a byte.
  EXPECT_LT(num_read, 70U);
}

TEST_P(PackedMap, IsRefusedIfAnythingIsBehindIt) {
  const std::string packed = Pack(OsmTrack(3));
  const std::string from = "other data from byte " + std::to_string(packed.size()) + " on";
  for (const std::string& more : {std::string("x"), std::string(512, '\0'), OsmTrack(3)}) {
    EXPECT_EQ(Fault(Name(), packed + more), EndFault(from));
  }
}

TEST_P(PackedMap, IsRefusedIfItUnpacksWithoutEnd) {
  const std::string blanks = Pack(std::string(65 << 20, ' '));
  for (const char* begin : {"<osm>", "{", ""}) {
    EXPECT_EQ(Fault(Name(), Pack(begin) + blanks),
              Name() + ": must unpack to at most 64 MiB or 100 times its size (got more)");
  }
}

TEST_P(PackedMap, MustHoldAMap) {
  EXPECT_EQ(Fault(Name(), ""), Name() + kCannot + " (got nothing)");
  EXPECT_EQ(Fault(Name(), Pack("")), Name() + kCannot + " (got nothing)");
  EXPECT_EQ(Fault(Name(), Pack("hello")), Name() + kCannot);
  EXPECT_EQ(Fault(Name(), Pack(Pack(OsmTrack(3)))), Name() + kCannot);
}

}  // namespace
}  // namespace railcast
