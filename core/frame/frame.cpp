#include "core/frame/frame.h"

namespace railcast {

void Frame::Resize(std::uint32_t new_rows, std::uint32_t new_columns, std::uint32_t new_returns) {
  rows = new_rows;
  columns = new_columns;
  returns = new_returns;
  ForEachField(*this, [this](std::string_view, std::string_view, auto& values) {
    values.resize(num_slots());
  });
}

}  // namespace railcast
