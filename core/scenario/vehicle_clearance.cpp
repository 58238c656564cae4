#include "core/scenario/vehicle_clearance.h"

#include <iomanip>
#include <set>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/object_contacts.h"

namespace railcast {
namespace {

std::string DepthText(double gap_m) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << -gap_m << " m";
  return text.str();
}

}  // namespace

void CheckVehicleIsClear(const ScenarioSpec& scenario,
                         const World& world,
                         const ScanPattern& pattern,
                         std::uint32_t first_frame,
                         std::uint32_t last_frame) {
  if (scenario.vehicle.may_overlap) return;
  const std::int64_t last_stamp_ns = pattern.StampNs(last_frame);
  ContactFinder finder(world);
  std::set<std::size_t> met;
  ErrorList errors;
  for (std::uint32_t frame = first_frame;; ++frame) {
    const std::int64_t stamp_ns = pattern.StampNs(frame);
    for (const ObjectContact& contact : finder.FindOfVehicle(stamp_ns)) {
      const std::size_t object = world.objects()[contact.one].is_ego ? contact.other : contact.one;
      if (!contact.is_overlap() || !met.insert(object).second) continue;
      errors.AddLine(scenario.sources.Place("/vehicle") +
                     ": must not be inside an object unless may_overlap is true (got " +
                     DepthText(contact.gap_m) + " inside " + Quoted(world.objects()[object].name) +
                     " at frame " + std::to_string(frame) + " (" + SecondsText(stamp_ns) + "))");
    }
    if (frame == last_frame || AreStillBetween(world, stamp_ns, last_stamp_ns)) break;
  }
  errors.ThrowIfAny();
}

}  // namespace railcast
