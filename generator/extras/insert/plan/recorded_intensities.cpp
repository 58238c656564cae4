#include "generator/extras/insert/plan/recorded_intensities.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/text.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/kernels/surface_response.h"
#include "core/io/recording/recording_kinds.h"
#include "core/scenario/json_source.h"
#include "generator/extras/insert/intensity_scale.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

constexpr std::size_t kLag = 1;  // Beyond a cell of textures, and not much.
static_assert(kTextureLags_m[kLag] == 0.1);

/// Whether a plan, or one that it builds on, gives its sensor the noise. That of a sensor's file is
/// of all sensors of its kind.
bool GivesNoise(const std::filesystem::path& plan_file) {
  JsonSource source;
  std::optional<Node> node = source.Open(plan_file);
  for (const std::string key : {"lidar", "receiver", "intensity_noise"}) {
    const auto object = source.Members(*node);
    const auto member = std::ranges::find(object->members, key, &Member::key);
    if (member == object->members.end()) return false;
    node = member->value;
  }
  return node->pointer.starts_with("/lidar/");
}

std::string WhyNot(const GridTurns& grids, const TurnNoise& noise) {
  if (grids.frames.empty()) return "it has no whole turn as a grid";
  if (noise.has_moved) return "its sensor moved";
  if (grids.frames.size() < 2) return "it has one whole turn only";
  return "";
}

/// V of effect `texture` on a surface that faces the beam (core/detect/kernels/surface_response.h).
double ShareKept(const BeamSpec& beam, double range_m) {
  constexpr double kPerCell = 4.0 * std::numbers::pi;
  const double per_cell = range_m / static_cast<double>(kTextureCell_m);
  const double h = per_cell * HorizontalSigma_rad(beam);
  const double w = per_cell * VerticalSigma_rad(beam);
  const double trace = h * h + w * w;
  return 1.0 / std::sqrt(1.0 + 3.0 * std::sqrt(trace) + kPerCell * trace +
                         kPerCell * kPerCell * h * h * w * w);
}

/// Why a figure is not used; empty if it is.
std::string WhyNotUsed(const JackknifedFigure& figure) {
  if (std::isfinite(figure.value)) {
    return figure.value > 0.0 && figure.value <= 2.0 * figure.error
               ? "since " + ShortText(figure.value) + " is less than twice its standard error"
               : "";
  }
  return "since smooth surfaces (" + NumberText(figure.num) + " pairs of returns) lie in " +
         NumberText(figure.num_parts) + " of the " + NumberText(JackknifedFigure::kLeastParts) +
         " directions that are needed";
}

std::string FigureText(const JackknifedFigure& figure, double scale) {
  return "(standard error " + ShortText(scale * figure.error) + ", " + NumberText(figure.num) +
         " pairs of returns)";
}

/// @returns What is used, as UseTexture().
std::string UseNoise(const RecordedIntensities& recorded, ScenarioSpec& plan) {
  constexpr double kPercent = 100.0;
  std::string why_not = WhyNotUsed(recorded.noise);
  const double noise = RelativeDeviation(recorded.noise.value);
  if (noise > 1.0) why_not = "since more than 100 % were measured";
  if (!why_not.empty()) return "noise of the sensor's file, " + why_not;
  plan.lidar.receiver.intensity_noise = noise;
  return "noise of " + ShortText(kPercent * noise) + " % from turn to turn " +
         FigureText(recorded.noise, kPercent);
}

std::string UseTexture(const RecordedIntensities& recorded, ScenarioSpec& plan) {
  std::string why_not = WhyNotUsed(recorded.texture);
  const double seen = recorded.texture.value;
  const double kept = ShareKept(plan.lidar.beam, recorded.range_m);
  const double texture = std::sqrt(std::log1p(std::expm1(seen * seen) / kept));
  if (texture > 2.0) why_not = "since beams are too wide to tell";
  if (!why_not.empty()) return "textures of the materials' file, " + why_not;
  for (Material& material : plan.materials) {
    const bool is_like = material.texture == 0.0 && material.retroreflectance == 0.0;
    if (is_like) material.texture = texture;
  }
  return "for materials without a texture one of " + ShortText(seen) +
         " between returns 0.1 m apart, " + ShortText(recorded.range_m) + " m away " +
         FigureText(recorded.texture, 1.0) + ", which is " + ShortText(texture) +
         " from cell to cell";
}

}  // namespace

RecordedIntensities IntensitiesOf(std::vector<RecordedFrame> turns, double per_reflectance) {
  for (RecordedFrame& turn : turns) {
    for (float& intensity : turn.frame.intensity) intensity /= static_cast<float>(per_reflectance);
  }
  const GridTurns grids = GridsOf(turns);
  const TurnNoise noise = FindTurnNoise(SmoothTurnsOf(grids));
  return {.why_not = WhyNot(grids, noise),
          .noise = noise.intensity.robust,
          .texture = noise.texture.at(kLag).robust,
          .range_m = noise.texture_range_m.at(kLag)};
}

std::optional<RecordedIntensities> MeasureIntensities(const std::filesystem::path& plan_file,
                                                      const ScenarioSpec& plan,
                                                      const std::filesystem::path& recording,
                                                      const std::vector<Transform>& at_frames) {
  constexpr std::size_t kMostTurns = 5;
  constexpr double kStands_m = 0.05;
  const EffectSet effects = EffectsOf(plan);
  const bool wants_noise = effects.intensity_noise && !GivesNoise(plan_file);
  if (!wants_noise && !effects.texture) return std::nullopt;
  const auto opened = OpenRecording(recording);
  if (IsSimulated(opened->info())) return std::nullopt;
  std::vector<RecordedFrame> turns = WholeTurns(*opened, kMostTurns);
  IntensityScaleFinder finder(opened->info());
  for (const RecordedFrame& turn : turns) finder.Add(turn);
  RecordedIntensities recorded = IntensitiesOf(std::move(turns), finder.Found().per_reflectance);
  recorded.wants_noise = wants_noise;
  recorded.wants_texture = effects.texture;
  const std::size_t last = std::min(kMostTurns, at_frames.size()) - 1;
  const Vector3 way_m = at_frames.at(last).translation() - at_frames.at(0).translation();
  if (recorded.why_not.empty() && way_m.norm() > kStands_m) recorded.why_not = "its sensor moved";
  return recorded;
}

std::string UseIntensities(const RecordedIntensities& recorded, ScenarioSpec& plan) {
  if (!recorded.why_not.empty()) {
    return "intensities of what is put in: noise and texture of the sensor's and the materials' "
           "files, since those of the recording are not known: " +
           recorded.why_not;
  }
  std::string used = recorded.wants_noise ? UseNoise(recorded, plan) : "";
  if (recorded.wants_noise && recorded.wants_texture) used += "; ";
  if (recorded.wants_texture) used += UseTexture(recorded, plan);
  return "intensities of what is put in, as measured on the recording's smooth surfaces: " + used;
}

}  // namespace railcast
