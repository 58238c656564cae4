#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <istream>
#include <streambuf>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "generator/extras/import/map/map_formats.h"

namespace railcast {
namespace {

/// What a call of a library has come to.
enum class Unpacked : std::uint8_t { kPart, kMember, kDamaged };

struct Gzip {
  using Stream = z_stream;
  static constexpr std::string_view kName = "gzip";
  static constexpr std::string_view kBegin = "\x1F\x8B";

  static bool Begin(Stream& stream) {
    constexpr int kWithHeader = 16;
    return inflateInit2(&stream, kWithHeader + MAX_WBITS) == Z_OK;
  }
  static Unpacked Next(Stream& stream) {
    const int result = inflate(&stream, Z_NO_FLUSH);
    if (result == Z_STREAM_END) return Unpacked::kMember;
    return result == Z_OK || result == Z_BUF_ERROR ? Unpacked::kPart : Unpacked::kDamaged;
  }
  static void End(Stream& stream) { inflateEnd(&stream); }
};

struct Bzip2 {
  using Stream = bz_stream;
  static constexpr std::string_view kName = "bzip2";
  static constexpr std::string_view kBegin = "BZh";

  static bool Begin(Stream& stream) { return BZ2_bzDecompressInit(&stream, 0, 0) == BZ_OK; }
  static Unpacked Next(Stream& stream) {
    const int result = BZ2_bzDecompress(&stream);
    if (result == BZ_STREAM_END) return Unpacked::kMember;
    return result == BZ_OK ? Unpacked::kPart : Unpacked::kDamaged;
  }
  static void End(Stream& stream) { BZ2_bzDecompressEnd(&stream); }
};

constexpr std::size_t kBuffer = 1 << 16;

/// Maps as text unpack to 10 to 30 times their size; zeros to a thousand times and more.
constexpr std::uint64_t kMostTimes = 100;
constexpr std::uint64_t kSmall_MiB = 64;

/// Unpacks a file, member by member.
template <class Packer>
class UnpackingBuffer final : public std::streambuf {
 public:
  explicit UnpackingBuffer(const std::filesystem::path& file)
      : file_(file),
        in_(OpenInput(file)),
        most_(std::max(kSmall_MiB << 20U, kMostTimes * std::filesystem::file_size(file))) {}
  ~UnpackingBuffer() override {
    if (is_open_) Packer::End(stream_);
  }
  UnpackingBuffer(const UnpackingBuffer&) = delete;
  UnpackingBuffer& operator=(const UnpackingBuffer&) = delete;

 protected:
  int_type underflow() override {
    stream_.next_out = reinterpret_cast<decltype(stream_.next_out)>(plain_.data());
    stream_.avail_out = kBuffer;
    // A member may be empty.
    while (stream_.avail_out == kBuffer && Unpack()) {
    }
    const std::size_t num = kBuffer - stream_.avail_out;
    num_plain_ += num;
    if (num_plain_ > most_) {
      throw InputError(ShownPath(file_) + ": must unpack to at most " + std::to_string(kSmall_MiB) +
                       " MiB or " + std::to_string(kMostTimes) + " times its size (got more)");
    }
    setg(plain_.data(), plain_.data(), plain_.data() + num);
    return num == 0 ? traits_type::eof() : traits_type::to_int_type(plain_[0]);
  }

 private:
  /// Unpacks what is read, or reads on; returns whether there may be more.
  bool Unpack() {
    if (!is_open_) {
      Fill(Packer::kBegin.size());
      if (stream_.avail_in == 0) return false;
      const std::string_view begin(reinterpret_cast<const char*>(stream_.next_in),
                                   stream_.avail_in);
      if (!begin.starts_with(Packer::kBegin)) {
        Refuse("other data from byte " + std::to_string(num_packed_ - stream_.avail_in) + " on");
      }
      Check(Packer::Begin(stream_), "there is memory for unpacking");
      is_open_ = true;
    }
    Fill(1);
    const auto num_before = stream_.avail_out;
    const bool is_at_end = stream_.avail_in == 0;
    const Unpacked unpacked = Packer::Next(stream_);
    if (unpacked == Unpacked::kDamaged) Refuse("damaged data");
    if (unpacked == Unpacked::kMember) {
      Packer::End(stream_);
      is_open_ = false;
    } else if (is_at_end && stream_.avail_out == num_before) {
      Refuse("the file's end within the data");
    }
    return true;
  }

  /// Reads on if fewer bytes than these wait to be unpacked.
  void Fill(std::size_t wanted) {
    if (stream_.avail_in >= wanted) return;
    std::copy_n(reinterpret_cast<const char*>(stream_.next_in), stream_.avail_in, packed_.data());
    in_.read(packed_.data() + stream_.avail_in,
             static_cast<std::streamsize>(kBuffer - stream_.avail_in));
    if (in_.bad()) throw FileError(file_, errno);
    num_packed_ += static_cast<std::uint64_t>(in_.gcount());
    stream_.avail_in += static_cast<unsigned>(in_.gcount());
    stream_.next_in = reinterpret_cast<decltype(stream_.next_in)>(packed_.data());
  }

  [[noreturn]] void Refuse(const std::string& got) const {
    throw InputError(ShownPath(file_) + ": must be " + std::string(Packer::kName) +
                     " data to its end (got " + got + ")");
  }

  std::filesystem::path file_;
  std::ifstream in_;
  std::uint64_t most_;
  std::uint64_t num_packed_ = 0;  ///< Bytes that were read.
  std::uint64_t num_plain_ = 0;   ///< Bytes that they gave.
  std::array<char, kBuffer> packed_{};
  std::array<char, kBuffer> plain_{};
  typename Packer::Stream stream_{};
  bool is_open_ = false;  ///< Whether the stream is within a member.
};

template <class Packer>
class UnpackingStream final : public std::istream {
 public:
  explicit UnpackingStream(const std::filesystem::path& file)
      : std::istream(nullptr), buffer_(file) {
    rdbuf(&buffer_);
    exceptions(std::ios::badbit);  // What the buffer throws goes through.
  }

 private:
  UnpackingBuffer<Packer> buffer_;
};

bool BeginsWith(const std::filesystem::path& file, std::string_view begin) {
  std::string bytes(begin.size(), '\0');
  std::ifstream in = OpenInput(file);
  return in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) && bytes == begin;
}

}  // namespace

bool IsPacked(const std::filesystem::path& file) {
  return BeginsWith(file, Gzip::kBegin) || BeginsWith(file, Bzip2::kBegin);
}

std::unique_ptr<std::istream> OpenMap(const std::filesystem::path& file) {
  if (BeginsWith(file, Gzip::kBegin)) return std::make_unique<UnpackingStream<Gzip>>(file);
  if (BeginsWith(file, Bzip2::kBegin)) return std::make_unique<UnpackingStream<Bzip2>>(file);
  return std::make_unique<std::ifstream>(OpenInput(file));
}

std::string ReadMapText(const std::filesystem::path& file) {
  const std::unique_ptr<std::istream> in = OpenMap(file);
  std::string bytes;
  std::array<char, kBuffer> block{};
  while (in->read(block.data(), block.size()) || in->gcount() > 0) {
    bytes.append(block.data(), static_cast<std::size_t>(in->gcount()));
  }
  if (in->bad()) throw FileError(file, errno);
  return AsUtf8(std::move(bytes));
}

}  // namespace railcast
