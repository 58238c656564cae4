#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/io/write_file.h"
#include "railcast/scenario.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/view_program.h"
#include "viewer/draw/stage.h"
#include "viewer/frames/frames.h"
#include "viewer/session/session.h"

namespace railcast {
namespace {

class BadInput : public Drawn {
 protected:
  static constexpr const char* kOnePoint =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
      "POINTS 1\nDATA ascii\n1 2 3\n";

  /// Expects one line of error, no picture and no crash.
  void ExpectFault(const std::string& arguments, const std::string& fault) const {
    const Ended ended = View("--screenshot " + PathOf("out.png") + " " + arguments);
    EXPECT_EQ(ended.status, 1) << arguments;
    EXPECT_EQ(ended.said, "error: " + fault + "\n") << arguments;
    EXPECT_FALSE(std::filesystem::exists(PathOf("out.png"))) << arguments;
  }
  /// Writes a file and expects an error that begins with its name.
  void ExpectFaultOf(const std::string& name,
                     const std::string& bytes,
                     const std::string& fault) const {
    Write(name, bytes);
    ExpectFault(PathOf(name), PathOf(name) + ": " + fault);
  }

  const std::string run_ = RecordedRun::Yard().path().string();
};

TEST_F(BadInput, SourcesThatAreMissingAreNamed) {
  for (const std::string name : {"gone", "gone.pcd", "gone.ply", "gone.bin", "gone.pcap"}) {
    ExpectFault(PathOf(name), PathOf(name) + ": no such file or directory");
  }
  std::filesystem::create_directories(PathOf("empty"));
  ExpectFault(
      PathOf("empty"),
      PathOf("empty") +
          ": must be a sequence or hold .pcd, .ply, .bin, .las, .xyz, .pts, .asc or .pc files (got "
          "neither)");
  ExpectFault(run_ + " --compare " + PathOf("gone"),
              PathOf("gone") + ": no such file or directory");
}

TEST_F(BadInput, LostOutputIsAFailure) {
  const Ended ended = View("--version > /dev/full");
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said, "stdout: not all of it could be written\n");
}

TEST_F(BadInput, EmptyFilesAreNamed) {
  ExpectFaultOf("empty.pcd", "", "is no PCD file: its header has no DATA line");
  ExpectFaultOf("empty.ply", "", "is no PLY file: its first line must be \"ply\"");
  for (const std::string name : {"empty.pcap", "empty.pcapng"}) {
    ExpectFaultOf(name, "", "truncated dump file; tried to read 4 file header bytes, only got 0");
  }
}

TEST_F(BadInput, GarbageIsNamed) {
  const std::string garbage = "\x8f\x03 this is \xff\x01 nothing\nat all\n\x7f";
  ExpectFaultOf("garbage.pcd", garbage,
                "is no PCD file: a header line begins with none of its keys");
  ExpectFaultOf("garbage.ply", garbage, "is no PLY file: its first line must be \"ply\"");
  ExpectFaultOf("garbage.bin", garbage,
                "must have 16 bytes for each point (got " + std::to_string(garbage.size()) + ")");
  ExpectFaultOf("garbage.pcap", garbage, "unknown file format");
  ExpectFaultOf("notes.txt", garbage,
                "line 1: must be numbers, or names of columns with x, y and z once each; --columns "
                "x,y,z,... names them (got \\x8f\\u0003 this is \\xff\\u0001 nothing)");
  ExpectFaultOf("cloud.xyzzy", garbage,
                "must be a directory or a .pcd, .ply, .bin, .las, .xyz, .pts, .asc, .pc, .txt, "
                ".csv, .pcap, .pcapng, .mcap or .db3 file");
}

TEST_F(BadInput, TruncatedFilesAreNamed) {
  const std::string pcd = ReadFileWhole(RecordedRun::Yard().path() / "frames/000000.pcd");
  const std::size_t header = pcd.find("DATA binary\n") + 12;
  ExpectFaultOf(
      "cut.pcd", pcd.substr(0, header + 1000),
      "POINTS: 28800 need " + std::to_string(pcd.size() - header) + " bytes, the file has 1000");
  ExpectFaultOf(
      "cut.bin", std::string(1601, '\0'),
      "must have 16 bytes for each point (got 1601); nor those of 3, 5, 6, 7, 8, 12 or "
      "16 numbers, of 4 of float64, or of rows; --kitti-columns N takes N numbers a point "
      "as they are");
  ExpectFaultOf("cut.ply",
                "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                "property float y\nproperty float z\nend_header\n123456789012",
                "element vertex: 3 points need 36 bytes, the file has 12");
}

TEST_F(BadInput, DamagedSequencesAreNamed) {
  std::filesystem::copy(run_, PathOf("cut"), std::filesystem::copy_options::recursive);
  std::filesystem::resize_file(PathOf("cut/frames/000001.pcd"), 5000);
  const Ended ended = View("--screenshot " + PathOf("out.png") + " --frame 1 " + PathOf("cut"));
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said.find("error: " + PathOf("cut/frames/000001.pcd: must have ")), 0U)
      << ended.said;
  EXPECT_EQ(std::ranges::count(ended.said, '\n'), 1);
  // The first frame is intact, and a video ends before the damaged one.
  EXPECT_GT(Draw(PathOf("cut")).width, 0);
  EXPECT_EQ(View("--video " + PathOf("video") + " " + PathOf("cut")).status, 1);
  EXPECT_TRUE(std::filesystem::exists(PathOf("video/000000.png")));
  EXPECT_FALSE(std::filesystem::exists(PathOf("video/000001.png")));
}

TEST_F(BadInput, FramesBeyondTheEndAreRefused) {
  ExpectFault(run_ + " --frame 6", run_ + ": has no frame 6 (it has 0 to 5)");
  ExpectFault(run_ + "/frames --frame 4294967295",
              run_ + "/frames: has no frame 4294967295 (it has 0 to 5)");
}

TEST_F(BadInput, ScenariosThatAreWrongAreRefused) {
  Write("cloud.pcd", kOnePoint);
  const auto with = [&](const std::string& scenario) {
    return PathOf("cloud.pcd") + " --scenario " + scenario;
  };
  ExpectFault(with(PathOf("gone.json")), PathOf("gone.json") + ": no such file");
  Write("cut.json", R"({"version": 1,)");
  ExpectFault(with(PathOf("cut.json")),
              PathOf("cut.json") +
                  ": line 1, column 14: syntax error while parsing object key - unexpected end of "
                  "input; expected string literal");
  const std::string scenario = RecordedRun::Yard().scenario_file().string();
  ExpectFault(with(scenario) + " --sensor roof", "sensor: must be \"Vir2Rail\" (got \"roof\")");
  // The messages of all malformed scenarios are tested where they are read; the program passes them
  // on, whichever they are.
  std::set<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(RAILCAST_SOURCE_DIR "/scenarios/malformed")) {
    if (entry.path().extension() == ".json") files.insert(entry.path());
  }
  constexpr std::size_t kEach = 12;
  for (std::size_t i = 0; const std::filesystem::path& file : files) {
    if (i++ % kEach != 0) continue;
    const Ended ended = View("--screenshot " + PathOf("out.png") + " " + with(file.string()));
    EXPECT_LE(ended.status, 1) << file << ended.said;
    EXPECT_TRUE(ended.status == 0 || ended.said.starts_with("error: ")) << file;
  }
}

TEST_F(BadInput, LabelsAndFieldsThatAreNotThereAreRefused) {
  Write("cloud.pcd", kOnePoint);
  const std::string cloud = PathOf("cloud.pcd");
  ExpectFault(run_ + " --select martian",
              "--select: must be labels of the recording (got martian)");
  ExpectFault(cloud + " --select wagon", "--select: must be labels of the recording (got wagon)");
  ExpectFault(cloud + " --select wagon --scenario " + RecordedRun::Yard().scenario_file().string(),
              cloud + ": has no field label to select by");
  ExpectFault(cloud + " --color-by taste",
              cloud + ": has no field taste to color by (has: range, height, x, y)");
  ExpectFault(run_ + " --color-range 0,1",
              run_ + "/frames/000000.pcd: field label has no scale with a range");
  ExpectFault(cloud + " --accumulate 4", cloud + ": frames without poses are not accumulated");
}

TEST_F(BadInput, AddressesThatCannotBeListenedToAreRefused) {
  ExpectFault("udp://127.0.0.1:99999",
              "the port must be a whole number from 1 to 65535 (got 127.0.0.1:99999)");
  ExpectFault("udp://192.0.2.1:27555",
              "cannot listen: Cannot assign requested address (got 192.0.2.1:27555)");
}

TEST_F(BadInput, CommandLinesThatDoNotGoTogetherEndWithTwo) {
  std::vector<std::string> wrong = {"", "a b", "--no-such-option a", "a --screenshot b --video c"};
  for (const std::string option : {"--color-by",
                                   "--frame -1",
                                   "--frame x",
                                   "--camera moon",
                                   "--size 10x10",
                                   "--size wide",
                                   "--size 100x100x100",
                                   "--size 20000x100",
                                   "--layout distance",
                                   "--layout changes",
                                   "--layout over",
                                   "--pick 1,1",
                                   "--screenshot b --pick 1,1 --pick 2,2 --pick 3,3",
                                   "--screenshot b --pick 1280,0",
                                   "--screenshot b --pick 1",
                                   "--screenshot b --pick -1,0",
                                   "--trace",
                                   "--eye 1,2,3",
                                   "--target 1,2,3",
                                   "--eye 1,2,3 --target 1,2,3",
                                   "--eye 1,2 --target 1,2,3",
                                   "--eye 1,2,3 --target 4,5,6 --camera top",
                                   "--eye nan,0,0 --target 1,2,3",
                                   "--eye a,b,c --target 1,2,3",
                                   "--sensor x",
                                   "--frames 3",
                                   "--frame -1",
                                   "--frame 0x1",
                                   "--accumulate 1.5",
                                   "--size 0x40x720",
                                   "--video v --frames 0",
                                   "--point-size 0",
                                   "--point-size 21",
                                   "--accumulate 0",
                                   "--accumulate 257",
                                   "--show fun",
                                   "--background pink",
                                   "--color-map jet",
                                   "--color-range 1,0",
                                   "--color-range nan,1",
                                   "--color-range 1",
                                   "--wait 0",
                                   "--wait nan",
                                   "--compare udp://127.0.0.1"}) {
    wrong.push_back(option + " " + run_);
  }
  wrong.emplace_back("'' --screenshot a.png");
  wrong.emplace_back("udp://127.0.0.1 --frame 1");
  wrong.push_back("udp://127.0.0.1 --compare " + run_);
  wrong.push_back("--from 127.0.0.1 " + run_);
  wrong.push_back("--image-port 27500 " + run_);
  wrong.emplace_back("--image-port 0 udp://127.0.0.1");
  for (const std::string& arguments : wrong) {
    const Ended ended = RunCommand("cd " + PathOf("") + " && " RAILCAST_VIEW " " + arguments);
    EXPECT_EQ(ended.status, 2) << arguments << '\n' << ended.said;
    EXPECT_TRUE(ended.said.ends_with("Run with --help for more information.\n")) << ended.said;
  }
  EXPECT_EQ(View("--scrennshot a.png " + run_).said,
            "unknown option, the nearest is --screenshot (got --scrennshot)\n"
            "Run with --help for more information.\n");
  EXPECT_TRUE(std::filesystem::is_empty(PathOf("")));
  EXPECT_EQ(View("--help").status, 0);
  EXPECT_EQ(View("--version").status, 0);
}

TEST_F(BadInput, OptionsWithCommasLeaveTheSourceAlone) {
  for (const std::string options :
       {"--show boxes,track", "--show boxes --show track", "--select wagon", "--pick 300,200",
        "--color-by range --color-range 0,9", "--eye 1,2,3 --target 4,5,6"}) {
    EXPECT_EQ(View("--size 640x480 --screenshot " + PathOf("out.png") + " " + options + " " + run_ +
                   " --frame 0")
                  .status,
              0)
        << options;
  }
}

// Inputs found by the fuzzers, under every extension that a reader accepts. They are read and drawn
// here as the program does, whose start takes longer than any of them; every tenth is the
// program's.
TEST_F(BadInput, FilesOfTheFuzzersCrashNothing) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> corpora = {
      {"cloud", {".pcd", ".ply", ".bin"}},
      {"capture", {".pcap", ".pcapng"}},
      {"velodyne", {".pcap"}},
      {"stream", {".pcd", ".pcap"}},
      {"command", {".json"}}};
  Write("cloud.pcd", kOnePoint);
  const DisplayConnection display;
  int num_shown = 0;
  int num_refused = 0;
  for (const auto& [corpus, extensions] : corpora) {
    for (const auto& entry :
         std::filesystem::directory_iterator(RAILCAST_FUZZ_CORPORA "/" + corpus)) {
      for (const std::string& extension : extensions) {
        const std::string file = PathOf("case" + extension);
        std::string bytes = ReadFileWhole(entry.path());
        // The fuzzer of clouds takes the format from the first byte.
        if (corpus == "cloud" && !bytes.empty()) bytes.erase(0, 1);
        Write("case" + extension, bytes);
        SCOPED_TRACE(entry.path());
        if ((num_shown + num_refused) % 10 == 0) {
          const std::string scenario =
              extension == ".json" ? PathOf("cloud.pcd") + " --scenario " : std::string();
          const Ended ended =
              View("--size 64x64 --screenshot " + PathOf("out.png") + " " + scenario + file);
          EXPECT_LE(ended.status, 1) << ended.said;
          EXPECT_TRUE(ended.status == 0 || ended.said.find("error: ") != std::string::npos);
        }
        try {
          RecordedFrames frames(extension == ".json" ? PathOf("cloud.pcd") : file);
          if (extension == ".json") frames.UseScenario(PickSensor(ReadScenario(file), {}));
          Session session({&frames}, {});
          if (!session.Seek(session.FirstPlace())) throw InputError("has no frame");
          Stage stage({64, 64});
          stage.UseCamera("all");
          stage.window().SetOffScreenRendering(true);
          stage.Show(session.Compose(), {});
          stage.window().Render();
          ++num_shown;
        } catch (const InputError& error) {
          EXPECT_STRNE(error.what(), "");
          ++num_refused;
        }
      }
    }
  }
  EXPECT_GT(num_shown, 5);
  EXPECT_GT(num_refused, 100);
}

}  // namespace
}  // namespace railcast
