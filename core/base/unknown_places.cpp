#include "core/base/unknown_places.h"

namespace railcast {

bool UnknownPlaces::IsKnown(std::string_view pointer) const {
  const std::string within = std::string(pointer) + '/';
  const auto first = pointers_.lower_bound(within);
  if (first != pointers_.end() && first->starts_with(within)) return false;
  for (std::string_view outer = pointer;; outer = outer.substr(0, outer.rfind('/'))) {
    if (pointers_.contains(outer)) return false;
    if (outer.find('/') == std::string_view::npos) return true;
  }
}

}  // namespace railcast
