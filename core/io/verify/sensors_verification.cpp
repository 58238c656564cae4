#include <algorithm>
#include <set>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/unfinished_file.h"
#include "core/io/verify/findings.h"
#include "core/io/verify/verification.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The sensors of a folder whose sensors.json is missing or damaged, as far as their folders say.
std::vector<SensorRecord> SensorsThere(const fs::path& directory) {
  std::set<std::string> names;
  std::error_code error;  // The folder itself may be gone.
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    if (IsThere(entry.path() / kRunFile)) names.insert(entry.path().filename().string());
  }
  std::vector<SensorRecord> sensors;
  for (const std::string& name : names) sensors.push_back({.name = name, .folder = name});
  return sensors;
}

/// Whether a sensor is where its scenario has it, which is written in degrees, and has the frames
/// of its run.
bool IsAsInFolder(const SensorRecord& sensor, const fs::path& folder) {
  constexpr double kRounding = 1e-9;
  const auto run = ReadRun(ReadFileWhole(folder / kRunFile), ShownPath(folder / kRunFile));
  const LidarSpec lidar = ReadScenario(folder / kScenarioFile).lidar;
  const MountRecord& mount = sensor.vehicle_from_sensor;
  Transform said(mount.rotation);
  said.pretranslate(mount.translation_m);
  return sensor.name == sensor.folder && sensor.start_frame == run.start_frame &&
         sensor.num_frames == run.num_frames && sensor.stride == run.stride() &&
         sensor.rate_hz == lidar.scan.rate_hz && sensor.phase_s == lidar.scan.phase_s &&
         said.isApprox(VehicleFromSensor(lidar.mount), kRounding);
}

class SensorsVerifier : private Findings {
 public:
  explicit SensorsVerifier(const fs::path& directory) : directory_(directory) {}

  Verification Run(const std::function<void(double)>& on_progress) {
    known_.insert(std::string(kSensorsFile));
    const bool has_record = Try([&] { ReadTheRecord(); });
    if (!has_record) Try([&] { record_.sensors = SensorsThere(directory_); });
    const auto num_sensors = static_cast<double>(record_.sensors.size());
    for (std::size_t i = 0; i < record_.sensors.size(); ++i) {
      CheckSensor(record_.sensors[i], [&](double share) {
        on_progress((static_cast<double>(i) + share) / num_sensors);
      });
    }
    if (record_.merged) Try([&] { CheckMerged(); });
    // Nothing is said of them before they are all there.
    if (!has_record) folders_.insert(std::string(kMergedFolder));
    FindOthers(directory_, "belongs to none of the run's sensors", folders_);
    return Take();
  }

 private:
  void ReadTheRecord() {
    const fs::path file = directory_ / kSensorsFile;
    const std::string place = ShownPath(file);
    if (!IsThere(file)) {
      known_.insert(std::string(kSensorsFile) + std::string(kUnfinishedSuffix));
      throw InputError({Fault{place, "missing: the run is unfinished", ""}});
    }
    const std::string text = ReadFileWhole(file);
    ++result_.num_files;
    result_.num_bytes += text.size();
    record_ = ReadSensorsText(text, place);
    is_old_ = !record_.has_hashes() && text == WithoutManifestHash(text);
    if (!is_old_) {
      Try([&] { CheckManifestHash(text, place); });
      return;
    }
    result_.unchecked.push_back(place +
                                ": an older railcast wrote it without hashes: whether it names all "
                                "sensors of the run, in their order, is not known");
  }

  void CheckSensor(const SensorRecord& sensor, const std::function<void(double)>& on_progress) {
    const fs::path folder = directory_ / sensor.folder;
    folders_.insert(sensor.folder);
    if (!sensor.manifest_hash.empty() && IsThere(folder / kManifestFile)) {
      CheckHash(folder / kManifestFile, sensor.manifest_hash, std::string(kSensorsFile));
    }
    const bool is_read = Try([&] { Add(VerifySequence(folder, on_progress)); });
    if (!is_read) return;
    Try([&] { AddBag(sensor); });
    // What is wrong with the folder's own files has been said.
    ErrorList known;
    const auto is_same = Attempt("", known, [&] { return IsAsInFolder(sensor, folder); });
    if (!is_old_ || is_same.value_or(true)) return;
    faults_.Add({ShownPath(directory_ / kSensorsFile) + ": /sensors: " + Quoted(sensor.name),
                 "must be as the scenario and the run in its folder say", ""});
  }

  // It stands beside the folders of the sensors.
  void AddBag(const SensorRecord& sensor) {
    const fs::path run = directory_ / sensor.folder / kRunFile;
    const auto bag = ReadRun(ReadFileWhole(run), ShownPath(run)).bag;
    if (!bag) return;
    const std::string name = (fs::path(sensor.folder) / bag->path).lexically_normal().string();
    known_.insert({name, std::string(kBagLinesFile)});
    folders_.insert(name);  // It may be one.
    if (!IsThere(directory_ / kSensorsFile)) known_.insert(name + std::string(kUnfinishedSuffix));
  }

  void CheckMerged() {
    const auto merged = MergedFolderIn(directory_);
    folders_.insert(record_.merged->folder);
    Verification found = VerifyMerged(*merged, [](double) {});
    found.num_frames = 0;  // They are those of the sequences.
    Add(found);
  }

  const fs::path& directory_;
  SensorsRecord record_;
  bool is_old_ = false;
  NameSet folders_;  ///< What is in them has been looked at.
};

}  // namespace

bool IsOfSensors(const fs::path& directory) {
  return IsThere(directory / kSensorsFile) ||
         IsThere(directory / (std::string(kSensorsFile) + std::string(kUnfinishedSuffix)));
}

Verification VerifySensors(const fs::path& directory,
                           const std::function<void(double)>& on_progress) {
  return SensorsVerifier(directory).Run(on_progress);
}

}  // namespace railcast
