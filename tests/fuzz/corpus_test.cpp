#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

class FuzzCorpus : public testing::TestWithParam<std::string> {};

// Tries each input in full and truncated at a few places. An error ends the program: a Check() of
// the fuzzer, or one of the sanitizers where the build has them.
TEST_P(FuzzCorpus, HoldsNothingThatBreaksTheReaders) {
  const FuzzTarget target = FuzzTargets().at(GetParam());
  std::size_t num_files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(RAILCAST_FUZZ_CORPORA "/" + GetParam())) {
    SCOPED_TRACE(entry.path());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
    for (const std::size_t size : {bytes.size(), bytes.size() / 2, bytes.size() / 3}) {
      // Copy the bytes, so that the sanitizer detects reads past the end.
      const std::vector<std::uint8_t> input(bytes.begin(),
                                            bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_EQ(target(input.data(), input.size()), 0);
    }
    ++num_files;
  }
  EXPECT_GT(num_files, 0U);
}

std::vector<std::string> NamesOfTargets() {
  std::vector<std::string> names;
  for (const auto& [name, target] : FuzzTargets()) names.push_back(name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Readers,
                         FuzzCorpus,
                         testing::ValuesIn(NamesOfTargets()),
                         [](const testing::TestParamInfo<std::string>& target) {
                           return target.param;
                         });

// The targets register themselves, the corpora are folders: neither is left out.
TEST(FuzzCorpora, HaveATargetEach) {
  std::size_t num_folders = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RAILCAST_FUZZ_CORPORA)) {
    ++num_folders;
    if (entry.path().filename() == "map" && !RAILCAST_TRIES_MAPS) continue;
    EXPECT_TRUE(FuzzTargets().contains(entry.path().filename())) << entry.path();
  }
  EXPECT_EQ(FuzzTargets().size() + (RAILCAST_TRIES_MAPS ? 0U : 1U), num_folders);
}

}  // namespace
}  // namespace railcast
