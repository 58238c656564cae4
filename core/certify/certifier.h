#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/certify/certificate.h"
#include "core/certify/rungs_beside.h"
#include "railcast/frame.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// What of a frame is certified.
struct CertifiedRegion {
  std::vector<std::uint32_t> cells{};  ///< The firings' cells, ascending: others are left out.
  /// Only echoes of these objects are counted; of all things if it is empty.
  std::set<std::uint32_t> instances{};
  /// About how many firings are drawn; absent: as many as the share of the time is enough for if
  /// all firings take what those of the run do.
  std::optional<double> num_wanted{};
};

/// Certifies the frames of a simulator: draws some firings of each, makes them anew on rung
/// `reference`, in full scene detail as on that rung, and on those beside the run's own, in the
/// frame's own scene, with the same random draws, and compares their echoes before range noise.
///
/// Which firings are drawn depends on the sensor's seed, the frame's number and its own result
/// alone: by strata (Stratum), more of those of which experience says that they differ (Neyman
/// 1934). The probabilities are the same in all frames.
///
///     const Certifier certifier(scenario, 0.01, *simulator);
///     auto begun = simulator->Begin(42);
///     simulator->Scan(*begun, frame);
///     const FrameCertificate certificate = certifier.Certify(*simulator, *begun, frame);
class Certifier {
 public:
  /// Has the simulator make the variants that are needed.
  /// @param cost_share What the certificates may take, as a share of the frames' own time; > 0.
  /// @param simulator With the effects that its frames are made with.
  /// @throws InputError if these are those of rung `reference`.
  Certifier(const ScenarioSpec& scenario, double cost_share, Simulator& simulator);
  /// The overload for firings that no simulator makes.
  /// @param num_firings In a frame.
  Certifier(const ScenarioSpec& scenario,
            double cost_share,
            const DetectorSpec& own,
            std::size_t num_firings,
            const World& world);

  /// Thread-safe for different frames, as Simulator::Scan().
  /// @param simulator The same, with the same effects.
  /// @param frame As the simulator made it.
  /// @param region Null for all of it. A frame of ScanNearObjects() is certified as to these
  ///   objects, with the firings of FiringsNearObjects().
  [[nodiscard]] FrameCertificate Certify(Simulator& simulator,
                                         BegunFrame& begun,
                                         const Frame& frame,
                                         const CertifiedRegion* region = nullptr) const;

  /// Makes firings in each of variants(), as Simulator::ScanFirings().
  using ScanFirings =
      std::function<void(std::span<const std::uint32_t> cells, std::span<Frame> frames)>;
  /// The overload for firings that `scan` makes.
  [[nodiscard]] FrameCertificate Certify(const Frame& frame,
                                         const CertifiedRegion* region,
                                         const ScanFirings& scan) const;

  /// The reference, the run's own way, and those of rungs().
  [[nodiscard]] const std::vector<FiringVariant>& variants() const { return variants_; }
  /// The rungs beside the run's own, whose errors are found on the same firings.
  [[nodiscard]] const std::vector<RungBeside>& rungs() const { return rungs_; }
  /// About how many firings of a frame are drawn.
  [[nodiscard]] double num_expected() const { return num_expected_; }

 private:
  /// The standard deviation of what is wrong with its firings, as experience says.
  [[nodiscard]] double ScatterOf(const Stratum& stratum) const;

  std::uint64_t seed_;
  float match_distance_m_;
  std::set<std::uint32_t> vague_labels_;   ///< Labels of plants, wires and nets.
  std::set<std::uint32_t> object_labels_;  ///< Labels of the world's objects.
  std::vector<RungBeside> rungs_;
  std::vector<FiringVariant> variants_;
  double num_expected_{};
  double probability_per_scatter_{};
};

/// About how many firings of a frame a share of its time is enough for.
[[nodiscard]] double NumCertified(const ScenarioSpec& scenario,
                                  const DetectorSpec& own,
                                  std::size_t num_firings,
                                  double cost_share);

/// The most that may be asked for.
inline constexpr double kMostCertifiedPercent = 10'000.0;

/// The share of the time that `--certify` gives: 0.01 of "1%"; nothing of "off".
/// @throws InputError if it is neither.
[[nodiscard]] std::optional<double> CertifiedShareOf(const std::string& text);

}  // namespace railcast
