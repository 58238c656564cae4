#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/write_file.h"
#include "core/scenario/json_text.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CertifiedRun : public testing::Test {
 protected:
  CertifiedRun() {
    std::ofstream(folder_.path() / "scenario.json")
        << R"({"version": 1, "file": ")" << RAILCAST_SOURCE_DIR
        << R"(/scenarios/minimal.json", "fidelity": "surface"})";
  }
  [[nodiscard]] Ended Make(const std::string& out, const std::string& options) const {
    return Generate("sequence " + Path("scenario.json") + " --out " + Path(out) + " " + options);
  }
  [[nodiscard]] std::string Path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] std::map<std::string, std::string> ContentsOf(const std::string& out) const {
    return Contents(folder_.path() / out);
  }
  [[nodiscard]] Json ManifestOf(const std::string& out) const {
    return Json::parse(ReadFileWhole(folder_.path() / out / "manifest.json"));
  }

  TemporaryDirectory folder_;
};

TEST_F(CertifiedRun, TellsItsErrorInTheManifestAndOnTheTerminal) {
  const Ended ended = Make("out", "--frames 3 --certify 50%");
  ASSERT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, HasSubstr("firings were made anew on rung reference"));
  EXPECT_THAT(ended.said, HasSubstr("footprint would take"));
  const Json certificate = ManifestOf("out").at("certificate");
  EXPECT_EQ(certificate.at("cost_share"), 0.5);
  EXPECT_EQ(certificate.at("frames"), 3);
  EXPECT_GT(certificate.at("drawn"), 20);
  const Json& missed = certificate.at("all").at("missed");
  EXPECT_LE(missed.at("low"), missed.at("value"));
  EXPECT_LE(missed.at("value"), missed.at("high"));
}

TEST_F(CertifiedRun, HasTheFramesOfOneThatIsNot) {
  ASSERT_EQ(Make("plain", "--frames 2").status, 0);
  ASSERT_EQ(Make("certified", "--frames 2 --certify 50%").status, 0);
  auto certified = ContentsOf("certified");
  for (auto& [name, bytes] : ContentsOf("plain")) {
    const bool has_certificate =
        name == "frames.jsonl" || name == "run.json" || name == "manifest.json";
    EXPECT_EQ(certified.at(name) == bytes, !has_certificate) << name;
  }
  EXPECT_FALSE(ManifestOf("plain").contains("certificate"));
}

TEST_F(CertifiedRun, HasTheSameBytesAtAnyNumberOfThreadsAndWhenItIsGoneOnWith) {
  ASSERT_EQ(Make("one", "--frames 4 --certify 50% --threads 1").status, 0);
  ASSERT_EQ(Make("four", "--frames 4 --certify 50% --threads 4").status, 0);
  EXPECT_EQ(ContentsOf("one"), ContentsOf("four"));
  // As a run that was stopped after two frames leaves it.
  fs::remove(folder_.path() / "four/manifest.json");
  std::string lines = ReadFileWhole(folder_.path() / "four/frames.jsonl");
  lines.resize(lines.find('\n', lines.find('\n') + 1) + 1);
  std::ofstream(folder_.path() / "four/frames.jsonl", std::ios::binary) << lines;
  ASSERT_EQ(Make("four", "--frames 4 --certify 50%").status, 0);
  EXPECT_EQ(ContentsOf("one"), ContentsOf("four"));
}

TEST_F(CertifiedRun, IsAnotherRunWithAnotherShare) {
  ASSERT_EQ(Make("out", "--frames 1 --certify 50%").status, 0);
  const Ended other = Make("out", "--frames 1 --certify 20%");
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.said, HasSubstr("its --certify is 50% (got 20%)"));
  EXPECT_THAT(Make("out", "--frames 1").said, HasSubstr("its --certify is 50% (got off)"));
}

TEST_F(CertifiedRun, RefusesSharesThatAreNoneAndTheReferenceItself) {
  const std::string rule = "--certify: must be off, or a share of the frames' time such as 1%";
  for (const std::string share : {"1", "0%", "-1%", "nan%", "x%", "10001%", "''"}) {
    const Ended ended = Make("out", "--frames 1 --certify " + share);
    EXPECT_EQ(ended.status, 1) << share;
    EXPECT_THAT(ended.said, HasSubstr(rule)) << share;
  }
  const Ended reference = Make("out", "--frames 1 --fidelity reference --certify 1%");
  EXPECT_EQ(reference.status, 1);
  EXPECT_THAT(reference.said, HasSubstr("--certify: must not be given at fidelity reference"));
  EXPECT_FALSE(fs::exists(folder_.path() / "out/manifest.json"));
}

TEST_F(CertifiedRun, TellsOfFidelityAutoWhereItsToleranceHeld) {
  // The choice takes a time for each firing of the sensor.
  WriteFileWhole(Path("scenario.json"),
                 R"({"version": 1, "file": ")" RAILCAST_SOURCE_DIR
                 R"(/scenarios/minimal.json", "lidar": {"file": ")" RAILCAST_SOURCE_DIR
                 R"(/scenarios/sensors/vir2rail.json", "scan": {"rate_hz": 10, "pattern": {
                    "type": "raster", "horizontal_fov_deg": 60, "vertical_fov_deg": 30,
                    "angular_resolution_deg": 0.5}}}})");
  const Ended ended = Make("out", "--frames 2 --fidelity auto --certify 600%");
  ASSERT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, HasSubstr("the tolerance held for certain in 2 of 2 frames"));
  EXPECT_TRUE(ManifestOf("out").at("certificate").contains("tolerance"));
}

}  // namespace
}  // namespace railcast
