#include "analysis/report/draw.h"

#include <cstdlib>

#include "analysis/report/chart_script.h"
#include "analysis/report/gnuplot.h"
#include "analysis/report/output.h"
#include "analysis/report/svg.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

// gnuplot writes its files piece by piece: they lie here until they are whole.
class DrawingFolder {
 public:
  DrawingFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "railcast-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw FileError(name, errno);
    path_ = name;
  }
  DrawingFolder(const DrawingFolder&) = delete;
  DrawingFolder& operator=(const DrawingFolder&) = delete;
  ~DrawingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

std::map<std::string, std::string> DrawCharts(const Report& report,
                                              const std::filesystem::path& folder) {
  const DrawingFolder drawings;
  std::string script;
  for (const Section& section : report.sections) {
    for (const Chart& chart : section.charts) {
      script += DrawingOf(chart, drawings.path() / (chart.key + ".svg"),
                          drawings.path() / (chart.key + ".png"));
    }
  }
  std::map<std::string, std::string> svgs;
  if (script.empty()) return svgs;
  WriteFileWhole(drawings.path() / "charts.gnuplot", script);
  (void)GnuplotOutput(drawings.path() / "charts.gnuplot", "set encoding utf8");
  MakeFolder(folder);
  for (const Section& section : report.sections) {
    for (const Chart& chart : section.charts) {
      const std::string svg =
          CleanSvg(ReadFileWhole(drawings.path() / (chart.key + ".svg")), chart.key);
      WriteFileWhole(folder / (chart.key + ".svg"), svg);
      WriteFileWhole(folder / (chart.key + ".png"),
                     ReadFileWhole(drawings.path() / (chart.key + ".png")));
      svgs.emplace(chart.key, svg);
    }
  }
  return svgs;
}

}  // namespace railcast
