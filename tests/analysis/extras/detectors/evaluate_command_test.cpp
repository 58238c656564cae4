#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/io/net/udp.h"
#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/stream/live_stream.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using PlainJson = nlohmann::json;

/// 30 frames of an approach at 10 m/s towards a box that is 79 m ahead of the sensor at first, past
/// one beside the track.
class EvaluateCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    const auto scenario = folder_->Write("scenario.json", Scenario(""));
    run_ = scenario.parent_path() / "run";
    MakeRun(scenario, run_);
  }
  static void TearDownTestSuite() { delete folder_; }

  /// @param more Further keys, each followed by a comma.
  static std::string Scenario(const std::string& more) {
    const std::string scenarios = ScenariosDir().string();
    return R"({"version": 1, )" + more + R"(
      "lidar": {"range_max_m": 150, "scan": {"rate_hz": 10, "pattern": {"type": "raster",
                "horizontal_fov_deg": 20, "vertical_fov_deg": 20, "angular_resolution_deg": 0.5}}},
      "world": {"alignment": {"course": {"type": "elements", "elements": [
                  {"type": "straight", "length_m": 1000}]}},
                "vegetation": {"trees_per_hectare": 0, "grass": false},
                "objects": [
                  {"name": "box", "type": "box", "s_m": 480, "h_m": 0, "size_m": [2, 2, 3]},
                  {"name": "beside", "type": "box", "s_m": 470, "d_m": 3, "h_m": 0,
                   "size_m": [2, 2, 3]}]},
      "vehicle": {"start_s_m": 400, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},
      "materials": ")" +
           scenarios + R"(/materials/railway.json",
      "labels": ")" +
           scenarios + R"(/labels.json"})";
  }

  static void MakeRun(const std::filesystem::path& scenario, const std::filesystem::path& run) {
    const Ended made =
        RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() + " --out " + run.string() +
                   " --frames 30 --fields x,y,z,label,time_ns --fidelity geometry");
    if (made.status != 0) throw std::runtime_error(made.said);
  }

  /// Writes detections, one line for each frame of the run, and returns the file.
  /// @param axes That the lines say; none if empty.
  static std::string Detections(const std::string& name,
                                const std::function<PlainJson(const PlainJson& objects)>& of_frame,
                                const std::string& axes = "") {
    std::istringstream lines(ReadFileWhole(run_ / "objects.jsonl"));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      const PlainJson frame = PlainJson::parse(line);
      PlainJson reported = {{"frame", frame.at("frame")},
                            {"compensate", "sensor"},
                            {"detections", of_frame(frame.at("objects"))}};
      if (!axes.empty()) reported["axes"] = axes;
      text += reported.dump() + "\n";
    }
    return folder_->Write(name, text).string();
  }

  static PlainJson Evaluate(const std::string& options) { return EvaluateRun(run_, options); }

  static PlainJson EvaluateRun(const std::filesystem::path& run, const std::string& options) {
    const Ended ended =
        Analyze("evaluate " + run.string() + " " + options + " --format json 2>/dev/null");
    if (ended.status != 0) throw std::runtime_error("evaluate " + options);
    return PlainJson::parse(ended.said);
  }

  static PlainJson Rows(const PlainJson& report, const std::string& key) {
    for (const PlainJson& section : report.at("sections")) {
      for (const PlainJson& table : section.at("tables")) {
        if (table.at("key") == key) return table.at("rows");
      }
    }
    return PlainJson::array();
  }

  static inline TemporaryFolder* folder_ = nullptr;
  static inline std::filesystem::path run_;
};

PlainJson TrueBoxes(const PlainJson& objects) {
  PlainJson detections = PlainJson::array();
  for (const PlainJson& object : objects) detections.push_back(object.at("output"));
  return detections;
}

TEST_F(EvaluateCommand, FindsWhatTheReferenceDetectorDetects) {
  const std::filesystem::path out = run_.parent_path() / "report";
  const Ended ended = Analyze("evaluate " + run_.string() + " --out " + out.string());
  ASSERT_EQ(ended.status, 0) << ended.said;
  const PlainJson report = PlainJson::parse(ReadFileWhole(out / "evaluate.json"));
  const PlainJson runs = Rows(report, "runs");
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].at("object"), "box");
  EXPECT_EQ(runs[0].at("outcome"), "not known: begun too near");
  EXPECT_NEAR(runs[0].at("detected_at_m").get<double>(), 77.0, 0.1);
  EXPECT_NEAR(runs[0].at("needed_m").get<double>(), 135.0, 0.01);
  EXPECT_NEAR(runs[0].at("driven_m").get<double>(), 29.0, 1e-6);
  const PlainJson alarms = Rows(report, "false_alarms");
  EXPECT_EQ(alarms.back().at("at"), "all");
  EXPECT_EQ(alarms.back().at("alarms"), 0U);
  const PlainJson beside = Rows(report, "no_alarm");
  ASSERT_EQ(beside.size(), 1U);
  EXPECT_EQ(beside[0].at("object"), "beside");
  EXPECT_EQ(beside[0].at("verdict"), "no alarm");
  EXPECT_TRUE(exists(out / "report.html"));
}

TEST_F(EvaluateCommand, TakesWhatADetectorReported) {
  const std::string truth = Detections("truth.jsonl", TrueBoxes);
  EXPECT_NEAR(Rows(Evaluate("--detections " + truth), "runs")[0].at("detected_at_m").get<double>(),
              77.0, 0.1);
  const PlainJson late = Evaluate("--latency-ms 1000 --detections " + truth);
  EXPECT_NEAR(Rows(late, "runs")[0].at("detected_at_m").get<double>(), 67.0, 0.1);
  const std::string none =
      Detections("none.jsonl", [](const PlainJson&) { return PlainJson::array(); });
  EXPECT_EQ(Rows(Evaluate("--detections " + none), "runs")[0].at("outcome"), "not detected");
}

TEST_F(EvaluateCommand, FindsTheSameInWhatADetectorSentLive) {
  const std::string truth = Detections("filed.jsonl", TrueBoxes);
  const std::string live = (run_.parent_path() / "live.jsonl").string();
  ListeningProgram program(RAILCAST_SOURCE_DIR "/examples/collect_detections.py " +
                           EndpointText(OwnEndpoint()) + " --frames 30 --out " + live);
  std::vector<std::string> lines;
  std::istringstream text(ReadFileWhole(truth));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  const UdpReceiver detector(kAnyLoopbackPort);
  for (std::size_t i = lines.size(); i-- > 0;) detector.Answer(lines[i], program.at());
  EXPECT_EQ(program.Rest(), "frames: 30, from 0 to 29, 0 missing between; 0 repeated datagrams\n");
  EXPECT_EQ(program.ExitStatus(), 0);
  EXPECT_EQ(ReadFileWhole(live), ReadFileWhole(truth));
  EXPECT_EQ(Evaluate("--detections " + live).at("sections"),
            Evaluate("--detections " + truth).at("sections"));
}

// The stream's frames are those of the run, and the client of the examples is the detector.
TEST_F(EvaluateCommand, TakesWhatTheExampleDetectsInAStream) {
  const std::filesystem::path scenario =
      folder_->Write("vehicle.json", Scenario(R"("output": {"frame": "vehicle"},)"));
  const std::filesystem::path run = run_.parent_path() / "vehicle_run";
  MakeRun(scenario, run);
  const std::string file = (run_.parent_path() / "example.jsonl").string();
  ListeningProgram program(RAILCAST_SOURCE_DIR "/examples/collect_detections.py " +
                           EndpointText(OwnEndpoint()) + " --frames 30 --out " + file);
  const std::string host = EndpointText({program.at().address, 27'403});
  const std::string commands = EndpointText(UdpReceiver(kAnyLoopbackPort).at());
  const Ended ended = RunCommand(
      RAILCAST_GENERATE " stream " + scenario.string() +
      " --fidelity geometry --fields x,y,z --lockstep --pacing burst --duration 3 --to " + host +
      " --commands-port " + commands.substr(commands.find(':') + 1) +
      " & " RAILCAST_SOURCE_DIR "/examples/detections_client.py --frames 30 --stream " + host +
      " --commands " + commands + " --to " + EndpointText(program.at()) + "; wait");
  EXPECT_EQ(program.Rest(), "frames: 30, from 0 to 29, 0 missing between; 0 repeated datagrams\n")
      << ended.said;
  const PlainJson row = Rows(EvaluateRun(run, "--detections " + file), "runs").at(0);
  EXPECT_EQ(row.at("object"), "box");
  // As the reference detector's, less what the train runs during the scan of 0.1 s and while the
  // client computes.
  EXPECT_LT(row.at("detected_at_m").get<double>(), 77.0);
  EXPECT_GT(row.at("detected_at_m").get<double>(), 60.0);
}

// Python gives a run's points and boxes in the sensor's axes, whatever those of its files are.
TEST_F(EvaluateCommand, WantsToKnowTheAxesWherePointsAreInThoseOfTheVehicle) {
  const std::filesystem::path scenario =
      folder_->Write("axes.json", Scenario(R"("output": {"frame": "vehicle"},)"));
  const std::filesystem::path run = run_.parent_path() / "axes_run";
  MakeRun(scenario, run);
  const std::string unsaid = Detections("unsaid.jsonl", TrueBoxes);
  const Ended ended = Analyze("evaluate " + run.string() + " --format text --detections " + unsaid);
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.said, HasSubstr("unsaid.jsonl:1: /axes: missing, must be \"sensor\""));
  const PlainJson said =
      EvaluateRun(run, "--detections " + Detections("said.jsonl", TrueBoxes, "sensor"));
  EXPECT_NEAR(Rows(said, "runs").at(0).at("detected_at_m").get<double>(), 77.0, 0.1);
}

TEST_F(EvaluateCommand, CountsBoxesAndWarnsWhereNoneReachesIntoTheGauge) {
  const std::string truth = Detections("counted.jsonl", TrueBoxes);
  const PlainJson report = Evaluate("--detections " + truth);
  const PlainJson counts = Rows(report, "boxes").at(0);
  // Both objects in each of 30 frames, of which one is beside the track.
  EXPECT_EQ(counts.at("read"), 60U);
  EXPECT_EQ(counts.at("in_gauge"), 30U);
  EXPECT_EQ(counts.at("matched"), 30U);
  const auto warning = [](const std::string& file) {
    const Ended ended =
        Analyze("evaluate " + run_.string() + " --format text --detections " + file);
    EXPECT_EQ(ended.status, 0);
    const std::size_t begin = ended.said.find("WARNING: ");
    if (begin == std::string::npos) return std::string();
    return ended.said.substr(begin, ended.said.find('\n', begin) + 1 - begin);
  };
  const std::string run = "WARNING: " + run_.string();
  const std::string question = ": are they in the axes that their lines say?\n";
  EXPECT_EQ(warning(truth), "");
  // In the vehicle's axes the boxes are lower by the sensor's height of 2.5 m, of their own 3 m.
  EXPECT_EQ(warning(Detections("lower.jsonl", TrueBoxes, "vehicle")),
            run + ": of 30 boxes in the gauge none is of an object" + question);
  const std::string below = Detections("below.jsonl", [](const PlainJson&) {
    return PlainJson::array({{{"center_m", {40, 0, -6}}, {"size_m", {1, 1, 1}}}});
  });
  EXPECT_EQ(warning(below), run + ": of 30 boxes none reaches into the gauge" + question);
  const std::string none =
      Detections("empty.jsonl", [](const PlainJson&) { return PlainJson::array(); });
  EXPECT_EQ(warning(none), run + ": no box was read\n");
}

TEST_F(EvaluateCommand, CountsAlarmsAtWhatIsBesideAndAtNothing) {
  const std::string wrong = Detections("wrong.jsonl", [](const PlainJson& objects) {
    PlainJson detections = TrueBoxes(objects);
    // Wide enough to reach into the gauge.
    for (PlainJson& box : detections) box["size_m"][1] = 4;
    detections.push_back({{"center_m", {40, 0, 0}}, {"size_m", {1, 1, 1}}, {"class", "ghost"}});
    return detections;
  });
  const PlainJson report = Evaluate("--detections " + wrong);
  const PlainJson list = Rows(report, "each_false_alarm");
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].at("frame"), 2U);
  EXPECT_EQ(list[0].at("at"), "no object");
  EXPECT_EQ(list[0].at("cause"), "ghost");
  EXPECT_EQ(list[1].at("at"), "beside");
  EXPECT_EQ(Rows(report, "no_alarm")[0].at("verdict"), "false alarm");
  EXPECT_EQ(Rows(report, "false_alarms").back().at("alarms"), 2U);
}

TEST_F(EvaluateCommand, SaysWhatIsWrongInOneLine) {
  const auto fault = [](const std::string& options) {
    const Ended ended = Analyze("evaluate " + run_.string() + " --format text " + options);
    EXPECT_EQ(ended.status, 1);
    return ended.said;
  };
  const std::string truth = Detections("more.jsonl", TrueBoxes);
  EXPECT_THAT(fault("--detections " + truth + " " + truth),
              HasSubstr("--detections: must be a file for each run, 1 (got 2)"));
  const std::string beyond =
      folder_->Write("beyond.jsonl", "{\"frame\": 30, \"detections\": []}\n").string();
  EXPECT_THAT(fault("--detections " + beyond),
              HasSubstr("beyond.jsonl:1: /frame: must be a frame of the run (got 30)"));
  const Ended foreign = Analyze("evaluate " + (run_ / "frames").string() + " --format text");
  EXPECT_EQ(foreign.status, 1);
  EXPECT_THAT(foreign.said, HasSubstr("must be a sequence directory, which says what was on the "
                                      "track"));
}

}  // namespace
}  // namespace railcast
