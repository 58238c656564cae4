#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace railcast {

/// One thing in the user's input that is wrong.
struct Fault {
  /// Where: a file, a JSON pointer or an option, or several of these from the outermost inwards.
  /// Empty if `rule` itself names the place.
  std::string place;
  std::string rule;   ///< What should be, for example "must be > 0".
  std::string value;  ///< What is there instead, as messages show it. Empty: nothing to show.

  /// "place: rule (got value)", without the parts that are empty.
  [[nodiscard]] std::string Line() const;

  bool operator==(const Fault&) const = default;
};

/// An error in the user's input: a scenario, a mesh, a command line or a file.
///
/// `what()` holds a line for each of the first 20 faults; faults() has all of them. For example
///
///     scenarios/demo.json: /lidar/range_max_m: must be > 0 (got -5)
class InputError : public std::runtime_error {
 public:
  /// @param lines One fault per line; each line becomes the `rule` of a Fault without a place.
  explicit InputError(const std::string& lines);
  explicit InputError(std::vector<Fault> faults);

  [[nodiscard]] const std::vector<Fault>& faults() const { return *faults_; }

 private:
  std::shared_ptr<const std::vector<Fault>> faults_;  // Copies of an exception must not throw.
};

}  // namespace railcast
