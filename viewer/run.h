#pragma once

#include "viewer/options.h"

namespace railcast {

/// Carries out what the command line asks for.
/// @throws InputError with one line if something cannot be read, shown or written.
void RunViewer(const ViewOptions& options);

}  // namespace railcast
