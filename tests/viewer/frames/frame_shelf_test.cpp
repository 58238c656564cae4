#include "viewer/frames/shown_frame.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

constexpr std::size_t kSlots = 1000;

/// A frame of `num_slots` slots with a point in each.
std::shared_ptr<const ShownFrame> Full(std::size_t num_slots, std::size_t num_foreign = 0) {
  RecordedFrame recorded;
  recorded.frame.Resize(1, static_cast<std::uint32_t>(num_slots), 1);
  recorded.foreign.resize(num_foreign, {"curvature", std::vector<float>(num_slots)});
  return std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)));
}

TEST(NumBytesOf, IsWhatAFrameTakesPerSlotAndPoint) {
  // Per slot: x, y, z, intensity, power_ratio, range_m, time_ns, column, label, instance,
  // true_range_m, incidence_rad, footprint_share and mixed_share of 4 bytes; ring and material of
  // 2; return_index, return_count and outcome of 1. Per point: x, y, z and the slot.
  constexpr std::size_t kPerSlot = 14 * 4 + 2 * 2 + 3;
  constexpr std::size_t kPerPoint = 16;
  EXPECT_EQ(NumBytesOf(*Full(kSlots)) - NumBytesOf(*Full(0)), kSlots * (kPerSlot + kPerPoint));
}

TEST(NumBytesOf, CountsForeignFields) {
  EXPECT_EQ(NumBytesOf(*Full(kSlots, 3)) - NumBytesOf(*Full(kSlots)), kSlots * 3 * 4);
}

TEST(FrameShelf, KeepsWhatItsBytesAllow) {
  const std::size_t each = NumBytesOf(*Full(kSlots));
  FrameShelf shelf({.num_bytes = 3 * each});
  for (std::size_t place = 0; place < 3; ++place) shelf.Put(place, Full(kSlots));
  EXPECT_EQ(shelf.size(), 3U);
  EXPECT_EQ(shelf.num_bytes(), 3 * each);
  shelf.Put(3, Full(1));
  EXPECT_EQ(shelf.Find(0), nullptr);
  for (std::size_t place = 1; place < 4; ++place) EXPECT_TRUE(shelf.Find(place)) << place;
  EXPECT_EQ(shelf.num_bytes(), 2 * each + NumBytesOf(*Full(1)));
}

TEST(FrameShelf, KeepsTheLastHoweverLarge) {
  FrameShelf shelf({.num_bytes = 1});
  const auto last = Full(kSlots);
  shelf.Put(0, Full(kSlots));
  shelf.Put(1, last);
  EXPECT_EQ(shelf.Find(0), nullptr);
  EXPECT_EQ(shelf.Find(1), last);
  EXPECT_EQ(shelf.num_bytes(), NumBytesOf(*last));
}

TEST(FrameShelf, KeepsNoMoreFramesThanItMay) {
  FrameShelf shelf({.num_frames = 2});
  for (std::size_t place = 0; place < 5; ++place) shelf.Put(place, Full(1));
  EXPECT_EQ(shelf.size(), 2U);
  EXPECT_EQ(shelf.Find(2), nullptr);
  EXPECT_TRUE(shelf.Find(3));
}

TEST(FrameShelf, KeepsWhatWasUsedLast) {
  FrameShelf shelf({.num_frames = 2});
  shelf.Put(0, Full(1));
  shelf.Put(1, Full(1));
  EXPECT_TRUE(shelf.Use(0));
  shelf.Put(2, Full(1));
  EXPECT_TRUE(shelf.Find(0));
  EXPECT_EQ(shelf.Find(1), nullptr);
  EXPECT_EQ(shelf.Use(1), nullptr);
}

TEST(FrameShelf, ForgetsTheOldestWhatWasFoundOnly) {
  FrameShelf shelf({.num_frames = 2});
  shelf.Put(0, Full(1));
  shelf.Put(1, Full(1));
  EXPECT_TRUE(shelf.Find(0));
  shelf.Put(2, Full(1));
  EXPECT_EQ(shelf.Find(0), nullptr);
}

}  // namespace
}  // namespace railcast
