#include <gtest/gtest.h>

#include "core/extras/osi/sensor_view.h"
#include "tests/core/io/message_of.h"

// Linked with without_protobuf.cpp, as programs are that are built without protobuf.

namespace railcast {
namespace {

TEST(WithoutProtobuf, MakingATraceSaysWhatIsMissing) {
  EXPECT_EQ(MessageOf([] { static_cast<void>(osi::ProtobufVersion()); }),
            "needs a railcast that was built with protobuf, Debian's packages libprotobuf-dev and "
            "protobuf-compiler (got one without)");
}

}  // namespace
}  // namespace railcast
