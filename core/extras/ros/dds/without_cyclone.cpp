#include "core/base/error.h"
#include "core/extras/ros/dds/participant.h"

// Takes the place of cyclone_participant.cpp in programs that are built without Cyclone DDS.

namespace railcast::dds {

std::unique_ptr<Participant> Join(const ParticipantSpec& /*spec*/) {
  throw InputError(
      "needs a railcast that was built with Cyclone DDS, Debian's package cyclonedds-dev (got one "
      "without)");
}

}  // namespace railcast::dds
