#pragma once

#include "core/scenario/command.h"
#include "core/scenario/describe_weather.h"
#include "core/scenario/describe_world.h"

namespace railcast {

// The key "command" distinguishes commands. "type" is not used, since objects have it as well.
template <class T>
inline constexpr const char* kCommandName = nullptr;
template <>
inline constexpr const char* kCommandName<SetSpeed> = "set_speed";
template <>
inline constexpr const char* kCommandName<Brake> = "brake";
template <>
inline constexpr const char* kCommandName<Stop> = "stop";
template <>
inline constexpr const char* kCommandName<PlaceObject> = "place_object";
template <>
inline constexpr const char* kCommandName<RemoveObject> = "remove_object";
template <>
inline constexpr const char* kCommandName<SetWeather> = "set_weather";
template <>
inline constexpr const char* kCommandName<Step> = "step";
template <>
inline constexpr const char* kCommandName<Reset> = "reset";

// No railway vehicle exceeds the upper limit: magnetic track brakes reach 3 m/s^2. At a rate below
// the lower limit, a change of speed would take hours or days.
[[nodiscard]] inline Limits AccelerationLimits() {
  return Within(1e-3, 10);
}

template <class Archive>
void Describe(Archive& a, SetSpeed& s) {
  a.Required("speed_mps", s.speed_mps, "Speed to be reached and then kept.", Within(0, 200));
  a.Optional("acceleration_mps2", s.acceleration_mps2,
             "Magnitude of the acceleration or deceleration on the way there.",
             AccelerationLimits());
}

template <class Archive>
void Describe(Archive& a, Brake& s) {
  a.Optional("deceleration_mps2", s.deceleration_mps2, "To a standstill.", AccelerationLimits());
}

template <class Archive>
void Describe(Archive&, Stop&) {}

template <class Archive>
void Describe(Archive& a, PlaceObject& s) {
  a.Required("object", s.object, "As in world.objects.");
}

template <class Archive>
void Describe(Archive& a, RemoveObject& s) {
  a.Required("name", s.name, "Name of the object.", NonEmptyString());
}

template <class Archive>
void Describe(Archive& a, SetWeather& s) {
  a.Required("weather", s.weather, "A whole section: what is left out takes its default.");
}

template <class Archive>
void Describe(Archive&, Step&) {}

template <class Archive>
void Describe(Archive&, Reset&) {}

}  // namespace railcast
