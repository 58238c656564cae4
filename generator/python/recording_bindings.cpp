#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "generator/python/bindings.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

/// The recording behind `railcast.Recording`: frames one after another or, where their number is
/// known, by their place. Thread-safe; frames are read and decoded at the same time.
class IndexedRecording {
 public:
  /// @throws InputError as OpenRecording().
  explicit IndexedRecording(std::filesystem::path source)
      : source_(std::move(source)), recording_(OpenRecording(source_)) {}

  [[nodiscard]] const std::filesystem::path& source() const { return source_; }
  [[nodiscard]] const RecordingInfo& info() const { return recording_->info(); }
  [[nodiscard]] const std::shared_ptr<RemarkLog>& remarks() const { return info().remarks; }

  /// Returns the frame at a place, or nothing beyond the last one.
  /// @throws InputError if its file cannot be read or is damaged.
  [[nodiscard]] std::shared_ptr<RecordedFrame> At(std::size_t place) {
    std::optional<Recording::FrameReader> read;
    {
      const std::lock_guard lock(mutex_);
      while (readers_.size() <= place) {
        auto next = recording_->Next();
        if (!next) return nullptr;
        readers_.push_back(std::move(*next));
      }
      read = readers_[place];
    }
    return std::make_shared<RecordedFrame>((*read)());
  }

 private:
  std::filesystem::path source_;
  std::unique_ptr<Recording> recording_;
  std::mutex mutex_;
  std::vector<Recording::FrameReader> readers_;  // Readers of the frames so far.
};

/// One pass over a recording, which keeps nothing of the frames before.
class RecordingPass {
 public:
  /// @param remarks Receives those of this pass at its end.
  RecordingPass(const std::filesystem::path& source, std::shared_ptr<RemarkLog> remarks)
      : remarks_(std::move(remarks)), recording_(OpenRecording(source)) {}
  RecordingPass(const RecordingPass&) = delete;
  RecordingPass& operator=(const RecordingPass&) = delete;
  ~RecordingPass() { remarks_->AddAll(*recording_->info().remarks); }

  /// The next frame, or nothing at the end.
  [[nodiscard]] std::shared_ptr<RecordedFrame> Next() {
    const std::lock_guard lock(mutex_);
    const auto read = recording_->Next();
    if (read) return std::make_shared<RecordedFrame>((*read)());
    remarks_->AddAll(*recording_->info().remarks);
    return nullptr;
  }

 private:
  std::shared_ptr<RemarkLog> remarks_;
  std::unique_ptr<Recording> recording_;
  std::mutex mutex_;
};

namespace py = pybind11;

std::size_t LengthOf(const IndexedRecording& recording) {
  if (recording.info().num_frames) return *recording.info().num_frames;
  throw py::type_error(
      "recording: must be one whose number of frames is known before its end, "
      "which that of a capture is not");
}

std::shared_ptr<RecordedFrame> FrameAt(IndexedRecording& recording, py::ssize_t place) {
  const auto length = static_cast<py::ssize_t>(LengthOf(recording));
  const py::ssize_t from_begin = place < 0 ? place + length : place;
  std::shared_ptr<RecordedFrame> frame;
  if (from_begin >= 0 && from_begin < length) {
    const OutsideInterpreter outside;
    frame = recording.At(static_cast<std::size_t>(from_begin));
  }
  if (frame) return frame;
  throw py::index_error("frame: must be >= 0 and < " + std::to_string(length) + Got(place));
}

std::shared_ptr<RecordedFrame> NextOf(RecordingPass& pass) {
  std::shared_ptr<RecordedFrame> frame;
  {
    const OutsideInterpreter outside;
    frame = pass.Next();
  }
  if (!frame) throw py::stop_iteration();
  return frame;
}

py::list RemarkList(const RemarkLog& log) {
  py::list list;
  for (const Remark& remark : log.List()) {
    py::dict item;
    item["name"] = remark.type().name;
    item["number"] = remark.number;
    item["place"] = remark.place;
    item["text"] = remark.Text();
    list.append(item);
  }
  return list;
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
void AddRecordingClass(pybind11::module_& module) {
  py::class_<RecordingPass>(module, "_RecordingPass", "One pass over a recording.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &NextOf);
  RefuseUnmade<RecordingPass>();
  py::class_<IndexedRecording>(
      module, "Recording",
      R"(Frames of a sequence, of cloud files or of a capture, in order of time: open() makes it.

    for frame in recording: ...     one pass, which keeps no frame
    recording[i], len(recording)    not for captures, whose length only their end tells

Several threads may read frames at once; the interpreter's lock is released meanwhile.
Raises InputError for a file that cannot be read or is damaged.)")
      .def("__iter__",
           [](const IndexedRecording& self) {
             const OutsideInterpreter outside;
             return std::make_unique<RecordingPass>(self.source(), self.remarks());
           })
      .def("__len__", &LengthOf)
      .def("__getitem__", &FrameAt, py::arg("index"), "The frame at a place, from 0.")
      .def_property_readonly("path", &IndexedRecording::source, "What was opened.")
      .def_property_readonly(
          "kind", [](const IndexedRecording& self) { return self.info().kind; },
          "What it is: \"sequence\", \"point cloud file\", \"capture of VLP-16\", ...")
      .def_property_readonly(
          "remarks", [](const IndexedRecording& self) { return RemarkList(*self.remarks()); },
          "What was left out, bridged, guessed or rounded in what was read so far, by index or in\n"
          "passes that have ended: dictionaries with name, number, place and text.")
      .def_property_readonly(
          "num_frames", [](const IndexedRecording& self) { return self.info().num_frames; },
          "Number of frames; None for a capture.")
      .def_property_readonly(
          "labels", [](const IndexedRecording& self) { return LabelDict(self.info().labels); },
          "Ids in the field `label`, by name; empty where labels have numbers only.")
      .def_property_readonly(
          "has_kitti_labels",
          [](const IndexedRecording& self) { return self.info().has_kitti_labels; },
          "Whether labels are SemanticKITTI's numbers.")
      .def_property_readonly(
          "materials", [](const IndexedRecording& self) { return self.info().materials; },
          "Names of materials by their number in the field `material`; may be empty.")
      .def_property_readonly(
          "scenario",
          [](const IndexedRecording& self) -> py::object {
            if (!self.info().scenario) return py::none();
            return ParsedJson(ResolvedScenarioJson(*self.info().scenario));
          },
          "The scenario with every default in place, as a dict; None if it is not known.")
      .def("__repr__", [](const IndexedRecording& self) {
        return "Recording(" + Quoted(self.source().string()) + ", " + self.info().kind + ")";
      });
  RefuseUnmade<IndexedRecording>();
  module.def(
      "open",
      [](const std::filesystem::path& path) {
        const OutsideInterpreter outside;
        return std::make_unique<IndexedRecording>(path);
      },
      py::arg("path"),
      R"(Opens a sequence directory, a .pcd or .ply file, a directory of such files, KITTI's folders,
a .pcap or .pcapng capture or a bag of ROS 2, "BAG:/topic" where it has several topics and
"BAG:/topic#frame_id" where that has several sensors (docs/recordings.md).

Raises InputError if it is none of these.)");
}

}  // namespace railcast
