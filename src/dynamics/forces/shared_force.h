// A force that its owner shares with a simulator.
#pragma once

#include "dynamics/forces/force.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace sprung {

/// Passes all calls on to a force that others may own and change too.
class SharedForce final : public Force {
 public:
  explicit SharedForce(std::shared_ptr<Force> force) : force_(std::move(force)) {}

  [[nodiscard]] std::string name() const override { return force_->name(); }
  void prepare(double time) override { force_->prepare(time); }
  void follow(const Conditions& conditions) override { force_->follow(conditions); }
  void set_step(double dt) override { force_->set_step(dt); }
  [[nodiscard]] std::optional<std::vector<Index>> touched() const override { return force_->touched(); }
  [[nodiscard]] bool is_constant() const override { return force_->is_constant(); }
  void add(const Kinematics& at, Points& forces) const override { force_->add(at, forces); }
  void couple(std::vector<ParticlePair>& pairs) const override { force_->couple(pairs); }
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override {
    force_->add_derivatives(at, derivatives);
  }
  void append_elements(std::vector<LinearElement>& elements) const override { force_->append_elements(elements); }
  void note_solution(const Points& positions) override { force_->note_solution(positions); }
  [[nodiscard]] double energy(const Points& positions) const override { return force_->energy(positions); }
  [[nodiscard]] EnergyKind energy_kind() const override { return force_->energy_kind(); }
  [[nodiscard]] double capacity() const override { return force_->capacity(); }
  [[nodiscard]] double largest_acceleration() const override { return force_->largest_acceleration(); }

 private:
  std::shared_ptr<Force> force_;
};

}  // namespace sprung
