#include "scene/building/body_builder.h"

#include "base/format.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/mesh_import.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/topology.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/mesh/weld.h"
#include "geometry/tetrahedra/tetrahedra_mesh.h"
#include "network/bodies/tetrahedra_body.h"
#include "scene/building/lattice_filling.h"
#include "scene/building/particle_selector.h"
#include "scene/json/json_text.h"
#include "scene/json/nearest_name.h"
#include "scene/materials/materials.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sprung {
namespace {

bool names_groups(const Scene& scene, const BodyScene& body) {
  const auto names_group = [](const auto& entry) { return std::holds_alternative<GroupSelector>(entry.where); };
  const auto is_group_of_body = [&](const AttachmentEndScene& end) {
    return end.body == body.name && end.where && std::holds_alternative<GroupSelector>(*end.where);
  };
  return !body.spring_groups.empty() || std::ranges::any_of(body.pins, names_group) ||
         std::ranges::any_of(body.point_masses, names_group) ||
         std::ranges::any_of(scene.attachments, is_group_of_body, &AttachmentScene::first) ||
         std::ranges::any_of(scene.attachments, is_group_of_body, &AttachmentScene::second);
}

class ShapeMaker {
 public:
  ShapeMaker(const Scene& scene, const BodyScene& body, const MeshFinder& finder, std::vector<Problem>& problems)
      : scene_(scene), body_(body), finder_(finder), problems_(problems), key_(join_path("bodies", body.name)) {}

  std::optional<BuiltBody> make() {
    try {
      return std::visit([&](const auto& shape) { return from(shape); }, body_.shape);
    } catch (const InputError& error) {
      for (Problem problem : error.problems()) report(std::move(problem));
      return std::nullopt;
    }
  }

 private:
  // Springs are built from the scaled sizes, because the stiffness that follows from a modulus depends on lengths.
  std::optional<BuiltBody> from(RopeShape rope) const {
    for (Vector3& point : rope.points) point *= body_.place.scale;
    if (rope.length) *rope.length *= body_.place.scale;
    return BuiltBody{make_rope(rope, body_.springs)};
  }

  std::optional<BuiltBody> from(ClothShape cloth) const {
    for (double& side : cloth.size) side *= body_.place.scale;
    return BuiltBody{make_cloth(cloth, body_.springs)};
  }

  std::optional<BuiltBody> from(SolidShape solid) const {
    solid.size *= body_.place.scale;
    BuiltBody body{make_solid(solid, body_.springs)};
    body.shape.preserve_volume = body_.preserve_volume;
    return body;
  }

  std::optional<BuiltBody> from(const TetrahedraFile& tetrahedra) {
    const auto file = finder_.find(tetrahedra.file, key_ + ".shape.file", problems_);
    if (!file) return std::nullopt;
    TetrahedraMesh mesh = read_tetrahedra(*file);
    mesh.vertices *= body_.place.scale;
    BuiltBody body{make_tetrahedra_body(mesh, body_.springs)};
    body.shape.preserve_volume = body_.preserve_volume;
    return body;
  }

  /// Reports a file of tetrahedra that is given as a surface, and returns whether it is one.
  [[nodiscard]] bool refuse_tetrahedra(const std::string& file) {
    if (!is_tetrahedra_file(file)) return false;
    problems_.push_back({scene_.file.string(), key_ + ".shape.file", "\"" + file + "\"",
                         "has the format of tetrahedra, not of a surface",
                         "use \"shape\": { \"type\": \"tetrahedra\", \"file\": ... }, without other keys"});
    return true;
  }

  std::optional<BuiltBody> from(const MeshFile& mesh) {
    const std::string key = key_ + ".shape.file";
    if (refuse_tetrahedra(mesh.file)) return std::nullopt;
    if (lower_case_extension(mesh.file) != ".obj") {
      problems_.push_back({scene_.file.string(), key, "\"" + mesh.file + "\"", "a simulated body is read from an .obj file",
                           "export it as OBJ: other formats lose the order of its vertices"});
      return std::nullopt;
    }
    const auto file = finder_.find(mesh.file, key, problems_);
    if (!file) return std::nullopt;
    PolygonMesh polygons = read_obj(*file);
    polygons.vertices *= body_.place.scale;
    check_preset(polygons);
    ObjSource source = source_of(*file, polygons);
    if (mesh.weld) {
      WeldedMesh welded = weld(std::move(polygons), *mesh.weld);
      polygons = std::move(welded.mesh);
      source.particle_of = std::move(welded.vertex_of);
    }
    ObjGroups groups = names_groups(scene_, body_) ? read_obj_groups(*file) : ObjGroups{};
    BuiltBody body{make_mesh_body(polygons, body_.springs, parts_of(groups)), std::move(source), std::move(groups)};
    fill(body.shape);
    return body;
  }

  std::optional<BuiltBody> from(const LatticeFile& lattice) {
    if (refuse_tetrahedra(lattice.file)) return std::nullopt;
    const auto file = finder_.find(lattice.file, key_ + ".shape.file", problems_);
    if (!file) return std::nullopt;
    PolygonMesh surface;
    std::optional<ObjSource> source;
    if (lower_case_extension(*file) == ".obj") {
      surface = read_obj(*file);
      source = source_of(*file, surface);
    } else {
      const TriangleMesh mesh = import_mesh(*file).mesh;
      surface = {.vertices = mesh.vertices, .faces = to_polygons(mesh.triangles), .lines = Edges(2, 0)};
    }
    surface.vertices *= body_.place.scale;
    const double longest = (surface.vertices.rowwise().maxCoeff() - surface.vertices.rowwise().minCoeff()).maxCoeff();
    const double cell_size = lattice.cells > 0 ? longest / lattice.cells : lattice.cell_size;
    BuiltBody body{make_lattice_body(fill_with_cells(std::move(surface), cell_size), body_.springs), std::move(source)};
    body.shape.preserve_volume = body_.preserve_volume;
    return body;
  }

  /// What frames need of the file of `mesh`.
  [[nodiscard]] ObjSource source_of(const std::filesystem::path& file, const PolygonMesh& mesh) const {
    ObjSource source = read_obj_source(file, body_.normals ? ObjTemplate::Normals::per_vertex : ObjTemplate::Normals::as_given);
    source.faces = mesh.faces;
    source.lines = mesh.lines;
    return source;
  }

  /// The parts of the mesh whose springs have values of their own.
  std::vector<MeshPart> parts_of(const ObjGroups& groups) {
    std::vector<MeshPart> parts;
    for (const SpringGroupScene& group : body_.spring_groups) {
      const auto found = groups.find(group.name);
      if (found == groups.end()) {
        Problem problem = unknown_group(group.name, groups);
        problem.file = scene_.file.string();
        problem.key = join_path(join_path(key_, "springs"), kSpringKindNames[static_cast<std::size_t>(group.kind)]) + ".groups";
        problems_.push_back(std::move(problem));
        continue;
      }
      MeshPart& part = parts.emplace_back(MeshPart{.faces = found->second.faces, .lines = found->second.lines});
      const std::array kinds{&part.materials.structural, &part.materials.shear, &part.materials.bend};
      *kinds.at(static_cast<std::size_t>(group.kind)) = group.material;
    }
    return parts;
  }

  /// Fills a closed mesh with a gas or a liquid.
  void fill(BodyShape& shape) {
    if (body_.pressure == 0.0 && body_.volume_factor == 0.0) return;
    const std::string key = key_ + (body_.pressure != 0.0 ? ".pressure" : ".volume.factor");
    const std::string value = format_number(body_.pressure != 0.0 ? body_.pressure : body_.volume_factor, 6);
    if (!is_closed(shape.surface.triangles)) {
      problems_.push_back({scene_.file.string(), key, value, "needs a closed mesh, in which each edge belongs to two faces",
                           "fill its holes, join vertices at the same place with \"weld\" in its shape, or remove the key"});
      return;
    }
    Points positions(3, static_cast<Index>(shape.positions.size()));
    for (Index i = 0; i < positions.cols(); ++i) positions.col(i) = shape.positions[i];
    const double volume = signed_volume(positions, shape.surface.triangles);
    if (volume == 0.0) {
      problems_.push_back({scene_.file.string(), key, value, "needs a mesh that encloses a volume", "remove it"});
    }
    shape.pressure = std::copysign(1.0, volume) * body_.pressure;
    shape.volume_factor = body_.volume_factor;
  }

  /// A mesh with faces is a cloth, a mesh of lines alone is a rope.
  void check_preset(const PolygonMesh& mesh) {
    if (body_.preset.empty()) return;
    const MaterialKind kind = mesh.faces.face_count() > 0 ? MaterialKind::cloth : MaterialKind::rope;
    const Material* const preset = find_material(body_.preset);
    if (preset == nullptr || preset->kind == kind) return;
    const std::string mesh_is =
        kind == MaterialKind::cloth ? "a mesh with faces, which is a cloth" : "a mesh of lines, which is a rope";
    problems_.push_back({scene_.file.string(), key_ + ".material", "\"" + body_.preset + "\"",
                         "must be a material for " + mesh_is + ": " + joined(material_names({kind})),
                         body_.preset + " is for a " + std::string(material_kind_name(preset->kind))});
  }

  /// Problems of a mesh file name it already; those of a shape get its key in the scene.
  void report(Problem problem) {
    if (problem.file.empty()) {
      problem.file = scene_.file.string();
      problem.key = key_ + (problem.key.starts_with("springs") ? "." : ".shape.") + problem.key;
    }
    problems_.push_back(std::move(problem));
  }

  const Scene& scene_;
  const BodyScene& body_;
  const MeshFinder& finder_;
  std::vector<Problem>& problems_;
  std::string key_;
};

void set_mass(const MassScene& mass, BodyShape& shape) {
  switch (mass.kind) {
    case MassScene::Kind::body:
      return set_total_mass(shape, mass.value);
    case MassScene::Kind::particle:
      return set_total_mass(shape, mass.value * static_cast<double>(std::ssize(shape.positions) - shape.contact_only));
    case MassScene::Kind::density:
      return set_density(shape, mass.value);
  }
}

void add_point_masses(const Scene& scene, const BodyScene& body, BuiltBody& built, std::vector<Problem>& problems) {
  const std::string key = join_path(join_path("bodies", body.name), "point_masses");
  for (std::size_t p = 0; p < body.point_masses.size(); ++p) {
    const PointMassScene& point_mass = body.point_masses[p];
    const SelectorLocation location{scene.file.string(), join_path(key, p)};
    for (const Index i : select_particles(point_mass.where, body, built, location, problems))
      built.shape.masses[i] += point_mass.mass;
  }
}

}  // namespace

std::optional<BuiltBody> build_body(const Scene& scene, const BodyScene& body, const MeshFinder& finder,
                                    std::vector<Problem>& problems) {
  auto built = ShapeMaker(scene, body, finder, problems).make();
  if (!built) return std::nullopt;
  try {
    set_mass(body.mass, built->shape);
  } catch (const InputError& error) {
    for (Problem problem : error.problems()) {
      problem.file = scene.file.string();
      problem.key = join_path("bodies", body.name) + "." + problem.key;
      problems.push_back(std::move(problem));
    }
    return std::nullopt;
  }
  place(built->shape, pose_of(body.place), body.velocity);
  add_point_masses(scene, body, *built, problems);
  return built;
}

RigidTransform pose_of(const Placement& placement) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees(placement.rotation);
  pose.translation() = placement.position;
  return pose;
}

}  // namespace sprung
