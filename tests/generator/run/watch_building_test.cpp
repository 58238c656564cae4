#include "generator/run/stopping.h"

#include <gtest/gtest.h>

#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

TEST(WatchBuilding, EndsAFrameWhoseSceneIsNotBuiltYetOnceTheRunIsStopped) {
  Simulator simulator(std::make_shared<SimpleWorld>(), MakeRaster(10, 10, 1), TestMaterials(), {},
                      1);
  bool is_stopped = true;
  WatchBuilding(
      simulator, [&] { return is_stopped; }, true);
  Frame frame;
  EXPECT_THROW(simulator.Scan(0, frame), RunStopped);
  is_stopped = false;
  simulator.Scan(0, frame);
  EXPECT_EQ(frame.num_slots(), simulator.pattern().num_firings());
  // The scene has been built already, so the stop has no effect.
  is_stopped = true;
  simulator.Scan(1, frame);
  EXPECT_EQ(frame.index, 1U);
}

}  // namespace
}  // namespace railcast
