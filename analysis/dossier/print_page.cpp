#include "analysis/dossier/dossier_report.h"

#include <string_view>

#include "analysis/report/program_output.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/io/write_file.h"
#include "core/program/command_line.h"

namespace railcast {

extern const char* const kPrintCss;

void PrintPage(const std::filesystem::path& page, const std::filesystem::path& pdf) {
  std::string html = ReadFileWhole(page);
  // weasyprint 57 fails on drawings in the colour of the text.
  constexpr std::string_view kTextColor = "currentColor";
  constexpr std::string_view kInk = "#17202a";
  for (std::size_t at = html.find(kTextColor); at != std::string::npos;
       at = html.find(kTextColor, at)) {
    html.replace(at, kTextColor.size(), kInk);
  }
  const std::size_t head = html.find("</head>");
  Check(head != std::string::npos, "a page has a head");
  html.insert(head, "<style>" + std::string(kPrintCss) + "</style>");
  const ReportScratch scratch;
  const std::filesystem::path file = scratch.path() / "page.html";
  WriteFileWhole(file, html);
  WriteFileWhole(
      pdf, ProgramOutput("weasyprint --quiet " + ShellWord(file.string()) + " -", "weasyprint"));
}

}  // namespace railcast
