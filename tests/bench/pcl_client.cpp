// Counts what PCL's own grabbers for Velodyne sensors receive; it does not depend on railcast.
//
//   pcl-client vlp|hdl HOST PORT SECONDS [CALIBRATION.xml]
//
// Prints the number of sweeps and points, and the shortest and longest time between arrivals of
// sweeps.

#include <pcl/io/hdl_grabber.h>
#include <pcl/io/vlp_grabber.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using Cloud = pcl::PointCloud<pcl::PointXYZI>;

struct Arrival {
  Clock::time_point time;
  std::size_t points{};
};

std::unique_ptr<pcl::HDLGrabber> MakeGrabber(const std::vector<std::string>& arguments) {
  const auto address = boost::asio::ip::address::from_string(arguments[1]);
  const auto port = static_cast<std::uint16_t>(std::stoi(arguments[2]));
  if (arguments[0] == "vlp") return std::make_unique<pcl::VLPGrabber>(address, port);
  return std::make_unique<pcl::HDLGrabber>(address, port,
                                           arguments.size() > 4 ? arguments[4] : std::string());
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() < 4 || (arguments[0] != "vlp" && arguments[0] != "hdl")) {
    std::fprintf(stderr, "usage: pcl-client vlp|hdl HOST PORT SECONDS [CALIBRATION.xml]\n");
    return 2;
  }
  const auto grabber = MakeGrabber(arguments);
  std::mutex mutex;
  std::vector<Arrival> arrivals;
  const std::function<void(const Cloud::ConstPtr&)> take = [&](const Cloud::ConstPtr& cloud) {
    const std::lock_guard lock(mutex);
    arrivals.push_back({Clock::now(), cloud->size()});
  };
  grabber->registerCallback(take);
  grabber->start();
  std::this_thread::sleep_for(std::chrono::duration<double>(std::stod(arguments[3])));
  const std::lock_guard lock(mutex);
  if (arrivals.size() < 2) {
    std::printf("%zu sweeps\n", arrivals.size());
    std::fflush(stdout);
    std::_Exit(1);
  }
  std::size_t points = 0;
  std::chrono::duration<double, std::milli> shortest(1e9);
  std::chrono::duration<double, std::milli> longest(0);
  for (std::size_t i = 1; i < arrivals.size(); ++i) {
    points += arrivals[i].points;
    const auto gap = arrivals[i].time - arrivals[i - 1].time;
    shortest = std::min<std::chrono::duration<double, std::milli>>(shortest, gap);
    longest = std::max<std::chrono::duration<double, std::milli>>(longest, gap);
  }
  const double num_gaps = static_cast<double>(arrivals.size() - 1);
  const std::chrono::duration<double> total = arrivals.back().time - arrivals.front().time;
  std::printf("%zu sweeps, %.3f Hz, %.0f points each, %.1f to %.1f ms apart\n", arrivals.size(),
              num_gaps / total.count(), static_cast<double>(points) / num_gaps, shortest.count(),
              longest.count());
  std::fflush(stdout);
  // PCL's stop() would wait for one more datagram.
  std::_Exit(0);
}
