#pragma once

#include <string>

#include "core/program/options.h"
#include "generator/run/run_plan.h"

namespace railcast {

// Options that several commands share.

/// Adds the options that say how frames are written and made: `--format`, `--fields`, `--merged`,
/// `--certify`, `--threads` and `--isa`.
void AddRunChoices(ProgramOptions& command, RunChoices& choices);

/// Adds the option `--certify`, which CertifiedShareOf() reads.
Option AddCertify(ProgramOptions& command, std::string& certify);

/// Checks a list of fields, or the name of a layout of points. One that is none is a usage error
/// (FailUsage), like an unknown format.
void CheckFields(const std::string& fields);

}  // namespace railcast
