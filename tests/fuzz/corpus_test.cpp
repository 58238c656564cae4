#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

/// Of the fuzzer that this test is built with.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace railcast {
namespace {

// Whole and cut at a few places. What is wrong ends the program: a Check() of the fuzzer's, or one
// of the sanitizers where the build has them.
TEST(FuzzCorpus, HoldsNothingThatBreaksTheReaders) {
  std::size_t num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RAILCAST_FUZZ_CORPUS)) {
    SCOPED_TRACE(entry.path());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
    for (const std::size_t size : {bytes.size(), bytes.size() / 2, bytes.size() / 3}) {
      // Copied, so that reading past the end is seen.
      const std::vector<std::uint8_t> input(bytes.begin(),
                                            bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_EQ(LLVMFuzzerTestOneInput(input.data(), input.size()), 0);
    }
    ++num_files;
  }
  EXPECT_GT(num_files, 0U);
}

}  // namespace
}  // namespace railcast
