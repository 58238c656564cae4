#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/certify/certified_figures.h"
#include "core/certify/certifier.h"
#include "core/io/datagrams.h"
#include "core/io/net/udp.h"
#include "generator/live/live_clock.h"
#include "generator/live/live_run.h"
#include "generator/run/frame_maker.h"
#include "railcast/camera.h"
#include "railcast/frame.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/stream.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

class LiveTopics;

/// Renders the images of a scenario's camera and sends them to its receivers.
class CameraStream {
 public:
  /// @param scenario Has a camera with receivers, and one sensor, whose stamps the images have.
  /// @param run Distinguishes this start from others.
  /// @throws InputError if a receiver cannot be sent to.
  CameraStream(const ScenarioSpec& scenario, const SendOptions& sending, std::uint32_t run);

  [[nodiscard]] const std::string& name() const { return camera_.spec().name; }
  /// The sensor's frame that has the stamp of an image.
  [[nodiscard]] std::uint32_t FrameOf(std::uint32_t image) const { return image * num_frames_; }

  /// Appends the datagrams of an image.
  /// @param simulator The sensor's, in the state of that frame.
  void Make(Simulator& simulator, std::uint32_t image, Datagrams& datagrams);
  /// Restarts with image 0.
  void Restart(std::uint32_t run) { run_ = run; }
  /// Sets how far the stamps of images are ahead of simulation time, also after a restart.
  void SetClockAhead(std::int64_t ahead_ns) { clock_ahead_ns_ = ahead_ns; }

  /// May be called from another thread than the other functions.
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
    sender_.Send(datagrams, items);
  }
  [[nodiscard]] const UdpSender::Counts& delivered() const { return sender_.counts(); }

 private:
  Camera camera_;
  std::uint32_t num_frames_;
  std::uint32_t run_;
  std::int64_t clock_ahead_ns_{};
  CameraImage image_;
  UdpSender sender_;
};

/// The receivers of the scenario's images; empty if it has no camera or the camera names none.
/// @throws InputError "/camera/udp: ..." if one cannot be understood.
[[nodiscard]] std::vector<Endpoint> ImageReceivers(const ScenarioSpec& scenario);

/// How a sensor's frames are sent.
struct SensorStreamSpec {
  std::string name;
  std::uint16_t sensor{};  ///< Its number on the vehicle.
  Protocol protocol = Protocol::kRailcast;
  std::vector<Endpoint> to;
  SendOptions sending;
  StampClock clock = StampClock::kSimulated;
  std::optional<std::filesystem::path> pcap;
  FieldSelection fields;  ///< For protocol railcast only, as is the next member.
  bool has_all_slots{};
};

/// Whether the frames of a sensor have any.
[[nodiscard]] bool HasReaders(const SensorStreamSpec& stream);

/// Encodes one sensor's frames and hands them to its receivers and to a capture file. If the system
/// refuses to write the capture, as on a full disk, the capture ends, but receivers continue to get
/// all frames.
class SensorStream {
 public:
  /// @param scenario The scenario with this sensor as its only one.
  /// @param pattern Scan pattern of the frames; must outlive the stream.
  /// @param run Distinguishes this start of the sensor from others in protocol railcast.
  /// @throws InputError if the sensor does not fit the protocol, a receiver cannot be sent to or
  ///   the file cannot be created.
  SensorStream(SensorStreamSpec spec,
               const ScenarioSpec& scenario,
               const ScanPattern& pattern,
               std::uint32_t run);

  [[nodiscard]] const SensorStreamSpec& spec() const { return spec_; }

  void Encode(const Frame& frame, Datagrams& datagrams) { encoder_->Encode(frame, datagrams); }
  /// Restarts with frame 0.
  void Restart(std::uint32_t run);
  /// Sets how far UTC is ahead of simulation time, as FrameEncoder::SetClockAhead() does, also
  /// after a restart; the sensor's clock follows. The stamps of a capture, which state UTC, stay
  /// what they were first.
  void SetUtcAhead(std::int64_t ahead_ns);

  /// May be called from another thread than the other functions.
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items);

  /// Completes the capture file.
  void Finish();
  /// Returns why the capture ended early and how much of it there is, or nothing if it did not end
  /// early. Thread-safe.
  [[nodiscard]] std::optional<std::string> capture_fault() const;
  /// Returns the numbers of datagrams delivered to receivers.
  [[nodiscard]] UdpSender::Counts delivered() const;

 private:
  [[nodiscard]] std::unique_ptr<FrameEncoder> MakeEncoder(std::uint32_t run) const;
  /// Calls `work(capture)`; if that throws, the capture ends.
  template <typename Work>
  void UseCapture(const Work& work);

  SensorStreamSpec spec_;
  LidarSpec lidar_;
  OutputSpec output_;
  const ScanPattern& pattern_;
  std::unique_ptr<FrameEncoder> encoder_;
  std::unique_ptr<UdpSender> sender_;      ///< Null if there are no receivers.
  std::unique_ptr<DatagramFile> capture_;  ///< Null if there is no capture.
  bool has_capture_clock_ = false;         ///< Whether the capture's stamps were set ahead.
  std::uint64_t num_captured_{};           ///< Datagrams captured.
  mutable std::mutex mutex_;               ///< Guards capture_fault_.
  std::optional<std::string> capture_fault_;
};

/// Certifies the frames of a sensor and adds up what that tells.
class LiveCertificate {
 public:
  /// So many firings, some 100 bytes each, tell enough: then nothing more is done.
  static constexpr std::uint64_t kMostDrawn = 1'000'000;

  /// @param maker Must outlive this object. The sensor has the effects of its frames.
  /// @param scenario With this sensor alone.
  /// @throws InputError as Certifier does.
  LiveCertificate(FrameMaker& maker,
                  std::size_t sensor,
                  const ScenarioSpec& scenario,
                  double cost_share);

  /// Certifies frames that are not added, and keeps the time that one takes.
  void Try(const Frame& frame);
  [[nodiscard]] std::int64_t tried_ns() const { return tried_ns_; }

  /// @pre Commands that came after the frame are not applied yet.
  void Add(const Frame& frame);
  /// Forgets all frames: those that are made again would be drawn from in the same way.
  void Restart();

  [[nodiscard]] RunCertificate Result() const { return sums_.Result(maker_.labels()); }

 private:
  [[nodiscard]] FrameCertificate Certify(const Frame& frame);

  FrameMaker& maker_;
  std::size_t sensor_;
  Certifier certifier_;
  CertifySpec spec_;
  CertificateSums sums_;
  std::uint64_t num_drawn_ = 0;
  std::int64_t tried_ns_{};
};

/// All sensors of one vehicle and the destinations of their frames; they share one world and one
/// clock. Frames of protocol ros2 go to LiveTopics, all others over UDP. If the scenario has a
/// camera with receivers, its images accompany the frames of the first sensor, unless nothing is
/// sent.
class LiveStreams {
 public:
  /// @param streams One for each of the scenario's sensors, in its order.
  /// @param run Distinguishes this start from others in protocol railcast.
  /// @param isa As MakeSimulators() takes it.
  /// @param ends_ns If given, the simulation time until which nothing may leave its track.
  /// @throws InputError as MakeSimulators(), CheckStaysOnTracks() and SensorStream do, in this
  ///   order, so that no file is created for a run that cannot be made.
  LiveStreams(const ScenarioSpec& scenario,
              const std::vector<SensorStreamSpec>& streams,
              int num_threads,
              std::uint32_t run,
              const std::string& isa,
              std::optional<std::int64_t> ends_ns = std::nullopt);

  [[nodiscard]] FrameMaker& maker() { return maker_; }

  /// Publishes the frames of the sensors of protocol ros2 on these topics from now on.
  /// @param topics Opened with maker(), must outlive this object; null where no sensor is of ros2.
  void Publish(LiveTopics* topics);

  /// Has the frames of all sensors certified. To be called before WarmUp().
  /// @param cost_share As Certifier takes it.
  void Certify(double cost_share) { certified_share_ = cost_share; }
  /// Adds what the certificates tell to a run's records.
  void AddCertificates(std::vector<LiveRecord>& records) const;

  /// Does slow work beforehand, so that it makes no frame late: builds the scene of frame 0 and, if
  /// the scenario asks for it, makes fidelity auto's choice. From now on the building of scenes is
  /// watched as by WatchBuilding(). Returns early if stopped.
  /// @pre No frame has been made.
  /// @throws InputError as LiveCertificate does.
  void WarmUp(const std::function<bool()>& is_stopped);

  /// Returns the sensors for RunLive(): those of UDP, those of ROS 2, the camera. Valid as long as
  /// this object.
  [[nodiscard]] std::vector<LiveSensor> Sensors();

  /// Restarts all sensors with frame 0.
  /// @pre The maker has been reset.
  void Restart();

  /// Sets the clocks of all sensors that do not state simulation time by the time of day.
  /// @param now_ns Time since 1970-01-01 00:00:00 UTC.
  /// @param lead_ns How long after that the first frame begins.
  void SetClocks(std::int64_t now_ns, std::int64_t lead_ns);

  /// Completes the capture files.
  void Finish();
  /// Returns a line for each capture that ended early. Thread-safe.
  [[nodiscard]] std::vector<std::string> CaptureFaults() const;
  /// Returns the numbers of datagrams delivered, in the order of Sensors().
  /// @pre Nothing is being sent.
  [[nodiscard]] std::vector<UdpSender::Counts> Delivered() const;

 private:
  void ChooseFidelity();
  void MakeFrame(SensorStream& stream, std::uint32_t frame, Datagrams& datagrams);

  FrameMaker maker_;
  std::vector<std::unique_ptr<SensorStream>> streams_;  ///< The streams by UDP.
  LiveTopics* topics_ = nullptr;
  std::unique_ptr<CameraStream> camera_;  ///< Null if no images are sent.
  std::vector<Frame> frames_;             ///< By sensor.
  std::optional<double> certified_share_;
  /// By name of the sensor; empty if frames are not certified.
  std::map<std::string, LiveCertificate> certificates_;
  std::uint32_t run_;
};

}  // namespace railcast
