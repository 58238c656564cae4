#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

// The beginning of a program that uses what a program of examples/ defines.
std::string Import(const std::string& name) {
  return "import sys\nsys.path.insert(0, '" RAILCAST_SOURCE_DIR "/examples')\nfrom " + name +
         " import *\n";
}

bool HasNumpy() {
  return RunCommand("/usr/bin/python3 -c 'import numpy'").status == 0;
}

// A vehicle and three wagons in a left-hand curve: one wagon is parked, one runs ahead, one
// approaches.
std::string CurveWithTraffic(const std::string& output, bool moves) {
  const auto motion = [&](const char* speed_mps, const char* more = "") {
    return R"("motion": {"profile": [{"time_s": 0, "speed_mps": )" +
           std::string(moves ? speed_mps : "0") + "}]" + more + "}";
  };
  return R"({
    "version": 1, "fidelity": "geometry",
    "lidar": {"file": ")" +
         kScenariosFolder + R"(sensors/vir2rail.json",
              "mount": {"position_m": [2, 0.5, 2.5], "yaw_deg": 10, "pitch_deg": 3}},
    "world": {
      "alignment": {"course": {"type": "elements", "elements": [
        {"type": "arc", "length_m": 2000, "radius_m": 900}]}},
      "tracks": [{"name": "main"}, {"name": "second", "offset_m": 4.0}],
      "vegetation": {"trees_per_hectare": 0, "grass": false},
      "objects": [
        {"name": "parked", "type": "open_wagon", "s_m": 1080, "d_m": -4.5},
        {"name": "ahead", "type": "flat_wagon", "s_m": 1040, )" +
         motion("25") + R"(},
        {"name": "coming", "type": "tank_wagon", "track": "second", "s_m": 1070, )" +
         motion("30", R"(, "reverse": true)") + R"(}]
    },
    "vehicle": {"start_s_m": 1000, )" +
         motion("40") + R"(},
    "output": )" +
         output + R"(,
    "materials": ")" +
         kScenariosFolder + R"(materials/railway.json",
    "labels": ")" +
         kScenariosFolder + R"(labels.json"
  })";
}

// Returns the output of examples/points_in_boxes.py, followed by `more`, run in a folder in which
// `out` is a sequence of that scenario.
std::string RunTheExample(const std::string& scenario, const std::string& more) {
  const TemporaryDirectory directory;
  const std::string folder = directory.path().string();
  WriteFileWhole(directory.path() / "scenario.json", scenario);
  const Ended made =
      Generate("sequence " + folder + "/scenario.json --frames 2 --out " + folder + "/out");
  EXPECT_EQ(made.status, 0) << made.said;
  WriteFileWhole(directory.path() / "program.py", Import("points_in_boxes") + more);
  const Ended run = RunCommand("cd " + folder + " && /usr/bin/python3 -BW ignore program.py");
  EXPECT_EQ(run.status, 0) << run.said;
  return run.said;
}

// Checks lines of name, points, points in the box; the last line of each name counts.
void ExpectAllPointsInTheirBoxes(const std::string& said) {
  for (const std::string name : {"parked", "ahead", "coming"}) {
    const std::size_t at = said.rfind(name + " ");
    ASSERT_NE(at, std::string::npos) << said;
    std::istringstream line(said.substr(at + name.size()));
    int num_points = 0;
    int num_in_box = 0;
    line >> num_points >> num_in_box;
    EXPECT_GT(num_points, 50) << said;
    EXPECT_EQ(num_in_box, num_points) << said;
  }
}

TEST(FileExamples, PutThePointsOfAMovingSceneIntoTheirBoxes) {
  if (!HasNumpy()) GTEST_SKIP() << "/usr/bin/python3 has no numpy";
  ExpectAllPointsInTheirBoxes(RunTheExample(CurveWithTraffic(R"({"frame": "sensor"})", true), ""));
}

TEST(FileExamples, ReadCompressedPcdAsTheyReadBinary) {
  if (!HasNumpy()) GTEST_SKIP() << "/usr/bin/python3 has no numpy";
  const TemporaryDirectory directory;
  const std::string folder = directory.path().string();
  WriteFileWhole(directory.path() / "scenario.json",
                 CurveWithTraffic(R"({"frame": "sensor"})", true));
  for (const std::string to : {"out", "compressed --format pcd-compressed"}) {
    const Ended made =
        Generate("sequence " + folder + "/scenario.json --frames 1 --out " + folder + "/" + to);
    ASSERT_EQ(made.status, 0) << made.said;
  }
  WriteFileWhole(directory.path() / "program.py",
                 Import("read_pcd") +
                     "frame = read_pcd('out/frames/000000.pcd')\n"
                     "other = read_pcd('compressed/frames/000000.pcd')\n"
                     "print('same', other.dtype == frame.dtype, other.shape == frame.shape,\n"
                     "      other.tobytes() == frame.tobytes())\n");
  const Ended run = RunCommand("cd " + folder + " && /usr/bin/python3 -BW ignore program.py");
  EXPECT_EQ(run.status, 0) << run.said;
  EXPECT_NE(run.said.find("same True True True"), std::string::npos) << run.said;
}

TEST(FileExamples, ShowThatPointsOfAStandingSceneLieInTheirOutputBoxesAsTheyAre) {
  if (!HasNumpy()) GTEST_SKIP() << "/usr/bin/python3 has no numpy";
  const std::string check_output_boxes =
      "for thing in lines('objects')[k]['objects']:\n"
      "    mine = points[points['instance'] == thing['instance']]\n"
      "    xyz = np.stack([mine[axis] for axis in 'xyz'], axis=1)\n"
      "    thing['world'] = thing['output']\n"
      "    print(thing['name'], len(mine), in_box(xyz, mine['time_ns'], thing, 0.005).sum())\n";
  for (const char* axes :
       {R"("sensor")", R"("vehicle")", R"("world", "origin_m": [800, 500, 2])"}) {
    for (const char* handedness : {R"("right")", R"("left")"}) {
      const std::string output =
          R"({"frame": )" + std::string(axes) + R"(, "handedness": )" + handedness + "}";
      SCOPED_TRACE(output);
      ExpectAllPointsInTheirBoxes(
          RunTheExample(CurveWithTraffic(output, false), check_output_boxes));
    }
  }
}

}  // namespace
}  // namespace railcast
