#include "tests/core/scenario/scenario_schema.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

// After a change of a spec's description, regenerate the schemas with
//   RAILCAST_WRITE_SCHEMAS=1 build/release/tests/core/scenario/scenario_test
//     --gtest_filter='ScenarioSchemas.*'
TEST(ScenarioSchemas, ArePublishedAsTheReaderHasThem) {
  const auto folder = ScenariosDir() / "schema";
  for (const auto& [name, text] : ScenarioSchemas()) {
    if (std::getenv("RAILCAST_WRITE_SCHEMAS") != nullptr) std::ofstream(folder / name) << text;
    EXPECT_EQ(TextOf(folder / name), text) << name;
  }
  EXPECT_EQ(JsonFilesIn(folder).size(), ScenarioSchemas().size());
}

}  // namespace
}  // namespace railcast
