#pragma once

#include <string>

#include "core/base/error.h"
#include "core/io/strict_json.h"

namespace railcast {

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
  try {
    return read(Json::parse(text));
  } catch (const typename Json::exception& error) {
    throw InputError(place + ": is damaged: " + error.what());
  }
}

}  // namespace railcast
