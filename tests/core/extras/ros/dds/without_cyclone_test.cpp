#include <gtest/gtest.h>

#include "core/extras/ros/dds/participant.h"
#include "tests/core/io/message_of.h"

// Linked with without_cyclone.cpp, as programs are that are built without Cyclone DDS.

namespace railcast {
namespace {

TEST(WithoutCyclone, JoiningADomainSaysWhatIsMissing) {
  EXPECT_EQ(MessageOf([] { static_cast<void>(dds::Join({})); }),
            "needs a railcast that was built with Cyclone DDS, Debian's package cyclonedds-dev "
            "(got one without)");
}

}  // namespace
}  // namespace railcast
