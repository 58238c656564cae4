#include "core/extras/survey/survey_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

SurveyTile ExampleTile() {
  SurveyTile tile{.cell = {-2, 7}, .base_m = 412.0, .surfels = {}, .wires = {}, .ground_m = {}};
  tile.surfels.push_back({{1.0F, 2.0F, 0.5F}, {0.1F, 0.0F, 0.0F}, {0.0F, 0.2F, 0.0F}, {7, 1}});
  tile.surfels.push_back({{3.0F, 4.0F, 1.5F}, {0.0F, 0.0F, 0.3F}, {0.0F, 0.2F, 0.0F}, {49, 0}});
  tile.wires.push_back({{30, 1}, 0.006F, {{0.0F, 0.0F, 5.5F}, {8.0F, 0.0F, 5.4F}}});
  tile.ground_m.assign(kGroundCells * kGroundCells, std::numeric_limits<float>::quiet_NaN());
  tile.ground_m[3 * kGroundCells + 5] = 0.25F;
  return tile;
}

std::string ExampleBytes() {
  return EncodeSurvey({"ground", "wall"}, {ExampleTile()});
}

class SurveyFileOf {
 public:
  explicit SurveyFileOf(const std::string& bytes) : path_(directory_.path() / "scene.survey") {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string Fault() const {
    try {
      const SurveyFile file(path_);
      for (std::size_t i = 0; i < file.tiles().size(); ++i) static_cast<void>(file.Read(i));
    } catch (const InputError& error) {
      std::string fault = error.what();
      const std::string name = path_.filename().string();
      if (fault.starts_with(name)) fault.replace(0, name.size(), "FILE");
      return fault;
    }
    return "";
  }

 private:
  TemporaryDirectory directory_;
  std::filesystem::path path_;
};

TEST(SurveyFile, ReadsWhatWasWritten) {
  const SurveyFileOf written(ExampleBytes());
  const SurveyFile file(written.path());
  EXPECT_EQ(file.labels(), (std::vector<std::string>{"ground", "wall"}));
  EXPECT_EQ(file.num_surfels(), 2U);
  ASSERT_EQ(file.tiles().size(), 1U);
  const SurveyTile tile = file.Read(0);
  const SurveyTile expected = ExampleTile();
  EXPECT_EQ(tile.Origin_m(), Vector3(-32.0, 112.0, 412.0));
  ASSERT_EQ(tile.surfels.size(), 2U);
  EXPECT_EQ(tile.surfels[1].center_m, expected.surfels[1].center_m);
  EXPECT_EQ(tile.surfels[1].half_u_m, expected.surfels[1].half_u_m);
  EXPECT_EQ(tile.surfels[0].half_v_m, expected.surfels[0].half_v_m);
  EXPECT_EQ(tile.surfels[1].surface, expected.surfels[1].surface);
  ASSERT_EQ(tile.wires.size(), 1U);
  EXPECT_EQ(tile.wires[0].points_m, expected.wires[0].points_m);
  EXPECT_EQ(tile.wires[0].radius_m, 0.006F);
}

TEST(SurveyFile, KnowsTheGroundInCellsOfHalfAMetre) {
  const SurveyFileOf written(ExampleBytes());
  const SurveyFile file(written.path());
  const SurveyTile& tile = file.tiles().front();
  EXPECT_EQ(GroundHeight_m(tile, {-32.0 + 2.6, 112.0 + 1.9}), 412.25);
  EXPECT_EQ(GroundHeight_m(tile, {-32.0 + 3.1, 112.0 + 1.9}), std::nullopt);
}

TEST(SurveyFile, SaysWhatIsWrong) {
  EXPECT_EQ(SurveyFileOf("ply\nformat ascii 1.0\n").Fault(),
            "FILE: must be a survey that railcast-generate survey has written");
  EXPECT_EQ(SurveyFileOf("").Fault(),
            "FILE: must be a survey that railcast-generate survey has written");
  EXPECT_EQ(SurveyFileOf(ExampleBytes().substr(0, 4000)).Fault(),
            "FILE: is damaged: it ends too early");
  std::string bytes = ExampleBytes();
  bytes.pop_back();
  EXPECT_EQ(SurveyFileOf(bytes).Fault(), "FILE: is damaged: it ends too early");
}

TEST(SurveyFile, RefusesSurfacesThatNothingDescribes) {
  SurveyTile tile = ExampleTile();
  tile.surfels[0].surface.label = 2;
  EXPECT_EQ(SurveyFileOf(EncodeSurvey({"ground", "wall"}, {tile})).Fault(),
            "FILE: is damaged: a surface has an unknown label or reflectivity");
  tile = ExampleTile();
  tile.surfels[0].center_m.x() = std::nanf("");
  EXPECT_EQ(SurveyFileOf(EncodeSurvey({"ground", "wall"}, {tile})).Fault(),
            "FILE: is damaged: a point is nowhere");
  tile = ExampleTile();
  tile.wires[0].points_m.resize(1);
  EXPECT_EQ(SurveyFileOf(EncodeSurvey({"ground", "wall"}, {tile})).Fault(),
            "FILE: is damaged: a wire is none");
}

TEST(SurveyLevels, AreWithinFivePercentOfEveryReflectivity) {
  for (double reflectivity = 0.01; reflectivity < 1.0; reflectivity *= 1.013) {
    const double level = MaterialOfLevel(SurveyLevelOf(reflectivity)).reflectivity;
    EXPECT_NEAR(level / reflectivity, 1.0, 0.05) << reflectivity;
  }
  EXPECT_EQ(SurveyLevelOf(0.0), 0);
  EXPECT_EQ(SurveyLevelOf(std::nan("")), 0);
  EXPECT_EQ(SurveyLevelOf(50.0), kNumSurveyLevels - 1);
}

}  // namespace
}  // namespace railcast
