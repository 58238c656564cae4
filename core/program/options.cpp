#include "core/program/options.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace railcast {

Option Option::Check(const ValueRule& rule) const {
  // CLI11 gives a transformation the text that it may change, and a check a copy of it.
  option_->transform(CLI::Validator(rule.broken, rule.shown));
  return *this;
}

Option Option::Required() const {
  option_->required();
  return *this;
}

Option Option::Needs(Option other) const {
  option_->needs(other.option_);
  return *this;
}

Option Option::Excludes(Option other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::NumValues(int number) const {
  option_->expected(number);
  return *this;
}

Option Option::NumValues(int at_least, int at_most) const {
  option_->expected(at_least, at_most);
  return *this;
}

Option Option::SeparatedBy(char delimiter) const {
  option_->delimiter(delimiter);
  return *this;
}

Option Option::MayRepeat() const {
  option_->take_all();
  return *this;
}

Option Option::TakesOneWord() const {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::ShowDefault() const {
  option_->capture_default_str();
  return *this;
}

Option Option::ShowType(const std::string& type) const {
  option_->type_name(type);
  return *this;
}

Option Option::Description(const std::string& text) const {
  option_->description(text);
  return *this;
}

std::string Option::name() const {
  return option_->get_name();
}

bool Option::is_given() const {
  return option_->count() > 0;
}

template <typename T>
Option ProgramOptions::AddOption(const std::string& names,
                                 T& value,
                                 const std::string& description) {
  return Option(app_->add_option(names, value, description));
}

// The values that options have.
using OptionText = const std::string&;
template Option ProgramOptions::AddOption(OptionText, int&, OptionText);
template Option ProgramOptions::AddOption(OptionText, double&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::uint16_t&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::uint32_t&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::uint64_t&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::string&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::filesystem::path&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::optional<double>&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::optional<std::uint16_t>&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::optional<std::uint32_t>&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::optional<std::uint64_t>&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::optional<std::string>&, OptionText);
template Option ProgramOptions::AddOption(OptionText,
                                          std::optional<std::filesystem::path>&,
                                          OptionText);
template Option ProgramOptions::AddOption(OptionText, std::vector<double>&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::vector<int>&, OptionText);
template Option ProgramOptions::AddOption(OptionText, std::vector<std::string>&, OptionText);
template Option ProgramOptions::AddOption(OptionText,
                                          std::vector<std::filesystem::path>&,
                                          OptionText);

Option ProgramOptions::AddText(const std::string& names,
                               const std::function<void(const std::string& text)>& use,
                               const std::string& description) {
  return Option(app_->add_option_function<std::string>(names, use, description));
}

Option ProgramOptions::AddFlag(const std::string& names,
                               bool& value,
                               const std::string& description) {
  return Option(app_->add_flag(names, value, description));
}

Option ProgramOptions::AddFlag(const std::string& names, const std::string& description) {
  return Option(app_->add_flag(names)->description(description));
}

ProgramOptions ProgramOptions::AddOneOf(const std::string& title) {
  CLI::Option_group* const group = app_->add_option_group(title);
  group->require_option(1, 0);
  return ProgramOptions(group);
}

ProgramOptions ProgramOptions::AddCommand(const std::string& name, const std::string& description) {
  return ProgramOptions(app_->add_subcommand(name, description));
}

ProgramOptions ProgramOptions::AddForeignCommand(const std::string& name,
                                                 const std::string& description) {
  CLI::App* const command = app_->add_subcommand(name, description);
  command->prefix_command()->fallthrough(false)->set_help_flag();
  return ProgramOptions(command);
}

void ProgramOptions::RequireCommand() {
  app_->require_subcommand(1);
  app_->fallthrough();
}

void ProgramOptions::WhenParsed(const std::function<void()>& use) {
  app_->callback(use);
}

void ProgramOptions::CheckTogether(const std::function<void()>& check) {
  app_->final_callback(check);
}

void ProgramOptions::Footer(const std::string& text) {
  app_->footer(text);
}

bool ProgramOptions::is_given(const std::string& name) const {
  return app_->count(name) > 0;
}

std::string ProgramOptions::TextOf(const std::string& name) const {
  return app_->get_option(name)->as<std::string>();
}

std::vector<Option> ProgramOptions::options() const {
  std::vector<Option> options;
  for (CLI::Option* const option : app_->get_options({})) options.emplace_back(option);
  return options;
}

std::vector<std::string> ProgramOptions::Remaining() const {
  return app_->remaining();
}

void FailUsage(const std::string& option, const std::string& rule) {
  throw CLI::ValidationError(option, rule);
}

void FailUsage(const std::string& fault) {
  throw CLI::ValidationError(fault);
}

}  // namespace railcast
