#include "scene/reading/scene_rules.h"

#include <algorithm>

namespace sprung {
namespace {

class AttachmentReader {
 public:
  AttachmentReader(const Scene& scene, const Json& bodies, const Json& obstacles)
      : scene_(scene), body_(name_of(bodies, "a body")), obstacle_(name_of(obstacles, "an obstacle")) {}

  [[nodiscard]] AttachmentScene read(Fields& fields) const {
    AttachmentScene attachment;
    const auto first = fields.required("first", object_of<AttachmentEndScene>([&](Fields& end) { return read_first(end); }));
    const auto second = fields.required("second", object_of<AttachmentEndScene>([&](Fields& end) { return read_second(end); }));
    attachment.first = first.value_or(AttachmentEndScene{});
    attachment.second = second.value_or(AttachmentEndScene{});
    check_ends(attachment, fields.location());
    attachment.stiffness = fields.optional("stiffness", number(kNotNegative));
    attachment.damping = read_damping(fields);
    attachment.rest_length = fields.optional("rest_length", number(kNotNegative));
    attachment.break_force = fields.optional("break_force", number(kPositive)).value_or(attachment.break_force);
    read_times(fields, attachment.from, attachment.until);
    return attachment;
  }

 private:
  [[nodiscard]] AttachmentEndScene read_first(Fields& fields) const {
    AttachmentEndScene end;
    fields.set_remedy({"obstacle"}, "only the second end may be an obstacle: the first are particles of a body");
    if (!fields.json().contains("obstacle") || fields.has("body")) {
      end.body = fields.required("body", body_).value_or("");
    }
    if (!fields.json().contains("obstacle") || has_selector(fields)) end.where = read_selector(fields, parts_of(end.body, fields));
    return end;
  }

  [[nodiscard]] AttachmentEndScene read_second(Fields& fields) const {
    AttachmentEndScene end;
    if (fields.one_of({"body", "obstacle"}) == "obstacle") {
      end.obstacle = fields.optional("obstacle", obstacle_).value_or("");
      return end;
    }
    (void)fields.optional("obstacle", text());
    end.body = fields.optional("body", body_).value_or("");
    if (has_selector(fields)) end.where = read_selector(fields, parts_of(end.body, fields));
    return end;
  }

  /// Those of any body if the body is unknown or its shape has problems.
  [[nodiscard]] NamedParts parts_of(const std::string& name, const Fields& fields) const {
    const auto body = std::ranges::find(scene_.bodies, name, &BodyScene::name);
    const std::string shape = "bodies." + name + ".shape";
    const auto is_of_shape = [&](const Problem& problem) { return problem.key.starts_with(shape); };
    if (body == scene_.bodies.end() || std::ranges::any_of(*fields.location().problems, is_of_shape))
      return named_parts(std::nullopt);
    return named_parts(body->shape);
  }

  static void check_ends(const AttachmentScene& attachment, const JsonLocation& location) {
    const AttachmentEndScene& second = attachment.second;
    if (second.body.empty() || second.body != attachment.first.body || second.where) return;
    location.at("second").report_key("must select particles: the nearest point of a body to its own particle is the particle",
                                     "add at, indices, nearest, box, sphere or group");
  }

  static double read_damping(Fields& fields) {
    const auto damping = fields.optional("damping", number(kNotNegative));
    if (damping && !fields.has("stiffness")) {
      fields.location().at("damping").report(fields.json()["damping"], "needs a stiffness: a rigid attachment has no damping",
                                             "add stiffness, or remove it");
    }
    return damping.value_or(0.0);
  }

  const Scene& scene_;
  Rule<std::string> body_;  ///< its name
  Rule<std::string> obstacle_;
};

}  // namespace

Rule<AttachmentScene> attachment_rule(const Scene& scene, const Json& bodies, const Json& obstacles) {
  return object_of<AttachmentScene>(
      [reader = AttachmentReader(scene, bodies, obstacles)](Fields& fields) { return reader.read(fields); });
}

}  // namespace sprung
