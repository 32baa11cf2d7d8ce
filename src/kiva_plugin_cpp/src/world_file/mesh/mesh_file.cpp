// SPDX-License-Identifier: Apache-2.0
#include "world_file/mesh/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "world_file/files/bounded_cache.h"
#include "world_file/files/file_stamps.h"
#include "world_file/mesh/mesh_limits.h"

namespace kiva {
namespace {

namespace fs = std::filesystem;

struct CachedMesh {
  std::shared_ptr<const Mesh> mesh;
  FileStamps stamps;
};

std::string lower(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::tolower(letter));
  return text;
}

/// Returns a file's ending, in lower case.
std::string formatOf(const std::string& file) {
  const std::string ending = lower(fs::path(file).extension().string());
  for (const char* known : {".dae", ".obj", ".stl"}) {
    if (ending == known) return ending;
  }
  throw DescriptionError("meshes of the format '" + ending +
                         "' are not supported; expected .dae, .obj or .stl");
}

const aiScene* import(const std::string& file, Assimp::Importer* importer) {
  importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Keeps positions alone, so that vertices at equal positions become one.
  importer->SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, ~aiComponent_MESHES);
  importer->SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                               aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene =
      importer->ReadFile(file, aiProcess_RemoveComponent | aiProcess_Triangulate |
                                   aiProcess_SortByPType | aiProcess_JoinIdenticalVertices);
  if (!scene || !scene->mRootNode) {
    throw DescriptionError(std::string("can't be read: ") + importer->GetErrorString());
  }
  return scene;
}

/// Collects the triangles of a scene's nodes.
class Collector {
 public:
  Collector(const aiScene& scene, const MeshRequest& request) : scene_(scene), request_(request) {}

  Mesh collect() {
    add(*scene_.mRootNode, aiMatrix4x4(), request_.submesh.empty());
    return std::move(mesh_);
  }

 private:
  /// Returns whether the request includes a submesh of that name: its node's name or its own.
  bool isWanted(const aiString& name) const { return request_.submesh == name.C_Str(); }

  void add(const aiNode& node, const aiMatrix4x4& parent, bool is_wanted) {
    const aiMatrix4x4 pose = parent * node.mTransformation;
    is_wanted = is_wanted || isWanted(node.mName);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& part = *scene_.mMeshes[node.mMeshes[i]];
      if (is_wanted || isWanted(part.mName)) add(part, pose);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], pose, is_wanted);
  }

  void add(const aiMesh& part, const aiMatrix4x4& pose) {
    checkTriangles(mesh_.triangles.size() + part.mNumFaces);
    const int first = static_cast<int>(mesh_.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D at = pose * part.mVertices[i];
      mesh_.vertices.push_back(Vector3(at.x, at.y, at.z) * request_.scale);
      if (mesh_.vertices.back().IsFinite()) continue;
      throw DescriptionError("a vertex is not finite");
    }
    // A mirroring scale turns triangles inside out.
    const bool flips = request_.scale.X() * request_.scale.Y() * request_.scale.Z() < 0;
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices == 3) addTriangle(first, face.mIndices, flips);
    }
  }

  void addTriangle(int first, const unsigned* corner, bool flips) {
    std::array<int, 3> triangle;
    for (int i = 0; i < 3; ++i) triangle[i] = first + static_cast<int>(corner[i]);
    if (flips) std::swap(triangle[1], triangle[2]);
    const auto& at = mesh_.vertices;
    const Vector3 along = at[triangle[1]] - at[triangle[0]];
    const Vector3 across = at[triangle[2]] - at[triangle[0]];
    if (along.Cross(across).Length() > 0) mesh_.triangles.push_back(triangle);
  }

  const aiScene& scene_;
  const MeshRequest& request_;
  Mesh mesh_;
};

void centre(Mesh* mesh) {
  const Vector3 middle = (mesh->min + mesh->max) * 0.5;
  for (Vector3& vertex : mesh->vertices) vertex -= middle;
  measure(mesh);
}

std::shared_ptr<const Mesh> read(const MeshRequest& request) {
  checkMeshFile(request.file, formatOf(request.file));
  Assimp::Importer importer;
  auto mesh =
      std::make_shared<Mesh>(Collector(*import(request.file, &importer), request).collect());
  if (mesh->triangles.empty()) {
    throw DescriptionError(request.submesh.empty() ? "holds no triangles"
                                                   : "holds no submesh '" + request.submesh + "'");
  }
  measure(mesh.get());
  if (request.is_centred) centre(mesh.get());
  return mesh;
}

std::string keyOf(const MeshRequest& request) {
  std::ostringstream key;
  key.precision(17);
  key << request.file << '\n'
      << request.scale.X() << ' ' << request.scale.Y() << ' ' << request.scale.Z() << '\n'
      << request.submesh << '\n'
      << request.is_centred;
  return key.str();
}

}  // namespace

std::shared_ptr<const Mesh> readMesh(const MeshRequest& request) {
  static BoundedCache<CachedMesh> cache(256);
  const std::string key = keyOf(request);
  const auto known = cache.find(key);
  if (known && known->stamps.areCurrent()) return known->mesh;
  const FileStamps stamps({request.file});
  const auto mesh = read(request);
  cache.put(key, std::make_shared<const CachedMesh>(CachedMesh{mesh, stamps}));
  return mesh;
}

void measure(Mesh* mesh) {
  mesh->min = mesh->max = mesh->vertices.front();
  for (const Vector3& vertex : mesh->vertices) {
    mesh->min.Min(vertex);
    mesh->max.Max(vertex);
  }
}

}  // namespace kiva
