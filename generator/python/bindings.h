#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

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

}  // namespace railcast
