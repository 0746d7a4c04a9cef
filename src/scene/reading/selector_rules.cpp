#include "scene/reading/scene_rules.h"

namespace sprung {
namespace {

std::optional<Selector> read_corners(Fields& fields, const NamedParts& parts) {
  const std::vector<std::string>& corners = parts.corners;
  const std::string others =
      std::string("select particles by indices, nearest, box") + (parts.groups ? ", sphere or group" : " or sphere");
  const JsonLocation at = fields.location().at("at");
  if (corners.empty()) {
    fields.accept("which");
    at.report(fields.json()["at"], "needs a rope, a cloth or a solid: other shapes have no named corners", others);
    return std::nullopt;
  }
  if (fields.json()["at"] != "corner") {
    fields.accept("which");
    at.report(fields.json()["at"], "must be \"corner\"", others);
    return std::nullopt;
  }
  const auto which = fields.required("which", list_of(word_of(corners), 1));
  if (!which) return std::nullopt;
  CornersSelector named;
  for (const std::size_t corner : *which) named.which.push_back(corners[corner]);
  return named;
}

std::optional<Selector> read_box(Fields& fields) {
  const auto box = fields.optional("box", array_of<2>(vector3()));
  if (!box) return std::nullopt;
  if (((*box)[0].array() > (*box)[1].array()).any()) {
    fields.location().at("box").report(fields.json()["box"], "must begin with the smaller coordinates",
                                       "write [[x_min, y_min, z_min], [x_max, y_max, z_max]]");
    return std::nullopt;
  }
  return BoxSelector{(*box)[0], (*box)[1]};
}

/// [[x, y, z], radius]
std::optional<SphereSelector> sphere(Json& json, const JsonLocation& location) {
  if (!detail::check_list(json, location, 2, 2)) return std::nullopt;
  const auto centre = vector3()(json[0], location.at(std::size_t{0}));
  const auto radius = number(kPositive)(json[1], location.at(std::size_t{1}));
  if (!centre || !radius) return std::nullopt;
  return SphereSelector{*centre, *radius};
}

std::optional<Selector> read_group(Fields& fields, bool has_groups) {
  const auto name = fields.optional("group", text());
  if (!name) return std::nullopt;
  if (has_groups) return GroupSelector{*name};
  fields.location().at("group").report(fields.json()["group"], "needs a mesh: other shapes have no groups",
                                       "select particles by at, indices, nearest, box or sphere");
  return std::nullopt;
}

}  // namespace

bool has_selector(Fields& fields) {
  bool any = false;
  for (const char* key : {"at", "indices", "nearest", "box", "sphere", "group"}) any = fields.has(key) || any;
  return any;
}

std::optional<Selector> read_selector(Fields& fields, const NamedParts& parts) {
  std::optional<Selector> corners;
  if (fields.has("at")) corners = read_corners(fields, parts);
  const auto indices = fields.optional("indices", list_of(integer(0, kMaxBodyParticles - 1), 1));
  const auto nearest = fields.optional("nearest", vector3());
  const auto box = read_box(fields);
  const auto in_sphere = fields.optional<SphereSelector>("sphere", sphere);
  const auto group = read_group(fields, parts.groups);
  const std::string key = fields.one_of({"at", "indices", "nearest", "box", "sphere", "group"}).value_or("");
  if (key == "at") return corners;
  if (key == "indices" && indices) return IndicesSelector{*indices};
  if (key == "nearest" && nearest) return NearestSelector{*nearest};
  if (key == "box") return box;
  if (key == "sphere" && in_sphere) return *in_sphere;
  if (key == "group") return group;
  return std::nullopt;
}

}  // namespace sprung
