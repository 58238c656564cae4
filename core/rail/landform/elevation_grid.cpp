#include "core/rail/landform/landform.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/input_file.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"

namespace railcast {
namespace {

constexpr double kDefaultMissing = -9999.0;
/// Beyond this, no height is one of the Earth's.
constexpr double kMostHeight_m = 1e5;

[[noreturn]] void FailReading(const std::string& place,
                              const std::string& rule,
                              const std::string& value = "") {
  throw InputError({Fault{place, rule, value}});
}

bool IsSpace(char letter) {
  return letter == ' ' || letter == '\t' || letter == '\n' || letter == '\r';
}

/// The words of a text, with the lines they stand in.
class GridWords {
 public:
  GridWords(std::string_view text, std::string shown) : text_(text), shown_(std::move(shown)) {}

  /// The next word; empty at the end.
  std::string_view Next() {
    while (at_ < text_.size() && IsSpace(text_[at_])) ++at_;
    word_ = at_;
    while (at_ < text_.size() && !IsSpace(text_[at_])) ++at_;
    return text_.substr(word_, at_ - word_);
  }
  /// Goes back to before the last word.
  void Return() { at_ = word_; }
  /// "dem.asc:7", of the last word.
  [[nodiscard]] std::string Place() const {
    const auto line =
        1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(word_), '\n');
    return shown_ + ":" + std::to_string(line);
  }
  [[nodiscard]] const std::string& shown() const { return shown_; }
  /// The most words that there can be from here on.
  [[nodiscard]] std::size_t most_words() const { return (text_.size() - at_ + 1) / 2; }

  /// Reads the next word as a number.
  double NextNumber() {
    const std::string_view word = Next();
    const auto value = ParseTextNumber<double>(word);
    if (!value || !std::isfinite(*value)) FailReading(Place(), "not a number", Quoted(word));
    return *value;
  }

 private:
  std::string_view text_;
  std::string shown_;
  std::size_t at_ = 0;
  std::size_t word_ = 0;
};

struct HeaderValue {
  double value{};
  std::string place;
};
using Header = std::map<std::string, HeaderValue, std::less<>>;

constexpr std::array kHeaderKeys = {"ncols",     "nrows",       "xllcorner", "xllcenter",
                                    "yllcorner", "yllcenter",   "cellsize",  "dx",
                                    "dy",        "nodata_value"};

Header ReadHeader(GridWords& words) {
  Header header;
  for (std::string_view word = words.Next(); !word.empty(); word = words.Next()) {
    if (std::isalpha(static_cast<unsigned char>(word.front())) == 0 && !header.empty()) break;
    std::string key(word);
    std::ranges::transform(key, key.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (std::ranges::find(kHeaderKeys, key) == kHeaderKeys.end()) {
      FailReading(words.Place(),
                  "must be a line of an ESRI ASCII grid's header, such as ncols or cellsize",
                  Quoted(word));
    }
    const std::string place = words.Place();
    if (header.contains(key)) FailReading(place, key + ": is given twice");
    header[key] = {words.NextNumber(), place + ": " + key};
  }
  words.Return();
  return header;
}

const HeaderValue& OneOfKeys(const Header& header,
                             const std::string& shown,
                             const char* key,
                             const char* other) {
  for (const char* name : {key, other}) {
    if (const auto found = header.find(name); found != header.end()) return found->second;
  }
  const std::string names = key == std::string(other) ? key : std::string(key) + " or " + other;
  FailReading(shown, "must have " + names + " in its header");
}

std::size_t CountOf(const HeaderValue& entry) {
  constexpr double kMost = 1e6;
  if (entry.value != std::floor(entry.value) || entry.value < 2.0 || entry.value > kMost) {
    FailReading(entry.place, "must be a whole number from 2 to 1000000", NumberText(entry.value));
  }
  return static_cast<std::size_t>(entry.value);
}

double SizeOfCell(const HeaderValue& entry) {
  if (!(entry.value > 0.0)) FailReading(entry.place, "must be > 0", NumberText(entry.value));
  return entry.value;
}

/// Weights of four neighbouring heights at `t` between the second and the third: Keys' cubic with
/// a = -1/2.
std::array<double, 4> CubicWeights(double t) {
  return {t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (-2.5 + 1.5 * t),
          t * (0.5 + t * (2.0 - 1.5 * t)), t * t * (-0.5 + 0.5 * t)};
}

}  // namespace

ElevationGrid::ElevationGrid(const std::filesystem::path& file)
    : ElevationGrid(
          WithinMemory([&] { return ReadingText(file); }, [&] { return ReadTextWhole(file); }),
          ShownPath(file.filename())) {}

ElevationGrid::ElevationGrid(std::string_view text, const std::string& shown) {
  GridWords words(text, shown);
  const Header header = ReadHeader(words);
  if (header.empty()) FailReading(shown, "must be an ESRI ASCII grid", "an empty file");
  const auto entry = [&](const char* key, const char* other) -> const HeaderValue& {
    return OneOfKeys(header, shown, key, other);
  };
  num_columns_ = CountOf(entry("ncols", "ncols"));
  num_rows_ = CountOf(entry("nrows", "nrows"));
  const HeaderValue& dx = entry("cellsize", "dx");
  dx_m_ = SizeOfCell(dx);
  dy_m_ = SizeOfCell(entry("cellsize", "dy"));
  west_m_ =
      entry("xllcorner", "xllcenter").value + (header.contains("xllcorner") ? 0.5 * dx_m_ : 0.0);
  south_m_ =
      entry("yllcorner", "yllcenter").value + (header.contains("yllcorner") ? 0.5 * dy_m_ : 0.0);
  // No survey has cells of a centimetre, and no local one of 10 cm covers a line.
  const double least_m = std::min(dx_m_, dy_m_);
  const bool is_on_globe =
      std::max(std::abs(west_m_), std::abs(west_m_ + static_cast<double>(num_columns_) * dx_m_)) <=
          180.0 &&
      std::max(std::abs(south_m_), std::abs(south_m_ + static_cast<double>(num_rows_) * dy_m_)) <=
          90.0;
  if (least_m < 0.01 || (least_m < 0.1 && is_on_globe)) {
    FailReading(dx.place,
                "must be in metres; cells as small as this are those of a grid in degrees, which "
                "must be projected first",
                NumberText(least_m));
  }
  const double missing =
      header.contains("nodata_value") ? header.at("nodata_value").value : kDefaultMissing;

  const std::size_t num_heights = num_columns_ * num_rows_;
  const std::string rule = "must have " + std::to_string(num_heights) + " heights, " +
                           std::to_string(num_columns_) + " in each of " +
                           std::to_string(num_rows_) + " rows";
  // A short file must not make much memory be taken for what it announces.
  if (words.most_words() >= num_heights) heights_m_.resize(num_heights);
  has_data_.resize(heights_m_.size());
  for (std::size_t i = 0; i < num_heights; ++i) {
    if (words.Next().empty()) FailReading(shown, rule, std::to_string(i));
    words.Return();
    const double height_m = words.NextNumber();
    if (heights_m_.empty()) continue;
    const std::size_t row = num_rows_ - 1 - i / num_columns_;
    const std::size_t place = row * num_columns_ + i % num_columns_;
    heights_m_[place] = height_m;
    has_data_[place] = height_m != missing;
    if (has_data_[place] && std::abs(height_m) > kMostHeight_m) {
      FailReading(words.Place(), "must be a height from -100000 to 100000 m", NumberText(height_m));
    }
  }
  if (!words.Next().empty()) FailReading(shown, rule, "more");
  FillMissing();
  if (std::ranges::find(has_data_, true) == has_data_.end())
    FailReading(shown, "must have a height that is not missing", "none");
}

void ElevationGrid::FillMissing() {
  // First the cells next to those with data, which interpolation reads beside covered places:
  // straight on from two cells in line.
  struct Cell {
    std::ptrdiff_t column;
    std::ptrdiff_t row;
  };
  const auto num_columns = static_cast<std::ptrdiff_t>(num_columns_);
  const auto num_rows = static_cast<std::ptrdiff_t>(num_rows_);
  const auto index = [&](const Cell& cell) {
    return static_cast<std::size_t>(cell.row * num_columns + cell.column);
  };
  const auto is_inside = [&](const Cell& cell) {
    return cell.column >= 0 && cell.row >= 0 && cell.column < num_columns && cell.row < num_rows;
  };
  const auto for_neighbours = [&](const Cell& cell, const auto& visit) {
    for (std::ptrdiff_t i = -1; i <= 1; ++i) {
      for (std::ptrdiff_t j = -1; j <= 1; ++j) {
        const Cell next{cell.column + i, cell.row + j};
        if ((i != 0 || j != 0) && is_inside(next)) visit(next, Cell{next.column + i, next.row + j});
      }
    }
  };
  std::vector<bool> is_known = has_data_;
  std::vector<Cell> front;
  for (std::ptrdiff_t row = 0; row < num_rows; ++row) {
    for (std::ptrdiff_t column = 0; column < num_columns; ++column) {
      const Cell cell{column, row};
      if (has_data_[index(cell)]) continue;
      double sum_m = 0.0;
      int count = 0;
      for_neighbours(cell, [&](const Cell& next, const Cell& after) {
        if (!has_data_[index(next)]) return;
        const double next_m = heights_m_[index(next)];
        const bool has_after = is_inside(after) && has_data_[index(after)];
        sum_m += has_after ? 2.0 * next_m - heights_m_[index(after)] : next_m;
        ++count;
      });
      if (count == 0) continue;
      heights_m_[index(cell)] = sum_m / count;
      is_known[index(cell)] = true;
      front.push_back(cell);
    }
  }
  // Then all others, from ring to ring.
  while (!front.empty()) {
    std::vector<Cell> next_front;
    for (const Cell& cell : front) {
      for_neighbours(cell, [&](const Cell& next, const Cell&) {
        if (is_known[index(next)]) return;
        is_known[index(next)] = true;
        heights_m_[index(next)] = heights_m_[index(cell)];
        next_front.push_back(next);
      });
    }
    front = std::move(next_front);
  }
}

ElevationGrid::Place ElevationGrid::PlaceOf(double x_m, double y_m) const {
  const auto split = [](double at, std::size_t count, std::ptrdiff_t& cell, double& within) {
    const double inside = std::clamp(at, -0.5, static_cast<double>(count) - 0.5);
    const double first = std::clamp(std::floor(inside), 0.0, static_cast<double>(count - 2));
    cell = static_cast<std::ptrdiff_t>(first);
    within = inside - first;
  };
  Place place;
  split((x_m - west_m_) / dx_m_, num_columns_, place.column, place.along);
  split((y_m - south_m_) / dy_m_, num_rows_, place.row, place.across);
  return place;
}

double ElevationGrid::At(std::ptrdiff_t column, std::ptrdiff_t row) const {
  const auto last_column = static_cast<std::ptrdiff_t>(num_columns_) - 1;
  const auto last_row = static_cast<std::ptrdiff_t>(num_rows_) - 1;
  if (column < 0) return 2.0 * At(0, row) - At(1, row);
  if (column > last_column) return 2.0 * At(last_column, row) - At(last_column - 1, row);
  if (row < 0) return 2.0 * At(column, 0) - At(column, 1);
  if (row > last_row) return 2.0 * At(column, last_row) - At(column, last_row - 1);
  return heights_m_[static_cast<std::size_t>(row) * num_columns_ +
                    static_cast<std::size_t>(column)];
}

double ElevationGrid::Height_m(double x_m, double y_m) const {
  const Place place = PlaceOf(x_m, y_m);
  const std::array<double, 4> along = CubicWeights(place.along);
  const std::array<double, 4> across = CubicWeights(place.across);
  double height_m = 0.0;
  for (std::ptrdiff_t j = 0; j < 4; ++j) {
    double row_m = 0.0;
    for (std::ptrdiff_t i = 0; i < 4; ++i) {
      row_m += along[static_cast<std::size_t>(i)] * At(place.column - 1 + i, place.row - 1 + j);
    }
    height_m += across[static_cast<std::size_t>(j)] * row_m;
  }
  return height_m;
}

bool ElevationGrid::Covers(double x_m, double y_m) const {
  const double column = (x_m - west_m_) / dx_m_;
  const double row = (y_m - south_m_) / dy_m_;
  if (!(column >= -0.5 && column <= static_cast<double>(num_columns_) - 0.5)) return false;
  if (!(row >= -0.5 && row <= static_cast<double>(num_rows_) - 0.5)) return false;
  const Place place = PlaceOf(x_m, y_m);
  const auto first =
      static_cast<std::size_t>(place.row) * num_columns_ + static_cast<std::size_t>(place.column);
  return has_data_[first] && has_data_[first + 1] && has_data_[first + num_columns_] &&
         has_data_[first + num_columns_ + 1];
}

double ElevationGrid::cell_m() const {
  return std::min(dx_m_, dy_m_);
}

}  // namespace railcast
