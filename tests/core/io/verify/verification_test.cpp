#include "core/io/verify/verification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/io/content_hash.h"
#include "core/io/run/run_record.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/damaged_run.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> FaultsOf(const std::filesystem::path& directory) {
  return VerifySequence(directory, [](double) {}).faults;
}

/// A run of three example frames, starting at frame 3. The tests change its files one by one.
class Verify : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    SequenceSpec spec = ExampleRun(path(), GetParam(), 3);
    spec.commands_jsonl = "{}\n";
    (void)RunSequence(spec, MakeExampleFrame, NoHooks());
  }
  [[nodiscard]] const std::filesystem::path& path() const { return directory_.path(); }
  [[nodiscard]] bool is_kitti() const { return GetParam() == std::string("kitti"); }
  /// The fault lines, each without the folder.
  [[nodiscard]] std::vector<std::string> Faults() const {
    std::vector<std::string> faults = FaultsOf(path());
    for (std::string& fault : faults) {
      const std::string place = path().string() + "/";
      EXPECT_TRUE(fault.starts_with(place)) << fault;
      fault.erase(0, place.size());
    }
    return faults;
  }
  void Replace(const std::string& file, const std::string& from, const std::string& to) const {
    WriteFileWhole(path() / file, Replaced(ReadFileWhole(path() / file), from, to));
  }
  /// Replaces text and updates the manifest's own hash, so that only its contents are wrong.
  void ReplaceInManifest(const std::string& from, const std::string& to) const {
    const std::string whole = ReadFileWhole(path() / "manifest.json");
    const std::string members = whole.substr(0, whole.find(",\n  \"manifest_xxh3\"")) + "\n}\n";
    WriteFileWhole(path() / "manifest.json", WithManifestHash(Replaced(members, from, to)));
  }

 private:
  TemporaryDirectory directory_;
};

TEST_P(Verify, FindsNothingInWhatWasJustWritten) {
  const Verification found = VerifySequence(path(), [](double) {});
  EXPECT_THAT(found.faults, IsEmpty());
  EXPECT_EQ(found.num_frames, 3U);
  std::uint64_t num_bytes = 0;
  const auto contents = Contents(path());
  for (const auto& [name, bytes] : contents) num_bytes += bytes.size();
  EXPECT_EQ(found.num_files, contents.size() - 1);  // All files except the manifest.
  EXPECT_EQ(found.num_bytes, num_bytes - contents.at("manifest.json").size());
}

TEST_P(Verify, FindsAFlippedBitWhereverItIs) {
  for (const auto& [name, bytes] : Contents(path())) {
    WriteFileWhole(path() / name, Flipped(bytes, bytes.size() / 2));
    std::string said;
    try {
      for (const std::string& fault : Faults()) said += fault + "\n";
    } catch (const InputError& error) {
      said = error.what();  // A damaged run.json cannot be parsed.
    }
    // A damaged line of frames.jsonl may name another file.
    EXPECT_THAT(said, testing::AnyOf(HasSubstr(name), HasSubstr("frames.jsonl"))) << name;
    WriteFileWhole(path() / name, bytes);
  }
  EXPECT_THAT(Faults(), IsEmpty());
}

TEST_P(Verify, FindsWhatIsMissing) {
  for (const auto& [name, bytes] : Contents(path())) {
    if (name == "run.json") continue;
    std::filesystem::remove(path() / name);
    const auto faults = Faults();
    ASSERT_FALSE(faults.empty()) << name;
    EXPECT_EQ(faults.front(), name == "manifest.json" ? name + ": missing: the run is unfinished"
                                                      : name + ": no such file or directory");
    EXPECT_EQ(faults.size(), 1U) << name << testing::PrintToString(faults);
    WriteFileWhole(path() / name, bytes);
  }
}

TEST_P(Verify, FindsWhatIsTooMuch) {
  const std::string folder = is_kitti() ? "sequences/00/velodyne" : "frames";
  const std::string ninth = folder + (is_kitti() ? "/000009.bin" : "/000009.pcd");
  WriteFileWhole(path() / ninth, "");
  WriteFileWhole(path() / "letter.txt", "dear");
  const std::string rule = ": is named neither in manifest.json nor in frames.jsonl";
  EXPECT_THAT(Faults(), testing::UnorderedElementsAre(ninth + rule, "letter.txt" + rule));
}

TEST_P(Verify, FindsAMissingLineOnceAndGoesOn) {
  const std::string lines = ReadFileWhole(path() / "frames.jsonl");
  const std::size_t first = lines.find('\n') + 1;
  const std::size_t second = lines.find('\n', first) + 1;
  WriteFileWhole(path() / "frames.jsonl", lines.substr(0, first) + lines.substr(second));
  const auto faults = Faults();
  ASSERT_EQ(faults.size(), 3U + (is_kitti() ? 2U : 1U)) << testing::PrintToString(faults);
  EXPECT_THAT(faults[0], testing::StartsWith("frames.jsonl: must have the hash "));
  EXPECT_EQ(faults[1], "frames.jsonl: must have a line for each of 3 frames (got 2)");
  EXPECT_EQ(faults[2], "frames.jsonl:2: frame: must be 4, one after another (got 5)");
  // The file that the removed line named.
  EXPECT_THAT(faults[3], HasSubstr(": is named neither in manifest.json nor in frames.jsonl"));
}

TEST_P(Verify, ComparesTheManifestWithWhatItSumsUp) {
  const std::string whole = ReadFileWhole(path() / "manifest.json");
  const auto manifest = nlohmann::json::parse(whole);
  const std::string points = manifest.at("points").dump();
  ReplaceInManifest("\"points\": " + points, "\"points\": 1");
  EXPECT_THAT(Faults(), ElementsAre("manifest.json: /points: must be " + points +
                                    ", the sum over frames.jsonl (got 1)"));
  WriteFileWhole(path() / "manifest.json", whole);
  ReplaceInManifest("\"num_frames\": 3", "\"num_frames\": 4");
  EXPECT_THAT(Faults(),
              ElementsAre("manifest.json: /num_frames: must be 3, as run.json says (got 4)"));
  WriteFileWhole(path() / "manifest.json", whole);
  ReplaceInManifest("\"seed\": 5", "\"seed\": 6");
  EXPECT_THAT(Faults(), ElementsAre("manifest.json: /seed: must be 5, as run.json says (got 6)"));
  WriteFileWhole(path() / "manifest.json", whole);
  ReplaceInManifest("\"points\": " + points + ",", "\"points\": " + points + ", \"note\": 1,");
  EXPECT_THAT(Faults(), Contains(testing::StartsWith("manifest.json: /note: unknown key")));
  WriteFileWhole(path() / "manifest.json", whole);
  ReplaceInManifest("\"seed\": 5", "\"seed\": 5, \"seed\": 5");
  EXPECT_THAT(Faults(), Contains("manifest.json: /seed: duplicate key"));
  WriteFileWhole(path() / "manifest.json", whole);
  const std::string hash = manifest.at("data_xxh3");
  ReplaceInManifest(hash, "0000000000000000");
  EXPECT_THAT(Faults(), ElementsAre("manifest.json: /data_xxh3: must be " + hash +
                                    ", that of the files (got 0000000000000000)"));
  WriteFileWhole(path() / "manifest.json", whole);
  ReplaceInManifest("\"labels.json\"", "\"lables.json\"");
  EXPECT_THAT(Faults(), ElementsAre("manifest.json: /files_xxh3: must name labels.json",
                                    "manifest.json: must name files of a sequence (got "
                                    "lables.json)",
                                    "labels.json: is named neither in manifest.json nor in "
                                    "frames.jsonl"));
}

TEST_P(Verify, SaysThatTheManifestIsNotAsItWasWritten) {
  const std::string whole = ReadFileWhole(path() / "manifest.json");
  const std::string hash = nlohmann::json::parse(whole).at("manifest_xxh3");
  const std::string blank = Replaced(whole, "{\n ", "{\n\t");
  WriteFileWhole(path() / "manifest.json", blank);
  const std::string before = blank.substr(0, blank.find("  \"manifest_xxh3\""));
  EXPECT_THAT(Faults(),
              ElementsAre("manifest.json: /manifest_xxh3: must be " + ContentHash(before) +
                          ", that of all before it (got " + hash + ")"));
}

// Flips one bit of each byte, a different one from byte to byte.
TEST_P(Verify, FindsEveryFlippedByteOfWhatSaysWhatItHolds) {
  for (const char* name : {"manifest.json", "run.json", "frames.jsonl"}) {
    const std::string whole = ReadFileWhole(path() / name);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      std::string bytes = whole;
      bytes[i] = static_cast<char>(bytes[i] ^ (1U << (i % 8)));
      // Not WriteFileWhole(), which syncs to disk each time.
      std::ofstream(path() / name, std::ios::binary) << bytes;
      bool is_found = false;
      try {
        is_found = !Faults().empty();
      } catch (const InputError&) {
        is_found = true;  // A damaged run.json cannot be parsed.
      }
      EXPECT_TRUE(is_found) << name << ", byte " << i;
    }
    WriteFileWhole(path() / name, whole);
  }
  EXPECT_THAT(Faults(), IsEmpty());
}

TEST_P(Verify, TakesALinkForAFileOfItsName) {
  const TemporaryDirectory elsewhere;
  std::filesystem::create_directory_symlink(elsewhere.path(), path() / "folder");
  std::filesystem::create_symlink("loop", path() / "loop");
  const std::string rule = ": is named neither in manifest.json nor in frames.jsonl";
  EXPECT_THAT(Faults(), testing::UnorderedElementsAre("folder" + rule, "loop" + rule));
  std::filesystem::remove(path() / "manifest.json");
  std::filesystem::create_symlink("manifest.json", path() / "manifest.json");
  EXPECT_THAT(Faults(), testing::UnorderedElementsAre(
                            "manifest.json: too many levels of symbolic links",
                            "folder: is no file of a sequence", "loop: is no file of a sequence"));
}

TEST_P(Verify, ShowsNamesHarmlessly) {
  WriteFileWhole(path() / "a\x1b[2J\nb", "");
  EXPECT_THAT(Faults(), ElementsAre("a\\u001b[2J\\nb: is named neither in manifest.json nor in "
                                    "frames.jsonl"));
}

TEST_P(Verify, GoesAsFarAsAnUnfinishedRunDoes) {
  std::filesystem::remove(path() / "manifest.json");
  const std::string lines = ReadFileWhole(path() / "frames.jsonl");
  const std::size_t last = lines.rfind('\n', lines.size() - 2) + 1;
  WriteFileWhole(path() / "frames.jsonl", lines.substr(0, last + 5));  // An incomplete line.
  WriteFileWhole(
      path() / (is_kitti() ? "sequences/00/velodyne/000002.bin.part" : "frames/000005.pcd.part"),
      "half");
  const Verification found = VerifySequence(path(), [](double) {});
  EXPECT_EQ(found.num_frames, 2U);
  EXPECT_THAT(Faults(), ElementsAre("manifest.json: missing: the run is unfinished"));
  WriteFileWhole(path() / "letter.txt", "dear");
  const std::string scenario = ReadFileWhole(path() / "scenario.resolved.json");
  WriteFileWhole(path() / "scenario.resolved.json", scenario + " ");
  EXPECT_THAT(Faults(),
              ElementsAre("manifest.json: missing: the run is unfinished",
                          "scenario.resolved.json: must have the hash " + ContentHash(scenario) +
                              ", as run.json says (got " + ContentHash(scenario + " ") + ")",
                          "letter.txt: is no file of a sequence"));
}

// As older programs wrote them on rungs with wide beams.
TEST_P(Verify, FindsOcclusionsThatAreNone) {
  const auto out = path() / "older";
  SequenceSpec spec = ExampleRun(out, GetParam(), 2);
  const ExampleFrames make = [](std::uint32_t index, Frame& frame, auto& objects) {
    MakeExampleFrame(index, frame, objects);
    if (index == 4) objects[0].view = {6, 6, 6, 30};
  };
  (void)RunSequence(spec, make, NoHooks());
  EXPECT_THAT(
      FaultsOf(out),
      ElementsAre(out.string() + "/objects.jsonl:2: /objects/0/occlusion: must be >= 0 and <= "
                                 "1 (got -4.0)"));
}

/// A line of frames.jsonl of an unfinished run, which no manifest vouches for.
class VerifyUnfinished : public Verify {
 protected:
  void SetUp() override {
    Verify::SetUp();
    std::filesystem::remove(path() / "manifest.json");
  }
  /// The faults after a change to the line of the second frame.
  /// @param is_hashed Whether the line's own hash is adapted to the change.
  [[nodiscard]] std::vector<std::string> FaultsAfter(const std::string& from,
                                                     const std::string& to,
                                                     bool is_hashed) const {
    const std::string lines = ReadFileWhole(path() / "frames.jsonl");
    const std::size_t begin = lines.find('\n') + 1;
    const std::size_t end = lines.find('\n', begin);
    std::string line = Replaced(lines.substr(begin, end - begin), from, to);
    if (is_hashed) line = WithLineHash(line.substr(0, line.rfind(",\"line_xxh3\"")) + "}");
    WriteFileWhole(path() / "frames.jsonl", lines.substr(0, begin) + line + lines.substr(end));
    std::vector<std::string> faults = Faults();
    EXPECT_EQ(faults.front(), "manifest.json: missing: the run is unfinished");
    faults.erase(faults.begin());
    return faults;
  }
  [[nodiscard]] std::string cloud() const {
    return is_kitti() ? "sequences/00/velodyne/000001.bin" : "frames/000004.pcd";
  }
  [[nodiscard]] nlohmann::json SecondLine() const {
    std::istringstream lines(ReadFileWhole(path() / "frames.jsonl"));
    std::string line;
    for (int i = 0; i < 2; ++i) std::getline(lines, line);
    return nlohmann::json::parse(line);
  }
};

TEST_P(VerifyUnfinished, NoticesAChangedLine) {
  const std::string points = SecondLine().at("points").dump();
  const auto faults = FaultsAfter("\"points\":" + points, "\"points\":7", false);
  ASSERT_EQ(faults.size(), 2U) << testing::PrintToString(faults);
  EXPECT_THAT(faults[0], testing::StartsWith("frames.jsonl:2: /line_xxh3: must be "));
  EXPECT_EQ(faults[1], "frames.jsonl:2: /points: must be " + points + ", as counted in " + cloud() +
                           " (got 7)");
}

TEST_P(VerifyUnfinished, ComparesCountsWithTheCloudItself) {
  const nlohmann::json line = SecondLine();
  const std::string points = line.at("points").dump();
  EXPECT_THAT(FaultsAfter("\"points\":" + points, "\"points\":7", true),
              ElementsAre("frames.jsonl:2: /points: must be " + points + ", as counted in " +
                          cloud() + " (got 7)"));
}

TEST_P(VerifyUnfinished, ComparesLabelsAndOutcomesWithTheCloudItself) {
  if (is_kitti()) GTEST_SKIP() << "its labels are SemanticKITTI's, and it has no outcomes";
  const nlohmann::json line = SecondLine();
  const auto label = line.at("points_per_label").items().begin();
  const std::string count = "\"" + label.key() + "\":" + label.value().dump();
  EXPECT_THAT(FaultsAfter(count, "\"" + label.key() + "\":99", true),
              ElementsAre("frames.jsonl:2: /points_per_label/" + label.key() + ": must be " +
                          label.value().dump() + ", as counted in " + cloud() + " (got 99)"));
  const std::string lost = line.at("outcomes").at("no_surface").dump();
  EXPECT_THAT(FaultsAfter("\"no_surface\":" + lost, "\"no_surface\":0", true),
              Contains(HasSubstr("frames.jsonl:2: /outcomes")));
}

INSTANTIATE_TEST_SUITE_P(Formats, VerifyUnfinished, testing::Values("pcd", "kitti"));

INSTANTIATE_TEST_SUITE_P(Formats, Verify, testing::Values("pcd", "kitti"));

TEST(Verification, RefusesWhatIsNoSequence) {
  const TemporaryDirectory directory;
  EXPECT_EQ(MessageOf([&] { (void)FaultsOf(directory.path()); }),
            (directory.path() / "run.json").string() + ": no such file or directory");
}

TEST(VerifyFolder, NamesTheExtraThatAFolderIsOf) {
  for (const auto& [file, extra] : std::vector<std::pair<std::string, std::string>>{
           {"dataset.json", "recipe"}, {"insert.jsonl", "insert"}, {"convert.jsonl", "insert"}}) {
    const TemporaryDirectory directory;
    WriteFileWhole(directory.path() / file, "");
    EXPECT_THAT(MessageOf([&] { (void)VerifyFolder(directory.path(), [](double) {}); }),
                HasSubstr(file + ": needs the extra " + extra + ", which is not installed"));
  }
}

TEST(OpenRecording, NamesTheExtraThatAnInsertionNeeds) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "insert.jsonl", "");
  std::filesystem::create_directory(directory.path() / "recording");
  for (const std::string folder : {"", "recording"}) {
    EXPECT_THAT(MessageOf([&] { (void)OpenRecording(directory.path() / folder); }),
                HasSubstr("needs the extra insert, which is not installed"));
  }
}

}  // namespace
}  // namespace railcast
