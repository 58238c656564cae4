#include "tests/core/io/small_disk.h"

#include <gtest/gtest.h>
#include <signal.h>

#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// Returns the error with which a test that asks for this work would fail, or "no error".
std::string FailureOf(const std::function<std::string(const fs::path&)>& work) {
  const TemporaryDirectory directory;
  try {
    const auto result = RunOnSmallDisk(directory.path(), work);
    return result.refused.empty() ? "no error" : result.refused;
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

class SmallDisk : public testing::Test {
 protected:
  void SetUp() override {
    const std::string failure = FailureOf([](const fs::path&) { return ""; });
    if (failure != "no error") GTEST_SKIP() << failure;
  }
};

TEST_F(SmallDisk, FailsWithWhatItsWorkThrows) {
  EXPECT_EQ(FailureOf([](const fs::path&) -> std::string { throw std::runtime_error("no"); }),
            "the work on the small disk threw: no");
}

TEST_F(SmallDisk, FailsWhereItsProcessDies) {
  EXPECT_EQ(FailureOf([](const fs::path&) {
              ::raise(SIGKILL);
              return "";
            }),
            "the process on the small disk died with status 9 (said \"m\")");
}

}  // namespace
}  // namespace railcast
