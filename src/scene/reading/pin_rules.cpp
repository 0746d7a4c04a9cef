#include "scene/reading/scene_rules.h"

namespace sprung {
namespace {

void read_corners(Fields& fields, const std::vector<std::string>& corners, PinScene& pin) {
  if (corners.empty()) {
    fields.accept("which");
    fields.location().at("at").report(fields.json()["at"], "needs a rope, a cloth or a solid: other shapes have no named corners",
                                      "pin by indices, nearest or box");
    return;
  }
  if (fields.json()["at"] != "corner") {
    fields.accept("which");
    fields.location().at("at").report(fields.json()["at"], "must be \"corner\"", "pin other particles by indices, nearest or box");
    return;
  }
  const auto which = fields.required("which", list_of(word_of(corners), 1));
  if (!which) return;
  PinCorners named;
  for (const std::size_t corner : *which) named.which.push_back(corners[corner]);
  pin.where = std::move(named);
}

std::optional<PinBox> read_box(Fields& fields) {
  const auto box = fields.optional("box", array_of<2>(vector3()));
  if (!box) return std::nullopt;
  if (((*box)[0].array() > (*box)[1].array()).any()) {
    fields.location().at("box").report(fields.json()["box"], "must begin with the smaller coordinates",
                                       "write [[x_min, y_min, z_min], [x_max, y_max, z_max]]");
    return std::nullopt;
  }
  return PinBox{(*box)[0], (*box)[1]};
}

PinScene read_pin(Fields& fields, const std::vector<std::string>& corners) {
  PinScene pin;
  if (fields.has("at")) read_corners(fields, corners, pin);
  const auto indices = fields.optional("indices", list_of(integer(0, kMaxBodyParticles - 1), 1));
  const auto nearest = fields.optional("nearest", vector3());
  const auto box = read_box(fields);
  const std::string key = fields.one_of({"at", "indices", "nearest", "box"}).value_or("");
  if (key == "indices") pin.where = PinIndices{indices.value_or(std::vector<Index>{})};
  if (key == "nearest") pin.where = PinNearest{nearest.value_or(Vector3::Zero())};
  if (key == "box" && box) pin.where = *box;
  pin.motion = fields.value("motion", motion_rule(), Json::object()).value_or(Motion{});
  return pin;
}

}  // namespace

Rule<PinScene> pin_rule(const std::vector<std::string>& corners) {
  return object_of<PinScene>([corners](Fields& fields) { return read_pin(fields, corners); });
}

}  // namespace sprung
