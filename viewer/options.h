#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/draw/cameras.h"
#include "viewer/draw/look.h"
#include "viewer/scene/choices.h"

namespace railcast {

/// What the command line asks for.
struct ViewOptions {
  std::filesystem::path source;
  std::filesystem::path compare;  ///< Empty: nothing is compared.
  std::filesystem::path scenario;
  std::optional<std::string> sensor;  ///< Of the scenario.
  std::optional<std::string> from;    ///< HOST or HOST:PORT of a live source's sender.
  std::optional<std::uint32_t> frame;
  std::filesystem::path screenshot;  ///< Empty: none.
  std::filesystem::path video;       ///< Likewise.
  std::optional<std::size_t> num_pictures;
  double wait_s = 60.0;  ///< For the first whole frame of a live source.
  std::vector<std::array<int, 2>> picks_px;
  bool traces = false;
  std::vector<std::string> select;

  Choices choices;
  Look look;
  std::string camera;  ///< Empty: by the source.
  std::optional<CameraPlace> place;
  std::array<int, 2> size_px{1280, 720};
  bool is_verbose = false;

  [[nodiscard]] bool is_live() const;
  [[nodiscard]] bool is_headless() const { return !screenshot.empty() || !video.empty(); }
};

inline constexpr std::string_view kLivePrefix = "udp://";

/// Reads the command line.
/// @throws CLI::ParseError as CLI11 does, also where options do not go together.
[[nodiscard]] ViewOptions ParseOptions(CLI::App& app, int argc, char** argv);

}  // namespace railcast
