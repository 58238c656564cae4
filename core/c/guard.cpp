#include "core/c/guard.h"

#include <exception>
#include <new>

#include "core/base/out_of_memory.h"
#include "railcast/error.h"

namespace railcast {
namespace {

thread_local std::string last_error;
// What LastError() returns: the text above, or a constant where memory does not suffice for it.
thread_local const char* last_error_text = "";

void Keep(const char* message) noexcept {
  try {
    last_error = message;
    last_error_text = last_error.c_str();
  } catch (const std::bad_alloc&) {
    last_error_text = "out of memory";
  }
}

}  // namespace

railcast_status StatusOfException() noexcept {
  try {
    throw;
  } catch (const InputError& error) {
    Keep(error.what());
    return IsOutOfMemory(error) ? RAILCAST_OUT_OF_MEMORY : RAILCAST_BAD_INPUT;
  } catch (const ArgumentError& error) {
    Keep(error.what());
    return RAILCAST_BAD_ARGUMENT;
  } catch (const CallbackError& error) {
    Keep(error.what());
    return RAILCAST_BAD_CALLBACK;
  } catch (const std::bad_alloc&) {
    FreeMemoryReserve();
    Keep("out of memory");
    return RAILCAST_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    Keep(error.what());
  } catch (...) {
    Keep("an exception of unknown type");
  }
  return RAILCAST_INTERNAL_ERROR;
}

const char* LastError() noexcept {
  return last_error_text;
}

}  // namespace railcast
