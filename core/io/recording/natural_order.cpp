#include "core/io/recording/natural_order.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "core/base/text.h"

namespace railcast {
namespace {

/// Takes the digits off the front of the text and returns them without leading zeros.
std::string_view TakeDigits(std::string_view& text) {
  const auto end = std::ranges::find_if_not(text, IsDigit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// Compares names naturally: numbers by value, all other characters one by one.
bool ComesBefore(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (IsDigit(a.front()) && IsDigit(b.front())) {
      const std::string_view a_digits = TakeDigits(a);
      const std::string_view b_digits = TakeDigits(b);
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

}  // namespace

void SortNaturally(std::vector<std::filesystem::path>& paths) {
  std::ranges::sort(paths, [](const std::filesystem::path& a, const std::filesystem::path& b) {
    const std::string a_name = a.filename().string();
    const std::string b_name = b.filename().string();
    if (ComesBefore(a_name, b_name)) return true;
    return !ComesBefore(b_name, a_name) && a_name < b_name;
  });
}

}  // namespace railcast
