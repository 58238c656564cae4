#include "core/io/recording/recording_extras.h"

#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

TEST(RecordingExtras, SayWhatThisBuildLacks) {
  EXPECT_EQ(MessageOf([] { (void)NeedExtra(RecordingExtras().verify_trace, "a.osi", "osi"); }),
            "a.osi: needs the extra osi, which is not installed (Debian package railcast-osi; to "
            "build it, "
            "-D RAILCAST_BUILD_OSI=ON)");
}

}  // namespace
}  // namespace railcast
