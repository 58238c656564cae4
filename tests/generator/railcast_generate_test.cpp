#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <thread>

#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(RailcastGenerate, ExplainsItself) {
  for (const char* command : {"", "sequence ", "check ", "world ", "trace "}) {
    EXPECT_THAT(Generate(std::string(command) + "--help"), ExitsWith(0, HasSubstr("Usage:")));
  }
}

TEST(RailcastGenerate, SaysWhichPointsAreInTheGauge) {
  const TemporaryDirectory directory;
  const std::string out = (directory.path() / "out").string();
  ASSERT_THAT(Generate("sequence " + kScenariosFolder + "brake_person.json --frames 2 --out " +
                       out + " --fields x,y,z,label,track_lateral_m,track_height_m,in_gauge"),
              ExitsWith(0));
  const auto frames = ReadAll(directory.path() / "out");
  ASSERT_EQ(frames.size(), 2U);
  ASSERT_EQ(frames[0].foreign.size(), 3U);
  std::size_t num_in_gauge = 0;
  for (std::size_t slot = 0; slot < frames[0].frame.x.size(); ++slot) {
    const float lateral_m = frames[0].foreign[0].values[slot];
    const bool is_in_gauge = frames[0].foreign[2].values[slot] == 1.0F;
    num_in_gauge += is_in_gauge ? 1U : 0U;
    // The vehicle's outline is 2 m to either side and 5 m high, within some decimetres.
    EXPECT_FALSE(is_in_gauge && std::abs(lateral_m) > 2.6F) << lateral_m;
    EXPECT_FALSE(is_in_gauge && frames[0].foreign[1].values[slot] > 6.5F);
  }
  EXPECT_GT(num_in_gauge, 0U);
}

TEST(RailcastGenerate, TakesMoreThreadsThanThereAreCores) {
  const TemporaryDirectory directory;
  const std::string num = std::to_string(std::thread::hardware_concurrency() + 6);
  EXPECT_THAT(Generate("sequence " + MakeProject(directory.path()).string() + " --frames 1 --out " +
                       (directory.path() / "out").string() + " --threads " + num),
              ExitsWith(0, testing::Not(HasSubstr("TBB"))));
}

TEST(RailcastGenerate, ExitsWithTwoOnWrongUsage) {
  EXPECT_EQ(Generate("").status, 2);
  EXPECT_EQ(Generate("sequence").status, 2);
  EXPECT_EQ(Generate("dance").status, 2);
  EXPECT_EQ(Generate("sequence a.json --out b --format las").status, 2);
  EXPECT_EQ(Generate("sequence a.json --out b --frames 0").status, 2);
  EXPECT_EQ(Generate("sequence a.json --out b --fidelity best").status, 2);
}

TEST(RailcastGenerate, FailsWhereItsOutputIsLost) {
  const TemporaryDirectory directory;
  const std::string scenario = kScenariosFolder + "minimal.json";
  const std::string out = (directory.path() / "out").string();
  for (const std::string& command :
       {std::string("--help"), "check " + scenario, "trace " + scenario + " --firing 0",
        "sequence " + scenario + " --frames 1 --out " + out}) {
    const Ended full = Generate(command + " > /dev/full");
    EXPECT_EQ(full.status, 1) << command;
    EXPECT_EQ(full.said, "stdout: no space left on device\n") << command;
    const Ended closed = Generate(command + " >&-");
    EXPECT_EQ(closed.status, 1) << command;
    EXPECT_EQ(closed.said, "stdout: bad file descriptor\n") << command;
  }
  // The output exceeds a buffer, so that it is refused long before the end.
  EXPECT_THAT(Generate("check " + scenario + " --resolved - > /dev/full"),
              ExitsWith(1, "stdout: not all of it could be written\n"));
}

TEST(RailcastGenerate, PrintsNothingRawThatComesFromOutside) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "a\nb\x1b[2J.json").string();
  EXPECT_EQ(Generate("check '" + file + "'").said,
            (directory.path() / "a\\nb\\u001b[2J.json").string() + ": no such file\n");
  const std::string scenario = kScenariosFolder + "minimal.json";
  const std::string out = (directory.path() / "o\nt\x1b[2J").string();
  EXPECT_THAT(Generate("sequence " + scenario + " --frames 1 --out '" + out + "'"),
              ExitsWith(0, AllOf(HasSubstr("/o\\nt\\u001b[2J"), testing::Not(HasSubstr("\x1b")))));
}

TEST(RailcastGenerate, RecordsWhatFidelityAutoChose) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path() / "project").string();
  const auto manifest_of = [&](const std::string& threads) {
    const auto out = directory.path() / ("out" + threads);
    EXPECT_THAT(Generate("sequence " + scenario + " --fidelity auto --frames 1 --threads " +
                         threads + " --out " + out.string()),
                ExitsWith(0, StartsWith("fidelity auto uses ")));
    return ReadFileWhole(out / "manifest.json");
  };
  const std::string manifest = manifest_of("1");
  EXPECT_NE(manifest.find("\"fidelity_choice\": {\n    \"effects\": ["), std::string::npos);
  EXPECT_EQ(manifest_of("2"), manifest);
}

TEST(RailcastGenerate, ReplaysOneFiringEffectByEffect) {
  const Ended run = Generate("trace " + kScenariosFolder + "minimal.json --frame 3 --firing 0");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.said.find("frame 3 firing 0 at 0 ns, slot 0\n"), 0U);
  for (const char* effect : {"\nhit ", "\nthreshold ", "\nnoise "}) {
    EXPECT_NE(run.said.find(effect), std::string::npos) << effect;
  }
  EXPECT_THAT(Generate("trace " + kScenariosFolder + "minimal.json --firing 28800"),
              ExitsWith(1, "--firing: must be < 28800, the firings of a frame (got 28800)\n"));
}

TEST(RailcastGenerate, ListsTheEchoesOfAFiringThatHasMoreThanOne) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "fog.json",
                 R"({"version": 1, "fidelity": "surface", "file": ")" + kScenariosFolder +
                     R"(minimal.json", "weather": {"visibility_m": 50}})");
  EXPECT_THAT(
      Generate("trace " + (directory.path() / "fog.json").string() + " --frame 3 --firing 1"),
      ExitsWith(0, AllOf(HasSubstr("\necho "), HasSubstr("\nfog "))));
}

TEST(RailcastGenerate, ExitsWithOneAndOneLineOnBadInput) {
  const TemporaryDirectory directory;
  const std::string out = " --out " + directory.path().string();
  EXPECT_THAT(Generate("sequence /no/such.json" + out),
              ExitsWith(1, "/no/such.json: no such file\n"));
  EXPECT_THAT(
      Generate("sequence " + kScenariosFolder + "minimal.json --format kitti --fields x,y,z" + out),
      ExitsWith(
          1,
          "--fields: KITTI's are fixed, so it must be left out with --format kitti (got x,y,z)\n"));
  EXPECT_THAT(Generate("world " + kScenariosFolder + "minimal.json --out a.stl"),
              ExitsWith(1, "--out: must end in .ply, .glb or .obj (got a.stl)\n"));
  const Ended stretch =
      Generate("world " + kScenariosFolder + "minimal.json --from-s 5 --to-s 1 --out a.ply");
  EXPECT_EQ(stretch.said, "--from-s, --to-s: must be 0 <= from < to <= 1000 (got 5, 1)\n");
}

TEST(RailcastGenerate, WritesNeitherOverItsScenarioNorTwoFilesAsOne) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path()).string();
  const std::string text = ReadFileWhole(scenario);
  const std::string sequence =
      "sequence " + scenario + " --frames 1 --out " + (directory.path() / "out").string();
  const std::string fault = "--summary: must not be SCENARIO or in it (got " + scenario + ")\n";
  EXPECT_THAT(Generate(sequence + " --summary " + scenario), ExitsWith(1, fault));
  EXPECT_THAT(Generate("stream " + scenario + " --duration 1 --to :9 --summary " + scenario),
              ExitsWith(1, fault));
  EXPECT_THAT(Generate("check " + scenario + " --resolved " + scenario),
              ExitsWith(1, "--resolved: must not be SCENARIO or in it (got " + scenario + ")\n"));
  EXPECT_EQ(ReadFileWhole(scenario), text);
  const std::string picture = (directory.path() / "p.png").string();
  EXPECT_THAT(Generate(sequence + " --picture " + picture + " --summary " + picture),
              ExitsWith(1, "--picture: must not be --summary or in it (got " + picture + ")\n"));
}

TEST(RailcastGenerate, WritesTheSummaryOfASequenceBesideItsDirectory) {
  const TemporaryDirectory directory;
  const std::filesystem::path out = directory.path() / "out";
  const std::string sequence = "sequence " + kScenariosFolder +
                               "minimal.json --format objects --frames 2 --out " + out.string() +
                               " --summary ";
  for (const std::string wrong : {"out/summary.json", "out/more/../summary.json", "out"}) {
    const std::string file = (directory.path() / wrong).string();
    EXPECT_THAT(Generate(sequence + file),
                ExitsWith(1, "--summary: must not be --out or in it (got " + file + ")\n"));
  }
  EXPECT_FALSE(std::filesystem::exists(out));
  const std::filesystem::path file = directory.path() / "out.json";
  EXPECT_THAT(Generate(sequence + file.string()), ExitsWith(0));
  const std::string begin = R"({"command":"sequence","sensors":[{"name":"Vir2Rail","directory":")" +
                            out.string() +
                            R"(","frames":2,"frames_done":2,"frames_made":2,"is_complete":true,)";
  EXPECT_EQ(ReadFileWhole(file).substr(0, begin.size()), begin);
}

TEST(RailcastGenerate, RefusesAMeshItCouldNotWriteBeforeItIsBuilt) {
  const Ended half = Generate("world " + kScenariosFolder + "minimal.json --from-s 5 --out a.ply");
  EXPECT_EQ(half.said,
            "--from-s, --to-s: must be given both or not at all (got only --from-s 5)\n");
  // No chunks are mentioned, because none was built.
  EXPECT_THAT(Generate("world " + kScenariosFolder + "minimal.json --out /no/such/a.ply"),
              ExitsWith(1, "/no/such/a.ply: no such file or directory\n"));
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory.path() / "a.ply");
  const std::string folder = (directory.path() / "a.ply").string();
  const Ended taken = Generate("world " + kScenariosFolder + "minimal.json --out " + folder);
  EXPECT_EQ(taken.said, folder + ": must be a regular file (got a directory)\n");
}

TEST(RailcastGenerate, GivesTheSameBytesForAnyNumberOfThreads) {
  const TemporaryDirectory directory;
  const std::string command = "sequence " + kScenariosFolder + "minimal.json --frames 2 --out " +
                              directory.path().string() + "/";
  for (const char* threads : {"1", "2", "8"}) {
    EXPECT_THAT(Generate(command + threads + " --threads " + threads),
                ExitsWith(0, HasSubstr("2 of 2 frames in ")));
  }
  const auto one = Contents(directory.path() / "1");
  EXPECT_EQ(Contents(directory.path() / "2"), one);
  EXPECT_EQ(Contents(directory.path() / "8"), one);
  const auto cloud = ReadPcd(directory.path() / "1/frames/000000.pcd");
  EXPECT_EQ(cloud.width, 240U);
  EXPECT_EQ(cloud.height, 120U);
}

TEST(RailcastGenerate, GivesTheSameManifestWhereverTheProjectLies) {
  const TemporaryDirectory directory;
  for (const char* place : {"here", "there"}) {
    const std::string scenario = MakeProject(directory.path() / place / "project").string();
    EXPECT_THAT(Generate("sequence " + scenario + " --frames 2 --out " +
                         (directory.path() / place / "out").string()),
                ExitsWith(0));
  }
  EXPECT_EQ(Contents(directory.path() / "here/out"), Contents(directory.path() / "there/out"));
}

TEST(RailcastGenerate, MakesADirectoryThatCanBeMadeAndTracedWithoutItsProject) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path() / "project").string();
  const auto out = directory.path() / "out";
  ASSERT_EQ(Generate("sequence " + scenario + " --frames 2 --out " + out.string()).status, 0);
  const std::string firing = " --frame 1 --firing 0";
  const Ended traced = Generate("trace " + scenario + firing);
  ASSERT_EQ(traced.status, 0) << traced.said;
  const auto made = Contents(out);
  std::filesystem::remove_all(directory.path() / "project");
  const auto moved = directory.path() / "moved";
  std::filesystem::rename(out, moved);
  const std::string resolved = (moved / "scenario.resolved.json").string();
  EXPECT_EQ(Generate("trace " + resolved + firing).said, traced.said);
  // Its own resolved scenario will do, too: an interrupted run can be continued from there.
  std::filesystem::remove(moved / "manifest.json");
  std::filesystem::remove(moved / "frames/000001.pcd");
  EXPECT_THAT(Generate("sequence " + resolved + " --frames 2 --out " + moved.string()),
              ExitsWith(0));
  EXPECT_EQ(Contents(moved), made);
}

TEST(RailcastGenerate, ResumesAMovedProjectButNotOneWithAChangedMesh) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path() / "old").string();
  const std::string out = " --frames 2 --out " + (directory.path() / "out").string();
  ASSERT_EQ(Generate("sequence " + scenario + out).status, 0);
  std::filesystem::remove(directory.path() / "out/manifest.json");
  std::filesystem::rename(directory.path() / "old", directory.path() / "new");
  const std::string moved = "sequence " + (directory.path() / "new/scenario.json").string() + out;
  WriteFileWhole(directory.path() / "new/rock.obj", std::string(kPyramidObj) + "f 1 2 3\n");
  EXPECT_THAT(Generate(moved),
              ExitsWith(1, (directory.path() / "out").string() +
                               ": holds a run with another content of rock.obj; choose another "
                               "--out\n"));
  WriteFileWhole(directory.path() / "new/rock.obj", kPyramidObj);
  EXPECT_EQ(Generate(moved).status, 0);
}

TEST(RailcastGenerate, RefusesToLeaveTheTrackBeforeTheFirstFrame) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "scenario.json").string();
  std::string scenario = ReadFileWhole(MakeProject(directory.path()));
  const std::string start = "{\"start_s_m\": 400}";
  scenario.replace(scenario.find(start), start.size(),
                   "{\"start_s_m\": 990, \"motion\": {\"profile\": "
                   "[{\"time_s\": 0, \"speed_mps\": 20}]}}");
  WriteFileWhole(file, scenario);
  const auto out = directory.path() / "out";
  EXPECT_THAT(
      Generate("sequence " + file + " --out " + out.string()),
      ExitsWith(1, file + ": /vehicle/motion: leaves track \"main\", from 0 to 1000 m, at frame "
                          "6 (0.6 s)\n"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(RailcastGenerate, NamesTheFileWhoseOutputIsOutOfReachAlsoOnTheWay) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "scenario.json").string();
  std::string scenario = ReadFileWhole(MakeProject(directory.path()));
  const std::string start = "\"vehicle\": {\"start_s_m\": 400}";
  scenario.replace(scenario.find(start), start.size(),
                   R"("output": {"frame": "world", "origin_m": [-7785, 0, 0]},
                      "vehicle": {"start_s_m": 400, "motion": {"profile":
                        [{"time_s": 0, "speed_mps": 50}]}})");
  WriteFileWhole(file, scenario);
  EXPECT_EQ(Generate("check " + file).status, 0);
  EXPECT_THAT(
      Generate("sequence " + file + " --out " + (directory.path() / "out").string()),
      ExitsWith(
          1, HasSubstr(file +
                       ": /output/origin_m: must lie within 8192 m of the sensor, since float32 "
                       "loses millimetres beyond (got [-7785, 0, 0], sensor at [410, 0, 2])\n")));
}

// Writes a scenario whose vehicle reaches the near side of a crate, 449.5 m, between frames 49
// and 50.
void MakeRunIntoACrate(const std::filesystem::path& file, const std::string& key = "") {
  std::string scenario = ReadFileWhole(MakeProject(file.parent_path()));
  const auto replace = [&](const std::string& what, const std::string& by) {
    scenario.replace(scenario.find(what), what.size(), by);
  };
  replace("\"objects\": [", R"("objects": [{"name": "crate", "type": "box", "s_m": 450, "h_m": 0.5,
                                           "size_m": [1, 1, 1]}, )");
  replace("\"vehicle\": {\"start_s_m\": 400}", R"("vehicle": {)" + key + R"("start_s_m": 400,
      "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]},
      "ego_boxes_m": [[-9, -0.9, 0, 0, 0.9, 3]]})");
  WriteFileWhole(file, scenario);
}

TEST(RailcastGenerate, SaysWhenTheBuffersOfTheCouplingScenarioTouch) {
  EXPECT_THAT(Generate("check " + kScenariosFolder + "coupling.json"),
              ExitsWith(0, testing::EndsWith(R"(contacts  in frames 0 to 5999:
          "wagon" touches "coupled_wagon" in frames 0 to 5999: 0.000 m apart at frame 0
          "wagon" touches "ego" in frames 64 to 5999: 0.000 m apart at frame 67
)")));
}

TEST(RailcastGenerate, RefusesToRunTheVehicleIntoAnObject) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "scenario.json").string();
  MakeRunIntoACrate(file);
  const std::string fault =
      file +
      ": /vehicle: must not be inside an object unless may_overlap is true (got 0.50 m inside "
      "\"crate\" at frame 50 (5 s))\n";
  EXPECT_THAT(Generate("check " + file), ExitsWith(1, fault));
  const std::filesystem::path out = directory.path() / "out";
  EXPECT_THAT(Generate("sequence " + file + " --frames 51 --out " + out.string()),
              ExitsWith(1, fault));
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(
      Generate("sequence " + file + " --start-frame 48 --frames 2 --out " + out.string()).status,
      0);
}

TEST(RailcastGenerate, RunsTheVehicleIntoAnObjectIfToldTo) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "scenario.json").string();
  MakeRunIntoACrate(file, "\"may_overlap\": true, ");
  const Ended check = Generate("check " + file);
  EXPECT_EQ(check.status, 0);
  // The vehicle leaves its track after frame 600. It is 9 m long, and the shortest way out is
  // aside: half the crate and half the vehicle.
  EXPECT_NE(check.said.find("contacts  in frames 0 to 600:\n"
                            "          \"crate\" overlaps \"ego\" in frames 50 to 59: "
                            "1.400 m deep at frame 51\n"),
            std::string::npos)
      << check.said;
  const std::filesystem::path out = directory.path() / "out";
  EXPECT_EQ(
      Generate("sequence " + file + " --start-frame 50 --frames 1 --out " + out.string()).status,
      0);
  EXPECT_NE(ReadFileWhole(out / "objects.jsonl")
                .find(R"("contacts":[{"with":"ego","overlap":true,"gap_m":-0.5}])"),
            std::string::npos);
}

TEST(RailcastGenerate, StartsAtAnyFrame) {
  const TemporaryDirectory directory;
  const std::string command = "sequence " + kScenariosFolder + "st_gallen_approach.json --out " +
                              directory.path().string() + "/";
  ASSERT_EQ(Generate(command + "all --frames 3").status, 0);
  ASSERT_EQ(Generate(command + "last --frames 1 --start-frame 2").status, 0);
  EXPECT_EQ(ReadFileWhole(directory.path() / "all/frames/000002.pcd"),
            ReadFileWhole(directory.path() / "last/frames/000002.pcd"));
}

TEST(RailcastGenerate, ChecksAScenario) {
  const Ended run = Generate("check " + kScenariosFolder + "st_gallen_approach.json");
  EXPECT_EQ(run.status, 0);
  for (const char* text :
       {"28800 firings a frame (120 rows x 240 columns)", "at most 288000 points/s",
        "7 curvature jumps smoothed", "152 gradient steps smoothed", "(-v lists them)",
        "foul_wagon: open_wagon, label wagon", "tree: 11 in full detail from 8 m, 7 at level 1"}) {
    EXPECT_NE(run.said.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(run.said.find("curvature at s "), std::string::npos);
  // On the same line, without what takes long to check.
  const Ended verbose = Generate("check -v " + kScenariosFolder + "forest_rain.json");
  EXPECT_NE(verbose.said.find("curvature at s "), std::string::npos);
}

TEST(RailcastGenerate, PrintsAResolvedScenarioThatReadsBackTheSame) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "resolved.json").string();
  const Ended first = Generate("check " + kScenariosFolder + "minimal.json --resolved -");
  EXPECT_EQ(first.status, 0);
  EXPECT_EQ(Generate("check " + kScenariosFolder + "minimal.json --resolved " + file).status, 0);
  EXPECT_EQ(ReadFileWhole(file), first.said);
  EXPECT_EQ(Generate("check " + file + " --resolved -").said, first.said);
}

TEST(RailcastGenerate, WritesTheSceneAsAMesh) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "world.ply").string();
  const Ended run =
      Generate("world " + kScenariosFolder + "minimal.json --from-s 400 --to-s 450 --out " + file);
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.said.find(" triangles of 1 chunk in " + file), std::string::npos);
  const auto megabytes = static_cast<double>(std::filesystem::file_size(file)) * 1e-6;
  std::istringstream first_line(run.said);
  std::string writing, triangles;
  std::size_t num_triangles = 0;
  double said_megabytes = 0.0;
  first_line >> writing >> num_triangles >> triangles >> said_megabytes;
  EXPECT_EQ(writing + " " + triangles, "writing triangles,");
  EXPECT_NEAR(said_megabytes, megabytes, 0.05);
  EXPECT_GT(ReadPly(file).width, 1000U);
}

TEST(RailcastGenerate, RefusesAMeshThatIsLargerThanAskedFor) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path()).string();
  // With plants, for whose numbers the lengths in text are estimated.
  std::string text = ReadFileWhole(scenario);
  const std::string begin = "\"vegetation\": {";
  const std::size_t at = text.find(begin);
  WriteFileWhole(scenario, text.erase(at, text.find("},", at) + 2 - at));
  const std::regex rule(
      "--max-mb: the file must have at most 1 MB \\(got (\\d+) triangles, (.+) MB, by chunk 1 of "
      "1\\); "
      "choose a shorter stretch by --from-s and --to-s, or more by --max-mb\n");
  for (const std::string name : {"a.ply", "a.glb", "a.obj"}) {
    const std::filesystem::path file = directory.path() / name;
    const std::string command =
        "world " + scenario + " --from-s 400 --to-s 450 --out " + file.string();
    const Ended refused = Generate(command + " --max-mb 1");
    EXPECT_EQ(refused.status, 1);
    EXPECT_FALSE(std::filesystem::exists(file));
    std::smatch said;
    ASSERT_TRUE(std::regex_match(refused.said, said, rule)) << refused.said;
    const Ended written = Generate(command);
    EXPECT_EQ(written.said.find("writing " + said[1].str() + " triangles, "), 0U) << written.said;
    const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(file));
    // Only the lengths of numbers in text are estimated; headers have less than 0.05 MB.
    const double tolerance = name == "a.obj" ? 0.1 * megabytes : 0.1;
    EXPECT_NEAR(std::stod(said[2]), megabytes, tolerance) << name;
  }
}

// Of PCL, what reads and writes files depends on VTK, which is most of what a user would install.
TEST(RailcastGenerate, LoadsNeitherPclNorVtkNorGdal) {
  const Ended run = RunCommand("ldd " RAILCAST_GENERATE);
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.said.find("libembree"), std::string::npos) << run.said;
  for (const std::string library : {"libpcl", "libvtk", "libgdal"}) {
    EXPECT_EQ(run.said.find(library), std::string::npos) << run.said;
  }
}

}  // namespace
}  // namespace railcast
