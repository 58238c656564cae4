#include "core/extras/ros/mcap/compression.h"

#include <lz4frame.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <functional>
#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

namespace railcast::mcap {
namespace {

constexpr int kZstdLevel = 1;
constexpr std::size_t kBlock_bytes = std::size_t{1} << 17U;

[[noreturn]] void ThrowDamaged(const char* kind, const char* reason) {
  throw InputError(std::string("must be whole ") + kind + " data (got: " + reason + ")");
}

Bytes Lz4Compressed(ByteSpan bytes) {
  Bytes out(::LZ4F_compressFrameBound(bytes.size(), nullptr));
  const std::size_t size =
      ::LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr);
  Check(::LZ4F_isError(size) == 0, "LZ4 has room for the bytes that it asked for");
  out.resize(size);
  return out;
}

Bytes ZstdCompressed(ByteSpan bytes) {
  Bytes out(::ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ::ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
  Check(::ZSTD_isError(size) == 0, "zstd has room for the bytes that it asked for");
  out.resize(size);
  return out;
}

/// Takes what becomes of compressed bytes, block by block.
using TakeBlock = std::function<void(ByteSpan block)>;

/// A stream of compressed bytes that comes in pieces.
class Uncompressor {
 public:
  virtual ~Uncompressor() = default;
  virtual void Add(ByteSpan piece, const TakeBlock& take) = 0;
  /// Whether what was added ends with the end of its last frame.
  [[nodiscard]] virtual bool is_whole() const = 0;
};

class ZstdUncompressor : public Uncompressor {
 public:
  void Add(ByteSpan piece, const TakeBlock& take) override {
    ::ZSTD_inBuffer input{piece.data(), piece.size(), 0};
    while (true) {
      ::ZSTD_outBuffer output{block_.data(), block_.size(), 0};
      const std::size_t left = ::ZSTD_decompressStream(stream_.get(), &output, &input);
      if (::ZSTD_isError(left) != 0) ThrowDamaged("zstd", ::ZSTD_getErrorName(left));
      is_whole_ = left == 0;
      take({block_.data(), output.pos});
      // A call after the end of a frame would begin the next one.
      if (input.pos == input.size && (is_whole_ || output.pos < output.size)) return;
    }
  }
  [[nodiscard]] bool is_whole() const override { return is_whole_; }

 private:
  std::unique_ptr<::ZSTD_DStream, std::size_t (*)(::ZSTD_DStream*)> stream_{::ZSTD_createDStream(),
                                                                            ::ZSTD_freeDStream};
  Bytes block_ = Bytes(kBlock_bytes);
  bool is_whole_ = true;
};

class Lz4Uncompressor : public Uncompressor {
 public:
  Lz4Uncompressor() {
    const std::size_t status = ::LZ4F_createDecompressionContext(&context_, LZ4F_VERSION);
    Check(::LZ4F_isError(status) == 0, "LZ4 is of the version that it was built with");
  }
  ~Lz4Uncompressor() override { ::LZ4F_freeDecompressionContext(context_); }
  Lz4Uncompressor(const Lz4Uncompressor&) = delete;
  Lz4Uncompressor& operator=(const Lz4Uncompressor&) = delete;

  void Add(ByteSpan piece, const TakeBlock& take) override {
    while (true) {
      std::size_t made = block_.size();
      std::size_t used = piece.size();
      const std::size_t left =
          ::LZ4F_decompress(context_, block_.data(), &made, piece.data(), &used, nullptr);
      if (::LZ4F_isError(left) != 0) ThrowDamaged("LZ4", ::LZ4F_getErrorName(left));
      is_whole_ = left == 0;
      take({block_.data(), made});
      piece = piece.subspan(used);
      // A call after the end of a frame would begin the next one.
      if (piece.empty() && (is_whole_ || made < block_.size())) return;
      if (used == 0 && made == 0) ThrowDamaged("LZ4", "it does not go on");
    }
  }
  [[nodiscard]] bool is_whole() const override { return is_whole_; }

 private:
  ::LZ4F_dctx* context_ = nullptr;
  Bytes block_ = Bytes(kBlock_bytes);
  bool is_whole_ = true;
};

}  // namespace

Bytes Compressed(ByteSpan bytes, McapCompression compression) {
  switch (compression) {
    case McapCompression::kLz4:
      return Lz4Compressed(bytes);
    case McapCompression::kZstd:
      return ZstdCompressed(bytes);
    case McapCompression::kNone:
      break;
  }
  return {bytes.begin(), bytes.end()};
}

Bytes Uncompressed(ByteSpan bytes, McapCompression compression, std::size_t max_size) {
  Bytes out;
  const auto take = [&](ByteSpan block) {
    if (block.size() > max_size - out.size()) {
      throw InputError("must become at most " + NumberText(max_size) + " bytes (got more)");
    }
    out.insert(out.end(), block.begin(), block.end());
  };
  if (compression == McapCompression::kNone) {
    take(bytes);
    return out;
  }
  const bool is_zstd = compression == McapCompression::kZstd;
  const auto uncompressor =
      is_zstd ? std::unique_ptr<Uncompressor>(std::make_unique<ZstdUncompressor>())
              : std::make_unique<Lz4Uncompressor>();
  if (!bytes.empty()) uncompressor->Add(bytes, take);
  if (!uncompressor->is_whole()) ThrowDamaged(is_zstd ? "zstd" : "LZ4", "it ends early");
  return out;
}

void UncompressFile(const std::filesystem::path& file, int descriptor, std::uint64_t max_ratio) {
  std::ifstream input = OpenInput(file);
  const std::uint64_t max_size =
      std::filesystem::file_size(file) * max_ratio + (std::uint64_t{1} << 24U);
  std::uint64_t size = 0;
  const auto take = [&](ByteSpan block) {
    size += block.size();
    if (size > max_size) {
      throw InputError("must become at most " + NumberText(max_size) + " bytes (got more)");
    }
    while (!block.empty()) {
      const ssize_t written = ::write(descriptor, block.data(), block.size());
      if (written < 0 && errno != EINTR) throw FileError("a temporary copy", errno);
      if (written > 0) block = block.subspan(static_cast<std::size_t>(written));
    }
  };
  ZstdUncompressor uncompressor;
  Bytes piece(kBlock_bytes);
  AtPlace(ShownPath(file) + ": ", [&] {
    while (input) {
      input.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
      const auto got = static_cast<std::size_t>(input.gcount());
      if (got > 0) uncompressor.Add(ByteSpan(piece).first(got), take);
    }
    if (!uncompressor.is_whole()) ThrowDamaged("zstd", "it ends early");
  });
}

void CompressFile(const std::filesystem::path& file, const std::function<void(ByteSpan)>& take) {
  std::ifstream input = OpenInput(file);
  const std::unique_ptr<::ZSTD_CCtx, std::size_t (*)(::ZSTD_CCtx*)> context(::ZSTD_createCCtx(),
                                                                            ::ZSTD_freeCCtx);
  const auto check = [](std::size_t status) {
    Check(::ZSTD_isError(status) == 0, "zstd compresses whatever it is given");
    return status;
  };
  check(::ZSTD_CCtx_setParameter(context.get(), ::ZSTD_c_compressionLevel, kZstdLevel));
  std::uint64_t left = std::filesystem::file_size(file);
  check(::ZSTD_CCtx_setPledgedSrcSize(context.get(), left));
  Bytes piece(kBlock_bytes);
  Bytes block(::ZSTD_CStreamOutSize());
  bool is_over = false;
  while (!is_over) {
    const std::size_t size = std::min<std::uint64_t>(left, piece.size());
    input.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(size));
    if (!input) throw FileError(file, EIO);
    left -= size;
    const auto mode = left == 0 ? ::ZSTD_e_end : ::ZSTD_e_continue;
    ::ZSTD_inBuffer in{piece.data(), size, 0};
    bool is_taken = false;
    while (!is_taken) {
      ::ZSTD_outBuffer out{block.data(), block.size(), 0};
      const std::size_t rest = check(::ZSTD_compressStream2(context.get(), &out, &in, mode));
      take(ByteSpan(block).first(out.pos));
      is_taken = left == 0 ? rest == 0 : in.pos == in.size;
    }
    is_over = left == 0;
  }
}

}  // namespace railcast::mcap
