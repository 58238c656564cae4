#include <gtest/gtest.h>

#include <sstream>

#include "core/base/error.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

// A scenario in a folder of its own, based on the smallest shipped one.
std::string OnMinimal(const std::string& sections) {
  return R"({"version": 1, "file": ")" + (ScenariosDir() / "minimal.json").string() + R"(", )" +
         sections + "}";
}

std::string FaultsOf(const std::filesystem::path& file) {
  return MessageOf([&] { static_cast<void>(ReadScenario(file)); });
}

TEST(ReadScenario, TakesDefaultsFromTheSpecs) {
  const ScenarioSpec spec = ReadScenario(ScenariosDir() / "minimal.json");
  EXPECT_EQ(spec.seed, ScenarioSpec().seed);
  EXPECT_EQ(spec.weather, WeatherSpec());
  EXPECT_EQ(spec.world.tracks, WorldSpec().tracks);
  EXPECT_EQ(spec.lidar.mount, MountSpec());
  EXPECT_FALSE(spec.camera.has_value());
}

TEST(ReadScenario, LetsAnObjectReplaceKeysOfTheFileItNames) {
  const TemporaryFolder folder;
  const ScenarioSpec base = ReadScenario(ScenariosDir() / "minimal.json");
  const ScenarioSpec spec = ReadScenario(folder.Write(
      "a.json",
      OnMinimal(R"("lidar": {"file": ")" + (ScenariosDir() / "sensors/vir2rail.json").string() +
                R"(", "range_max_m": 120, "mount": {"yaw_deg": 10}})")));
  EXPECT_EQ(spec.lidar.range_max_m, 120.0);
  EXPECT_EQ(spec.lidar.mount.yaw_deg, 10.0);
  EXPECT_EQ(spec.lidar.mount.position_m, MountSpec().position_m);
  EXPECT_EQ(spec.lidar.scan, base.lidar.scan);
  EXPECT_EQ(spec.world, base.world);
}

// A sensor, a scenario with it, and one that builds on that: keys at every depth.
constexpr const char* kBaseSensor = R"({"version": 1,
  "scan": {"rate_hz": 5, "pattern": {"type": "raster", "horizontal_fov_deg": 20,
           "vertical_fov_deg": 10, "angular_resolution_deg": 1, "order": "rows"}},
  "receiver": {"range_noise_floor_m": 0.007, "dead_time_ns": 3}, "beam": {"wavelength_nm": 1550},
  "mount": {"position_m": [1, 2, 3], "pitch_deg": 4}})";

ScenarioSpec OverSections(const TemporaryFolder& folder, const std::string& sections) {
  folder.Write("sensor.json", kBaseSensor);
  folder.Write("base.json", OnMinimal(R"(
    "lidar": {"file": "sensor.json", "receiver": {"dead_time_ns": 8, "edge_loss": 0.1}},
    "weather": {"rain_rate_mmph": 3, "sun": {"illuminance_klx": 50, "azimuth_deg": 7}},
    "effects": {"clutter": false},
    "world": {"alignment": {"gauge_mm": 1000,
                "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 90}]}},
              "terrain": {"half_width_m": 30, "relief": {"sigma_m": 3}},
              "objects": [{"name": "anna", "type": "person", "s_m": 40}]},
    "vehicle": {"start_s_m": 40, "pivot_distance_m": 7, "ride": {"track_quality": "poor"},
                "motion": {"profile": [{"time_s": 0, "speed_mps": 5}], "reverse": true}})"));
  return ReadScenario(
      folder.Write("a.json", R"({"version": 1, "file": "base.json", )" + sections + "}"));
}

TEST(ReadScenario, LetsKeysReplaceThoseOfAFileAtEveryDepth) {
  const TemporaryFolder folder;
  const ScenarioSpec spec = OverSections(folder, R"(
    "lidar": {"receiver": {"return_mode": "dual", "edge_loss": 0.2}, "mount": {"yaw_deg": 5},
              "scan": {"rate_hz": 4}},
    "weather": {"sun": {"elevation_deg": 9}}, "effects": {"halo": false},
    "world": {"terrain": {"relief": {"wavelength_m": 200}}, "objects": []},
    "vehicle": {"start_s_m": 50, "ride": {}, "motion": {"profile": [{"time_s": 0, "speed_mps": 6}]}})");
  // Own keys, of the scenario below, of the sensor below that.
  EXPECT_EQ(spec.lidar.receiver.return_mode, ReturnMode::kDual);
  EXPECT_EQ(spec.lidar.receiver.edge_loss, 0.2);
  EXPECT_EQ(spec.lidar.receiver.dead_time_ns, 8.0);
  EXPECT_EQ(spec.lidar.receiver.range_noise_floor_m, 0.007);
  EXPECT_EQ(spec.lidar.beam.wavelength_nm, 1550.0);
  EXPECT_EQ(spec.lidar.mount, (MountSpec{{1.0, 2.0, 3.0}, 5.0, 4.0, 0.0}));
  EXPECT_EQ(spec.lidar.scan.rate_hz, 4.0);
  EXPECT_EQ(std::get<RasterSpec>(spec.lidar.scan.pattern).order, RasterOrder::kRows);
  EXPECT_EQ(spec.weather.rain_rate_mmph, 3.0);
  EXPECT_EQ(spec.weather.sun, (SunSpec{50.0, 7.0, 9.0}));
  EXPECT_EQ(spec.effects, (std::map<std::string, bool>{{"clutter", false}, {"halo", false}}));
  EXPECT_EQ(spec.world.alignment.gauge_mm, 1000.0);
  EXPECT_EQ(spec.world.terrain.half_width_m, 30.0);
  EXPECT_EQ(spec.world.terrain.relief->sigma_m, 3.0);
  EXPECT_EQ(spec.world.terrain.relief->wavelength_m, 200.0);
  EXPECT_EQ(spec.world.objects.size(), 0U);
  EXPECT_EQ(spec.vehicle.pivot_distance_m, 7.0);
  EXPECT_EQ(spec.vehicle.ride->track_quality, TrackQuality::kPoor);
  EXPECT_TRUE(spec.vehicle.motion.reverse);
  EXPECT_EQ(spec.vehicle.motion.profile.size(), 1U);
  EXPECT_EQ(spec.vehicle.motion.profile[0].speed_mps, 6.0);
}

TEST(ReadScenario, ReplacesListsFilesAndTypedObjectsAsAWhole) {
  const TemporaryFolder folder;
  folder.Write("dual.json", R"({"version": 1, "return_mode": "dual"})");
  const ScenarioSpec spec = OverSections(folder, R"(
    "lidar": {"receiver": "dual.json", "mount": {"position_m": [0, 0, 5]},
              "scan": {"pattern": {"type": "raster", "horizontal_fov_deg": 30,
                       "vertical_fov_deg": 10, "angular_resolution_deg": 1}}},
    "weather": {"file": ")" + (ScenariosDir() / "weather/snow.json").string() +
                                                     R"("},
    "vehicle": {"consist": [{"type": "multiple_unit"}]})");
  EXPECT_EQ(spec.lidar.receiver, (ReceiverSpec{.return_mode = ReturnMode::kDual}));
  EXPECT_EQ(spec.lidar.mount, (MountSpec{{0.0, 0.0, 5.0}, 0.0, 4.0, 0.0}));
  EXPECT_EQ(std::get<RasterSpec>(spec.lidar.scan.pattern).order, RasterOrder::kColumns);
  EXPECT_EQ(spec.lidar.scan.rate_hz, 5.0);
  EXPECT_EQ(spec.weather.rain_rate_mmph, 0.0);
  EXPECT_EQ(spec.weather.sun, SunSpec());
  // One of two keys for the same quantity replaces the other one below it.
  EXPECT_EQ(spec.vehicle.consist.size(), 1U);
}

TEST(ReadScenario, NamesTheFileThatANestedValueStandsIn) {
  const TemporaryFolder folder;
  const auto fault_of = [&](const std::string& sections) {
    return MessageOf([&] { static_cast<void>(OverSections(folder, sections)); });
  };
  const std::string in = folder.Write("any.json", "").parent_path().string();
  EXPECT_EQ(fault_of(R"("lidar": {"receiver": {"edge_loss": 7}})"),
            in + "/a.json: /lidar/receiver/edge_loss: must be >= 0 and <= 1 (got 7)");
  EXPECT_EQ(fault_of(R"("lidar": {"receiver": {"edge_los": 0.1}})"),
            in + "/a.json: /lidar/receiver/edge_los: unknown key, the nearest is \"edge_loss\"");
  const ScenarioSpec spec = OverSections(folder, R"("lidar": {"receiver": {"edge_loss": 0.2}})");
  EXPECT_EQ(spec.sources.Place("/lidar/receiver/edge_loss"),
            in + "/a.json: /lidar/receiver/edge_loss");
  EXPECT_EQ(spec.sources.Place("/lidar/receiver/dead_time_ns"),
            in + "/base.json: /lidar/receiver/dead_time_ns");
  EXPECT_EQ(spec.sources.Place("/lidar/receiver/range_noise_floor_m"),
            in + "/sensor.json: /receiver/range_noise_floor_m");
  EXPECT_EQ(spec.sources.Place("/vehicle/ride/track_quality"),
            in + "/base.json: /vehicle/ride/track_quality");
}

TEST(ReadScenario, LetsAFileNameTheNextOne) {
  const TemporaryFolder folder;
  folder.Write("fog.json", R"({"version": 1, "fog_density_per_m": 0.02, "rain_rate_mmph": 3})");
  folder.Write("wet_fog.json", R"({"version": 1, "file": "fog.json", "rain_rate_mmph": 9})");
  const ScenarioSpec spec =
      ReadScenario(folder.Write("a.json", OnMinimal(R"("weather": "wet_fog.json")")));
  EXPECT_EQ(spec.weather.fog_density_per_m, 0.02);
  EXPECT_EQ(spec.weather.rain_rate_mmph, 9.0);
}

TEST(ReadScenario, RefusesMoreMaterialsThanIndicesCanTell) {
  const TemporaryFolder folder;
  std::string materials;
  for (int i = 0; i < 65'536; ++i) {
    if (i > 0) materials += ",";
    materials += R"({"name": "m)" + std::to_string(i) + R"(", "reflectivity": 0.5})";
  }
  const auto library =
      folder.Write("many.json", R"({"version": 1, "materials": [)" + materials + "]}");
  EXPECT_EQ(FaultsOf(folder.Write("a.json", OnMinimal(R"("materials": "many.json")"))),
            library.string() + ": /materials: must have at most 65535 elements (got 65536)");
}

TEST(ReadScenario, ReportsTheFaultsOfEveryFileAtOnce) {
  const TemporaryFolder folder;
  const auto weather = folder.Write("weather.json", R"({"version": 1, "snow_rate_mmph": -1})");
  const auto file = folder.Write(
      "a.json",
      OnMinimal(R"("weather": "weather.json", "fidelity": "high", "output": {"fram": 1})"));
  EXPECT_EQ(FaultsOf(file),
            file.string() +
                ": /fidelity: must be \"geometry\", \"plausibility\", \"surface\", \"footprint\", "
                "\"reference\" or \"auto\" (got \"high\")\n" +
                weather.string() + ": /snow_rate_mmph: must be >= 0 and <= 5000 (got -1)\n" +
                file.string() + ": /output/fram: unknown key, the nearest is \"frame\"");
}

// With that many keys, comparing each with all the others would take minutes.
TEST(ReadScenario, NamesTwentyOf200000UnknownKeys) {
  const TemporaryFolder folder;
  std::vector<std::string> keys(200'000);
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = "fidelity_" + std::to_string(i);
  std::string sections = R"("seed": 1)";
  for (const std::string& key : keys) sections += ", \"" + key + "\": 0";
  const auto file = folder.Write("a.json", OnMinimal(sections));
  std::istringstream faults(FaultsOf(file));
  std::string fault;
  for (std::size_t i = 0; i < 20; ++i) {
    std::getline(faults, fault);
    ASSERT_EQ(fault,
              file.string() + ": /" + keys[i] + ": unknown key, the nearest is \"fidelity\"");
  }
  std::getline(faults, fault);
  EXPECT_EQ(fault, "... and 199980 more faults");
  EXPECT_FALSE(std::getline(faults, fault)) << fault;
}

TEST(ReadScenario, QuotesUmlautsAsTheyAreAndNoHalves) {
  const TemporaryFolder folder;
  const auto fault = [&](const std::string& fidelity) {
    return FaultsOf(folder.Write("a.json", OnMinimal(R"("fidelity": ")" + fidelity + '"')));
  };
  EXPECT_TRUE(fault("Süd").ends_with("(got \"Süd\")")) << fault("Süd");
  std::string many;
  for (int i = 0; i < 40; ++i) many += "ü";
  EXPECT_TRUE(fault(many).ends_with("(got \"" + many.substr(0, 58) + "...)")) << fault(many);
}

// The parser's own message quotes the text, which may be invalid UTF-8 or look like the message.
TEST(ReadScenario, QuotesNoTextThatIsNoJson) {
  const TemporaryFolder folder;
  const auto fault = [&](const std::string& text) {
    const auto file = folder.Write("a.json", text);
    return FaultsOf(file).substr(file.string().size());
  };
  const std::string invalid = "syntax error while parsing value - invalid literal";
  EXPECT_EQ(fault("{\"; expected \": \xDE"), ": line 1, column 17: " + invalid + R"( (got \xde))");
  EXPECT_EQ(fault("{\"ill-formed UTF-8\": x"), ": line 1, column 22: " + invalid + " (got x)");
  EXPECT_EQ(fault("{\"'; expected end of input\": 1"),
            ": line 1, column 30: syntax error while parsing object - unexpected end of input; "
            "expected '}'");
}

TEST(ReadScenario, LocatesAFaultInTheObjectThatReplacesAFilesKey) {
  const TemporaryFolder folder;
  folder.Write("weather.json", R"({"version": 1, "snow_rate_mmph": -1, "fog_density_per_m": -2})");
  const auto file = folder.Write(
      "a.json", OnMinimal(R"("weather": {"file": "weather.json", "snow_rate_mmph": -3})"));
  EXPECT_EQ(FaultsOf(file),
            file.parent_path().string() +
                "/weather.json: /fog_density_per_m: must be >= 0 and <= 10 (got -2)\n" +
                file.string() + ": /weather/snow_rate_mmph: must be >= 0 and <= 5000 (got -3)");
}

TEST(ReadScenario, ResolvesFileNamesAgainstTheFileThatHoldsThem) {
  const TemporaryFolder folder;
  const auto table = folder.Write("rosette.csv", "");
  folder.Write("lidar.json",
               R"({"version": 1, "scan": {"rate_hz": 10,
                   "pattern": {"type": "table", "file": "rosette.csv"}}})");
  const auto file = folder.Write("a.json", OnMinimal(R"("lidar": "lidar.json")"));
  std::filesystem::current_path("/");
  const ScenarioSpec spec = ReadScenario(file.relative_path());
  EXPECT_EQ(std::get<FiringTableSpec>(spec.lidar.scan.pattern).file, table.string());
}

TEST(ReadScenario, NamesAMissingFileAsItWasGiven) {
  EXPECT_EQ(FaultsOf("no/such/scenario.json"), "no/such/scenario.json: no such file");
  EXPECT_EQ(FaultsOf("/"), "/: must be a file, not a directory");
}

TEST(ReadScenario, ReadsEverySensorOfTheCatalogue) {
  const TemporaryFolder folder;
  for (const auto& sensor : JsonFilesIn(ScenariosDir() / "sensors")) {
    const auto file = folder.Write("a.json", OnMinimal(R"("lidar": ")" + sensor.string() + '"'));
    EXPECT_EQ(FaultsOf(file), "no error") << sensor;
  }
}

// The published and the physical model of a sensor must use the same range at 10 % of the data
// sheet.
TEST(ReadScenario, GivesEverySensorOneRangeAtTenPercent) {
  const TemporaryFolder folder;
  for (const auto& sensor : JsonFilesIn(ScenariosDir() / "sensors")) {
    const auto file = folder.Write("a.json", OnMinimal(R"("lidar": ")" + sensor.string() + '"'));
    const LidarSpec lidar = ReadScenario(file).lidar;
    EXPECT_EQ(lidar.receiver.range_at_10_percent_m, lidar.plausibility.reference_range_m) << sensor;
    EXPECT_EQ(lidar.plausibility.reference_threshold, 0.1) << sensor;
  }
}

TEST(ReadScenario, ReadsEveryRung) {
  const TemporaryFolder folder;
  for (const Fidelity rung : kRungs) {
    const std::string name(NameOf(rung));
    const auto file = folder.Write("a.json", OnMinimal(R"("fidelity": ")" + name + '"'));
    EXPECT_EQ(EffectsOf(ReadScenario(file)), EffectsOfRung(rung)) << name;
  }
}

TEST(ReadScenario, TakesVisibilityInPlaceOfFogDensity) {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.json", OnMinimal(R"("weather": {"visibility_m": 100})"));
  EXPECT_EQ(ReadScenario(file).weather.visibility_m, 100.0);
  EXPECT_EQ(ReadScenario(file).weather.fog_density_per_m, 0.0);
}

TEST(ReadScenario, KeepsWholeNumbersThatNoDoubleHolds) {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.json", OnMinimal(R"("seed": 18446744073709551615)"));
  EXPECT_EQ(ReadScenario(file).seed, 18446744073709551615ULL);
}

TEST(ReadLabelTable, ReadsTheShippedTable) {
  const LabelTable labels =
      ReadLabelTable(std::filesystem::path(RAILCAST_SOURCE_DIR) / "scenarios/labels.json");
  EXPECT_EQ(labels.Id("unlabeled"), 0U);
  EXPECT_EQ(labels.Id("rail"), 1U);
  EXPECT_EQ(labels.Find("wagon")->osdar23, "wagons");
}

TEST(ReadLabelTable, NamesEveryFault) {
  const TemporaryFolder folder;
  const auto file = folder.Write("labels.json", R"({"version": 1, "labels": []})");
  try {
    static_cast<void>(ReadLabelTable(file));
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("labels.json: /labels: must not be empty"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace railcast
