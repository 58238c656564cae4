#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/base/option_rules.h"
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

/// For CLI::App::failure_message of a program with commands: CLI11 calls a misspelt command a
/// missing one.
[[nodiscard]] inline std::string SayWhatIsWrong(const CLI::App* app, const CLI::Error& error) {
  const std::vector<std::string> words = app->remaining();
  const bool has_word = !words.empty() && !words.front().starts_with('-');
  if (!app->get_subcommands().empty() || !has_word) return CLI::FailureMessage::simple(app, error);
  std::vector<std::string> names;
  for (const CLI::App* known : app->get_subcommands({})) names.push_back(known->get_name());
  return Unknown("command", words.front(), names) + " (got " + words.front() +
         ")\nRun with --help for more information.\n";
}

}  // namespace railcast
