#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text.h"
#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

// The parts of the Python module. Each adds its classes, whose docstrings are the reference.
void AddFrameClasses(pybind11::module_& module);
void AddRecordingClass(pybind11::module_& module);
void AddSimulatorClass(pybind11::module_& module);

/// A transform as a 4 x 4 array of float64.
[[nodiscard]] inline pybind11::array_t<double> MatrixArray(const Transform& transform) {
  pybind11::array_t<double> array({4, 4});
  auto values = array.mutable_unchecked<2>();
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      values(row, column) = transform.matrix()(row, column);
    }
  }
  return array;
}

/// A vector as 3 float64.
[[nodiscard]] inline pybind11::array_t<double> VectorArray(const Vector3& vector) {
  return pybind11::array_t<double>(3, vector.data());
}

/// Labels as a dict of their ids by name.
[[nodiscard]] inline pybind11::dict LabelDict(const LabelTable& labels) {
  pybind11::dict ids;
  for (const Label& label : labels.labels()) ids[pybind11::str(label.name)] = label.id;
  return ids;
}

/// What Python's own parser makes of a JSON text.
[[nodiscard]] inline pybind11::object ParsedJson(const std::string& text) {
  return pybind11::module_::import("json").attr("loads")(text);
}

/// JSON text of what Python holds.
[[nodiscard]] inline std::string JsonText(const pybind11::object& value) {
  return pybind11::module_::import("json").attr("dumps")(value).cast<std::string>();
}

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
