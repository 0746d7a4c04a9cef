#include "geometry/import/assimp_reader.h"

#include "geometry/import/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

namespace sprung {
namespace {

// assimp only logs lost geometry and continues. Most of what it logs is harmless: missing materials, flat hierarchies.
class LossCollector : public Assimp::LogStream {
 public:
  explicit LossCollector(std::vector<std::string>& losses) : losses_(losses) {}

  void write(const char* message) override {
    constexpr std::array<std::string_view, 8> kSignsOfLoss{
        "out-of-range",  "dropped",         "nexpected EOF",        "nexpected end of file",
        "invalid index", "nvalid vertex i", "nvalid vertex refere", "to triangulate polygon"};
    const std::string_view text = message;
    const auto reports_loss = [&](std::string_view sign) { return text.find(sign) != std::string_view::npos; };
    if (std::any_of(kSignsOfLoss.begin(), kSignsOfLoss.end(), reports_loss)) losses_.push_back(without_prefix(text));
  }

 private:
  // "Error, T0: OFF: ..." ends with a newline.
  static std::string without_prefix(std::string_view text) {
    const std::size_t prefix = text.find(": ");
    if (prefix != std::string_view::npos) text.remove_prefix(prefix + 2);
    return std::string(text.substr(0, text.find_last_not_of("\r\n") + 1));
  }

  std::vector<std::string>& losses_;
};

// assimp has one log for the whole process.
class LogScope {
 public:
  explicit LogScope(std::vector<std::string>& losses) : lock_(mutex()) {
    Assimp::Logger* log = Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    log->attachStream(new LossCollector(losses), Assimp::Logger::Err | Assimp::Logger::Warn);
  }
  ~LogScope() { Assimp::DefaultLogger::kill(); }
  LogScope(const LogScope&) = delete;
  LogScope& operator=(const LogScope&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex the_mutex;
    return the_mutex;
  }

  std::lock_guard<std::mutex> lock_;
};

std::string shortened(const std::string& text) {
  constexpr std::size_t kReadable = 160;
  return text.size() <= kReadable ? text : text.substr(0, kReadable) + "...";
}

void check_mesh(const aiMesh& mesh, FileProblems& problems) {
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& p = mesh.mVertices[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    problems.add("vertex " + std::to_string(i + 1), "", "each coordinate must be finite and less than 3.4e38");
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] < mesh.mNumVertices) continue;
      problems.add("face " + std::to_string(f + 1), "",
                   "must refer to one of the " + std::to_string(mesh.mNumVertices) + " vertices");
      break;
    }
  }
}

class Collector {
 public:
  explicit Collector(const aiScene& scene) : scene_(scene) {}

  void add_node(const aiNode& node, const Eigen::Matrix4d& parent) {
    Eigen::Matrix4d local;
    for (unsigned row = 0; row < 4; ++row) {
      for (unsigned column = 0; column < 4; ++column) local(row, column) = node.mTransformation[row][column];
    }
    const Eigen::Matrix4d transform = parent * local;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) add_mesh(*scene_.mMeshes[node.mMeshes[m]], transform);
    for (unsigned c = 0; c < node.mNumChildren; ++c) add_node(*node.mChildren[c], transform);
  }

  [[nodiscard]] TriangleMesh mesh() const {
    return {Eigen::Map<const Points>(positions_.data(), 3, std::ssize(positions_) / 3),
            Eigen::Map<const Triangles>(corners_.data(), 3, std::ssize(corners_) / 3)};
  }

 private:
  void add_mesh(const aiMesh& mesh, const Eigen::Matrix4d& transform) {
    const Index first = static_cast<Index>(positions_.size() / 3);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      const Vector3 placed = (transform * Eigen::Vector4d(p.x, p.y, p.z, 1.0)).head<3>();
      positions_.insert(positions_.end(), placed.begin(), placed.end());
    }
    // A mirroring transform turns the faces inside out.
    const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0.0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      std::array<Index, 3> corners{};
      for (unsigned k = 0; k < 3; ++k) corners[k] = first + static_cast<Index>(face.mIndices[k]);
      if (mirrored) std::swap(corners[1], corners[2]);
      corners_.insert(corners_.end(), corners.begin(), corners.end());
    }
  }

  const aiScene& scene_;
  std::vector<double> positions_;
  std::vector<Index> corners_;
};

}  // namespace

// Triangulation is the only post-processing: JoinIdenticalVertices and others use absolute tolerances, and PreTransformVertices
// rounds to float. Indices are checked before it, because it does not check them.
TriangleMesh read_with_assimp(const std::filesystem::path& file, const CheckedFile& checked) {
  Assimp::Importer importer;
  FileProblems problems(file);
  std::vector<std::string> losses;
  const LogScope log(losses);
  const auto report_losses = [&] {
    for (const std::string& loss : losses) problems.add("", "", "is damaged: " + shortened(loss), "export it again");
    problems.throw_if_any();
  };
  const aiScene* scene = importer.ReadFileFromMemory(checked.bytes.data(), checked.bytes.size(), 0, checked.extension.c_str());
  if (scene == nullptr && losses.empty()) losses.emplace_back(importer.GetErrorString());
  report_losses();
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) check_mesh(*scene->mMeshes[m], problems);
  problems.throw_if_any();
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr && losses.empty()) losses.emplace_back(importer.GetErrorString());
  report_losses();
  Collector collector(*scene);
  if (scene->mRootNode != nullptr) collector.add_node(*scene->mRootNode, Eigen::Matrix4d::Identity());
  TriangleMesh mesh = collector.mesh();
  if (!checked.positions.empty()) {
    if (mesh.vertices.cols() != std::ssize(checked.positions))
      throw std::logic_error("assimp did not keep the vertices of a PLY file");
    for (Index i = 0; i < mesh.vertices.cols(); ++i) mesh.vertices.col(i) = checked.positions[i];
  }
  if (!mesh.vertices.allFinite()) problems.add("", "", "its nodes move vertices to positions that are not finite");
  problems.throw_if_any();
  return mesh;
}

}  // namespace sprung
