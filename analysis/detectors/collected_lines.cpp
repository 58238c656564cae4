#include "analysis/detectors/reported_detections.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {

std::string CollectedLines::Take(std::string_view datagram, const std::string& from) {
  std::string_view rest = datagram;
  // An empty one is no JSON, which the reader says.
  const std::string_view line = TakeLine(rest).value_or("");
  if (!rest.empty()) {
    throw InputError({{from, "must send one line in each datagram", ShownText(datagram)}});
  }
  const std::uint32_t frame = ReadDetectionLine(line, from).frame;
  const auto [known, is_new] = lines_.try_emplace(frame, line);
  if (is_new) return known->second + "\n";
  if (known->second != line) {
    throw InputError({{from + ": /frame", "must be that of one line only", NumberText(frame)}});
  }
  ++num_repeated_;
  return "";
}

std::string CollectedLines::Text() const {
  std::string text;
  for (const auto& [frame, line] : lines_) text += line + "\n";
  return text;
}

std::string CollectedLines::Summary() const {
  std::string text = "frames: " + NumberText(lines_.size());
  if (!lines_.empty()) {
    const std::uint64_t first = lines_.begin()->first;
    const std::uint64_t last = lines_.rbegin()->first;
    text += ", from " + NumberText(first) + " to " + NumberText(last) + ", " +
            NumberText(last - first + 1 - lines_.size()) + " missing between";
  }
  return text + "; " + NumberText(num_repeated_) + " repeated datagrams";
}

}  // namespace railcast
