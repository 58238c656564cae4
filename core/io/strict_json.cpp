#include "core/io/strict_json.h"

#include "core/scenario/json_text.h"

namespace railcast {

void CheckRecordedJson(const std::string& text, const std::string& place) {
  const JsonText parsed = ParseJson(text);
  if (!parsed.json) throw InputError(place + ": is damaged: " + parsed.syntax_error);
  if (parsed.duplicate_keys.empty()) return;
  throw InputError(place + ": is damaged: " + parsed.duplicate_keys.front() + ": duplicate key");
}

}  // namespace railcast
