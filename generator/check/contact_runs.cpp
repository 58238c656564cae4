#include "generator/check/contact_runs.h"

#include <algorithm>
#include <map>
#include <utility>

namespace railcast {

std::vector<ContactRun> FindContactRuns(const World& world,
                                        const ScanPattern& pattern,
                                        std::uint32_t last_frame) {
  ContactFinder finder(world);
  std::vector<ContactRun> runs;
  // The run of each pair that is in contact in the latest frame, as an index.
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> open;
  for (std::uint32_t frame = 0;; ++frame) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> still_open;
    for (const ObjectContact& contact : finder.FindAll(pattern.StampNs(frame))) {
      const std::pair pair{contact.one, contact.other};
      const auto known = open.find(pair);
      const std::size_t index = known == open.end() ? runs.size() : known->second;
      if (known == open.end()) runs.push_back({frame, frame, frame, contact});
      ContactRun& run = runs[index];
      run.last_frame = frame;
      if (contact.gap_m < run.nearest.gap_m) {
        run.nearest = contact;
        run.nearest_frame = frame;
      }
      still_open.emplace(pair, index);
    }
    open = std::move(still_open);
    if (frame == last_frame) return runs;
    if (AreStillBetween(world, pattern.StampNs(frame), pattern.StampNs(last_frame))) break;
  }
  for (const auto& [pair, index] : open) runs[index].last_frame = last_frame;
  return runs;
}

}  // namespace railcast
