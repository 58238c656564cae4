// read_recording.cpp: lists the frames of a recording: a run of railcast, clouds of any source, or
// a sensor's capture.
#include <railcast/io/recording.h>
#include <railcast/railcast.h>

#include <algorithm>
#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const auto recording = railcast::OpenRecording(argv[1]);
    std::cout << recording->info().kind << '\n';
    while (const auto read = recording->Next()) {
      const railcast::RecordedFrame recorded = (*read)();
      const auto& outcomes = recorded.frame.outcome;
      std::cout << recorded.name << ": "
                << std::count_if(outcomes.begin(), outcomes.end(), railcast::HasPoint)
                << " points in " << recorded.frame.rows << " rows, "
                << (recorded.Has("label") ? "with" : "without") << " labels, "
                << recorded.objects.size() << " objects\n";
    }
  } catch (const railcast::InputError& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
