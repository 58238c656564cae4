#pragma once

namespace railcast {

/// Thrown where a run that was told to stop is in the middle of a frame. It is no fault: the run
/// ends in order without that frame.
struct RunStopped {};

}  // namespace railcast
