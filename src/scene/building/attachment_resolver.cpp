#include "scene/building/attachment_resolver.h"

#include "scene/building/particle_selector.h"
#include "scene/json/json_text.h"

#include <algorithm>
#include <utility>

namespace sprung {

AttachmentResolver::AttachmentResolver(const Scene& scene, const TextProblems& known, std::vector<Problem>& problems)
    : scene_(scene), known_(known), problems_(problems), ends_(scene.attachments.size()) {}

std::string AttachmentResolver::key_of(std::size_t attachment) const { return join_path("attachments", attachment); }

void AttachmentResolver::note_body(const BodyScene& body, const BuiltBody& built, Index first) {
  const Index number = bodies_++;
  if (known_.affect(join_path("bodies", body.name) + ".place")) return;
  const auto select = [&](const AttachmentEndScene& end, const std::string& key) {
    std::vector<Index> particles;
    if (end.where) particles = select_particles(*end.where, body, built, {scene_.file.string(), key}, problems_);
    for (Index& particle : particles) particle += first;
    return particles;
  };
  for (std::size_t a = 0; a < scene_.attachments.size(); ++a) {
    if (known_.affect(key_of(a))) continue;
    const AttachmentScene& attachment = scene_.attachments[a];
    if (attachment.first.body == body.name) ends_[a].first = select(attachment.first, key_of(a) + ".first");
    if (attachment.second.body != body.name) continue;
    ends_[a].second = select(attachment.second, key_of(a) + ".second");
    ends_[a].second_body = number;
  }
}

void AttachmentResolver::add_to(NetworkBuilder& network) {
  for (std::size_t a = 0; a < scene_.attachments.size(); ++a) {
    const AttachmentScene& text = scene_.attachments[a];
    Ends& ends = ends_[a];
    if (ends.first.empty()) continue;  // a problem tells why
    const auto is_second = [&](Index particle) { return std::ranges::binary_search(ends.second, particle); };
    if (std::ranges::any_of(ends.first, is_second)) {
      problems_.push_back({scene_.file.string(), key_of(a), "", "has the same particle at both ends",
                           "select particles at one end that are not among those at the other"});
      continue;
    }
    Attachment attachment{.name = key_of(a),
                          .particles = std::move(ends.first),
                          .second = ParticleEnds{std::move(ends.second)},
                          .stiffness = text.stiffness,
                          .damping = text.damping,
                          .rest_length = text.rest_length,
                          .break_force = text.break_force,
                          .from = text.from,
                          .until = text.until};
    if (!text.second.obstacle.empty()) {
      const auto obstacle = std::ranges::find(scene_.obstacles, text.second.obstacle, &ObstacleScene::name);
      attachment.second = ObstacleEnd{static_cast<Index>(obstacle - scene_.obstacles.begin())};
    } else if (!text.second.where) {
      attachment.second = SurfaceEnd{ends.second_body};
    }
    network.add_attachment(std::move(attachment));
  }
}

}  // namespace sprung
