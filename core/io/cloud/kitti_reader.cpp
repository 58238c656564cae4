#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
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

/// The first numbers of a file, by which layouts are judged.
template <typename Number>
std::vector<Number> FirstNumbers(std::string_view bytes) {
  constexpr std::size_t kMost = 60'000;
  std::vector<Number> numbers(std::min(kMost, bytes.size() / sizeof(Number)));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
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

/// Whether the first three of so many numbers a point can be coordinates: 99 % are metres, and none
/// is an index 0..n or, of x and y, always 0.
template <typename Number>
bool CanBePositions(const std::vector<Number>& numbers, std::size_t num_columns) {
  constexpr double kMostIndex = 255.0;
  constexpr double kMostWrong = 0.01;
  const std::size_t num_rows = numbers.size() / num_columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::size_t num_wrong = 0;
    bool is_index = true;
    double most = 0.0;
    for (std::size_t row = 0; row < num_rows; ++row) {
      const double value = static_cast<double>(numbers[row * num_columns + axis]);
      if (!IsLikelyPosition(value)) ++num_wrong;
      is_index = is_index && value >= 0.0 && value <= kMostIndex && value == std::floor(value);
      most = std::max(most, value);
    }
    if (static_cast<double>(num_wrong) > kMostWrong * static_cast<double>(num_rows)) return false;
    if (is_index && (most > 0.0 || axis < 2)) return false;
  }
  return true;
}

/// The choice of other columns that fits the values of a file that is read with four; "4" if these
/// do, or if there are too few to tell; empty if none fits.
std::string FittingColumns(std::string_view bytes) {
  constexpr std::size_t kLeastNumbers = 256;
  constexpr double kClear = 0.9;
  constexpr std::array<std::size_t, 5> kOthers = {3, 5, 6, 7, 8};
  const auto numbers = FirstNumbers<float>(bytes);
  const std::size_t num_floats = bytes.size() / sizeof(float);
  if (numbers.size() < kLeastNumbers) return "4";
  const bool is_four = bytes.size() % (4 * sizeof(float)) == 0 && CanBePositions(numbers, 4);
  std::size_t best = 4;
  double least = DifferenceAt(numbers, best);
  for (const std::size_t num : kOthers) {
    const bool is_possible = bytes.size() % sizeof(float) == 0 && num_floats % num == 0;
    // Points in pairs differ less from the one after the next.
    const double clear = num % best == 0 ? 0.5 * kClear : kClear;
    const double difference = DifferenceAt(numbers, num);
    if (!is_possible || !(difference < clear * least) || !CanBePositions(numbers, num)) continue;
    best = num;
    least = difference;
  }
  if (best == 5) {
    bool is_ring = true;
    for (std::size_t i = 4; i < numbers.size(); i += 5) {
      is_ring = is_ring && numbers[i] >= 0.0F && numbers[i] == std::floor(numbers[i]);
    }
    return is_ring ? "nuscenes" : "5";
  }
  if (best == 6) return "waymo";
  if (best != 4 || is_four) return NumberText(best);
  const bool is_double =
      bytes.size() % (4 * sizeof(double)) == 0 && CanBePositions(FirstNumbers<double>(bytes), 4);
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
  const std::string what = fitting.empty() || fitting == "4" ? "" : "; " + SayWhatFits(fitting);
  if (is_uneven) {
    throw InputError(file + ": must have 16 bytes for each point" + Got(bytes.size()) + what);
  }
  throw InputError(file +
                   ": its values are not those of 4 numbers a point, x y z intensity, in metres" +
                   (what.empty() ? "; --kitti-columns says how many it has" : what));
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
  return ReadColumns(file, bytes, labels, *columns);
}

}  // namespace railcast
