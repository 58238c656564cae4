#pragma once

#include <concepts>
#include <string>
#include <utility>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

// The words of a room's reports stand in a file beside its sources, words.json, which CMake
// compiles in: titles, notes, captions, the columns of tables, and the axes and series of charts,
// by their keys. What is measured fills them. Texts are Mustache templates: {{name}} is the place
// of a value, and what stands between {{#name}} and {{/name}} is left out where the value is empty
// or false, between {{^name}} and {{/name}} where it is not.

/// A value for the places of one name in words.
struct WordValue {
  WordValue(std::string name, std::string text) : name(std::move(name)), text(std::move(text)) {}
  /// Whether a part is shown; a template, so that no text is taken for true.
  template <std::same_as<bool> Bool>
  WordValue(std::string name, Bool is_shown) : name(std::move(name)), text(is_shown ? "1" : "") {}

  std::string name;
  std::string text;
};
using WordValues = std::vector<WordValue>;

// @param words The constant of the file, such as kStatsWords.
// @pre The file has such an entry.

/// Sentences that stand in several places.
[[nodiscard]] std::string SentencesOf(const char* words,
                                      const std::string& key,
                                      const WordValues& values = {});

/// A section with its title and paragraphs. Of a paragraph each line becomes one; empty ones are
/// left out.
[[nodiscard]] Section SectionOf(const char* words,
                                const std::string& key,
                                const WordValues& values = {});

/// A table with its title, note and columns.
[[nodiscard]] Table TableOf(const char* words,
                            const std::string& key,
                            const WordValues& values = {});

/// A chart with its title, caption and axes, but no series.
[[nodiscard]] Chart ChartOf(const char* words,
                            const std::string& key,
                            const WordValues& values = {});

/// A chart with its series, each of two columns of a table. The x axis of bars has the texts of
/// their first column. With "by", there is one series for each text of that column.
[[nodiscard]] Chart ChartOfTable(const char* words,
                                 const std::string& key,
                                 const Table& table,
                                 const WordValues& values = {});

}  // namespace railcast
