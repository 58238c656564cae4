#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/io/net/udp_sender.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/stream/stream_example.h"
#include "tests/viewer/view_program.h"

namespace railcast {
namespace {

/// What WriteSquares writes, as a frame of one row; the last slot has no point.
Frame SquaresFrame(std::uint32_t index) {
  std::vector<std::array<float, 3>> points = {{-40.0F, 0.0F, 0.0F}};
  for (int iy = -20; iy <= 20; ++iy) {
    for (int iz = -20; iz <= 20; ++iz) {
      for (int square = 0; square < 2; ++square) {
        points.push_back({40.0F, 0.05F * static_cast<float>(iy) + 5.0F * static_cast<float>(square),
                          0.05F * static_cast<float>(iz)});
      }
    }
  }
  Frame frame;
  frame.index = index;
  frame.Resize(1, static_cast<std::uint32_t>(points.size() + 1), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    frame.x[i] = points[i][0];
    frame.y[i] = points[i][1];
    frame.z[i] = points[i][2];
  }
  frame.outcome.back() = Outcome::kNoSurface;
  return frame;
}

/// Sends these datagrams again and again, `pause` apart, until it ends.
class EndlessSender {
 public:
  EndlessSender(const Endpoint& to, std::vector<Datagrams> scans)
      : thread_([this, to, scans = std::move(scans)] {
          UdpSender sender({to}, 0);
          while (goes_on_) {
            for (const Datagrams& scan : scans) {
              sender.Send(scan, scan.items);
              std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
          }
        }) {}
  ~EndlessSender() {
    goes_on_ = false;
    thread_.join();
  }
  EndlessSender(const EndlessSender&) = delete;
  EndlessSender& operator=(const EndlessSender&) = delete;

 private:
  std::atomic<bool> goes_on_{true};
  std::thread thread_;
};

Datagrams Scan(const Frame& frame, const StreamSpec& spec = {}) {
  Datagrams scan;
  StreamEncoder(StreamPattern(frame.rows, frame.columns), spec).Encode(frame, scan);
  return scan;
}

TEST_F(Screenshot, ShowsTheFirstWholeFrameOfAStream) {
  const Endpoint at = OwnEndpoint();
  Datagrams half = Scan(SquaresFrame(0));
  half.items.resize(half.items.size() / 2);
  const EndlessSender sender(at, {half, Scan(SquaresFrame(1)), Scan(SquaresFrame(2))});
  Draw("--color-by height udp://" + EndpointText(at));
  // As ShowsHeightOnTheScale.
  for (const double z_m : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    EXPECT_NEAR(PlaceOnScale(At(0.0, PixelsAbove(z_m))), 0.5 + 0.5 * z_m, 2.0 / 36.0) << z_m;
    EXPECT_NEAR(PlaceOnScale(At(-5.0 * MetreInPixels(), PixelsAbove(z_m))), 0.5 + 0.5 * z_m,
                2.0 / 36.0)
        << z_m;
  }
}

TEST_F(Screenshot, KeepsUpWithAStream) {
  const std::string source = "udp://" + EndpointText(OwnEndpoint());
  ListeningProgram view(std::string(kOnADisplay) + " --color-by intensity " + source);
  UdpSender sender({view.at()}, 0);
  const Datagrams first = Scan(SquaresFrame(1));
  sender.Send(first, first.items);
  // The window opens for that one, and lives until a frame comes that it cannot colour.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  StreamSpec without_intensity;
  without_intensity.fields = FieldSelection("x,y,z");
  const EndlessSender later(view.at(), {Scan(SquaresFrame(2)), Scan(SquaresFrame(3)),
                                        Scan(SquaresFrame(4), without_intensity)});
  EXPECT_EQ(view.Rest(), "error: " + source + ": has no field intensity to color by\n");
  EXPECT_EQ(view.ExitStatus(), 1);
}

}  // namespace
}  // namespace railcast
