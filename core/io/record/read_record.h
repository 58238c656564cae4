#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/io/content_hash.h"
#include "core/scenario/json_text.h"
#include "core/scenario/value_type.h"

namespace railcast {

/// Parses JSON strictly (ParseJson()), without duplicate keys.
/// @throws InputError "place: is damaged: ...".
[[nodiscard]] Json ReadRecordedJson(const std::string& text, const std::string& place);

/// Fills a record (record_text.h) from its JSON. Keys that the description does not have are
/// faults.
/// @param place Names the file or line in errors: "out/run.json", "out/frames.jsonl:3".
/// @throws InputError "place: /pointer: rule (got value)" for the first fault.
void ReadRecordInto(const std::string& text, const std::string& place, const ValueRef& record);

/// The record that `text` is the JSON of.
///
///     const auto run = ReadRecord<RunRecord>(ReadFileWhole(file), ShownPath(file));
///
/// @throws InputError as ReadRecordInto().
template <class T>
[[nodiscard]] T ReadRecord(const std::string& text, const std::string& place) {
  T record;
  ReadRecordInto(text, place, RefTo(record));
  return record;
}

/// As ReadRecord(), of a line that may end with its own hash, which is not checked.
template <class T>
[[nodiscard]] T ReadRecordLine(std::string_view line, const std::string& place) {
  return ReadRecord<T>(WithoutLineHash(line), place);
}

/// What a line says that is as it was written; nothing if it is not, or is empty.
/// @param line Ends with its own hash and may have a line end.
/// @param read Reads a line without its end; throws InputError if it is not such a line.
template <class Read>
[[nodiscard]] auto ReadWholeLine(std::string_view line, const Read& read)
    -> std::optional<decltype(read(line))> {
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (!LineHashFault(line).empty()) return std::nullopt;
  try {
    return read(line);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace railcast
