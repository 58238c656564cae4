#include "generator/run/line_ledger.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/io/content_hash.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The whole lines of a file, one after the other: millions need not fit into memory.
class Lines {
 public:
  Lines(const fs::path& file, std::string_view header) {
    if (!fs::exists(file)) return;
    stream_ = OpenInput(file);
    std::string begin(header.size(), '\0');
    stream_.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    has_header_ = stream_ && begin == header;
    if (has_header_) position_ = header.size();
  }

  /// The next lines with their ends; empty if there are fewer or the last is incomplete.
  [[nodiscard]] std::string_view Next(std::uint32_t num_lines) {
    next_.clear();
    for (std::uint32_t i = 0; i < num_lines; ++i) {
      if (!has_header_ || !std::getline(stream_, line_) || stream_.eof()) {
        next_.clear();
        break;
      }
      next_ += line_;
      next_ += '\n';
    }
    return next_;
  }
  /// Counts what Next() has returned.
  void Count() { position_ += next_.size(); }
  /// The size of what was counted.
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  std::ifstream stream_;
  bool has_header_ = false;
  std::string line_;
  std::string next_;
  std::uint64_t position_ = 0;
};

}  // namespace

std::uint32_t LineLedger::Count(
    std::uint32_t most,
    const std::function<std::optional<LedgerItem>(std::uint32_t i, std::string_view line)>& read,
    const std::function<void(std::string_view records)>& on_done) {
  std::vector<Lines> lines;
  for (const LineFileName& file : files_) lines.emplace_back(directory_ / file.name, file.header);
  std::uint32_t num = 0;
  std::string records;
  for (; num < most; ++num) {
    const std::optional<LedgerItem> item = read(num, lines.back().Next(1));
    if (!item || item->num_lines.size() + 1 != files_.size()) break;
    records.clear();
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) records += lines[i].Next(item->num_lines[i]);
    const auto is_there = [&](const KnownFile& file) { return HasContent(directory_, file); };
    if (ContentHash(records) != item->records_hash) break;
    if (!std::ranges::all_of(item->files, is_there)) break;
    on_done(records);
    for (Lines& file : lines) file.Count();
  }
  sizes_.clear();
  for (const Lines& file : lines) sizes_.push_back(file.position());
  return num;
}

std::string LineLedger::FileWithOthers() const {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(directory_ / files_[i].name, error);
    if (error || size != sizes_[i]) return files_[i].name;
  }
  return "";
}

void LineLedger::Open() {
  Check(sizes_.size() == files_.size(), "items are counted before lines are added");
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const fs::path file = directory_ / files_[i].name;
    const std::uint64_t size = sizes_[i];
    MakeFolders(file.parent_path());
    open_.emplace_back(file, size);
    if (size == 0) open_.back().Append(files_[i].header);
  }
}

void LineLedger::Append(const std::vector<std::string>& records,
                        const std::function<std::string(std::string records_hash)>& own) {
  Check(records.size() + 1 == open_.size(), "each file gets its lines");
  std::string all;
  std::size_t num_bytes = 0;
  for (const std::string& lines : records) num_bytes += lines.size();
  all.reserve(num_bytes);
  for (std::size_t i = 0; i < records.size(); ++i) {
    open_[i].Append(records[i]);
    all += records[i];
  }
  open_.back().Append(own(ContentHash(all)));
}

void LineLedger::Sync() {
  for (LineFile& file : open_) file.Sync();
}

bool HasContent(const fs::path& directory, const KnownFile& file) {
  const fs::path path = directory / file.name;
  std::error_code error;
  return fs::is_regular_file(path, error) && fs::file_size(path, error) == file.bytes && !error &&
         ContentHash(ReadFileWhole(path)) == file.hash;
}

}  // namespace railcast
