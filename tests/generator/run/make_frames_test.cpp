#include "generator/run/make_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "core/io/content_hash.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/verification.h"
#include "generator/run/run_directory.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

std::string RunMessage(const SequenceSpec& spec) {
  return MessageOf([&] { (void)RunSequence(spec, MakeExampleFrame, NoHooks()); });
}

TEST(RunSequence, WritesEverythingThatASequenceHolds) {
  const TemporaryDirectory directory;
  const auto result =
      RunSequence(ExampleRun(directory.path(), "pcd", 2), MakeExampleFrame, NoHooks());
  EXPECT_TRUE(result.is_complete);
  EXPECT_EQ(result.num_done, 2U);
  std::vector<std::string> names;
  for (const auto& [name, bytes] : Contents(directory.path())) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{
                       "frames.jsonl", "frames/000003.pcd", "frames/000004.pcd",
                       "inputs/" + ContentHash("a table") + "/table.csv",
                       "inputs/" + ContentHash("a wagon") + "/wagon.obj", "labels.json",
                       "manifest.json", "materials.json", "objects.jsonl", "poses.csv", "run.json",
                       "scenario.resolved.json"}));
}

TEST(RunSequence, WritesTheSameBytesInTheSameOrderHoweverManyFramesAreMadeAtOnce) {
  for (const char* format : {"pcd", "kitti"}) {
    const TemporaryDirectory one;
    (void)RunSequence(ExampleRun(one.path(), format, 20), MakeExampleFrame, NoHooks());
    for (const std::size_t num : {2U, 3U, 7U, 30U}) {
      const TemporaryDirectory directory;
      std::vector<std::uint32_t> shown;
      const SequenceHooks hooks = {
          [&](std::uint32_t num_done, std::uint32_t) { shown.push_back(num_done); },
          [] { return false; }};
      const auto result = RunSequence(ExampleRun(directory.path(), format, 20), MakeUnevenFrame,
                                      hooks, {}, AtOnce(num));
      EXPECT_TRUE(result.is_complete);
      EXPECT_EQ(Contents(directory.path()), Contents(one.path())) << num;
      std::vector<std::uint32_t> all(21);
      std::iota(all.begin(), all.end(), 0U);
      EXPECT_EQ(shown, all);
    }
  }
}

TEST(RunSequence, HoldsTwiceAsManyFramesAsItMakesAtOnce) {
  constexpr std::size_t kAtOnce = 3;
  const TemporaryDirectory directory;
  std::mutex mutex;
  std::set<const Frame*> frames;
  std::atomic<std::size_t> num_begun = 0;
  std::atomic<std::size_t> num_written = 0;
  std::size_t most_ahead = 0;
  const ExampleFrames make = [&](std::uint32_t index, Frame& frame, auto& objects) {
    const std::size_t ahead = ++num_begun - num_written;
    MakeUnevenFrame(index, frame, objects);
    const std::lock_guard lock(mutex);
    frames.insert(&frame);
    most_ahead = std::max(most_ahead, ahead);
  };
  const SequenceHooks hooks = {
      [&](std::uint32_t num_done, std::uint32_t) { num_written = num_done; }, [] { return false; }};
  (void)RunSequence(ExampleRun(directory.path(), "pcd", 40), make, hooks, {}, AtOnce(kAtOnce));
  EXPECT_LE(frames.size(), 2 * kAtOnce);
  EXPECT_LE(most_ahead, 2 * kAtOnce + 1) << "one may be written and not yet counted";
  EXPECT_GT(most_ahead, 1U) << "some were made at once";
}

TEST(RunSequence, NamesMaterialsByTheIdsThatFramesCarry) {
  const TemporaryDirectory directory;
  (void)RunSequence(ExampleRun(directory.path(), "pcd", 1), MakeExampleFrame, NoHooks());
  const auto contents = Contents(directory.path());
  const auto materials = nlohmann::json::parse(contents.at("materials.json")).at("materials");
  EXPECT_EQ(materials, nlohmann::json::parse(R"([
    {"id": 0, "name": "none", "reflectivity": 0.0, "reflectivity_1550nm": 0.0,
     "facet_slope_deg": 0.0, "specular_f0": 0.0, "specular_f0_1550nm": 0.0,
     "specular_roughness": 0.3, "retroreflectance": 0.0},
    {"id": 1, "name": "ballast", "reflectivity": 0.25, "reflectivity_1550nm": 0.25,
     "facet_slope_deg": 0.0, "specular_f0": 0.0, "specular_f0_1550nm": 0.0,
     "specular_roughness": 0.3, "retroreflectance": 0.0},
    {"id": 2, "name": "rail_head", "reflectivity": 0.08, "reflectivity_1550nm": 0.08,
     "facet_slope_deg": 0.0, "specular_f0": 0.0, "specular_f0_1550nm": 0.0,
     "specular_roughness": 0.3, "retroreflectance": 0.0}])"));
  EXPECT_EQ(
      nlohmann::json::parse(contents.at("manifest.json")).at("files_xxh3").at("materials.json"),
      ContentHash(contents.at("materials.json")));
}

TEST(RunSequence, KeepsACopyOfEveryFileThatTheScenarioNames) {
  const TemporaryDirectory directory;
  const SequenceSpec spec = ExampleRun(directory.path());
  (void)RunSequence(spec, MakeExampleFrame, NoHooks());
  const auto contents = Contents(directory.path());
  EXPECT_EQ(contents.at("inputs/" + ContentHash("a wagon") + "/wagon.obj"), "a wagon");
  EXPECT_EQ(contents.at("inputs/" + ContentHash("a table") + "/table.csv"), "a table");
}

TEST(RunSequence, WritesOnlyNamesThatAreListed) {
  for (const char* format : {"pcd", "ply", "kitti"}) {
    const TemporaryDirectory directory;
    SequenceSpec spec = ExampleRun(directory.path(), format);
    spec.commands_jsonl = "{}\n";
    (void)RunSequence(spec, MakeExampleFrame, NoHooks());
    for (const auto& [name, bytes] : Contents(directory.path())) {
      EXPECT_TRUE(IsSequenceFile(name)) << name;
    }
  }
}

// The version of the program is recorded only in run.json, which the data's hash leaves out.
TEST(RunSequence, GivesTheSameDataTheSameHashWhoeverMadeThem) {
  const auto hashes_by = [](const std::string& version) {
    const TemporaryDirectory directory;
    SequenceSpec spec = ExampleRun(directory.path());
    spec.version = version;
    (void)RunSequence(spec, MakeExampleFrame, NoHooks());
    return nlohmann::json::parse(Contents(directory.path()).at("manifest.json"));
  };
  const auto one = hashes_by("0.1.0");
  const auto other = hashes_by("0.2.0");
  EXPECT_EQ(one.at("data_xxh3"), other.at("data_xxh3"));
  EXPECT_NE(one.at("files_xxh3").at("run.json"), other.at("files_xxh3").at("run.json"));
}

TEST(RunSequence, WritesKittisLayoutNumberedFromZero) {
  const TemporaryDirectory directory;
  (void)RunSequence(ExampleRun(directory.path(), "kitti", 2), MakeExampleFrame, NoHooks());
  const auto contents = Contents(directory.path());
  for (const char* name : {"velodyne/000000.bin", "velodyne/000001.bin", "labels/000000.label",
                           "labels/000001.label", "calib.txt"}) {
    EXPECT_TRUE(contents.contains(std::string("sequences/00/") + name)) << name;
  }
  EXPECT_TRUE(contents.contains("semantic-kitti-railcast.yaml"));
  EXPECT_EQ(contents.at("sequences/00/times.txt"), "0\n0.1\n");
  const std::string& poses = contents.at("sequences/00/poses.txt");
  double first = 0.0;
  std::istringstream(poses) >> first;
  EXPECT_NEAR(first, 1.0, 1e-15);
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 2);
}

TEST(RunSequence, GivesKittiTheIdsOfWhatMovesWhileItMoves) {
  const TemporaryDirectory directory;
  const ExampleFrames stopping = [](std::uint32_t index, Frame& frame, auto& objects) {
    MakeExampleFrame(index, frame, objects);
    if (index == 3) objects.front().velocity_world_mps = Vector3(0, 0.5, 0);
  };
  (void)RunSequence(ExampleRun(directory.path(), "kitti", 2), stopping, NoHooks());
  const auto classes_of = [&](const char* file) {
    const std::string bytes = ReadFileWhole(directory.path() / "sequences/00/labels" / file);
    std::set<std::uint32_t> classes;
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
      std::uint32_t stored = 0;
      std::memcpy(&stored, bytes.data() + i, 4);
      classes.insert(stored & 0xFFFFU);
    }
    return classes;
  };
  EXPECT_EQ(classes_of("000000.label"), (std::set<std::uint32_t>{256, 260}));
  EXPECT_EQ(classes_of("000001.label"), (std::set<std::uint32_t>{16, 260}));
}

TEST(RunSequence, NamesTheHashOfEveryFrameFile) {
  const TemporaryDirectory directory;
  (void)RunSequence(ExampleRun(directory.path()), MakeExampleFrame, NoHooks());
  const auto contents = Contents(directory.path());
  std::istringstream lines(contents.at("frames.jsonl"));
  std::string line;
  std::uint32_t index = 3;
  while (std::getline(lines, line)) {
    const auto record = ParseFrameLine(line);
    ASSERT_TRUE(record.has_value());
    EXPECT_EQ(record->frame, index++);
    ASSERT_EQ(record->files.size(), 1U);
    const std::string& bytes = contents.at(record->files[0].name);
    EXPECT_EQ(record->files[0].hash, ContentHash(bytes));
    EXPECT_EQ(record->files[0].bytes, bytes.size());
  }
  EXPECT_EQ(index, 9U);
}

TEST(RunSequence, TotalsItsFramesInTheManifest) {
  const TemporaryDirectory directory;
  const auto result = RunSequence(ExampleRun(directory.path()), MakeExampleFrame, NoHooks());
  FrameCounts expected;
  for (std::uint32_t index = 3; index < 9; ++index) {
    expected.Add(CountFrame(ExampleFrame(index), ExampleLabels()));
  }
  EXPECT_EQ(result.counts, expected);
  const auto manifest = nlohmann::json::parse(Contents(directory.path()).at("manifest.json"));
  EXPECT_EQ(manifest.at("seed"), 5);
  EXPECT_EQ(manifest.at("version"), "0.1.0");
  EXPECT_EQ(manifest.at("num_frames"), 6);
  EXPECT_EQ(manifest.at("points"), expected.points);
  EXPECT_EQ(manifest.at("outcomes").at("returned"), expected.outcomes[0]);
  EXPECT_EQ(manifest.at("points_per_label").at("wagon"), expected.points_per_label.at("wagon"));
}

TEST(RunSequence, HasNothingToDoInACompleteDirectory) {
  const TemporaryDirectory directory;
  (void)RunSequence(ExampleRun(directory.path()), MakeExampleFrame, NoHooks());
  const auto before = Contents(directory.path());
  const auto result = RunSequence(ExampleRun(directory.path()), MakeExampleFrame, NoHooks());
  EXPECT_TRUE(result.was_complete);
  EXPECT_EQ(result.num_done, 6U);
  EXPECT_EQ(Contents(directory.path()), before);
}

// Every file in turn is changed in its middle, extended, and removed.
TEST(RunSequence, MendsWhateverWasChangedInACompleteDirectory) {
  for (const char* format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    SequenceSpec spec = ExampleRun(directory.path(), format);
    spec.commands_jsonl = "{}\n";
    (void)RunSequence(spec, MakeExampleFrame, NoHooks());
    const auto whole = Contents(directory.path());
    for (const auto& [name, bytes] : whole) {
      std::string middle = bytes;
      middle[bytes.size() / 2] ^= 1;
      for (const auto& change : {middle, bytes + "\n", std::string()}) {
        // A damaged run.json cannot be parsed, and without a manifest the run counts as unfinished.
        if (name == "run.json" && change != bytes + "\n") continue;
        if (name == "manifest.json" && change.empty()) continue;
        std::filesystem::remove(directory.path() / name);
        if (!change.empty()) WriteFileWhole(directory.path() / name, change);
        const SequenceResult mended = RunSequence(spec, MakeExampleFrame, NoHooks());
        const std::string place = directory.path().string() + ": ";
        ASSERT_EQ(mended.changed.size(), 1U) << name;
        EXPECT_TRUE(mended.changed.front() == place + name + " was changed or removed" ||
                    mended.changed.front().starts_with(place + "frame "))
            << mended.changed.front();
        ASSERT_EQ(Contents(directory.path()), whole) << name;
      }
    }
  }
}

TEST(RunSequence, GoesOnBeyondNumbersOfSixDigits) {
  for (const std::string format : {"pcd", "objects"}) {
    const TemporaryDirectory directory;
    SequenceSpec spec = ExampleRun(directory.path(), format, 4);
    spec.start_frame = 999'998;
    EXPECT_TRUE(RunSequence(spec, MakeExampleFrame, NoHooks()).is_complete);
    const auto whole = Contents(directory.path());
    EXPECT_EQ(whole.contains("frames/1000001.pcd"), format == "pcd");
    EXPECT_THAT(VerifySequence(directory.path(), [](double) {}).faults, testing::IsEmpty());
    std::filesystem::remove(directory.path() / "manifest.json");
    std::filesystem::remove(directory.path() / "frames/1000000.pcd");
    const SequenceResult again = RunSequence(spec, MakeExampleFrame, NoHooks());
    EXPECT_EQ(again.num_resumed, format == "pcd" ? 2U : 4U);
    EXPECT_EQ(Contents(directory.path()), whole);
    for (const std::string name : {"frames/1000002.pcd", "frames/0999998.pcd"}) {
      std::filesystem::create_directories(directory.path() / "frames");
      WriteFileWhole(directory.path() / name, "mine");
      EXPECT_EQ(VerifySequence(directory.path(), [](double) {}).faults.size(), 1U) << name;
      EXPECT_THAT(
          RunMessage(spec),
          testing::HasSubstr("holds a file that does not belong to this run (" + name + ")"));
      std::filesystem::remove(directory.path() / name);
    }
  }
}

TEST(RunSequence, NamesTheFirstChangedFrameOfACompleteDirectory) {
  const TemporaryDirectory directory;
  (void)RunSequence(ExampleRun(directory.path()), MakeExampleFrame, NoHooks());
  std::filesystem::remove(directory.path() / "frames/000005.pcd");
  const auto mended = RunSequence(ExampleRun(directory.path()), MakeExampleFrame, NoHooks());
  EXPECT_EQ(mended.changed, std::vector<std::string>{directory.path().string() +
                                                     ": frame 5 was changed or removed"});
  EXPECT_EQ(mended.num_resumed, 2U);
}

TEST(RunSequence, HashesEveryFileThatItsFramesDoNot) {
  for (const char* format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    (void)RunSequence(ExampleRun(directory.path(), format), MakeExampleFrame, NoHooks());
    const auto contents = Contents(directory.path());
    const auto hashes = nlohmann::json::parse(contents.at("manifest.json")).at("files_xxh3");
    for (const auto& [name, bytes] : contents) {
      if (name == "manifest.json") continue;
      if (contents.at("frames.jsonl").find("\"" + name + "\"") != std::string::npos) continue;
      EXPECT_EQ(hashes.value(name, ""), ContentHash(bytes)) << name;
    }
  }
}

TEST(RunSequence, RefusesTheDirectoryOfAnotherRun) {
  const TemporaryDirectory directory;
  const SequenceSpec first = ExampleRun(directory.path());
  (void)RunSequence(first, MakeExampleFrame, NoHooks());
  const std::string place = directory.path().string() + ": ";
  SequenceSpec other = first;
  other.identity.scenario_hash = "7e0";
  EXPECT_EQ(RunMessage(other), place + "holds a run of another scenario; choose another --out");
  other.identity.inputs.pop_back();
  EXPECT_EQ(RunMessage(other), place + "holds a run of another scenario; choose another --out");
  other = first;
  other.identity.scenario_hash = "7e0";
  other.identity.inputs[1].hash = "c4a49ed";
  EXPECT_EQ(RunMessage(other),
            place + "holds a run with another content of table.csv; choose another --out");
  other = first;
  other.seed = 6;
  EXPECT_EQ(RunMessage(other),
            place + "holds another run: its seed is 5 (got 6); choose another --out");
  other = ExampleRun(directory.path(), "ply");
  EXPECT_EQ(RunMessage(other),
            place + "holds another run: its --format is pcd (got ply); choose another --out");
  other = first;
  other.start_frame = 0;
  EXPECT_EQ(RunMessage(other),
            place + "holds another run: its --start-frame is 3 (got 0); choose another --out");
  other = first;
  other.num_frames = 7;
  EXPECT_EQ(RunMessage(other),
            place + "holds another run: its --frames is 6 (got 7); choose another --out");
  other = first;
  other.files.fields = FieldSelection("x,y,z");
  EXPECT_NE(RunMessage(other).find("its --fields is x,y,z,"), std::string::npos);
  EXPECT_NE(RunMessage(other).find("(got x,y,z); choose another --out"), std::string::npos);
}

TEST(RunSequence, RefusesToMixProgramsAndInstructionSets) {
  const TemporaryDirectory directory;
  const SequenceSpec first = ExampleRun(directory.path());
  (void)RunSequence(first, MakeExampleFrame, NoHooks());
  SequenceSpec complete = first;
  complete.version = "0.1.0+14c4fad0a1b2";
  EXPECT_EQ(RunMessage(complete),
            directory.path().string() +
                ": is complete, made by railcast 0.1.0 (got 0.1.0+14c4fad0a1b2); use that one, or "
                "choose another --out");
  complete = first;
  complete.isa = "avx512";
  EXPECT_EQ(RunMessage(complete),
            directory.path().string() +
                ": is complete, made with instruction set avx2 (got avx512); add --isa avx2, or "
                "choose another --out");
  std::filesystem::remove(directory.path() / "manifest.json");
  const std::string place = directory.path().string() + ": must be continued ";
  SequenceSpec other = first;
  other.version = "0.1.0+14c4fad0a1b2";
  EXPECT_EQ(RunMessage(other),
            place +
                "by the railcast that began it, 0.1.0 (got 0.1.0+14c4fad0a1b2); use that one, "
                "or choose another --out");
  other = first;
  other.embree_version = "3.13.6";
  EXPECT_EQ(RunMessage(other),
            place +
                "by the Embree that began it, 3.13.5 (got 3.13.6); use that one, or choose "
                "another --out");
  other = first;
  other.isa = "avx512";
  EXPECT_EQ(RunMessage(other),
            place +
                "with the instruction set that it was begun with, avx2 (got avx512); add --isa "
                "avx2, or choose another --out");
}

TEST(RunSequence, RefusesARunThatIsNestedDeep) {
  const TemporaryDirectory directory;
  const SequenceSpec spec = ExampleRun(directory.path());
  (void)RunSequence(spec, MakeExampleFrame, NoHooks());
  constexpr std::size_t kDepth = 200'000;
  const std::string nested = std::string(kDepth, '[') + std::string(kDepth, ']');
  for (const std::string key : {"seed", "inputs", "version"}) {
    auto run = nlohmann::ordered_json::parse(RunJson(spec));
    run[key] = "NESTED";
    std::string text = run.dump();
    text.replace(text.find("\"NESTED\""), 8, nested);
    WriteFileWhole(directory.path() / "run.json", text);
    EXPECT_TRUE(RunMessage(spec).ends_with("choose another --out")) << key;
  }
}

// Returns the error of a run for a directory that holds a file of other origin.
std::string StrangerMessage(const std::filesystem::path& directory, const std::string& name) {
  return directory.string() + ": holds a file that does not belong to this run (" + name +
         "); move it away or choose another --out";
}

TEST(RunSequence, RefusesADirectoryWithOtherThings) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "letter.txt", "dear");
  EXPECT_EQ(RunMessage(ExampleRun(directory.path())),
            StrangerMessage(directory.path(), "letter.txt"));
  EXPECT_EQ(RunMessage(ExampleRun(directory.path() / "letter.txt")),
            (directory.path() / "letter.txt").string() + ": not a directory");
}

TEST(RunSequence, TakesNoFilesForItsOwnWhereThereIsNoRun) {
  const TemporaryDirectory directory;
  for (const std::string name : {"poses.csv", "frames/000003.pcd", "film.part"}) {
    const auto out = directory.path() / std::to_string(name.size());
    std::filesystem::create_directories((out / name).parent_path());
    WriteFileWhole(out / name, "dear");
    EXPECT_EQ(RunMessage(ExampleRun(out)), StrangerMessage(out, name));
    EXPECT_EQ(ReadFileWhole(out / name), "dear");
  }
  std::filesystem::create_directories(directory.path() / "killed");
  WriteFileWhole(directory.path() / "killed/run.json.part", "{");
  EXPECT_EQ(RunMessage(ExampleRun(directory.path() / "killed")), "no error");
}

TEST(RunSequence, RefusesLinksWhereverTheyLead) {
  const TemporaryDirectory directory;
  const auto out = directory.path() / "out";
  (void)RunSequence(ExampleRun(out), MakeExampleFrame, NoHooks());
  std::filesystem::create_directory(directory.path() / "elsewhere");
  std::filesystem::create_directory_symlink(directory.path() / "elsewhere", out / "notes");
  EXPECT_EQ(RunMessage(ExampleRun(out)),
            out.string() +
                ": holds a symbolic link, which no run makes (notes); move it away or "
                "choose another --out");
}

TEST(RunSequence, KeepsAnInputThatIsCalledAsIfItWereUnfinished) {
  const TemporaryDirectory directory;
  SequenceSpec spec = ExampleRun(directory.path());
  spec.identity.inputs.push_back(ExampleInput("wagon.part", "v 0 0 0"));
  (void)RunSequence(spec, MakeExampleFrame, NoHooks());
  std::filesystem::remove(directory.path() / "manifest.json");
  const auto copy = directory.path() / spec.identity.inputs.back().CopyName();
  WriteFileWhole(directory.path() / "frames/000003.pcd.part", "half");
  EXPECT_TRUE(RunSequence(spec, MakeExampleFrame, NoHooks()).is_complete);
  EXPECT_EQ(ReadFileWhole(copy), "v 0 0 0");
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "frames/000003.pcd.part"));
}

TEST(RunSequence, LeavesStrangersFilesInARunAlone) {
  // The run has frames 3 to 8.
  for (const std::string name :
       {"film.part", "frames/film.part", "frames/000003.pcd.bak", "notes/letter.txt",
        "frames/000009.pcd", "frames/000002.pcd", "frames/000003.ply", "frames/3.pcd",
        "inputs/0123456789abcdef/wagon.obj", "commands.jsonl", "sequences/00/poses.txt"}) {
    for (const bool is_complete : {false, true}) {
      const TemporaryDirectory directory;
      (void)RunSequence(ExampleRun(directory.path()), MakeExampleFrame, NoHooks());
      if (!is_complete) std::filesystem::remove(directory.path() / "manifest.json");
      std::filesystem::create_directories((directory.path() / name).parent_path());
      WriteFileWhole(directory.path() / name, "dear");
      EXPECT_EQ(RunMessage(ExampleRun(directory.path())), StrangerMessage(directory.path(), name));
      EXPECT_EQ(ReadFileWhole(directory.path() / name), "dear");
    }
  }
}

TEST(RunSequence, RefusesADirectoryThatIsBeingWritten) {
  const TemporaryDirectory directory;
  std::string said;
  const ExampleFrames starts_another = [&](std::uint32_t index, Frame& frame, auto& objects) {
    if (said.empty()) said = RunMessage(ExampleRun(directory.path()));
    MakeExampleFrame(index, frame, objects);
  };
  (void)RunSequence(ExampleRun(directory.path()), starts_another, NoHooks());
  EXPECT_EQ(said, directory.path().string() + ": another run is writing here");
}

}  // namespace
}  // namespace railcast
