#include "core/base/out_of_memory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

std::string Doing() {
  return "building a wall (2 triangles)";
}

std::string MessageOfMaking(const std::function<void()>& make) {
  return MessageOf([&] { WithinMemory(Doing, make); });
}

TEST(OutOfMemory, GivesWhatIsMade) {
  EXPECT_EQ(WithinMemory(Doing, [] { return 3; }), 3);
}

TEST(OutOfMemory, SaysWhatDidNotFit) {
  EXPECT_EQ(MessageOfMaking([] { throw std::bad_alloc(); }),
            "out of memory while building a wall (2 triangles)");
  EXPECT_EQ(MessageOfMaking([] {
              std::vector<double> endless;
              endless.resize(endless.max_size() + 1);
            }),
            "out of memory while building a wall (2 triangles)");
}

TEST(OutOfMemory, SaysWhatNoThreadCanBeStartedFor) {
  EXPECT_EQ(
      MessageOfMaking([] {
        throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
      }),
      "no thread can be started while building a wall (2 triangles)");
}

TEST(OutOfMemory, LeavesTheInnermostPlaceToSpeak) {
  EXPECT_EQ(MessageOfMaking([] {
              WithinMemory([] { return "reading a brick"; }, [] { throw std::bad_alloc(); });
            }),
            "out of memory while reading a brick");
}

TEST(OutOfMemory, LetsOtherErrorsPass) {
  EXPECT_THROW(WithinMemory(Doing, [] { throw std::out_of_range("3"); }), std::out_of_range);
  EXPECT_THROW(
      WithinMemory(Doing,
                   [] { throw std::system_error(std::make_error_code(std::errc::io_error)); }),
      std::system_error);
}

TEST(StartThread, DoesTheWork) {
  int done = 0;
  StartThread("counting", [&] { ++done; }).join();
  EXPECT_EQ(done, 1);
}

TEST(OutOfMemory, TellsTheSizeOfAFile) {
  const std::string file = testing::TempDir() + "out_of_memory_test.txt";
  std::ofstream(file) << "12345";
  EXPECT_EQ(ReadingText(file), "reading " + file + " (5 bytes)");
  std::remove(file.c_str());
  EXPECT_EQ(ReadingText(file), "reading " + file);
}

}  // namespace
}  // namespace railcast
