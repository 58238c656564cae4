#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/units.h"
#include "core/io/cloud/las_reader.h"
#include "core/io/recording/cloud_stem.h"
#include "core/io/recording/recording_kinds.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

using CloudNames = std::vector<CloudName>;

/// Decides what a value means that all names have: whether hyphens before it are signs, and how
/// fractions are read. Fractions are numbers of nanoseconds without zeros in front, as pcl_ros of
/// ROS 2 writes them, if the longest has nine digits, none begins with 0, as one in ten decimal
/// fractions does, and none is as short as 5, half a second or 5 ns; and they are numbers of their
/// own if two would be the same, as where 1.10 is the tenth of the first.
void SettleValues(CloudNames& names, std::size_t place) {
  const auto value_of = [&](CloudName& name) -> NameValue& { return name.values[place]; };
  const std::string& before = names.front().texts[place];
  const bool are_signs =
      before.empty() || before.back() == '_' || before.back() == '=' ||
      std::ranges::any_of(names, [&](CloudName& name) { return !value_of(name).has_sign; });
  std::size_t longest = 0;
  bool are_ns = true;
  for (CloudName& name : names) {
    NameValue& value = value_of(name);
    value.is_negative = value.is_negative && are_signs;
    const std::string& fraction = value.fraction;
    longest = std::max(longest, fraction.size());
    constexpr std::size_t kLeastDigits = 4;
    are_ns = are_ns && value.has_point &&
             (fraction == "0" || (fraction.front() != '0' && fraction.size() >= kLeastDigits));
  }
  const auto fill_up = [&] {
    for (CloudName& name : names) {
      NameValue& value = value_of(name);
      if (value.has_point) value.fraction.insert(0, longest - value.fraction.size(), '0');
    }
  };
  if (are_ns && longest == kNanosecondDigits) return fill_up();
  if (longest == 0) return;
  std::set<std::vector<NameValue>> different;
  for (const CloudName& name : names) different.insert(name.values);
  if (different.size() == names.size()) return;
  fill_up();
  for (CloudName& name : names) value_of(name).has_point = false;
}

/// Whether values are whole numbers that follow each other without a gap, and not only tenths.
bool CountsWithoutGap(std::vector<NameValue> values) {
  std::ranges::sort(values);
  bool are_tenths = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto number = ParseNumber<std::uint64_t>("0" + values[i].whole);
    const auto first = ParseNumber<std::uint64_t>("0" + values[0].whole);
    if (values[i].is_time || values[i].has_point || !number || *number != *first + i) return false;
    are_tenths = are_tenths && values[i].written.size() == 1;
  }
  return !are_tenths || values.back().whole != "9";
}

/// The stems of which a stem may be a copy by its name: "x (1)", "x - Copy", "x_copy", "Kopie von
/// x".
std::vector<std::string_view> OriginalsOf(std::string_view stem) {
  std::vector<std::string_view> originals;
  const auto add_before = [&](std::size_t mark) {
    const std::size_t end = mark == 0 ? mark : stem.find_last_not_of(" -_(", mark - 1);
    if (mark > 0 && end != std::string_view::npos) originals.push_back(stem.substr(0, end + 1));
  };
  if (stem.ends_with(')') && stem.rfind('(') != std::string_view::npos) {
    add_before(stem.rfind('('));
  }
  if (stem.rfind(" - ") != std::string_view::npos) add_before(stem.rfind(" - "));
  const std::string lower = LowerCase(stem);
  for (const std::string_view word : {"cop", "kop"}) {  // "Copy", "copie", "Kopie", "kopia" ...
    if (lower.starts_with(word)) {                      // "Copy of x", "Kopie (2) von x".
      std::size_t blank = stem.find(' ');
      if (stem.substr(std::min(blank, stem.size())).starts_with(" (")) {
        blank = stem.find(' ', blank + 1);
      }
      if (blank != std::string_view::npos) blank = stem.find(' ', blank + 1);
      if (blank != std::string_view::npos) originals.push_back(stem.substr(blank + 1));
    }
    const std::size_t place = lower.rfind(word);
    if (place == std::string::npos || place == 0) continue;
    if (std::string_view(" -_(").find(stem[place - 1]) != std::string_view::npos) add_before(place);
  }
  return originals;
}

/// Files whose names differ in their running number or time alone.
struct NameSeries {
  std::string label;               ///< "front_#".
  std::vector<std::size_t> files;  ///< In order.
  /// The values that run, for each file.
  std::vector<std::vector<NameValue>> values;
  bool is_bare{};  ///< Whether the stems are numbers and nothing else.
  bool is_part{};  ///< Whether others have the same text, and other numbers in one place.
};

/// The stamp that a number is: of 2001 to 2099 in s, ms, us or ns, or any number of seconds with a
/// point that stands alone.
std::optional<std::int64_t> StampOfNumber_ns(const NameValue& number, bool is_decimal) {
  constexpr std::int64_t kFirst_s = 1'000'000'000;
  constexpr std::int64_t kEnd_s = 4'100'000'000;
  constexpr std::size_t kMostDigits = 19;
  if (number.whole.size() > kMostDigits || number.fraction.size() > kNanosecondDigits) {
    return std::nullopt;
  }
  const auto whole = ParseNumber<std::int64_t>("0" + number.whole);
  if (!whole) return std::nullopt;
  std::string fraction = number.fraction;
  fraction.resize(kNanosecondDigits, '0');
  const auto fraction_ns = ParseNumber<std::int64_t>(fraction).value();
  for (std::int64_t per_s = 1; per_s <= kNsPerS; per_s *= 1000) {
    if (*whole < kFirst_s * per_s || *whole / per_s >= kEnd_s) continue;
    return *whole * (kNsPerS / per_s) + (per_s == 1 ? fraction_ns : 0);
  }
  if (!is_decimal || *whole >= kFirst_s * 9) return std::nullopt;
  return (number.is_negative ? -1 : 1) * (*whole * kNsPerS + fraction_ns);
}

/// The stamps of the files of a series; empty if they have none.
std::vector<std::int64_t> StampsOf(const NameSeries& series) {
  const bool is_decimal =
      series.is_bare && std::ranges::any_of(series.values, [](const auto& values) {
        return values.size() == 1 && values[0].has_point;
      });
  std::vector<std::int64_t> stamps_ns;
  for (const std::vector<NameValue>& values : series.values) {
    const auto time = std::ranges::find_if(values, &NameValue::is_time);
    std::optional<std::int64_t> stamp_ns;
    if (time != values.end()) {
      stamp_ns = time->time_ns;
    } else if (values.size() == 2 && values[1].written.size() == kNanosecondDigits) {
      // Seconds, and nanoseconds behind them.
      NameValue both = values[0];
      both.fraction = values[1].written;
      stamp_ns = StampOfNumber_ns(both, false);
    } else {
      for (const NameValue& value : values) {
        if (!stamp_ns) stamp_ns = StampOfNumber_ns(value, is_decimal);
      }
    }
    if (!stamp_ns) return {};
    stamps_ns.push_back(*stamp_ns);
  }
  return stamps_ns;
}

/// Parses names: those that differ in their numbers alone hold times where all of them do.
/// Otherwise "20261130_000059" is followed by "20261130_000060".
CloudNames ParseNames(const std::vector<std::string>& stems) {
  CloudNames plain;
  CloudNames timed;
  std::map<std::string, bool> all_timed;  // By the text beside the numbers.
  for (const std::string& stem : stems) {
    plain.push_back(ParseCloudName(stem, false));
    timed.push_back(ParseCloudName(stem, true));
    const bool has_time = std::ranges::any_of(timed.back().values, &NameValue::is_time);
    const auto [shape, is_new] = all_timed.emplace(plain.back().Label(), has_time);
    if (!is_new) shape->second = shape->second && has_time;
  }
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (all_timed.at(plain[i].Label())) plain[i] = std::move(timed[i]);
  }
  return plain;
}

/// The number of different values in a place of names.
std::size_t NumDifferent(const CloudNames& names, std::size_t place) {
  std::set<NameValue> values;
  for (const CloudName& name : names) values.insert(name.values[place]);
  return values.size();
}

/// Whether a value of these names numbers sensors or drives beside the one that runs: each of
/// several has two files or more, and it belongs to a word, as in "lidar2_0001", or the other one
/// counts without a gap beside it.
bool IsOfSource(const CloudNames& names, std::size_t place, std::size_t running) {
  std::map<NameValue, std::vector<NameValue>> beside;
  bool is_in_word = false;
  for (const CloudName& name : names) {
    beside[name.values[place]].push_back(name.values[running]);
    is_in_word = is_in_word || name.IsInWord(place) || name.values[place].is_time;
  }
  const auto several =
      std::ranges::count_if(beside, [](const auto& source) { return source.second.size() > 1; });
  if (several < 2) return false;
  return is_in_word || std::ranges::all_of(beside, [](const auto& source) {
           return CountsWithoutGap(source.second);
         });
}

/// Whether the values in a place are fractions of the seconds before them, written without a point:
/// nanoseconds, or all parts into which a steady rate divides a second.
bool AreFractions(const CloudNames& names, std::size_t place) {
  constexpr std::size_t kMostRate_hz = 100;  // A thousand are numbers of frames.
  const std::size_t num_digits = names.front().values[place].written.size();
  if (num_digits != 1 && num_digits != 3 && num_digits != 6 && num_digits != kNanosecondDigits) {
    return false;
  }
  std::set<std::uint64_t> parts;
  for (const CloudName& name : names) {
    const NameValue& value = name.values[place];
    const bool is_plain = !value.is_time && !value.has_point && !value.has_sign;
    if (!is_plain || value.written.size() != num_digits || name.texts[place].size() != 1 ||
        name.IsInWord(place - 1)) {
      return false;
    }
    parts.insert(ParseNumber<std::uint64_t>("0" + value.whole).value());
  }
  if (num_digits == kNanosecondDigits) {
    return *parts.rbegin() - *parts.begin() >= parts.size();  // They do not count.
  }
  std::uint64_t step = num_digits == 1 ? 10 : num_digits == 3 ? 1'000 : 1'000'000;
  if (parts.size() < 2 || parts.size() > kMostRate_hz || step % parts.size() != 0) return false;
  step /= parts.size();
  return std::ranges::all_of(
      parts, [&](std::uint64_t part) { return part % step == *parts.begin() % step; });
}

/// Splits names that differ in their values alone, and puts each series in order.
std::vector<NameSeries> SplitNames(CloudNames names, const std::vector<std::size_t>& files) {
  const std::size_t num_values = names.front().values.size();
  std::vector<std::size_t> different;
  for (std::size_t i = 0; i < num_values; ++i) {
    SettleValues(names, i);
    different.push_back(NumDifferent(names, i));
  }
  const auto most = std::max_element(different.rbegin(), different.rend());
  const auto running = static_cast<std::size_t>(different.rend() - most) - 1;
  std::vector<bool> runs(num_values, false);
  for (std::size_t i = 0; i < num_values; ++i) {
    const bool is_beside = i + 1 == running || i == running + 1;
    runs[i] = i == running ||
              (different[i] > 1 && ((is_beside && AreFractions(names, std::max(i, running))) ||
                                    !IsOfSource(names, i, running)));
  }
  // Seconds stand before nanoseconds, also if they are the same in all names.
  const NameValue& last = names.front().values[running];
  if (running > 0 && last.written.size() == kNanosecondDigits &&
      StampOfNumber_ns(names.front().values[running - 1], false)) {
    runs[running - 1] = true;
  }
  const auto running_values = [&](std::size_t i) {
    std::vector<NameValue> values;
    for (std::size_t place = 0; place < num_values; ++place) {
      if (runs[place]) values.push_back(names[i].values[place]);
    }
    return values;
  };
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, running_values);
  std::map<std::string, NameSeries> by_label;
  for (const std::size_t i : order) {
    NameSeries& series = by_label[names[i].Label(runs)];
    series.files.push_back(files[i]);
    series.values.push_back(running_values(i));
    series.is_bare = names[i].Label() == "#";
  }
  std::vector<NameSeries> all;
  for (auto& [label, series] : by_label) {
    series.label = label;
    series.is_part = by_label.size() > 1;
    all.push_back(std::move(series));
  }
  return all;
}

/// All series of names, also those of one.
std::vector<NameSeries> SeriesOfNames(const std::vector<std::string>& stems) {
  std::map<std::string, std::pair<CloudNames, std::vector<std::size_t>>> by_text;
  CloudNames names = ParseNames(stems);
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto& [alike, files] = by_text[names[i].Label()];
    files.push_back(i);
    alike.push_back(std::move(names[i]));
  }
  std::vector<NameSeries> all;
  for (auto& [text, group] : by_text) {
    if (group.first.front().values.empty()) {
      all.push_back({.label = text, .files = {group.second.front()}, .values = {{}}});
      continue;
    }
    for (NameSeries& series : SplitNames(std::move(group.first), group.second)) {
      all.push_back(std::move(series));
    }
  }
  return all;
}

std::vector<std::string> StemsOf(const std::vector<fs::path>& files) {
  std::vector<std::string> stems;
  for (const fs::path& file : files) stems.push_back(file.stem().string());
  return stems;
}

/// Moves those files that are copies of others to `others`.
void TakeCopies(std::vector<fs::path>& files, std::vector<fs::path>& others) {
  std::set<std::string, std::less<>> stems;
  for (const fs::path& file : files) stems.insert(file.stem().string());
  std::erase_if(files, [&](const fs::path& file) {
    const std::string stem = file.stem().string();
    const bool is_copy = std::ranges::any_of(
        OriginalsOf(stem), [&](std::string_view original) { return stems.contains(original); });
    if (is_copy) others.push_back(file);
    return is_copy;
  });
}

/// Whether a series follows another one: its first value is above the last of the other.
bool Follows(const NameSeries& after, const NameSeries& before) {
  const std::vector<NameValue>& first = after.values.front();
  const std::vector<NameValue>& last = before.values.back();
  const auto is_time = [](const NameValue& value) { return value.is_time; };
  return std::ranges::equal(first, last, {}, is_time, is_time) && last < first;
}

/// The series of more than one file in the order of their values.
/// @throws InputError if they overlap: they are of several sensors or drives.
std::vector<NameSeries> InOrder(std::vector<NameSeries> series, const fs::path& directory) {
  std::ranges::stable_sort(series, {}, [](const NameSeries& one) { return one.values.front(); });
  for (std::size_t i = 1; i < series.size(); ++i) {
    if (Follows(series[i], series[i - 1])) continue;
    std::string got;
    for (const NameSeries& one : series) {
      got += (got.empty() ? "" : ", ") + ShownText(one.label) + " of " +
             NumberText(one.files.size()) + " files";
    }
    throw InputError(ShownPath(directory) + ": must hold one series of clouds (got " + got + "); " +
                     ShownPath(directory / series.front().label) + " opens the first");
  }
  return series;
}

}  // namespace

CloudSeries SeriesOfClouds(std::vector<fs::path> files, const std::string& label) {
  CloudSeries clouds;
  SortNaturally(files);
  // Tiles of surveys are numbered by their places.
  if (files.empty() || IsLasFile(files.front())) return {std::move(files), {}};
  const fs::path directory = files.front().parent_path();
  TakeCopies(files, clouds.others);
  std::vector<NameSeries> series = SeriesOfNames(StemsOf(files));
  std::size_t num_in_series = 0;
  std::erase_if(series, [&](const NameSeries& one) {
    const bool is_wanted = label.empty() ? one.files.size() > 1 || one.is_part : one.label == label;
    if (is_wanted) num_in_series += one.files.size();
    return !is_wanted;
  });
  if (label.empty() && 2 * num_in_series <= files.size()) {
    clouds.files = std::move(files);
    return clouds;
  }
  std::vector<bool> is_taken(files.size(), false);
  for (const NameSeries& one : InOrder(std::move(series), directory)) {
    for (const std::size_t i : one.files) {
      clouds.files.push_back(files[i]);
      is_taken[i] = true;
    }
  }
  for (std::size_t i = 0; i < files.size() && label.empty(); ++i) {
    if (!is_taken[i]) clouds.others.push_back(files[i]);
  }
  return clouds;
}

std::vector<std::int64_t> StampsOfNames(const std::vector<fs::path>& files) {
  if (files.size() < 2) return {};
  std::vector<std::int64_t> stamps_ns(files.size());
  for (const NameSeries& series : SeriesOfNames(StemsOf(files))) {
    const std::vector<std::int64_t> of_series_ns = StampsOf(series);
    if (of_series_ns.empty()) return {};
    for (std::size_t i = 0; i < series.files.size(); ++i) {
      stamps_ns[series.files[i]] = of_series_ns[i];
    }
  }
  std::vector<std::int64_t> sorted = stamps_ns;
  std::ranges::sort(sorted);
  std::vector<double> steps_ns;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] == sorted[i - 1]) return {};
    steps_ns.push_back(static_cast<double>(sorted[i] - sorted[i - 1]));
  }
  // What follows the seconds in steps of 1 us is a number, no fraction.
  constexpr double kShortest_ns = 1e6;
  return MedianOf(steps_ns) > kShortest_ns ? stamps_ns : std::vector<std::int64_t>{};
}

}  // namespace railcast
