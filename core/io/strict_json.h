#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/scenario/json_text.h"

namespace railcast {

/// Converts JSON to a T as the library does it.
template <typename T, typename = void>
struct StrictSerializer : nlohmann::adl_serializer<T> {};

/// Converts JSON to an integer type, but only from a whole number that T can hold: the library
/// would cut off fractions and high bits, and its result for 1e30 is undefined.
template <std::integral T>
requires(!std::same_as<T, bool>) struct StrictSerializer<T, void> : nlohmann::adl_serializer<T> {
  template <typename Json>
  static void from_json(const Json& json, T& value) {
    const bool fits = json.is_number_unsigned()
                          ? std::in_range<T>(json.template get_ref<const std::uint64_t&>())
                          : json.is_number_integer() &&
                                std::in_range<T>(json.template get_ref<const std::int64_t&>());
    if (!fits) {
      constexpr int kWrongType = 302;
      // Other values are not quoted, since they may be nested too deep to be written.
      const std::string got = json.is_number() ? json.dump() : json.type_name();
      throw Json::type_error::create(
          kWrongType,
          "a value must be a whole number from " + std::to_string(std::numeric_limits<T>::min()) +
              " to " + std::to_string(std::numeric_limits<T>::max()) + " (got " + got + ")",
          &json);
    }
    nlohmann::adl_serializer<T>::from_json(json, value);
  }
};

/// The library's JSON with StrictSerializer and with objects that are `Map`s.
template <template <typename, typename, typename...> class Map>
using StrictJsonIn = nlohmann::basic_json<Map,
                                          std::vector,
                                          std::string,
                                          bool,
                                          std::int64_t,
                                          std::uint64_t,
                                          double,
                                          std::allocator,
                                          StrictSerializer>;

/// JSON that converts a number only to a type that can hold it, and otherwise throws
/// Json::exception.
using StrictJson = StrictJsonIn<std::map>;
/// As above, with an object's members in the order of the text.
using StrictOrderedJson = StrictJsonIn<nlohmann::ordered_map>;

/// Checks that a text is JSON as ParseJson() accepts it, without duplicate keys.
/// @param place Names the file in errors: "out/run.json".
/// @throws InputError "place: is damaged: ..." if it is not.
void CheckRecordedJson(const std::string& text, const std::string& place);

/// Parses JSON that railcast wrote and returns what `read` makes of it.
/// @tparam Json StrictJson or StrictOrderedJson.
/// @throws InputError "place: is damaged: ..." if the text is not JSON, or does not have what
///   `read` asks for.
template <typename Json, typename Read>
auto ReadRecordedJson(const std::string& text, const std::string& place, const Read& read)
    -> decltype(read(Json{})) {
  // Checked first because the library's own syntax errors quote the text raw and without bound.
  CheckRecordedJson(text, place);
  return ReadJson(place, [&] { return read(Json::parse(text)); });
}

}  // namespace railcast
