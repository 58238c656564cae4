#pragma once

#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "core/base/error.h"

namespace railcast {

/// "out of memory while reading wall.obj (42311802 bytes)": what could not be made, and how large
/// it is.
[[nodiscard]] InputError OutOfMemory(const std::string& doing);

/// "no thread can be started while ...": the system's limit of threads, or memory for their stacks.
[[nodiscard]] InputError OutOfThreads(const std::string& doing);

/// For WithinMemory: "reading wall.obj (42311802 bytes)".
[[nodiscard]] std::string ReadingText(const std::filesystem::path& file);

/// What `make` returns. To be put around whatever grows with its input, so that a run which does
/// not fit into the machine ends with a line that says what did not:
///
///     WithinMemory([&] { return ReadingText(file); }, [&] { return Read(file); });
///
/// @param doing Gives the words after "while"; called only on failure. The innermost place wins.
/// @throws InputError if `make` runs out of memory or cannot start a thread.
template <typename Doing, typename Make>
decltype(auto) WithinMemory(const Doing& doing, const Make& make) {
  try {
    return make();
  } catch (const std::bad_alloc&) {
    throw OutOfMemory(doing());
  } catch (const std::length_error&) {
    // What exceeds even a container's greatest size.
    throw OutOfMemory(doing());
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) throw;
    throw OutOfThreads(doing());
  }
}

/// A thread that does `work`. @param doing As WithinMemory() takes it.
/// @throws InputError "no thread can be started while hearing commands".
template <typename Work>
[[nodiscard]] std::thread StartThread(const std::string& doing, const Work& work) {
  return WithinMemory([&] { return doing; }, [&] { return std::thread(work); });
}

}  // namespace railcast
