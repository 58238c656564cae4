#include "generator/dataset/dataset_report.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace railcast {
namespace {

IndexedFrame FrameOf(const std::string& hash, const std::vector<std::string>& persons) {
  IndexedFrame frame;
  frame.record.files = {{"frames/000000.pcd", 100, hash}, {"image/000000.png", 50, "image"}};
  for (const std::string& person : persons) {
    IndexedObject& object = frame.objects.emplace_back();
    object.name = person;
    object.type = "person";
  }
  return frame;
}

IndexedScenario ScenarioOf(int number, std::vector<IndexedFrame> frames) {
  return {{{"scenario", number},
           {"split", "train"},
           {"base", "base.json"},
           {"drawn", Json::object()},
           {"placed", Json::array()},
           {"weather", Json::object()}},
          {{{{"sensor", "front"}}, std::move(frames)}}};
}

TEST(DatasetReport, CountsFramesThatAnotherOneHasTheBytesOf) {
  DatasetReport report;
  report.Add(ScenarioOf(0, {FrameOf("a", {}), FrameOf("b", {}), FrameOf("a", {})}));
  report.Add(ScenarioOf(1, {FrameOf("c", {}), FrameOf("a", {})}));
  EXPECT_EQ(report.Write().at("duplicate_frames"), 2);
}

TEST(DatasetReport, CountsAnObjectOnceAScenario) {
  DatasetReport report;
  report.Add(ScenarioOf(0, {FrameOf("a", {"anna"}), FrameOf("b", {"anna", "ben"})}));
  report.Add(ScenarioOf(1, {FrameOf("c", {"anna"})}));
  const Json persons = report.Write().at("objects").at("person");
  EXPECT_EQ(persons.at("objects"), 3);
  EXPECT_EQ(persons.at("in_frames"), 4);
}

}  // namespace
}  // namespace railcast
