#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/recording/source_choice.h"
#include "core/program/options.h"
#include "viewer/composition/composer.h"
#include "viewer/draw/cameras.h"
#include "viewer/draw/look.h"

namespace railcast {

/// The options of the command line.
struct ViewOptions {
  std::filesystem::path source;
  std::filesystem::path compare;  ///< Empty: nothing is compared.
  SourceChoice choice;            ///< For sources that do not say it themselves.
  std::filesystem::path scenario;
  /// Name of a sensor of the scenario, or address of one of a capture.
  std::optional<std::string> sensor;
  std::optional<std::string> from;          ///< HOST or HOST:PORT of a live source's sender.
  std::optional<std::uint16_t> image_port;  ///< Where a live camera's images come.
  std::optional<std::uint32_t> frame;
  std::filesystem::path screenshot;  ///< Empty: none.
  std::filesystem::path video;       ///< Empty: none.
  std::optional<std::size_t> num_pictures;
  double wait_s = 60.0;  ///< Time limit for the first whole frame of a live source.
  std::vector<std::array<int, 2>> picks_px;
  bool traces = false;
  std::vector<std::string> select;
  std::optional<std::array<double, 2>> stretch_s_m;  ///< The part of the line in a plan.

  Choices choices;
  Look look;
  std::string camera;  ///< Empty: depends on the source.
  std::optional<CameraPlace> place;
  std::array<int, 2> size_px{1280, 720};
  bool is_verbose = false;

  [[nodiscard]] bool is_live() const;
  /// Whether the source is a scenario, whose plan is to be drawn.
  [[nodiscard]] bool is_plan() const { return !is_live() && source.extension() == ".json"; }
  [[nodiscard]] bool is_headless() const { return !screenshot.empty() || !video.empty(); }
};

inline constexpr std::string_view kLivePrefix = "udp://";

/// Adds the options of railcast-view. Parsing fills `options`; options that contradict each other
/// are a usage error.
/// @param options Must live as long as `app`.
void AddViewOptions(ProgramOptions& app, ViewOptions& options);

}  // namespace railcast
