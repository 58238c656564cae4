#pragma once

#include <string>

namespace railcast {

/// The style sheet of a report's page.
[[nodiscard]] std::string PageStyle();

}  // namespace railcast
