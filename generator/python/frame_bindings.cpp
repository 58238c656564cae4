#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/join.h"
#include "core/io/recording/recorded_motion.h"
#include "generator/python/bindings.h"
#include "railcast/enum_names.h"
#include "railcast/error.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

namespace py = pybind11;

using Shape = std::vector<py::ssize_t>;

// An array in the frame's own memory, which keeps the frame alive.
template <typename T>
py::array ViewOf(std::vector<T>& values, const Frame& frame, const py::object& owner) {
  using Number = std::conditional_t<std::is_enum_v<T>, std::uint8_t, T>;
  static_assert(sizeof(Number) == sizeof(T));
  return py::array_t<Number>(
      Shape{static_cast<py::ssize_t>(frame.rows), static_cast<py::ssize_t>(frame.width())},
      reinterpret_cast<Number*>(values.data()), owner);
}

std::vector<std::string> FieldsOf(const RecordedFrame& recorded) {
  std::vector<std::string> names;
  ForEachField(recorded.frame, [&](const char* name, const auto&...) {
    if (recorded.Has(name)) names.emplace_back(name);
  });
  for (const ForeignField& field : recorded.foreign) names.push_back(field.name);
  return names;
}

py::array FieldNamed(const py::object& self, const std::string& wanted) {
  auto& recorded = self.cast<RecordedFrame&>();
  Frame& frame = recorded.frame;
  py::object found = py::none();
  if (recorded.Has(wanted)) {
    ForEachField(frame, [&](const char* name, const char*, auto& values) {
      if (name == wanted) found = ViewOf(values, frame, self);
    });
  }
  for (ForeignField& field : recorded.foreign) {
    if (found.is_none() && field.name == wanted) found = ViewOf(field.values, frame, self);
  }
  if (!found.is_none()) return found;
  throw py::key_error("frame: must have the field, it has " + Join(FieldsOf(recorded)) + " (got " +
                      Quoted(wanted) + ")");
}

std::size_t NumPoints(const Frame& frame) {
  return static_cast<std::size_t>(
      std::count_if(frame.x.begin(), frame.x.end(), [](float x_m) { return !std::isnan(x_m); }));
}

py::array_t<bool> PointMask(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  py::array_t<bool> mask(
      Shape{static_cast<py::ssize_t>(frame.rows), static_cast<py::ssize_t>(frame.width())});
  std::transform(frame.x.begin(), frame.x.end(), mask.mutable_data(),
                 [](float x_m) { return !std::isnan(x_m); });
  return mask;
}

// Reads what is to be undone, and checks that the frame allows it.
Compensation CompensationOf(const RecordedFrame& recorded, const std::string& name) {
  const std::optional<Compensation> wanted = ValueNamed<Compensation>(name);
  if (!wanted) {
    throw InputError(
        {{"compensate", "must be one of " + Join(NamesOf<Compensation>()), Quoted(name)}});
  }
  if (recorded.axes == PointAxes::kOther && wanted != Compensation::kNone) {
    throw InputError({{"compensate",
                       "must be \"none\" for points that the scenario's output puts into other "
                       "axes than the sensor's",
                       Quoted(name)}});
  }
  const bool moves = recorded.axes == PointAxes::kSensorAtFiring && recorded.has_pose &&
                     recorded.frame.duration_ns > 0 && wanted != Compensation::kNone;
  if (moves && !recorded.Has("time_ns")) {
    throw InputError(recorded.name +
                     ": time_ns: must be among the fields to undo the motion of the scan");
  }
  if (moves && wanted == Compensation::kAll && !recorded.objects.empty() &&
      !recorded.Has("instance")) {
    throw InputError(recorded.name +
                     ": instance: must be among the fields to undo the motion of objects");
  }
  return *wanted;
}

py::array_t<float> Points(const RecordedFrame& recorded, const std::string& compensate) {
  const Frame& frame = recorded.frame;
  const RecordedMotion motion(recorded, CompensationOf(recorded, compensate));
  py::array_t<float> points(Shape{static_cast<py::ssize_t>(NumPoints(frame)), 3});
  float* to = points.mutable_data();
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isnan(frame.x[i])) continue;
    const Eigen::Vector3f point_m = motion.PointOf(i);
    to = std::copy_n(point_m.data(), 3, to);
  }
  return points;
}

py::array_t<double> BoxOf(const RecordedFrame& recorded,
                          const RecordedObject& object,
                          const std::string& compensate) {
  const Compensation wanted = CompensationOf(recorded, compensate);
  return MatrixArray(RecordedMotion(recorded, wanted).BoxOf(object));
}

py::object PoseOrNone(const RecordedFrame& recorded, const Transform& pose) {
  if (!recorded.has_pose) return py::none();
  return MatrixArray(pose);
}

py::object ScanPoses(const RecordedFrame& recorded) {
  if (!recorded.has_pose) return py::none();
  const Frame& frame = recorded.frame;
  std::vector<ScanPose> poses = {{0, frame.world_from_sensor}};
  poses.insert(poses.end(), frame.poses_between.begin(), frame.poses_between.end());
  if (frame.duration_ns > 0) poses.push_back({frame.duration_ns, frame.world_from_sensor_end});
  py::array_t<std::int64_t> times_ns(static_cast<py::ssize_t>(poses.size()));
  py::list matrices;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    times_ns.mutable_at(static_cast<py::ssize_t>(i)) = poses[i].time_ns;
    matrices.append(MatrixArray(poses[i].world_from_sensor));
  }
  return py::make_tuple(times_ns, py::module_::import("numpy").attr("stack")(matrices));
}

// The table of fields for the docstring, so that it stands in one place, ForEachField.
std::string FieldTable() {
  std::string table;
  ForEachPossibleField([&](const std::string& name, const std::string& unit, const auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    const std::string type =
        std::is_floating_point_v<T> ? "float32" : "uint" + std::to_string(8 * sizeof(T));
    table += "    " + name + std::string(26 - name.size(), ' ') + type +
             (unit.empty() ? "" : std::string(9 - type.size(), ' ') + unit) + "\n";
  });
  return table;
}

std::string FrameDoc() {
  return R"(One scan: arrays of shape (rows, width), with width = columns * returns.

    frame[name]   the array of a field, in the frame's own memory: nothing is copied, and
                  the array keeps the frame alive

Slot [row, column * returns + return_index] belongs to one return of one firing; row 0 is
the lowest channel. Slots without a point have NaN in x, y, z and range_m, and `outcome`
says why (OUTCOMES). Patterns and clouds that are no grids have one row. Points are in
the sensor's axes (x forward, y left, z up) at the time of each firing, those of KITTI's
clouds at the stamp; those of Simulator.scan() in the axes that the scenario's `output`
says. points(compensate="all") has them where the boxes are.

Fields:

)" + FieldTable() +
         R"(
A recording may lack some of them, and a cloud of another source may have fields of its
own, as float32: see `fields`. docs/files.md says what each one means.)";
}

using FrameClass = py::class_<RecordedFrame, std::shared_ptr<RecordedFrame>>;

void AddNumbers(FrameClass& frame) {
  const auto of_frame = [&](const char* name, auto member, const char* doc) {
    frame.def_property_readonly(
        name, [member](const RecordedFrame& self) { return self.frame.*member; }, doc);
  };
  of_frame("index", &Frame::index, "Number of the frame in its run.");
  of_frame("stamp_ns", &Frame::stamp_ns, "Simulation time of the first firing, in ns.");
  of_frame("duration_ns", &Frame::duration_ns, "Time from the stamp to the last firing, in ns.");
  of_frame("rows", &Frame::rows, "Number of channels; 1 where there is no grid.");
  of_frame("columns", &Frame::columns, "Number of azimuth steps.");
  of_frame("returns", &Frame::returns, "Slots per firing: 1, 2 or 3.");
  frame
      .def_property_readonly(
          "width", [](const RecordedFrame& self) { return self.frame.width(); },
          "columns * returns.")
      .def_property_readonly(
          "num_points", [](const RecordedFrame& self) { return NumPoints(self.frame); },
          "Number of slots that have a point.")
      .def_readonly("name", &RecordedFrame::name,
                    "Name in messages, such as that of its file; empty if simulated.")
      .def_readonly("is_grid", &RecordedFrame::is_grid,
                    "Whether slots are firings, so that those without a point are lost ones.");
}

void AddArrays(FrameClass& frame) {
  frame.def_property_readonly("fields", &FieldsOf, "Names of the fields that the frame has.")
      .def("__getitem__", &FieldNamed, py::arg("field"),
           R"(The array of a field, (rows, width), in the frame's own memory.

Raises KeyError if the frame lacks it.)")
      .def("__contains__",
           [](const RecordedFrame& self, const std::string& name) {
             const std::vector<std::string> names = FieldsOf(self);
             return std::find(names.begin(), names.end(), name) != names.end();
           })
      .def_property_readonly("has_point", &PointMask,
                             "Whether each slot has a point: bool, (rows, width).")
      .def("points", &Points, py::kw_only(), py::arg("compensate") = "none",
           R"(The points' x, y, z in m, without empty slots: float32, (num_points, 3), a copy. They
are in the order of frame[field][frame.has_point].

compensate: the motion during the scan that is undone, so that points are where they
    were at the stamp, as boxes are:
    "none"    none: each point is where its firing met something, in the axes that the
              sensor had then
    "sensor"  the sensor's, as a vehicle can that knows its own motion
    "all"     that of moving objects, too

Where pose or duration are not known there is nothing to undo. KITTI's clouds come with
the sensor's motion undone and have no times, so that all three are the same for them.
Raises InputError if the fields `time_ns` and `instance` are needed and missing.)")
      .def("sensor_from_box", &BoxOf, py::arg("object"), py::kw_only(),
           py::arg("compensate") = "all",
           R"(Centre and axes of an object's box where points(compensate) are: float64, (4, 4).

With "all" that is the box at the stamp. Otherwise the points of a moving object are
spread over its way while it was scanned, and the box is where it was at their mean time
(Object.points_time_ns); with "none" in the axes that the sensor had at that time. KITTI's
clouds have the boxes of "sensor".)");
}

void AddPlaces(FrameClass& frame) {
  frame
      .def_property_readonly(
          "world_from_sensor",
          [](const RecordedFrame& self) { return PoseOrNone(self, self.frame.world_from_sensor); },
          "Pose at the stamp in m, east-north-up: float64, (4, 4); None where it is not known.")
      .def_property_readonly(
          "world_from_sensor_end",
          [](const RecordedFrame& self) {
            return PoseOrNone(self, self.frame.world_from_sensor_end);
          },
          "Pose at the last firing: float64, (4, 4); None where it is not known.")
      .def_property_readonly("scan_poses", &ScanPoses,
                             R"(Times since the stamp in ns and poses, from the stamp to the last
firing: int64, (n,) and float64, (n, 4, 4). Poses at other times are interpolated. None where they
are not known.)")
      .def_property_readonly(
          "origin_m", [](const RecordedFrame& self) { return VectorArray(self.origin_m); },
          R"(Add it to positions to get those of the file, in m: float64, (3,). It is 0 unless the
file has them far from 0, as in a national grid.)")
      .def_readonly("objects", &RecordedFrame::objects,
                    R"(The objects within range, those of objects.jsonl. Empty for clouds of others
and for simulated frames that were not asked for them.)")
      .def_property_readonly(
          "certificate",
          [](const RecordedFrame& self) -> py::object {
            if (self.certificate_json.empty()) return py::none();
            return py::module_::import("json").attr("loads")(self.certificate_json);
          },
          R"(What the frame's numerical error rests on, `certificate` of its line in frames.jsonl:
dict; None where the run is not certified. "strata" are its firings by kind with their number and
the probability of each to be drawn, "drawn" are those that were made anew, with their echoes.)");
}

void AddFrame(py::module_& module) {
  FrameClass frame(module, "Frame");
  frame.doc() = FrameDoc();
  AddNumbers(frame);
  AddArrays(frame);
  AddPlaces(frame);
  frame.def("__repr__", [](const RecordedFrame& self) {
    return "Frame(index=" + std::to_string(self.frame.index) +
           ", rows=" + std::to_string(self.frame.rows) +
           ", width=" + std::to_string(self.frame.width()) +
           ", num_points=" + std::to_string(NumPoints(self.frame)) + ")";
  });
}

void AddObject(py::module_& module) {
  py::class_<RecordedObject>(module, "Object", "An object as seen in one frame, with its box.")
      .def_readonly("name", &RecordedObject::name, "Name in the scenario.")
      .def_readonly("type", &RecordedObject::type, "Type in the scenario, such as \"person\".")
      .def_readonly("label", &RecordedObject::label,
                    "Name of its label; in KITTI's format that of its points' class.")
      .def_readonly("instance", &RecordedObject::instance, "Its number in the field `instance`.")
      .def_property_readonly(
          "size_m", [](const RecordedObject& self) { return VectorArray(self.size_m); },
          "Length, width and height of the box in m: float64, (3,).")
      .def_property_readonly(
          "sensor_from_box",
          [](const RecordedObject& self) { return MatrixArray(self.sensor_from_box); },
          R"(Centre and axes of the box at the stamp, in the sensor's axes in m: float64, (4, 4).
Frame.sensor_from_box() has it where points are.)")
      .def_property_readonly(
          "velocity_world_mps",
          [](const RecordedObject& self) { return VectorArray(self.velocity_world_mps); },
          "Velocity of the box's centre in world axes, in m/s: float64, (3,).")
      .def_readonly("points", &RecordedObject::points, "Slots with a point on it.")
      .def_readonly(
          "points_time_ns", &RecordedObject::points_time_ns,
          R"(Mean time of these since the stamp, in ns; None without any, and in recordings of
programs that did not write it.)")
      .def_readonly("firings_visible", &RecordedObject::firings_visible,
                    "Firings of which a ray meets it first, detected or not.")
      .def_readonly("firings_alone", &RecordedObject::firings_alone,
                    "Firings of which a ray would meet it if nothing else stood there.")
      .def_readonly("occlusion", &RecordedObject::occlusion,
                    R"(The share of it that something else hides, 0 to 1; None where it would not be
visible even alone.)")
      .def("__repr__", [](const RecordedObject& self) {
        return "Object(name=" + Quoted(self.name) + ", label=" + Quoted(self.label) +
               ", points=" + std::to_string(self.points) + ")";
      });
}

}  // namespace

void AddFrameClasses(pybind11::module_& module) {
  AddObject(module);
  AddFrame(module);
  RefuseUnmade<RecordedObject>();
  RefuseUnmade<RecordedFrame>();
}

}  // namespace railcast
