#pragma once

#include <filesystem>

namespace railcast {

/// Prints a report's page with weasyprint.
/// @param page report.html as EmitReport() writes it.
/// @throws InputError if weasyprint is not found or fails, or if the file cannot be written.
void PrintPage(const std::filesystem::path& page, const std::filesystem::path& pdf);

}  // namespace railcast
