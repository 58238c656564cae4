#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "generator/check/check_report.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

using testing::HasSubstr;

TEST(CertificateBudget, SaysHowPreciselyAShareOfTheTimeWouldKnowARun) {
  ScenarioSpec scenario =
      ReadScenario(std::filesystem::path(RAILCAST_SOURCE_DIR) / "scenarios/minimal.json");
  scenario.fidelity = Fidelity::kSurface;
  const auto simulator = MakeSimulator(scenario, 0);
  const std::string text = CertificateBudgetText(scenario, 0.01, *simulator);
  EXPECT_THAT(text, HasSubstr("certified --certify 1% makes about 1."));
  EXPECT_THAT(text, HasSubstr(": 50 frames would know the share of missed echoes to +-"));
  EXPECT_THAT(text, HasSubstr("plausibility would take 0."));
  EXPECT_THAT(text, HasSubstr("footprint would take 8"));
}

}  // namespace
}  // namespace railcast
