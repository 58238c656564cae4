#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/trace/trace_scene.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/memory_limit.h"

namespace railcast {
namespace {

// Runs `make` and prints the message of its exception. The process then exits with 1, or with 0 if
// nothing was thrown.
template <typename Make>
[[noreturn]] void EndAfter(std::size_t more_bytes, const Make& make) {
  LimitMemory(more_bytes);
  try {
    make();
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::_Exit(1);
  }
  std::_Exit(0);
}

// 980,000 triangles: 12 MB of indices, 6 MB of vertices, and about 100 MB of acceleration
// structure.
Model MakeLargeModel() {
  return {"ball", {{MakeSphere(1.0, 700, 700), 1, 1}}};
}

void BuildLargeModelWithin(std::size_t more_bytes) {
  const TraceDevice device;
  const Model model = MakeLargeModel();
  EndAfter(more_bytes, [&] { const TraceModel built(device, model); });
}

void BuildLargeSceneWithin(std::size_t more_bytes) {
  const TraceDevice device;
  const auto model =
      std::make_shared<const TraceModel>(device, Model{"wall", {{MakeWall(1.0F, 1.0F), 1, 1}}});
  const TracePlacement placement{model, {Eigen::Affine3d::Identity()}, 1};
  const std::vector<TracePlacement> placements(200'000, placement);
  EndAfter(more_bytes, [&] { const TraceScene scene(device, placements); });
}

void BuildSmallModelAfterALargeOneWithin(std::size_t more_bytes) {
  const TraceDevice device;
  const Model large = MakeLargeModel();
  const Model small{"wall", {{MakeWall(1.0F, 1.0F), 1, 1}}};
  EndAfter(more_bytes, [&] {
    try {
      const TraceModel built(device, large);
      std::_Exit(2);
    } catch (const InputError&) {
    }
    const TraceModel built(device, small);
  });
}

class OutOfMemoryDeathTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!kCanLimitMemory) GTEST_SKIP() << "sanitizers reserve more than can be limited";
    testing::FLAGS_gtest_death_test_style = "threadsafe";
  }
};

TEST_F(OutOfMemoryDeathTest, SaysWhichModelDoesNotFit) {
  const std::string line =
      "^out of memory while building \"ball\" for ray tracing \\(980000 triangles\\)\n$";
  // Less than the triangles need, and less than the acceleration structure needs.
  for (const std::size_t more_bytes : {8'000'000U, 60'000'000U}) {
    EXPECT_EXIT(BuildLargeModelWithin(more_bytes), testing::ExitedWithCode(1), line) << more_bytes;
  }
}

TEST_F(OutOfMemoryDeathTest, BuildsTheModelWithMoreMemory) {
  EXPECT_EXIT(BuildLargeModelWithin(2'000'000'000), testing::ExitedWithCode(0), "^$");
}

TEST_F(OutOfMemoryDeathTest, SaysHowManyPlacesDoNotFit) {
  EXPECT_EXIT(BuildLargeSceneWithin(30'000'000), testing::ExitedWithCode(1),
              "^out of memory while building a scene for ray tracing \\(200000 places\\)\n$");
}

TEST_F(OutOfMemoryDeathTest, LeavesNoErrorForTheNextModel) {
  EXPECT_EXIT(BuildSmallModelAfterALargeOneWithin(60'000'000), testing::ExitedWithCode(0), "^$");
}

}  // namespace
}  // namespace railcast
