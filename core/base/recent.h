#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

namespace railcast {

/// The values that were used last, by what they were made of. Thread-safe.
template <class Key, class Value>
class Recent {
 public:
  /// @param most Weight of all values up to which they are kept; 0 = none is.
  explicit Recent(std::size_t most) : most_(most) {}

  /// The value of a key, which `make()`, a std::shared_ptr<const Value>, makes unless it is kept.
  /// Threads that need the same one at the same time may each make it; all get that of the first.
  template <class Make>
  [[nodiscard]] std::shared_ptr<const Value> Get(const Key& key, const Make& make) {
    return Get(key, make, [](const Value&) { return std::size_t{1}; });
  }
  /// @param weigh Gives the weight of a value.
  template <class Make, class Weigh>
  [[nodiscard]] std::shared_ptr<const Value> Get(const Key& key,
                                                 const Make& make,
                                                 const Weigh& weigh) {
    if (auto known = Find(key)) return known;
    std::shared_ptr<const Value> made = make();
    if (most_ == 0) return made;
    std::list<Entry> unwanted;  // Freed after the lock is released.
    const std::lock_guard lock(mutex_);
    if (auto known = FindLocked(key)) return known;
    entries_.push_front({key, made, weigh(*made)});
    weight_ += entries_.front().weight;
    while (weight_ > most_) {
      weight_ -= entries_.back().weight;
      unwanted.splice(unwanted.begin(), entries_, std::prev(entries_.end()));
    }
    return made;
  }

 private:
  struct Entry {
    Key key;
    std::shared_ptr<const Value> value;
    std::size_t weight{};
  };

  [[nodiscard]] std::shared_ptr<const Value> Find(const Key& key) {
    const std::lock_guard lock(mutex_);
    return FindLocked(key);
  }
  [[nodiscard]] std::shared_ptr<const Value> FindLocked(const Key& key) {
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
      if (!(entry->key == key)) continue;
      entries_.splice(entries_.begin(), entries_, entry);
      return entries_.front().value;
    }
    return nullptr;
  }

  std::size_t most_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // The entry that was used last comes first.
  std::size_t weight_ = 0;
};

}  // namespace railcast
