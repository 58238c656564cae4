#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

/// Defined by the fuzzer that this test is linked with.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace railcast {
namespace {

// Tries each input in full and truncated at a few places. An error ends the program: a Check() of
// the fuzzer, or one of the sanitizers where the build has them.
TEST(FuzzCorpus, HoldsNothingThatBreaksTheReaders) {
  std::size_t num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RAILCAST_FUZZ_CORPUS)) {
    SCOPED_TRACE(entry.path());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
    for (const std::size_t size : {bytes.size(), bytes.size() / 2, bytes.size() / 3}) {
      // Copy the bytes, so that the sanitizer detects reads past the end.
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
