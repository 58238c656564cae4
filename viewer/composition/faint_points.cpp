#include "viewer/composition/faint_points.h"

namespace railcast {

std::vector<bool> FaintPoints(const ShownFrame& shown, const std::set<std::uint32_t>& labels) {
  std::vector<bool> is_faint;
  if (labels.empty()) return is_faint;
  is_faint.reserve(shown.num_points());
  for (const std::uint32_t slot : shown.slots) {
    is_faint.push_back(!labels.contains(shown.frame().label[slot]));
  }
  return is_faint;
}

}  // namespace railcast
