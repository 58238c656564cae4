#include "core/io/recording/cloud_stem.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <optional>
#include <tuple>
#include <utility>

#include "core/base/text.h"
#include "core/base/units.h"

namespace railcast {
namespace {

/// Takes so many digits off the front of the text; nothing if there are fewer.
std::optional<unsigned> TakeDigits(std::size_t num, std::string_view& text) {
  const auto number = ParseNumber<unsigned>(text.substr(0, num));
  if (text.size() < num || !std::ranges::all_of(text.substr(0, num), IsDigit)) return std::nullopt;
  text.remove_prefix(num);
  return number;
}

/// Takes one of some letters off the front of the text; 0 if it begins with none of them.
char TakeOneOf(std::string_view letters, std::string_view& text) {
  if (text.empty() || letters.find(text.front()) == std::string_view::npos) return 0;
  const char letter = text.front();
  text.remove_prefix(1);
  return letter;
}

/// Takes the fraction of a second off the text: behind a point or a comma, or as 3, 6 or 9 digits
/// behind another mark, or right behind seconds that no mark divides from minutes.
std::int64_t TakeFraction_ns(bool is_compact, std::string_view& text) {
  std::string_view rest = text;
  const char mark = TakeOneOf(".,_-", rest);
  std::string digits(TakeAllDigits(rest));
  const bool is_sure = mark == '.' || mark == ',';
  const bool has_even = digits.size() == 3 || digits.size() == 6 || digits.size() == 9;
  if (digits.empty() || (!is_sure && !((mark != 0 || is_compact) && has_even))) return 0;
  text = rest;
  digits.resize(kNanosecondDigits, '0');
  return ParseNumber<std::int64_t>(digits).value();
}

/// Takes the zone off the text that a time is in: "Z", "+0800", "+08-00", "-05:00".
std::int64_t TakeZone_ns(std::string_view& text) {
  std::string_view rest = text;
  if (TakeOneOf("Zz", rest) != 0) {
    if (rest.empty() || std::isalnum(static_cast<unsigned char>(rest.front())) == 0) text = rest;
    return 0;
  }
  const char sign = TakeOneOf("+-", rest);
  const auto hours = sign == 0 ? std::nullopt : TakeDigits(2, rest);
  const char mark = TakeOneOf(":-_", rest);
  const auto minutes = TakeDigits(2, rest);
  constexpr unsigned kMostHours = 14;
  const bool is_zone = hours && minutes && *hours <= kMostHours && *minutes % 15 == 0 &&
                       *minutes < 60 && (rest.empty() || !IsDigit(rest.front()));
  // "-0500" may be a number of its own.
  if (!is_zone || (sign == '-' && mark == 0)) return 0;
  text = rest;
  return (sign == '-' ? -1 : 1) * std::int64_t{60 * *hours + *minutes} * 60 * kNsPerS;
}

/// Takes a date with a time off the front of the text, as ISO 8601 has them, or with other marks
/// between their numbers, or without any: "2026-11-30T09-59-59.8", "20261130_095959".
std::optional<std::int64_t> TakeTime_ns(std::string_view& text) {
  std::string_view rest = text;
  const auto year = TakeDigits(4, rest);
  const char date_mark = TakeOneOf("-_.", rest);
  const auto month = TakeDigits(2, rest);
  if (date_mark != 0 && TakeOneOf({&date_mark, 1}, rest) == 0) return std::nullopt;
  const auto day = TakeDigits(2, rest);
  const char middle = TakeOneOf("Tt _-", rest);
  const auto hour = TakeDigits(2, rest);
  const char time_mark = TakeOneOf("-_.:", rest);
  const auto minute = TakeDigits(2, rest);
  if (time_mark != 0 && TakeOneOf({&time_mark, 1}, rest) == 0) return std::nullopt;
  const auto second = TakeDigits(2, rest);
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  if (middle == 0 && (date_mark != 0 || time_mark != 0)) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(*month), std::chrono::day(*day)};
  constexpr unsigned kFirstYear = 1970;
  constexpr unsigned kLastYear = 2200;
  if (!date.ok() || *year < kFirstYear || *year > kLastYear) return std::nullopt;
  if (*hour > 23 || *minute > 59 || *second > 59) return std::nullopt;
  const std::int64_t fraction_ns = TakeFraction_ns(time_mark == 0, rest);
  if (!rest.empty() && IsDigit(rest.front())) return std::nullopt;
  const std::int64_t zone_ns = TakeZone_ns(rest);
  text = rest;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  const std::int64_t seconds = ((std::int64_t{days} * 24 + *hour) * 60 + *minute) * 60 + *second;
  return seconds * kNsPerS + fraction_ns - zone_ns;
}

/// Takes a number off the front of the text, with its sign, if it has one, and its decimals, unless
/// these are followed by others, as in 1.2.3.
NameValue TakeNumberOfName(std::string_view& text) {
  NameValue number;
  const std::string_view before = text;
  const char sign = TakeOneOf("+-", text);
  number.has_sign = sign != 0;
  number.is_negative = sign == '-';
  number.whole = WithoutZeros(TakeAllDigits(text));
  std::string_view rest = text;
  if (TakeOneOf(".", rest) != 0) {
    number.fraction = TakeAllDigits(rest);
    const bool goes_on = rest.size() > 1 && rest[0] == '.' && IsDigit(rest[1]);
    number.has_point = !number.fraction.empty() && !goes_on;
  }
  if (number.has_point) {
    text = rest;
    const std::size_t last = number.fraction.find_last_not_of('0');
    number.fraction.resize(std::min(number.fraction.size(), std::max(last + 1, kNanosecondDigits)));
  } else {
    number.fraction.clear();
  }
  number.written = before.substr(0, before.size() - text.size());
  return number;
}

/// What the size of a number without its sign is compared by.
auto SizeOfNumber(const NameValue& number) {
  const std::string_view fraction = number.fraction;
  return std::tuple(number.whole.size(), std::string_view(number.whole),
                    fraction.substr(0, fraction.find_last_not_of('0') + 1));
}

}  // namespace

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

std::weak_ordering NameValue::operator<=>(const NameValue& other) const {
  if (is_time || other.is_time) {
    return std::tuple(is_time, time_ns) <=> std::tuple(other.is_time, other.time_ns);
  }
  if (is_negative != other.is_negative) return other.is_negative <=> is_negative;
  const auto size = SizeOfNumber(*this) <=> SizeOfNumber(other);
  return is_negative ? 0 <=> size : size;
}

std::string CloudName::Label(const std::vector<bool>& runs) const {
  std::string label;
  for (std::size_t i = 0; i < values.size(); ++i) {
    label += texts[i] + (runs.empty() || runs[i] ? "#" : values[i].written);
  }
  return label + texts.back();
}

bool CloudName::IsInWord(std::size_t place) const {
  const auto is_letter = [](char letter) {
    const auto byte = static_cast<unsigned char>(letter);
    return std::isalpha(byte) != 0 || byte >= 0x80;
  };
  const std::string& before = texts[place];
  const std::string& after = texts[place + 1];
  return (!before.empty() && is_letter(before.back())) ||
         (!after.empty() && is_letter(after.front()));
}

CloudName ParseCloudName(std::string_view stem, bool with_times) {
  CloudName name{{""}, {}};
  char last = 0;
  for (std::string_view rest = stem; !rest.empty();) {
    const std::string_view before = rest;
    NameValue value;
    std::optional<std::int64_t> time_ns;
    std::string_view unsigned_rest = rest.substr(rest.front() == '-' ? 1 : 0);
    const bool is_hyphen = unsigned_rest.size() < rest.size() && TakeTime_ns(unsigned_rest);
    const bool is_sign = !IsDigit(last) && !is_hyphen && rest.size() > 1 &&
                         (rest[0] == '-' || rest[0] == '+') && IsDigit(rest[1]);
    if (with_times && IsDigit(rest.front())) time_ns = TakeTime_ns(rest);
    if (time_ns) {
      value.is_time = true;
      value.time_ns = *time_ns;
      value.written = before.substr(0, before.size() - rest.size());
    } else if (IsDigit(rest.front()) || is_sign) {
      value = TakeNumberOfName(rest);
    } else {
      last = rest.front();
      name.texts.back() += last;
      rest.remove_prefix(1);
      continue;
    }
    last = '0';
    name.values.push_back(std::move(value));
    name.texts.emplace_back();
  }
  return name;
}

}  // namespace railcast
