// engine_axes.c: checks the table of axes in docs/engine.md: to rotate a vector and then convert it
// must give the same as to convert both and then rotate.
#include <math.h>
#include <stdio.h>

typedef struct {
  double x, y, z, w;  // w is 0 in vectors.
} Quaternion;

static Quaternion VectorFromUnreal(Quaternion v) {
  return (Quaternion){v.x / 100, -v.y / 100, v.z / 100, 0};
}
static Quaternion RotationFromUnreal(Quaternion q) { return (Quaternion){-q.x, q.y, -q.z, q.w}; }

static Quaternion VectorFromUnity(Quaternion v) { return (Quaternion){v.z, -v.x, v.y, 0}; }
static Quaternion RotationFromUnity(Quaternion q) { return (Quaternion){-q.z, q.x, -q.y, q.w}; }

static Quaternion VectorFromGodot(Quaternion v) { return (Quaternion){-v.z, -v.x, v.y, 0}; }
static Quaternion RotationFromGodot(Quaternion q) { return (Quaternion){-q.z, -q.x, q.y, q.w}; }

static Quaternion Product(Quaternion a, Quaternion b) {
  return (Quaternion){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
                      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
static Quaternion Turned(Quaternion q, Quaternion v) {
  return Product(Product(q, v), (Quaternion){-q.x, -q.y, -q.z, q.w});
}

// The difference between these two orders, for a rotation and a vector in general position.
static double Gap(Quaternion vector(Quaternion), Quaternion rotation(Quaternion)) {
  const Quaternion q = {0.1, -0.5, 0.7, 0.5}, v = {3, 5, 7, 0};  // |q| = 1
  const Quaternion a = vector(Turned(q, v)), b = Turned(rotation(q), vector(v));
  return fabs(a.x - b.x) + fabs(a.y - b.y) + fabs(a.z - b.z);
}

int main(void) {
  const double gap = Gap(VectorFromUnreal, RotationFromUnreal) +
                     Gap(VectorFromUnity, RotationFromUnity) +
                     Gap(VectorFromGodot, RotationFromGodot);
  printf("rotations commute with the change of axes to %g\n", gap);
  return gap < 1e-12 ? 0 : 1;
}
