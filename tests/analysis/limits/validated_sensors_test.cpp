#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "core/base/input_file.h"

namespace railcast {

extern const char* const kValidatedSensors;

namespace {

struct HeldOutRow {
  std::string sensor;
  std::vector<std::string> cells;
};

// The rows "odd" of the table of presets in docs/results/validation.md, which RealPreset.* holds.
std::vector<HeldOutRow> RowsOfDocs() {
  const std::string text = ReadFileWhole(RAILCAST_SOURCE_DIR "/docs/results/validation.md");
  std::istringstream lines(text.substr(text.find("| | sectors | points |")));
  std::vector<HeldOutRow> rows;
  std::string sensor;
  std::string line;
  while (std::getline(lines, line) && line.starts_with('|')) {
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, '|');) {
      const auto begin = cell.find_first_not_of(' ');
      cells.push_back(begin == std::string::npos
                          ? std::string()
                          : cell.substr(begin, cell.find_last_not_of(' ') - begin + 1));
    }
    if (!cells.at(1).empty() && !cells.at(1).starts_with("-")) sensor = cells.at(1);
    if (cells.at(2) == "odd") rows.push_back({sensor, {cells.begin() + 3, cells.end()}});
  }
  return rows;
}

double LeadingNumber(const std::string& text) {
  std::smatch found;
  return std::regex_search(text, found, std::regex("^[0-9.]+")) ? std::stod(found[0])
                                                                : std::nan("");
}

void ExpectFigure(const nlohmann::json& figure, double expected, const std::string& what) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(figure.is_null()) << what;
  } else {
    EXPECT_NEAR(figure.get<double>(), expected, 1e-9) << what;
  }
}

TEST(ValidatedSensors, HaveTheFiguresOfTheDocs) {
  const auto rows = RowsOfDocs();
  const auto data = nlohmann::json::parse(kValidatedSensors);
  ASSERT_EQ(rows.size(), 6U);
  ASSERT_EQ(data.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& [sensor, cells] = rows[i];
    EXPECT_EQ(data[i].at("sensor"), sensor);
    ExpectFigure(data[i].at("points_error"), LeadingNumber(cells[0]) / 100.0, sensor + " points");
    ExpectFigure(data[i].at("intensity_error"), LeadingNumber(cells[1]) / 100.0,
                 sensor + " intensity");
    ExpectFigure(data[i].at("noise_ratio"), LeadingNumber(cells[3]), sensor + " noise");
    const std::string arrow = "→ ";
    ExpectFigure(data[i].at("holes_recorded"), LeadingNumber(cells[4]) / 100.0, sensor + " holes");
    ExpectFigure(data[i].at("holes_simulated"),
                 LeadingNumber(cells[4].substr(cells[4].find(arrow) + arrow.size())) / 100.0,
                 sensor + " simulated holes");
  }
}

}  // namespace
}  // namespace railcast
