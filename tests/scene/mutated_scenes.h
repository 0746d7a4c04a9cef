// A seeded generator of scenes with mistakes: valid documents, each changed at random positions.
#pragma once

#include "scene/json/json_text.h"

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace sprung {

struct MutatedScene {
  Json document;
  std::vector<std::string> changes;  ///< `mutation at pointer`, printed by failing tests
};

/// Generates mutated copies of valid documents. The same seed gives the same scenes on every machine.
class SceneMutator {
 public:
  /// `valid` must not be empty. Mutations use the words, values and keys of all its documents.
  SceneMutator(std::vector<Json> valid, std::uint32_t seed);

  /// The next scene. Most have one mutation, so that no mistake hides another; some have two or three.
  [[nodiscard]] MutatedScene next();

  /// Names of all mutations.
  [[nodiscard]] static std::vector<std::string> mutation_names();

 private:
  struct Entry {
    std::string key;
    Json value;
  };

  void collect(const Json& json);
  /// Applies mutation number `kind` at a random position. Returns a description, or an empty one if the mutation does not apply.
  std::string mutate(Json& document, std::size_t kind);
  std::size_t pick(std::size_t count) { return random_() % count; }

  std::vector<Json> valid_;
  std::vector<Entry> entries_;  ///< of all objects in the valid documents
  std::mt19937 random_;
};

}  // namespace sprung
