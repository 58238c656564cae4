#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// Layout of a table's column in the page.
struct PageColumn {
  bool is_number = false;
  /// Estimates take three cells, so that figures, intervals and counts are aligned.
  bool has_estimates = false;
};

[[nodiscard]] std::vector<PageColumn> PageColumns(const Table& table);

/// Whether a text has a word, such as a path, that is broken where its column is narrow.
[[nodiscard]] bool HasLongWord(const std::string& text);

/// The columns of a table that fit beside each other: one block if all do, else several that begin
/// with the first column. A table longer than a page of paper is one block, which is scrolled.
[[nodiscard]] std::vector<std::vector<std::size_t>> TableBlocks(const Table& table);

/// Keys of the tables that are printed, so that the report has about ten pages of A4 at most: open
/// ones before folded ones, in their order, as long as there is room. A table that would take more
/// than a page is left to its file.
[[nodiscard]] std::set<std::string> TablesOnPaper(const Report& report);

}  // namespace railcast
