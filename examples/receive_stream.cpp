// receive_stream.cpp: waits for three frames of railcast-generate stream on the given port.
#include <railcast/io/udp_grabber.h>
#include <railcast/railcast.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <iostream>
#include <thread>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    railcast::UdpGrabber grabber(railcast::ParseEndpoint(argv[1], railcast::kStreamPort));
    std::atomic<int> num_frames{0};
    std::function<void(const pcl::PointCloud<pcl::PointXYZI>::ConstPtr&)> callback =
        [&](const auto& cloud) {
          std::cout << cloud->header.seq << ": " << cloud->size() << " points" << std::endl;
          ++num_frames;
        };
    grabber.registerCallback(callback);
    grabber.start();
    for (int tick = 0; tick < 600 && num_frames < 3; ++tick) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    grabber.stop();
    return num_frames >= 3 ? 0 : 1;
  } catch (const railcast::InputError& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
