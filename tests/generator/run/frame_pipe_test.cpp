#include "generator/run/frame_pipe.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "generator/run/stopping.h"

namespace railcast {
namespace {

/// A pipe of numbers from 0 on, in which each work takes longer for some numbers than for others.
struct NumberPipe {
  FramePipe pipe;
  std::vector<int> slots;
  std::vector<int> in_order;  ///< Numbers in the stage that takes one after another.
  std::vector<int> written;
  int num_told = 0;
  int num_begun = 0;
  /// Where the work on number 20 fails: "begin", "parallel", "in order" or "write".
  std::string fails_at;
  std::function<void()> fault = [] { throw std::runtime_error("20 is bad"); };

  explicit NumberPipe(int num) {
    pipe.num_at_once = 4;
    pipe.num_waiting = 2;
    slots.assign(pipe.num_slots(), -1);
    pipe.execute = [](const std::function<void()>& work) { work(); };
    pipe.begin = [this, num](std::size_t slot) {
      if (num_begun == num) return false;
      slots[slot] = num_begun++;
      Work("begin", slot);
      return true;
    };
    pipe.stages = {{false, [this](std::size_t slot) { Work("parallel", slot); }},
                   {true, [this](std::size_t slot) {
                      Work("in order", slot);
                      in_order.push_back(slots[slot]);
                    }}};
    pipe.write = [this](std::size_t slot) {
      Work("write", slot);
      written.push_back(slots[slot]);
    };
    pipe.on_written = [this] { ++num_told; };
  }

  void Work(const std::string& what, std::size_t slot) const {
    constexpr int kUneven = 7;
    if (what != "begin") {
      std::this_thread::sleep_for(std::chrono::microseconds(300 * (slots[slot] % kUneven)));
    }
    if (what == fails_at && slots[slot] == 20) fault();
  }
};

std::vector<int> FirstNumbers(int num) {
  std::vector<int> numbers(static_cast<std::size_t>(num));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

TEST(RunPipe, WritesAllFramesInTheirOrder) {
  NumberPipe numbers(100);
  RunPipe(numbers.pipe);
  EXPECT_EQ(numbers.in_order, FirstNumbers(100));
  EXPECT_EQ(numbers.written, FirstNumbers(100));
  EXPECT_EQ(numbers.num_told, 100);
}

TEST(RunPipe, PassesAFaultOnOnceTheFramesBeforeItAreWritten) {
  for (const char* const where : {"begin", "parallel", "in order"}) {
    NumberPipe numbers(100);
    numbers.fails_at = where;
    EXPECT_THROW(RunPipe(numbers.pipe), std::runtime_error) << where;
    EXPECT_EQ(numbers.written, FirstNumbers(20)) << where;
    EXPECT_EQ(numbers.num_told, 20) << where;
  }
}

TEST(RunPipe, WritesNothingAfterWhatCouldNotBeWritten) {
  NumberPipe numbers(100);
  numbers.fails_at = "write";
  EXPECT_THROW(RunPipe(numbers.pipe), std::runtime_error);
  EXPECT_EQ(numbers.written, FirstNumbers(20));
  EXPECT_EQ(numbers.num_told, 20);
}

TEST(RunPipe, EndsAfterTheFramesBeforeAStopWithoutAFault) {
  for (const char* const where : {"begin", "parallel"}) {
    NumberPipe numbers(100);
    numbers.fails_at = where;
    numbers.fault = [] { throw RunStopped(); };
    RunPipe(numbers.pipe);
    EXPECT_EQ(numbers.written, FirstNumbers(20)) << where;
  }
}

}  // namespace
}  // namespace railcast
