#pragma once

#include <memory>
#include <string>

#include "core/extras/dds/participant.h"
#include "core/program/options.h"
#include "generator/live/live_options.h"
#include "railcast/scenario.h"

namespace railcast {

/// Adds the options `--domain`, `--interface` and `--receive-buffers`.
void AddRosOptions(ProgramOptions& command, RosOptions& options);

/// How the options, the scenario's interfaces and the environment say to take part in a domain.
/// @throws InputError if the environment names no domain.
[[nodiscard]] dds::ParticipantSpec ParticipantOf(const RosOptions& options, const Ros2Spec& spec);

/// Joins a domain.
/// @throws InputError "protocol ros2: ..." as dds::Join() does.
[[nodiscard]] std::unique_ptr<dds::Participant> JoinDomain(const dds::ParticipantSpec& spec);

/// Returns "domain 42, on loopback".
[[nodiscard]] std::string PlaceText(const dds::ParticipantSpec& spec);

}  // namespace railcast
