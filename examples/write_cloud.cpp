// write_cloud.cpp: writes a frame of a scenario as PCD, and reads it as any program with PCL does.
#include <railcast/io/cloud_files.h>
#include <railcast/railcast.h>

#include <fstream>
#include <iostream>
#include <string>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const auto simulator = railcast::MakeSimulator(railcast::ReadScenario(argv[1]), 0);
    railcast::Frame frame;
    simulator->Scan(0, frame);
    std::string bytes;
    railcast::EncodePcd(frame, railcast::FieldSelection("x,y,z,intensity,label"),
                        railcast::PcdEncoding::kBinary, bytes);
    std::ofstream(argv[2], std::ios::binary) << bytes;

    const pcl::PCLPointCloud2 cloud = railcast::ReadPcd(argv[2]);
    std::cout << cloud.width * cloud.height << " points\n";
    return cloud.width * cloud.height == frame.num_slots() ? 0 : 1;
  } catch (const railcast::InputError& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
