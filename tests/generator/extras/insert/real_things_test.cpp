// Things are cut out of real captures; models of their size are put in at their places; and what
// comes back is compared with the real points, firing by firing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "generator/extras/insert/firing_finder.h"
#include "generator/extras/insert/inserter.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/plan/plan_project.h"
#include "tests/generator/extras/insert/two_samples.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A thing that stands in a capture, as it was measured in its points (docs/insert.md, "Against
/// reality"). Places are in the sensor's axes, heights above the sensor.
struct RealThing {
  std::string sensor;
  std::string what;
  std::string recording;  ///< Below the folder of shared data.
  std::uint32_t frame{};
  std::string type;  ///< Of the model.
  double azimuth_deg{};
  double distance_m{};  ///< Of its axis at the height of the sensor, horizontally.
  double low_m{}, high_m{};
  double length_m{}, width_m{};  ///< Of a pole both are its diameter.
  double heading_deg{};
  double lean_left_deg{}, lean_away_deg{};  ///< As it is headed; poles are headed away.
  /// What is this far beside the model is cut out, too: noise and, of persons, limbs.
  double reach_m = 0.15;
  double reach_aside_m = 0.15;
};

RealThing Pole(RealThing thing) {
  thing.type = "pole";
  thing.heading_deg = thing.azimuth_deg;
  thing.length_m = thing.width_m;
  return thing;
}

std::vector<RealThing> RealThings() {
  const std::string nebula = "lidar_packets_nebula/";
  const std::string vls128 = nebula + "vls128_single.pcap";
  const std::string os1 = "lidar_ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap";
  const std::string os2 = "lidar_ouster/OS-2-128-U1_v2.3.0_1024x10.pcap";
  const std::string xt32 = "lidar_hesai/captures/xt32.db3";
  return {
      Pole({"VLS-128", "pole", vls128, 2, "", -55.61, 7.737, -1.5, 2.1, 0, 0.326, 0, -0.05, -0.22}),
      Pole({"VLS-128", "post A", vls128, 2, "", -141.487, 11.109, -1.45, 0.3, 0, 0.314, 0, -0.9,
            1.06}),
      Pole({"VLS-128", "post B", vls128, 2, "", -146.394, 12.642, -1.5, 3.3, 0, 0.313, 0, -0.9,
            0.96}),
      Pole({"VLS-128", "post C", vls128, 2, "", -161.547, 23.808, -1.0, 3.0, 0, 0.261, 0, -0.5,
            0.95}),
      Pole({"VLS-128", "post D", vls128, 2, "", -39.949, 22.385, -1.4, 3.0, 0, 0.242, 0, 0.45,
            -0.6}),
      {"VLS-128", "box", vls128, 2, "box", -44.85, 5.309, -1.12, -0.338, 0.278, 0.199, -87.0},
      {"Pandar64", "part of a door", nebula + "pandar64.pcap", 1, "box", -123.91, 6.184, -0.75, 0.1,
       0.05, 0.5, -99.2, 0, 0, 0.15, 0},
      {"XT32", "panel", xt32, 1, "box", -92.75, 0.7109, 0.028, 0.25, 0.05, 0.197, -84.9, 0, 0, 0.05,
       0.05},
      {"VLP-32C", "panel", nebula + "vlp32c_single.pcap", 2, "box", -25.72, 3.654, -0.195, 1.2,
       0.02, 0.892, 3.1},
      Pole({"OS1-128", "pole", os1, 1, "", -52.0, 6.899, -1.6, 2.6, 0, 0.426, 0, 0.8, -2.3, 0.25,
            0.25}),
      Pole({"OS1-128", "bin", os1, 1, "", -93.1, 6.116, -1.8, -0.66, 0, 0.61, 0, 0, 0, 0.25, 0.25}),
      {"OS1-128", "walking person", os1, 1, "person", -33.28, 13.108, -1.93, -0.38, 0.6, 0.6, 167.4,
       0, 0, 0.3, 0.3},
      Pole({"OS2-128", "pole", os2, 0, "", -48.03, 6.545, -1.1, 1.4, 0, 0.414, 0, 0.8, -2.9, 0.2,
            0.2}),
  };
}

// By its foot: it leans about its lowest point.
Transform SensorFromThing(const RealThing& thing) {
  const Eigen::AngleAxisd heading(RadFromDeg(thing.heading_deg), Vector3::UnitZ());
  const double azimuth_rad = RadFromDeg(thing.azimuth_deg);
  const Vector3 axis_m(thing.distance_m * std::cos(azimuth_rad),
                       thing.distance_m * std::sin(azimuth_rad), 0.0);
  const Vector3 lean(std::tan(RadFromDeg(thing.lean_away_deg)),
                     std::tan(RadFromDeg(thing.lean_left_deg)), 1.0);
  const Eigen::Matrix3d turned =
      (heading * Eigen::AngleAxisd(RadFromDeg(thing.lean_away_deg), Vector3::UnitY()) *
       Eigen::AngleAxisd(-RadFromDeg(thing.lean_left_deg), Vector3::UnitX()))
          .toRotationMatrix();
  return MakeTransform(turned, axis_m + thing.low_m * (heading * lean));
}

/// The plan's section of objects.
std::string ObjectsOf(const RealThing& thing) {
  constexpr double kMountHeight_m = 2.5;  // Of sensors that are found.
  const Vector3 foot_m = SensorFromThing(thing).translation();
  const auto key = [](const char* name, double value) {
    return std::string(", \"") + name + "\": " + NumberText(value);
  };
  return R"(, "objects": [{"name": "thing", "type": ")" + thing.type +
         "\", \"frame\": " + std::to_string(thing.frame) + key("x_m", foot_m.x()) +
         key("y_m", foot_m.y()) + key("h_m", foot_m.z() + kMountHeight_m) +
         key("heading_deg", thing.heading_deg) + key("roll_deg", -thing.lean_left_deg) +
         key("pitch_deg", thing.lean_away_deg) + ", \"size_m\": [" + NumberText(thing.length_m) +
         ", " + NumberText(thing.width_m) + ", " + NumberText(thing.high_m - thing.low_m) + "]}]";
}

/// Of a capture from which nothing was taken for any preset, material or model.
std::vector<RealThing> HeldOutThings() {
  const std::string os0 = "ouster_more/OS-0-128-U1_v2.3.0_1024x10.pcap";
  return {Pole({"OS0-128", "utility pole", os0, 0, "", 33.68, 12.59, -0.3, 7.9, 0, 0.307, 0, -1.68,
                0.52, 0.2, 0.2}),
          Pole({"OS0-128", "sign post", os0, 0, "", -24.22, 11.965, -0.3, 3.35, 0, 0.146, 0, 0.95,
                -0.55, 0.2, 0.2})};
}

/// A return on the thing.
struct Echo {
  std::uint32_t row{}, column{};
  double range_m{};
  double intensity{};  ///< Of retroreflectors 1.
};
using Echoes = std::map<std::pair<std::uint32_t, std::uint32_t>, Echo>;  // By row and column.

Echo EchoAt(const Frame& frame, std::size_t slot) {
  const auto cell = static_cast<std::uint32_t>(slot / frame.returns);
  return {cell / frame.columns, cell % frame.columns, static_cast<double>(frame.range_m[slot]),
          std::min(1.0, static_cast<double>(frame.intensity[slot]))};
}

void Put(const Echo& echo, Echoes& echoes) {
  echoes.emplace(std::pair(echo.row, echo.column), echo);
}

/// Takes the thing's points out of a frame; what is behind them stays unknown.
Echoes CutOut(const RealThing& thing, RecordedFirings& firings) {
  Frame& frame = firings.recorded.frame;
  const Transform thing_from_sensor = SensorFromThing(thing).inverse();
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  Echoes echoes;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    const Vector3 point_m(static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
                          static_cast<double>(frame.z[slot]));
    const Vector3 inside_m = thing_from_sensor * point_m;
    if (std::abs(inside_m.x()) > 0.5 * thing.length_m + thing.reach_m ||
        std::abs(inside_m.y()) > 0.5 * thing.width_m + thing.reach_aside_m || inside_m.z() < 0.0 ||
        inside_m.z() > thing.high_m - thing.low_m) {
      continue;
    }
    Put(EchoAt(frame, slot), echoes);
    frame.x[slot] = frame.y[slot] = frame.z[slot] = frame.range_m[slot] = kNaN;
  }
  return echoes;
}

/// A capture without the thing, and the plan that puts it in again.
struct CutThing {
  RealThing thing;
  InsertPlan plan;
  RecordedFirings firings;
  Echoes real;
};

CutThing CutOutOfCapture(const RealThing& thing) {
  const fs::path recording = fs::path(RAILCAST_SHARED_DATA_DIR) / thing.recording;
  const TemporaryDirectory folder;
  CutThing cut{.thing = thing,
               .plan = ReadInsertPlan(WritePlan(folder.path(), R"({"poses": "standing"})",
                                                ObjectsOf(thing), R"("fidelity": "footprint", )"),
                                      recording),
               .firings = {},
               .real = {}};
  const auto opened = OpenRecording(recording);
  RecordedFrame recorded;
  for (std::uint32_t i = 0; i <= thing.frame; ++i) recorded = (*opened->Next())();
  const ScanSpec& scan = cut.plan.scenario.lidar.scan;
  cut.firings = FiringFinder(opened->info(), scan, false).Find(std::move(recorded));
  cut.real = CutOut(thing, cut.firings);
  return cut;
}

double MeanIntensity(const Echoes& echoes) {
  double sum = 0.0;
  for (const auto& [cell, echo] : echoes) sum += echo.intensity;
  return sum / static_cast<double>(std::max<std::size_t>(echoes.size(), 1));
}

/// The returns on the model.
Echoes InsertedEchoes(const CutThing& cut) {
  const InsertedFrame inserted = Inserter(cut.plan, 0).Insert(cut.firings, cut.thing.frame);
  Echoes echoes;
  for (const SlotEdit& edit : inserted.edits) {
    if (edit.is_added) Put(EchoAt(inserted.recorded.frame, edit.slot), echoes);
  }
  return echoes;
}

// The materials reflect so much that the mean intensity is the real one, from a first guess.
Echoes PutAgain(CutThing cut, Fidelity rung = Fidelity::kFootprint) {
  cut.plan.scenario.fidelity = rung;
  double reflectivity = MeanIntensity(cut.real);
  Echoes ours;
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (Material& material : cut.plan.scenario.materials) material.reflectivity = reflectivity;
    ours = InsertedEchoes(cut);
    reflectivity *= MeanIntensity(cut.real) / std::max(1e-6, MeanIntensity(ours));
  }
  return ours;
}

/// A thing that was cut out of its capture, and ours in its place; made once for all tests.
const std::pair<CutThing, Echoes>& CutOutAndPutAgain(const RealThing& thing) {
  static std::map<std::string, std::pair<CutThing, Echoes>> made;
  auto& again = made[thing.recording + ", " + thing.what];
  if (again.second.empty()) again.second = PutAgain(again.first = CutOutOfCapture(thing));
  return again;
}

/// The echoes of a row, by column.
std::map<std::uint32_t, std::vector<Echo>> RowsOf(const Echoes& echoes) {
  std::map<std::uint32_t, std::vector<Echo>> rows;
  for (const auto& [cell, echo] : echoes) rows[echo.row].push_back(echo);
  return rows;
}

double Mean(const std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

double Spread(const std::vector<double>& values) {
  const double mean = Mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

/// How far the model's returns are from the real ones.
struct Difference {
  double points{};        ///< Ours per real one.
  double row_error{};     ///< Sum over the rows of the difference of their points, per real point.
  double range_m{};       ///< Mean of ours - real over firings with both, ...
  double range_rms_m{};   ///< ... and the spread about it.
  double edge_firings{};  ///< By how many firings rows of ours reach further, at each end.
  double spread_real{}, spread_ours{};  ///< Of the rows' mean intensities.
};

double MeanOf(const std::vector<Echo>& echoes, double Echo::*value) {
  std::vector<double> values;
  for (const Echo& echo : echoes) values.push_back(echo.*value);
  return Mean(values);
}

double Extent(const std::vector<Echo>& row) {
  return static_cast<double>(row.back().column) - static_cast<double>(row.front().column);
}

Difference Compare(const Echoes& all_real, const Echoes& all_ours) {
  std::vector<double> ranges_m;
  for (const auto& [cell, echo] : all_real) {
    const auto found = all_ours.find(cell);
    if (found != all_ours.end()) ranges_m.push_back(found->second.range_m - echo.range_m);
  }
  const auto real = RowsOf(all_real);
  const auto ours = RowsOf(all_ours);
  std::set<std::uint32_t> rows;
  for (const auto* side : {&real, &ours}) {
    for (const auto& [row, echoes] : *side) rows.insert(row);
  }
  std::vector<double> edges, intensities_real, intensities_ours;
  double row_error = 0.0;
  for (const std::uint32_t row : rows) {
    const auto a = real.find(row);
    const auto b = ours.find(row);
    const double num_a = a == real.end() ? 0.0 : static_cast<double>(a->second.size());
    const double num_b = b == ours.end() ? 0.0 : static_cast<double>(b->second.size());
    row_error += std::abs(num_a - num_b);
    if (num_a == 0.0 || num_b == 0.0) continue;
    intensities_real.push_back(MeanOf(a->second, &Echo::intensity));
    intensities_ours.push_back(MeanOf(b->second, &Echo::intensity));
    edges.push_back(0.5 * (Extent(b->second) - Extent(a->second)));
  }
  const auto num_real = static_cast<double>(all_real.size());
  return {.points = static_cast<double>(all_ours.size()) / num_real,
          .row_error = row_error / num_real,
          .range_m = Mean(ranges_m),
          .range_rms_m = Spread(ranges_m),
          .edge_firings = Mean(edges),
          .spread_real = Spread(intensities_real),
          .spread_ours = Spread(intensities_ours)};
}

bool IsThere(const RealThing& thing) {
  return exists(fs::path(RAILCAST_SHARED_DATA_DIR) / thing.recording);
}

void PrintRow(const CutThing& cut, const Echoes& beams, const Echoes& rays) {
  const Difference d = Compare(cut.real, beams);
  std::printf(
      "| %s | %s | %.1f m | %zu | %zu | %zu | %zu, %zu | %.0f %% | %.0f mm | %+.2f | %+.2f | %.2f "
      "| "
      "%.3f, %.3f |\n",
      cut.thing.sensor.c_str(), cut.thing.what.c_str(), cut.thing.distance_m, cut.real.size(),
      beams.size(), rays.size(), RowsOf(cut.real).size(), RowsOf(beams).size(), 100.0 * d.row_error,
      1e3 * d.range_rms_m, d.edge_firings, Compare(cut.real, rays).edge_firings,
      MeanIntensity(cut.real), d.spread_real, d.spread_ours);
}

/// Intensity across the width of a thing, from left to right, in units of its mean.
class Profile {
 public:
  void Add(const Echoes& echoes) {
    const double mean = MeanIntensity(echoes);
    for (const auto& [number, row] : RowsOf(echoes)) {
      if (row.size() < 6) continue;
      for (const Echo& echo : row) {
        const double place = (echo.column - row.front().column) / Extent(row);
        bins_.at(std::min<std::size_t>(10, static_cast<std::size_t>(11.0 * place)))
            .push_back(echo.intensity / mean);
      }
    }
  }
  [[nodiscard]] double At(std::size_t bin) const { return Mean(bins_.at(bin)); }

 private:
  std::vector<std::vector<double>> bins_ = std::vector<std::vector<double>>(11);
};

// scripts/dev/draw_insertion.sh draws what this prints.
TEST(RealThings, ComeBackWhereTheyWereCutOut) {
  std::size_t num = 0;
  double sum_of_beams = 0.0, sum_of_rays = 0.0;
  Profile real, ours;
  for (const RealThing& thing : RealThings()) {
    if (!IsThere(thing)) continue;
    SCOPED_TRACE(thing.sensor + ", " + thing.what);
    const auto& [cut, beams] = CutOutAndPutAgain(thing);
    const Echoes rays = PutAgain(cut, Fidelity::kSurface);
    PrintRow(cut, beams, rays);
    const Difference difference = Compare(cut.real, beams);
    const bool is_person = thing.type == "person";  // Its posture is unknown.
    EXPECT_NEAR(difference.points, 1.0, is_person ? 0.15 : 0.09);
    EXPECT_LT(difference.row_error, is_person ? 0.3 : 0.14);
    EXPECT_LT(std::abs(difference.range_m), is_person ? 0.05 : 0.015);
    EXPECT_LT(difference.range_rms_m, is_person ? 0.3 : 0.12);
    EXPECT_LT(std::abs(difference.edge_firings), 1.1);
    if (thing.type != "pole") continue;
    ++num;
    sum_of_beams += std::abs(difference.edge_firings);
    sum_of_rays += std::abs(Compare(cut.real, rays).edge_firings);
    if (thing.sensor != "VLS-128") continue;
    real.Add(cut.real);
    ours.Add(beams);
  }
  if (num == 0) GTEST_SKIP() << "no captures in " << RAILCAST_SHARED_DATA_DIR;
  std::printf("edges of %zu poles, in firings: beams %.2f, thin rays %.2f\n", num,
              sum_of_beams / static_cast<double>(num), sum_of_rays / static_cast<double>(num));
  EXPECT_LT(sum_of_beams, 0.6 * sum_of_rays);
  for (std::size_t bin = 0; bin < 11; ++bin) {
    std::printf("across: %zu %.3f %.3f\n", bin, real.At(bin), ours.At(bin));
  }
}

/// What a row of a thing shows: number of points, mean and spread of range, how much nearer its
/// middle is than its ends, mean and spread of intensity, and how much brighter its middle is.
std::vector<double> FeaturesOf(const std::vector<Echo>& row, double mean_intensity) {
  std::vector<double> ranges_m, intensities, inner_m, outer_m, inner, outer;
  for (std::size_t i = 0; i < row.size(); ++i) {
    ranges_m.push_back(row[i].range_m);
    intensities.push_back(row[i].intensity / mean_intensity);
    const bool is_outer = i < row.size() / 3 || i >= row.size() - row.size() / 3;
    (is_outer ? outer_m : inner_m).push_back(row[i].range_m);
    (is_outer ? outer : inner).push_back(intensities.back());
  }
  return {static_cast<double>(row.size()), Mean(ranges_m),    Spread(ranges_m),
          Mean(outer_m) - Mean(inner_m),   Mean(intensities), Spread(intensities),
          Mean(inner) - Mean(outer)};
}

constexpr std::array<const char*, 7> kFeatures = {
    "number of points", "mean range", "spread of range",          "ends behind the middle",
    "mean intensity",   "its spread", "middle brighter than ends"};
constexpr std::size_t kNumOfShape = 4;

/// The rows of a real thing and of ours in its place, each feature less its mean over the thing.
TwoSamples RowsOfBoth(const RealThing& thing) {
  const auto& [cut, ours] = CutOutAndPutAgain(thing);
  TwoSamples rows;
  for (const auto* echoes : {&cut.real, &ours}) {
    for (const auto& [number, row] : RowsOf(*echoes)) {
      if (row.size() >= 3) rows.Add(FeaturesOf(row, MeanIntensity(*echoes)), echoes == &ours);
    }
  }
  for (std::size_t k = 0; k < kFeatures.size(); ++k) {
    const double mean = Mean(rows.Column(k));
    for (auto& row : rows.features) row[k] -= mean;
  }
  return rows;
}

/// Some of the features.
TwoSamples Only(const TwoSamples& samples, std::size_t first, std::size_t num) {
  TwoSamples some = samples;
  for (auto& row : some.features) {
    const auto begin = row.begin() + static_cast<std::ptrdiff_t>(first);
    row = std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(num));
  }
  return some;
}

// Rows of the real poles and posts of the VLS-128 against ours. No thing is scored by what its own
// rows have taught.
TEST(RealThings, AreToldFromOursByTheseFeatures) {
  TwoSamples all;
  std::size_t num_things = 0;
  for (const RealThing& thing : RealThings()) {
    if (thing.sensor != "VLS-128" || thing.type != "pole" || !IsThere(thing)) continue;
    const TwoSamples rows = RowsOfBoth(thing);
    for (std::size_t i = 0; i < rows.features.size(); ++i) {
      all.Add(rows.features[i], rows.is_second[i], num_things);
    }
    ++num_things;
  }
  if (all.features.empty()) GTEST_SKIP() << "no captures in " << RAILCAST_SHARED_DATA_DIR;
  const double area_of_shapes = CrossValidatedArea(Only(all, 0, kNumOfShape));
  std::printf("%zu rows, area %.2f, of shapes alone %.2f, of intensities alone %.2f\n",
              all.features.size(), CrossValidatedArea(all), area_of_shapes,
              CrossValidatedArea(Only(all, kNumOfShape, kFeatures.size() - kNumOfShape)));
  EXPECT_LE(area_of_shapes, 0.72);
  for (std::size_t k = 0; k < kFeatures.size(); ++k) {
    std::printf("| %s | %.2f |\n", kFeatures.at(k), CrossValidatedArea(Only(all, k, 1)));
  }
}

/// How far the first and the last returns of rows of six or more are behind the middle third, m.
std::array<double, 2> EndsBehindTheMiddle_m(const Echoes& echoes) {
  std::vector<double> first_m, last_m;
  for (const auto& [number, row] : RowsOf(echoes)) {
    if (row.size() < 6) continue;
    const auto third = static_cast<std::ptrdiff_t>(row.size() / 3);
    const double middle_m =
        MeanOf(std::vector<Echo>(row.begin() + third, row.end() - third), &Echo::range_m);
    first_m.push_back(row.front().range_m - middle_m);
    last_m.push_back(row.back().range_m - middle_m);
  }
  return {Mean(first_m), Mean(last_m)};
}

// The VLS-128 itself tells the two ends of a round post apart, which no beam of ours does.
TEST(RealThings, HaveEndsThatDifferAsOursDoNot) {
  for (const RealThing& thing : RealThings()) {
    if (thing.sensor != "VLS-128" || thing.distance_m > 15.0 || thing.type != "pole") continue;
    if (!IsThere(thing)) GTEST_SKIP() << "no captures in " << RAILCAST_SHARED_DATA_DIR;
    SCOPED_TRACE(thing.what);
    const auto& [cut, ours] = CutOutAndPutAgain(thing);
    const auto real_m = EndsBehindTheMiddle_m(cut.real);
    const auto ours_m = EndsBehindTheMiddle_m(ours);
    std::printf("| %s | %.0f, %.0f | %.0f, %.0f |\n", thing.what.c_str(), 1e3 * real_m[0],
                1e3 * real_m[1], 1e3 * ours_m[0], 1e3 * ours_m[1]);
    EXPECT_GT(std::abs(real_m[0] - real_m[1]), 0.015);
    EXPECT_LT(std::abs(ours_m[0] - ours_m[1]), 0.015);
  }
}

// scripts/dev/tell_apart.py has boosted trees and this logistic regression tell them apart.
TEST(RealThings, GiveTheirRowsToOtherClassifiers) {
  const char* file = std::getenv("RAILCAST_WRITE_ROWS");
  if (file == nullptr) GTEST_SKIP() << "set RAILCAST_WRITE_ROWS to the file";
  std::ofstream out(file);
  out << "thing,ours";
  for (const char* feature : kFeatures) out << ',' << feature;
  std::vector<RealThing> things = RealThings();
  for (RealThing& thing : HeldOutThings()) things.push_back(std::move(thing));
  for (const RealThing& thing : things) {
    if (!IsThere(thing)) continue;
    const TwoSamples rows = RowsOfBoth(thing);
    for (std::size_t i = 0; i < rows.features.size(); ++i) {
      out << '\n' << thing.sensor << ' ' << thing.what << ',' << rows.is_second[i];
      for (const double value : rows.features[i]) out << ',' << value;
    }
  }
  EXPECT_TRUE((out << '\n').good());
}

}  // namespace
}  // namespace railcast
