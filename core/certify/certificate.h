#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/certify/strata.h"
#include "railcast/enum_names.h"

namespace railcast {

class Archive;

// What is known of a frame's numerical error: some of its firings, drawn at random, were made anew
// in the same scene by rung `reference` and by the rungs beside its own (docs/certificate.md).

/// How an echo of the frame and one of the reference go together (MatchEchoes()).
enum class EchoVerdict {
  kFound,   ///< Both have it.
  kMissed,  ///< Only the reference has it.
  kFalse,   ///< Only the frame has it.
};
template <>
inline constexpr auto kEnumNames<EchoVerdict> =
    std::to_array<EnumName<EchoVerdict>>({{EchoVerdict::kFound, "found"},
                                          {EchoVerdict::kMissed, "missed"},
                                          {EchoVerdict::kFalse, "false"}});

/// An echo of a surface in a drawn firing. Label, instance and range are the reference's, or the
/// frame's where only that has it.
struct CertifiedEcho {
  EchoVerdict verdict{};
  std::uint32_t label{};
  std::uint32_t instance{};
  double range_m{};                       ///< True range.
  std::optional<double> range_error_m{};  ///< |frame - reference| before range noise; if found.
  /// Received power, frame / reference; if found and both have one.
  std::optional<double> power{};
  bool has_other_label{};  ///< Whether the frame gives it another label; if found.

  bool operator==(const CertifiedEcho&) const = default;
};
void Describe(Archive& a, CertifiedEcho& s);

/// How many echoes of a firing go together in another rung.
struct VerdictCounts {
  std::uint32_t found{};
  std::uint32_t missed{};
  std::uint32_t wrong{};  ///< False ones.

  bool operator==(const VerdictCounts&) const = default;
};
void Describe(Archive& a, VerdictCounts& s);

/// A firing that was drawn.
struct DrawnFiring {
  std::uint32_t cell{};     ///< row * columns + column.
  std::uint32_t stratum{};  ///< Index into FrameCertificate::strata.
  std::vector<CertifiedEcho> echoes{};
  std::vector<VerdictCounts> rungs{};  ///< For the rungs beside the run's own, in their order.

  bool operator==(const DrawnFiring&) const = default;
};
void Describe(Archive& a, DrawnFiring& s);

/// The firings of a frame in one stratum.
struct StratumCount : Stratum {
  std::uint64_t firings{};
  double probability{};  ///< With which each of them is drawn.

  bool operator==(const StratumCount&) const = default;
};
void Describe(Archive& a, StratumCount& s);

/// What a frame's certificate rests on.
struct FrameCertificate {
  std::vector<StratumCount> strata{};  ///< All that the frame has, as they come.
  std::vector<DrawnFiring> drawn{};    ///< By cell.

  bool operator==(const FrameCertificate&) const = default;
};
void Describe(Archive& a, FrameCertificate& s);

}  // namespace railcast
