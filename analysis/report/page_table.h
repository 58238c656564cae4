#pragma once

#include <string>

#include "analysis/report/report.h"

namespace railcast {

/// A table folded away under its title, in a page. On paper, where nobody can scroll, one that is
/// too wide is broken into several that begin alike.
[[nodiscard]] std::string TableHtml(const Table& table);

}  // namespace railcast
