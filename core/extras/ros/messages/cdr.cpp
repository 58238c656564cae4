#include "core/extras/ros/messages/cdr.h"

#include <limits>

#include "core/base/text.h"

namespace railcast::ros::cdr {
namespace {

// The second byte of a header of plain CDR, version 1. The first is 0.
constexpr std::byte kBigEndian{0};
constexpr std::byte kLittleEndian{1};

std::size_t BytesToAlign(std::size_t at, std::size_t alignment) {
  return (alignment - at % alignment) % alignment;
}

}  // namespace

std::uint32_t Writer::SizeOf(std::size_t size) {
  Check(size <= std::numeric_limits<std::uint32_t>::max(),
        "a message's sequences have 32-bit sizes");
  return static_cast<std::uint32_t>(size);
}

void Writer::PutRaw(const void* values, std::size_t size, std::size_t alignment) {
  bytes_.resize(bytes_.size() + BytesToAlign(bytes_.size() - kHeaderSize, alignment));
  const auto* const first = static_cast<const std::byte*>(values);
  bytes_.insert(bytes_.end(), first, first + size);
}

void Writer::Put(const std::string& text) {
  Put(SizeOf(text.size() + 1));
  PutRaw(text.c_str(), text.size() + 1, 1);
}

Reader::Reader(std::string_view name, std::span<const std::byte> bytes) : name_(name) {
  if (bytes.size() < kHeaderSize) {
    Refuse("must begin with CDR's header of 4 bytes" + Got(bytes.size()));
  }
  if (bytes[0] != std::byte{0} || (bytes[1] != kBigEndian && bytes[1] != kLittleEndian)) {
    Refuse("must be plain CDR, whose header begins with 0 0 or 0 1 (got " +
           NumberText(std::to_integer<int>(bytes[0])) + " " +
           NumberText(std::to_integer<int>(bytes[1])) + ")");
  }
  is_big_endian_ = bytes[1] == kBigEndian;
  body_ = bytes.subspan(kHeaderSize);
}

void Reader::Refuse(const std::string& rule) const {
  throw InputError(std::string(name_) + ": " + rule);
}

void Reader::CheckLength(std::size_t length, std::size_t max_length) const {
  if (length <= max_length) return;
  Refuse("a string must have at most " + NumberText(max_length) + " characters" + Got(length));
}

const std::byte* Reader::TakeRaw(std::size_t size, std::size_t alignment) {
  const std::size_t begin = at_ + BytesToAlign(at_, alignment);
  if (begin > body_.size() || size > body_.size() - begin) {
    Refuse("must have " + NumberText(size) + " bytes from byte " + NumberText(kHeaderSize + begin) +
           " on" + Got(kHeaderSize + body_.size()));
  }
  at_ = begin + size;
  return body_.data() + begin;
}

std::size_t Reader::TakeCount(std::size_t min_size) {
  std::uint32_t num = 0;
  Take(num);
  const std::size_t most = (body_.size() - at_) / min_size;
  if (num > most) {
    Refuse("a sequence at byte " + NumberText(kHeaderSize + at_ - sizeof num) +
           " must have at most " + NumberText(most) + " elements" + Got(num));
  }
  return num;
}

void Reader::Take(std::string& text) {
  const std::size_t size = TakeCount(1);
  text.clear();
  // Some writers leave out the NUL of an empty string.
  if (size == 0) return;
  const std::byte* const first = TakeRaw(size, 1);
  if (first[size - 1] != std::byte{0}) {
    Refuse("a string must end in NUL before byte " + NumberText(kHeaderSize + at_));
  }
  text.assign(reinterpret_cast<const char*>(first), size - 1);
}

void Reader::CheckAtEnd() const {
  if (body_.size() - at_ <= kMaxPadding) return;
  Refuse("must have at most " + NumberText(kHeaderSize + at_ + kMaxPadding) + " bytes" +
         Got(kHeaderSize + body_.size()));
}

}  // namespace railcast::ros::cdr
