#pragma once

namespace railcast {

/// A section of the line.
struct ChainageRange {
  double begin_s_m{};
  double end_s_m{};
};

}  // namespace railcast
