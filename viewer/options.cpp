#include "viewer/options.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/text.h"
#include "core/program/command_line.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {
namespace {

constexpr int kMinSize_px = 64;
constexpr int kMaxSize_px = 16384;

/// Values as CLI11 parses them, before they are checked.
struct RawOptions {
  std::string size = "1280x720";
  std::string background = "dark";
  std::string color_map;
  std::vector<double> color_range;
  std::vector<double> eye_m, target_m;
  std::vector<std::string> show;
  std::vector<std::string> picks;
  std::string layout = "beside";
  std::string image;
  std::vector<double> stretch_s_m;
};

/// A name that --show takes, and the choice that it sets.
struct Showable {
  std::string_view name;
  bool OverlayChoices::*choice;
};
constexpr auto kShowables = std::to_array<Showable>({
    {"surfaces", &OverlayChoices::mesh},
    {"boxes", &OverlayChoices::boxes},
    {"track", &OverlayChoices::track},
    {"gauge", &OverlayChoices::gauge},
    {"frustum", &OverlayChoices::frustum},
    {"axes", &OverlayChoices::axes},
    {"rings", &OverlayChoices::rings},
});
constexpr std::string_view kEmptyBeams = "empty-beams";

[[noreturn]] void Fail(const std::string& option, const std::string& rule) {
  FailUsage(option, rule);
}

/// Parses two whole numbers; empty if `text` is not that, or if a number is out of its limits.
std::optional<std::array<int, 2>> ParsePair(std::string_view text,
                                            char between,
                                            int at_least,
                                            const std::array<int, 2>& at_most) {
  const std::size_t end = text.find(between);
  if (end == std::string_view::npos) return std::nullopt;
  std::array<int, 2> pair{};
  const std::array<std::string_view, 2> words = {text.substr(0, end), text.substr(end + 1)};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto number = ParseWholeNumber(words[i]);
    if (!number || std::cmp_less(*number, at_least) || std::cmp_greater(*number, at_most[i])) {
      return std::nullopt;
    }
    pair[i] = static_cast<int>(*number);
  }
  return pair;
}

std::array<int, 2> ParseSize(const std::string& text) {
  const auto size_px = ParsePair(text, 'x', kMinSize_px, {kMaxSize_px, kMaxSize_px});
  if (!size_px)
    Fail("--size", "must be WIDTHxHEIGHT, each 64 to 16384 (got " + ShownText(text) + ")");
  return *size_px;
}

std::array<int, 2> ParsePick(const std::string& text, const std::array<int, 2>& size_px) {
  const auto place_px = ParsePair(text, ',', 0, {size_px[0] - 1, size_px[1] - 1});
  if (!place_px) {
    Fail("--pick", "must be X,Y in pixels from the picture's upper left corner, within it (got " +
                       text + ")");
  }
  return *place_px;
}

std::array<double, 3> Triple(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}

template <typename Names>
std::vector<std::string> Strings(const Names& names) {
  return {names.begin(), names.end()};
}

std::vector<std::string> ShowableNames() {
  std::vector<std::string> names = {std::string(kEmptyBeams)};
  for (const Showable& showable : kShowables) names.emplace_back(showable.name);
  return names;
}

std::vector<std::string> BackgroundNames() {
  std::vector<std::string> names;
  for (const Background& background : kBackgrounds) names.emplace_back(background.name);
  return names;
}

void AddSourceOptions(ProgramOptions& app, ViewOptions& options, RawOptions& raw) {
  app.AddOption("source", options.source,
                "What to show: a sequence directory, a cloud in .pcd, .ply, .bin, .las or text, a "
                "directory of such files, a .pcap or .pcapng capture, a bag of ROS 2, a live "
                "stream, udp://HOST:PORT, or a scenario, SCENARIO.json, whose plan --screenshot "
                "draws")
      .Required()
      .Check(NonEmpty());
  AddSourceChoice(app, options.choice);
  app.AddOption("--frame", options.frame, "Number of the frame to begin with; default: the first")
      .Check(Whole({0, std::numeric_limits<std::uint32_t>::max()}));
  app.AddOption("--compare", options.compare,
                "A second source to compare the first with, frame by frame");
  app.AddOption("--layout", raw.layout,
                "How --compare shows two sources. beside: side by side; distance: one over the "
                "other, each point coloured by its distance to the nearest of the other source; "
                "changes: likewise, coloured by whether both have the point, or only one")
      .Check(Named(Strings(kLayoutNames)))
      .ShowDefault();
  app.AddOption("--scenario", options.scenario,
                "Scenario that a stream or file was made from: it gives the labels' names, the "
                "track and the surfaces");
  app.AddOption(
      "--sensor", options.sensor,
      "Name of the sensor, where the scenario has several; of captures that hold several, "
      "ADDRESS or ADDRESS:PORT of one");
  app.AddOption("--from", options.from,
                "HOST or HOST:PORT whose live frames are shown; default: the first sender heard");
  app.AddOption("--image-port", options.image_port,
                "UDP port of this machine to which a live source's camera images are sent; "
                "default: images are not received")
      .Check(Whole({1, 65535}));
  app.AddOption("--wait", options.wait_s,
                "Seconds to wait for the first whole frame of a live source")
      .Check(Number({1e-3, 1e9}))
      .ShowDefault();
}

void AddLookOptions(ProgramOptions& app, ViewOptions& options, RawOptions& raw) {
  app.AddOption("--color-by", options.choices.color_by,
                "Field to colour the points by: a field of railcast or any other that the cloud "
                "has. Default: label where there is one, else height");
  app.AddOption("--color-map", raw.color_map, "Colour map for continuous values; default: viridis")
      .Check(Named(Strings(kColorMapNames)));
  app.AddOption("--color-range", raw.color_range,
                "The two ends of the colour scale; default: the 1st and 99th percentile of the "
                "first frame")
      .NumValues(2)
      .SeparatedBy(',')
      .TakesOneWord();
  app.AddOption("--point-size", options.look.point_size_px,
                "Size of a point in pixels; default: in proportion to the height of the picture")
      .Check(Whole({1, kMaxPointSize_px}));
  app.AddOption("--background", raw.background).Check(Named(BackgroundNames())).ShowDefault();
  app.AddOption("--accumulate", options.choices.num_accumulated,
                "How many frames to show at once, each where it was in the world")
      .Check(Whole({1, kMaxAccumulated}))
      .ShowDefault();
  app.AddOption("--show", raw.show, "What to draw over the points, separated by commas")
      .Check(Named(ShowableNames()))
      .SeparatedBy(',')
      .NumValues(1)
      .MayRepeat()
      .TakesOneWord();
  app.AddOption("--image", raw.image,
                "The camera's image to show in the corner; default: color where there are images. "
                "For a live source: color or off")
      .Check(Named(Strings(kPictureKindNames)));
  app.AddOption("--select", options.select,
                "Labels to show, separated by commas; all others are faint")
      .SeparatedBy(',')
      .NumValues(1)
      .MayRepeat()
      .TakesOneWord();
}

void AddCameraOptions(ProgramOptions& app, ViewOptions& options, RawOptions& raw) {
  const Option camera =
      app.AddOption("--camera", options.camera,
                    "Where to look from; default: chase for live sources and where the scenario is "
                    "known, else all")
          .Check(Named(Strings(kCameraNames)));
  const Option eye =
      app.AddOption("--eye", raw.eye_m,
                    "Where to look from instead of --camera: X,Y,Z in the sensor's axes, in metres")
          .NumValues(3)
          .SeparatedBy(',')
          .TakesOneWord();
  const Option target = app.AddOption("--target", raw.target_m,
                                      "Where --eye looks: X,Y,Z in the sensor's axes, in metres")
                            .NumValues(3)
                            .SeparatedBy(',')
                            .TakesOneWord();
  eye.Needs(target).Excludes(camera);
  target.Needs(eye);
  app.AddOption("--size", raw.size, "Size of the window or picture in pixels, WIDTHxHEIGHT")
      .ShowDefault();
}

void AddPictureOptions(ProgramOptions& app, ViewOptions& options, RawOptions& raw) {
  const Option screenshot = app.AddOption("--screenshot", options.screenshot,
                                          "PNG file to write instead of opening a window");
  const Option video =
      app.AddOption("--video", options.video,
                    "Directory to write a PNG of each frame to: 000000.png, 000001.png, ...");
  app.AddOption("--frames", options.num_pictures,
                "Number of pictures of a video; default: to the recording's end")
      .Check(Whole({1}))
      .Needs(video);
  video.Excludes(screenshot);
  const Option pick =
      app.AddOption(
             "--pick", raw.picks,
             "Print all that is known of the point at X,Y of the picture, in pixels from its upper "
             "left corner. Given twice: measure from the first point to the second")
          .NumValues(1)
          .MayRepeat()
          .TakesOneWord()
          .Needs(screenshot);
  app.AddFlag("--trace", options.traces,
              "Print what each effect made of the picked point's firing, too")
      .Needs(pick);
}

void AddPlanOptions(ProgramOptions& app, RawOptions& raw) {
  app.AddOption("--stretch", raw.stretch_s_m,
                "FROM TO: chainages in metres between which the plan of a scenario shows the line; "
                "default: where its tracks branch, or the whole line")
      .NumValues(2)
      .TakesOneWord();
}

void UseRaw(const RawOptions& raw, const ProgramOptions& app, ViewOptions& options) {
  options.size_px = ParseSize(raw.size);
  if (raw.picks.size() > 2) Fail("--pick", "must be given at most twice");
  for (const std::string& pick : raw.picks) {
    options.picks_px.push_back(ParsePick(pick, options.size_px));
  }
  options.look.background = *std::ranges::find(kBackgrounds, raw.background, &Background::name);
  // At this size, neighbouring beams of a spinning sensor nearly touch.
  if (!app.is_given("--point-size")) {
    options.look.point_size_px =
        std::max(2, static_cast<int>(std::lround(options.size_px[1] / 300.0)));
  }
  if (!raw.color_map.empty()) {
    options.choices.map = static_cast<ColorMap>(std::ranges::find(kColorMapNames, raw.color_map) -
                                                kColorMapNames.begin());
  }
  if (!raw.image.empty()) {
    options.choices.picture = static_cast<PictureKind>(
        std::ranges::find(kPictureKindNames, raw.image) - kPictureKindNames.begin());
  }
  if (!raw.color_range.empty()) {
    if (!(raw.color_range[0] < raw.color_range[1]) || !std::isfinite(raw.color_range[0]) ||
        !std::isfinite(raw.color_range[1])) {
      Fail("--color-range", "must be two numbers, the lower first");
    }
    auto& ends = raw.layout == "distance" ? options.choices.distance_ends_m : options.choices.ends;
    ends = {raw.color_range[0], raw.color_range[1]};
  }
  options.choices.layout =
      static_cast<Layout>(std::ranges::find(kLayoutNames, raw.layout) - kLayoutNames.begin());
  for (const std::string& name : raw.show) {
    const auto* const found = std::ranges::find(kShowables, name, &Showable::name);
    (found == kShowables.end() ? options.choices.empty_beams
                               : options.choices.overlays.*found->choice) = true;
  }
  if (!raw.stretch_s_m.empty()) {
    if (!(raw.stretch_s_m[0] < raw.stretch_s_m[1])) {
      Fail("--stretch", "must be two chainages, the lesser first (got " +
                            NumberText(raw.stretch_s_m[0]) + " and " +
                            NumberText(raw.stretch_s_m[1]) + ")");
    }
    options.stretch_s_m = {raw.stretch_s_m[0], raw.stretch_s_m[1]};
  }
  if (!raw.eye_m.empty()) {
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (!std::ranges::all_of(raw.eye_m, is_finite) ||
        !std::ranges::all_of(raw.target_m, is_finite)) {
      Fail("--eye, --target", "must be numbers");
    }
    options.place = UprightCamera(Triple(raw.eye_m), Triple(raw.target_m));
    if (options.place->eye_m == options.place->target_m) {
      Fail("--eye", "must be another place than --target");
    }
  }
}

/// Only the colours of a live camera are sent, and they go to a port of their own.
void CheckLiveImage(const ViewOptions& options) {
  const PictureKind kind = options.choices.picture.value_or(PictureKind::kOff);
  if (!options.is_live() || kind == PictureKind::kOff) return;
  if (kind != PictureKind::kColor) {
    Fail("--image", "must be color or off for a live source (got " +
                        std::string(kPictureKindNames[static_cast<std::size_t>(kind)]) + ")");
  }
  if (!options.image_port) Fail("--image", "needs --image-port for a live source");
}

void CheckTogether(const ViewOptions& options) {
  if (options.frame && options.is_live()) Fail("--frame", "is not for a live source");
  if (options.is_live() && !options.compare.empty()) {
    Fail("--compare", "is not for a live source");
  }
  if (options.compare.string().starts_with(kLivePrefix)) {
    Fail("--compare", "must not be a live source");
  }
  if (options.compare.empty() && options.choices.layout != Layout::kBeside) {
    Fail("--layout", "needs --compare");
  }
  if (options.from && !options.is_live()) Fail("--from", "is for a live source");
  if (options.image_port && !options.is_live()) Fail("--image-port", "is for a live source");
  CheckLiveImage(options);
  if (options.sensor && !ParseSender(*options.sensor) && options.scenario.empty()) {
    Fail("--sensor", "needs --scenario, unless it is the address of a capture's sensor");
  }
}

/// A plan shows no frames, so that few options apply.
void CheckPlan(const ProgramOptions& app, const ViewOptions& options) {
  if (!options.is_plan()) {
    if (options.stretch_s_m) Fail("--stretch", "is for the plan of a scenario");
    return;
  }
  constexpr std::array<std::string_view, 5> kForPlans = {"source", "--screenshot", "--size",
                                                         "--background", "--stretch"};
  for (const Option& option : app.options()) {
    if (!option.is_given() || option.name() == "-v") continue;
    if (std::ranges::find(kForPlans, option.name()) == kForPlans.end()) {
      Fail(option.name(), "is not for the plan of a scenario");
    }
  }
  if (options.screenshot.empty()) Fail("--screenshot", "is needed for the plan of a scenario");
}

void CheckFiles(const ProgramOptions& app, const ViewOptions& options) {
  for (const char* const option : {"--screenshot", "--video", "--compare", "--scenario"}) {
    if (app.is_given(option) && app.TextOf(option).empty()) {
      Fail(option, "must not be empty");
    }
  }
  if (!options.screenshot.empty() && options.screenshot.extension() != ".png") {
    Fail("--screenshot", "must end in .png (got " + ShownPath(options.screenshot) + ")");
  }
}

}  // namespace

bool ViewOptions::is_live() const {
  return source.string().starts_with(kLivePrefix);
}

void AddViewOptions(ProgramOptions& app, ViewOptions& options) {
  const auto raw = std::make_shared<RawOptions>();
  AddSourceOptions(app, options, *raw);
  AddLookOptions(app, options, *raw);
  AddCameraOptions(app, options, *raw);
  AddPictureOptions(app, options, *raw);
  AddPlanOptions(app, *raw);
  app.AddFlag("-v", options.is_verbose, "Print what is shown");
  app.CheckTogether([&app, &options, raw] {
    UseRaw(*raw, app, options);
    CheckPlan(app, options);
    CheckTogether(options);
    CheckFiles(app, options);
  });
}

}  // namespace railcast
