#include "railcast/io/stream.h"

#include <algorithm>

namespace railcast {

const StreamField* StreamHeader::Find(std::string_view name) const {
  const auto found = std::ranges::find(fields, name, &StreamField::name);
  return found == fields.end() ? nullptr : &*found;
}

std::uint32_t ReceivedFrame::num_lost_packets() const {
  std::uint32_t count = 0;
  for (const IndexRange& range : lost_packets) count += range.count;
  return count;
}

}  // namespace railcast
