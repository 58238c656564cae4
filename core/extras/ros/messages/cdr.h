#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/extras/ros/messages/message_type.h"
#include "core/extras/ros/messages/named_fields.h"

namespace railcast::ros {

// The encoding of messages on the wire and in bags: plain CDR, version 1 (OMG DDSI-RTPS 2.3, 10;
// CORBA 3.0, 15.3). A header of four bytes tells the byte order; every number is aligned to its
// size, counted from after that header; a string is its length with the final NUL (u32), its bytes
// and the NUL; a sequence is its length (u32) and its elements, an array the elements alone.

namespace cdr {

static_assert(std::endian::native == std::endian::little);

inline constexpr std::size_t kHeaderSize = 4;
/// Readers of DDS round a message's length up to whole words.
inline constexpr std::size_t kMaxPadding = 3;

template <typename T>
inline constexpr bool kIsNumber = std::is_arithmetic_v<T>;
/// Whether a run of such values is the same bytes in memory and on a little-endian wire.
template <typename T>
inline constexpr bool kIsPlain = kIsNumber<T> && !std::is_same_v<T, bool>;

/// Appends values to a message.
class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  template <typename T>
  void Put(const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      bytes_.push_back(std::byte{value});
    } else if constexpr (kIsNumber<T>) {
      PutRun(&value, 1);
    } else {
      VisitFields(value, [this](std::string_view, const auto& field) { this->Put(field); });
    }
  }
  void Put(const std::string& text);
  template <std::size_t kMaxLength>
  void Put(const BoundedString<kMaxLength>& bounded) {
    Check(bounded.text.size() <= kMaxLength, "a string of a message keeps to its limit");
    Put(bounded.text);
  }
  template <typename T>
  void Put(const std::vector<T>& values) {
    Put(SizeOf(values.size()));
    PutAll(values.data(), values.size());
  }
  template <typename T, std::size_t kSize>
  void Put(const std::array<T, kSize>& values) {
    PutAll(values.data(), kSize);
  }

 private:
  [[nodiscard]] static std::uint32_t SizeOf(std::size_t size);
  void PutRaw(const void* values, std::size_t size, std::size_t alignment);

  template <typename T>
  void PutRun(const T* values, std::size_t num) {
    // An empty run is not aligned either.
    if (num > 0) PutRaw(values, num * sizeof(T), sizeof(T));
  }
  template <typename T>
  void PutAll(const T* values, std::size_t num) {
    if constexpr (kIsPlain<T>) {
      PutRun(values, num);
    } else {
      for (std::size_t i = 0; i < num; ++i) Put(values[i]);
    }
  }

  std::vector<std::byte>& bytes_;
};

/// The least length of a value, by which a hostile length is refused before memory is reserved.
template <typename T>
[[nodiscard]] std::size_t MinSize() {
  if constexpr (kIsNumber<T>) {
    return sizeof(T);
  } else if constexpr (requires { T::kName; }) {
    static const std::size_t size = [] {
      std::size_t sum = 0;
      T message;
      VisitFields(message, [&sum](std::string_view, auto& field) {
        sum += MinSize<std::remove_cvref_t<decltype(field)>>();
      });
      return sum;
    }();
    return size;
  } else if constexpr (message_type::Element<T>::kArraySize > 0) {
    return message_type::Element<T>::kArraySize *
           MinSize<typename message_type::Element<T>::Type>();
  } else {
    return sizeof(std::uint32_t);
  }
}

/// Takes values off a message.
class Reader {
 public:
  /// @param name Of the message's type, for messages about errors.
  /// @throws InputError unless the header is that of plain CDR.
  Reader(std::string_view name, std::span<const std::byte> bytes);

  template <typename T>
  void Take(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = *TakeRaw(1, 1) != std::byte{0};
    } else if constexpr (kIsNumber<T>) {
      TakeRun(&value, 1);
    } else {
      VisitFields(value, [this](std::string_view, auto& field) { this->Take(field); });
    }
  }
  void Take(std::string& text);
  template <std::size_t kMaxLength>
  void Take(BoundedString<kMaxLength>& bounded) {
    Take(bounded.text);
    CheckLength(bounded.text.size(), kMaxLength);
  }
  template <typename T>
  void Take(std::vector<T>& values) {
    const std::size_t num = TakeCount(MinSize<T>());
    values.resize(num);
    TakeAll(values.data(), num);
  }
  template <typename T, std::size_t kSize>
  void Take(std::array<T, kSize>& values) {
    TakeAll(values.data(), kSize);
  }

  /// @throws InputError if more than padding is left.
  void CheckAtEnd() const;

 private:
  [[noreturn]] void Refuse(const std::string& rule) const;
  void CheckLength(std::size_t length, std::size_t max_length) const;
  /// The next bytes, after those that align them.
  [[nodiscard]] const std::byte* TakeRaw(std::size_t size, std::size_t alignment);
  /// The length of a sequence whose elements have at least `min_size` bytes.
  [[nodiscard]] std::size_t TakeCount(std::size_t min_size);

  template <typename T>
  void TakeRun(T* values, std::size_t num) {
    if (num == 0) return;
    std::memcpy(values, TakeRaw(num * sizeof(T), sizeof(T)), num * sizeof(T));
    if constexpr (sizeof(T) > 1) {
      if (is_big_endian_) std::for_each(values, values + num, [](T& value) { Swap(value); });
    }
  }
  template <typename T>
  static void Swap(T& value) {
    auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    std::ranges::reverse(bytes);
    value = std::bit_cast<T>(bytes);
  }
  template <typename T>
  void TakeAll(T* values, std::size_t num) {
    if constexpr (kIsPlain<T>) {
      TakeRun(values, num);
    } else {
      for (std::size_t i = 0; i < num; ++i) Take(values[i]);
    }
  }

  std::string_view name_;
  std::span<const std::byte> body_;  ///< Without the header.
  std::size_t at_ = 0;
  bool is_big_endian_ = false;
};

}  // namespace cdr

/// Encodes a message, little-endian, with CDR's header.
template <typename Message>
[[nodiscard]] std::vector<std::byte> ToCdr(const Message& message) {
  std::vector<std::byte> bytes = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  cdr::Writer(bytes).Put(message);
  return bytes;
}

/// Decodes a message of either byte order.
/// @throws InputError "sensor_msgs/msg/Image: rule (got value)" if the bytes are not one.
template <typename Message>
[[nodiscard]] Message FromCdr(std::span<const std::byte> bytes) {
  cdr::Reader reader(Message::kName, bytes);
  Message message;
  reader.Take(message);
  reader.CheckAtEnd();
  return message;
}

}  // namespace railcast::ros
