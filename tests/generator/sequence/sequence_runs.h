#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/verify/verification.h"
#include "generator/run/make_frames.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"

namespace railcast {

inline std::vector<std::string> FaultsOf(const std::filesystem::path& directory) {
  return VerifySequence(directory, [](double) {}).faults;
}

/// Runs `railcast-generate sequence` of a project's scenario, for tests of formats that are one
/// file for a whole run.
class SequenceRuns : public testing::Test {
 protected:
  /// @param num_frames Of a whole run.
  explicit SequenceRuns(std::uint32_t num_frames)
      : frames_("--frames " + std::to_string(num_frames)), num_frames_(num_frames) {}

  /// Runs the program and returns what it said.
  std::string Run(const std::string& options, int status = 0) const {
    const Ended run = Generate("sequence " + scenario_.string() + " " + options);
    EXPECT_EQ(run.status, status) << run.said;
    return run.said;
  }
  [[nodiscard]] std::filesystem::path Out(const std::string& name) const {
    return folder_.path() / name;
  }
  [[nodiscard]] std::filesystem::path Make(const std::string& name,
                                           const std::string& options) const {
    Run(options + " --out " + Out(name).string());
    return Out(name);
  }
  /// Makes the first frames of a run, as if it were interrupted after them.
  /// @return What there is of each sensor's frames.
  std::vector<SequenceResult> MakeFirst(const std::string& name,
                                        const std::string& format,
                                        std::uint32_t num_frames) const {
    RunChoices choices;
    choices.directory = Out(name);
    choices.format = format;
    choices.num_frames = num_frames_;
    RunPlan plan = PlanRun(ReadScenario(scenario_), choices, scenario_.string());
    FrameMaker maker(plan.scenario, 2, plan.sensors.front().spec.isa);
    SetFrames(maker, plan);
    std::uint32_t num_begun = 0;
    const SequenceHooks hooks = {[](std::uint32_t, std::uint32_t) {},
                                 [&] { return num_begun++ >= num_frames; }};
    return MakeFrames(maker, plan, RunFolders(plan), hooks).sequences;
  }

  const std::string frames_;  ///< The option for a whole run.
  const TemporaryDirectory folder_;
  const std::filesystem::path scenario_ = MakeProject(folder_.path() / "project");

 private:
  std::uint32_t num_frames_;
};

}  // namespace railcast
