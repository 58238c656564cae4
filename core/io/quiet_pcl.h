#pragma once

// Includes what PCL's headers write messages with, and drops those messages. Include it before all
// other headers of PCL, in sources only. PCL warns of single neighbourhoods that it cannot use, in
// its own format; our figures account for them already. Without messages nothing that we use of PCL
// is in its shared libraries, so that no program has to load them.

#include <pcl/console/print.h>

#undef PCL_LOG_STREAM
#define PCL_LOG_STREAM(LEVEL, STREAM, CSTR, ATTR, FG, ARGS) static_cast<void>(0)
#undef PCL_ERROR
#define PCL_ERROR(...) static_cast<void>(0)
#undef PCL_WARN
#define PCL_WARN(...) static_cast<void>(0)
#undef PCL_INFO
#define PCL_INFO(...) static_cast<void>(0)
#undef PCL_DEBUG
#define PCL_DEBUG(...) static_cast<void>(0)
#undef PCL_VERBOSE
#define PCL_VERBOSE(...) static_cast<void>(0)

namespace pcl::console {
inline constexpr bool kHasMessages = false;
}
#define isVerbosityLevelEnabled(LEVEL) kHasMessages
