#pragma once

/// Includes all of railcast::core: scenarios, worlds, sensors, effects and frames.
/// docs/embedding.md shows complete programs. The headers of railcast::io are in railcast/io; some
/// of them need PCL.
///
///     const auto scenario = railcast::ReadScenario("scenarios/open_line.json");
///     const auto simulator = railcast::MakeSimulator(scenario, /*num_threads=*/0);
///     railcast::Frame frame;
///     for (std::uint32_t i = 0; i < 100; ++i) {
///       simulator->Scan(i, frame);
///       // Use frame.x, frame.label, frame.outcome, ...
///     }

#include "railcast/alignment.h"
#include "railcast/camera.h"
#include "railcast/effects.h"
#include "railcast/enum_names.h"
#include "railcast/error.h"
#include "railcast/fidelity.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/lineside.h"
#include "railcast/material.h"
#include "railcast/motion_sensors.h"
#include "railcast/outcome.h"
#include "railcast/rail_world.h"
#include "railcast/ray_caster.h"
#include "railcast/remark.h"
#include "railcast/rigid_motion.h"
#include "railcast/scenario.h"
#include "railcast/scene.h"
#include "railcast/simulator.h"
#include "railcast/structures.h"
#include "railcast/track_side.h"
#include "railcast/transform.h"
#include "railcast/world_spec.h"
