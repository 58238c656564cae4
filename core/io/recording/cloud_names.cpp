#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/las_reader.h"
#include "core/io/recording/recording_kinds.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Takes the digits off the front of the text.
std::string_view TakeAllDigits(std::string_view& text) {
  const auto end = std::ranges::find_if_not(text, IsDigit);
  const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  return digits;
}

std::string_view WithoutZeros(std::string_view digits) {
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// Compares names naturally: numbers by value, all other characters one by one.
bool ComesBefore(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (IsDigit(a.front()) && IsDigit(b.front())) {
      const std::string_view a_digits = WithoutZeros(TakeAllDigits(a));
      const std::string_view b_digits = WithoutZeros(TakeAllDigits(b));
      if (a_digits.size() != b_digits.size()) return a_digits.size() < b_digits.size();
      if (a_digits != b_digits) return a_digits < b_digits;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.size() < b.size();
}

/// Sorts paths of one folder by the natural order of their names, so that 9.pcd comes
/// before 10.pcd.
void SortNaturally(std::vector<fs::path>& paths) {
  std::ranges::sort(paths, [](const fs::path& a, const fs::path& b) {
    const std::string a_name = a.filename().string();
    const std::string b_name = b.filename().string();
    if (ComesBefore(a_name, b_name)) return true;
    return !ComesBefore(b_name, a_name) && a_name < b_name;
  });
}

constexpr std::size_t kNanosecondDigits = 9;

/// A name with one number, which may have a decimal point: "cloud_", "12", "5", "".
struct DecimalName {
  std::string before;
  std::string whole;     ///< Without zeros in front.
  std::string fraction;  ///< As written, but for zeros behind nanoseconds.
  std::string after;
  bool has_point{};

  [[nodiscard]] auto number() const {
    return std::tuple(whole.size(), whole, fraction.substr(0, fraction.find_last_not_of('0') + 1));
  }
};

std::optional<DecimalName> DecimalNameOf(const fs::path& file) {
  const std::string name = file.stem().string();
  std::string_view rest = name;
  DecimalName decimal;
  const auto first = std::ranges::find_if(rest, IsDigit);
  decimal.before = rest.substr(0, static_cast<std::size_t>(first - rest.begin()));
  rest.remove_prefix(decimal.before.size());
  decimal.whole = WithoutZeros(TakeAllDigits(rest));
  decimal.has_point = rest.size() > 1 && rest[0] == '.' && IsDigit(rest[1]);
  if (decimal.has_point) rest.remove_prefix(1);
  if (decimal.has_point) decimal.fraction = TakeAllDigits(rest);
  if (decimal.before.size() == name.size() || std::ranges::any_of(rest, IsDigit))
    return std::nullopt;
  const std::size_t last = decimal.fraction.find_last_not_of('0');
  decimal.fraction.resize(std::min(decimal.fraction.size(), std::max(last + 1, kNanosecondDigits)));
  decimal.after = rest;
  return decimal;
}

/// Fills up fractions that are numbers of nanoseconds without zeros in front, as pcl_ros of ROS 2
/// writes them: the longest has nine digits, none begins with 0, as one in ten decimal fractions
/// does, and none is as short as 5, half a second or 5 ns.
void FillUpNanoseconds(std::vector<DecimalName>& names) {
  std::size_t longest = 0;
  for (const DecimalName& name : names) {
    const std::string& fraction = name.fraction;
    longest = std::max(longest, fraction.size());
    constexpr std::size_t kLeastDigits = 4;
    if (!name.has_point) return;
    if (fraction != "0" && (fraction.front() == '0' || fraction.size() < kLeastDigits)) return;
  }
  if (longest != kNanosecondDigits) return;
  for (DecimalName& name : names) {
    name.fraction.insert(0, kNanosecondDigits - name.fraction.size(), '0');
  }
}

/// The decimal names of all files; nothing if some have none, none has a point, or if two are the
/// same number, as where 1.10 is the tenth of the first.
std::optional<std::vector<DecimalName>> DecimalNamesOf(const std::vector<fs::path>& files) {
  std::vector<DecimalName> names;
  for (const fs::path& file : files) {
    auto name = DecimalNameOf(file);
    if (!name) return std::nullopt;
    names.push_back(std::move(*name));
    if (names.back().before != names.front().before || names.back().after != names.front().after) {
      return std::nullopt;
    }
  }
  if (std::ranges::none_of(names, &DecimalName::has_point)) return std::nullopt;
  FillUpNanoseconds(names);
  std::vector<DecimalName> sorted = names;
  std::ranges::sort(sorted, {}, &DecimalName::number);
  const auto twice = std::ranges::adjacent_find(sorted, {}, &DecimalName::number);
  return twice == sorted.end() ? std::optional(std::move(names)) : std::nullopt;
}

/// Sorts cloud files by their names: as decimal numbers where all are, else naturally.
void SortClouds(std::vector<fs::path>& files) {
  SortNaturally(files);
  const auto names = DecimalNamesOf(files);
  if (!names) return;
  std::vector<std::size_t> order(files.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return names->at(i).number(); });
  std::vector<fs::path> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(files[i]));
  files = std::move(sorted);
}

/// Throws if two files differ in their endings alone: they are one frame in two formats.
void CheckStemsDiffer(const std::vector<fs::path>& files) {
  std::map<std::string, const fs::path*> by_stem;
  for (const fs::path& file : files) {
    const auto [known, is_new] = by_stem.emplace(file.stem().string(), &file);
    if (is_new) continue;
    throw InputError(ShownPath(file.parent_path()) + ": must have each frame in one format (got " +
                     ShownPath(known->second->filename()) + " and " + ShownPath(file.filename()) +
                     ")");
  }
}

}  // namespace

bool IsCloudFile(const fs::path& file) {
  return FindReader(file) != nullptr || IsLasFile(file);
}

bool IsKittiFile(const fs::path& file) {
  const FrameFormat* const format = FindReader(file);
  return format != nullptr && format->dataset;
}

std::vector<fs::path> CloudFilesIn(const fs::path& directory) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const bool is_hidden = entry.path().filename().native().starts_with('.');
    if (!is_hidden && IsCloudFile(entry.path())) files.push_back(entry.path());
  }
  SortClouds(files);
  CheckStemsDiffer(files);
  return files;
}

std::vector<fs::path> KittiSequencesIn(const fs::path& directory) {
  std::vector<fs::path> sequences;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory / "sequences", error)) {
    if (!CloudFilesIn(entry.path() / "velodyne").empty()) sequences.push_back(entry.path());
  }
  SortNaturally(sequences);
  return sequences;
}

std::vector<fs::path> CloudsOfDirectory(const fs::path& directory) {
  for (const auto& place : {directory, directory / "frames", directory / "velodyne"}) {
    auto files = CloudFilesIn(place);
    if (!files.empty()) return files;
  }
  std::vector<fs::path> files;
  for (const fs::path& sequence : KittiSequencesIn(directory)) {
    const auto more = CloudFilesIn(sequence / "velodyne");
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

std::vector<std::int64_t> StampsOfNames(const std::vector<fs::path>& files) {
  constexpr std::size_t kMostSeconds = 10;  // Digits.
  const auto names = DecimalNamesOf(files);
  if (!names || files.size() < 2) return {};
  std::vector<std::int64_t> stamps_ns;
  for (const DecimalName& name : *names) {
    const bool is_time = name.before.empty() && name.after.empty() &&
                         name.whole.size() <= kMostSeconds &&
                         name.fraction.size() <= kNanosecondDigits;
    if (!is_time) return {};
    std::string fraction = name.fraction;
    fraction.resize(kNanosecondDigits, '0');
    const auto seconds = name.whole.empty() ? 0 : ParseNumber<std::int64_t>(name.whole).value();
    if (seconds >= 9'000'000'000) return {};
    stamps_ns.push_back(seconds * kNsPerS + ParseNumber<std::int64_t>(fraction).value());
  }
  return stamps_ns;
}

std::string ColumnsBehind(const fs::path& source) {
  const std::string& text = source.native();
  const std::size_t mark = text.rfind(':');
  if (mark == std::string::npos) return {};
  const std::string columns = text.substr(mark + 1);
  return IsKittiColumns(columns) ? columns : std::string();
}

KittiSource KittiSourceOf(const fs::path& source) {
  std::error_code error;
  const std::string columns = ColumnsBehind(source);
  if (columns.empty() || fs::exists(source, error)) return {source, {}};
  const std::string& text = source.native();
  return {text.substr(0, text.size() - columns.size() - 1), columns};
}

}  // namespace railcast
