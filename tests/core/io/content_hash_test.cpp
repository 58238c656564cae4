#include "core/io/content_hash.h"

#include <gtest/gtest.h>

#include <string>

#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

// XXH3's published value for empty input and seed 0.
TEST(ContentHash, IsXxh3) {
  EXPECT_EQ(ContentHash(""), "2d06800538d394c2");
}

TEST(ContentHash, DependsOnEveryByte) {
  EXPECT_NE(ContentHash("frame 0"), ContentHash("frame 1"));
  EXPECT_EQ(ContentHash("frame 0").size(), 16U);
}

// Files are read in blocks of 256 KiB.
TEST(ContentHash, OfAFileIsThatOfItsBytes) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / "file";
  for (const std::size_t size : {0UL, 1UL, (1UL << 18U) - 1, 1UL << 18U, (1UL << 19U) + 7}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * i % 251);
    WriteFileWhole(file, bytes);
    const FileHash hashed = HashFile(file);
    EXPECT_EQ(hashed.hash, ContentHash(bytes)) << size;
    EXPECT_EQ(hashed.num_bytes, size);
  }
}

TEST(LineHash, IsThatOfTheTextBeforeIt) {
  EXPECT_EQ(WithLineHash(R"({"a":1})"),
            R"({"a":1,"line_xxh3":")" + ContentHash(R"({"a":1)") + "\"}");
}

TEST(LineHash, NoticesEveryChangedByte) {
  const std::string line = WithLineHash(R"({"a":1,"b":[true,"x"]})");
  EXPECT_EQ(LineHashFault(line), "");
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::string changed = line;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_NE(LineHashFault(changed), "") << changed;
    EXPECT_NE(LineHashFault(line.substr(0, i)), "") << i;
  }
  EXPECT_NE(LineHashFault(line + "}"), "");
}

TEST(LineHash, SaysWhatItMustBe) {
  std::string line = WithLineHash(R"({"a":1})");
  line[5] = '2';
  EXPECT_EQ(LineHashFault(line), "/line_xxh3: must be " + ContentHash(R"({"a":2)") +
                                     ", that of all before it (got " + ContentHash(R"({"a":1)") +
                                     ")");
  EXPECT_EQ(LineHashFault(R"({"a":1})"), "must end with line_xxh3, the hash of all before it");
}

}  // namespace
}  // namespace railcast
