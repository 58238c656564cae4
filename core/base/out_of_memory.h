#pragma once

#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "core/base/error.h"

namespace railcast {

/// The error "out of memory while reading wall.obj (42311802 bytes)". `doing` names what did not
/// fit and its size.
[[nodiscard]] InputError OutOfMemory(const std::string& doing);

/// The error "no thread can be started while ...": the system's thread limit is reached, or there
/// is no memory for another stack.
[[nodiscard]] InputError OutOfThreads(const std::string& doing);

/// Whether one of the faults is OutOfMemory() or OutOfThreads().
[[nodiscard]] bool IsOutOfMemory(const InputError& error);

/// Frees a small block that the program keeps for the case that even the message about lacking
/// memory finds none. Thread-safe.
void FreeMemoryReserve();

/// The text "reading wall.obj (42311802 bytes)" for WithinMemory.
[[nodiscard]] std::string ReadingText(const std::filesystem::path& file);

/// Returns what `make` returns, and reports running out of memory as an InputError. Wrap it around
/// everything whose size depends on the input, so that a run that does not fit into memory ends
/// with a message naming the cause:
///
///     WithinMemory([&] { return ReadingText(file); }, [&] { return Read(file); });
///
/// @param doing Returns the words after "while"; called only on failure. If calls are nested, the
///   innermost one supplies the text.
/// @throws InputError if `make` runs out of memory or cannot start a thread.
template <typename Doing, typename Make>
decltype(auto) WithinMemory(const Doing& doing, const Make& make) {
  try {
    return make();
  } catch (const std::bad_alloc&) {
    FreeMemoryReserve();
    throw OutOfMemory(doing());
  } catch (const std::length_error&) {
    // The requested size exceeds even the maximum size of a container.
    throw OutOfMemory(doing());
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) throw;
    throw OutOfThreads(doing());
  }
}

/// Starts a thread that runs `work`.
/// @param doing Words after "while", as for WithinMemory().
/// @throws InputError such as "no thread can be started while hearing commands".
template <typename Work>
[[nodiscard]] std::thread StartThread(const std::string& doing, const Work& work) {
  return WithinMemory([&] { return doing; }, [&] { return std::thread(work); });
}

}  // namespace railcast
