#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace railcast {

/// What a process may take.
struct ProcessLimits {
  std::uint64_t memory_bytes{};  ///< Beyond what it begins with.
  std::uint64_t time_s{};        ///< Time of computing.
};

/// How a process ended, and with what.
struct ProcessEnd {
  enum class Kind {
    kDone,        ///< `bytes` are the work's result.
    kFault,       ///< The work threw an InputError, whose lines `bytes` are.
    kLackMemory,  ///< It took more memory than its limit.
    kLackTime,
    kBroken,  ///< It was ended by anything else, as by an overflow of its stack.
  };
  Kind kind = Kind::kBroken;
  std::string bytes{};
};

/// Does `work` in a process of its own, a copy of this one, and waits for its end. It is for
/// libraries that a file can bring down: those that recurse as deep as the file wants, or ask for
/// as much memory. The copy has the memory of this process and nothing else: no other threads, no
/// output, and the signals' default handlers. `work` must not need any of them.
///
/// A process of its own rather than a check of the file beforehand, because the check would have to
/// know the file's format as well as the library does, and every way to bring that down.
///
/// @throws InputError "no process can be started: reason".
/// @throws std::bad_alloc if the memory that the system leaves to this process itself is less than
///   the limit, and did not suffice.
[[nodiscard]] ProcessEnd RunLimited(const ProcessLimits& limits,
                                    const std::function<std::string()>& work);

}  // namespace railcast
