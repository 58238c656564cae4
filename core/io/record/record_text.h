#pragma once

#include <string>
#include <string_view>

#include "core/io/content_hash.h"
#include "core/scenario/json_text.h"
#include "core/scenario/value_type.h"

namespace railcast {

// What railcast writes about its own results, such as a line of frames.jsonl or a manifest, is a
// record: a struct with one description (archive.h), by which it is written (here), read
// (read_record.h) and documented. Keys stand in the order of the description. An optional key is
// left out where its value is absent, false or empty; a required one is null where an optional
// value is absent.

/// Appends a number as the JSON library writes it: the shortest digits that give the same double
/// back, and null instead of what is not finite.
void AppendJsonNumber(double number, std::string& text);

/// Appends a record as one line of JSON. The text is put together directly: of thousands of
/// objects, a tree of JSON values costs several times as much as tracing their frame.
void AppendRecord(const ValueRef& record, std::string& text);

/// The record as one line of JSON, without a line end.
template <class T>
[[nodiscard]] std::string RecordText(const T& record) {
  std::string text;
  // Writing does not change the values that an archive visits.
  AppendRecord(RefTo(const_cast<T&>(record)), text);
  return text;
}

/// The record as a file of its own: indented JSON with a line end.
template <class T>
[[nodiscard]] std::string RecordFile(const T& record) {
  return Json::parse(RecordText(record)).dump(2) + "\n";
}

/// The record as a line that ends with a hash of itself (WithLineHash()), and its line end.
template <class T>
[[nodiscard]] std::string HashedRecordLine(const T& record) {
  return WithLineHash(RecordText(record)) + "\n";
}

}  // namespace railcast
