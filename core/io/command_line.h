#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/option_rules.h"
#include "core/base/shown_text.h"
#include "core/scenario/json_rules.h"

// What the programs' command lines have in common.

namespace railcast {

/// Of an option that counts or numbers something.
[[nodiscard]] inline CLI::Validator Whole(const WholeNumberRule& rule) {
  return {rule, rule.Range()};
}

/// Of an option that measures something.
[[nodiscard]] inline CLI::Validator Number(const NumberRule& rule) {
  return {[rule](std::string& text) { return rule(text); }, rule.Range()};
}

/// Of an option that names a file or folder.
[[nodiscard]] inline CLI::Validator NonEmpty() {
  return {[](std::string& text) { return NonEmptyRule(text); }, ""};
}

/// The program and what the command line names of its commands.
[[nodiscard]] inline std::vector<const CLI::App*> AppsInUse(const CLI::App* app) {
  std::vector<const CLI::App*> apps = {app};
  for (const CLI::App* command : app->get_subcommands()) apps.push_back(command);
  return apps;
}

/// The line for the first option that neither the program nor its command has; empty if there is
/// none.
[[nodiscard]] inline std::string UnknownOption(const CLI::App* app) {
  constexpr bool kOfCommandsToo = true;
  std::vector<std::string> names;
  for (const CLI::App* in_use : AppsInUse(app)) {
    for (const CLI::Option* option : in_use->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  for (const std::string& word : app->remaining(kOfCommandsToo)) {
    if (!word.starts_with("--") || word == "--") continue;
    const std::string name = word.substr(0, word.find('='));
    const std::optional<std::string> nearest = Nearest(name, names);
    return "unknown option" + (nearest ? ", the nearest is " + *nearest : "") + " (got " + name +
           ")";
  }
  return "";
}

/// The line for a word that should be a command and is none; empty if there is a command, or no
/// word.
[[nodiscard]] inline std::string UnknownCommand(const CLI::App* app) {
  const std::vector<std::string> words = app->remaining();
  const bool has_word = !words.empty() && !words.front().starts_with('-');
  const bool lacks_command = !app->get_subcommands({}).empty() && app->get_subcommands().empty();
  if (!lacks_command || !has_word) return "";
  std::vector<std::string> names;
  for (const CLI::App* known : app->get_subcommands({})) names.push_back(known->get_name());
  return Unknown("command", words.front(), names) + " (got " + words.front() + ")";
}

/// For CLI::App::failure_message: CLI11 calls a misspelt command a missing one, and so it does with
/// an option that is required. Arguments are shown as ShownLines() shows them.
[[nodiscard]] inline std::string SayWhatIsWrong(const CLI::App* app, const CLI::Error& error) {
  for (const std::string& fault : {UnknownOption(app), UnknownCommand(app)}) {
    if (!fault.empty()) return ShownLines(fault) + "\nRun with --help for more information.\n";
  }
  return ShownLines(CLI::FailureMessage::simple(app, error));
}

}  // namespace railcast
