// Finds the ends of a scene's attachments.
#pragma once

#include "network/network_builder.h"
#include "scene/building/body_builder.h"
#include "scene/format/text_problems.h"

#include <string>
#include <vector>

namespace sprung {

class AttachmentResolver {
 public:
  /// Keeps references to all. Attachments that the known problems of the text affect are left out. Requires that the scene has the
  /// bodies and obstacles that attachments name.
  AttachmentResolver(const Scene& scene, const TextProblems& known, std::vector<Problem>& problems);

  /// Finds the ends in a body, whose particles begin at `first` in the network. Adds a problem for each selector that selects
  /// nothing. Call it once for each body, in their order.
  void note_body(const BodyScene& body, const BuiltBody& built, Index first);

  /// Adds the attachments. Adds a problem for one with a particle at both ends.
  void add_to(NetworkBuilder& network);

 private:
  struct Ends {
    std::vector<Index> first;
    std::vector<Index> second;
    Index second_body = kNone;
  };
  [[nodiscard]] std::string key_of(std::size_t attachment) const;

  const Scene& scene_;
  const TextProblems& known_;
  std::vector<Problem>& problems_;
  std::vector<Ends> ends_;  ///< by attachment
  Index bodies_ = 0;
};

}  // namespace sprung
