#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare/cloud_figures.h"
#include "analysis/compare/separability.h"
#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "railcast/io/recording.h"

namespace railcast {

/// How frames are paired.
enum class Pairing {
  kIndex,  ///< By position in their recordings.
  kStamp,  ///< By stamp: the nearest, at most half of A's frame spacing apart.
};

struct FramePair {
  RecordedFrame a, b;
  std::uint64_t num_frames_a{};  ///< Frames of A so far, with a partner or without.
};

/// Pairs the frames of two recordings in order of time, each in at most one pair; frames without a
/// partner are counted.
class FramePairs {
 public:
  /// @param pairing By default: by stamp if the stamps of both recordings rise, else by index.
  FramePairs(Recording& a, Recording& b, std::optional<Pairing> pairing);

  /// Returns nothing at the end of both recordings.
  /// @throws InputError as the recordings do.
  [[nodiscard]] std::optional<FramePair> Next();

  [[nodiscard]] Pairing pairing() const { return pairing_; }
  /// Number of frames of A without a partner; complete once Next() has returned nothing.
  [[nodiscard]] std::uint64_t num_alone_a() const { return a_.num_dropped; }
  [[nodiscard]] std::uint64_t num_alone_b() const { return b_.num_dropped; }

 private:
  // One recording with up to two frames read ahead.
  struct Side {
    Recording& recording;
    std::deque<RecordedFrame> frames;
    std::uint64_t num_dropped = 0;

    void Fill();
    RecordedFrame Take();
    void Drop();
    void DropRest();
    [[nodiscard]] std::optional<std::int64_t> Spacing_ns() const;
  };

  [[nodiscard]] std::optional<FramePair> NextByIndex();
  [[nodiscard]] std::optional<FramePair> NextByStamp();

  Side a_, b_;
  Pairing pairing_{};
  std::int64_t tolerance_ns_{};
  std::uint64_t num_pairs_{};
};

/// "index" or "stamp".
[[nodiscard]] std::string PairingName(Pairing pairing);

/// The figures that are computed for every pair of frames, in the order of PairFigures::values, as
/// columns of a table.
/// @param registers Whether the clouds were registered, of which the last ones are.
[[nodiscard]] std::vector<TableColumn> PairMetrics(const std::vector<double>& distances_m,
                                                   bool registers = false);

/// The figures of one pair of frames.
struct PairFigures {
  std::uint32_t index_a{}, index_b{};
  std::int64_t stamp_a_ns{}, stamp_b_ns{};
  std::uint64_t num_points_a{}, num_points_b{};
  std::vector<double> values;  ///< NaN where a frame has no points or lacks the field.
};

/// Compares two recordings pair by pair. Its size hardly grows with their length.
class Comparison {
 public:
  /// @param registers Whether each cloud of B is first laid on that of A, from where it is.
  explicit Comparison(std::vector<double> distances_m, bool registers = false);

  /// The input of Add(), which can be computed on any thread.
  struct Part {
    PairFigures figures;
    CloudHistograms histograms_a, histograms_b;
    BinnedCloud bins_a, bins_b;
  };
  /// @throws InputError if B's cloud cannot be laid on A's.
  [[nodiscard]] Part Compare(const RecordedFrame& a, const RecordedFrame& b) const;
  void Add(const Part& part);

  [[nodiscard]] const std::vector<TableColumn>& metrics() const { return metrics_; }
  [[nodiscard]] const std::vector<double>& distances_m() const { return distances_m_; }
  [[nodiscard]] bool registers() const { return registers_; }
  [[nodiscard]] std::uint64_t num_pairs() const { return num_pairs_; }

  /// One metric over all pairs.
  struct Summary {
    Moments moments;
    double sum{};
    double least = std::numeric_limits<double>::infinity();
    double largest = -std::numeric_limits<double>::infinity();
    /// Plain mean of the pairs that have the metric, without an interval; NaN if none has it.
    [[nodiscard]] double Mean() const;
  };
  [[nodiscard]] const std::vector<Summary>& summaries() const { return summaries_; }
  /// Every pair or, in long recordings, every pair_stride()-th one.
  [[nodiscard]] const std::vector<PairFigures>& pairs() const { return pairs_; }
  [[nodiscard]] std::uint64_t pair_stride() const { return stride_; }
  [[nodiscard]] const CloudHistograms& histograms_a() const { return histograms_a_; }
  [[nodiscard]] const CloudHistograms& histograms_b() const { return histograms_b_; }
  [[nodiscard]] const BinSums& bins() const { return bins_; }

 private:
  std::vector<double> distances_m_;
  bool registers_;
  std::vector<TableColumn> metrics_;
  std::vector<Summary> summaries_;
  std::vector<PairFigures> pairs_;
  std::uint64_t num_pairs_{}, stride_ = 1;
  CloudHistograms histograms_a_, histograms_b_;
  BinSums bins_;
};

/// Called after each pair with its num_frames_a, on one thread at a time.
using ComparisonProgress = std::function<void(std::uint64_t num_frames_a)>;

/// Compares all pairs, several at a time; the figures do not depend on the number of threads.
/// @param patches Also of all pairs.
/// @throws InputError as the recordings do.
void CompareAll(FramePairs& pairs,
                Comparison& comparison,
                PatchPairs& patches,
                const ComparisonProgress& on_progress);

}  // namespace railcast
