// Beams of which only some have a width (BeamSpec::footprint_of), against the same frames in which
// all have one.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

/// Another caster that keeps the answers of NeedsWidth(), in the order in which it is asked.
class AnswersKept final : public RayCaster {
 public:
  explicit AnswersKept(const RayCaster& caster) : caster_(caster) {}
  void Cast(RayTile& tile) const override { caster_.Cast(tile); }
  void CastBeam(BeamRays& beam) const override { caster_.CastBeam(beam); }
  [[nodiscard]] bool NeedsWidth(const BeamRays& beam) const override {
    answers_.push_back(caster_.NeedsWidth(beam));
    return answers_.back();
  }
  [[nodiscard]] const std::vector<bool>& answers() const { return answers_; }

 private:
  const RayCaster& caster_;
  mutable std::vector<bool> answers_;
};

std::string BytesOfSlot(const Frame& frame, std::size_t slot) {
  std::string bytes;
  ForEachField(frame, [&](std::string_view, std::string_view, const auto& values) {
    bytes.append(reinterpret_cast<const char*>(&values[slot]), sizeof(values[slot]));
  });
  return bytes;
}

/// A shipped scenario on rung `footprint` with up to three returns.
class OnRungFootprint {
 public:
  OnRungFootprint(const std::string& name, const std::vector<std::string>& classes) {
    ScenarioSpec scenario =
        ReadScenario(std::string(RAILCAST_SOURCE_DIR "/scenarios/") + name + ".json");
    scenario.fidelity = Fidelity::kFootprint;
    scenario.effects.clear();
    scenario.lidar.receiver.return_mode = ReturnMode::kTriple;
    scenario.lidar.beam.footprint_of = classes;
    // One thread asks beam after beam.
    simulator_ = MakeSimulator(scenario, 1);
    spec_ = simulator_->spec();
  }

  [[nodiscard]] const std::vector<std::uint32_t>& labels() const {
    return spec_.detector.footprint_labels;
  }
  /// A frame in which the beams have a width that may meet the classes.
  [[nodiscard]] Frame Some(std::uint32_t frame) {
    simulator_->Use(spec_);
    return FrameBy(*simulator_, frame);
  }
  [[nodiscard]] Frame All(std::uint32_t frame) {
    SimulatorSpec spec = spec_;
    spec.detector.footprint_labels.clear();
    simulator_->Use(spec);
    return FrameBy(*simulator_, frame);
  }
  /// Whether beams have a width, by their places in the frame.
  [[nodiscard]] std::vector<bool> IsWide(std::uint32_t frame) {
    simulator_->Use(spec_);
    const ScanPattern& pattern = simulator_->pattern();
    std::vector<bool> is_wide(pattern.num_firings());
    simulator_->VisitScene(frame, [&](const SceneOfFrame& scene) {
      const AnswersKept caster(scene.caster);
      Frame ignored;
      simulator_->Scan(frame, HostScene{caster, scene.window_from_world, scene.surfaces}, ignored);
      for (std::size_t i = 0; i < is_wide.size(); ++i) {
        const std::uint32_t firing = pattern.packet_order[i];
        is_wide[std::size_t{pattern.row[firing]} * pattern.columns + pattern.column[firing]] =
            caster.answers()[i];
      }
    });
    return is_wide;
  }

 private:
  std::unique_ptr<Simulator> simulator_;
  SimulatorSpec spec_;
};

// No echo of a class that is asked for is lost, and a beam with a width gives what it gives where
// all have one, to the bit. Wires with a class that is asked for give their beams a width, too.
void ExpectTheSameOfClasses(const std::string& scenario,
                            const std::vector<std::string>& classes,
                            std::uint32_t index,
                            double most_wide) {
  OnRungFootprint rung(scenario, classes);
  const Frame all = rung.All(index);
  const Frame some = rung.Some(index);
  const std::vector<bool> is_wide = rung.IsWide(index);
  ASSERT_EQ(all.num_slots(), some.num_slots());
  std::size_t num_asked = 0;
  std::size_t num_others = 0;
  for (std::size_t firing = 0; firing < is_wide.size(); ++firing) {
    bool is_asked = false;
    bool is_same = true;
    for (std::size_t slot = firing * all.returns; slot < (firing + 1) * all.returns; ++slot) {
      is_same = is_same && BytesOfSlot(all, slot) == BytesOfSlot(some, slot);
      for (const Frame* frame : {&all, &some}) {
        is_asked = is_asked || (HasPoint(frame->outcome[slot]) &&
                                std::ranges::binary_search(rung.labels(), frame->label[slot]));
      }
    }
    num_asked += is_asked ? 1U : 0U;
    num_others += is_same ? 0U : 1U;
    EXPECT_TRUE(is_same || !(is_asked || is_wide[firing])) << firing;
  }
  EXPECT_GT(num_asked, 100U);
  EXPECT_GT(num_others, 100U) << "the others have no width";
  EXPECT_LT(std::ranges::count(is_wide, true), most_wide * static_cast<double>(is_wide.size()));
}

TEST(FootprintOf, LosesNothingOfPersonsWagonsAndPostsAtTheApproach) {
  ExpectTheSameOfClasses("st_gallen_approach",
                         {"person", "wagon", "object", "signal", "mast", "cantilever"}, 30, 0.12);
}

TEST(FootprintOf, LosesNothingOfRailsMastsAndWiresOnTheOpenLine) {
  ExpectTheSameOfClasses(
      "open_line", {"rail", "mast", "cantilever", "contact_wire", "messenger_wire", "dropper"}, 0,
      0.08);
}

TEST(FootprintOf, LosesNothingOfWagonsAndPersonsBetweenWagons) {
  ExpectTheSameOfClasses("parallel_wagons", {"person", "wagon"}, 12, 0.2);
}

// Trees and wires sway in a scene that is made for each frame.
TEST(FootprintOf, LosesNothingInWind) {
  const auto scan = [](bool is_of_all) {
    ScenarioSpec scenario = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/open_line.json");
    scenario.fidelity = Fidelity::kFootprint;
    scenario.weather.wind_speed_mps = 12.0;
    scenario.effects = {{"thin_conductors", false}};
    if (!is_of_all) scenario.lidar.beam.footprint_of = {"contact_wire", "messenger_wire"};
    return FrameBy(*MakeSimulator(scenario, 0));
  };
  const Frame all = scan(true);
  const Frame some = scan(false);
  constexpr std::uint32_t kContactWire = 7;
  constexpr std::uint32_t kMessengerWire = 8;
  std::size_t num_wires = 0;
  for (std::size_t slot = 0; slot < all.num_slots(); ++slot) {
    if (all.label[slot] != kContactWire && all.label[slot] != kMessengerWire) continue;
    ++num_wires;
    EXPECT_EQ(BytesOfSlot(all, slot), BytesOfSlot(some, slot)) << slot;
  }
  EXPECT_GT(num_wires, 50U);
}

TEST(FootprintOf, IsTheSameAtAnyNumberOfThreads) {
  ScenarioSpec scenario = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/parallel_wagons.json");
  scenario.fidelity = Fidelity::kFootprint;
  scenario.lidar.beam.footprint_of = {"person"};
  const Frame one = FrameBy(*MakeSimulator(scenario, 1), 3);
  const Frame three = FrameBy(*MakeSimulator(scenario, 3), 3);
  for (std::size_t slot = 0; slot < one.num_slots(); ++slot) {
    ASSERT_EQ(BytesOfSlot(one, slot), BytesOfSlot(three, slot)) << slot;
  }
}

}  // namespace
}  // namespace railcast
