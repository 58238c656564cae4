#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "tests/generator/extras/osi/example_view.h"

namespace railcast::osi {
namespace {

using osi3::EnvironmentalConditions;
using osi3::MovingObject;
using Classification = osi3::StationaryObject::Classification;
using Vehicle = osi3::MovingObject::VehicleClassification;

osi3::GroundTruth TruthOf(const std::vector<ObjectOfView>& objects,
                          const WeatherSpec& weather = {}) {
  return ReadView(ExampleLidar(), EmptyFrame(), objects, weather).global_ground_truth();
}

EnvironmentalConditions ConditionsOf(const WeatherSpec& weather) {
  return TruthOf({ExampleObject(7, "ego")}, weather).environmental_conditions();
}

TEST(GroundTruth, HasTheBoxesOfMovingObjects) {
  ObjectOfView object = ExampleObject(9, "person");
  const auto truth = TruthOf({ExampleObject(7, "ego"), object});
  EXPECT_EQ(truth.host_vehicle_id().value(), 7U);
  ASSERT_EQ(truth.moving_object_size(), 2);
  const MovingObject& moving = truth.moving_object(1);
  EXPECT_EQ(moving.id().value(), 9U);
  EXPECT_EQ(moving.source_reference(0).identifier(0), "person9");
  const auto& base = moving.base();
  EXPECT_EQ(base.dimension().length(), 4.0);
  EXPECT_EQ(base.dimension().width(), 2.0);
  EXPECT_EQ(base.dimension().height(), 1.5);
  EXPECT_EQ(VectorOf(base.position()), object.world_from_box.translation());
  EXPECT_TRUE(RotationOf(base.orientation()).isApprox(object.world_from_box.linear(), 1e-14));
  EXPECT_EQ(VectorOf(base.velocity()), Vector3(1.0, 2.0, 3.0));
  EXPECT_FALSE(base.has_acceleration());
  // The standard demands them.
  EXPECT_TRUE(moving.has_pedestrian_attributes());
  EXPECT_TRUE(truth.moving_object(0).has_vehicle_attributes());
}

TEST(GroundTruth, SaysWhereTheAxlesOfItsOwnVehicleAre) {
  ObjectOfView host = ExampleObject(7, "ego");
  host.acceleration_mps2 = Vector3(0.1, 0.2, 0.3);
  host.rear_m = Vector3(-8.0, 0.0, -1.0);
  host.front_m = Vector3(2.0, 0.0, -1.0);
  const auto truth = TruthOf({host});
  const MovingObject& moving = truth.moving_object(0);
  EXPECT_EQ(VectorOf(moving.base().acceleration()), Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(VectorOf(moving.vehicle_attributes().bbcenter_to_rear()), *host.rear_m);
  EXPECT_EQ(VectorOf(moving.vehicle_attributes().bbcenter_to_front()), *host.front_m);
}

TEST(GroundTruth, KnowsWhatMovesByItself) {
  const auto truth =
      TruthOf({ExampleObject(1, "ego"), ExampleObject(2, "wagon"), ExampleObject(3, "train"),
               ExampleObject(4, "person"), ExampleObject(5, "animal")});
  ASSERT_EQ(truth.moving_object_size(), 5);
  for (const int i : {0, 1, 2}) {
    EXPECT_EQ(truth.moving_object(i).type(), MovingObject::TYPE_VEHICLE);
    EXPECT_EQ(truth.moving_object(i).vehicle_classification().type(), Vehicle::TYPE_TRAIN);
  }
  EXPECT_EQ(truth.moving_object(3).type(), MovingObject::TYPE_PEDESTRIAN);
  EXPECT_EQ(truth.moving_object(4).type(), MovingObject::TYPE_ANIMAL);
}

TEST(GroundTruth, KnowsRoadVehicles) {
  const std::vector<std::pair<std::string, Vehicle::Type>> types = {
      {"car", Vehicle::TYPE_CAR},         {"lorry", Vehicle::TYPE_HEAVY_TRUCK},
      {"bus", Vehicle::TYPE_BUS},         {"tractor", Vehicle::TYPE_WORK_MACHINE},
      {"bicycle", Vehicle::TYPE_BICYCLE}, {"motorcycle", Vehicle::TYPE_MOTORCYCLE},
      {"mesh", Vehicle::TYPE_OTHER}};
  for (const auto& [type, expected] : types) {
    const auto truth = TruthOf({ExampleObject(1, "ego"), ExampleObject(2, "road_vehicle", type)});
    EXPECT_EQ(truth.moving_object(1).vehicle_classification().type(), expected) << type;
  }
}

TEST(GroundTruth, HasWhatStandsApart) {
  ObjectOfView rolling = ExampleObject(3, "object");
  rolling.moves = true;
  const auto truth = TruthOf(
      {ExampleObject(1, "ego"), ExampleObject(2, "tree"), rolling, ExampleObject(4, "object")});
  ASSERT_EQ(truth.moving_object_size(), 2);
  EXPECT_EQ(truth.moving_object(1).type(), MovingObject::TYPE_OTHER);
  ASSERT_EQ(truth.stationary_object_size(), 2);
  EXPECT_EQ(truth.stationary_object(0).classification().type(), Classification::TYPE_TREE);
  EXPECT_EQ(truth.stationary_object(0).base().dimension().length(), 4.0);
  EXPECT_EQ(truth.stationary_object(1).classification().type(), Classification::TYPE_OTHER);
}

TEST(GroundTruth, ClassesPrecipitationByItsRate) {
  WeatherSpec weather;
  EXPECT_EQ(ConditionsOf(weather).precipitation(), EnvironmentalConditions::PRECIPITATION_NONE);
  weather.rain_rate_mmph = 0.05;
  weather.snow_rate_mmph = 0.05;
  EXPECT_EQ(ConditionsOf(weather).precipitation(),
            EnvironmentalConditions::PRECIPITATION_VERY_LIGHT);
  weather.rain_rate_mmph = 8.0;
  EXPECT_EQ(ConditionsOf(weather).precipitation(), EnvironmentalConditions::PRECIPITATION_MODERATE);
  weather.rain_rate_mmph = 8.1;
  EXPECT_EQ(ConditionsOf(weather).precipitation(), EnvironmentalConditions::PRECIPITATION_HEAVY);
}

TEST(GroundTruth, ClassesFogByItsVisibility) {
  WeatherSpec weather;
  EXPECT_EQ(ConditionsOf(weather).fog(), EnvironmentalConditions::FOG_EXCELLENT_VISIBILITY);
  weather.visibility_m = 1001.0;
  EXPECT_EQ(ConditionsOf(weather).fog(), EnvironmentalConditions::FOG_MIST);
  weather.visibility_m = 999.0;
  EXPECT_EQ(ConditionsOf(weather).fog(), EnvironmentalConditions::FOG_LIGHT);
  weather.visibility_m.reset();
  // ln 20 / 0.1 m^-1 = 30 m.
  weather.fog_density_per_m = 0.1;
  EXPECT_EQ(ConditionsOf(weather).fog(), EnvironmentalConditions::FOG_DENSE);
}

TEST(GroundTruth, CountsDirectionsFromTheNorth) {
  WeatherSpec weather;
  weather.wind_speed_mps = 7.0;
  weather.wind_direction_deg = 180.0;  // From the west.
  weather.sun = {.illuminance_klx = 80.0, .azimuth_deg = 0.0, .elevation_deg = 30.0};  // East.
  const auto conditions = ConditionsOf(weather);
  EXPECT_NEAR(conditions.wind().origin_direction(), std::numbers::pi / 2.0, 1e-12);
  EXPECT_EQ(conditions.wind().speed(), 7.0);
  EXPECT_NEAR(conditions.sun().azimuth(), 1.5 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(conditions.sun().elevation(), std::numbers::pi / 6.0, 1e-12);
  EXPECT_EQ(conditions.sun().intensity(), 80'000.0);
  EXPECT_FALSE(ConditionsOf({}).has_sun());
}

}  // namespace
}  // namespace railcast::osi
