// host_scene.c: scans a box on a plane, made of the program's own triangles, and checks every range.
#include <math.h>
#include <railcast/c_api.h>
#include <stdio.h>

enum { GROUND = 1, BOX = 2, NUM_TRIANGLES = 12 };  // Indices into the table of surfaces.
static const railcast_surface surfaces[] = {{NULL, NULL, 0, 0},  // 0: nothing
                                            {"ballast", "ground", 0, 0},
                                            {"concrete", "object", 1, 0}};

typedef struct {
  double a[3], ab[3], ac[3];  // A corner and the two edges from it.
  uint32_t surface;
} Triangle;

static const double low[3] = {28, 0.5, 0}, high[3] = {32, 3.5, 2};  // The box's corners.
static Triangle triangles[NUM_TRIANGLES];

static void Add(int index, uint32_t surface, const double a[3], const double ab[3],
                const double ac[3]) {
  for (int i = 0; i < 3; ++i) {
    triangles[index].a[i] = a[i];
    triangles[index].ab[i] = ab[i];
    triangles[index].ac[i] = ac[i];
  }
  triangles[index].surface = surface;
}

// Two triangles for each face of the box but its floor, and two for the ground.
static void MakeTriangles(void) {
  int n = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const double* corner = side ? high : low;
      double u[3] = {0, 0, 0}, v[3] = {0, 0, 0}, far[3], minus_u[3], minus_v[3];
      const int iu = (axis + 1) % 3, iv = (axis + 2) % 3;
      u[iu] = (low[iu] + high[iu]) - 2 * corner[iu];
      v[iv] = (low[iv] + high[iv]) - 2 * corner[iv];
      if (axis == 2 && side == 0) continue;
      for (int i = 0; i < 3; ++i) {
        far[i] = corner[i] + u[i] + v[i];
        minus_u[i] = -u[i];
        minus_v[i] = -v[i];
      }
      Add(n++, BOX, corner, u, v);
      Add(n++, BOX, far, minus_u, minus_v);
    }
  }
  const double a[3] = {-200, -200, 0}, b[3] = {200, 200, 0}, x[3] = {400, 0, 0}, y[3] = {0, 400, 0};
  const double minus_x[3] = {-400, 0, 0}, minus_y[3] = {0, -400, 0};
  Add(n++, GROUND, a, x, y);
  Add(n++, GROUND, b, minus_x, minus_y);
}

static void Cross(const double a[3], const double b[3], double out[3]) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = a[j] * b[k] - a[k] * b[j];
  }
}
static double Dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The distance to a triangle, INFINITY if there is none (Moeller and Trumbore 1997).
static double Distance(const Triangle* t, const double origin[3], const double direction[3]) {
  const double from_a[3] = {origin[0] - t->a[0], origin[1] - t->a[1], origin[2] - t->a[2]};
  double p[3], q[3];
  Cross(direction, t->ac, p);
  Cross(from_a, t->ab, q);
  const double determinant = Dot(t->ab, p);
  if (determinant == 0) return INFINITY;
  const double u = Dot(from_a, p) / determinant, v = Dot(direction, q) / determinant;
  const double distance = Dot(t->ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && distance >= 0 ? distance : INFINITY;
}

static int CastRays(void* user, const railcast_rays* rays) {
  (void)user;
  for (size_t i = 0; i < rays->num_rays; ++i) {
    const double origin[3] = {rays->origin_x[i], rays->origin_y[i], rays->origin_z[i]};
    const double direction[3] = {rays->direction_x[i], rays->direction_y[i], rays->direction_z[i]};
    for (int t = 0; t < NUM_TRIANGLES; ++t) {
      const float range_m = (float)Distance(&triangles[t], origin, direction);
      double normal[3];
      if (!(range_m < rays->range_m[i])) continue;
      Cross(triangles[t].ab, triangles[t].ac, normal);
      rays->range_m[i] = range_m;
      rays->surface[i] = triangles[t].surface;
      rays->normal_x[i] = (float)normal[0];
      rays->normal_y[i] = (float)normal[1];
      rays->normal_z[i] = (float)normal[2];
    }
  }
  return 0;
}

// The range in closed form: the ground's height over the ray's slope, and the box by its slabs.
static double ExactRange(const double origin[3], const double direction[3]) {
  double begin = 0, end = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const double s = (low[i] - origin[i]) / direction[i], t = (high[i] - origin[i]) / direction[i];
    begin = fmax(begin, fmin(s, t));
    end = fmin(end, fmax(s, t));
  }
  const double box = begin < end ? begin : INFINITY;
  const double ground = direction[2] < 0 ? -origin[2] / direction[2] : INFINITY;
  return fmin(box, ground);
}

static int Fail(const char* what) {
  fprintf(stderr, "%s: %s\n", what, railcast_last_error());
  return 1;
}

int main(int argc, char** argv) {
  char file[4096];
  railcast_config config = {0};
  railcast_scene scene = {0};
  railcast_motion motion = {{{0, 0, 2.5}, {0, 0, 0, 1}}, {{2, 0, 2.5}, {0, 0, 0, 1}}, {0, 0, 0}};
  railcast_sim* sim = NULL;
  railcast_frame frame;
  railcast_field range, time, instance;
  int num_on_box = 0;
  double worst_m = 0;
  if (argc != 2) return 2;  // The folder of railcast's scenarios.
  snprintf(file, sizeof file, "%s/scene.json", argv[1]);
  config.json_text = "{\"version\": 1, \"file\": \"minimal.json\", \"fidelity\": \"geometry\","
                     " \"lidar\": {\"file\": \"sensors/vir2rail.json\", \"range_max_m\": 100}}";
  config.file = file;
  scene.cast_rays = CastRays;
  scene.surfaces = surfaces;
  scene.num_surfaces = 3;
  MakeTriangles();
  if (railcast_c_api_version() != RAILCAST_C_API_VERSION) return 1;
  if (railcast_create_with_scene(&config, &scene, &sim)) return Fail("create");
  if (railcast_step_host(sim, 0, &motion)) return Fail("step");
  if (railcast_get_frame(sim, &frame)) return Fail("frame");
  if (railcast_get_field(sim, "range_m", &range)) return Fail("range_m");
  if (railcast_get_field(sim, "time_ns", &time)) return Fail("time_ns");
  if (railcast_get_field(sim, "instance", &instance)) return Fail("instance");

  for (uint32_t row = 0; row < frame.rows; ++row) {
    for (uint32_t column = 0; column < frame.columns; ++column) {
      // Beams pass through the centres of cells of 0.25 degrees, from the left and from below.
      const double degree = 3.14159265358979323846 / 180;
      const double azimuth = (30 - 0.25 * (column + 0.5)) * degree;
      const double elevation = (-15 + 0.25 * (row + 0.5)) * degree;
      const double direction[3] = {cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth),
                                   sin(elevation)};
      const size_t slot = (size_t)row * frame.columns + column;
      const double share = ((const uint32_t*)time.values)[slot] / (double)frame.duration_ns;
      const double origin[3] = {2 * share, 0, 2.5};  // The sensor moves by 2 m during the scan.
      const double exact_m = ExactRange(origin, direction);
      const double range_m = ((const float*)range.values)[slot];
      if (isnan(range_m) != (exact_m > 100)) return 1;
      if (!isnan(range_m)) worst_m = fmax(worst_m, fabs(range_m - exact_m));
      num_on_box += ((const uint32_t*)instance.values)[slot] == 1;
    }
  }
  printf("%d firings on the box; ranges within %.2f mm\n", num_on_box, worst_m * 1e3);
  railcast_destroy(sim);
  // A rotation in float32 may tilt a ray by 1e-7. 100 m away on a plane 2.5 m below, that moves the
  // hit by 0.4 mm.
  return num_on_box > 0 && worst_m < 1e-3 ? 0 : 1;
}
