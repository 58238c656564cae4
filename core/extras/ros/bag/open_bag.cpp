#include <algorithm>
#include <cerrno>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/unread_formats.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/bag_metadata.h"
#include "core/extras/ros/bag/temporary_copy.h"
#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/compression.h"
#include "core/extras/ros/mcap/record_scan.h"
#include "core/io/unfinished_file.h"
#include "core/io/write_file.h"

namespace railcast::bag {
namespace {

/// A part of a bag, with the message of it that comes next.
struct BagPart {
  std::unique_ptr<BagReader> reader;
  std::size_t number{};             ///< As BagPlace counts them.
  std::vector<std::size_t> topics;  ///< Index in the whole bag by index in the part.
  std::optional<std::int64_t> start_ns;
  std::optional<BagMessage> next;
  bool is_begun = false;  ///< Not before its start is reached, so that few parts are in memory.
};

class MergedReader : public BagReader {
 public:
  MergedReader(std::vector<std::unique_ptr<BagReader>> parts, std::vector<Remark> remarks)
      : remarks_(std::move(remarks)) {
    for (auto& reader : parts) {
      BagPart part{.reader = std::move(reader),
                   .number = parts_.size(),
                   .topics = {},
                   .start_ns = {},
                   .next = {}};
      part.start_ns = part.reader->FindStart_ns();
      for (const BagTopic& topic : part.reader->topics()) part.topics.push_back(topics_.Add(topic));
      parts_.push_back(std::move(part));
    }
    std::ranges::stable_sort(parts_, {}, &BagPart::start_ns);
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_.topics(); }

  [[nodiscard]] std::optional<std::int64_t> FindStart_ns() override {
    // Parts without messages come first.
    const auto first =
        std::ranges::find_if(parts_, [](const BagPart& part) { return part.start_ns.has_value(); });
    return first == parts_.end() ? std::nullopt : first->start_ns;
  }

  void Select(const std::vector<std::size_t>& wanted) override {
    const std::set<std::size_t> chosen(wanted.begin(), wanted.end());
    for (BagPart& part : parts_) {
      std::vector<std::size_t> in_part;
      for (std::size_t i = 0; i < part.topics.size(); ++i) {
        if (chosen.contains(part.topics[i])) in_part.push_back(i);
      }
      part.reader->Select(in_part);
      part.is_begun = false;
    }
    last_ = nullptr;
  }

  [[nodiscard]] std::optional<BagMessage> Next() override {
    if (last_ != nullptr) last_->next = last_->reader->Next();
    BagPart* first = nullptr;
    for (BagPart& part : parts_) {
      const bool is_later = first != nullptr && part.start_ns > first->next->time_ns;
      if (is_later && !part.is_begun) continue;
      if (!std::exchange(part.is_begun, true)) part.next = part.reader->Next();
      if (!part.next) continue;
      if (first == nullptr || part.next->time_ns < first->next->time_ns) first = &part;
    }
    last_ = first;
    if (first == nullptr) return std::nullopt;
    return BagMessage{first->topics[first->next->topic],
                      first->next->time_ns,
                      first->next->data,
                      {.part = first->number, .in_part = first->next->place.in_part},
                      first->next->channel};
  }

  [[nodiscard]] std::vector<BagAttachment> ReadAttachments() override {
    std::vector<BagAttachment> all;
    for (const BagPart& part : parts_) {
      for (BagAttachment& attachment : part.reader->ReadAttachments()) {
        all.push_back(std::move(attachment));
      }
    }
    return all;
  }

  [[nodiscard]] std::vector<Remark> remarks() const override {
    std::vector<Remark> all = remarks_;
    for (const BagPart& part : parts_) {
      for (const Remark& remark : part.reader->remarks()) AddRemark(remark, all);
    }
    return all;
  }

 private:
  std::vector<Remark> remarks_;
  std::vector<BagPart> parts_;
  TopicList topics_;
  BagPart* last_ = nullptr;  ///< The part of which the last message was returned.
};

/// Reads a bag of which each message is compressed by zstd.
class UncompressingReader : public BagReader {
 public:
  /// @param name Names it in messages.
  UncompressingReader(std::unique_ptr<BagReader> bag, std::string name)
      : bag_(std::move(bag)), name_(std::move(name)) {}

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return bag_->topics(); }
  [[nodiscard]] std::optional<std::int64_t> FindStart_ns() override { return bag_->FindStart_ns(); }
  void Select(const std::vector<std::size_t>& wanted) override { bag_->Select(wanted); }

  [[nodiscard]] std::optional<BagMessage> Next() override {
    auto message = bag_->Next();
    if (!message) return std::nullopt;
    data_ = AtPlace(name_ + ": message: ", [&] {
      return mcap::Uncompressed(message->data, McapCompression::kZstd,
                                mcap::kMaxUncompressed_bytes);
    });
    message->data = data_;
    return message;
  }

  [[nodiscard]] std::vector<BagAttachment> ReadAttachments() override {
    return bag_->ReadAttachments();
  }
  [[nodiscard]] std::vector<Remark> remarks() const override { return bag_->remarks(); }

 private:
  std::unique_ptr<BagReader> bag_;
  std::string name_;
  mcap::Bytes data_;
};

/// Reads the parts of a bag as one. Topics of several parts that are the same in all but their
/// definitions are one; messages come in the order of their times.
/// @param remarks On the bag as a whole.
std::unique_ptr<BagReader> Merged(std::vector<std::unique_ptr<BagReader>> parts,
                                  std::vector<Remark> remarks) {
  if (parts.size() == 1 && remarks.empty()) return std::move(parts.front());
  return std::make_unique<MergedReader>(std::move(parts), std::move(remarks));
}

bool BeginsWith(const std::filesystem::path& file, std::string_view magic) {
  std::string begin(magic.size(), '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), std::ssize(begin));
  return begin == magic;
}

/// Whether rosbag2 compressed the file as a whole.
bool IsZstd(const std::filesystem::path& file) {
  return BeginsWith(file, "\x28\xB5\x2F\xFD");
}

bool IsSqlite(const std::filesystem::path& file) {
  return BeginsWith(file, {"SQLite format 3\0", 16});
}

bool IsMcap(const std::filesystem::path& file) {
  return mcap::BeginsAsMcap(mcap::ByteFile(file, ShownPath(file)));
}

/// Whether the name is that of a bag's file, compressed or unfinished or not.
bool HasNameOfBag(std::filesystem::path file) {
  for (const std::string_view suffix : {std::string_view(".zstd"), kUnfinishedSuffix}) {
    if (file.extension() == suffix) file.replace_extension();
  }
  return file.extension() == ".mcap" || file.extension() == ".db3";
}

std::unique_ptr<BagReader> OpenBagFile(const std::filesystem::path& file, const std::string& name) {
  CheckIsReadable(file);
  if (IsMcap(file)) return OpenMcapBag(file, name);
  if (IsSqlite(file)) return OpenSqliteBag(file, name);
  if (IsZstd(file)) {
    const TemporaryCopy copy;
    const std::filesystem::path plain = copy.AddUncompressed(file);
    if (IsMcap(plain)) return OpenMcapBag(plain, name);
    if (IsSqlite(plain)) return OpenSqliteBag(plain, name);
  }
  const std::string advice = AdviceOnFile(file);
  throw InputError(
      name + ": " +
      (advice.empty() ? "must be an MCAP file or a database of rosbag2 (got neither)" : advice));
}

/// Returns the bag's files in a directory without metadata.yaml, by their names' numbers.
std::vector<std::filesystem::path> BagFilesIn(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (HasNameOfBag(entry.path()) && entry.is_regular_file(error)) files.push_back(entry.path());
  }
  // Times say the order of the messages; this one decides between equal ones.
  std::ranges::sort(files, {}, [](const std::filesystem::path& file) {
    return std::pair(file.native().size(), file.native());
  });
  return files;
}

BagParts PartsIn(const std::filesystem::path& directory) {
  if (exists(directory / kMetadataFile)) return ReadBagParts(directory);
  return {.files = BagFilesIn(directory)};
}

/// Files of bags beside those that metadata.yaml names. Players leave what they uncompressed.
std::vector<Remark> FilesLeftOut(const std::filesystem::path& directory, const BagParts& parts) {
  std::vector<Remark> remarks;
  for (const std::filesystem::path& file : BagFilesIn(directory)) {
    const bool is_part = std::ranges::any_of(parts.files, [&](const auto& part) {
      return part.filename() == file.filename() || part.stem() == file.filename();
    });
    if (is_part) continue;
    AddRemark({.kind = RemarkKind::kFilesLeftOut,
               .place = ShownPath(directory / kMetadataFile),
               .detail = ShownPath(file.filename()) + " is not named there"},
              remarks);
  }
  return remarks;
}

/// A copy of a file that rosbag2 compressed as a whole.
class CompressedCopy : public BagCopy {
 public:
  /// @param plain The copy of what it becomes, which is made at `plain_file`.
  CompressedCopy(std::filesystem::path file,
                 std::filesystem::path copy,
                 std::filesystem::path plain_file,
                 std::unique_ptr<BagCopy> plain)
      : file_(std::move(file)),
        copy_(std::move(copy)),
        plain_file_(std::move(plain_file)),
        plain_(std::move(plain)) {}

  void Put(const BagPlace& place, std::optional<std::span<const std::byte>> data) override {
    has_changed_ = has_changed_ || data;
    plain_->Put(place, data);
  }

  void Finish() override {
    plain_->Finish();
    const UnfinishedFile out(copy_, 0);
    if (has_changed_) {
      mcap::CompressFile(plain_file_, [&](mcap::ByteSpan bytes) { out.Append(bytes); });
    } else {
      out.AppendFile(file_);
    }
    out.Finish();
    std::filesystem::remove(plain_file_);
  }

 private:
  std::filesystem::path file_;
  std::filesystem::path copy_;
  std::filesystem::path plain_file_;
  std::unique_ptr<BagCopy> plain_;
  bool has_changed_ = false;
};

std::unique_ptr<BagCopy> CopyBagFile(const std::filesystem::path& file,
                                     const std::filesystem::path& copy,
                                     const BagTopic& topic) {
  const std::string name = ShownPath(file);
  CheckIsReadable(file);
  if (IsMcap(file)) return CopyMcapBag(file, name, copy, topic);
  if (IsSqlite(file)) return CopySqliteBag(file, copy);
  const TemporaryCopy uncompressed;
  const std::filesystem::path plain = uncompressed.AddUncompressed(file);
  const std::filesystem::path plain_copy = copy.string() + ".plain";
  auto inner = IsMcap(plain) ? CopyMcapBag(plain, name, plain_copy, topic)
                             : CopySqliteBag(plain, plain_copy);
  return std::make_unique<CompressedCopy>(file, copy, plain_copy, std::move(inner));
}

/// A copy of a rosbag2 directory.
class DirectoryCopy : public BagCopy {
 public:
  DirectoryCopy(const std::filesystem::path& bag, std::filesystem::path copy, const BagTopic& topic)
      : copy_(std::move(copy)) {
    std::error_code error;
    std::filesystem::create_directories(copy_, error);
    if (error) throw FileError(copy_, error.value());
    const BagParts parts = PartsIn(bag);
    are_messages_compressed_ = parts.are_messages_compressed;
    std::set<std::filesystem::path> known;
    for (const std::filesystem::path& file : parts.files) {
      parts_.push_back(CopyBagFile(file, copy_ / file.filename(), topic));
      known.insert(file.filename());
      for (const auto& beside : ChangesBeside(file)) known.insert(beside.filename());
    }
    for (const auto& entry : std::filesystem::directory_iterator(bag)) {
      const bool is_other = entry.is_regular_file() && !known.contains(entry.path().filename());
      if (is_other) others_.push_back(entry.path());
    }
  }

  void Put(const BagPlace& place, std::optional<std::span<const std::byte>> data) override {
    if (!data || !are_messages_compressed_) return parts_.at(place.part)->Put(place, data);
    const mcap::Bytes compressed = mcap::Compressed(*data, McapCompression::kZstd);
    parts_.at(place.part)->Put(place, compressed);
  }

  void Finish() override {
    for (const auto& part : parts_) part->Finish();
    for (const std::filesystem::path& other : others_) {
      const UnfinishedFile out(copy_ / other.filename(), 0);
      out.AppendFile(other);
      out.Finish();
    }
  }

 private:
  std::filesystem::path copy_;
  std::vector<std::unique_ptr<BagCopy>> parts_;
  std::vector<std::filesystem::path> others_;  ///< Files beside the parts, such as metadata.yaml.
  bool are_messages_compressed_ = false;
};

}  // namespace

std::unique_ptr<BagCopy> CopyBag(const std::filesystem::path& bag,
                                 const std::filesystem::path& copy,
                                 const BagTopic& topic) {
  if (is_directory(bag)) return std::make_unique<DirectoryCopy>(bag, copy, topic);
  return CopyBagFile(bag, copy, topic);
}

std::size_t TopicList::Add(const BagTopic& topic) {
  const auto [known, is_new] =
      indices_.try_emplace({topic.name, topic.type, topic.encoding}, topics_.size());
  if (is_new) topics_.push_back(topic);
  return known->second;
}

std::string FullTypeName(std::string type, std::string_view encoding) {
  const std::size_t slash = type.find('/');
  const bool is_short = encoding == "cdr" && slash != std::string::npos && slash == type.rfind('/');
  return is_short ? type.insert(slash, "/msg") : type;
}

std::unique_ptr<BagReader> OpenBag(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!exists(status)) throw FileError(path, error ? error.value() : ENOENT);
  if (!is_directory(status)) return OpenBagFile(path, ShownPath(path));
  const BagParts parts = PartsIn(path);
  std::vector<std::unique_ptr<BagReader>> readers;
  for (const std::filesystem::path& file : parts.files) {
    readers.push_back(OpenBagFile(file, ShownPath(file)));
  }
  if (readers.empty()) {
    throw InputError(ShownPath(path) + ": must hold .mcap or .db3 files (got none)");
  }
  auto bag = Merged(std::move(readers), FilesLeftOut(path, parts));
  if (!parts.are_messages_compressed) return bag;
  return std::make_unique<UncompressingReader>(std::move(bag), ShownPath(path));
}

bool IsBag(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (is_directory(status)) {
    return exists(path / kMetadataFile) || !BagFilesIn(path).empty();
  }
  return is_regular_file(status) && (HasNameOfBag(path) || IsMcap(path) || IsSqlite(path));
}

}  // namespace railcast::bag
