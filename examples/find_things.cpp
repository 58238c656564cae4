// find_things.cpp: a pipeline of PCL on labelled clouds: thins them, takes the ground away, and
// puts boxes around what is left.
//
//     find_things SCENARIO|FRAME.pcd|HOST:PORT
//
// Of a scenario it takes frame 0, of a stream (railcast-generate stream) the first frame.
#include <pcl/common/common.h>
#include <pcl/common/io.h>
#include <pcl/conversions.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>
#include <railcast/io/cloud_files.h>
#include <railcast/io/point_types.h>
#include <railcast/io/udp_grabber.h>
#include <railcast/railcast.h>

#include <functional>
#include <future>
#include <iostream>
#include <map>
#include <string>
#include <vector>

using Labelled = pcl::PointCloud<railcast::LabelledPoint>;
// PCL's libraries hold its algorithms for this type.
using Cloud = pcl::PointCloud<pcl::PointXYZL>;

Labelled FrameOf(const std::string& scenario) {
  railcast::Frame frame;
  railcast::MakeSimulator(railcast::ReadScenario(scenario), 0)->Scan(0, frame);
  return railcast::ToPointCloud<railcast::LabelledPoint>(frame);
}

Labelled FileOf(const std::string& file) {
  Labelled cloud;
  pcl::fromPCLPointCloud2(railcast::ReadPcd(file), cloud);
  return cloud;
}

Labelled FirstOfStream(const std::string& at) {
  railcast::UdpGrabber grabber(railcast::ParseEndpoint(at, railcast::kStreamPort));
  std::promise<Labelled> first;
  bool is_set = false;
  std::function<void(const Labelled::ConstPtr&)> take = [&](const Labelled::ConstPtr& cloud) {
    if (!is_set) first.set_value(*cloud);
    is_set = true;
  };
  grabber.registerCallback(take);
  grabber.start();
  Labelled cloud = first.get_future().get();
  grabber.stop();
  return cloud;
}

/// The points, thinned to one for each cell of 0.2 m.
Cloud::Ptr Thinned(const Labelled& labelled) {
  const Cloud::Ptr all(new Cloud), thinned(new Cloud);
  pcl::copyPointCloud(labelled, *all);
  pcl::VoxelGrid<pcl::PointXYZL> grid;
  grid.setInputCloud(all);
  grid.setLeafSize(0.2F, 0.2F, 0.2F);
  grid.filter(*thinned);
  return thinned;
}

/// What is not on the largest level plane.
Cloud::Ptr WithoutGround(const Cloud::Ptr& cloud) {
  pcl::SACSegmentation<pcl::PointXYZL> segmentation;
  segmentation.setModelType(pcl::SACMODEL_PERPENDICULAR_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setAxis(Eigen::Vector3f::UnitZ());
  segmentation.setEpsAngle(0.1);
  segmentation.setDistanceThreshold(0.25);
  segmentation.setInputCloud(cloud);
  const pcl::PointIndices::Ptr ground(new pcl::PointIndices);
  pcl::ModelCoefficients plane;
  segmentation.segment(*ground, plane);
  std::cout << cloud->size() << " cells, " << ground->indices.size() << " of the ground\n";
  const Cloud::Ptr rest(new Cloud);
  pcl::ExtractIndices<pcl::PointXYZL> extract;
  extract.setInputCloud(cloud);
  extract.setIndices(ground);
  extract.setNegative(true);
  extract.filter(*rest);
  return rest;
}

/// Prints the box and the most frequent label of each cluster.
int PrintThings(const Cloud::Ptr& cloud) {
  std::vector<pcl::PointIndices> clusters;
  pcl::EuclideanClusterExtraction<pcl::PointXYZL> extraction;
  extraction.setClusterTolerance(0.6);
  extraction.setMinClusterSize(40);
  extraction.setInputCloud(cloud);
  extraction.extract(clusters);
  for (const pcl::PointIndices& cluster : clusters) {
    Eigen::Vector4f low_m, high_m;
    pcl::getMinMax3D(*cloud, cluster, low_m, high_m);
    std::map<std::uint32_t, int> votes;
    std::uint32_t label = 0;
    for (const int index : cluster.indices) {
      const std::uint32_t its = (*cloud)[static_cast<std::size_t>(index)].label;
      if (++votes[its] > votes[label]) label = its;
    }
    const Eigen::Vector3f size_m = (high_m - low_m).head<3>();
    std::cout << cluster.indices.size() << " cells of label " << label << " in a box of "
              << size_m.transpose() << " m at "
              << (low_m + 0.5F * (high_m - low_m)).head<3>().transpose() << " m\n";
  }
  return clusters.empty() ? 1 : 0;
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string source = argv[1];
  try {
    const Labelled cloud = source.ends_with(".json")  ? FrameOf(source)
                           : source.ends_with(".pcd") ? FileOf(source)
                                                      : FirstOfStream(source);
    return PrintThings(WithoutGround(Thinned(cloud)));
  } catch (const railcast::InputError& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
