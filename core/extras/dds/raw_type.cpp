#include "core/extras/dds/raw_type.h"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>
#include <utility>

#include "core/extras/dds/participant.h"

namespace railcast::dds {
namespace {

// The protocol sends payloads in words of four bytes.
constexpr std::size_t kWord_bytes = 4;

struct RawData final : ddsi_serdata {
  RawData(const ddsi_sertype* type_of, ddsi_serdata_kind kind_of, std::vector<std::byte> cdr)
      : ddsi_serdata(), bytes(std::move(cdr)) {
    ddsi_serdata_init(this, type_of, kind_of);
    // Topics without keys have one instance.
    hash = type_of->serdata_basehash;
    bytes.resize((bytes.size() + kWord_bytes - 1) / kWord_bytes * kWord_bytes);
  }
  std::vector<std::byte> bytes;
};

const RawData& Raw(const ddsi_serdata* sample) {
  return *static_cast<const RawData*>(sample);
}

/// Returns a new sample, or null where memory lacks: exceptions do not pass through C.
template <typename MakeBytes>
ddsi_serdata* TryMake(const ddsi_sertype* type, ddsi_serdata_kind kind, const MakeBytes& make) {
  try {
    return new RawData(type, kind, make());
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

ddsi_serdata* KeyOf(const ddsi_sertype* type, const ddsi_keyhash* /*hash*/) {
  return TryMake(type, SDK_KEY, [] { return std::vector<std::byte>(); });
}

ddsi_serdata* UntypedOf(const ddsi_serdata* sample) {
  ddsi_serdata* key = KeyOf(sample->type, nullptr);
  if (key != nullptr) key->type = nullptr;
  return key;
}

/// Puts the fragments together in which a sample came.
ddsi_serdata* FromFragments(const ddsi_sertype* type,
                            ddsi_serdata_kind kind,
                            const nn_rdata* fragment,
                            std::size_t size) {
  return TryMake(type, kind, [&] {
    std::vector<std::byte> bytes(std::min(size, kMaxTaken_bytes));
    std::size_t end = 0;
    for (; fragment != nullptr && end < bytes.size(); fragment = fragment->nextfrag) {
      if (fragment->maxp1 <= end || fragment->min > end) continue;
      const auto* payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
      const std::size_t new_end = std::min<std::size_t>(fragment->maxp1, bytes.size());
      std::memcpy(&bytes[end], payload + (end - fragment->min), new_end - end);
      end = new_end;
    }
    bytes.resize(end);
    return bytes;
  });
}

ddsi_serdata* FromPieces(const ddsi_sertype* type,
                         ddsi_serdata_kind kind,
                         ddsrt_msg_iovlen_t num_pieces,
                         const ddsrt_iovec_t* pieces,
                         std::size_t size) {
  return TryMake(type, kind, [&] {
    std::vector<std::byte> bytes;
    bytes.reserve(size);
    for (const ddsrt_iovec_t& piece : std::span(pieces, static_cast<std::size_t>(num_pieces))) {
      const auto* begin = static_cast<const std::byte*>(piece.iov_base);
      bytes.insert(bytes.end(), begin, begin + std::min(piece.iov_len, size - bytes.size()));
    }
    return bytes;
  });
}

// Samples come and go as bytes, by dds_writecdr() and dds_takecdr(): nobody makes objects of them.
constexpr ddsi_serdata_ops kDataOps = {
    .eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; },
    .get_size =
        [](const ddsi_serdata* sample) {
          return static_cast<std::uint32_t>(Raw(sample).bytes.size());
        },
    .from_ser = FromFragments,
    .from_ser_iov = FromPieces,
    .from_keyhash = KeyOf,
    .from_sample = [](const ddsi_sertype*, ddsi_serdata_kind, const void*) -> ddsi_serdata* {
      return nullptr;
    },
    .to_ser =
        [](const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* buffer) {
          std::memcpy(buffer, Raw(sample).bytes.data() + offset, size);
        },
    .to_ser_ref =
        [](const ddsi_serdata* sample, std::size_t offset, std::size_t size, ddsrt_iovec_t* ref) {
          ref->iov_base = const_cast<std::byte*>(Raw(sample).bytes.data() + offset);
          ref->iov_len = size;
          return ddsi_serdata_ref(sample);
        },
    .to_ser_unref = [](ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); },
    .to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; },
    .to_untyped = UntypedOf,
    .untyped_to_sample =
        [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return false; },
    .free = [](ddsi_serdata* sample) { delete static_cast<RawData*>(sample); },
    .print =
        [](const ddsi_sertype* type, const ddsi_serdata*, char* text, std::size_t size) {
          const int length = std::snprintf(text, size, "%s", type->type_name);
          return static_cast<std::size_t>(length);
        },
    .get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; },
#ifdef DDS_HAS_SHM
    // Shared memory is switched off in the configuration.
    .get_sample_size = nullptr,
    .from_iox_buffer = nullptr,
#endif
};

constexpr ddsi_sertype_ops kTypeOps = {
    .version = ddsi_sertype_v0,
    .arg = nullptr,
    .free =
        [](ddsi_sertype* type) {
          ddsi_sertype_fini(type);
          delete type;
        },
    .zero_samples = nullptr,
    .realloc_samples = nullptr,
    .free_samples = nullptr,
    .equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; },
    .hash = [](const ddsi_sertype*) -> std::uint32_t { return 0; },
    .type_id = nullptr,
    .type_map = nullptr,
    .type_info = nullptr,
    .derive_sertype = nullptr,
    .get_serialized_size = nullptr,
    .serialize_into = nullptr,
};

}  // namespace

ddsi_sertype* MakeRawType(const std::string& name) {
  auto* type = new ddsi_sertype();
  ddsi_sertype_init(type, name.c_str(), &kTypeOps, &kDataOps, /*topickind_no_key=*/true);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

ddsi_serdata* MakeRawSample(const ddsi_sertype* type, std::span<const std::byte> cdr) {
  return new RawData(type, SDK_DATA, {cdr.begin(), cdr.end()});
}

const std::vector<std::byte>& BytesOf(const ddsi_serdata* sample) {
  return Raw(sample).bytes;
}

}  // namespace railcast::dds
