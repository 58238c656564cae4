#include "generator/extras/insert/clouds/edit_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/field_layout.h"
#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/cloud_frame.h"

namespace railcast {
namespace {

constexpr std::size_t kNoCell = std::numeric_limits<std::size_t>::max();

/// Measured values saturate in a type that cannot hold them, as in sensors; numbers of labels and
/// instances must not.
template <typename Stored, typename Value>
Stored Convert(Value value) {
  using Limits = std::numeric_limits<Stored>;
  if constexpr (std::is_floating_point_v<Stored>) {
    return static_cast<Stored>(value);
  } else if constexpr (std::is_floating_point_v<Value>) {
    if (std::isnan(value)) return Stored{};
    // No value of a return comes near the greatest of 64 bits.
    constexpr double kMost = 9e18;
    const double least = std::max(-kMost, static_cast<double>(Limits::min()));
    const double most = std::min(kMost, static_cast<double>(Limits::max()));
    return static_cast<Stored>(std::llround(std::clamp(double{value}, least, most)));
  } else {
    if (!std::in_range<Stored>(value)) {
      throw InputError("a field of the recording cannot hold the number " + NumberText(value) +
                       "; choose another --format than same");
    }
    return static_cast<Stored>(value);
  }
}

/// The last row of some points while its numbers are changed.
class RowDraft {
 public:
  /// Appends a row that is as that of an entry.
  RowDraft(const Cloud& cloud, std::size_t entry, OtherPoints& points) : cloud_(cloud) {
    const std::uint8_t* const row = cloud.data.data() + entry * cloud.point_step;
    points.data.insert(points.data.end(), row, row + cloud.point_step);
    points.sources.push_back(static_cast<std::uint32_t>(entry));
    row_ = points.data.data() + points.data.size() - cloud.point_step;
  }
  /// Appends a row without any values: NaN, or 0 where there is no NaN.
  RowDraft(const Cloud& cloud, OtherPoints& points) : cloud_(cloud) {
    points.data.resize(points.data.size() + cloud.point_step);
    points.sources.push_back(kNoSource);
    row_ = points.data.data() + points.data.size() - cloud.point_step;
    for (std::size_t i = 0; i < cloud.fields.size(); ++i) Clear(i);
  }

  template <typename Value>
  void Set(std::size_t cell, Value value) {
    const CloudField& field = cloud_.fields[cell];
    VisitNumberType(field.type, [&](auto zero) {
      const auto stored = Convert<decltype(zero)>(value);
      std::memcpy(row_ + field.offset, &stored, sizeof stored);
    });
  }
  void Clear(std::size_t cell) { Set(cell, std::numeric_limits<double>::quiet_NaN()); }
  /// Takes the number that an entry has.
  void Copy(std::size_t cell, std::size_t entry) {
    const CloudField& field = cloud_.fields[cell];
    std::memcpy(row_ + field.offset, cloud_.Row(entry).data() + field.offset, SizeOf(field.type));
  }

 private:
  const Cloud& cloud_;
  std::uint8_t* row_;  ///< Valid until the next one is appended.
};

bool IsPosition(std::string_view name) {
  return name == "x" || name == "y" || name == "z" || name == "range_m";
}

/// Whether a field says which firing a return is of, which does not change.
bool IsOfFiring(std::string_view name) {
  return name == "ring" || name == "column" || name == "time_ns";
}

/// One frame's edits of its cloud.
class RowEdit {
 public:
  RowEdit(const Cloud& cloud,
          const RecordedFirings& firings,
          const InsertedFrame& inserted,
          const RowContext& context)
      : cloud_(cloud),
        firings_(firings),
        before_(firings.recorded.frame),
        after_(inserted.recorded.frame),
        inserted_(inserted),
        context_(context),
        moving_(MovingInstances(inserted.objects)),
        num_rows_(cloud.num_points()),
        slots_(num_rows_, kNoSlot),
        edit_of_slot_(before_.num_slots(), nullptr) {
    for (std::size_t slot = 0; slot < firings.entry_of_slot.size(); ++slot) {
      const std::uint32_t entry = firings.entry_of_slot[slot];
      if (entry == kNoEntry) continue;
      Check(entry < num_rows_, "an entry is a row of the cloud");
      slots_[entry] = static_cast<std::uint32_t>(slot);
    }
    for (const SlotEdit& edit : inserted.edits) edit_of_slot_[edit.slot] = &edit;
    FindCells();
    is_organised_ = IsOrganised();
  }

  EditedRows Make() {
    EditedRows edited;
    edited.points.data.reserve(cloud_.data.size() + inserted_.edits.size() * cloud_.point_step);
    if (is_organised_) {
      MakeOrganised(edited);
    } else {
      MakeInOrder(edited);
    }
    return edited;
  }

 private:
  void FindCells() {
    const auto cell_of = [&](const CloudField* field) {
      return field == nullptr ? kNoCell : static_cast<std::size_t>(field - cloud_.fields.data());
    };
    std::set<std::size_t> known;
    ForEachPossibleField([&](std::string_view name, std::string_view, const auto&) {
      const std::size_t cell = cell_of(FindFieldOf(cloud_, name));
      cells_.push_back(cell);
      known.insert(cell);
      if (name == "ring") ring_cell_ = cell;
    });
    if (FindFieldOf(cloud_, "time_ns") == nullptr) times_ = FindTimeColumn(cloud_);
    if (times_) known.insert(cell_of(times_->column));
    for (std::size_t i = 0; i < cloud_.fields.size(); ++i) {
      if (!known.contains(i)) foreign_.push_back(i);
    }
  }

  [[nodiscard]] bool IsOrganised() const {
    if (context_.is_organised || cloud_.height > 1) return true;
    for (const std::uint32_t slot : slots_) {
      if (slot != kNoSlot && std::isnan(before_.x[slot])) return true;
    }
    return false;
  }

  /// Calls `visit(name, cell, values before, values after)` for the fields that the cloud has.
  template <typename Visitor>
  void ForEachCell(const Visitor& visit) const {
    std::size_t i = 0;
    const auto visit_after = [&](std::string_view name, const auto& before, const auto& after) {
      if (cells_[i] != kNoCell) visit(name, cells_[i], before, after);
      ++i;
    };
    ForEachPair(visit_after);
  }

  // Both frames have the same fields in the same order.
  template <typename Visitor>
  void ForEachPair(const Visitor& visit) const {
    std::vector<const void*> before;
    ForEachField(before_, [&](std::string_view, std::string_view, const auto& values) {
      before.push_back(&values);
    });
    std::size_t i = 0;
    ForEachField(after_, [&](std::string_view name, std::string_view, const auto& values) {
      visit(name, *static_cast<std::remove_reference_t<decltype(values)>*>(before.at(i++)), values);
    });
  }

  template <typename Value>
  static bool AreSame(Value a, Value b) {
    if constexpr (std::is_floating_point_v<Value>)
      return a == b || (std::isnan(a) && std::isnan(b));
    return a == b;
  }

  // Takes the values that differ from those recorded in `from`. Positions stay.
  void SetChanged(std::size_t slot, std::size_t from, RowDraft& row) const {
    ForEachCell([&](std::string_view name, std::size_t cell, const auto& old, const auto& now) {
      if (IsPosition(name) || IsOfFiring(name) || name == "label" || name == "instance") return;
      using Stored = typename StoredType<ElementOf<decltype(now)>>::Type;
      if (!AreSame(old[from], now[slot])) row.Set(cell, static_cast<Stored>(now[slot]));
    });
  }

  [[nodiscard]] bool IsOfObject(std::size_t slot) const {
    const SlotEdit& edit = *edit_of_slot_[slot];
    return (edit.is_added && !edit.is_merged) ||
           (edit.hidden_by != 0 && after_.instance[slot] == edit.hidden_by);
  }
  [[nodiscard]] std::uint32_t LabelAt(std::size_t slot) const {
    if (context_.labels == nullptr || !IsOfObject(slot)) return after_.label[slot];
    return context_.labels->Of(after_.label[slot], moving_.contains(after_.instance[slot]));
  }

  // Takes all values of a slot.
  void SetAll(std::size_t slot, RowDraft& row) const {
    const Vector3 stored_m =
        Vector3(after_.x[slot], after_.y[slot], after_.z[slot]) + firings_.recorded.origin_m;
    ForEachCell([&](std::string_view name, std::size_t cell, const auto&, const auto& now) {
      using Stored = typename StoredType<ElementOf<decltype(now)>>::Type;
      if (name == "x" || name == "y" || name == "z") {
        row.Set(cell, stored_m[name[0] - 'x']);
      } else if (name == "label") {
        row.Set(cell, LabelAt(slot));
      } else if (name == "ring" && !IsRailcasts()) {
        SetRing(slot, row);
      } else {
        row.Set(cell, static_cast<Stored>(now[slot]));
      }
    });
    if (times_) row.Set(CellOf(*times_->column), times_->Stored(after_.time_ns[slot]));
    for (const std::size_t cell : foreign_) row.Clear(cell);
  }

  [[nodiscard]] std::size_t CellOf(const CloudField& field) const {
    return static_cast<std::size_t>(&field - cloud_.fields.data());
  }
  // Whether rings in the cloud are the rows of its frames.
  [[nodiscard]] bool IsRailcasts() const {
    return cloud_.Find("ring") != nullptr && cloud_.Find("column") != nullptr;
  }
  // Other clouds number their rings as they like: as in the returns of the same row.
  void SetRing(std::size_t slot, RowDraft& row) const {
    if (entry_of_row_.empty()) {
      entry_of_row_.resize(before_.rows, kNoEntry);
      for (std::size_t entry = 0; entry < num_rows_; ++entry) {
        if (slots_[entry] == kNoSlot) continue;
        entry_of_row_[slots_[entry] / before_.width()] = static_cast<std::uint32_t>(entry);
      }
    }
    const std::uint32_t entry = entry_of_row_[slot / before_.width()];
    if (entry == kNoEntry) {
      row.Set(ring_cell_, after_.ring[slot]);
    } else {
      row.Copy(ring_cell_, entry);
    }
  }

  // Marks the absence of a point.
  void SetAbsent(std::size_t slot, RowDraft& row) const {
    if (cloud_.Find("outcome") != nullptr) {
      SetChanged(slot, slot, row);
      ForEachCell([&](std::string_view name, std::size_t cell, const auto&, const auto& now) {
        using Stored = typename StoredType<ElementOf<decltype(now)>>::Type;
        if (name == "instance") row.Set(cell, static_cast<Stored>(now[slot]));
        if (name == "label") row.Set(cell, LabelAt(slot));
        if (IsPosition(name)) row.Clear(cell);
      });
      return;
    }
    ForEachCell([&](std::string_view name, std::size_t cell, const auto&, const auto&) {
      if (IsOfFiring(name) || name == "return_index") return;
      if (IsPosition(name) && marks_by_zero()) {
        row.Set(cell, 0);
      } else {
        row.Clear(cell);
      }
    });
    for (const std::size_t cell : foreign_) row.Clear(cell);
  }

  // Whether the cloud says by a position of 0 that there is no point, and not by NaN.
  [[nodiscard]] bool marks_by_zero() const {
    if (!marks_by_zero_) {
      marks_by_zero_ = false;
      const CloudField* const x = FindFieldOf(cloud_, "x");
      bool is_known = false;
      VisitField(cloud_, *x, [&](std::size_t i, auto value) {
        if (is_known || slots_[i] == kNoSlot || !std::isnan(before_.x[slots_[i]])) return;
        is_known = true;
        marks_by_zero_ = value == 0;
      });
    }
    return *marks_by_zero_;
  }

  void MakeOrganised(EditedRows& edited) const {
    for (const SlotEdit& edit : inserted_.edits) {
      if (!edit.has_point || firings_.entry_of_slot[edit.slot] != kNoEntry) continue;
      throw InputError(inserted_.recorded.name +
                       ": an organised cloud must have a place for every firing");
    }
    for (std::size_t entry = 0; entry < num_rows_; ++entry) {
      const std::uint32_t slot = slots_[entry];
      const SlotEdit* const edit = slot == kNoSlot ? nullptr : edit_of_slot_[slot];
      const bool is_moved = edit != nullptr && edit->from_slot;
      RowDraft row(cloud_, is_moved ? firings_.entry_of_slot[*edit->from_slot] : entry,
                   edited.points);
      if (edit == nullptr) {
        if (HasOtherCount(slot)) SetChanged(slot, slot, row);
      } else if (edit->is_added) {
        SetAll(slot, row);
      } else if (edit->has_point) {
        SetChanged(slot, edit->from_slot.value_or(slot), row);
      } else {
        SetAbsent(slot, row);
      }
    }
    edited.slots = slots_;
  }

  // Whether a slot that is otherwise as recorded has another number of returns beside it now.
  [[nodiscard]] bool HasOtherCount(std::uint32_t slot) const {
    return slot != kNoSlot && (before_.return_count[slot] != after_.return_count[slot] ||
                               before_.return_index[slot] != after_.return_index[slot]);
  }

  // The slot in which a recorded return is now; kNoSlot if it is lost.
  [[nodiscard]] std::vector<std::uint32_t> PresentSlots() const {
    std::vector<std::uint32_t> now(before_.num_slots());
    std::iota(now.begin(), now.end(), 0U);
    for (const SlotEdit& edit : inserted_.edits) now[edit.slot] = kNoSlot;
    for (const SlotEdit& edit : inserted_.edits) {
      if (edit.has_point && !edit.is_added) now[edit.from_slot.value_or(edit.slot)] = edit.slot;
    }
    return now;
  }

  void MakeInOrder(EditedRows& edited) const {
    const std::vector<std::uint32_t> now = PresentSlots();
    const auto added = AddedAfter();
    auto next = added.begin();
    const auto add_until = [&](std::int64_t entry) {
      for (; next != added.end() && next->first <= entry; ++next) {
        RowDraft row(cloud_, edited.points);
        SetAll(next->second, row);
        edited.slots.push_back(next->second);
      }
    };
    add_until(-1);
    for (std::size_t entry = 0; entry < num_rows_; ++entry) {
      const std::uint32_t from = slots_[entry];
      const std::uint32_t slot = from == kNoSlot ? from : now[from];
      if (from == kNoSlot || slot != kNoSlot) {
        RowDraft row(cloud_, entry, edited.points);
        const bool has_edit = slot != kNoSlot && edit_of_slot_[slot] != nullptr;
        if (slot != from || has_edit || HasOtherCount(slot)) SetChanged(slot, from, row);
        edited.slots.push_back(slot);
      }
      add_until(static_cast<std::int64_t>(entry));
    }
  }

  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
  using KeyOf = Key (*)(const Frame& frame, std::uint32_t slot);
  static constexpr std::array<KeyOf, 3> kOrders = {
      [](const Frame& frame, std::uint32_t slot) {
        return Key(frame.time_ns[slot], slot / frame.width(), slot % frame.returns);
      },
      [](const Frame& frame, std::uint32_t slot) {
        return Key(slot % frame.width() / frame.returns, slot / frame.width(),
                   slot % frame.returns);
      },
      [](const Frame& /*frame*/, std::uint32_t slot) { return Key(slot, 0, 0); }};

  // The order that the rows have: by time, by columns or by rows, whichever they break least often.
  [[nodiscard]] KeyOf FindOrder() const {
    KeyOf best = kOrders.back();
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const KeyOf key : kOrders) {
      if (key == kOrders[0] && !firings_.recorded.Has("time_ns")) continue;
      std::size_t num_broken = 0;
      std::optional<Key> last;
      for (const std::uint32_t slot : slots_) {
        if (slot == kNoSlot) continue;
        const Key here = key(before_, slot);
        if (last && here < *last) ++num_broken;
        last = here;
      }
      if (num_broken < fewest) {
        fewest = num_broken;
        best = key;
      }
    }
    return best;
  }

  // The slots with added returns, by the entry after which they come; -1 = before the first.
  [[nodiscard]] std::vector<std::pair<std::int64_t, std::uint32_t>> AddedAfter() const {
    std::vector<std::pair<std::int64_t, std::uint32_t>> added;
    const KeyOf key = FindOrder();
    std::vector<std::pair<Key, std::int64_t>> entries;
    for (std::size_t entry = 0; entry < num_rows_; ++entry) {
      if (slots_[entry] == kNoSlot) continue;
      entries.emplace_back(key(before_, slots_[entry]), static_cast<std::int64_t>(entry));
    }
    std::ranges::sort(entries);
    std::vector<std::pair<Key, std::uint32_t>> slots;
    for (const SlotEdit& edit : inserted_.edits) {
      if (edit.is_added) slots.emplace_back(key(after_, edit.slot), edit.slot);
    }
    std::ranges::sort(slots);
    for (const auto& [place, slot] : slots) {
      const auto after =
          std::ranges::upper_bound(entries, place, {}, &std::pair<Key, std::int64_t>::first);
      added.emplace_back(after == entries.begin() ? -1 : std::prev(after)->second, slot);
    }
    std::ranges::stable_sort(added, {}, &std::pair<std::int64_t, std::uint32_t>::first);
    return added;
  }

  const Cloud& cloud_;
  const RecordedFirings& firings_;
  const Frame& before_;
  const Frame& after_;
  const InsertedFrame& inserted_;
  const RowContext& context_;
  std::set<std::uint32_t> moving_;  ///< Instances.
  std::size_t num_rows_;
  std::vector<std::uint32_t> slots_;  ///< By entry.
  std::vector<const SlotEdit*> edit_of_slot_;
  std::vector<std::size_t> cells_;  ///< In the order of ForEachPossibleField().
  std::size_t ring_cell_ = kNoCell;
  std::optional<TimeColumn> times_;
  std::vector<std::size_t> foreign_;  ///< Cells that hold no field of ours.
  bool is_organised_ = false;
  mutable std::vector<std::uint32_t> entry_of_row_;  ///< An entry of each row of the frame.
  mutable std::optional<bool> marks_by_zero_;
};

}  // namespace

EditedRows EditRows(const Cloud& cloud,
                    const RecordedFirings& firings,
                    const InsertedFrame& inserted,
                    const RowContext& context) {
  return RowEdit(cloud, firings, inserted, context).Make();
}

std::vector<std::uint32_t> SlotsOfEntries(const RecordedFirings& firings) {
  std::uint32_t num_entries = 0;
  for (const std::uint32_t entry : firings.entry_of_slot) {
    if (entry != kNoEntry) num_entries = std::max(num_entries, entry + 1);
  }
  std::vector<std::uint32_t> slots(num_entries, kNoSlot);
  for (std::size_t slot = 0; slot < firings.entry_of_slot.size(); ++slot) {
    const std::uint32_t entry = firings.entry_of_slot[slot];
    if (entry != kNoEntry) slots[entry] = static_cast<std::uint32_t>(slot);
  }
  return slots;
}

}  // namespace railcast
