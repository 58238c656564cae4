#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "generator/run/run_plan.h"

namespace railcast {

// Options that several commands share.

/// Adds the options that say how frames are written and made: `--format`, `--fields`, `--merged`,
/// `--threads` and `--isa`.
void AddRunChoices(CLI::App& command, RunChoices& choices);

/// Checks a list of fields, or the name of a layout of points.
/// @throws CLI::ValidationError if `fields` is not a valid list: that is a usage error, like an
///   unknown format.
void CheckFields(const std::string& fields);

}  // namespace railcast
