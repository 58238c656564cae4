#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/analysis/analyze_program.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"

namespace railcast {
namespace {

// Two runs of one project, with a mesh and a firing table, as another machine gets them: elsewhere,
// and without the project.
class MovedSequence : public testing::Test {
 protected:
  void SetUp() override {
    const auto project = directory_.path() / "project";
    const std::string scenario = MakeProject(project).string();
    for (const std::string seed : {"1", "2"}) {
      const auto out = directory_.path() / ("made_" + seed);
      const Ended run = RunCommand(RAILCAST_GENERATE " sequence " + scenario +
                                   " --frames 2 --out " + out.string() + " --seed " + seed);
      ASSERT_EQ(run.status, 0) << run.said;
      std::filesystem::rename(out, directory_.path() / ("run_" + seed));
    }
    std::filesystem::remove_all(project);
  }
  // Of both runs.
  [[nodiscard]] Ended Analyze(const std::string& command) const {
    const std::string run = (directory_.path() / "run_").string();
    return railcast::Analyze(command + " " + run + "1 " + run + "2 --format text");
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(MovedSequence, IsReadByEveryCommandWithoutTheFilesItWasMadeOf) {
  for (const char* command : {"stats", "detect", "compare"}) {
    const Ended run = Analyze(command);
    EXPECT_EQ(run.status, 0) << command << ": " << run.said;
  }
}

}  // namespace
}  // namespace railcast
