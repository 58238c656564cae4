#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "railcast/frame.h"
#include "railcast/scene.h"

namespace railcast {

/// The number of items of a kind and how many of them match an item of the other side.
struct Matched {
  std::uint64_t num{};
  std::uint64_t num_matched{};

  void Count(bool is_matched) {
    ++num;
    num_matched += is_matched ? 1 : 0;
  }
  [[nodiscard]] std::uint64_t num_missed() const { return num - num_matched; }
  /// Matched share in [0, 1]; 1 if there are no items.
  [[nodiscard]] double share() const {
    return num == 0 ? 1.0 : static_cast<double>(num_matched) / static_cast<double>(num);
  }
  bool operator==(const Matched&) const = default;
};

/// The lower end of the 95 % interval of a share of which `num_found` of `num` were found: Wilson's
/// with continuity correction (Newcombe 1998, Stat. Med. 17, 857, method 4), because parts may have
/// few echoes. 0 if `num` is 0.
[[nodiscard]] double LeastShare(std::uint64_t num_found, std::uint64_t num);

/// What of a scene is compared for itself, since a mean over all echoes hides it.
struct ScenePart {
  enum class Kind { kRangeBin, kClass, kObject };
  Kind kind{};
  std::uint32_t id{};  ///< Number of the bin, label or instance.
  std::string name;    ///< "50 to 100 m", or the name of the class or object.

  bool operator==(const ScenePart&) const = default;
};

/// Width of the range bins.
inline constexpr double kRangeBin_m = 50.0;

/// The parts of a scene: range bins up to `range_max_m`, classes except `other_labels`, and objects
/// except the sensor's own vehicle.
[[nodiscard]] std::vector<ScenePart> MakeSceneParts(double range_max_m,
                                                    const LabelTable& labels,
                                                    const std::vector<std::uint32_t>& other_labels,
                                                    const std::vector<SceneObject>& objects);

/// The median of absolute errors.
struct MedianError {
  double median = std::numeric_limits<double>::quiet_NaN();  ///< NaN if there are no errors.
  /// Lower end of its 95 % interval, by ranks; 0 if there are too few errors.
  double least{};
};
[[nodiscard]] MedianError MedianOf(std::vector<float> errors);

/// The differences within one part. Echoes of the reference count for the part that they are of in
/// the reference, others for the part that they are of in the other frame.
struct PartDifference {
  ScenePart part;
  Matched reference_echoes;
  Matched echoes;
  MedianError range_m;    ///< As FrameDifference::range_m.
  MedianError intensity;  ///< As FrameDifference::intensity.
};

/// Where an echo is and what it is of.
struct EchoPlace {
  float range_m{};
  std::uint32_t label{};
  std::uint32_t instance{};
};

/// Accumulates differences by parts.
class PartsComparison {
 public:
  explicit PartsComparison(const std::vector<ScenePart>& parts);

  void CountReference(const EchoPlace& echo, bool is_matched);
  void CountOther(const EchoPlace& echo, bool is_matched);
  /// @param intensity_error NaN if either echo has no intensity.
  void AddErrors(const EchoPlace& reference, float range_error_m, float intensity_error);
  /// In the order of the parts, also of those without echoes.
  [[nodiscard]] std::vector<PartDifference> Result() const;

 private:
  template <typename Visit>
  void VisitPartsOf(const EchoPlace& echo, const Visit& visit);

  std::vector<PartDifference> differences_;
  std::vector<std::vector<float>> range_errors_m_;
  std::vector<std::vector<float>> intensity_errors_;
  std::size_t num_bins_{};  // The bins are the first parts.
  std::unordered_map<std::uint32_t, std::size_t> part_of_label_;
  std::unordered_map<std::uint32_t, std::size_t> part_of_instance_;
};

}  // namespace railcast
