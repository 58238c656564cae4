#include "core/io/verify/known_names.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "core/io/run/sequence_files.h"

namespace railcast {
namespace {

/// A name that has the number of a frame, "frames/000012.pcd".
struct NumberedName {
  std::string around;  ///< "frames/#.pcd".
  std::uint32_t number{};
};

std::optional<NumberedName> SplitAtNumber(std::string_view name) {
  const std::size_t begin = name.rfind('/') + 1;  // 0 if there is none.
  const std::string_view file = name.substr(begin);
  NumberedName split;
  const auto [end, error] = std::from_chars(file.data(), file.data() + file.size(), split.number);
  const auto num_digits = static_cast<std::size_t>(end - file.data());
  // Another number of digits would be another name.
  if (error != std::errc() || FrameDigits(split.number) != file.substr(0, num_digits)) {
    return std::nullopt;
  }
  split.around = std::string(name.substr(0, begin)) + "#" + std::string(file.substr(num_digits));
  return split;
}

}  // namespace

bool KnownNames::Hold(const std::vector<Numbers>& runs, std::uint32_t number) {
  const auto next = std::ranges::upper_bound(runs, number, {}, &Numbers::first);
  if (next == runs.begin()) return false;
  const Numbers& run = *(next - 1);
  if (run.step == 0) return number == run.first;
  return number <= run.last && (number - run.first) % run.step == 0;
}

void KnownNames::insert(const std::string& name) {
  const auto split = SplitAtNumber(name);
  if (!split) {
    others_.insert(name);
    return;
  }
  const std::uint32_t number = split->number;
  std::vector<Numbers>& runs = numbered_[split->around];
  if (runs.empty()) {
    runs.push_back({number, number, 0});
    return;
  }
  Numbers& last = runs.back();
  if (number <= last.last) {
    if (!Hold(runs, number)) others_.insert(name);
  } else if (last.step == 0 || number - last.last == last.step) {
    last.step = number - last.last;
    last.last = number;
  } else {
    runs.push_back({number, number, 0});
  }
}

bool KnownNames::contains(std::string_view name) const {
  if (others_.contains(name)) return true;
  const auto split = SplitAtNumber(name);
  if (!split) return false;
  const auto found = numbered_.find(split->around);
  return found != numbered_.end() && Hold(found->second, split->number);
}

}  // namespace railcast
