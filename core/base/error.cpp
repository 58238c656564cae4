#include "core/base/error.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "core/base/text.h"

namespace railcast {
namespace {

// Without a stream, which swallows that memory has run out: the error would have no line.
std::vector<Fault> FaultsOfLines(std::string_view lines) {
  std::vector<Fault> faults;
  while (const auto line = TakeLine(lines)) faults.push_back({"", std::string(*line), ""});
  return faults;
}

// More lines than a screen has would hide the first ones, which are often the cause of the others.
std::string LinesOf(const std::vector<Fault>& faults) {
  constexpr std::size_t kMostShown = 20;
  const std::size_t num_shown = std::min(faults.size(), kMostShown);
  std::string lines;
  for (std::size_t i = 0; i < num_shown; ++i) {
    if (!lines.empty()) lines += '\n';
    lines += faults[i].Line();
  }
  if (faults.size() == num_shown) return lines;
  return lines + "\n... and " + std::to_string(faults.size() - num_shown) + " more faults";
}

}  // namespace

std::string Fault::Line() const {
  return (place.empty() ? "" : place + ": ") + rule + (value.empty() ? "" : " (got " + value + ")");
}

InputError::InputError(const std::string& lines)
    : std::runtime_error(LinesOf(FaultsOfLines(lines))),
      faults_(std::make_shared<const std::vector<Fault>>(FaultsOfLines(lines))) {}

InputError::InputError(std::vector<Fault> faults)
    : std::runtime_error(LinesOf(faults)),
      faults_(std::make_shared<const std::vector<Fault>>(std::move(faults))) {}

void ErrorList::Add(Fault fault) {
  if (seen_.insert(fault.Line()).second) faults_.push_back(std::move(fault));
}

std::vector<std::string> ErrorList::lines() const {
  std::vector<std::string> lines;
  for (const Fault& fault : faults_) lines.push_back(fault.Line());
  return lines;
}

void ErrorList::ThrowIfAny() const {
  if (!faults_.empty()) throw InputError(faults_);
}

void Check(bool condition, const char* assumption, const char* file, int line) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: broken assumption: %s\n", file, line, assumption);
  std::abort();
}

bool UnknownPlaces::IsKnown(std::string_view pointer) const {
  const std::string within = std::string(pointer) + '/';
  const auto first = pointers_.lower_bound(within);
  if (first != pointers_.end() && first->starts_with(within)) return false;
  for (std::string_view outer = pointer;; outer = outer.substr(0, outer.rfind('/'))) {
    if (pointers_.contains(outer)) return false;
    if (outer.find('/') == std::string_view::npos) return true;
  }
}

InputError LacksExtra(const std::string& what, const std::string& extra) {
  std::string option = extra;
  std::ranges::transform(option, option.begin(), [](char c) { return c - 'a' + 'A'; });
  return InputError(what + ": needs the extra " + extra +
                    ", which is not installed (Debian package railcast-" + extra +
                    "; to build it, -D RAILCAST_BUILD_" + option + "=ON)");
}

}  // namespace railcast
