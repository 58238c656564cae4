#include "core/program/command_line.h"

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <regex>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/json_rules.h"
#include "core/trace/trace_program.h"

namespace railcast {
namespace {

/// The program and those of its commands that the command line names.
std::vector<const CLI::App*> AppsInUse(const CLI::App* app) {
  std::vector<const CLI::App*> apps = {app};
  for (const CLI::App* command : app->get_subcommands()) apps.push_back(command);
  return apps;
}

/// The line for the first option or argument that neither the program nor its command has; empty if
/// there is none.
std::string UnknownArgument(const CLI::App* app) {
  constexpr bool kOfCommandsToo = true;
  std::vector<std::string> names;
  for (const CLI::App* in_use : AppsInUse(app)) {
    for (const CLI::Option* option : in_use->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  std::string surplus;
  for (const std::string& word : app->remaining(kOfCommandsToo)) {
    if (!word.starts_with("-") || word == "--") {
      if (surplus.empty()) surplus = "too many arguments (got " + word + ")";
      continue;
    }
    const std::string name = word.substr(0, word.find('='));
    const std::optional<std::string> nearest = Nearest(name, names);
    return "unknown option" + (nearest ? ", the nearest is " + *nearest : "") + " (got " + name +
           ")";
  }
  return surplus;
}

/// The line for a command that is none, or is missing; empty if there is one, or need not be.
std::string UnknownCommand(const CLI::App* app, const CLI::Error& error) {
  if (app->get_subcommands({}).empty() || !app->get_subcommands().empty()) return "";
  std::vector<std::string> names;
  for (const CLI::App* known : app->get_subcommands({})) names.push_back(known->get_name());
  const std::vector<std::string> words = app->remaining();
  const bool is_missing = words.empty() && error.get_name() == "RequiredError";
  if (is_missing) return "command: must be " + InWords(names) + " (got none)";
  if (words.empty() || words.front().starts_with('-')) return "";
  return Unknown("command", words.front(), names) + " (got " + words.front() + ")";
}

/// What CLI11 says of the options together and of numbers of values. What it says of single values
/// are our own rules.
std::string InOurForm(const std::string& said) {
  static const std::array<std::pair<std::regex, const char*>, 9> forms = {{
      {std::regex("^At least 1 option from \\[(.*),(.*)\\] is required$"),
       "$1 or $2: one is required (got none)"},
      {std::regex("^(.*) is required$"), "$1: is required (got none)"},
      {std::regex("^(.*) requires (.*)$"), "$1: must come with $2"},
      {std::regex("^(.*) excludes (.*)$"), "$1: must not come with $2"},
      {std::regex("^(.*): 1 required .*missing$"), "$1: must have a value (got none)"},
      {std::regex("^(.*): (.*) required .*missing$"), "$1: must have $2 values (got fewer)"},
      {std::regex("^(.*): At Most 1 required but received (.*)$"),
       "$1: must be given once (got $2 times)"},
      {std::regex("^(.*): (At Most|At least) (.*) required but received (.*)$"),
       "$1: must have $3 values (got $4)"},
      {std::regex("^(.*) was given a disallowed flag override$"), "$1: must have no value"},
  }};
  for (const auto& [theirs, ours] : forms) {
    if (std::regex_match(said, theirs)) return std::regex_replace(said, theirs, ours);
  }
  return said;
}

/// The line for a value that CLI11 could not convert: that of a flag, or of numbers for which there
/// is no rule of our own.
std::string Unconverted(const CLI::App* app, std::string_view said) {
  constexpr std::string_view kBefore = "Could not convert: ";
  const std::size_t end = said.find(" = ");
  if (!said.starts_with(kBefore) || end == said.npos) return std::string(said);
  const std::string name(said.substr(kBefore.size(), end - kBefore.size()));
  bool is_flag = false;
  for (const CLI::App* in_use : AppsInUse(app)) {
    const CLI::Option* const option = in_use->get_option_no_throw(name);
    is_flag = is_flag || (option != nullptr && option->get_items_expected_max() == 0);
  }
  return name + (is_flag ? ": must have no value" : ": must be numbers") + " (got " +
         std::string(said.substr(end + 3)) + ")";
}

}  // namespace

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

ValueRule Named(std::vector<std::string> names) {
  const std::string shown = CLI::IsMember(names).get_description();
  return {[rule = OneOf(std::move(names))](const std::string& text) {
            const std::optional<std::string> broken = Broken(rule, text);
            return broken ? *broken + " (got " + text + ")" : "";
          },
          shown};
}

void AddIsa(ProgramOptions& command, std::string& isa) {
  command
      .AddOption("--isa", isa,
                 "Instruction set for ray tracing, on which the last bits of ranges depend; "
                 "default: the machine's best")
      .Check(Named(IsaNames()));
}

std::string SayWhatIsWrong(const CLI::App* app, const CLI::Error& error) {
  std::string fault = UnknownCommand(app, error);
  if (fault.empty()) fault = UnknownArgument(app);
  if (fault.empty()) {
    const std::string kind = error.get_name();
    if (kind == "ConversionError") {
      fault = Unconverted(app, error.what());
    } else {
      fault = kind == "ValidationError" ? error.what() : InOurForm(error.what());
    }
  }
  return ShownLines(fault) + "\nRun with --help for more information.\n";
}

}  // namespace railcast
