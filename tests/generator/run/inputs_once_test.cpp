#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/mesh/made_scenes.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/effort.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using PlainJson = nlohmann::json;

/// Counts how often other programs open files.
class Openings {
 public:
  explicit Openings(const std::vector<fs::path>& files) : watch_(::inotify_init1(IN_NONBLOCK)) {
    for (const fs::path& file : files) {
      const int number = ::inotify_add_watch(watch_, file.c_str(), IN_OPEN | IN_CLOSE);
      EXPECT_GE(number, 0) << file;
      names_[number] = file.filename().string();
    }
  }
  ~Openings() { ::close(watch_); }
  Openings(const Openings&) = delete;
  Openings& operator=(const Openings&) = delete;

  /// Since the last call, by the files' names. The system merges equal events, so that closings are
  /// watched, too: they lie between two openings.
  [[nodiscard]] std::map<std::string, int> Take() const {
    std::map<std::string, int> counts;
    for (const auto& [number, name] : names_) counts[name] = 0;
    alignas(inotify_event) std::array<char, 4096> events{};
    ssize_t size = 0;
    while ((size = ::read(watch_, events.data(), events.size())) > 0) {
      for (ssize_t at = 0; at < size;) {
        const auto* const event =
            reinterpret_cast<const inotify_event*>(events.data() + at);  // As inotify(7) says.
        if ((event->mask & IN_OPEN) != 0) ++counts[names_.at(event->wd)];
        at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      }
    }
    return counts;
  }

 private:
  int watch_;
  std::map<int, std::string> names_;
};

/// A project whose scenario names files of all kinds, some of them through others.
class InputsOnce : public testing::Test {
 protected:
  InputsOnce() {
    MakeProject(directory_.path());
    WriteFileWhole(Path("rock.obj"), "mtllib rock.mtl\n" + std::string(kPyramidObj));
    WriteFileWhole(Path("rock.mtl"), "newmtl grey\nKd 0.5 0.5 0.5\n");
    WriteFileWhole(Path("stone.ply"),
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                   "property float y\nproperty float z\nelement face 1\n"
                   "property list uchar int vertex_indices\nend_header\n"
                   "0 0 0\n1 0 0\n0 0 1\n3 0 1 2\n");
    std::string heights = "ncols 3\nnrows 3\nxllcorner -500\nyllcorner -1500\ncellsize 1500\n";
    WriteFileWhole(Path("hills.asc"), heights + "0 0 0\n0 0 0\n0 0 0\n");
  }

  [[nodiscard]] fs::path Path(const std::string& name) const { return directory_.path() / name; }
  /// The names of all files that are named.
  [[nodiscard]] std::vector<fs::path> Files() const {
    return {Path("beams.csv"), Path("rock.obj"), Path("rock.mtl"), Path("stone.ply"),
            Path("hills.asc")};
  }
  /// The path of a scenario with as many sensors.
  [[nodiscard]] std::string Scenario(int num_sensors) const {
    PlainJson scenario = PlainJson::parse(ReadFileWhole(Path("scenario.json")));
    scenario["world"]["terrain"]["elevation"] = {{"file", "hills.asc"}, {"origin_m", {0, 0, 0}}};
    scenario["world"]["objects"].push_back(
        {{"name", "stone"}, {"type", "mesh"}, {"file", "stone.ply"}, {"s_m", 455}, {"d_m", 4}});
    if (num_sensors > 1) {
      PlainJson lidar = scenario["lidar"];
      scenario.erase("lidar");
      for (int i = 0; i < num_sensors; ++i) {
        lidar["name"] = "lidar" + std::to_string(i);
        scenario["lidars"].push_back(lidar);
      }
    }
    const fs::path file = Path("of" + std::to_string(num_sensors) + ".json");
    WriteFileWhole(file, scenario.dump());
    return file.string();
  }
  [[nodiscard]] std::string Sequence(int num_sensors, const std::string& more = "") const {
    return "sequence " + Scenario(num_sensors) + " --frames 2 --out " +
           Path("run" + std::to_string(num_sensors)).string() + " " + more;
  }

  TemporaryDirectory directory_;
};

TEST_F(InputsOnce, AreOpenedOnceHoweverManySensorsThereAre) {
  const Openings openings(Files());
  const auto each_once = testing::Each(testing::Pair(testing::_, 1));
  for (const int num_sensors : {1, 2, 4}) {
    for (const std::string moment : {"new", "complete"}) {
      const Ended run = Generate(Sequence(num_sensors));
      ASSERT_EQ(run.status, 0) << run.said;
      EXPECT_THAT(openings.Take(), each_once) << num_sensors << " sensors, " << moment;
    }
    fs::remove(Path("run" + std::to_string(num_sensors)) /
               (num_sensors == 1 ? "manifest.json" : "lidar1/manifest.json"));
    ASSERT_EQ(Generate(Sequence(num_sensors)).status, 0);
    EXPECT_THAT(openings.Take(), each_once) << num_sensors << " sensors, unfinished";
  }
  for (const std::string command : {"check ", "stream --duration 0.1 --protocol railcast "}) {
    const Ended run = Generate(command + Scenario(1));
    ASSERT_EQ(run.status, 0) << run.said;
    EXPECT_THAT(openings.Take(), each_once) << command;
  }
}

TEST_F(InputsOnce, TakeMemoryAndSpaceOnceHoweverManySensorsThereAre) {
  constexpr std::size_t kSize = 40'000'000;
  for (const char* const name : {"hills.asc", "rock.obj"}) {
    const std::string bytes = ReadFileWhole(Path(name));
    WriteFileWhole(Path(name), bytes + std::string(kSize - bytes.size(), '\n'));
  }
  const std::string program = std::string(RAILCAST_GENERATE) + " ";
  const Effort one = EffortOf(program + Sequence(1));
  const Effort four = EffortOf(program + Sequence(4));
  EXPECT_LT(four.memory_kb, 1.1 * one.memory_kb);
  for (const auto& entry : fs::recursive_directory_iterator(Path("run4/lidar3/inputs"))) {
    if (entry.is_regular_file()) {
      EXPECT_EQ(entry.hard_link_count(), 4U) << entry.path();
    }
  }
}

TEST_F(InputsOnce, AreNotWrittenOver) {
  for (const fs::path& file : Files()) {
    const std::string bytes = ReadFileWhole(file);
    for (const std::string option : {"--summary ", "--picture "}) {
      const Ended run = Generate(Sequence(1, option + file.string()));
      EXPECT_EQ(run.status, 1);
      EXPECT_EQ(run.said,
                file.string() + ": must not be written over, since this command reads it\n");
      EXPECT_FALSE(fs::exists(Path("run1")));
    }
    const Ended checked = Generate("check " + Scenario(1) + " --resolved " + file.string());
    EXPECT_EQ(checked.status, 1) << checked.said;
    const Ended streamed = Generate("stream " + Scenario(1) + " --duration 0.1 --summary " +
                                    file.string() + " --protocol railcast");
    EXPECT_EQ(streamed.status, 1) << streamed.said;
    EXPECT_EQ(ReadFileWhole(file), bytes);
  }
}

}  // namespace
}  // namespace railcast
