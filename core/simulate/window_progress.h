#pragma once

#include <cstddef>
#include <functional>

namespace railcast {

/// Told while a window is built: how many of its steps, chunks most of them, are done; the last
/// call is with all of them. What it throws ends the building, and is thrown to whoever waits for
/// the window. Several threads may call it at once.
using WindowProgress = std::function<void(std::size_t num_done, std::size_t num_steps)>;

}  // namespace railcast
