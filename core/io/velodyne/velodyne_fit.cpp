#include "core/io/velodyne/velodyne_encoder.h"

#include <cmath>
#include <string>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// Reports what in a scan does not fit one format.
class Fit {
 public:
  explicit Fit(const VelodyneFormat& format)
      : model_(*format.model), prefix_("--protocol " + std::string(format.name) + ": /lidar") {}

  void CheckPattern(const ScanSpec& scan) const {
    const auto* const pattern = std::get_if<SpinningSpec>(&scan.pattern);
    if (pattern == nullptr) Fail("/scan/pattern/type", "must be \"spinning\"");
    if (pattern->rotation != Rotation::kClockwise) {
      Fail("/scan/pattern/rotation", "must be \"clockwise\"", Quoted(NameOf(pattern->rotation)));
    }
    if (pattern->channels.size() != model_.lasers.size()) {
      Fail("/scan/pattern/channels",
           "must be " + NumberText(model_.lasers.size()) + " as " + std::string(model_.name) +
               " has",
           NumberText(pattern->channels.size()));
    }
    if (!model_.has_own_angles) {
      CheckNear("/scan/pattern/cycle_us", pattern->cycle_us, model_.cycle_us, kMaxTimeOffset_us);
      CheckChannels(pattern->channels);
    }
    CheckColumns(*pattern, scan.rate_hz);
  }

  [[noreturn]] void Fail(const std::string& place,
                         const std::string& rule,
                         const std::string& got = {}) const {
    throw InputError(prefix_ + place + ": " + rule + (got.empty() ? "" : " (got " + got + ")"));
  }

 private:
  void CheckNear(const std::string& place, double got, double expected, double tolerance) const {
    if (std::abs(got - expected) <= tolerance) return;
    Fail(place, "must be " + NumberText(expected) + " as of " + std::string(model_.name),
         NumberText(got));
  }

  void CheckChannels(const std::vector<ChannelSpec>& channels) const {
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const std::string place = "/scan/pattern/channels/" + NumberText(i);
      const ChannelSpec& laser = model_.lasers[i];
      CheckNear(place + "/elevation_deg", channels[i].elevation_deg, laser.elevation_deg,
                kMaxChannelOffset_deg);
      CheckNear(place + "/azimuth_deg", channels[i].azimuth_deg, laser.azimuth_deg,
                kMaxChannelOffset_deg);
      CheckNear(place + "/time_us", channels[i].time_us, laser.time_us, kMaxTimeOffset_us);
    }
  }

  void CheckColumns(const SpinningSpec& pattern, double rate_hz) const {
    const std::size_t in_block = model_.cycles_per_block();
    // The margin is for rounding: 1800 x 55.5555556 us is slightly more than 100 ms.
    const double fitting = std::floor(1e6 / (rate_hz * pattern.cycle_us) * (1.0 + 1e-6));
    const double most = fitting - std::fmod(fitting, static_cast<double>(in_block));
    if (pattern.columns == most) return;
    Fail("/scan/pattern/columns", "must be " + NumberText(most) + ", a whole turn",
         NumberText(pattern.columns));
  }

  const VelodyneModel& model_;
  std::string prefix_;
};

}  // namespace

void CheckFits(const VelodyneFormat& format, const ScanSpec& scan, ReturnMode return_mode) {
  const Fit fit(format);
  fit.CheckPattern(scan);
  const std::string got = Quoted(NameOf(return_mode));
  if (format.is_dual && return_mode != ReturnMode::kDual) {
    fit.Fail("/receiver/return_mode", "must be \"dual\"", got);
  }
  if (!format.is_dual && return_mode != ReturnMode::kStrongest &&
      return_mode != ReturnMode::kLast) {
    fit.Fail("/receiver/return_mode", "must be \"strongest\" or \"last\"", got);
  }
}

}  // namespace railcast
