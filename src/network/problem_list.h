// Collects the broken rules of an input, so that all are reported in one go. Internal to network/.
#pragma once

#include "base/error.h"
#include "base/format.h"
#include "network/body_shape.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

class ProblemList {
 public:
  void add(std::string key, std::string value, std::string rule, std::string remedy) {
    problems_.push_back({{}, std::move(key), std::move(value), std::move(rule), std::move(remedy)});
  }

  void require_positive(const std::string& key, double value, const std::string& remedy);

  void require_not_negative(const std::string& key, double value, const std::string& remedy);

  void require_count(const std::string& key, std::int64_t value, std::int64_t least);

  /// A particle count beyond kMaxBodyParticles.
  void require_affordable(const std::string& key, const std::string& value, double particles);

  /// Stiffness, modulus and damping of all kinds.
  void require_materials(const SpringMaterials& materials);

  [[nodiscard]] bool empty() const { return problems_.empty(); }

  /// Throws InputError when there are any.
  void throw_if_any() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  std::vector<Problem> problems_;
};

/// `points[3]`
[[nodiscard]] std::string entry_key(const std::string& key, std::size_t entry);

/// `[1, nan, 0]`
[[nodiscard]] std::string vector_text(const Vector3& vector);

/// `[64, 64]`
[[nodiscard]] std::string counts_text(std::span<const Index> counts);

}  // namespace sprung
