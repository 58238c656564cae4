#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/certify/certificate.h"
#include "core/certify/rungs_beside.h"
#include "core/certify/weighted_shares.h"
#include "railcast/fidelity.h"
#include "railcast/frame.h"

namespace railcast {

class Archive;

/// What a run's certificate says of the echoes of one part of the scene. Figures are absent where
/// fewer than kLeastEchoes echoes of all were drawn, or kLeastInRow of a class, range or object,
/// which are compared. Range errors are those of the found echoes, before range noise and without a
/// sign; errors of the power are |frame / reference - 1|.
struct CertifiedPart {
  static constexpr std::uint64_t kLeastEchoes = 10;
  static constexpr std::uint64_t kLeastInRow = 30;

  std::string name;                              ///< "all", a class, a range bin, an object.
  std::uint64_t echoes{};                        ///< Echoes of the reference that were drawn.
  std::optional<CertifiedFigure> missed{};       ///< Share of the reference's echoes.
  std::optional<CertifiedFigure> wrong{};        ///< False ones: share of the run's echoes.
  std::optional<CertifiedFigure> other_label{};  ///< Share of the found ones.
  std::optional<CertifiedFigure> range_p50_m{};
  std::optional<CertifiedFigure> range_p95_m{};
  std::optional<CertifiedFigure> power_p50{};
  std::optional<CertifiedFigure> power_p95{};
};
void Describe(Archive& a, CertifiedPart& s);

/// What another rung would have given, by the same firings.
struct CertifiedRung {
  std::string name;
  double cost{};  ///< In multiples of the run's own, by the table of costs.
  std::optional<CertifiedFigure> missed{};
  std::optional<CertifiedFigure> wrong{};
};
void Describe(Archive& a, CertifiedRung& s);

/// In how many frames a tolerance held by their certificates. In the others, which are usually
/// most, too few firings were drawn to tell.
struct CertifiedTolerance {
  std::uint32_t frames_within{};
  std::uint32_t frames_beyond{};
  bool is_within{};  ///< Whether the figures of the whole run are.
};
void Describe(Archive& a, CertifiedTolerance& s);

/// The numerical error of a run, by the certificates of its frames.
struct RunCertificate {
  double cost_share{};  ///< As it was asked for.
  std::uint32_t frames{};
  std::uint64_t firings{};
  std::uint64_t drawn{};
  /// Share of the firings in strata of which none was drawn.
  double without_drawn{};
  CertifiedPart all{};
  std::vector<CertifiedPart> classes{};  ///< Classes with drawn echoes; likewise below.
  std::vector<CertifiedPart> ranges{};
  std::vector<CertifiedPart> objects{};
  std::vector<CertifiedRung> rungs{};
  std::optional<CertifiedTolerance> tolerance{};  ///< Only with fidelity `auto`.
};
void Describe(Archive& a, RunCertificate& s);

/// How a run is certified, and what its figures are named by.
struct CertifySpec {
  double cost_share{};
  std::vector<RungBeside> rungs{};
  std::map<std::uint32_t, std::string> objects{};  ///< Names by instance.
  std::optional<ToleranceSpec> tolerance{};
  std::vector<std::uint32_t> tolerance_labels{};  ///< The labels of ToleranceSpec::of.
};

/// Adds up the certificates of a run's frames. They are kept, since figures need them all: some 100
/// bytes for each drawn firing.
class CertificateSums {
 public:
  explicit CertificateSums(CertifySpec spec) : spec_(std::move(spec)) {}

  void Add(const FrameCertificate& frame);
  [[nodiscard]] RunCertificate Result(const LabelTable& labels) const;

 private:
  using IsOf = std::function<bool(const CertifiedEcho&)>;
  [[nodiscard]] CertifiedPart PartOf(std::string name,
                                     const IsOf& is_of,
                                     std::uint64_t least = CertifiedPart::kLeastInRow) const;
  /// What the tolerance limits.
  [[nodiscard]] CertifiedPart PartOfTolerance() const;
  [[nodiscard]] CertifiedRung RungOf(std::size_t i) const;

  CertifySpec spec_;
  WeightedShares shares_;
  std::vector<DrawnFiring> drawn_;
  std::uint32_t num_frames_ = 0;
  std::uint32_t num_within_ = 0;
  std::uint32_t num_beyond_ = 0;
};

/// What a run's certificate says, a line each: its error, and what the rungs beside would give.
[[nodiscard]] std::string CertificateText(const RunCertificate& certificate);

}  // namespace railcast
