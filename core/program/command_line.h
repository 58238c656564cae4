#pragma once

// Helpers that the command lines of all programs share.
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/recording/source_choice.h"
#include "core/program/options.h"

namespace CLI {
class Error;
}  // namespace CLI

namespace railcast {

/// Returns a word of a shell's command line, quoted where necessary.
[[nodiscard]] inline std::string ShellWord(std::string_view text) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./,:=+@%-";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string_view::npos) {
    return std::string(text);
  }
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  word += "'";
  return word;
}

// Rules for the values of command-line options, in the form that Option::Check takes: functions of
// the option's text that return the broken rule, or an empty string if none is broken. All programs
// share them, so that every program reads a number the same way.

/// Parses a whole number in its plain form: decimal digits and nothing else. Leading zeros are
/// ignored, as in the names of frames: "000030" is 30. Returns nothing if the text is not such a
/// number or exceeds 64 bits.
[[nodiscard]] std::optional<std::uint64_t> ParseWholeNumber(std::string_view text);

/// For Option::Check. CLI11 itself reads 010 as octal and wraps -1 around, so the text is
/// replaced by the plain digits of its number.
struct WholeNumberRule {
  std::uint64_t at_least = 0;
  std::uint64_t at_most = std::numeric_limits<std::uint64_t>::max();

  [[nodiscard]] std::string operator()(std::string& text) const;
  [[nodiscard]] std::string Range() const;  ///< "1 to 65535".
};

/// For Option::Check: a decimal number. CLI11 itself also accepts 0x10, and NaN in any range.
struct NumberRule {
  double at_least{};
  double at_most{};

  [[nodiscard]] std::string operator()(const std::string& text) const;
  [[nodiscard]] std::string Range() const;
};

/// For the name of a file or folder, which is empty where the shell expands an unset variable.
[[nodiscard]] std::string NonEmptyRule(const std::string& text);

/// For an option that is a count or an index.
[[nodiscard]] inline ValueRule Whole(const WholeNumberRule& rule) {
  return {rule, rule.Range()};
}

/// For an option that is a measured quantity.
[[nodiscard]] inline ValueRule Number(const NumberRule& rule) {
  return {[rule](std::string& text) { return rule(text); }, rule.Range()};
}

/// For an option that names a file or folder.
[[nodiscard]] inline ValueRule NonEmpty() {
  return {[](std::string& text) { return NonEmptyRule(text); }, ""};
}

/// For an option that is one of these names.
[[nodiscard]] ValueRule Named(std::vector<std::string> names);

/// Adds the option --summary.
inline void AddSummaryFile(ProgramOptions& command, std::optional<std::filesystem::path>& file) {
  command
      .AddOption("--summary", file,
                 "File to write what the run did to when it has ended, as one line of JSON")
      .Check(NonEmpty());
}

/// Adds the option --threads.
inline Option AddThreads(ProgramOptions& command,
                         int& num_threads,
                         const std::string& description = "Number of threads; 0 = all cores") {
  return command.AddOption("--threads", num_threads, description)
      .Check(Whole({0, 1024}))
      .ShowDefault();
}

/// Adds the option --isa.
void AddIsa(ProgramOptions& command, std::string& isa);

/// Adds the options --columns, --kitti-columns, --topic and --frame-id, for WithChoice().
inline void AddSourceChoice(ProgramOptions& command, SourceChoice& choice) {
  command
      .AddOption(
          "--columns", choice.columns,
          "Names of the columns of clouds in text, such as x,y,z,_,intensity, where _ is one "
          "that is not used; default: those of the file's header, else x,y,z")
      .Check(NonEmpty());
  command
      .AddOption("--kitti-columns", choice.kitti_columns,
                 "Columns of points in .bin files: nuscenes, waymo, float64, or the number of "
                 "float32 columns, of which x y z intensity come first; default: the four of "
                 "KITTI")
      .Check(NonEmpty());
  command
      .AddOption("--topic", choice.topic,
                 "Topic to read of sources that are bags of ROS 2; needed only where a bag has "
                 "several with points")
      .Check(NonEmpty());
  command
      .AddOption("--frame-id", choice.frame_id,
                 "frame_id of the clouds or packets to read of a topic; needed only where it has "
                 "those of several sensors. Where these share one, frame_id#channel")
      .Check(NonEmpty());
}

/// Adds the option --sensor of SourceChoice, for commands without one of their own.
inline void AddCaptureSensor(ProgramOptions& command, std::string& sensor) {
  command
      .AddOption(
          "--sensor", sensor,
          "ADDRESS or ADDRESS:PORT of the sensor to read of sources that are captures; needed "
          "only where a capture holds several")
      .Check(NonEmpty());
}

/// For CLI::App::failure_message: what is wrong, in the form of all messages, with the nearest name
/// where a command or an option is unknown. Arguments are shown as ShownLines() shows them.
[[nodiscard]] std::string SayWhatIsWrong(const CLI::App* app, const CLI::Error& error);

}  // namespace railcast
