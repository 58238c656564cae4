#include "core/program/command_line.h"

#include <charconv>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/trace/trace_program.h"
#include "railcast/io/recording.h"

namespace railcast {

std::vector<std::filesystem::path> WithTopic(std::vector<std::filesystem::path> sources,
                                             const std::string& topic) {
  if (topic.empty()) return sources;
  std::size_t num_bags = 0;
  for (std::filesystem::path& source : sources) {
    if (!IsBagOfTopics(source)) continue;
    source = TopicOfBag(source, topic);
    ++num_bags;
  }
  if (num_bags > 0) return sources;
  throw InputError(
      "--topic: must come with a bag of ROS 2, .mcap, .db3 or a directory of them (got " +
      ShownPath(sources.front()) + ")");
}

std::optional<std::uint64_t> ParseWholeNumber(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string WholeNumberRule::operator()(std::string& text) const {
  const std::optional<std::uint64_t> number = ParseWholeNumber(text);
  if (!number || *number < at_least || *number > at_most) {
    return "must be a whole number from " + Range() + " (got " + text + ")";
  }
  text = std::to_string(*number);
  return "";
}

std::string WholeNumberRule::Range() const {
  std::string range = std::to_string(at_least);
  range.append(" to ").append(std::to_string(at_most));
  return range;
}

std::string NumberRule::operator()(const std::string& text) const {
  double number = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number);
  const bool is_number = error == std::errc{} && end == last;
  // NaN fails both comparisons.
  if (is_number && number >= at_least && number <= at_most) return "";
  return "must be a number from " + Range() + " (got " + text + ")";
}

std::string NumberRule::Range() const {
  std::string range = NumberText(at_least);
  range.append(" to ").append(NumberText(at_most));
  return range;
}

std::string NonEmptyRule(const std::string& text) {
  return text.empty() ? "must not be empty" : "";
}

void AddIsa(CLI::App& command, std::string& isa) {
  command
      .add_option("--isa", isa,
                  "Instruction set for ray tracing, on which the last bits of ranges depend; "
                  "default: the machine's best")
      ->check(CLI::IsMember(IsaNames()));
}

}  // namespace railcast
