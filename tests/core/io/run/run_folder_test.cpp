#include "core/io/run/run_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/record/record_text.h"
#include "core/io/run/sensors_record.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class OutputPlaces : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text = "{}") const {
    fs::create_directories(Path(name).parent_path());
    WriteFileWhole(Path(name), text);
  }
  [[nodiscard]] fs::path Path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string Refusal(const std::string& own_file, const fs::path& got) const {
    return "--out: must be outside " + Path("run").string() +
           ", which holds nothing but what belongs to its " + own_file + " (got " + got.string() +
           ")";
  }
  static std::string FaultOf(const fs::path& out, bool may_be_own = false) {
    return MessageOf([&] { CheckIsOutside("--out", out, may_be_own); });
  }

 private:
  TemporaryDirectory directory_;
  fs::path folder_ = fs::canonical(directory_.path());
};

TEST_F(OutputPlaces, AreNotInFoldersOfRailcast) {
  for (const std::string name : {"frames.jsonl", "insert.jsonl", "convert.jsonl", "scenarios.jsonl",
                                 "approaches.jsonl", "scene.survey"}) {
    for (const std::string beside : {"run.json", "dataset.json", "study.json"}) {
      Write("run/" + beside);
    }
    Write("run/" + name);
    for (const std::string out : {"run", "run/stats", "run/frames/more"}) {
      EXPECT_EQ(FaultOf(Path(out)), Refusal(name, Path(out)));
    }
    EXPECT_EQ(FaultOf(Path("run"), true), "no error");
    EXPECT_EQ(FaultOf(Path("run/own"), true), Refusal(name, Path("run/own")));
    EXPECT_EQ(FaultOf(Path("run_stats")), "no error");
    fs::remove_all(Path("run"));
  }
}

TEST_F(OutputPlaces, AreNotBesideTheRunsOfSeveralSensors) {
  SensorsRecord record;
  record.sensors.push_back({.name = "front", .folder = "front", .num_frames = 1});
  Write("run/sensors.json", RecordFile(record));
  EXPECT_EQ(FaultOf(Path("run/stats")), Refusal("sensors.json", Path("run/stats")));
}

TEST_F(OutputPlaces, MayBeBesideFilesThatUsersNameAsRailcastDoes) {
  for (const std::string name : {"run.json", "dataset.json", "study.json", "sensors.json"}) {
    Write("mine/" + name);
  }
  EXPECT_EQ(FaultOf(Path("mine/stats")), "no error");
  for (const std::string name : {"frames.jsonl", "scenarios.jsonl", "approaches.jsonl"}) {
    Write("other/" + name);
  }
  EXPECT_EQ(FaultOf(Path("other/stats")), "no error");
}

TEST_F(OutputPlaces, AreFollowed) {
  Write("run/frames.jsonl");
  Write("run/run.json");
  fs::create_directory_symlink("run", Path("link"));
  EXPECT_EQ(FaultOf(Path("link/stats")), Refusal("frames.jsonl", Path("link/stats")));
  const fs::path before = fs::current_path();
  fs::current_path(Path("run"));
  const std::string within = FaultOf("stats");
  fs::current_path(before);
  EXPECT_EQ(within, Refusal("frames.jsonl", "stats"));
}

// A link to a file, to a folder or to nothing yet, wherever it is.
TEST_F(OutputPlaces, OfRunsHoldNoLinks) {
  Write("mine/file");
  fs::create_directory_symlink("run", Path("link"));
  for (const std::string name : {"run.json", "frames", "frames/000003.pcd", "a/b/c.part"}) {
    for (const std::string target : {"mine/file", "mine", "nothing"}) {
      fs::create_directories(Path("run/" + name).parent_path());
      fs::create_symlink(Path(target), Path("run/" + name));
      for (const fs::path& out : {Path("run"), Path("link")}) {
        EXPECT_EQ(MessageOf([&] { const FolderLock lock(out); }),
                  out.string() + ": holds a symbolic link, which no run makes (" + name +
                      "); move it away or choose another --out");
        EXPECT_EQ(MessageOf([&] { RefuseLinks(out, {"."}); }),
                  (out / name).string() + ": must not be a symbolic link");
      }
      fs::remove(Path("run/" + name));
      EXPECT_EQ(MessageOf([&] { const FolderLock lock(Path("link")); }), "no error");
    }
  }
}

TEST_F(OutputPlaces, OfCommandsMayHoldTheLinksOfOthers) {
  Write("out/mine/file");
  fs::create_directory_symlink("mine", Path("out/link"));
  EXPECT_EQ(MessageOf([&] { RefuseLinks(Path("out"), {"charts", "report.html"}); }), "no error");
  fs::create_directory_symlink("mine", Path("out/charts"));
  EXPECT_EQ(MessageOf([&] {
              RefuseLinks(Path("out"), {"charts", "report.html"});
            }),
            Path("out/charts").string() + ": must not be a symbolic link");
}

TEST_F(OutputPlaces, OfFilesAreNeitherInputsNorEachOther) {
  Write("a.json");
  Write("clouds/0.pcd");
  fs::create_hard_link(Path("a.json"), Path("same.json"));
  const auto fault_of = [&](const fs::path& summary, const fs::path& picture) {
    return MessageOf([&] {
      CheckOutputFiles({{"SCENARIO", Path("a.json")}, {"RECORDING", Path("clouds")}},
                       {{"--summary", summary}, {"--picture", picture}});
    });
  };
  EXPECT_EQ(fault_of(Path("b.json"), Path("c.png")), "no error");
  EXPECT_EQ(fault_of("", ""), "no error");
  EXPECT_EQ(fault_of("/dev/null", ""),
            "/dev/null: must be a regular file (got a character device)");
  for (const std::string name : {"a.json", "clouds/../a.json", "same.json"}) {
    EXPECT_EQ(fault_of(Path(name), ""),
              "--summary: must not be SCENARIO or in it (got " + Path(name).string() + ")");
  }
  EXPECT_EQ(fault_of("", Path("clouds/0.pcd")), "--picture: must not be RECORDING or in it (got " +
                                                    Path("clouds/0.pcd").string() + ")");
  EXPECT_EQ(fault_of(Path("p.png"), Path("p.png")),
            "--picture: must not be --summary or in it (got " + Path("p.png").string() + ")");
}

}  // namespace
}  // namespace railcast
