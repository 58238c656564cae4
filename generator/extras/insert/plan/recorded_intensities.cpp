#include "generator/extras/insert/plan/recorded_intensities.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/kernels/surface_response.h"
#include "core/io/recording/recording_kinds.h"
#include "generator/extras/insert/intensity_scale.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

constexpr std::size_t kLag = 1;  // Beyond a cell of textures, and not much.
static_assert(kTextureLags_m[kLag] == 0.1);

void FindGiven(const std::filesystem::path& plan_file, RecordedIntensities& recorded) {
  using Json = nlohmann::json;
  const Json plan = Json::parse(ReadFileWhole(plan_file));
  recorded.is_noise_given = plan.contains(Json::json_pointer("/lidar/receiver/intensity_noise"));
}

std::string WhyNot(const GridTurns& grids, const TurnNoise& noise) {
  if (grids.frames.empty()) return "it has no whole turn as a grid";
  if (noise.has_moved) return "its sensor moved";
  if (grids.frames.size() < 2) return "it has one whole turn only";
  for (const JackknifedFigure* const figure :
       {&noise.intensity.robust, &noise.texture.at(kLag).robust}) {
    if (std::isfinite(figure->value)) continue;
    return "its smooth surfaces are too few (" + NumberText(figure->num) + " pairs of returns)";
  }
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

/// The figure, where it is told from 0.
double ValueOf(const JackknifedFigure& figure) {
  return figure.value > 2.0 * figure.error ? figure.value : 0.0;
}

std::string FigureText(const JackknifedFigure& figure, double scale) {
  return "(standard error " + ShortText(scale * figure.error) + ", " + NumberText(figure.num) +
         " pairs of returns)";
}

/// @returns What is used, as UseTexture().
std::string UseNoise(const RecordedIntensities& recorded, ScenarioSpec& plan) {
  constexpr double kPercent = 100.0;
  const double noise = std::sqrt(std::expm1(std::pow(ValueOf(recorded.noise), 2)));
  if (noise > 1.0) return "noise of the sensor's file, since more than 100 % were measured";
  plan.lidar.receiver.intensity_noise = noise;
  return "noise of " + ShortText(kPercent * noise) + " % from turn to turn " +
         FigureText(recorded.noise, kPercent);
}

std::string UseTexture(const RecordedIntensities& recorded, ScenarioSpec& plan) {
  const double seen = ValueOf(recorded.texture);
  const double kept = ShareKept(plan.lidar.beam, recorded.range_m);
  const double texture = std::sqrt(std::log1p(std::expm1(seen * seen) / kept));
  if (texture > 2.0) return "textures of the materials' file, since beams are too wide to tell";
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

RecordedIntensities MeasureIntensities(const std::filesystem::path& plan_file,
                                       const std::filesystem::path& recording) {
  constexpr std::size_t kMostTurns = 5;
  const auto opened = OpenRecording(recording);
  if (IsSimulated(opened->info())) return {.is_simulated = true};
  std::vector<RecordedFrame> turns = WholeTurns(*opened, kMostTurns);
  IntensityScaleFinder finder(opened->info());
  for (const RecordedFrame& turn : turns) finder.Add(turn);
  RecordedIntensities recorded = IntensitiesOf(std::move(turns), finder.Found().per_reflectance);
  FindGiven(plan_file, recorded);
  return recorded;
}

std::string UseIntensities(const RecordedIntensities& recorded, ScenarioSpec& plan) {
  const EffectSet effects = EffectsOf(plan);
  const bool has_things = !plan.world.objects.empty() || !plan.world.trains.empty();
  const bool wants_noise = effects.intensity_noise && !recorded.is_noise_given;
  if (recorded.is_simulated || !has_things || !(wants_noise || effects.texture)) return "";
  if (!recorded.why_not.empty()) {
    return "intensities of what is put in: noise and texture of the sensor's and the materials' "
           "files, since the recording does not tell its own: " +
           recorded.why_not;
  }
  std::string used = wants_noise ? UseNoise(recorded, plan) : "";
  if (wants_noise && effects.texture) used += "; ";
  if (effects.texture) used += UseTexture(recorded, plan);
  return "intensities of what is put in, as measured on the recording's smooth surfaces: " + used;
}

}  // namespace railcast
