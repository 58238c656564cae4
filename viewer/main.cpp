#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <string_view>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/io/stream/stream_clouds.h"
#include "core/scenario/scenario.h"
#include "viewer/cloud.h"
#include "viewer/coloring.h"
#include "viewer/label_file.h"
#include "viewer/live_frames.h"
#include "viewer/view.h"

namespace railcast {
namespace {

constexpr int kMinSize_px = 64;
constexpr int kMaxSize_px = 16384;

struct Options {
  std::filesystem::path source;
  std::filesystem::path screenshot;  ///< Empty: a window.
  std::string color_by;              ///< Empty: label where the cloud has it, else height.
  std::string camera = "chase";
  std::string size = "1280x720";
  std::optional<std::uint32_t> frame;
  bool verbose = false;
};

/// @throws CLI::ValidationError if `text` is no WIDTHxHEIGHT.
std::array<int, 2> ParseSize(const std::string& text) {
  std::array<int, 2> size_px{};
  char end = '\0';
  const int num_read = std::sscanf(text.c_str(), "%dx%d%c", &size_px[0], &size_px[1], &end);
  for (const int length_px : size_px) {
    if (num_read == 2 && length_px >= kMinSize_px && length_px <= kMaxSize_px) continue;
    throw CLI::ValidationError("--size",
                               "must be WIDTHxHEIGHT, each 64 to 16384 (got " + text + ")");
  }
  return size_px;
}

void AddOptions(CLI::App& app, Options& options) {
  app.add_option("source", options.source,
                 "A .pcd or .ply file, a sequence directory, or udp://HOST:PORT")
      ->required();
  app.add_option("--screenshot", options.screenshot, "Write a PNG instead of opening a window");
  app.add_option("--color-by", options.color_by, "Default: label where there is one, else height")
      ->check(CLI::IsMember(std::vector<std::string>(kColorBy.begin(), kColorBy.end())));
  app.add_option("--camera", options.camera, "From where to look")
      ->check(CLI::IsMember(std::vector<std::string>(kCameras.begin(), kCameras.end())))
      ->capture_default_str();
  app.add_option("--size", options.size, "Of the picture, in pixels")->capture_default_str();
  app.add_option("--frame", options.frame, "Frame of a sequence directory; default: its first");
  app.add_flag("-v", options.verbose, "Say what is shown");
  app.set_version_flag("--version", RAILCAST_VERSION);
}

constexpr std::string_view kLivePrefix = "udp://";

bool IsLive(const Options& options) {
  return options.source.string().starts_with(kLivePrefix);
}

/// @param place Where the cloud is from, for faults.
Coloring ColorPlaced(const Cloud& cloud,
                     const std::string& place,
                     std::string color_by,
                     const LabelTable& labels) {
  if (color_by.empty()) color_by = cloud.fields.contains("label") ? "label" : "height";
  return AtPlace(place + ": ", [&] { return ColorCloud(cloud, color_by, labels); });
}

Coloring ColorFile(const Cloud& cloud,
                   const std::filesystem::path& file,
                   const std::string& color_by) {
  const auto label_file = FindLabelFile(file);
  return ColorPlaced(cloud, file.string(), color_by,
                     label_file ? ReadLabelTable(*label_file) : LabelTable());
}

struct LivePicture {
  Cloud cloud;
  Coloring coloring;
  ViewSpec spec;
};

/// A stream names no label table: labels are shown by their numbers.
LivePicture MakeLivePicture(const ReceivedFrame& frame,
                            const Options& options,
                            const std::array<int, 2>& size_px) {
  const std::string place = options.source.string();
  LivePicture picture;
  picture.cloud = MakeCloud(MakePclCloud(frame), place);
  picture.coloring = ColorPlaced(picture.cloud, place, options.color_by, LabelTable());
  picture.spec = {.size_px = size_px,
                  .camera = options.camera,
                  .caption = place + "  frame " + std::to_string(frame.header.frame) + "  " +
                             std::to_string(picture.cloud.size()) + " points"};
  if (!frame.is_complete()) {
    picture.spec.caption += "  " + std::to_string(frame.num_lost_packets()) + " packets lost";
  }
  return picture;
}

void RunLive(const Options& options, const std::array<int, 2>& size_px) {
  const DisplayConnection display;
  LiveFrames frames(ParseEndpoint(options.source.string().substr(kLivePrefix.size()), kStreamPort));
  std::fprintf(stderr, "listening at %s\n", EndpointText(frames.at()).c_str());
  LivePicture picture = MakeLivePicture(*frames.WaitForWhole(), options, size_px);
  const auto window = MakeView(picture.cloud, picture.coloring, picture.spec);
  if (!options.screenshot.empty()) {
    WriteScreenshot(*window, options.screenshot);
    return;
  }
  ShowWindow(*window, [&] {
    const auto frame = frames.TakeLatest();
    if (!frame) return false;
    picture = MakeLivePicture(*frame, options, size_px);
    ReplaceCloud(*window, picture.cloud, picture.coloring, picture.spec);
    return true;
  });
}

void Run(const Options& options, const std::array<int, 2>& size_px) {
  const std::filesystem::path file = FindCloudFile(options.source, options.frame);
  const Cloud cloud = ReadCloud(file);
  const Coloring coloring = ColorFile(cloud, file, options.color_by);
  const std::string caption = file.string() + "  " + std::to_string(cloud.size()) + " points";
  if (options.verbose) std::fprintf(stderr, "%s\n", caption.c_str());
  const DisplayConnection display;
  const auto window =
      MakeView(cloud, coloring, {.size_px = size_px, .camera = options.camera, .caption = caption});
  if (options.screenshot.empty()) {
    ShowWindow(*window);
  } else {
    WriteScreenshot(*window, options.screenshot);
  }
}

int Main(int argc, char** argv) {
  CLI::App app("Shows a point cloud, coloured by what is known of its points.", "railcast-view");
  Options options;
  AddOptions(app, options);
  std::array<int, 2> size_px{};
  try {
    app.parse(argc, argv);
    size_px = ParseSize(options.size);
    if (options.frame && (IsLive(options) || std::filesystem::is_regular_file(options.source))) {
      throw CLI::ValidationError("--frame", "is for a sequence directory, not a file or stream");
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (IsLive(options)) {
      RunLive(options, size_px);
    } else {
      Run(options, size_px);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::Main(argc, argv);
}
