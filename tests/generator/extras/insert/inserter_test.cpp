// A recording into which something is put is compared with the simulation that had it.
#include "generator/extras/insert/inserter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "tests/generator/extras/insert/closed_loop.h"
#include "tests/support/frame_bytes.h"

namespace railcast {
namespace {

/// A simulation without things, one with them, and the first with them put into it.
struct Loop {
  RecordedFirings recorded;
  Frame truth;
  InsertedFrame inserted;
  double sigma_m{};  ///< Of the range noise at the detection threshold.
};

constexpr SectorSpec kLoopSector{12.0, -25.0, 15.0};

Loop RunLoopIn(const SimpleWorld& scene,
               const std::vector<LoopThing>& things,
               const LoopSensor& sensor,
               bool is_own = true) {
  Loop loop;
  const auto without = std::make_shared<SimpleWorld>(scene);
  loop.recorded = RecordedOf(ScanLoop(sensor, without), sensor.pattern);
  if (!is_own) ForgetOwnFields(loop.recorded);
  const auto with = std::make_shared<SimpleWorld>(scene);
  AddThings(sensor.scenario, things, *with);
  loop.truth = ScanLoop(sensor, with);
  const auto alone = ThingsAlone(sensor.scenario, things);
  Inserter inserter(PlanOf(sensor.scenario, alone, sensor.pattern), 0);
  loop.inserted = inserter.Insert(loop.recorded, 0);
  const ReceiverSpec& receiver = sensor.scenario.lidar.receiver;
  loop.sigma_m =
      std::hypot(receiver.range_noise_floor_m,
                 receiver.range_noise_scale_m / std::sqrt(2.0 * receiver.snr_at_threshold));
  return loop;
}

Loop RunLoop(const LoopSensor& sensor, bool is_own = true) {
  return RunLoopIn(*MakeLoopScene(sensor.scenario), LoopThings(), sensor, is_own);
}

bool HasPointAt(const Frame& frame, std::size_t slot) {
  return !std::isnan(frame.x[slot]);
}

/// What a loop shows, over firings.
struct LoopFigures {
  std::size_t num_on_things = 0;  ///< Firings with a point on a thing, in either.
  std::size_t num_same = 0;       ///< Of which both have it in the same slot ...
  std::size_t num_near = 0;       ///< ... and within 4 sigma.
  std::size_t num_shadow = 0;     ///< Firings that changed without a point on a thing, in either.
  std::size_t num_shadow_same = 0;
  std::size_t num_changed_in_vain = 0;  ///< Firings that the truth has as they were recorded.
  double worst_intensity = 0.0;         ///< Relative error of the mean in the worst bin of range.
};

bool AreSame(const Frame& a, const Frame& b, std::size_t slot, double within_m) {
  if (HasPointAt(a, slot) != HasPointAt(b, slot)) return false;
  return !HasPointAt(a, slot) ||
         std::abs(static_cast<double>(a.range_m[slot] - b.range_m[slot])) <= within_m;
}

LoopFigures FiguresOf(const Loop& loop) {
  const Frame& before = loop.recorded.recorded.frame;
  const Frame& truth = loop.truth;
  const Frame& now = loop.inserted.recorded.frame;
  LoopFigures figures;
  std::map<int, std::array<double, 3>> bins;  // Sums of intensities, and their number.
  for (std::size_t first = 0; first < truth.num_slots(); first += truth.returns) {
    bool is_on_thing = false;
    bool is_same = true;
    bool is_near = true;
    bool is_as_recorded = true;
    bool is_now_as_recorded = true;
    for (std::size_t slot = first; slot < first + truth.returns; ++slot) {
      const auto on = [&](const Frame& frame) {
        return HasPointAt(frame, slot) && frame.instance[slot] != 0;
      };
      is_on_thing = is_on_thing || on(truth) || on(now);
      is_same = is_same && on(truth) == on(now);
      is_near = is_near && AreSame(truth, now, slot, 4.0 * loop.sigma_m);
      is_as_recorded = is_as_recorded && AreSame(truth, before, slot, 0.0);
      is_now_as_recorded = is_now_as_recorded && AreSame(now, before, slot, 0.0);
      if (!on(truth) || !on(now)) continue;
      auto& bin = bins[static_cast<int>(truth.range_m[slot] / 25.0F)];
      bin[0] += static_cast<double>(truth.intensity[slot]);
      bin[1] += static_cast<double>(now.intensity[slot]);
      bin[2] += 1.0;
    }
    if (is_on_thing) {
      ++figures.num_on_things;
      figures.num_same += is_same ? 1U : 0U;
      figures.num_near += is_same && is_near ? 1U : 0U;
    } else if (is_as_recorded) {
      figures.num_changed_in_vain += is_now_as_recorded ? 0U : 1U;
    } else {
      ++figures.num_shadow;
      figures.num_shadow_same += is_near ? 1U : 0U;
    }
  }
  for (const auto& [bin, sums] : bins) {
    if (sums[2] < 5.0) continue;
    figures.worst_intensity = std::max(figures.worst_intensity, std::abs(sums[1] / sums[0] - 1.0));
  }
  return figures;
}

std::string TextOf(const LoopFigures& f) {
  std::ostringstream text;
  text << f.num_on_things << " firings on things, " << f.num_same << " in the same slots, "
       << f.num_near << " within 4 sigma; " << f.num_shadow << " in shadows, " << f.num_shadow_same
       << " the same; " << f.num_changed_in_vain << " changed in vain; intensities within "
       << 100.0 * f.worst_intensity << " %";
  return text.str();
}

// At least 99 % of the firings that meet things are the same, and intensities within 5 %. What is
// not the same are firings whose recorded returns do not say what lay beside them or behind.
void ExpectTheSame(const Loop& loop, const std::string& what) {
  const LoopFigures figures = FiguresOf(loop);
  testing::Test::RecordProperty(what, TextOf(figures));
  SCOPED_TRACE(what + ": " + TextOf(figures));
  ASSERT_GT(figures.num_on_things, 20U);
  const auto share = [](std::size_t part, std::size_t all) {
    return static_cast<double>(part) / static_cast<double>(all);
  };
  EXPECT_GE(share(figures.num_near, figures.num_on_things), 0.99);
  if (figures.num_shadow > 50) {
    EXPECT_GE(share(figures.num_shadow_same, figures.num_shadow), 0.96);
  }
  EXPECT_LE(figures.worst_intensity, 0.05);
  EXPECT_EQ(figures.num_changed_in_vain, 0U);
}

class RoundTrip : public testing::TestWithParam<std::string> {};

TEST_P(RoundTrip, GivesTheFrameThatHadTheThings) {
  for (const Fidelity rung : {Fidelity::kPlausibility, Fidelity::kSurface, Fidelity::kFootprint}) {
    const LoopSensor sensor = MakeLoopSensor(GetParam(), rung, kLoopSector);
    ExpectTheSame(RunLoop(sensor), std::string(NameOf(rung)));
  }
}

TEST_P(RoundTrip, DoesSoIfTheRecordingKnowsNeitherPowerNorTruth) {
  const LoopSensor sensor = MakeLoopSensor(GetParam(), Fidelity::kFootprint, kLoopSector);
  ExpectTheSame(RunLoop(sensor, /*is_own=*/false), "foreign");
}

// The recorded intensities have the sensor's noise and gains in them, and so has the power that is
// estimated by them. The least are those of docs/results/insertion.md.
TEST_P(RoundTrip, IsNearlyAsGoodWithThePresetsNoiseAndGains) {
  LoopSensor sensor = MakeLoopSensor(GetParam(), Fidelity::kFootprint, kLoopSector);
  sensor.scenario.lidar.receiver = ReadMinimalWith(GetParam()).lidar.receiver;
  const double least = GetParam() == "vls128" ? 0.986 : 0.99;
  for (const bool is_own : {true, false}) {
    const LoopFigures figures = FiguresOf(RunLoop(sensor, is_own));
    RecordProperty(is_own ? "own" : "foreign", TextOf(figures));
    SCOPED_TRACE(TextOf(figures));
    const auto on_things = static_cast<double>(figures.num_on_things);
    EXPECT_GE(static_cast<double>(figures.num_near) / on_things, least);
    // By noise, what lies behind a thing is strong enough to be part of an echo, or is not.
    EXPECT_LE(figures.worst_intensity, 0.025);
    EXPECT_EQ(figures.num_changed_in_vain, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sensors,
    RoundTrip,
    testing::Values(
        "vir2rail", "vlp16", "vlp32c", "pandar64", "vls128", "xt32", "qt128", "rosette"));

TEST(Inserter, GivesSeveralReturnsByTheRuleOfTheSensor) {
  for (const ReturnMode mode : {ReturnMode::kDual, ReturnMode::kTriple, ReturnMode::kLast}) {
    LoopSensor sensor = MakeLoopSensor("vls128", Fidelity::kFootprint, kLoopSector);
    sensor.scenario.lidar.receiver.return_mode = mode;
    ExpectTheSame(RunLoop(sensor), std::string(NameOf(mode)));
  }
}

// What a beam meets beside and behind a thing is known by one or two recorded echoes, where grazing
// ballast has a row of them: first returns agree, second ones in nine of ten slots.
TEST(Inserter, GivesNineOfTenSecondReturnsOnGrazingBallast) {
  LoopSensor sensor = MakeLoopSensor("vls128", Fidelity::kFootprint, kLoopSector);
  sensor.scenario.lidar.receiver.return_mode = ReturnMode::kDual;
  std::vector<LoopThing> things;
  for (const double ahead_m : {20.0, 40.0, 60.0, 80.0}) {
    things.push_back({ahead_m, things.size() % 2 == 0 ? 1.0 : -1.0, {0.5, 0.6, 0.5}});
  }
  const Loop loop = RunLoopIn(*MakeTrackScene(sensor.scenario), things, sensor);
  const Frame& truth = loop.truth;
  const Frame& now = loop.inserted.recorded.frame;
  double num = 0.0;
  std::array<double, 2> num_same{};
  for (std::size_t first = 0; first < truth.num_slots(); first += 2) {
    const auto is_on_thing = [&](const Frame& frame) {
      return (HasPointAt(frame, first) && frame.instance[first] != 0) ||
             (HasPointAt(frame, first + 1) && frame.instance[first + 1] != 0);
    };
    if (!is_on_thing(truth) && !is_on_thing(now)) continue;
    num += 1.0;
    for (const std::size_t k : {0U, 1U}) {
      num_same[k] += AreSame(truth, now, first + k, 4.0 * loop.sigma_m) ? 1.0 : 0.0;
    }
  }
  RecordProperty("same", NumberText(num_same[0]) + " and " + NumberText(num_same[1]) + " of " +
                             NumberText(num));
  EXPECT_GT(num, 150.0);
  EXPECT_GE(num_same[0] / num, 0.98);
  EXPECT_GE(num_same[1] / num, 0.90);
}

// Of a beam that a pole covers in part, the rest is known by the recorded echo alone.
TEST(Inserter, MakesThinPolesOverBallastLittleDarkerThanTheSimulation) {
  const LoopSensor sensor = MakeLoopSensor("vls128", Fidelity::kFootprint, kLoopSector);
  std::vector<LoopThing> poles;
  for (int left_m = -6; left_m <= 6; ++left_m) {
    poles.push_back({50.0, static_cast<double>(left_m), {0.05, 0.05, 3.0}});
  }
  const Loop loop = RunLoopIn(*MakeTrackScene(sensor.scenario), poles, sensor);
  const Frame& now = loop.inserted.recorded.frame;
  std::array<double, 2> sums{};
  for (std::size_t slot = 0; slot < now.num_slots(); ++slot) {
    const bool is_pole = loop.truth.instance[slot] != 0 && now.instance[slot] != 0 &&
                         HasPointAt(loop.truth, slot) && HasPointAt(now, slot);
    if (!is_pole) continue;
    sums[0] += static_cast<double>(loop.truth.intensity[slot]);
    sums[1] += static_cast<double>(now.intensity[slot]);
  }
  RecordProperty("ratio", NumberText(sums[1] / sums[0]));
  EXPECT_GT(sums[1] / sums[0], 0.97);
  EXPECT_LT(sums[1] / sums[0], 1.0);
}

TEST(Inserter, TellsOfEachReturnWhichOfHowManyItIs) {
  LoopSensor sensor = MakeLoopSensor("vls128", Fidelity::kFootprint, kLoopSector);
  sensor.scenario.lidar.receiver.return_mode = ReturnMode::kDual;
  const Loop loop = RunLoop(sensor);
  const Frame& frame = loop.inserted.recorded.frame;
  ASSERT_GT(loop.inserted.edits.size(), 500U);
  std::size_t num_wrong = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::size_t first = slot / 2 * 2;
    const int num = int{HasPointAt(frame, first)} + int{HasPointAt(frame, first + 1)};
    if (!HasPointAt(frame, slot)) continue;
    if (frame.return_count[slot] != num || frame.return_index[slot] != slot - first) ++num_wrong;
  }
  EXPECT_EQ(num_wrong, 0U);
}

TEST(Inserter, LeavesEchoesThatAreMostlyOfARecordedSurfaceTheLabelOfThis) {
  const Loop loop = RunLoop(MakeLoopSensor("vls128", Fidelity::kFootprint, kLoopSector));
  const Frame& before = loop.recorded.recorded.frame;
  const Frame& after = loop.inserted.recorded.frame;
  std::size_t num_merged = 0;
  for (const SlotEdit& edit : loop.inserted.edits) {
    if (!edit.is_merged) continue;
    ++num_merged;
    EXPECT_TRUE(edit.is_added);
    EXPECT_EQ(after.label[edit.slot], before.label[edit.slot]);
    EXPECT_EQ(after.instance[edit.slot], before.instance[edit.slot]);
  }
  EXPECT_GT(num_merged, 0U);
}

TEST(Inserter, KeepsTheOrderOfCapturesWhichNameTheFarthestReturnFirst) {
  LoopSensor sensor = MakeLoopSensor("vls128", Fidelity::kFootprint, kLoopSector);
  sensor.scenario.lidar.receiver.return_mode = ReturnMode::kDual;
  RecordedFirings recorded =
      RecordedOf(ScanLoop(sensor, MakeLoopScene(sensor.scenario)), sensor.pattern);
  Frame& frame = recorded.recorded.frame;
  std::size_t num_turned = 0;
  for (std::size_t first = 0; first < frame.num_slots(); first += 2) {
    if (!HasPointAt(frame, first + 1) || frame.range_m[first] > frame.range_m[first + 1]) continue;
    ++num_turned;
    ForEachField(frame,
                 [&](auto, auto, auto& values) { std::swap(values[first], values[first + 1]); });
  }
  ASSERT_GT(num_turned, 10U);
  const auto alone = ThingsAlone(sensor.scenario, LoopThings());
  const InsertedFrame inserted =
      Inserter(PlanOf(sensor.scenario, alone, sensor.pattern), 0).Insert(recorded, 0);
  const Frame& now = inserted.recorded.frame;
  std::size_t num_of_two = 0;
  for (const SlotEdit& edit : inserted.edits) {
    const std::size_t first = edit.slot / 2 * 2;
    if (!HasPointAt(now, first + 1)) continue;
    ++num_of_two;
    EXPECT_GT(now.range_m[first], now.range_m[first + 1]);
  }
  EXPECT_GT(num_of_two, 10U);
}

// Copies one slot of a frame to a slot of another.
void CopyOneSlot(const Frame& from, std::size_t from_slot, Frame& to, std::size_t slot) {
  std::vector<const void*> sources;
  ForEachField(from, [&](auto, auto, const auto& values) { sources.push_back(&values); });
  std::size_t next = 0;
  ForEachField(to, [&](auto, auto, auto& values) {
    using Values = std::decay_t<decltype(values)>;
    values[slot] = (*static_cast<const Values*>(sources[next++]))[from_slot];
  });
}

// The points of a frame as firings of their own.
RecordedFirings PointsAlone(const Frame& scanned) {
  std::vector<std::size_t> slots;
  for (std::size_t slot = 0; slot < scanned.num_slots(); ++slot) {
    if (HasPointAt(scanned, slot)) slots.push_back(slot);
  }
  Frame frame;
  frame.Resize(1, static_cast<std::uint32_t>(slots.size()), 1);
  ScanPattern pattern;
  pattern.rate_hz = 10.0;
  pattern.rows = 1;
  pattern.columns = frame.columns;
  for (std::uint32_t i = 0; i < frame.columns; ++i) {
    CopyOneSlot(scanned, slots[i], frame, i);
    const Eigen::Vector3f direction =
        Eigen::Vector3f(frame.x[i], frame.y[i], frame.z[i]).normalized();
    pattern.direction_x.push_back(direction.x());
    pattern.direction_y.push_back(direction.y());
    pattern.direction_z.push_back(direction.z());
    pattern.time_ns.push_back(frame.time_ns[i]);
    pattern.row.push_back(0);
    pattern.column.push_back(i);
    pattern.packet_order.push_back(i);
  }
  RecordedFirings recorded = RecordedOf(frame, pattern);
  recorded.recorded.is_grid = false;
  recorded.are_points_alone = true;
  return recorded;
}

TEST(Inserter, TakesPointsAloneForFiringsOfTheirOwn) {
  const LoopSensor sensor = MakeLoopSensor("vlp32c", Fidelity::kFootprint, kLoopSector);
  const RecordedFirings recorded = PointsAlone(ScanLoop(sensor, MakeLoopScene(sensor.scenario)));
  const auto alone = ThingsAlone(sensor.scenario, LoopThings());
  const InsertedFrame inserted =
      Inserter(PlanOf(sensor.scenario, alone, sensor.pattern), 0).Insert(recorded, 0);
  std::size_t num_added = 0;
  for (const SlotEdit& edit : inserted.edits) {
    EXPECT_TRUE(edit.had_point);
    num_added += edit.is_added ? 1U : 0U;
  }
  EXPECT_GT(num_added, 20U);
}

TEST(Inserter, LeavesAFrameAsItIsWithoutThingsAndWeather) {
  const LoopSensor sensor = MakeLoopSensor("vlp16", Fidelity::kFootprint, {20.0, -15.0, 15.0});
  const RecordedFirings recorded =
      RecordedOf(ScanLoop(sensor, MakeLoopScene(sensor.scenario)), sensor.pattern);
  Inserter inserter(PlanOf(sensor.scenario, ThingsAlone(sensor.scenario, {}), sensor.pattern), 0);
  const InsertedFrame inserted = inserter.Insert(recorded, 0);
  EXPECT_TRUE(inserted.edits.empty());
  EXPECT_EQ(FrameBytes(inserted.recorded.frame), FrameBytes(recorded.recorded.frame));
}

TEST(Inserter, MakesNoNoiseOfIntensitiesInRecordedReturns) {
  const LoopSensor exact = MakeLoopSensor("vlp16", Fidelity::kFootprint, kLoopSector);
  LoopSensor noisy = exact;
  ReceiverSpec& receiver = noisy.scenario.lidar.receiver;
  receiver.intensity_noise = receiver.channel_gain = receiver.channel_gain_variation = 0.5;
  const RecordedFirings recorded =
      RecordedOf(ScanLoop(exact, MakeLoopScene(exact.scenario)), exact.pattern);
  const auto insert = [&](const ScenarioSpec& scenario) {
    Inserter inserter(PlanOf(scenario, ThingsAlone(scenario, LoopThings()), exact.pattern), 0);
    return inserter.Insert(recorded, 0).recorded.frame;
  };
  const Frame frame = insert(exact.scenario);
  const Frame with_noise = insert(noisy.scenario);
  std::size_t num_weaker = 0;
  std::size_t num_noisy = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    ASSERT_EQ(HasPointAt(frame, slot), HasPointAt(with_noise, slot));
    if (!HasPointAt(frame, slot)) continue;
    const bool is_same = frame.intensity[slot] == with_noise.intensity[slot];
    if (frame.instance[slot] != 0) {
      num_noisy += is_same ? 0U : 1U;
    } else {
      EXPECT_TRUE(is_same) << slot;
      num_weaker += frame.intensity[slot] < recorded.recorded.frame.intensity[slot] ? 1U : 0U;
    }
  }
  EXPECT_GT(num_weaker, 2U);
  EXPECT_GT(num_noisy, 20U);
}

TEST(Inserter, ListsEverySlotThatIsNotAsRecordedAndNoOther) {
  const Loop loop = RunLoop(MakeLoopSensor("vlp16", Fidelity::kFootprint, kLoopSector));
  const Frame& before = loop.recorded.recorded.frame;
  const Frame& now = loop.inserted.recorded.frame;
  std::set<std::size_t> edited;
  for (const SlotEdit& edit : loop.inserted.edits) {
    edited.insert(edit.slot);
    EXPECT_EQ(edit.had_point, HasPointAt(before, edit.slot));
    EXPECT_EQ(edit.has_point, HasPointAt(now, edit.slot));
    EXPECT_TRUE(!edit.is_added || now.instance[edit.slot] != 0 || !edit.from_slot);
  }
  for (std::size_t slot = 0; slot < now.num_slots(); ++slot) {
    const bool is_same = AreSame(before, now, slot, 0.0) &&
                         (!HasPointAt(now, slot) || before.intensity[slot] == now.intensity[slot]);
    EXPECT_EQ(edited.count(slot) == 0, is_same) << slot;
  }
}

TEST(Inserter, TellsWhatHasHiddenEachLostReturn) {
  const Loop loop = RunLoop(MakeLoopSensor("vlp32c", Fidelity::kFootprint, kLoopSector));
  std::size_t num_lost = 0;
  for (const SlotEdit& edit : loop.inserted.edits) {
    if (edit.lost_to == Outcome::kReturned) continue;
    ++num_lost;
    EXPECT_TRUE(edit.had_point);
    EXPECT_GE(edit.hidden_by, 1U);
    EXPECT_LE(edit.hidden_by, LoopThings().size());
    // An opaque thing leaves nothing; at its rim, it may be the stronger one.
    EXPECT_TRUE(edit.lost_to == Outcome::kBelowThreshold ||
                edit.lost_to == Outcome::kNoFurtherEcho);
  }
  EXPECT_GT(num_lost, 100U);
}

TEST(Inserter, GivesTheSameBytesWithAnyNumberOfThreads) {
  const LoopSensor sensor = MakeLoopSensor("vlp16", Fidelity::kFootprint, {12.0, -15.0, 15.0});
  const RecordedFirings recorded =
      RecordedOf(ScanLoop(sensor, MakeLoopScene(sensor.scenario)), sensor.pattern);
  ScenarioSpec foggy = sensor.scenario;
  foggy.weather.visibility_m = 100.0;
  const InsertPlan plan = PlanOf(foggy, ThingsAlone(foggy, LoopThings()), sensor.pattern);
  const InsertedFrame one = Inserter(plan, 1).Insert(recorded, 0);
  const InsertedFrame three = Inserter(plan, 3).Insert(recorded, 0);
  EXPECT_EQ(FrameBytes(one.recorded.frame), FrameBytes(three.recorded.frame));
  EXPECT_EQ(one.edits.size(), three.edits.size());
}

TEST(Inserter, TellsOfObjectsThatNoBeamMeets) {
  const LoopSensor sensor = MakeLoopSensor("vlp16", Fidelity::kFootprint, {12.0, -15.0, 15.0});
  const RecordedFirings recorded =
      RecordedOf(ScanLoop(sensor, MakeLoopScene(sensor.scenario)), sensor.pattern);
  // One behind the wall, one behind the sensor, one in sight.
  const std::vector<LoopThing> things = {
      {20.0, 3.0, {0.5, 0.5, 1.8}}, {-20.0, 0.0, {0.5, 0.5, 1.8}}, {12.0, -1.0, {0.5, 0.5, 1.8}}};
  Inserter inserter(PlanOf(sensor.scenario, ThingsAlone(sensor.scenario, things), sensor.pattern),
                    0);
  const InsertedFrame inserted = inserter.Insert(recorded, 0);
  ASSERT_EQ(inserted.objects.size(), 3U);
  EXPECT_GT(inserted.objects[0].firings_alone, 0U);
  EXPECT_EQ(inserted.objects[0].firings_visible, 0U);
  EXPECT_EQ(inserted.objects[1].firings_alone, 0U);
  EXPECT_GT(inserted.objects[2].firings_visible, 0U);
  EXPECT_GT(inserted.objects[2].points, 0U);
}

TEST(Inserter, GivesAddedReturnsAsManyPhotonsAsRecordedOnesOfTheirIntensityAndRange) {
  const LoopSensor sensor = MakeLoopSensor("vlp16", Fidelity::kFootprint, {12.0, -15.0, 15.0});
  RecordedFirings recorded =
      RecordedOf(ScanLoop(sensor, MakeLoopScene(sensor.scenario)), sensor.pattern);
  const auto photons = [](const Frame& frame, std::size_t slot) {
    return 4000.0F * frame.intensity[slot] / (frame.range_m[slot] * frame.range_m[slot]);
  };
  const Frame& before = recorded.recorded.frame;
  ForeignField& signal = recorded.recorded.foreign.emplace_back(ForeignField{"signal", {}});
  for (std::size_t slot = 0; slot < before.num_slots(); ++slot) {
    signal.values.push_back(HasPointAt(before, slot) ? photons(before, slot) : 0.0F);
  }
  Inserter inserter(
      PlanOf(sensor.scenario, ThingsAlone(sensor.scenario, LoopThings()), sensor.pattern), 0);
  const InsertedFrame inserted = inserter.Insert(recorded, 0);
  std::size_t num_added = 0;
  for (const SlotEdit& edit : inserted.edits) {
    if (!edit.is_added || inserted.recorded.frame.instance[edit.slot] == 0) continue;
    const float expected = photons(inserted.recorded.frame, edit.slot);
    EXPECT_NEAR(inserted.recorded.foreign[0].values[edit.slot], expected, 1e-3F * expected);
    ++num_added;
  }
  EXPECT_GT(num_added, 20U);
}

}  // namespace
}  // namespace railcast
