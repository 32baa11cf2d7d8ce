// SPDX-License-Identifier: Apache-2.0
#include "world_file/mesh/mesh_limits.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "world_file/files/xml.h"

namespace kiva {
namespace {

constexpr std::size_t kMostMeshBytes = 300'000'000;     // a million triangles as text
constexpr std::size_t kMostColladaBytes = 100'000'000;  // Assimp keeps all of it as a tree

/// Calls visit(line) for every line of a file, without the blanks before it.
template <typename Visit>
void forLines(const std::string& file, Visit visit) {
  std::ifstream in(file, std::ios::binary);
  for (std::string line; std::getline(in, line);) {
    visit(line.c_str() + std::min(line.find_first_not_of(" \t"), line.size()));
  }
}

std::size_t trianglesOfStl(const std::string& file, std::size_t size) {
  constexpr std::size_t kHeader = 84, kEach = 50;  // [byte]
  char header[kHeader] = {};
  std::ifstream(file, std::ios::binary).read(header, kHeader);
  std::uint32_t count = 0;
  std::memcpy(&count, header + kHeader - sizeof(count), sizeof(count));
  if (size == kHeader + kEach * count) return count;  // binary
  std::size_t facets = 0;
  forLines(file, [&](const char* line) { facets += std::strncmp(line, "facet", 5) == 0; });
  return facets;
}

/// A face of n corners is n − 2 triangles.
std::size_t trianglesOfObj(const std::string& file) {
  std::size_t triangles = 0;
  forLines(file, [&](const char* line) {
    if (line[0] != 'f' || (line[1] != ' ' && line[1] != '\t')) return;
    std::size_t corners = 0;
    for (const char* at = line + 1; *at; ++at) {
      const bool is_blank = std::strchr(" \t\r", *at), was_blank = std::strchr(" \t\r", at[-1]);
      corners += !is_blank && (was_blank || at == line + 1);
    }
    triangles += corners > 2 ? corners - 2 : 0;
  });
  return triangles;
}

std::size_t trianglesOfCollada(const std::string& file) {
  XmlDocument document;
  document.LoadFile(file.c_str());
  if (document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED) {
    throw DescriptionError("its elements nest deeper than " +
                           std::to_string(TINYXML2_MAX_ELEMENT_DEPTH));
  }
  std::size_t triangles = 0;
  if (!document.RootElement()) return 0;  // Assimp says why.
  forAll(document.RootElement(), [&](XmlElement* element) {
    const std::string name = element->Name();
    const bool has_faces = name == "triangles" || name == "polylist" || name == "polygons" ||
                           name == "trifans" || name == "tristrips";
    if (has_faces) triangles += element->Unsigned64Attribute("count", 0);
  });
  return triangles;
}

}  // namespace

void checkMeshFile(const std::string& file, const std::string& ending) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(file, failed);
  if (failed) return;  // Assimp says why.
  const std::size_t most = ending == ".dae" ? kMostColladaBytes : kMostMeshBytes;
  if (size > most) {
    throw DescriptionError("it has " + std::to_string(size) + " bytes; expected at most " +
                           std::to_string(most));
  }
  if (ending == ".stl") checkTriangles(trianglesOfStl(file, size));
  if (ending == ".obj") checkTriangles(trianglesOfObj(file));
  if (ending == ".dae") checkTriangles(trianglesOfCollada(file));
}

void checkTriangles(std::size_t count) {
  if (count <= kMostTriangles) return;
  throw DescriptionError("it has more than " + std::to_string(kMostTriangles) + " triangles");
}

}  // namespace kiva
