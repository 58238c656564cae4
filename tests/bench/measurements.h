#pragma once

#include "core/program/program.h"

namespace railcast {

// The commands of railcast-measure, each in the source of its name: what it measures is told there.
void AddScaling(ProgramOptions& app, ProgramCommand& command);
void AddStages(ProgramOptions& app, ProgramCommand& command);
void AddRebuild(ProgramOptions& app, ProgramCommand& command);
void AddDetail(ProgramOptions& app, ProgramCommand& command);
void AddMeshes(ProgramOptions& app, ProgramCommand& command);
void AddModules(ProgramOptions& app, ProgramCommand& command);
void AddSettings(ProgramOptions& app, ProgramCommand& command);

}  // namespace railcast
