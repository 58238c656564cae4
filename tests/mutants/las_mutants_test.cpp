#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>

#include "core/base/text.h"
#include "tests/core/io/cloud/made_las.h"
#include "tests/mutants/mutants.h"

namespace railcast {
namespace {

/// A variable length record of the coordinate system.
std::string ProjectionRecord(std::uint16_t id, const std::string& content) {
  std::string head(54, '\0');
  head.replace(2, 15, "LASF_Projection");
  PutNumber(head, 18, id);
  PutNumber(head, 20, static_cast<std::uint16_t>(content.size()));
  return head + content;
}

std::string GeoKeys(std::uint16_t key, std::uint16_t value) {
  std::string keys;
  for (const int number : {1, 1, 0, 2, 1024, 0, 1, 1, int{key}, 0, 1, int{value}}) {
    keys += BytesOf(static_cast<std::uint16_t>(number));
  }
  return keys;
}

constexpr std::size_t kNumPoints = 6;

/// Points in the place that the header's bounds state.
std::string LasOf(int minor_version,
                  int format,
                  const std::string& record = LasRecord(34735, GeoKey(3076, 9001))) {
  const MadeLas las{
      .minor_version = minor_version, .format = format, .records = record, .num_records = 1};
  std::string bytes = las.Bytes(kNumPoints);
  const std::array<double, 6> bounds = {5006.0, 5001.0, 299'998.0, 299'988.0, 0.345, 0.345};
  for (std::size_t i = 0; i < bounds.size(); ++i) PutNumber(bytes, 179 + 8 * i, bounds.at(i));
  return bytes;
}

// NOLINTNEXTLINE(readability-function-size): a list of changes
void TryLas(Mutants& mutants, int minor_version, int format) {
  const std::string& good = mutants.good();
  const auto change = [&](const std::string& what, std::size_t place, auto number) {
    mutants.Try(what, NumberText(number) + " at " + NumberText(place),
                With(good, place, BytesOf(number)));
  };
  for (int other = 0; other < 256; ++other) {
    change("format of points changed", 104, static_cast<std::uint8_t>(other));
    change("version changed", 25, static_cast<std::uint8_t>(other));
  }
  for (std::uint16_t size = 0; size < 80; ++size) {
    change("length of points changed", 105, size);
    change("length of the header changed", 94, static_cast<std::uint16_t>(200 + 4 * size));
    change("begin of points changed", 96, std::uint32_t{200} + 3 * size);
  }
  for (const std::uint32_t num : {0U, 1U, 5U, 7U, 12U, 4'000'000'000U}) {
    change("number of points changed", 107, num);
    if (minor_version == 4) change("number of points changed", 247, std::uint64_t{num});
    change("number of records changed", 100, num);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double scale :
         {0.0, 0.01, 0.1, 1.0, 1e-4, 1e-7, -0.001, 1e300, std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::quiet_NaN()}) {
      change("scale changed", 131 + 8 * axis, scale);
    }
    for (const double offset : {0.0, 1.0, 5e6, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
      change("offset changed", 155 + 8 * axis, offset);
    }
  }
  const std::size_t first =
      good.size() - kNumPoints * kLasPointBytes.at(static_cast<std::size_t>(format));
  const std::size_t flags = first + 15;
  for (std::size_t i = 0; i < kNumPoints; ++i) {
    const std::size_t place = flags + i * kLasPointBytes.at(static_cast<std::size_t>(format));
    const auto withheld = static_cast<char>(good[place] | (format < 6 ? 0x80 : 0x04));
    mutants.Try("a point marked as withheld", NumberText(i), With(good, place, {withheld}));
  }
  for (std::size_t num = 1; num < 60; ++num) {
    mutants.Try("bytes behind the points", NumberText(num), good + std::string(num, 'x'));
  }
  const auto with_record = [&](const std::string& what, const std::string& record) {
    mutants.Try("coordinates " + what, "", LasOf(minor_version, format, record));
  };
  with_record("in degrees (GeoTIFF)", ProjectionRecord(34735, GeoKeys(1024, 2)));
  for (const int number : {9002, 9003, 9005, 9036, 9014}) {
    const auto unit = static_cast<std::uint16_t>(number);
    with_record("in another unit in plan (GeoTIFF)", ProjectionRecord(34735, GeoKeys(3076, unit)));
    with_record("in another unit in height (GeoTIFF)",
                ProjectionRecord(34735, GeoKeys(4099, unit)));
  }
  with_record("in a system that states no unit (GeoTIFF)",
              ProjectionRecord(34735, GeoKeys(3072, 2263)));
  for (const char* unit : {"US survey foot\",0.3048006", "foot\",0.3048",
                           "Foot (International)\",0.3048", "ft\",0.3048", "kilometre\",1000",
                           "yard\",0.9144", "Link\",0.201168", "millimetre\",0.001"}) {
    with_record(
        "in another unit (WKT)",
        ProjectionRecord(
            2112, std::string("PROJCS[\"x\",GEOGCS[\"y\",UNIT[\"degree\",0.0174532925]],UNIT[\"") +
                      unit + "]]"));
    with_record(
        "in another unit (WKT 2)",
        ProjectionRecord(
            2112,
            std::string(
                "PROJCRS[\"x\",BASEGEOGCRS[\"y\"],CS[Cartesian,2],AXIS[\"e\",east],LENGTHUNIT[\"") +
                unit + "]]"));
  }
  with_record("in degrees (WKT)",
              ProjectionRecord(2112, "GEOGCS[\"y\",UNIT[\"degree\",0.0174532925]]"));
  for (const char* system : {"GEOGCRS", "GEODCRS", "GEODETICCRS", "GEOGRAPHICCRS"}) {
    const std::string begin = std::string(system) + "[\"y\",CS[";
    with_record(
        "in degrees (WKT 2)",
        ProjectionRecord(2112, begin + "ellipsoidal,2],ANGLEUNIT[\"degree\",0.0174532925]]"));
    with_record("from the centre of the earth (WKT)",
                ProjectionRecord(2112, begin + "Cartesian,3],LENGTHUNIT[\"metre\",1]]"));
  }
  with_record("from the centre of the earth (WKT)",
              ProjectionRecord(2112, "GEOCCS[\"y\",UNIT[\"metre\",1]]"));
  with_record("from the centre of the earth (GeoTIFF)", ProjectionRecord(34735, GeoKeys(1024, 3)));
  with_record(
      "in metres (WKT)",
      ProjectionRecord(
          2112, "PROJCS[\"x\",GEOGCS[\"y\",UNIT[\"degree\",0.0174532925]],UNIT[\"metre\",1]]"));
  with_record("in metres (WKT 2)",
              ProjectionRecord(2112,
                               "PROJECTEDCRS[\"x\",BASEGEODCRS[\"y\"],CS[Cartesian,2],"
                               "LENGTHUNIT[\"metre\",1.0]]"));
  TryCuts(mutants, 3);
}

TEST(LasMutants, AreNeverReadWrongWithoutAWord) {
  Mutants older("LAS 1.2, format 1", "a.las", LasOf(2, 1), ReadRecordingWhole);
  TryLas(older, 2, 1);
  Mutants newer("LAS 1.4, format 6", "a.las", LasOf(4, 6), ReadRecordingWhole);
  TryLas(newer, 4, 6);
  CheckSection("LAS", {&older, &newer});
}

}  // namespace
}  // namespace railcast
