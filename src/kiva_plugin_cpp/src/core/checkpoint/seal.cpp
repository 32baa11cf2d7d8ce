// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint/seal.h"

namespace kiva {
namespace {

constexpr char kMagic[9] = "KIVAWRLD";
constexpr std::uint32_t kVersion = 16;

}  // namespace

std::string sealed(const std::string& content) {
  Writer header;
  std::uint32_t version = kVersion;
  std::uint64_t size = content.size(), hash = hashBytes(kVersion, content.data(), content.size());
  header.bytes = kMagic;
  header(version, size, hash);
  return header.bytes + content;
}

Content opened(const std::string& bytes) {
  Reader reader(bytes);
  char magic[8];
  std::uint32_t version;
  std::uint64_t size, hash;
  reader(magic);
  if (std::memcmp(magic, kMagic, 8) != 0) throw ArchiveError("these bytes are no checkpoint");
  reader(version);
  if (version != kVersion) {
    throw ArchiveError("it has format " + std::to_string(version) + ", and this is format " +
                       std::to_string(kVersion));
  }
  reader(size, hash);
  if (size != reader.left()) {
    throw ArchiveError("it has " + std::to_string(reader.left()) + " bytes of content where " +
                       std::to_string(size) + " were expected");
  }
  if (hashBytes(kVersion, reader.at, size) != hash) throw ArchiveError("its bytes are damaged");
  return {reader, hash};
}

}  // namespace kiva
