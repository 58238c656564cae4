// Measures what moving things cost a simulator that has their triangles in Embree's tree, beside
// railcast, which has them as instances of their models: on one thread, in processor time, in turns
// in one process. Prints tab-separated values.
//
//   railcast-measure rebuild SCENARIO [--turns N]
//
// For each frame, the vertices of all objects that move are placed anew, and their tree is built
// anew (Embree's quality for things that move, LOW) or refitted. To either, the raw trace of all
// sensors is added. All else of the scene is touched by none of the three.
#include <tbb/task_arena.h>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/program/command_line.h"
#include "core/trace/embree.h"
#include "railcast/scenario.h"
#include "railcast/scene.h"
#include "tests/bench/measurements.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

/// The triangles of all objects that move, in one tree.
class MovingTree {
 public:
  /// @param quality Of the objects' own trees after the first: built anew or refitted.
  MovingTree(const World& world, RTCBuildQuality quality)
      : world_(world), device_(rtcNewDevice("")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    for (std::size_t i = 0; i < world.objects().size(); ++i) {
      if (world.objects()[i].moves) Attach(i, quality);
    }
    Move(0);
  }
  ~MovingTree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  MovingTree(const MovingTree&) = delete;
  MovingTree& operator=(const MovingTree&) = delete;

  [[nodiscard]] std::size_t num_triangles() const { return num_triangles_; }

  /// Places all objects where they are at a time.
  void Move(std::int64_t time_ns) {
    for (const Moving& moving : all_) {
      const Eigen::Isometry3f pose =
          Eigen::Isometry3d(world_.WorldFromObject(moving.object, time_ns).matrix()).cast<float>();
      Eigen::Vector3f* vertex = moving.vertices_m;
      for (const Part& part : world_.objects()[moving.object].model->parts) {
        for (const Eigen::Vector3f& own_m : part.mesh.vertices) *vertex++ = pose * own_m;
      }
      RTCGeometry geometry = rtcGetGeometry(scene_, moving.geometry);
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry);
    }
    tbb::task_arena one_thread(1);
    one_thread.execute([this] { rtcCommitScene(scene_); });
  }

 private:
  struct Moving {
    std::size_t object{};
    unsigned geometry{};
    Eigen::Vector3f* vertices_m{};
  };

  void Attach(std::size_t object, RTCBuildQuality quality) {
    const std::vector<Part>& parts = world_.objects()[object].model->parts;
    std::size_t num_vertices = 0;
    std::size_t num_triangles = 0;
    for (const Part& part : parts) {
      num_vertices += part.mesh.vertices.size();
      num_triangles += part.mesh.triangles.size();
    }
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality);
    auto* const vertices_m = static_cast<Eigen::Vector3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Eigen::Vector3f), num_vertices));
    auto* corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), num_triangles));
    std::uint32_t first = 0;
    for (const Part& part : parts) {
      for (const auto& triangle : part.mesh.triangles) {
        for (const std::uint32_t corner : triangle) *corners++ = first + corner;
      }
      first += static_cast<std::uint32_t>(part.mesh.vertices.size());
    }
    all_.push_back({object, rtcAttachGeometry(scene_, geometry), vertices_m});
    rtcReleaseGeometry(geometry);
    num_triangles_ += num_triangles;
  }

  const World& world_;
  RTCDevice device_;
  RTCScene scene_;
  std::vector<Moving> all_;
  std::size_t num_triangles_ = 0;
};

int RunRebuild(const std::string& file, int num_turns) {
  constexpr std::int64_t kFrame_ns = 100'000'000;
  FrameMaker maker(ReadScenario(file), 1);
  maker.Make(0);
  const auto raw_trace = maker.MakeRawTrace();
  MovingTree rebuilt(maker.world(), RTC_BUILD_QUALITY_LOW);
  MovingTree refitted(maker.world(), RTC_BUILD_QUALITY_REFIT);
  WaitUntilIdle();
  std::vector<double> raw_ms, frame_ms, rebuild_ms, refit_ms;
  for (int turn = 0; turn < num_turns; ++turn) {
    const std::int64_t time_ns = kFrame_ns * (turn % 2);  // The window stays the same.
    raw_ms.push_back(CpuTimeOf_ms(raw_trace));
    frame_ms.push_back(CpuTimeOf_ms([&] { maker.Make(static_cast<std::uint32_t>(turn % 2)); }));
    rebuild_ms.push_back(CpuTimeOf_ms([&] { rebuilt.Move(time_ns); }));
    refit_ms.push_back(CpuTimeOf_ms([&] { refitted.Move(time_ns); }));
  }
  const double raw = Median(raw_ms);
  const double frame = Median(frame_ms);
  std::printf("way\tms\tx frame\tmoving triangles\n");
  const auto print = [&](const char* way, double ms) {
    std::printf("%s\t%.1f\t%.2f\t%zu\n", way, ms, ms / frame, rebuilt.num_triangles());
  };
  print("raw trace", raw);
  print("railcast", frame);
  print("raw trace, tree rebuilt", raw + Median(rebuild_ms));
  print("raw trace, tree refitted", raw + Median(refit_ms));
  return kExitSuccess;
}

}  // namespace

void AddRebuild(ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions rebuild =
      app.AddCommand("rebuild", "Measure what moving things cost in trees built anew");
  struct Options {
    std::string scenario;
    int num_turns = 5;
  };
  const auto options = std::make_shared<Options>();
  rebuild.AddOption("SCENARIO", options->scenario, "Scenario with objects that move").Required();
  rebuild.AddOption("--turns", options->num_turns, "Turns that each way takes")
      .Check(Whole({1, 1'000'000}))
      .ShowDefault();
  rebuild.WhenParsed([options, &command] {
    command = [options](const std::string&) {
      return RunRebuild(options->scenario, options->num_turns);
    };
  });
}

}  // namespace railcast
