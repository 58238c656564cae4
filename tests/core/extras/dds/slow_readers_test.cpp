#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>

#include "core/extras/dds/participant.h"
#include "tests/core/extras/dds/fast_dds.h"
#include "tests/core/extras/dds/free_domain.h"
#include "tests/core/extras/dds/reader_process.h"

namespace railcast {
namespace {

constexpr const char* kType = "sensor_msgs::msg::dds_::PointCloud2_";
constexpr std::size_t kNumMessages = 60;  // Three times as many as a writer keeps.
constexpr std::size_t kMessage_bytes = 100'000;

/// A writer with a good reader, and another reader in a process of its own.
class BesideAnother : public testing::Test {
 protected:
  void Start(int delay_ms) {
    writer_ = participant_->AddWriter({.name = "/points", .type = kType, .hash = ""});
    good_ = &others_.Read("rt/points", kType);
    another_ = std::make_unique<ReaderProcess>(domain_, "rt/points", kType, delay_ms);
    ASSERT_EQ(another_->WaitForLine(), "ready");
    ASSERT_TRUE(WaitUntilTrue([&] { return participant_->NumReaders(writer_) == 2; }));
    ASSERT_TRUE(good_->WaitForWriter());
  }
  /// Writes messages one after another; each must be taken at once and reach the good reader.
  void WriteAll() {
    MessageBytes message(kMessage_bytes);
    for (std::size_t i = 0; i < kNumMessages; ++i) {
      message[4] = static_cast<std::byte>(i);
      EXPECT_TRUE(participant_->Write(writer_, message)) << i;
      ASSERT_EQ(good_->WaitFor(i + 1).size(), i + 1);
      EXPECT_EQ(good_->WaitFor(i + 1).back(), message) << i;
    }
  }

  std::uint32_t domain_ = FreeDomain();
  std::unique_ptr<dds::Participant> participant_ =
      dds::Join({.domain = domain_, .node = "railcast"});
  FastParticipant others_{domain_};
  std::size_t writer_{};
  FastReader* good_ = nullptr;
  std::unique_ptr<ReaderProcess> another_;
};

TEST_F(BesideAnother, ASlowReaderDelaysNobody) {
  Start(/*delay_ms=*/300);
  WriteAll();
  EXPECT_THAT(another_->WaitForLine(), testing::StartsWith("100000 "));
}

TEST_F(BesideAnother, AStoppedReaderDelaysNobodyAndGoesOnLater) {
  Start(0);
  another_->Signal(SIGSTOP);
  WriteAll();
  another_->Signal(SIGCONT);
  EXPECT_THAT(another_->WaitForLine(), testing::StartsWith("100000 "));
}

TEST_F(BesideAnother, AKilledReaderDelaysNobody) {
  Start(0);
  another_->Signal(SIGKILL);
  WriteAll();
}

}  // namespace
}  // namespace railcast
