// The railway world gives the same frame wherever it lies: at UTM coordinates and 29 km down the
// line.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "core/rail/catenary/catenary.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

constexpr double kPlacementTolerance_m = 2e-4;

ScenarioSpec Demo() {
  ScenarioSpec spec = ReadScenario(std::filesystem::path(RAILCAST_SOURCE_DIR) /
                                   "scenarios/st_gallen_approach.json");
  spec.fidelity = Fidelity::kGeometry;
  return spec;
}

Frame ScanFrame(const ScenarioSpec& spec, std::uint32_t index) {
  const auto simulator = MakeSimulator(spec, 0);
  Frame frame;
  simulator->Scan(index, frame);
  return frame;
}

struct Difference {
  std::size_t num_compared = 0;
  std::size_t num_other_labels = 0;
  double worst_m = 0.0;
};

// Compares the slots for which `counts` holds for the labels in both frames.
template <typename Counts>
Difference ComparePlacement(const Frame& a, const Frame& b, const Counts& counts) {
  Difference difference;
  for (std::size_t slot = 0; slot < a.num_slots(); ++slot) {
    if (!counts(a.label[slot]) || !counts(b.label[slot])) continue;
    ++difference.num_compared;
    const bool is_numbered_along_the_line = a.instance[slot] >= kFirstMastInstance;
    if (a.label[slot] != b.label[slot] ||
        (!is_numbered_along_the_line && a.instance[slot] != b.instance[slot])) {
      ++difference.num_other_labels;
    } else if (a.label[slot] != 0) {
      difference.worst_m = std::max(
          difference.worst_m,
          std::abs(static_cast<double>(a.range_m[slot]) - static_cast<double>(b.range_m[slot])));
    }
  }
  return difference;
}

// A beam within 0.1 mm of an edge may fall on either side of it and get another label. Each frame
// has 40 such beams, but only the last bits of poses in double differ here: none of 1,440,000 beams
// of the demo got another label. Leaves and blades of grass are full of edges, so their ranges may
// differ without another label; those of wires, rails and wagons must not.
TEST(RailPlacement, UtmCoordinatesAndAnotherHeadingGiveTheSameFrame) {
  ScenarioSpec here = Demo();
  ScenarioSpec there = here;
  there.world.alignment.origin_m = {5.3e6, 6e5, 400.0};
  there.world.alignment.heading_deg = 77.0;
  const Frame a = ScanFrame(here, 20);
  const Frame b = ScanFrame(there, 20);
  const LabelTable labels(here.labels);
  const std::set<std::uint32_t> plants = {labels.Id("grass"), labels.Id("tree")};
  const Difference hard =
      ComparePlacement(a, b, [&](std::uint32_t label) { return !plants.contains(label); });
  const Difference all = ComparePlacement(a, b, [](std::uint32_t) { return true; });
  RecordProperty("other_labels", static_cast<int>(all.num_other_labels));
  EXPECT_GT(hard.num_compared, 20'000U);
  EXPECT_LE(hard.num_other_labels, 1U);
  EXPECT_LE(hard.worst_m, kPlacementTolerance_m);
  EXPECT_EQ(all.num_compared, 28'800U);
  EXPECT_LE(all.num_other_labels, 1U);
}

// 29,250 m is a whole number of chunks (50 m), sleepers (0.6 m) and spans (65 m), so everything
// that repeats along the line is the same there. Stones and plants do not repeat and are left out.
TEST(RailPlacement, TwentyNineKilometresDownTheLineRailsWiresAndWagonsAreTheSame) {
  constexpr double kFarther_m = 29'250.0;
  ScenarioSpec here = Demo();
  here.world.alignment = {};
  here.world.alignment.course =
      AlignmentElementsSpec{{{ElementType::kStraight, 40'000.0, std::nullopt}}};
  here.world.vegetation.trees_per_hectare = 0.0;
  here.world.vegetation.grass = false;
  // The ground's roughness differs between the two places, so no object may stand on the ground.
  for (ObjectSpec& object : here.world.objects) object.h_m = object.h_m.value_or(0.0);
  ScenarioSpec there = here;
  there.vehicle.start_s_m += kFarther_m;
  for (ObjectSpec& object : there.world.objects) object.s_m += kFarther_m;
  const Frame a = ScanFrame(here, 20);
  const Frame b = ScanFrame(there, 20);
  const LabelTable labels(here.labels);
  std::set<std::uint32_t> repeated;
  for (const char* name : {"rail", "contact_wire", "messenger_wire", "dropper", "cantilever",
                           "wagon", "person", "object", "signal"}) {
    repeated.insert(labels.Id(name));
  }
  const Difference difference =
      ComparePlacement(a, b, [&](std::uint32_t label) { return repeated.contains(label); });
  EXPECT_GT(difference.num_compared, 1'000U);
  EXPECT_LE(difference.num_other_labels, 1U);
  EXPECT_LE(difference.worst_m, kPlacementTolerance_m);
}

}  // namespace
}  // namespace railcast
