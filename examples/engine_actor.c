// engine_actor.c: a lidar as an actor of a game engine with Unreal's axes, called once per tick.
#include <math.h>
#include <railcast/c_api.h>
#include <stdio.h>

// What the engine offers --------------------------------------------------------------------------
typedef struct {
  double x, y, z;
} Vector;
typedef struct {
  Vector position_cm;
  double qx, qy, qz, qw;
} EnginePose;
typedef struct {
  double distance_cm;
  Vector normal;
} EngineHit;

static double Along(Vector v, int axis) { return axis == 0 ? v.x : v.y; }

// Walls 60 m ahead (x) and 5 m to the right (y).
static int LineTrace(Vector start_cm, Vector direction, double reach_cm, EngineHit* hit) {
  static const double wall_cm[2] = {6000, 500};
  hit->distance_cm = reach_cm;
  for (int axis = 0; axis < 2; ++axis) {
    const double distance_cm = (wall_cm[axis] - Along(start_cm, axis)) / Along(direction, axis);
    if (!(distance_cm > 0 && distance_cm < hit->distance_cm)) continue;
    hit->distance_cm = distance_cm;
    hit->normal = (Vector){axis == 0 ? -1 : 0, axis == 1 ? -1 : 0, 0};
  }
  return hit->distance_cm < reach_cm;
}

// The vehicle at a time: 20 m/s ahead, turning to the right by 0.2 rad/s about z.
static EnginePose VehicleAt(double time_s) {
  const double half_yaw_rad = 0.5 * 0.2 * time_s;
  return (EnginePose){{2000 * time_s, 0, 250}, 0, 0, sin(half_yaw_rad), cos(half_yaw_rad)};
}

// The actor ---------------------------------------------------------------------------------------
enum { NUM_TICKS = 64 };  // More than there are ticks in a scan.
typedef struct {
  railcast_sim* sim;
  railcast_scan scan;
  uint32_t next_frame;
  uint32_t num_ticks;
  double time_s[NUM_TICKS];  // Of tick k in element k % NUM_TICKS.
  EnginePose pose[NUM_TICKS];
  double scene_origin_m[3];
} LidarActor;

static int CastRays(void* user, const railcast_rays* rays) {
  const double* origin_m = ((const LidarActor*)user)->scene_origin_m;
  for (size_t i = 0; i < rays->num_rays; ++i) {
    const Vector start_cm = {100 * (rays->origin_x[i] + origin_m[0]),
                             -100 * (rays->origin_y[i] + origin_m[1]),
                             100 * (rays->origin_z[i] + origin_m[2])};
    const Vector direction = {rays->direction_x[i], -rays->direction_y[i], rays->direction_z[i]};
    EngineHit hit;
    if (!LineTrace(start_cm, direction, 100.0 * rays->range_m[i], &hit)) continue;
    rays->range_m[i] = (float)(hit.distance_cm / 100);
    rays->normal_x[i] = (float)hit.normal.x;
    rays->normal_y[i] = (float)-hit.normal.y;
    rays->normal_z[i] = (float)hit.normal.z;
    rays->surface[i] = 1;
  }
  return 0;
}

static double Between(double a, double b, double share) { return a + share * (b - a); }

// The pose at a time, between the two ticks around it, in railcast's axes.
static railcast_pose PoseAt(const LidarActor* actor, double time_s) {
  uint32_t k = actor->num_ticks - 1;
  while (k > 1 && actor->time_s[(k - 1) % NUM_TICKS] > time_s) --k;
  const EnginePose *a = &actor->pose[(k - 1) % NUM_TICKS], *b = &actor->pose[k % NUM_TICKS];
  const double begin_s = actor->time_s[(k - 1) % NUM_TICKS];
  const double share = (time_s - begin_s) / (actor->time_s[k % NUM_TICKS] - begin_s);
  // q and -q are the same rotation: take the one of b that is nearer to a.
  const double sign = a->qx * b->qx + a->qy * b->qy + a->qz * b->qz + a->qw * b->qw < 0 ? -1 : 1;
  const double qx = Between(a->qx, sign * b->qx, share), qy = Between(a->qy, sign * b->qy, share);
  const double qz = Between(a->qz, sign * b->qz, share), qw = Between(a->qw, sign * b->qw, share);
  const double length = sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  const railcast_pose pose = {{Between(a->position_cm.x, b->position_cm.x, share) / 100,
                               -Between(a->position_cm.y, b->position_cm.y, share) / 100,
                               Between(a->position_cm.z, b->position_cm.z, share) / 100},
                              {-qx / length, qy / length, -qz / length, qw / length}};
  return pose;
}

// Called by the engine once per tick. Returns the number of frames made, or -1.
static int Tick(LidarActor* actor, double time_s, EnginePose pose) {
  int num_frames = 0;
  actor->time_s[actor->num_ticks % NUM_TICKS] = time_s;
  actor->pose[actor->num_ticks++ % NUM_TICKS] = pose;
  if (actor->num_ticks < 2) return 0;
  for (;; ++num_frames, ++actor->next_frame) {
    const double stamp_s = actor->next_frame / actor->scan.rate_hz;
    const double end_s = stamp_s + 1e-9 * actor->scan.duration_ns;
    railcast_motion motion;
    if (end_s > time_s) return num_frames;
    motion.world_from_sensor = PoseAt(actor, stamp_s);
    motion.world_from_sensor_end = PoseAt(actor, end_s);
    for (int i = 0; i < 3; ++i) {  // Whole kilometres, so that rays are exact in large worlds.
      actor->scene_origin_m[i] = 1000 * floor(motion.world_from_sensor.position_m[i] / 1000);
      motion.scene_origin_m[i] = actor->scene_origin_m[i];
    }
    if (railcast_step_host(actor->sim, actor->next_frame, &motion)) return -1;
  }
}

// The check ---------------------------------------------------------------------------------------
// How far the ranges of the last frame are from those of LineTrace() in the engine's own axes.
static double WorstError_m(const LidarActor* actor) {
  const char* const names[] = {"x", "y", "z", "range_m"};
  railcast_frame frame;
  railcast_field time, field[4];
  double worst_m = 0;
  if (railcast_get_frame(actor->sim, &frame)) return INFINITY;
  if (railcast_get_field(actor->sim, "time_ns", &time)) return INFINITY;
  for (int i = 0; i < 4; ++i) {
    if (railcast_get_field(actor->sim, names[i], &field[i])) return INFINITY;
  }
  for (size_t slot = 0; slot < frame.num_slots; ++slot) {
    const double x = ((const float*)field[0].values)[slot];
    const double y = -((const float*)field[1].values)[slot];
    const double z = ((const float*)field[2].values)[slot];
    const double range_m = ((const float*)field[3].values)[slot];
    const EnginePose pose = VehicleAt(
        1e-9 * ((double)frame.stamp_ns + ((const uint32_t*)time.values)[slot]));
    // Unreal's yaw turns x towards y.
    const double cosine = pose.qw * pose.qw - pose.qz * pose.qz, sine = 2 * pose.qw * pose.qz;
    const Vector direction = {(cosine * x - sine * y) / range_m, (sine * x + cosine * y) / range_m,
                              z / range_m};
    EngineHit hit;
    if (isnan(range_m)) continue;
    if (!LineTrace(pose.position_cm, direction, 30000, &hit)) return INFINITY;
    worst_m = fmax(worst_m, fabs(hit.distance_cm / 100 - range_m));
  }
  return worst_m;
}

int main(int argc, char** argv) {
  static const railcast_surface surfaces[] = {{NULL, NULL, 0, 0}, {"concrete", "building", 0, 0}};
  LidarActor actor = {0};
  railcast_config config = {0};
  railcast_scene scene = {0};
  char file[4096];
  double worst_m = 0;
  if (argc != 2) return 2;  // The folder of railcast's scenarios.
  snprintf(file, sizeof file, "%s/actor.json", argv[1]);
  config.json_text = "{\"version\": 1, \"file\": \"minimal.json\", \"fidelity\": \"geometry\"}";
  config.file = file;
  config.num_threads = 1;  // If the engine's rays may be cast by the game's thread only.
  scene.cast_rays = CastRays;
  scene.user = &actor;
  scene.surfaces = surfaces;
  scene.num_surfaces = 2;
  if (railcast_create_with_scene(&config, &scene, &actor.sim) ||
      railcast_get_scan(actor.sim, &actor.scan)) {
    fprintf(stderr, "%s\n", railcast_last_error());
    return 1;
  }
  for (int tick = 0; tick <= 60; ++tick) {  // One second of an engine that ticks 60 times a second.
    const double time_s = tick / 60.0;
    const int num_frames = Tick(&actor, time_s, VehicleAt(time_s));
    if (num_frames < 0) fprintf(stderr, "%s\n", railcast_last_error());
    if (num_frames != 0) worst_m = fmax(worst_m, WorstError_m(&actor));
  }
  printf("%u frames; ranges within %.2f mm\n", (unsigned)actor.next_frame, worst_m * 1e3);
  railcast_destroy(actor.sim);
  return actor.next_frame == 10 && worst_m < 1e-3 ? 0 : 1;
}
