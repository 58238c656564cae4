// A program that embeds railcast's core and knows nothing of its sources.

#include <cmath>
#include <cstdio>

#include "core/base/random.h"
#include "core/base/transform.h"
#include "core/frame/frame.h"
#include "core/scene/mesh.h"

namespace {

/// A frame of one turn of a two-channel sensor that stands in the middle of a round tunnel.
railcast::Frame TunnelFrame(float radius_m) {
  railcast::Frame frame;
  frame.Resize(2, 360, 1);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const auto words =
        railcast::RandomWords(1, railcast::RandomUse::kNoise, 0, static_cast<std::uint32_t>(slot));
    const float azimuth_rad = 6.2831853F * railcast::UnitFloat(words[0]);
    frame.x[slot] = radius_m * std::cos(azimuth_rad);
    frame.y[slot] = radius_m * std::sin(azimuth_rad);
    frame.outcome[slot] = railcast::Outcome::kReturned;
  }
  return frame;
}

}  // namespace

int main() {
  const railcast::Frame frame = TunnelFrame(3.0F);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const float range_m = std::hypot(frame.x[slot], frame.y[slot]);
    if (!railcast::HasPoint(frame.outcome[slot]) || std::abs(range_m - 3.0F) > 1e-5F) {
      std::fprintf(stderr, "slot %zu: range %g m\n", slot, static_cast<double>(range_m));
      return 1;
    }
  }

  const railcast::Mesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  railcast::Mesh two_triangles = triangle;
  two_triangles.Append(triangle,
                       railcast::MakeTransform(railcast::RotationFromYawPitchRoll(0, 0, 0),
                                               railcast::Vector3(0, 0, 5)));
  const railcast::Model model{"two_triangles", {{two_triangles, 0, 0}}};
  std::printf("%zu slots, %zu triangles up to %g m\n", frame.num_slots(), model.num_triangles(),
              model.Bounds().max().z());
  return model.num_triangles() == 2 && model.Bounds().max().z() == 5.0 ? 0 : 1;
}
