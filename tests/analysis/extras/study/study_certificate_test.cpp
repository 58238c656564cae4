#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/extras/study/approach_scan.h"
#include "analysis/extras/study/run_study.h"
#include "analysis/extras/study/study_report.h"
#include "core/base/input_file.h"
#include "core/certify/rungs_beside.h"
#include "core/detect/base/beam_optics.h"
#include "core/extras/recipe/scenario_draw.h"
#include "core/fidelity/frame_comparison.h"
#include "tests/analysis/extras/study/study_project.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

// Is never complete, so that all frames up to the closest are traced.
constexpr DetectionRule kIncomplete = {
    .min_points = std::numeric_limits<std::uint32_t>::max(), .min_frames = 1, .of_frames = 1};

/// The certificate of one approach.
std::optional<RunCertificate> CertificateOfOne(const ApproachScanner& scanner) {
  StudyResult result;
  result.approaches.emplace_back().certificate = scanner.certificate();
  return CertificateOfStudy(result);
}

/// Echoes of an object, as whole frames have them.
struct ObjectEchoes {
  double reference{};
  double missed{};
  double frame{};
  double wrong{};

  void Add(const Frame& theirs, const Frame& ours, std::uint32_t instance, float distance_m) {
    for (std::size_t cell = 0; cell < std::size_t{theirs.rows} * theirs.columns; ++cell) {
      const FiringEchoes one(theirs, cell);
      const FiringEchoes other(ours, cell);
      const auto matches = MatchEchoes(one.ranges_m, other.ranges_m, distance_m);
      for (std::size_t i = 0; i < one.slots.size(); ++i) {
        if (theirs.instance[one.slots[i]] != instance) continue;
        reference += 1.0;
        const bool is_found =
            std::ranges::any_of(matches, [&](const auto& match) { return match.first == i; });
        (is_found ? frame : missed) += 1.0;
      }
      for (std::size_t k = 0; k < other.slots.size(); ++k) {
        const bool is_found =
            std::ranges::any_of(matches, [&](const auto& match) { return match.second == k; });
        if (is_found || ours.instance[other.slots[k]] != instance) continue;
        frame += 1.0;
        wrong += 1.0;
      }
    }
  }
};

TEST(StudyCertificate, GivesTheErrorOfWholeFramesIfAllFiringsAreDrawn) {
  const TemporaryDirectory directory;
  const StudySpec study = ReadStudy(WriteStudy(directory.path(), StudiedRecipe(1)));
  const Recipe recipe = ReadStudyRecipe(study);
  ScenarioSpec scenario = ScenarioDrawer(recipe).Draw(0).scenario;
  scenario.lidar.beam.reference_rays = 16;
  scenario.weather = {};
  const std::vector<std::uint32_t> frames = {0, 10, 20, 30, 36, 40, 44};
  ApproachScanner scanner(2, {}, {}, {}, 1e6);
  ASSERT_TRUE(scanner.Follow(scenario, frames, kIncomplete, [] { return false; }));
  ASSERT_TRUE(scanner.certificate());
  EXPECT_EQ(scanner.certificate()->frames, frames.size());
  const auto& objects = scanner.certificate()->objects;
  ASSERT_EQ(objects.size(), 1U);

  const auto simulator = MakeSimulator(scenario, 2);
  const EffectSet own = simulator->spec().detector.effects;
  const auto scan = [&](EffectSet effects, std::uint32_t index) {
    SimulatorSpec spec = simulator->spec();
    spec.detector.effects = WithoutRangeErrors(effects);
    simulator->Use(spec);
    Frame frame;
    simulator->Scan(index, frame);
    return frame;
  };
  ObjectEchoes echoes;
  for (const std::uint32_t index : frames) {
    echoes.Add(scan(EffectsAt(Fidelity::kReference, scenario), index), scan(own, index),
               objects.begin()->second,
               static_cast<float>(0.5 * PulseLength_m(scenario.lidar.beam)));
  }
  ASSERT_GT(echoes.reference, 50.0);
  EXPECT_GT(echoes.missed, 0.0);
  const auto certificate = CertificateOfOne(scanner);
  ASSERT_TRUE(certificate);
  EXPECT_EQ(certificate->drawn, certificate->firings);
  ASSERT_EQ(certificate->objects.size(), 1U);
  const CertifiedPart& person = certificate->objects.front();
  EXPECT_EQ(person.name, "person");
  // Rays are aimed within packets of others, so that one or the other at an edge may meet another
  // thing.
  EXPECT_NEAR(static_cast<double>(person.echoes), echoes.reference, 0.02 * echoes.reference);
  EXPECT_NEAR(person.missed->value, echoes.missed / echoes.reference, 0.02);
  EXPECT_NEAR(person.wrong->value, echoes.wrong / echoes.frame, 0.02);
  EXPECT_EQ(person.missed->value, certificate->all.missed->value);
  EXPECT_EQ(StudyCertificateSection(certificate).key, "certificate");

  scenario.fidelity = Fidelity::kReference;
  ASSERT_TRUE(scanner.Follow(scenario, {40}, kIncomplete, [] { return false; }));
  EXPECT_FALSE(scanner.certificate());
  EXPECT_FALSE(CertificateOfOne(scanner));
}

TEST(StudyCertificate, LeavesVerdictsAsTheyAreAndIsTheSameOnAnyNumberOfThreadsAndInShards) {
  const TemporaryDirectory directory;
  const auto path = [&](const std::string& name) { return directory.path() / name; };
  const auto lines = [&](const std::string& folder) {
    return ReadFileWhole(path(folder) / "approaches.jsonl");
  };
  const auto file = WriteStudy(directory.path(), StudiedRecipe(4));
  const StudyResult one =
      RunStudyIn(file, {.directory = path("one"), .num_threads = 1, .certify = 1.0});
  (void)RunStudyIn(file, {.directory = path("three"), .num_threads = 3, .certify = 1.0});
  EXPECT_EQ(lines("three"), lines("one"));
  for (const std::uint32_t number : {1U, 2U}) {
    (void)RunStudyIn(file, {.directory = path("shard" + std::to_string(number)),
                            .shard = {number, 2},
                            .num_threads = 2,
                            .certify = 1.0});
  }
  (void)RunStudyIn(
      file,
      {.directory = path("joined"), .shards = {path("shard1"), path("shard2")}, .certify = 1.0});
  EXPECT_EQ(lines("joined"), lines("one"));

  const StudyResult plain = RunStudyIn(file, {.directory = path("plain")});
  ASSERT_EQ(plain.approaches.size(), one.approaches.size());
  std::size_t num_drawn = 0;
  for (std::size_t i = 0; i < plain.approaches.size(); ++i) {
    ASSERT_TRUE(one.approaches[i].certificate);
    EXPECT_FALSE(plain.approaches[i].certificate);
    num_drawn += one.approaches[i].certificate->sum.drawn.size();
    ASSERT_EQ(one.approaches[i].objects.size(), plain.approaches[i].objects.size());
    for (std::size_t k = 0; k < plain.approaches[i].objects.size(); ++k) {
      EXPECT_EQ(one.approaches[i].objects[k].is_detected,
                plain.approaches[i].objects[k].is_detected);
      EXPECT_EQ(one.approaches[i].objects[k].frame, plain.approaches[i].objects[k].frame);
    }
  }
  EXPECT_GT(num_drawn, 0U);
  EXPECT_TRUE(CertificateOfStudy(one));
  EXPECT_FALSE(CertificateOfStudy(plain));
}

TEST(StudyCertificate, IsMadeUnlessItIsOffAndNotOfAStudyThatWasBegunWithout) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = WriteStudy(directory.path(), StudiedRecipe(3));
  const auto run = [&](const std::string& folder, const std::string& options) {
    return RunCommand(RAILCAST_ANALYZE " study " + file.string() + " --out " +
                      (directory.path() / folder).string() + options);
  };
  const auto text = [&](const std::string& name) { return ReadFileWhole(directory.path() / name); };
  const Ended without = run("without", " --certify off");
  ASSERT_EQ(without.status, 0) << without.said;
  const std::string lines = text("without/approaches.jsonl");
  EXPECT_EQ(lines.find("certificate"), std::string::npos);
  WriteFileWhole(directory.path() / "without/approaches.jsonl",
                 lines.substr(0, lines.find('\n') + 1));
  EXPECT_EQ(run("without", " --certify 1%").status, 1);
  const Ended again = run("without", "");
  ASSERT_EQ(again.status, 0) << again.said;
  EXPECT_EQ(text("without/approaches.jsonl"), lines);

  const Ended usual = run("usual", "");
  ASSERT_EQ(usual.status, 0) << usual.said;
  EXPECT_EQ(nlohmann::json::parse(text("usual/study.json")).at("certify"), 0.01);
  const auto has_section = [&](const std::string& folder) {
    const auto report = nlohmann::json::parse(text(folder + "/report.json"));
    return std::ranges::any_of(report.at("sections"), [](const nlohmann::json& section) {
      return section.at("key") == "certificate";
    });
  };
  EXPECT_TRUE(has_section("usual"));
  EXPECT_FALSE(has_section("without"));
}

}  // namespace
}  // namespace railcast
