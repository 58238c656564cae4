#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"

namespace railcast {
namespace {

constexpr std::size_t kBytesOfLabel = sizeof(std::uint32_t);

/// The numbers of a point in a .bin file.
struct BinColumns {
  std::vector<std::string> names;
  NumberType type = NumberType::kFloat;

  [[nodiscard]] std::size_t num_bytes() const { return names.size() * SizeOf(type); }
};

/// What `--kitti-columns` names; nothing if it names none.
std::optional<BinColumns> ColumnsNamed(std::string_view choice) {
  constexpr std::size_t kLeast = 3;
  constexpr std::size_t kMost = 16;
  if (choice == "nuscenes") return BinColumns{{"x", "y", "z", "intensity", "ring"}};
  if (choice == "waymo") return BinColumns{{"x", "y", "z", "intensity", "elongation", "timestamp"}};
  if (choice == "float64") return BinColumns{{"x", "y", "z", "intensity"}, NumberType::kDouble};
  const auto num = ParseNumber<std::size_t>(choice);
  if (!num || *num < kLeast || *num > kMost) return std::nullopt;
  BinColumns columns{{"x", "y", "z", "intensity"}};
  columns.names.resize(std::min(*num, columns.names.size()));
  while (columns.names.size() < *num) {
    columns.names.push_back("number_" + NumberText(columns.names.size() + 1));
  }
  return columns;
}

/// Numbers from the middle of a file, by which layouts are judged: clouds may begin with firings
/// into the sky. They begin with a point of any number of columns up to 8, or of 12 or 16.
template <typename Number>
std::vector<Number> SomeNumbers(std::string_view bytes) {
  constexpr std::size_t kMost = 60'000;
  constexpr std::size_t kCommonMultiple = 1680;
  const std::size_t num = bytes.size() / sizeof(Number);
  const std::size_t first =
      num <= kMost ? 0 : (num - kMost) / 2 / kCommonMultiple * kCommonMultiple;
  std::vector<Number> numbers(std::min(kMost, num));
  if (!numbers.empty()) {
    std::memcpy(numbers.data(), bytes.data() + first * sizeof(Number),
                numbers.size() * sizeof(Number));
  }
  return numbers;
}

/// How much numbers differ that are a number of places apart: 0 to 1, least where these are those
/// of one column in points that follow each other.
double DifferenceAt(const std::vector<float>& numbers, std::size_t places) {
  double sum = 0.0;
  for (std::size_t i = places; i < numbers.size(); ++i) {
    const double a = numbers[i];
    const double b = numbers[i - places];
    const double size = std::abs(a) + std::abs(b);
    const double difference = std::abs(a - b) / size;
    sum += size == 0.0 ? 0.0 : std::isfinite(difference) ? difference : 1.0;
  }
  return sum / static_cast<double>(numbers.size() - places);
}

/// Whether the first three of so many numbers a point can be coordinates: 99 % are metres from 0
/// or, as in a national grid, from their median, and none is an index 0..n or, of x and y, always
/// 0. Points that are not finite, or 0, are none.
template <typename Number>
bool CanBePositions(const std::vector<Number>& numbers, std::size_t num_columns) {
  constexpr double kMostIndex = 255.0;
  constexpr double kMostWrong = 0.01;
  constexpr double kEarth_m = 1e8;
  std::array<std::vector<double>, 3> axes;
  for (std::size_t first = 0; first + num_columns <= numbers.size(); first += num_columns) {
    const auto point = std::span(numbers).subspan(first, 3);
    const bool is_none =
        std::ranges::all_of(point, [](Number value) { return value == Number{0}; }) ||
        !std::ranges::all_of(point, [](Number value) { return std::isfinite(value); });
    for (std::size_t axis = 0; axis < 3 && !is_none; ++axis) {
      axes.at(axis).push_back(static_cast<double>(point[axis]));
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double>& values = axes.at(axis);
    if (values.empty()) return true;
    const bool is_index = std::ranges::all_of(values, [](double value) {
      return value >= 0.0 && value <= kMostIndex && value == std::floor(value);
    });
    if (is_index && (axis < 2 || std::ranges::max(values) > 0.0)) return false;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    const double far = std::abs(*middle);
    const double origin = far > kFarPosition_m && far < kEarth_m ? *middle : 0.0;
    const auto num_wrong = std::ranges::count_if(
        values, [&](double value) { return !IsLikelyPosition(value - origin); });
    if (static_cast<double>(num_wrong) > kMostWrong * static_cast<double>(values.size())) {
      return false;
    }
  }
  return true;
}

/// Whether 99 % of the last of four numbers a point are not below 0.
bool CanBeIntensities(const std::vector<float>& numbers) {
  constexpr std::size_t kMostWrong = 100;
  std::size_t num_below = 0;
  for (std::size_t i = 3; i < numbers.size(); i += 4) num_below += numbers[i] < 0.0F ? 1 : 0;
  return num_below * kMostWrong <= numbers.size() / 4;
}

/// Whether a column is one of rings: whole numbers from 0 on.
bool IsRing(const std::vector<float>& numbers, std::size_t column, std::size_t num_columns) {
  for (std::size_t i = column; i < numbers.size(); i += num_columns) {
    if (!(numbers[i] >= 0.0F && numbers[i] == std::floor(numbers[i]))) return false;
  }
  return true;
}

/// Whether every n-th point of four numbers is a unit vector or none at all while others are far
/// away: it is a normal, and a point has 4 n numbers.
bool HasNormals(const std::vector<float>& numbers, std::size_t num_columns) {
  constexpr float kFar_m = 2.0F;
  constexpr double kRounding = 1e-3;
  std::size_t num_far = 0;
  for (std::size_t first = 0; first + num_columns <= numbers.size(); first += num_columns) {
    num_far += std::abs(numbers[first]) > kFar_m || std::abs(numbers[first + 1]) > kFar_m ? 1 : 0;
  }
  if (2 * num_far * num_columns < numbers.size()) return false;
  for (std::size_t begin = 4; begin < num_columns; begin += 4) {
    std::size_t num_units = 0, num_others = 0;
    for (std::size_t i = begin; i + 2 < numbers.size(); i += num_columns) {
      const double length = std::hypot(numbers[i], numbers[i + 1], numbers[i + 2]);
      if (length > 0.0) ++(std::abs(length - 1.0) < kRounding ? num_units : num_others);
    }
    if (num_others == 0 && num_units > 0) return true;
  }
  return false;
}

/// Whether every other number is the lower half of one of 64 bits, the end of its fraction: most of
/// these are 0, huge or next to nothing. (Two numbers of 32 bits read as one of 64 always look like
/// one, of about the size of the second.)
bool AreDoubles(const std::vector<float>& halves) {
  constexpr double kLeast = 1e-6;
  constexpr double kMost = 1e6;
  std::size_t num_numbers = 0;
  for (std::size_t i = 0; i < halves.size(); i += 2) {
    const double size = std::abs(halves[i]);
    num_numbers += size > kLeast && size < kMost ? 1 : 0;
  }
  return num_numbers < halves.size() / 4;
}

/// Whether the numbers of a file stand in so many rows, one after the other, which makes parts of
/// the file unlike each other: x, y, z can be positions, and no other row has numbers below 0,
/// while x or y has.
bool AreRows(std::string_view bytes, std::size_t num_rows) {
  constexpr std::size_t kLeastPoints = 64;
  constexpr std::size_t kMostPoints = 15'000;
  constexpr std::size_t kManyBelow = 20;  // One in so many.
  const std::size_t num_points = bytes.size() / sizeof(float) / num_rows;
  if (bytes.size() != num_points * num_rows * sizeof(float) || num_points < kLeastPoints) {
    return false;
  }
  // Where the numbers stand side by side, a step prime to their columns meets all of them.
  constexpr std::size_t kPrimesOfColumns = 2 * 3 * 5 * 7 * 11 * 13;
  std::size_t step = (num_points + kMostPoints - 1) / kMostPoints;
  while (std::gcd(step, kPrimesOfColumns) != 1) ++step;
  std::vector<float> numbers;
  std::vector<std::size_t> num_below(num_rows);
  for (std::size_t point = 0; point < num_points; point += step) {
    for (std::size_t row = 0; row < num_rows; ++row) {
      float number{};
      std::memcpy(&number, bytes.data() + (row * num_points + point) * sizeof number,
                  sizeof number);
      numbers.push_back(number);
      num_below[row] += number < 0.0F ? 1 : 0;
    }
  }
  const bool are_others_above = std::ranges::none_of(std::span(num_below).subspan(3),
                                                     [](std::size_t num) { return num > 0; });
  return are_others_above &&
         kManyBelow * std::max(num_below[0], num_below[1]) >= numbers.size() / num_rows &&
         CanBePositions(numbers, num_rows);
}

/// Says that the numbers of a file stand in rows; empty if they do not.
std::string SayRows(std::string_view bytes) {
  // The most first, for rows of others lie within fewer.
  for (const std::size_t num : {6UL, 5UL, 4UL}) {
    if (!AreRows(bytes, num)) continue;
    const std::string rows = NumberText(num);
    return "they stand in " + rows +
           " rows, x, y, z and others, one after the other: numpy.fromfile(FILE, "
           "'float32').reshape(" +
           rows + ", -1).T.tofile(FILE) stores them by points";
  }
  return {};
}

/// The choice of other columns that fits the values of a file that is read with four; "4" if these
/// do, or if there are too few to tell; empty if none fits.
std::string FittingColumns(std::string_view bytes) {
  constexpr std::size_t kLeastNumbers = 256;
  constexpr double kClear = 0.9;
  constexpr std::array<std::size_t, 7> kOthers = {3, 5, 6, 7, 8, 12, 16};
  const auto numbers = SomeNumbers<float>(bytes);
  const std::size_t num_floats = bytes.size() / sizeof(float);
  if (numbers.size() < kLeastNumbers) return "4";
  const bool is_four = bytes.size() % (4 * sizeof(float)) == 0 && CanBePositions(numbers, 4) &&
                       CanBeIntensities(numbers);
  std::size_t best = 4;
  double least = DifferenceAt(numbers, best);
  for (const std::size_t num : kOthers) {
    const bool is_possible = bytes.size() % sizeof(float) == 0 && num_floats % num == 0;
    // Points in pairs differ less from the one after the next.
    const double clear = num % best == 0 ? 0.5 * kClear : kClear;
    const double difference = DifferenceAt(numbers, num);
    if (!is_possible || !(difference < clear * least)) continue;
    best = num;
    least = difference;
  }
  // Where points do not follow each other as the sensor saw them, differences tell nothing.
  for (const std::size_t num : {8UL, 12UL, 16UL}) {
    if (best == 4 && num_floats % num == 0 && HasNormals(numbers, num)) best = num;
  }
  if (best == 4 ? is_four : CanBePositions(numbers, best)) {
    if (best == 5 && IsRing(numbers, 4, 5)) return "nuscenes";
    if (best == 6 && !IsRing(numbers, 4, 6)) return "waymo";
    return NumberText(best);
  }
  const bool is_double = bytes.size() % (4 * sizeof(double)) == 0 && AreDoubles(numbers) &&
                         CanBePositions(SomeNumbers<double>(bytes), 4);
  return is_double ? "float64" : "";
}

std::string SayWhatFits(const std::string& choice) {
  const std::string known = choice == "nuscenes" ? " of nuScenes (x y z intensity ring)"
                            : choice == "waymo" ? " of Waymo (x y z intensity elongation timestamp)"
                                                : "";
  return "those" + (known.empty() ? " of --kitti-columns " + choice + " fit"
                                  : known + " fit: --kitti-columns " + choice);
}

/// Checks that the values are those of four float32 a point.
void CheckFour(const std::string& file, std::string_view bytes) {
  const std::string fitting = FittingColumns(bytes);
  const bool is_uneven = bytes.size() % (4 * sizeof(float)) != 0;
  if (!is_uneven && fitting == "4") return;
  const std::string rows = SayRows(bytes);
  std::string what = rows;
  if (rows.empty() && fitting != "4") {
    what = fitting.empty() ? "nor those of 3, 5, 6, 7, 8, 12 or 16 numbers, of 4 of float64, or of "
                             "rows; --kitti-columns N takes N numbers a point as they are"
                           : SayWhatFits(fitting);
  }
  if (!what.empty()) what.insert(0, "; ");
  if (is_uneven) {
    throw InputError(file + ": must have 16 bytes for each point" + Got(bytes.size()) + what);
  }
  throw InputError(
      file + ": its values are not those of 4 numbers a point, x y z intensity, in metres" + what);
}

void CheckLabels(const std::string& file,
                 std::string_view bytes,
                 std::size_t num_points,
                 std::string_view labels) {
  if (labels.size() == num_points * kBytesOfLabel) return;
  std::string message = file + ": its .label file must have " +
                        NumberText(num_points * kBytesOfLabel) + " bytes" + Got(labels.size());
  const std::size_t num_labels = labels.size() / kBytesOfLabel;
  const std::size_t num_floats = bytes.size() / sizeof(float);
  if (num_labels > 0 && num_floats % num_labels == 0 &&
      ColumnsNamed(NumberText(num_floats / num_labels))) {
    const std::size_t num = num_floats / num_labels;
    message += "; " + NumberText(num_labels) + " labels are as many as points of " +
               NumberText(num) + " numbers: --kitti-columns " +
               (num == 5   ? "nuscenes"
                : num == 6 ? "waymo"
                           : NumberText(num)) +
               "?";
  }
  throw InputError(message);
}

CloudFile ReadColumns(const std::string& file,
                      std::string_view bytes,
                      const std::optional<std::string>& labels,
                      const BinColumns& columns) {
  const std::size_t point_bytes = columns.num_bytes();
  const std::size_t num_points = bytes.size() / point_bytes;
  if (labels) CheckLabels(file, bytes, num_points, *labels);
  if (bytes.size() % point_bytes != 0 || num_points > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(file + ": must have " + NumberText(point_bytes) + " bytes for each point" +
                     Got(bytes.size()));
  }
  CloudFile read;
  Cloud& cloud = read.cloud;
  cloud.width = static_cast<std::uint32_t>(num_points);
  cloud.height = 1;
  for (const std::string& name : columns.names) cloud.AddField(name, columns.type);
  if (!labels) {
    const auto* const rows = reinterpret_cast<const std::uint8_t*>(bytes.data());
    cloud.data.assign(rows, rows + bytes.size());
    return read;
  }
  cloud.AddField("label", NumberType::kUint16);
  cloud.AddField("instance", NumberType::kUint16);
  read.label_bytes = kBytesOfLabel;
  cloud.data.resize(num_points * cloud.point_step);
  Transpose({point_bytes, kBytesOfLabel}, num_points, (std::string(bytes) + *labels).data(), true,
            cloud.data.data());
  return read;
}

}  // namespace

void TurnLeft(const Cloud& cloud, std::vector<std::uint8_t>& rows) {
  for (auto row = rows.begin(); row != rows.end(); row += cloud.point_step) {
    std::array<float, 2> place{};
    std::memcpy(place.data(), &*row, sizeof place);
    place = {place[1], -place[0]};
    std::memcpy(&*row, place.data(), sizeof place);
  }
}

bool IsKittiColumns(std::string_view choice) {
  return ColumnsNamed(choice).has_value();
}

CloudFile ParseKittiFile(const std::string& file,
                         std::string_view bytes,
                         const std::optional<std::string>& labels) {
  if (labels) CheckLabels(file, bytes, bytes.size() / (4 * sizeof(float)), *labels);
  CheckFour(file, bytes);
  return ReadColumns(file, bytes, labels, *ColumnsNamed("4"));
}

CloudFile ParseKittiColumns(const std::string& file,
                            std::string_view bytes,
                            const std::optional<std::string>& labels,
                            std::string_view choice) {
  const auto columns = ColumnsNamed(choice);
  Check(columns.has_value(), "the choice is one of IsKittiColumns()");
  const std::string rows = columns->type == NumberType::kFloat ? SayRows(bytes) : "";
  if (!rows.empty()) {
    throw InputError(file + ": must have the numbers of a point side by side; " + rows);
  }
  CloudFile read = ReadColumns(file, bytes, labels, *columns);
  read.is_turned = choice == "nuscenes";
  if (read.is_turned) TurnLeft(read.cloud, read.cloud.data);
  return read;
}

}  // namespace railcast
