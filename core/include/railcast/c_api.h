#pragma once

/// railcast for programs in C, and in every language that can call C: game engines, Python's
/// ctypes, C#. docs/engine.md shows complete programs.
///
/// It is not called railcast.h because that is the C++ header that includes all others. This header
/// is C99 and includes nothing of railcast; link librailcast (CMake: railcast::c).
///
/// Every function that can fail returns a railcast_status and never lets an exception out. If it is
/// not RAILCAST_OK, railcast_last_error() says why.
///
/// Threads: different simulations may be used by different threads at once. Calls for one
/// simulation must not overlap, except that several threads may read its frame at once. Overlapping
/// steps are refused with RAILCAST_BAD_ARGUMENT.
///
/// Lengths are in metres, angles in radians, axes right-handed with z up; the sensor looks along x,
/// with y to its left. Structs are to be zeroed before their members are set.

#include <stddef.h>
#include <stdint.h>

// NOLINTBEGIN(readability-identifier-naming): names in the manner of C

#ifdef __cplusplus
extern "C" {
#endif

/// Version of this interface. It grows with every change after which programs compiled for the
/// previous version can no longer use the library; librailcast.so.N holds version N.
#define RAILCAST_C_API_VERSION 1

/// RAILCAST_C_API_VERSION of the loaded library. Programs that load the library at run time compare
/// it with their own.
int railcast_c_api_version(void);

/// Version of railcast, such as "1.0.0" or "1.0.0-rc.1".
const char* railcast_version(void);

/// Outcome of a function.
enum railcast_status {
  RAILCAST_OK = 0,
  /// The scenario or a file that it names is faulty; the message has a line for every fault, as
  /// railcast-generate prints them.
  RAILCAST_BAD_INPUT = 1,
  /// An argument breaks a rule of this header.
  RAILCAST_BAD_ARGUMENT = 2,
  RAILCAST_OUT_OF_MEMORY = 3,  ///< Memory or threads do not suffice.
  /// The host's callback returned another value than 0, or what it wrote breaks a rule of
  /// railcast_rays.
  RAILCAST_BAD_CALLBACK = 4,
  RAILCAST_INTERNAL_ERROR = 5  ///< A bug in railcast or in one of its libraries.
};
typedef enum railcast_status railcast_status;

/// The message of the last function that failed in the calling thread; "" if none did. Valid until
/// the thread's next call that fails. Never null.
const char* railcast_last_error(void);

/// A position and a rotation.
struct railcast_pose {
  double position_m[3];
  double quaternion_xyzw[4];  ///< Unit length, to within 0.001.
};
typedef struct railcast_pose railcast_pose;

/// The largest number of threads of a simulation.
#define RAILCAST_MAX_THREADS 1024

/// What a simulation is made of.
struct railcast_config {
  /// The scenario as JSON text (docs/scenario.md), UTF-8.
  const char* json_text;
  /// The file that the text stands for, which need not exist: names of other files in it are
  /// relative to its folder, and messages show its name. Null = "scenario" in the current folder.
  const char* file;
  /// Name of the sensor; may be null if the scenario has only one.
  const char* sensor;
  /// Threads that simulate, at most RAILCAST_MAX_THREADS; 0 = all cores. With 1, everything runs in
  /// the calling thread.
  int num_threads;
};
typedef struct railcast_config railcast_config;

/// A simulation of one sensor.
typedef struct railcast_sim railcast_sim;

/// Makes the simulation of a scenario in its own world. Fidelity `auto` makes its choice here.
/// @param[out] sim To be given to railcast_destroy(); null if the function fails.
/// @return RAILCAST_OK, RAILCAST_BAD_INPUT, RAILCAST_BAD_ARGUMENT or RAILCAST_OUT_OF_MEMORY.
railcast_status railcast_create(const railcast_config* config, railcast_sim** sim);

/// Frees a simulation and everything that railcast_get_...() returned for it. Null is permitted.
/// To be called before the process ends: a thread of the simulation builds scenes ahead, and may
/// crash where exit() destroys what it works with.
void railcast_destroy(railcast_sim* sim);

// A scene of the host

/// The largest number of rays that a callback gets at once.
#define RAILCAST_MAX_RAYS 256

/// Rays of a callback, and where the host writes what they hit. Each array has num_rays elements.
///
/// Rays are in world axes, relative to railcast_motion::scene_origin_m. For every ray that meets a
/// surface at a distance in [0, range_m], the host sets range_m, surface and the normal; for all
/// other rays it leaves these values unchanged. Rays start at distance 0, so that a surface nearer
/// than the sensor's least range blocks the beam.
struct railcast_rays {
  size_t num_rays;  ///< 1 to RAILCAST_MAX_RAYS.
  const float *origin_x, *origin_y, *origin_z;
  const float *direction_x, *direction_y, *direction_z;  ///< Unit length.
  /// Time of each ray within the frame: 0 at its stamp, 1 at its last firing.
  const float* shutter;
  float* range_m;     ///< Before the call: the greatest range.
  uint32_t* surface;  ///< Index into the host's table of surfaces. Before the call: 0.
  float *normal_x, *normal_y, *normal_z;  ///< Either side of the surface; length 1e-15 to 1e15.
};
typedef struct railcast_rays railcast_rays;

/// Finds the first surface along each ray. Several threads may call it at once, unless the
/// simulation has one thread: then only the thread that calls railcast_step_host(). It must not
/// call railcast for the same simulation. It must return: it must neither end or cancel the thread
/// that it runs on nor leave by longjmp().
/// @return 0, or any other value to end the step with RAILCAST_BAD_CALLBACK.
typedef int (*railcast_cast_rays)(void* user, const railcast_rays* rays);

/// A surface, or any number of surfaces that have these properties in common.
struct railcast_surface {
  const char* material;  ///< Name of one of the scenario's materials.
  const char* label;     ///< Name of one of the scenario's labels.
  uint32_t instance;     ///< Value of frames' field "instance"; 0 = background.
  int is_ego;            ///< Not 0: part of the sensor's own vehicle, blocks beams without a point.
};
typedef struct railcast_surface railcast_surface;

/// The host's scene.
struct railcast_scene {
  railcast_cast_rays cast_rays;
  void* user;  ///< The callback's first argument.
  /// The table of surfaces, which is copied. Element 0 stands for nothing and is all zero.
  const railcast_surface* surfaces;
  size_t num_surfaces;
};
typedef struct railcast_scene railcast_scene;

/// Makes a simulation whose rays the host traces, in the host's scene. Of the scenario's world
/// and vehicle only `lidar.mount` is used, and only for points in vehicle axes. Effects that need
/// more than rays do nothing: `spray`, and `thin_conductors`, since wires are surfaces like any
/// other here. Wind moves patches of fog only: it does not sway the host's trees and wires.
/// @param[out] sim As for railcast_create().
/// @return As railcast_create().
railcast_status railcast_create_with_scene(const railcast_config* config,
                                           const railcast_scene* scene,
                                           railcast_sim** sim);

/// Replaces the table of surfaces of a host's scene, for objects that appear or change.
railcast_status railcast_set_surfaces(railcast_sim* sim,
                                      const railcast_surface* surfaces,
                                      size_t num_surfaces);

// Frames

/// How the sensor scans. Frame k begins at its stamp, k / rate_hz after that of frame 0 (the
/// scenario's `phase_s`), and its last firing is duration_ns later.
struct railcast_scan {
  double rate_hz;
  uint32_t duration_ns;
  uint32_t num_firings;
};
typedef struct railcast_scan railcast_scan;

/// Tells how the simulation's sensor scans.
/// @param[out] scan Unchanged on failure.
railcast_status railcast_get_scan(const railcast_sim* sim, railcast_scan* scan);

/// Simulates a frame of a simulation that railcast_create() made. Frames may be simulated in any
/// order: a frame depends on its number alone.
railcast_status railcast_step(railcast_sim* sim, uint32_t frame_index);

/// How the host moved the sensor during a frame.
struct railcast_motion {
  railcast_pose world_from_sensor;  ///< At the stamp.
  /// At the last firing. In between, the position changes linearly and the rotation at a constant
  /// rate.
  railcast_pose world_from_sensor_end;
  /// Subtracted from the positions of rays, which are float32. At most 8192 m from the sensor.
  double scene_origin_m[3];
};
typedef struct railcast_motion railcast_motion;

/// Simulates a frame of a simulation that railcast_create_with_scene() made. The frame depends on
/// its number, which keys the random draws, on the motion and on what the callback writes.
railcast_status railcast_step_host(railcast_sim* sim,
                                   uint32_t frame_index,
                                   const railcast_motion* motion);

/// The frame of the last step. Without one, or if it failed, railcast_get_frame() and
/// railcast_get_field() are refused with RAILCAST_BAD_ARGUMENT.
struct railcast_frame {
  int64_t stamp_ns;  ///< Simulation time of the first firing.
  uint32_t index;
  uint32_t duration_ns;
  uint32_t rows;                        ///< Channels.
  uint32_t columns;                     ///< Azimuth steps.
  uint32_t returns;                     ///< Slots per firing.
  size_t num_slots;                     ///< rows * columns * returns.
  railcast_pose world_from_sensor;      ///< At the stamp.
  railcast_pose world_from_sensor_end;  ///< At the last firing.
};
typedef struct railcast_frame railcast_frame;

/// Describes the frame of the last step.
/// @param[out] frame Unchanged on failure.
railcast_status railcast_get_frame(const railcast_sim* sim, railcast_frame* frame);

/// Type of a field's values.
enum railcast_type {
  RAILCAST_FLOAT32 = 1,
  RAILCAST_UINT8 = 2,
  RAILCAST_UINT16 = 3,
  RAILCAST_UINT32 = 4
};
typedef enum railcast_type railcast_type;

/// The values of one field of a frame, in the simulation's own memory. They may be read until the
/// next step or railcast_destroy().
struct railcast_field {
  const void* values;
  size_t num_values;  ///< railcast_frame::num_slots.
  railcast_type type;
};
typedef struct railcast_field railcast_field;

/// @param name As docs/files.md lists them: "x", "range_m", "label", "outcome", ...
railcast_status railcast_get_field(const railcast_sim* sim,
                                   const char* name,
                                   railcast_field* field);

/// The name of a value of the field "outcome", such as "returned"; null if there is none.
const char* railcast_outcome_name(unsigned outcome);

#ifdef __cplusplus
}
#endif
// NOLINTEND(readability-identifier-naming)
