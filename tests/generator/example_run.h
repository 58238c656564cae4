#pragma once

#include <tbb/task_arena.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include "core/io/content_hash.h"
#include "core/io/write_file.h"
#include "generator/run/make_frames.h"
#include "tests/core/io/example_frame.h"

namespace railcast {

inline InputFile ExampleInput(const std::string& name, const std::string& bytes) {
  return {name, ContentHash(bytes), std::make_shared<const std::string>(bytes), {}, {}};
}

/// Returns the specification of a run of `num_frames` example frames, beginning with frame 3.
inline SequenceSpec ExampleRun(const std::filesystem::path& directory,
                               const std::string& format = "pcd",
                               std::uint32_t num_frames = 6) {
  SequenceSpec spec;
  spec.directory = directory;
  spec.version = "0.1.0";
  spec.embree_version = "3.13.5";
  spec.isa = "avx2";
  spec.identity = {"{\"seed\": 5}\n",
                   ContentHash("{\"seed\": 5}\n"),
                   {ExampleInput("wagon.obj", "a wagon"), ExampleInput("table.csv", "a table")}};
  spec.seed = 5;
  spec.files = {&ParseFrameFormat(format), FieldSelection(), ExampleLabels()};
  spec.materials = MaterialLibrary({{"ballast", 0.25}, {"rail_head", 0.08}});
  spec.start_frame = 3;
  spec.num_frames = num_frames;
  return spec;
}

inline void MakeExampleFrame(std::uint32_t index,
                             Frame& frame,
                             std::vector<ObjectInFrame>& objects) {
  frame = ExampleFrame(index);
  ObjectInFrame wagon{"wagon_1", "open_wagon", "wagon", 3};
  wagon.size_m = Vector3(10.0, 2.9, 3.1);
  wagon.world_from_box.translation() = Vector3(80.0 - 0.1 * index, 1.5, 1.6);
  wagon.points = 4;
  wagon.view = {8, 6, 8, 6};
  objects.push_back(wagon);
}

using ExampleFrames =
    std::function<void(std::uint32_t index, Frame& frame, std::vector<ObjectInFrame>& objects)>;
using ImageSource = std::function<bool(std::uint32_t index, CameraImage& image)>;

/// Makes each frame with one call.
inline SequenceResult RunSequence(const SequenceSpec& spec,
                                  const ExampleFrames& make_frame,
                                  const SequenceHooks& hooks,
                                  const ImageSource& make_image = {},
                                  const FramesAtOnce& at_once = {}) {
  const BeginFrame begin = [&](std::uint32_t index) -> FrameJob {
    return [&, index](MadeFrame& made) {
      made.objects.clear();
      make_frame(index, made.frame, made.objects);
      made.has_image = make_image && make_image(index, made.image);
    };
  };
  return RunSequence(spec, begin, hooks, at_once);
}

/// So many frames at once, on four threads.
inline FramesAtOnce AtOnce(std::size_t num) {
  return {num, [](const std::function<void()>& work) {
            tbb::task_arena four_threads(4);
            four_threads.execute([&] { work(); });
          }};
}

/// Makes frames of which every other one takes a while, so that later ones are done before it.
inline void MakeUnevenFrame(std::uint32_t index,
                            Frame& frame,
                            std::vector<ObjectInFrame>& objects) {
  MakeExampleFrame(index, frame, objects);
  if (index % 2 != 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));
}

inline SequenceHooks NoHooks() {
  return {[](std::uint32_t, std::uint32_t) {}, [] { return false; }};
}

/// Returns the bytes of every file below a directory, by the file's name.
inline std::map<std::string, std::string> Contents(const std::filesystem::path& directory) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    if (!entry.is_regular_file()) continue;
    contents[std::filesystem::relative(entry.path(), directory).string()] =
        ReadFileWhole(entry.path());
  }
  return contents;
}

}  // namespace railcast
