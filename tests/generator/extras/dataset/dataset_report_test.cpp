#include "generator/extras/dataset/dataset_report.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace railcast {
namespace {

IndexedFrame FrameOf(const std::string& hash, const std::vector<std::string>& persons) {
  IndexedFrame frame;
  frame.record.files = {{"frames/000000.pcd", hash, 100}, {"image/000000.png", "image", 50}};
  for (const std::string& person : persons) {
    IndexObjectRecord& object = frame.objects.emplace_back();
    object.name = person;
    object.type = "person";
  }
  return frame;
}

IndexedScenario ScenarioOf(std::uint32_t number, std::vector<IndexedFrame> frames) {
  return {{.scenario = number,
           .base = "base.json",
           .split = "train",
           .line = "",
           .sequences = {{.sensor = "front",
                          .folder = "",
                          .scenario_hash = "",
                          .data_hash = "",
                          .manifest_hash = ""}}},
          {std::move(frames)}};
}

TEST(DatasetReport, CountsFramesThatAnotherOneHasTheBytesOf) {
  DatasetReport report;
  report.Add(ScenarioOf(0, {FrameOf("a", {}), FrameOf("b", {}), FrameOf("a", {})}));
  report.Add(ScenarioOf(1, {FrameOf("c", {}), FrameOf("a", {})}));
  EXPECT_EQ(report.Record().duplicate_frames, 2U);
}

TEST(DatasetReport, CountsAnObjectOnceAScenario) {
  DatasetReport report;
  report.Add(ScenarioOf(0, {FrameOf("a", {"anna"}), FrameOf("b", {"anna", "ben"})}));
  report.Add(ScenarioOf(1, {FrameOf("c", {"anna"})}));
  const TypeCountsRecord persons = report.Record().objects.at("person");
  EXPECT_EQ(persons.objects, 3U);
  EXPECT_EQ(persons.in_frames, 4U);
}

}  // namespace
}  // namespace railcast
