#include "core/scenario/sensors.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

ScenarioSpec TwoSensors() {
  return ReadScenario(ScenariosDir() / "two_sensors.json");
}

std::string PickFault(const std::optional<std::string>& name) {
  return MessageOf([&] { static_cast<void>(PickSensor(TwoSensors(), name)); });
}

TEST(Sensors, AreReadFromAList) {
  const ScenarioSpec spec = TwoSensors();
  EXPECT_EQ(SensorNames(spec), (std::vector<std::string>{"front", "roof"}));
  EXPECT_EQ(spec.lidar, LidarSpec());
  const LidarSpec vlp16 = [] {
    ScenarioSpec minimal = ReadScenario(ScenariosDir() / "minimal.json");
    return minimal.lidar;
  }();
  // Each sensor of the list may be based on a file.
  EXPECT_EQ(spec.lidars[0].receiver, vlp16.receiver);
  EXPECT_EQ(spec.lidars[0].mount.position_m[0], 2.2);
  EXPECT_EQ(spec.lidars[1].range_max_m, 100.0);
}

TEST(Sensors, OneOfThemMakesAScenarioOfItsOwn) {
  const ScenarioSpec spec = TwoSensors();
  const ScenarioSpec roof = PickSensor(spec, "roof");
  EXPECT_EQ(roof.lidar, spec.lidars[1]);
  EXPECT_TRUE(roof.lidars.empty());
  EXPECT_EQ(SensorNames(roof), (std::vector<std::string>{"roof"}));
  EXPECT_EQ(roof.interfaces.protocol, Protocol::kVlp16);
  EXPECT_TRUE(roof.interfaces.sensors.empty());
  EXPECT_EQ(roof.world, spec.world);
  EXPECT_EQ(PickSensor(roof, std::nullopt), roof);
}

TEST(Sensors, MustBeNamedWhereThereAreSeveral) {
  EXPECT_EQ(PickFault(std::nullopt),
            "sensor: must be \"front\" or \"roof\" (got none of the scenario's sensors)");
  EXPECT_EQ(PickFault("side"), "sensor: must be \"front\" or \"roof\" (got \"side\")");
  EXPECT_EQ(PickFault("front"), "no error");
}

TEST(Sensors, FaultsOfOneThatWasPickedNameItsPlace) {
  const ScenarioSpec roof = PickSensor(TwoSensors(), "roof");
  const std::string file = (ScenariosDir() / "two_sensors.json").string();
  EXPECT_EQ(roof.sources.Place("/lidar/mount/yaw_deg"), file + ": /lidars/1/mount/yaw_deg");
  const std::string sensor = (ScenariosDir() / "sensors/vlp16.json").string();
  EXPECT_EQ(roof.sources.Place("/lidar/scan/rate_hz"), sensor + ": /scan/rate_hz");
  EXPECT_EQ(roof.sources.Place("/vehicle/motion"), file + ": /vehicle/motion");
}

TEST(Sensors, ResolveToWhatTheyWereReadFrom) {
  const TemporaryFolder folder;
  const ScenarioSpec spec = TwoSensors();
  EXPECT_EQ(ReadScenario(folder.Write("resolved.json", ResolvedScenarioJson(spec))), spec);
}

TEST(Sensors, SendEachToReceiversOfItsOwn) {
  const std::vector<std::string> two = {"front", "roof"};
  const auto fault = [&](const std::vector<SensorInterface>& sensors) {
    return InterfacesFault({{}, Protocol::kRailcast, sensors}, two);
  };
  EXPECT_EQ(fault({}), "");
  EXPECT_EQ(fault({{"front", Protocol::kRailcast, {}}, {"roof", Protocol::kVlp16, {}}}), "");
  EXPECT_EQ(fault({{"front", Protocol::kVlp16, {"127.0.0.1:2368"}},
                   {"roof", Protocol::kVlp16, {"127.0.0.1:2369"}}}),
            "");
  EXPECT_EQ(fault({{"front", Protocol::kHdl32e, {}}, {"roof", Protocol::kVlp16, {}}}),
            "must give each sensor receivers of its own, \"roof\" others than 127.0.0.1:2368");
  EXPECT_EQ(fault({{"front", Protocol::kRailcast, {"10.0.0.1:9"}},
                   {"roof", Protocol::kVlp16, {"10.0.0.1:9"}}}),
            "must give each sensor receivers of its own, \"roof\" others than 10.0.0.1:9");
  EXPECT_EQ(fault({{"front", Protocol::kRailcast, {}}}),
            "must name each sensor once, \"roof\" too");
  EXPECT_EQ(fault({{"front", Protocol::kRailcast, {}}, {"front", Protocol::kVlp16, {}}}),
            "must name each sensor once, \"front\" too");
  EXPECT_EQ(fault({{"side", Protocol::kRailcast, {}}, {"roof", Protocol::kVlp16, {}}}),
            "must name sensors of the scenario, \"front\" or \"roof\", not \"side\"");
  EXPECT_EQ(InterfacesFault({{}, Protocol::kRailcast, {{"a", Protocol::kRailcast, {}}}}, {}),
            "must be left out with \"lidar\", which has but one sensor");
}

TEST(Sensors, SendNoFramesWherePositionPacketsGo) {
  const auto fault = [](const InterfacesSpec& interfaces) { return PositionsFault(interfaces); };
  EXPECT_EQ(fault({}), "");
  EXPECT_EQ(fault({{"10.0.0.1:8308"}, Protocol::kRailcast, {}}), "") << "which has none";
  EXPECT_EQ(fault({{"10.0.0.1:2368", "10.0.0.2:8308"}, Protocol::kVlp16, {}}),
            "must send frames elsewhere than to 10.0.0.2:8308, which gets position packets");
  const SensorInterface front{"front", Protocol::kVlp16, {"10.0.0.1:2368"}};
  EXPECT_EQ(fault({{}, {}, {front, {"roof", Protocol::kRailcast, {"10.0.0.2:8308"}}}}), "");
  EXPECT_EQ(fault({{}, {}, {front, {"roof", Protocol::kRailcast, {"10.0.0.1:8308"}}}}),
            "must send frames elsewhere than to 10.0.0.1:8308, which gets position packets");
  EXPECT_EQ(fault({{}, {}, {front, {"roof", Protocol::kVlp16, {"10.0.0.1:2369"}}}}), "")
      << "position packets may share their port";
}

TEST(Sensors, ShareNoReceiverWithTheCamera) {
  CameraSpec camera;
  const auto fault = [&](const InterfacesSpec& interfaces) {
    return ImagesFault(camera, interfaces);
  };
  EXPECT_EQ(fault({}), "");
  camera.udp = {"10.0.0.1:27500", "127.0.0.1:27400"};
  EXPECT_EQ(fault({{"10.0.0.1:2368"}, Protocol::kVlp16, {}}), "");
  EXPECT_EQ(fault({}),
            "must send images elsewhere than to 127.0.0.1:27400, which gets a sensor's frames");
  const SensorInterface front{"front", Protocol::kRailcast, {"10.0.0.1:27400"}};
  EXPECT_EQ(fault({{}, {}, {front, {"roof", Protocol::kVlp16, {"10.0.0.1:27500"}}}}),
            "must send images elsewhere than to 10.0.0.1:27500, which gets a sensor's frames");
  camera.udp = {"127.0.0.1:8308"};
  EXPECT_EQ(fault({{}, {}, {front, {"roof", Protocol::kVlp16, {}}}}),
            "must send images elsewhere than to 127.0.0.1:8308, which gets a sensor's position "
            "packets");
}

}  // namespace
}  // namespace railcast
