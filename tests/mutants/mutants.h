#pragma once

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/remark.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {

/// What a reader makes of a file.
struct Reading {
  std::string fault{};            ///< Why it is refused; empty if it is read.
  std::vector<Remark> remarks{};  ///< What is told.
  std::vector<double> values{};   ///< All that it means, alike to 1e-4: m, ns.
};

/// Mutants of one good file: changes of known meaning, as they happen to people's files. A mutant
/// is refused, or a remark tells of it, or it means what the good file does. All others are read
/// wrong without a word.
class Mutants {
 public:
  using Reader = std::function<Reading(const std::filesystem::path& file)>;

  /// @param file Its name, in a folder of its own.
  /// @param good Its bytes. They must be read; what is told of them is told of each mutant, too.
  Mutants(std::string reader, const std::string& file, std::string good, Reader read);

  /// Reads a mutant, unless it is the good file.
  /// @param change What was done, a row of the table.
  /// @param detail To find it by.
  /// @return Why it is refused; empty if it is not.
  std::string Try(const std::string& change, const std::string& detail, const std::string& bytes);
  /// As Try(), but expects that the mutant is another file than the good one, and is read.
  void TryHarmless(const std::string& change, const std::string& bytes);
  /// Nobody can tell some mutants of this change, for this reason.
  void Excuse(const std::string& change, const std::string& reason) { excuses_[change] = reason; }
  /// Expects that no mutant was read wrong without a word, but for those with an excuse.
  /// @return The rows of the page.
  [[nodiscard]] std::string Rows() const;

  [[nodiscard]] const std::string& good() const { return good_; }
  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }
  [[nodiscard]] std::size_t num() const;

 private:
  struct Row {
    std::string change;
    std::size_t num_refused = 0;
    std::size_t num_told = 0;
    std::size_t num_equal = 0;
    std::set<std::string> remarks{};
    std::vector<std::string> silent{};
  };
  [[nodiscard]] Reading Read(const std::string& bytes) const;

  std::string reader_;
  TemporaryDirectory folder_;
  std::filesystem::path file_;
  std::string good_;
  Reader read_;
  Reading expected_;
  std::vector<Row> rows_;
  std::map<std::string, std::string> excuses_;
};

/// Reads all frames of a recording.
[[nodiscard]] Reading ReadRecordingWhole(const std::filesystem::path& source);

/// Compares a section of docs/results/mutants.md with what the tests found, or writes it:
///   RAILCAST_WRITE_MUTANTS=1 build/ci/tests/mutants/mutants_test
void CheckSection(const std::string& heading, const std::vector<const Mutants*>& all);

/// The bytes of a number, in the machine's order.
template <typename Number>
[[nodiscard]] std::string BytesOf(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

/// The bytes with others in their place.
[[nodiscard]] inline std::string With(std::string bytes,
                                      std::size_t place,
                                      const std::string& new_bytes) {
  return bytes.replace(place, new_bytes.size(), new_bytes);
}

/// The text with the number-th occurrence (from 0) of a part replaced; the text itself where there
/// are not so many.
[[nodiscard]] std::string Replaced(std::string text,
                                   const std::string& part,
                                   const std::string& other,
                                   std::size_t number = 0);
[[nodiscard]] std::string AllReplaced(std::string text,
                                      const std::string& part,
                                      const std::string& other);

/// A part of a text that becomes another.
struct TextChange {
  std::string what;
  std::string part;
  std::string other;
};

/// Each of the changes where the part stands for the first, second, ... time, and everywhere.
void TryChanges(Mutants& mutants, const std::vector<TextChange>& changes);

/// What happens to files of any format while they are copied.
/// @param step Between places that are tried, bytes.
void TryCuts(Mutants& mutants, std::size_t step);

}  // namespace railcast
