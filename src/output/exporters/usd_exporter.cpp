#include "output/exporters/usd_exporter.h"

#include "base/format.h"

#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <set>
#include <utility>

namespace sprung {
namespace {

// What the name of a body's lines has more than that of its faces.
constexpr const char* kLines = "_lines";

void append_float(std::string& text, double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(value)).ptr;
  text.append(digits.data(), end);
}

void begin_sample(std::string& text, int frame) { text.append("            ").append(std::to_string(frame)).append(": "); }

std::string tuple(const Points& points, const std::vector<Index>* order = nullptr) {
  std::string text = "[";
  const auto count = order != nullptr ? static_cast<Eigen::Index>(order->size()) : points.cols();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index column = order != nullptr ? (*order)[static_cast<std::size_t>(i)] : i;
    text += i == 0 ? "(" : ", (";
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) text += ", ";
      append_float(text, points(axis, column));
    }
    text += ')';
  }
  return text + "]";
}

template <class Numbers>
std::string list(const Numbers& numbers) {
  std::string text = "[";
  for (const auto number : numbers) {
    if (text.size() > 1) text += ", ";
    text += std::to_string(number);
  }
  return text + "]";
}

/// A name that USD accepts: `-` becomes `_`, and a digit at the begin gets a `_` before it.
std::string prim_name(const std::string& name) {
  std::string result;
  for (const char letter : name) result += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  if (result.empty() || std::isdigit(static_cast<unsigned char>(result.front())) != 0) result.insert(0, 1, '_');
  return result;
}

/// An attribute with time samples.
std::string attribute(const std::string& declaration, const std::string& samples) {
  return "        " + declaration + ".timeSamples = {\n" + samples + "        }\n";
}

std::string subsets(const std::vector<std::string>& names, const std::vector<Index>& begins, Index faces,
                    const std::string& family) {
  std::string text;
  std::map<std::string, std::vector<Index>> faces_of;  // of each name
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Index end = k + 1 < begins.size() ? begins[k + 1] : faces;
    for (Index f = begins[k]; f < end; ++f) faces_of[names[k]].push_back(f);
  }
  std::set<std::string> taken;
  for (const auto& [given, numbers] : faces_of) {
    std::string name = prim_name(given);
    while (!taken.insert(name).second) name += '_';
    text.append("        def GeomSubset \"").append(family).append("_").append(name).append("\"\n        {\n");
    text.append("            uniform token elementType = \"face\"\n            uniform token familyName = \"").append(family);
    text.append("\"\n            int[] indices = ").append(list(numbers)).append("\n        }\n");
  }
  return text;
}

}  // namespace

UsdExporter::UsdExporter(ExportedRun run) : run_(std::move(run)), shapes_(shapes_of(run_.model)), samples_(shapes_.size()) {}

void UsdExporter::add_faces(const PolygonFaces& faces, int frame, Samples& to) const {
  std::vector<Index> counts;
  for (Index f = 0; f < faces.face_count(); ++f) counts.push_back(faces.corner_begin[f + 1] - faces.corner_begin[f]);
  begin_sample(to.counts, frame);
  to.counts.append(list(counts)).append(",\n");
  begin_sample(to.indices, frame);
  to.indices.append(list(faces.vertex)).append(",\n");
  if (faces.texcoord.empty()) return;
  begin_sample(to.texcoords, frame);
  to.texcoords += '[';
  for (std::size_t c = 0; c < faces.texcoord.size(); ++c) {
    const Index uv = faces.texcoord[c];
    to.texcoords += c == 0 ? "(" : ", (";
    append_float(to.texcoords, uv == kNone ? 0.0 : faces.texcoords[uv][0]);
    to.texcoords += ", ";
    append_float(to.texcoords, uv == kNone ? 0.0 : faces.texcoords[uv][1]);
    to.texcoords += ')';
  }
  to.texcoords += "],\n";
}

std::vector<std::string> UsdExporter::losses(bool /*tears*/) const {
  if (!has_materials(run_.model)) return {};
  return {"animation.usda has the faces of each material as a subset, without colours and textures"};
}

std::vector<ExportedFile> UsdExporter::frame(const ExportedFrame& frame) {
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const ExportedShape& shape = shapes_[k];
    Samples& samples = samples_[k];
    const bool is_rigid = shape.body == kNone && run_.model.obstacles[shape.obstacle].motion == ObstacleMotion::rigid;
    const std::size_t torn =
        shape.body != kNone && static_cast<std::size_t>(shape.body) < frame.torn.size() ? frame.torn[shape.body].size() : 0;
    if (shape.faces.face_count() > 0 && (frame.number == 1 || torn != samples.torn)) {
      add_faces(faces_in(shape, frame), frame.number, samples);
      samples.torn = torn;
    }
    if (is_rigid) {
      begin_sample(samples.transform, frame.number);
      const Eigen::Matrix4d pose = frame.state.poses[shape.obstacle].matrix();
      samples.transform += "( ";
      for (int column = 0; column < 4; ++column) {  // USD multiplies rows from the left
        samples.transform += column == 0 ? "(" : ", (";
        for (int row = 0; row < 4; ++row) {
          if (row > 0) samples.transform += ", ";
          append_number(samples.transform, pose(row, column));
        }
        samples.transform += ')';
      }
      samples.transform += " ),\n";
    }
    if (frame.number > 1 && (is_rigid || !shape.changes)) continue;
    const Points vertices =
        is_rigid ? run_.model.obstacles[shape.obstacle].mesh.vertices : vertices_of(run_.model, shape, frame.state);
    if (shape.faces.face_count() > 0) {
      begin_sample(samples.points, frame.number);
      samples.points.append(tuple(vertices)).append(",\n");
    }
    if (shape.lines.cols() > 0) {
      const std::vector<Index> ends(shape.lines.data(), shape.lines.data() + shape.lines.size());
      begin_sample(samples.curves, frame.number);
      samples.curves.append(tuple(vertices, &ends)).append(",\n");
    }
  }
  return {};
}

std::string UsdExporter::mesh_text(const std::string& name, const ExportedShape& shape, const Samples& samples) const {
  std::string text;
  if (shape.faces.face_count() > 0) {
    text.append("    def Mesh \"").append(name).append("\"\n    {\n        uniform token subdivisionScheme = \"none\"\n");
    text += "        uniform bool doubleSided = 1\n";
    text += attribute("int[] faceVertexCounts", samples.counts) + attribute("int[] faceVertexIndices", samples.indices) +
            attribute("point3f[] points", samples.points);
    if (!samples.texcoords.empty()) {
      text += "        texCoord2f[] primvars:st (interpolation = \"faceVarying\")\n" +
              attribute("texCoord2f[] primvars:st", samples.texcoords);
    }
    if (!samples.transform.empty()) {
      text += attribute("matrix4d xformOp:transform", samples.transform) +
              "        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n";
    }
    if (shape.body != kNone) {
      const RecordedBody& body = run_.model.bodies[shape.body];
      text += subsets(body.face_materials, body.face_material_begin, shape.faces.face_count(), "material");
      text += subsets(shape.faces.groups, shape.faces.group_begin, shape.faces.face_count(), "group");
    }
    text += "    }\n";
  }
  if (shape.lines.cols() > 0) {
    text.append("    def BasisCurves \"").append(name).append(shape.faces.face_count() > 0 ? kLines : "").append("\"\n    {\n");
    text += "        uniform token type = \"linear\"\n        int[] curveVertexCounts = ";
    text += list(std::vector<int>(static_cast<std::size_t>(shape.lines.cols()), 2)) + "\n" +
            attribute("point3f[] points", samples.curves);
    text += "    }\n";
  }
  return text;
}

std::vector<ExportedFile> UsdExporter::end(int frames) {
  std::string text = "#usda 1.0\n(\n    defaultPrim = \"sprung\"\n    doc = \"Sprung " SPRUNG_VERSION
                     "\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n";
  text.append("    startTimeCode = 1\n    endTimeCode = ").append(std::to_string(frames)).append("\n    timeCodesPerSecond = ");
  append_number(text, run_.frame_rate);
  text += "\n    framesPerSecond = ";
  append_number(text, run_.frame_rate);
  text += "\n)\n\ndef Xform \"sprung\"\n{\n";
  std::set<std::string> taken;
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    std::string name = prim_name(shapes_[k].body == kNone ? "obstacle_" + shapes_[k].name : shapes_[k].name);
    while (taken.contains(name) || taken.contains(name + kLines)) name += '_';
    taken.insert({name, name + kLines});
    text += mesh_text(name, shapes_[k], samples_[k]);
  }
  return {{"animation.usda", text + "}\n"}};
}

}  // namespace sprung
