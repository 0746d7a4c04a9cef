#include "dynamics/stretch_limit/batch_recorder.h"

namespace sprung {

void BatchRecorder::note_ends(const SpringBatches::Batch& batch, const Points& positions) {
  for (Index s = batch.begin; s < batch.end; ++s) momenta_.col(s) = positions.col(shown(s));
}

// The last spring of a batch may fill it up several times.
void BatchRecorder::take_momenta(const SpringBatches::Batch& batch, const Points& positions) {
  for (Index s = batch.begin; s < batch.end; ++s) {
    const bool fills_up = s > batch.begin && batches_.spring[s] == batches_.spring[s - 1];
    const Vector3 moved = positions.col(shown(s)) - momenta_.col(s);
    momenta_.col(s) = fills_up ? Vector3(Vector3::Zero()) : Vector3(network_.masses[shown(s)] * moved);
  }
}

void BatchRecorder::write_to(const ImpulseRecorder& recorder, const Points& positions) const {
  for (Index s = 0; s < batches_.count(); ++s) {
    if (momenta_.col(s).isZero(0.0)) continue;
    const Index other = shows_first(s) ? batches_.second[s] : batches_.first[s];
    const Vector3 direction = (positions.col(other) - positions.col(shown(s))).stableNormalized();
    recorder.add_to_spring(batches_.spring[s], direction.dot(momenta_.col(s)));
    if (network_.is_fixed(other)) recorder.add_to_pinned(other, -momenta_.col(s));
  }
}

}  // namespace sprung
