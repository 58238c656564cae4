#include "generator/extras/insert/intensity_scale.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace railcast {
namespace {

constexpr const char* kClouds = "directory of point clouds";

IntensityScale ScaleOf(const std::string& kind, const std::vector<float>& intensities) {
  RecordingInfo info;
  info.kind = kind;
  RecordedFrame recorded;
  recorded.fields.emplace("intensity");
  recorded.frame.intensity = intensities;
  IntensityScaleFinder finder(info);
  finder.Add(recorded);
  return finder.Found();
}

// 1000 points of which two are of a retroreflector.
std::vector<float> Points(float usual, float retroreflector) {
  std::vector<float> intensities(998, usual);
  intensities.insert(intensities.end(), 2, retroreflector);
  return intensities;
}

TEST(IntensityScale, IsFoundInWhatTheRecordingShows) {
  EXPECT_EQ(ScaleOf(kClouds, Points(0.2F, 3.0F)).per_reflectance, 1.0);
  EXPECT_EQ(ScaleOf(kClouds, Points(20.0F, 255.0F)).per_reflectance, 100.0);
  EXPECT_EQ(ScaleOf(kClouds, Points(120.0F, 255.0F)).per_reflectance, 255.0);
  EXPECT_EQ(ScaleOf(kClouds, Points(900.0F, 40'000.0F)).per_reflectance, 65535.0);
}

TEST(IntensityScale, IsStated) {
  EXPECT_EQ(ScaleOf(kClouds, Points(20.0F, 255.0F)).remark,
            "intensities: taken for hundredths, 100 = white, since the highest recorded is 255");
}

TEST(IntensityScale, OfCapturesIsKnown) {
  EXPECT_EQ(ScaleOf("capture of VLP-16", Points(20.0F, 255.0F)).per_reflectance, 1.0);
}

// Bytes of 0 are what is below half a byte, and so are zeros on other scales.
TEST(IntensityScale, TakesZeroForTheMiddleOfWhatIsRoundedToIt) {
  std::vector<float> bytes = Points(20.0F, 255.0F);
  bytes.insert(bytes.end(), {0.0F, 1.0F, 0.0F, 2.0F});
  EXPECT_EQ(ScaleOf(kClouds, bytes).of_zero, 0.25);
  std::vector<float> hundredths = Points(0.5F, 1.0F);
  hundredths.insert(hundredths.end(), {0.0F, 0.03125F});
  EXPECT_EQ(ScaleOf(kClouds, hundredths).of_zero, 0.25 * 0.03125);
  EXPECT_EQ(ScaleOf(kClouds, {0.0F}).of_zero, 0.0);
}

TEST(IntensityScale, IsOneWithoutIntensities) {
  EXPECT_EQ(ScaleOf(kClouds, {}).per_reflectance, 1.0);
}

}  // namespace
}  // namespace railcast
