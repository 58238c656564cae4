#include "analysis/frontier/kept_frontier.h"

#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIdentityFile = "run.txt";
// Files of builds that did not measure the processor were "times_0" and so on.
constexpr const char* kTimesFile = "spent";

/// Appends values to bytes, or takes them from there.
struct Writing {
  std::string bytes;

  template <typename T>
  void Visit(const T* values, std::size_t num) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(values), num * sizeof(T));
  }
};

struct Reading {
  std::span<const char> bytes;
  bool is_whole = true;

  template <typename T>
  void Visit(T* values, std::size_t num) {
    static_assert(std::is_trivially_copyable_v<T>);
    is_whole = is_whole && bytes.size() >= num * sizeof(T);
    if (!is_whole) return;
    std::memcpy(values, bytes.data(), num * sizeof(T));
    bytes = bytes.subspan(num * sizeof(T));
  }
};

/// Visits all of a frame; its vectors must have their sizes.
template <typename Archive, typename F>
void VisitFrame(Archive& archive, F& frame) {
  archive.Visit(&frame.index, 1);
  archive.Visit(&frame.stamp_ns, 1);
  archive.Visit(&frame.duration_ns, 1);
  archive.Visit(frame.world_from_sensor.data(), 16);
  archive.Visit(frame.world_from_sensor_end.data(), 16);
  ForEachField(frame, [&](std::string_view, std::string_view, auto& values) {
    archive.Visit(values.data(), values.size());
  });
}

void WriteKept(const fs::path& file, const std::string& bytes) {
  WriteFileWhole(file, bytes + ContentHash(bytes));
}

// Returns nothing if the file is not there as it was written.
std::optional<std::string> ReadKept(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  std::string bytes = ReadFileWhole(file);
  const std::size_t hash_size = ContentHash("").size();
  const std::size_t size = bytes.size() < hash_size ? 0 : bytes.size() - hash_size;
  const std::string hash = bytes.substr(size);
  bytes.resize(size);
  if (ContentHash(bytes) == hash) return bytes;
  return std::nullopt;
}

std::string BytesOf(const Frame& frame) {
  Writing writing;
  writing.Visit(&frame.rows, 1);
  writing.Visit(&frame.columns, 1);
  writing.Visit(&frame.returns, 1);
  writing.Visit(&frame.has_velocity, 1);
  VisitFrame(writing, frame);
  return std::move(writing.bytes);
}

Frame FrameOfBytes(const std::string& bytes) {
  Reading reading{bytes};
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  std::uint32_t returns = 0;
  reading.Visit(&rows, 1);
  reading.Visit(&columns, 1);
  reading.Visit(&returns, 1);
  Frame frame;
  reading.Visit(&frame.has_velocity, 1);
  frame.Resize(rows, columns, returns);
  VisitFrame(reading, frame);
  Check(reading.is_whole && reading.bytes.empty(), "a kept frame is whole");
  return frame;
}

/// Returns what a file holds or, if there is none, what `make` makes, which it then holds.
template <typename Value>
Value Kept(const fs::path& file,
           const std::function<Value()>& make,
           const std::function<std::string(const Value&)>& write,
           const std::function<Value(const std::string&)>& read) {
  if (file.empty()) return make();
  if (const auto bytes = ReadKept(file)) return read(*bytes);
  Value value = make();
  WriteKept(file, write(value));
  return value;
}

}  // namespace

KeptFrontier::KeptFrontier(fs::path folder, const std::string& identity)
    : folder_(std::move(folder)) {
  MakeFolders(folder_);
  const fs::path file = folder_ / kIdentityFile;
  if (!fs::exists(file)) {
    WriteFileWhole(file, identity + "\n");
  } else if (ReadFileWhole(file) != identity + "\n") {
    throw InputError(ShownPath(folder_) +
                     ": must be what the same command has written; remove it to start anew");
  }
}

fs::path KeptFrontier::FileOf(const char* what, std::uint32_t index) const {
  if (folder_.empty()) return {};
  return folder_ / (std::string(what) + "_" + std::to_string(index));
}

Frame KeptFrontier::FrameOf(std::uint32_t index, const std::function<Frame()>& make) const {
  return Kept<Frame>(FileOf("frame", index), make, BytesOf, FrameOfBytes);
}

std::vector<float> KeptFrontier::StepsOf(std::uint32_t index,
                                         const std::function<std::vector<float>()>& make) const {
  return Kept<std::vector<float>>(
      FileOf("steps", index), make,
      [](const std::vector<float>& steps_m) {
        Writing writing;
        writing.Visit(steps_m.data(), steps_m.size());
        return std::move(writing.bytes);
      },
      [](const std::string& bytes) {
        std::vector<float> steps_m(bytes.size() / sizeof(float));
        Reading reading{bytes};
        reading.Visit(steps_m.data(), steps_m.size());
        return steps_m;
      });
}

std::vector<RowTimes> KeptFrontier::TimesOf(
    std::uint32_t index, const std::function<std::vector<RowTimes>()>& make) const {
  return Kept<std::vector<RowTimes>>(
      FileOf(kTimesFile, index), make,
      [](const std::vector<RowTimes>& rows) {
        nlohmann::json json = nlohmann::json::array();
        for (const RowTimes& row : rows)
          json.push_back({row.times_ms, row.ratios, row.processor_ms});
        return json.dump();
      },
      [](const std::string& text) {
        std::vector<RowTimes> rows;
        for (const auto& row : nlohmann::json::parse(text))
          rows.push_back({row.at(0), row.at(1), row.at(2)});
        return rows;
      });
}

bool KeptFrontier::HasFrame(std::uint32_t index) const {
  return !folder_.empty() && fs::exists(FileOf("frame", index));
}

bool KeptFrontier::HasTimes(std::uint32_t index) const {
  return !folder_.empty() && fs::exists(FileOf(kTimesFile, index));
}

void KeptFrontier::Remove() const {
  if (!folder_.empty()) fs::remove_all(folder_);
}

}  // namespace railcast
