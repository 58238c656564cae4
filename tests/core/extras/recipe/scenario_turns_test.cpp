#include "core/extras/recipe/scenario_turns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <latch>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/extras/recipe/scenario_lines.h"
#include "core/io/content_hash.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Le;

constexpr std::uint32_t kAny = 1'000;

/// Work whose lines are the numbers of the scenarios.
struct NumberedWork {
  std::vector<int> kept;
  std::vector<double> progress;
  ScenarioWork work{.make = [](const ScenarioTurn& turn) { return std::to_string(turn.index); },
                    .keep = [this](const std::string& line) { kept.push_back(std::stoi(line)); },
                    .on_progress =
                        [this](double num_beyond) {
                          progress.push_back(static_cast<double>(kept.size()) + num_beyond);
                        },
                    .is_stopped = [] { return false; }};
};

/// Makes scenario 0 wait until scenario `index` has been made.
void LetOvertake(std::uint32_t index, NumberedWork& numbered) {
  const auto is_made = std::make_shared<std::atomic<bool>>(false);
  numbered.work.make = [=](const ScenarioTurn& turn) {
    if (turn.index == index) *is_made = true;
    while (turn.index == 0 && !*is_made) std::this_thread::yield();
    return std::to_string(turn.index);
  };
}

TEST(ScenarioTurns, KeepLinesInOrderWhicheverIsMadeFirst) {
  NumberedWork numbered;
  LetOvertake(2, numbered);
  TakeTurns(4, 2, kAny, numbered.work);
  EXPECT_THAT(numbered.kept, ElementsAre(0, 1, 2, 3));
}

TEST(ScenarioTurns, MakeAsManyAtOnceAsThereAreThreads) {
  NumberedWork numbered;
  std::latch all_three(3);
  numbered.work.make = [&](const ScenarioTurn& turn) {
    all_three.arrive_and_wait();
    return std::to_string(turn.index);
  };
  TakeTurns(3, 3, kAny, numbered.work);
  EXPECT_THAT(numbered.kept, ElementsAre(0, 1, 2));
}

TEST(ScenarioTurns, ShareTheThreadsAmongFewScenarios) {
  NumberedWork numbered;
  numbered.work.make = [&](const ScenarioTurn& turn) {
    EXPECT_FALSE(turn.is_alone);
    return std::to_string(turn.num_threads);
  };
  TakeTurns(2, 6, kAny, numbered.work);
  TakeTurns(9, 3, kAny, numbered.work);
  EXPECT_THAT(numbered.kept, ElementsAre(3, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1));
}

TEST(ScenarioTurns, GiveAllThreadsToTheOnlyScenario) {
  NumberedWork numbered;
  std::vector<int> num_threads;
  numbered.work.make = [&](const ScenarioTurn& turn) {
    EXPECT_TRUE(turn.is_alone);
    num_threads.push_back(turn.num_threads);
    return std::to_string(turn.index);
  };
  TakeTurns(1, 6, kAny, numbered.work);
  TakeTurns(2, 6, 1, numbered.work);
  EXPECT_THAT(num_threads, ElementsAre(6, 6, 6));
}

// Scenario 0 is not done before scenario 7 has begun, which is four for each of two threads.
TEST(ScenarioTurns, RunAheadNoFartherThanFourForEachThread) {
  NumberedWork numbered;
  std::atomic<std::uint32_t> farthest = 0;
  std::atomic<std::uint32_t> before_first = 0;
  numbered.work.make = [&](const ScenarioTurn& turn) {
    if (turn.index > farthest) farthest = turn.index;
    if (turn.index == 0) {
      while (farthest < 7) std::this_thread::yield();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      before_first = farthest.load();
    }
    return std::to_string(turn.index);
  };
  TakeTurns(30, 2, kAny, numbered.work);
  EXPECT_EQ(before_first, 7U);
  EXPECT_EQ(numbered.kept.size(), 30U);
}

TEST(ScenarioTurns, PassOnTheFaultOfTheFirstAndKeepThoseBeforeIt) {
  for (const int num_threads : {1, 2, 8}) {
    NumberedWork numbered;
    numbered.work.make = [&](const ScenarioTurn& turn) {
      if (turn.index == 5) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (turn.index >= 5) throw InputError("scenario " + std::to_string(turn.index));
      return std::to_string(turn.index);
    };
    EXPECT_EQ(MessageOf([&] { TakeTurns(20, num_threads, kAny, numbered.work); }), "scenario 5");
    EXPECT_THAT(numbered.kept, ElementsAre(0, 1, 2, 3, 4));
  }
}

TEST(ScenarioTurns, StopThoseAfterAFault) {
  NumberedWork numbered;
  numbered.work.make = [&](const ScenarioTurn& turn) -> std::optional<std::string> {
    if (turn.index == 0) throw InputError("scenario 0");
    while (!turn.is_stopped()) std::this_thread::yield();
    return std::nullopt;
  };
  EXPECT_EQ(MessageOf([&] { TakeTurns(20, 4, kAny, numbered.work); }), "scenario 0");
  EXPECT_TRUE(numbered.kept.empty());
}

TEST(ScenarioTurns, KeepNothingAfterALineThatCouldNotBeKept) {
  NumberedWork numbered;
  numbered.work.keep = [&](const std::string& line) {
    if (line == "3") throw InputError("disk full");
    numbered.kept.push_back(std::stoi(line));
  };
  EXPECT_EQ(MessageOf([&] { TakeTurns(20, 3, kAny, numbered.work); }), "disk full");
  EXPECT_THAT(numbered.kept, ElementsAre(0, 1, 2));
}

TEST(ScenarioTurns, BeginNoneAfterBeingStopped) {
  NumberedWork numbered;
  std::atomic<int> num_begun = 0;
  numbered.work.make = [&](const ScenarioTurn& turn) {
    ++num_begun;
    return std::to_string(turn.index);
  };
  numbered.work.is_stopped = [&] { return num_begun >= 6; };
  TakeTurns(50, 2, kAny, numbered.work);
  EXPECT_THAT(num_begun.load(), Le(7));
  EXPECT_EQ(static_cast<int>(numbered.kept.size()), num_begun);
}

TEST(ScenarioTurns, TellProgressThatNeverFalls) {
  NumberedWork numbered;
  numbered.work.make = [&](const ScenarioTurn& turn) {
    for (const double done : {0.25, 0.5, 1.0}) turn.on_progress(done);
    return std::to_string(turn.index);
  };
  TakeTurns(12, 3, kAny, numbered.work);
  EXPECT_TRUE(std::ranges::is_sorted(numbered.progress));
  EXPECT_THAT(numbered.progress, Each(Le(12.0)));
}

TEST(ScenarioTurns, LetOneAtATimeTakeMuchMemory) {
  NumberedWork numbered;
  std::atomic<int> num_large = 0;
  numbered.work.make = [&](const ScenarioTurn& turn) {
    const std::unique_lock<std::mutex> memory = turn.await_memory();
    EXPECT_EQ(++num_large, 1);
    EXPECT_EQ(turn.num_threads_of_run, 4);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --num_large;
    return std::to_string(turn.index);
  };
  TakeTurns(12, 4, kAny, numbered.work);
  EXPECT_EQ(numbered.kept.size(), 12U);
}

class ScenarioLinesTest : public testing::Test {
 protected:
  void Write(const std::string& text) const {
    WriteFileWhole(directory_.path() / "scenarios.jsonl", text);
  }
  [[nodiscard]] ScenarioLines Open() const {
    return {directory_.path() / "scenarios.jsonl", {2, 3}};
  }
  TemporaryDirectory directory_;
};

/// A line of scenarios.jsonl.
std::string LineOf(int scenario) {
  return WithLineHash("{\"scenario\":" + std::to_string(scenario) + "}") + "\n";
}

TEST_F(ScenarioLinesTest, ComeOneAfterTheOtherAlsoAfterAPause) {
  Write(LineOf(1) + LineOf(4) + LineOf(7));
  ScenarioLines lines = Open();
  for (const int expected : {1, 4, 7}) {
    const auto line = lines.Next();
    ASSERT_TRUE(line);
    EXPECT_EQ(line->text + "\n", LineOf(expected));
    lines.Pause();
  }
  EXPECT_FALSE(lines.Next());
  EXPECT_EQ(lines.size(), 3U * LineOf(1).size());
}

TEST_F(ScenarioLinesTest, EndBeforeALineThatIsNotTheShardsNext) {
  const std::string first = LineOf(1);
  std::string changed = LineOf(4);
  changed.replace(changed.find("4"), 1, "04");
  const std::string torn = LineOf(4).substr(0, LineOf(4).size() - 1);
  for (const std::string& rest :
       {std::string(), torn, LineOf(2), changed, std::string("{\"scenario\":4}\n"),
        std::string("{\"scen\n"), std::string("[]\n"), std::string("{}\n")}) {
    Write(first + rest);
    ScenarioLines lines = Open();
    EXPECT_EQ(lines.Skip(), 1U) << rest;
    EXPECT_EQ(lines.size(), first.size());
    EXPECT_FALSE(lines.Next());
  }
}

TEST_F(ScenarioLinesTest, AreSkippedAsFarAsIsAskedFor) {
  Write(LineOf(1) + LineOf(4));
  ScenarioLines lines = Open();
  EXPECT_EQ(lines.Skip(1), 1U);
  EXPECT_EQ(lines.Next()->text + "\n", LineOf(4));
  EXPECT_EQ(lines.Skip(1), 0U);
}

TEST_F(ScenarioLinesTest, OfFinishedScenariosAreNamedIfTheyAreNotAsTheyWereWritten) {
  const std::string file = (directory_.path() / "scenarios.jsonl").string();
  const auto message = [&](const std::string& second) {
    Write(LineOf(1) + second);
    ScenarioLines lines = Open();
    EXPECT_EQ(lines.Need().text + "\n", LineOf(1));
    return MessageOf([&] { (void)lines.Need(); });
  };
  EXPECT_EQ(message(""), file + ":2: missing");
  EXPECT_EQ(message(LineOf(2)), file + ":2: must be the line of scenario 4 (got 2)");
  EXPECT_EQ(message("{\"scen\n"), file + ":2: must end with line_xxh3, the hash of all before it");
  EXPECT_EQ(message("{\"scenario\":4}\n"),
            file + ":2: must end with line_xxh3, the hash of all before it");
}

TEST_F(ScenarioLinesTest, AreNoneWithoutAFile) {
  EXPECT_EQ(Open().Skip(), 0U);
}

}  // namespace
}  // namespace railcast
