#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>

namespace railcast {

/// Frees the interpreter's lock for as long as it lives, so that other threads of Python run
/// meanwhile.
///
/// When Python ends, threads that it does not wait for (daemon=True) may be in such work, and one
/// that asks for the lock after that would be ended in the middle of C++. Therefore the end waits
/// for work in progress, which ends early where IsInterrupted() is asked, and its threads stay
/// here.
class OutsideInterpreter {
 public:
  OutsideInterpreter();
  ~OutsideInterpreter();
  OutsideInterpreter(const OutsideInterpreter&) = delete;
  OutsideInterpreter& operator=(const OutsideInterpreter&) = delete;

 private:
  PyThreadState* state_;
};

/// Whether work in progress is to end: Ctrl-C was pressed, of which only Python's main thread
/// learns, or Python is ending. To be called within OutsideInterpreter.
[[nodiscard]] bool IsInterrupted();

/// Has Python call us when it ends or forks. To be called once, before the first
/// OutsideInterpreter.
void WatchInterpreter();

/// Makes the use of an instance that __new__ made without __init__ a TypeError; pybind11 would take
/// fresh memory for the object that is missing. To be called after the class is defined.
template <typename T>
void RefuseUnmade() {
  pybind11::detail::get_type_info(typeid(T))->operator_new = [](std::size_t) -> void* {
    throw pybind11::type_error(
        "self: must be an object that railcast made (got one that __new__ alone made)");
  };
}

}  // namespace railcast
