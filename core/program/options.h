#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): a library's
class App;
class Option;
}  // namespace CLI

namespace railcast {

/// A rule for the text of an option's value, and how `--help` shows it.
struct ValueRule {
  /// Returns the broken rule, or an empty string if none is broken. May replace the text by what is
  /// to be converted.
  std::function<std::string(std::string& text)> broken;
  std::string shown;  ///< For example "1 to 65535"; may be empty.
};

/// An option of a command line, as ProgramOptions returns it. A reference to it that is copied;
/// each function returns the option itself, so that calls can be chained.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option Check(const ValueRule& rule) const;  ///< For each of its values.
  Option Required() const;
  Option Needs(Option other) const;
  Option Excludes(Option other) const;
  Option NumValues(int number) const;  ///< Number of values of one occurrence.
  Option NumValues(int at_least, int at_most) const;
  Option SeparatedBy(char delimiter) const;  ///< Its values may be one word.
  Option MayRepeat() const;                  ///< The values of all occurrences are taken.
  Option TakesOneWord() const;               ///< Words after its value are not further values.
  Option ShowDefault() const;                ///< In `--help`: the variable's value now.
  Option ShowType(const std::string& type) const;
  Option Description(const std::string& text) const;

  [[nodiscard]] std::string name() const;
  [[nodiscard]] bool is_given() const;

 private:
  CLI::Option* option_;
};

/// The options of a program or of one of its commands. A reference to them that is copied; it is
/// valid as long as the program parses or runs. Only one source includes CLI11, whose templates are
/// most of what a command would compile.
///
///     ProgramOptions world = program.AddCommand("world", "Write the scene as a mesh");
///     world.AddOption("--out", options->out, "File to write").Required().Check(NonEmpty());
///     world.WhenParsed([&command, options] { command = ...; });
class ProgramOptions {
 public:
  explicit ProgramOptions(CLI::App* app) : app_(app) {}

  /// Adds an option that fills `value`, a text, number or path, a std::optional of one, or a
  /// std::vector of them.
  /// @param names For example "--out", "-v,--verbose", or "scenario" for an argument without a
  /// name.
  template <typename T>
  Option AddOption(const std::string& names, T& value, const std::string& description = "");
  /// Adds an option whose text `use` gets.
  Option AddText(const std::string& names,
                 const std::function<void(const std::string& text)>& use,
                 const std::string& description);
  Option AddFlag(const std::string& names, bool& value, const std::string& description);
  Option AddFlag(const std::string& names, const std::string& description);  ///< For is_given().

  /// Adds options of which one must be given.
  [[nodiscard]] ProgramOptions AddOneOf(const std::string& title);
  [[nodiscard]] ProgramOptions AddCommand(const std::string& name, const std::string& description);
  /// Adds a command that takes all further words as they are, also `--help`: another program's.
  [[nodiscard]] ProgramOptions AddForeignCommand(const std::string& name,
                                                 const std::string& description);
  /// One of the commands added after this must be named. What a command does not know is the
  /// program's: `--version` may follow it.
  void RequireCommand();
  void WhenParsed(
      const std::function<void()>& use);  ///< The command was named and its options are sound.
  void CheckTogether(
      const std::function<void()>& check);  ///< All options of the program have been parsed.
  void Footer(const std::string& text);     ///< The last lines of `--help`.

  [[nodiscard]] bool is_given(const std::string& name) const;
  [[nodiscard]] std::string TextOf(const std::string& name) const;  ///< Text of a given option.
  [[nodiscard]] std::vector<Option> options() const;
  [[nodiscard]] std::vector<std::string> Remaining() const;  ///< The words of a foreign command.

 private:
  CLI::App* app_;
};

/// Ends the parsing because values do not go together: a usage error, as where a rule is broken.
[[noreturn]] void FailUsage(const std::string& option, const std::string& rule);
[[noreturn]] void FailUsage(const std::string& fault);

}  // namespace railcast
