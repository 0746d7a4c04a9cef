#include "output/exporters/vtk_exporter.h"

#include "base/files/file_pattern.h"
#include "base/format.h"
#include "output/exporters/binary_text.h"

#include <algorithm>
#include <numeric>

namespace sprung {
namespace {

constexpr std::uint8_t kBroken = 3;
constexpr std::uint8_t kNoSpring = 4;

/// Arrays after the XML text: each begins with its size [bytes].
class Appended {
 public:
  template <class Number>
  void add(const std::string& type, const std::string& name, int components, const std::vector<Number>& numbers) {
    open(type, name, components, numbers.size() * sizeof(Number));
    for (const Number number : numbers) append_little(bytes_, number);
  }
  void add(const std::string& name, const Points& points) {
    open("Float64", name, 3, static_cast<std::size_t>(points.size()) * sizeof(double));
    append_points<double>(bytes_, points);
  }
  void open_element(const std::string& name) { xml_.append("<").append(name).append(">\n"); }
  void close_element(const std::string& name) { xml_.append("</").append(name).append(">\n"); }

  [[nodiscard]] const std::string& xml() const { return xml_; }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void open(const std::string& type, const std::string& name, int components, std::size_t size) {
    xml_.append("<DataArray type=\"").append(type).append("\" Name=\"").append(name);
    xml_.append("\" NumberOfComponents=\"").append(std::to_string(components));
    xml_.append("\" format=\"appended\" offset=\"").append(std::to_string(bytes_.size())).append("\"/>\n");
    append_little(bytes_, static_cast<std::uint64_t>(size));
  }

  std::string xml_;
  std::string bytes_;
};

void add_cells(const std::string& element, const std::vector<std::int32_t>& vertices, const std::vector<std::int32_t>& ends,
               Appended& to) {
  to.open_element(element);
  to.add("Int32", "connectivity", 1, vertices);
  to.add("Int32", "offsets", 1, ends);
  to.close_element(element);
}

/// The springs of a body with the vertices of their ends, and their cell data.
struct SpringCells {
  std::vector<std::int32_t> vertices;
  std::vector<float> tension;
  std::vector<std::uint8_t> kind;
};

bool vertices_are_particles(const RecordedBody& body) {
  if (static_cast<Index>(body.particle_of.size()) != body.particle_count) return false;
  for (Index i = 0; i < body.particle_count; ++i) {
    if (body.particle_of[i] != body.first_particle + i) return false;
  }
  return true;
}

SpringCells spring_cells(const RecordedModel& model, const RecordedBody& body, const RecordedFrame& frame) {
  SpringCells cells;
  const RecordedSprings& springs = model.springs;
  const auto is_own = [&](Index particle) {
    return particle >= body.first_particle && particle < body.first_particle + body.particle_count;
  };
  for (std::size_t s = 0; s < springs.kinds.size(); ++s) {
    const auto ends = springs.ends.col(static_cast<Eigen::Index>(s));
    if (!is_own(ends[0]) || !is_own(ends[1])) continue;
    for (const Index end : {ends[0], ends[1]}) cells.vertices.push_back(end - body.first_particle);
    const bool is_broken = !frame.broken.empty() && frame.broken[s] != 0;
    double tension = 0.0;
    if (!is_broken && s < springs.stiffness.size()) {
      const Vector3 between = frame.positions.col(ends[0]) - frame.positions.col(ends[1]);
      const double length = between.norm();
      tension = springs.stiffness[s] * (length - springs.rest_lengths[s]);
      if (frame.velocities.cols() > 0 && length > 0.0) {
        tension += springs.damping[s] * (frame.velocities.col(ends[0]) - frame.velocities.col(ends[1])).dot(between) / length;
      }
    }
    cells.tension.push_back(static_cast<float>(tension));
    cells.kind.push_back(is_broken ? kBroken : static_cast<std::uint8_t>(springs.kinds[s]));
  }
  return cells;
}

}  // namespace

std::vector<std::string> VtkExporter::patterns() const {
  std::vector<std::string> patterns = SequenceExporter::patterns();
  for (const ExportedShape& shape : shapes()) {
    if (shape.changes) patterns.push_back(shape.folder + shape.name + ".pvd");
  }
  return patterns;
}

std::vector<std::string> VtkExporter::losses(bool /*tears*/) const {
  const bool has_uvs =
      std::ranges::any_of(run().model.bodies, [](const RecordedBody& body) { return !body.faces.texcoord.empty(); });
  std::vector<std::string> losses;
  for (const RecordedBody& body : run().model.bodies) {
    if (vertices_are_particles(body)) continue;
    losses.push_back("the VTK files of " + body.name + " have no springs and tension: its vertices are not its particles");
  }
  if (has_materials(run().model) || has_groups(run().model) || has_uvs) {
    losses.emplace_back("the VTK files have no UVs, no groups and no materials of faces");
  }
  return losses;
}

std::string VtkExporter::bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const {
  const Points vertices = vertices_of(run().model, shape, frame.state);
  const PolygonFaces faces = faces_in(shape, frame);
  const bool is_body = shape.body != kNone;
  SpringCells lines;
  if (is_body && vertices_are_particles(run().model.bodies[shape.body])) {
    lines = spring_cells(run().model, run().model.bodies[shape.body], frame.state);
  } else {
    for (const Index end : shape.lines.reshaped()) lines.vertices.push_back(end);
    lines.tension.assign(static_cast<std::size_t>(shape.lines.cols()), 0.0F);
    lines.kind.assign(lines.tension.size(), kNoSpring);
  }
  const std::size_t line_count = lines.kind.size();
  const auto face_count = static_cast<std::size_t>(faces.face_count());

  Appended arrays;
  arrays.open_element("Points");
  arrays.add("Points", vertices);
  arrays.close_element("Points");
  if (is_body) {
    const VertexState state = vertex_state(run().model, run().model.bodies[shape.body], frame.state);
    arrays.open_element("PointData");
    arrays.add("velocity", state.velocities);
    arrays.add("Float32", "stretch", 1, state.stretch);
    arrays.add("UInt8", "contact", 1, state.contact);
    arrays.close_element("PointData");
    lines.tension.resize(line_count + face_count, 0.0F);
    lines.kind.resize(line_count + face_count, kNoSpring);
    arrays.open_element("CellData");
    arrays.add("Float32", "tension", 1, lines.tension);
    arrays.add("UInt8", "kind", 1, lines.kind);
    arrays.close_element("CellData");
  }
  std::vector<std::int32_t> ends(line_count);
  for (std::size_t k = 0; k < line_count; ++k) ends[k] = static_cast<std::int32_t>(2 * (k + 1));
  add_cells("Lines", lines.vertices, ends, arrays);
  add_cells("Polys", {faces.vertex.begin(), faces.vertex.end()}, {faces.corner_begin.begin() + 1, faces.corner_begin.end()},
            arrays);

  std::string bytes =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">";
  append_number(bytes, frame.state.time);
  bytes.append("</DataArray></FieldData>\n<Piece NumberOfPoints=\"").append(std::to_string(vertices.cols()));
  bytes.append("\" NumberOfVerts=\"0\" NumberOfLines=\"").append(std::to_string(line_count));
  bytes.append("\" NumberOfStrips=\"0\" NumberOfPolys=\"").append(std::to_string(face_count)).append("\">\n");
  bytes.append(arrays.xml()).append("</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_").append(arrays.bytes());
  return bytes.append("\n</AppendedData>\n</VTKFile>\n");
}

std::vector<ExportedFile> VtkExporter::end(int frames) {
  std::vector<ExportedFile> files;
  for (const ExportedShape& shape : shapes()) {
    if (!shape.changes) continue;
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (int frame = 1; frame <= frames; ++frame) {
      text += "<DataSet timestep=\"";
      append_number(text, (frame - 1) / run().frame_rate);
      const std::string file = fill_pattern(pattern_of(shape), frame);
      text.append("\" part=\"0\" file=\"").append(file.substr(shape.folder.size())).append("\"/>\n");
    }
    files.push_back({shape.folder + shape.name + ".pvd", text + "</Collection>\n</VTKFile>\n"});
  }
  return files;
}

}  // namespace sprung
