#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "railcast/frame.h"

namespace railcast {

/// Expects that all fields of two frames are the same to the bit.
inline void ExpectSameBytes(const Frame& a, const Frame& b) {
  std::vector<std::pair<const void*, std::size_t>> fields;
  ForEachField(a, [&](std::string_view, std::string_view, const auto& values) {
    fields.emplace_back(values.data(), values.size() * sizeof(values[0]));
  });
  std::size_t next = 0;
  ForEachField(b, [&](std::string_view name, std::string_view, const auto& values) {
    const auto [data, size] = fields[next++];
    ASSERT_EQ(size, values.size() * sizeof(values[0])) << name;
    EXPECT_EQ(std::memcmp(data, values.data(), size), 0) << name;
  });
}

}  // namespace railcast
