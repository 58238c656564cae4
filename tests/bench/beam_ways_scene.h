#pragma once

#include <memory>
#include <vector>

#include "core/detect/base/effect_parameters.h"
#include "core/detect/kernels/kernels.h"
#include "core/trace/beam_tree.h"
#include "railcast/ray_caster.h"
#include "railcast/scenario.h"
#include "tests/bench/layouts.h"

namespace railcast {

/// The trees for beams of a scenario's frame 0 without moving objects and wires, and its beams.
class BeamWaysScene {
 public:
  explicit BeamWaysScene(const ScenarioSpec& scenario);
  ~BeamWaysScene();
  BeamWaysScene(const BeamWaysScene&) = delete;
  BeamWaysScene& operator=(const BeamWaysScene&) = delete;

  [[nodiscard]] const BeamScene& beams() const;
  [[nodiscard]] const LayoutScene& layout() const { return layout_; }
  [[nodiscard]] std::size_t num_firings() const { return layout_.rays.rows.size(); }
  [[nodiscard]] float range_max_m() const { return range_max_m_; }

  /// Aims the sub-rays of the beam of a firing, as effect `footprint` does.
  void Aim(std::size_t firing, BeamRays& beam) const;

 private:
  struct Trees;

  LayoutScene layout_;
  float range_max_m_;
  std::uint64_t seed_;
  BeamFrame frame_{};
  const Kernels& kernels_;
  std::unique_ptr<Trees> trees_;
};

}  // namespace railcast
