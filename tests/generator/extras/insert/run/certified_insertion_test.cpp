#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/write_file.h"
#include "core/scenario/json_text.h"
#include "railcast/io/recording.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/closed_loop.h"
#include "tests/generator/extras/insert/run/made_insertion.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CertifiedInsertion : public testing::Test {
 protected:
  CertifiedInsertion() {
    MadeSequenceSpec made = RunWith("pcd", "");
    made.num_frames = 3;
    (void)MakeSequence(Path("run"), made);
    (void)WriteRunPlan(folder_.path(), kBox);
  }
  [[nodiscard]] fs::path Path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] Ended Insert(const std::string& out,
                             const std::string& options,
                             const std::string& recording = "run") const {
    return Generate("insert " + Path(recording).string() + " " + Path("plan.json").string() +
                    " --out " + Path(out).string() + " " + options + " 2>&1");
  }
  [[nodiscard]] Json ReadJson(const std::string& file) const {
    return Json::parse(ReadFileWhole(Path(file)));
  }

  TemporaryDirectory folder_;
};

TEST_F(CertifiedInsertion, TellsItsErrorInItsManifestsAndOnTheTerminal) {
  const Ended ended = Insert("out", "--certify 2000%");
  ASSERT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, HasSubstr("firings were made anew on rung reference"));
  EXPECT_THAT(ended.said, HasSubstr("surface would take"));
  const Json certificate = ReadJson("out/manifest.json").at("certificate");
  EXPECT_EQ(certificate.at("cost_share"), 20.0);
  EXPECT_EQ(certificate.at("frames"), 3);
  EXPECT_GT(certificate.at("drawn"), 20);
  EXPECT_EQ(certificate.at("objects").at(0).at("name"), "crate");
  const Json& missed = certificate.at("all").at("missed");
  EXPECT_LE(missed.at("low"), missed.at("value"));
  EXPECT_LE(missed.at("value"), missed.at("high"));
  EXPECT_EQ(ReadJson("out/recording/manifest.json").at("certificate"), certificate);
}

TEST_F(CertifiedInsertion, HasTheFramesOfOneThatIsNot) {
  ASSERT_EQ(Insert("plain", "").status, 0);
  ASSERT_EQ(Insert("certified", "--certify 100%").status, 0);
  auto certified = FilesOf(Path("certified"));
  for (auto& [name, bytes] : FilesOf(Path("plain"))) {
    const std::string file = fs::path(name).filename();
    const bool has_certificate = file == "frames.jsonl" || file == "insert.jsonl" ||
                                 file == "run.json" || file == "manifest.json";
    EXPECT_EQ(certified.at(name) == bytes, !has_certificate) << name;
  }
  EXPECT_FALSE(ReadJson("plain/manifest.json").contains("certificate"));
}

TEST_F(CertifiedInsertion, HasTheSameBytesAtAnyNumberOfThreadsAndWhenItIsGoneOnWith) {
  ASSERT_EQ(Insert("one", "--certify 100% --threads 1").status, 0);
  ASSERT_EQ(Insert("four", "--certify 100% --threads 4").status, 0);
  EXPECT_EQ(FilesOf(Path("one")), FilesOf(Path("four")));
  // As a run that was stopped after its first frame leaves it.
  fs::remove(Path("four/manifest.json"));
  std::string lines = ReadFileWhole(Path("four/insert.jsonl"));
  lines.resize(lines.find('\n') + 1);
  std::ofstream(Path("four/insert.jsonl"), std::ios::binary) << lines;
  ASSERT_EQ(Insert("four", "--certify 100%").status, 0);
  EXPECT_EQ(FilesOf(Path("one")), FilesOf(Path("four")));
}

TEST_F(CertifiedInsertion, GivesEachFrameItsCertificateFromAnyFirstFrame) {
  fs::copy(Path("run/frames"), Path("clouds"));
  (void)WriteRunPlan(
      folder_.path(),
      R"({"name": "crate", "type": "box", "size_m": [2, 3, 3], "s_m": 20, "h_m": 0})",
      R"({"poses": "standing"})");
  const auto certificates = [&](const std::string& out) {
    std::vector<std::string> all;
    const auto recording = OpenRecording(Path(out));
    while (const auto read = recording->Next()) all.push_back((*read)().certificate_json);
    return all;
  };
  ASSERT_EQ(Insert("all", "--certify 1000%", "clouds").status, 0);
  ASSERT_EQ(Insert("last", "--certify 1000% --frames 2", "clouds").status, 0);
  const auto all = certificates("all");
  ASSERT_EQ(all.size(), 3U);
  EXPECT_NE(all[2], all[1]);
  EXPECT_THAT(certificates("last"), testing::ElementsAre(all[2]));
  EXPECT_FALSE(Json::parse(all[2]).at("drawn").empty());
}

TEST_F(CertifiedInsertion, IsAnotherRunWithAnotherShare) {
  ASSERT_EQ(Insert("out", "--certify 50% --frames 0").status, 0);
  const Ended other = Insert("out", "--certify 20% --frames 0");
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.said, HasSubstr("its --certify is 50% (got 20%)"));
}

TEST_F(CertifiedInsertion, IsRefusedWhereThereIsNothingToCertify) {
  EXPECT_THAT(Insert("out", "--certify 1").said,
              HasSubstr("--certify: must be off, or a share of the frames' time such as 1%"));
  const std::string points = "--certify: must be left out with --points-alone";
  EXPECT_THAT(Insert("out", "--certify 1% --points-alone").said, HasSubstr(points));
  (void)WriteRunPlan(folder_.path(), "");
  EXPECT_THAT(Insert("out", "--certify 1%").said,
              HasSubstr("--certify: must be off for a plan without objects"));
  Json plan = ReadJson("plan.json");
  plan["fidelity"] = "reference";
  WriteFileWhole(Path("plan.json"), plan.dump());
  (void)plan;
  EXPECT_EQ(Insert("out", "--certify 1%").status, 1);
  EXPECT_FALSE(fs::exists(Path("out")));
}

/// The returns of things in an inserted frame.
std::size_t NumOfThings(const InsertedFrame& inserted) {
  std::size_t num = 0;
  for (const SlotEdit& edit : inserted.edits) {
    num += edit.is_added && !edit.is_merged &&
           inserted.recorded.frame.outcome[edit.slot] == Outcome::kReturned;
  }
  return num;
}

TEST(ScreenedCertifier, CountsTheEchoesOfThingsThatTheReferenceGivesIfAllFiringsAreDrawn) {
  for (const Fidelity fidelity : {Fidelity::kSurface, Fidelity::kFootprint}) {
    const LoopSensor sensor = MakeLoopSensor("vlp16", fidelity, {12.0, -15.0, 15.0});
    const RecordedFirings recorded =
        RecordedOf(ScanLoop(sensor, MakeLoopScene(sensor.scenario)), sensor.pattern);
    const auto insert = [&](Fidelity at, std::optional<double> certify) {
      ScenarioSpec scenario = sensor.scenario;
      scenario.fidelity = at;
      const InsertPlan plan = PlanOf(scenario, ThingsAlone(scenario, LoopThings()), sensor.pattern);
      return Inserter(plan, 1, certify).Insert(recorded, 0);
    };
    const InsertedFrame own = insert(fidelity, 1e9);
    std::map<EchoVerdict, std::size_t> counts;
    for (const DrawnFiring& drawn : own.certificate->drawn) {
      for (const CertifiedEcho& echo : drawn.echoes) counts[echo.verdict] += echo.instance != 0;
    }
    const std::size_t found = counts[EchoVerdict::kFound];
    // A thing's echo that one rung merges with the recorded one has another instance there.
    EXPECT_GT(found, 100U);
    const auto reference = static_cast<double>(NumOfThings(insert(Fidelity::kReference, {})));
    EXPECT_NEAR(static_cast<double>(found + counts[EchoVerdict::kMissed]), reference,
                0.002 * reference);
    const auto of_own = static_cast<double>(NumOfThings(own));
    EXPECT_NEAR(static_cast<double>(found + counts[EchoVerdict::kFalse]), of_own, 0.01 * of_own);
  }
}

}  // namespace
}  // namespace railcast
