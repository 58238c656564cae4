#include "railcast/io/cloud_files.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

constexpr const char* kAll =
    "x,y,z,intensity,power_ratio,range_m,time_ns,ring,column,return_index,return_count,label,"
    "instance,outcome,true_range_m,incidence_rad,material,footprint_share,mixed_share";

TEST(FieldSelection, IsEverythingByDefault) {
  EXPECT_EQ(FieldSelection().Text(), kAll);
  EXPECT_EQ(FieldSelection("all"), FieldSelection());
}

TEST(FieldSelection, KeepsTheTablesOrder) {
  EXPECT_EQ(FieldSelection("label,z,x,y").Text(), "x,y,z,label");
}

TEST(FieldSelection, NamesTheNearestFieldForEveryMisspeltOne) {
  EXPECT_EQ(MessageOf([] { FieldSelection("x,lable,range"); }),
            "--fields: unknown field, the nearest is \"label\" (got \"lable\")\n"
            "--fields: unknown field, the nearest is \"range_m\" (got \"range\")");
}

TEST(FieldSelection, NamesAllFieldsForWhatIsNearToNone) {
  const std::string rule =
      "--fields: unknown field, must be \"x\", \"y\", \"z\", \"intensity\", \"power_ratio\", "
      "\"range_m\", \"time_ns\", \"ring\", \"column\", \"return_index\", \"return_count\", "
      "\"label\", \"instance\", \"outcome\", \"true_range_m\", \"incidence_rad\", \"material\", "
      "\"footprint_share\" or \"mixed_share\" (got ";
  EXPECT_EQ(MessageOf([] { FieldSelection("foo"); }), rule + "\"foo\")");
  EXPECT_EQ(MessageOf([] { FieldSelection("x,,y"); }), rule + "\"\")");
}

TEST(FieldSelection, HasVelocitiesOfSensorsThatMeasureThem) {
  EXPECT_EQ(FieldSelection("all", true).Text(),
            std::string(kAll) + ",radial_velocity_mps,true_radial_velocity_mps");
  EXPECT_EQ(FieldSelection("radial_velocity_mps,x", true).Text(), "x,radial_velocity_mps");
  EXPECT_EQ(MessageOf([] { FieldSelection("x,radial_velocity_mps"); }),
            "--fields: must be a field of a sensor without lidar.velocity (got "
            "\"radial_velocity_mps\")");
}

TEST(FieldSelection, RefusesAFieldTwice) {
  EXPECT_EQ(MessageOf([] { FieldSelection("x,y,x"); }), "--fields: field \"x\" comes twice");
}

}  // namespace
}  // namespace railcast
