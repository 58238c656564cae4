#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/scenario/archive.h"
#include "railcast/error.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

struct PartOfRecord {
  std::string name{};
  std::uint32_t count{};
};
void Describe(Archive& a, PartOfRecord& s) {
  a.Required("name", s.name, "A value of the test.");
  a.Required("count", s.count, "A value of the test.");
}

struct WholeRecord {
  std::int64_t stamp_ns{};
  double share{};
  Vector3 place_m = Vector3::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  std::vector<PartOfRecord> parts{};
  std::map<std::string, std::uint64_t> counts{};
  NamedValues<std::string> hashes{};
  std::optional<double> hidden{};
  std::optional<std::uint32_t> stride{};
  std::string note{};
  std::vector<std::uint32_t> lines{};
  Json any{};
};
void Describe(Archive& a, WholeRecord& s) {
  a.Required("stamp_ns", s.stamp_ns, "A value of the test.");
  a.Required("share", s.share, "A value of the test.", Within(0, 1));
  a.Required("place_m", s.place_m, "A value of the test.");
  a.Required("turn_xyzw", s.turn, "A value of the test.");
  a.Required("parts", s.parts, "A value of the test.");
  a.Required("counts", s.counts, "A value of the test.");
  a.Required("hashes", s.hashes, "A value of the test.");
  a.Nullable("hidden", s.hidden, "A value of the test.");
  a.Optional("stride", s.stride, "A value of the test.");
  a.Optional("note", s.note, "A value of the test.");
  a.Optional("lines", s.lines, "A value of the test.");
  a.Optional("any", s.any, "A value of the test.");
}

constexpr const char* kFull =
    R"({"stamp_ns":-9223372036854775808,"share":0.3333333333333333,"place_m":[1.0,-0.5,5300000.25],)"
    R"("turn_xyzw":[0.0,0.0,0.6,0.8],"parts":[{"name":"a \"b\" ü","count":4294967295}],)"
    R"("counts":{"ballast":1,"rail":18446744073709551615},"hashes":{"z":"1","a":"2"},"hidden":0.25,)"
    R"("stride":3,"note":"n","lines":[1,2],"any":{"k":[1,null]}})";

std::string FaultOfRecord(const std::string& text) {
  try {
    static_cast<void>(ReadRecord<WholeRecord>(text, "FILE:3"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

std::string FaultWith(const std::string& from, const std::string& to) {
  std::string text = kFull;
  text.replace(text.find(from), from.size(), to);
  return FaultOfRecord(text);
}

TEST(Record, ReadsWhatItWritesToTheLastDigit) {
  EXPECT_EQ(RecordText(ReadRecord<WholeRecord>(kFull, "FILE")), kFull);
  // As the JSON library writes it.
  EXPECT_EQ(nlohmann::ordered_json::parse(kFull).dump(), kFull);
}

TEST(Record, HasNamesOfUtf8Alone) {
  WholeRecord record;
  record.note = "drive\xFF";
  try {
    (void)RecordText(record);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "names in files of JSON must be UTF-8 (got \"drive\\xff\")");
  }
}

TEST(Record, LeavesOutWhatIsEmptyAndSaysWhatIsNull) {
  EXPECT_EQ(RecordText(WholeRecord{}),
            R"({"stamp_ns":0,"share":0.0,"place_m":[0.0,0.0,0.0],"turn_xyzw":[0.0,0.0,0.0,1.0],)"
            R"("parts":[],"counts":{},"hashes":{},"hidden":null})");
  const auto read = ReadRecord<WholeRecord>(RecordText(WholeRecord{}), "FILE");
  EXPECT_FALSE(read.hidden || read.stride);
}

TEST(Record, OfALineMayEndWithItsHash) {
  const std::string line = HashedRecordLine(PartOfRecord{"rail", 3});
  EXPECT_EQ(line.find(",\"line_xxh3\":\""), 24U);
  const auto part = ReadRecordLine<PartOfRecord>(line.substr(0, line.size() - 1), "FILE:1");
  EXPECT_EQ(part.name, "rail");
  EXPECT_EQ(part.count, 3U);
}

TEST(Record, NamesThePlaceOfTheFirstFault) {
  EXPECT_EQ(FaultOfRecord(kFull), "none");
  EXPECT_EQ(FaultWith("-9223372036854775808", "9223372036854775808"),
            "FILE:3: /stamp_ns: must be a whole number of at most 63 bits (got "
            "9223372036854775808)");
  EXPECT_EQ(FaultWith("-9223372036854775808", "1.5"),
            "FILE:3: /stamp_ns: must be a whole number of at most 63 bits (got 1.5)");
  EXPECT_EQ(FaultWith("4294967295", "4294967296"),
            "FILE:3: /parts/0/count: must be a whole number from 0 to 4294967295 (got 4294967296)");
  EXPECT_EQ(FaultWith("4294967295", "-1"),
            "FILE:3: /parts/0/count: must be a whole number from 0 to 4294967295 (got -1)");
  EXPECT_EQ(FaultWith("18446744073709551615", "1e30"),
            "FILE:3: /counts/rail: must be a whole number from 0 to 18446744073709551615 (got "
            "1e+30)");
  EXPECT_EQ(FaultWith("[1.0,-0.5,", "[-0.5,"),
            "FILE:3: /place_m: must be a list of 3 values (got [-0.5,5300000.25])");
  EXPECT_EQ(FaultWith("0.3333333333333333", "1.5"),
            "FILE:3: /share: must be >= 0 and <= 1 (got 1.5)");
  EXPECT_EQ(FaultWith("\"share\"", "\"shore\""),
            "FILE:3: /shore: unknown key, the nearest is \"share\"");
  EXPECT_EQ(FaultWith("\"hidden\":0.25,", ""), "FILE:3: /hidden: missing");
  EXPECT_EQ(FaultWith("\"z\":\"1\"", "\"a\":\"1\""), "FILE:3: /hashes/a: duplicate key");
  EXPECT_EQ(FaultWith("{\"name\":\"a \\\"b\\\" ü\",\"count\":4294967295}", "\"part.json\""),
            "FILE:3: /parts/0: must be an object (got \"part.json\")");
}

TEST(Record, IsDamagedWhereItIsNoJson) {
  EXPECT_TRUE(FaultOfRecord("{\"stamp_ns\":").starts_with("FILE:3: is damaged: line 1, column "));
  EXPECT_EQ(FaultOfRecord("[]"), "FILE:3: must be an object (got [])");
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  EXPECT_TRUE(FaultOfRecord(deep).starts_with("FILE:3: is damaged: "));
}

}  // namespace
}  // namespace railcast
