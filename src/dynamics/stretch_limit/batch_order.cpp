#include "dynamics/stretch_limit/batch_order.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace sprung {
namespace {

// Tasks are cut by size alone; some 10 us of work are worth waking a thread for.
constexpr Index kTaskBatches = 4096 / SpringBatches::kBatchSprings;

// The springs between two chunks extend by a band with each colour on either side, and the chunks must keep some in their middle.
// With two chunks many springs may lie between them: in a cloth of 64 x 64 with bend springs each chunk has 1.2 bands per colour,
// a fifth of the springs remain serial, and two threads save a third of a drape. With fewer batches than this, waiting costs what
// parallelism saves.
constexpr Index kBandsPerColour = 3;
constexpr Index kBatchesForTwo = 4 * kTaskBatches;

// A batch that reads what the previous one has just written stalls: colours follow each other at a distance of this many bands.
constexpr Index kBandsBetweenColours = 2;

/// Calls `body` with each particle of a batch.
template <class Body>
void for_particles(const SpringBatches& batches, Index b, const Body& body) {
  for (Index s = batches.batch[b].begin; s < batches.batch[b].end; ++s) {
    body(batches.first[s]);
    body(batches.second[s]);
  }
}

class Order {
 public:
  Order(const SpringBatches& batches, const std::vector<Index>& colour_begin, Index band, Index particles)
      : batches_(batches), particles_(particles) {
    for (std::size_t colour = 0; colour + 1 < colour_begin.size(); ++colour) {
      for (Index p = colour_begin[colour]; p < colour_begin[colour + 1]; ++p) {
        waiting_.push_back(p);
        ranks_.push_back(lowest_particle(p) + static_cast<Index>(colour) * kBandsBetweenColours * band);
      }
    }
  }

  /// Adds a stage of the batches that concern one chunk of particles alone and no waiting batch. The chunks begin at `offset`
  /// before the first particle.
  void add_chunks(Index chunk, Index offset) {
    std::vector<std::vector<Index>> of_chunks((particles_ + offset - 1) / chunk + 1);
    std::vector<bool> waits_for(particles_, false);
    std::vector<Index> left;
    for (const Index p : waiting_) {
      const Index owner = (batches_.first[batches_.batch[p].begin] + offset) / chunk;
      bool alone = true;
      for_particles(batches_, p, [&](Index i) { alone = alone && (i + offset) / chunk == owner && !waits_for[i]; });
      if (alone) {
        of_chunks[owner].push_back(p);
      } else {
        left.push_back(p);
        for_particles(batches_, p, [&](Index i) { waits_for[i] = true; });
      }
    }
    waiting_ = std::move(left);
    for (const std::vector<Index>& task : of_chunks) add_task(task);
    end_stage();
  }

  /// Adds a stage of one task with all batches that are left.
  void add_rest() {
    add_task(waiting_);
    end_stage();
  }

  void write(SpringBatches& batches) const {
    std::vector<SpringBatches::Batch> ordered;
    ordered.reserve(order_.size());
    for (const Index p : order_) ordered.push_back(batches.batch[p]);
    batches.batch = std::move(ordered);
    batches.task_begin = task_begin_;
    batches.stage_begin = stage_begin_;
  }

 private:
  [[nodiscard]] Index lowest_particle(Index b) const {
    Index lowest = particles_;
    for_particles(batches_, b, [&](Index i) { lowest = std::min(lowest, i); });
    return lowest;
  }

  /// Orders the batches by position, but keeps each after those before it with a common particle.
  void add_task(const std::vector<Index>& members) {
    if (members.empty()) return;
    std::vector<std::vector<std::size_t>> followers(members.size());
    std::vector<int> missing(members.size(), 0);
    std::vector<Index> last_at(particles_, kNone);
    for (std::size_t k = 0; k < members.size(); ++k) {
      for_particles(batches_, members[k], [&](Index i) {
        const auto last = std::exchange(last_at[i], static_cast<Index>(k));
        if (last == kNone || last == static_cast<Index>(k)) return;
        followers[last].push_back(k);
        ++missing[k];
      });
    }
    using Entry = std::pair<Index, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> ready;
    const auto make_ready = [&](std::size_t k) { ready.emplace(ranks_[members[k]], k); };
    for (std::size_t k = 0; k < members.size(); ++k) {
      if (missing[k] == 0) make_ready(k);
    }
    while (!ready.empty()) {
      const std::size_t next = ready.top().second;
      ready.pop();
      order_.push_back(members[next]);
      for (const std::size_t follower : followers[next]) {
        if (--missing[follower] == 0) make_ready(follower);
      }
    }
    task_begin_.push_back(static_cast<Index>(order_.size()));
  }

  void end_stage() {
    const auto tasks = static_cast<Index>(task_begin_.size()) - 1;
    if (tasks > stage_begin_.back()) stage_begin_.push_back(tasks);
  }

  const SpringBatches& batches_;
  Index particles_;
  std::vector<Index> waiting_;  ///< in the order of their colours
  std::vector<Index> ranks_;
  std::vector<Index> order_;
  std::vector<Index> task_begin_{0};
  std::vector<Index> stage_begin_{0};
};

/// Stores springs in the order of their batches, so that a pass reads memory in order.
void store_in_order(SpringBatches& batches) {
  std::vector<Index> springs;
  springs.reserve(batches.first.size());
  for (SpringBatches::Batch& of : batches.batch) {
    const auto begin = static_cast<Index>(springs.size());
    for (Index s = of.begin; s < of.end; ++s) springs.push_back(s);
    of.begin = begin;
    of.end = static_cast<Index>(springs.size());
  }
  const auto reorder = [&](auto& values) {
    const auto before = values;
    std::ranges::transform(springs, values.begin(), [&](Index s) { return before[s]; });
  };
  reorder(batches.spring);
  reorder(batches.first);
  reorder(batches.second);
  reorder(batches.rest_length);
  reorder(batches.per_length);
  reorder(batches.first_share);
}

}  // namespace

void order_by_colour(const std::vector<Index>& colour_begin, SpringBatches& batches) {
  for (std::size_t colour = 0; colour + 1 < colour_begin.size(); ++colour) {
    for (Index p = colour_begin[colour]; p < colour_begin[colour + 1]; p = batches.task_begin.back()) {
      batches.task_begin.push_back(std::min(p + kTaskBatches, colour_begin[colour + 1]));
    }
    batches.stage_begin.push_back(static_cast<Index>(batches.task_begin.size()) - 1);
  }
}

void order_by_locality(const std::vector<Index>& colour_begin, Index band, Index particles, SpringBatches& batches) {
  const auto colours = static_cast<Index>(colour_begin.size()) - 1;
  const Index least = static_cast<Index>(batches.batch.size()) >= kBatchesForTwo ? 2 : 1;
  const Index chunks = std::max(least, particles / std::max(1, kBandsPerColour * colours * band));
  const Index chunk = (particles + chunks - 1) / chunks;
  Order order(batches, colour_begin, band, particles);
  for (const Index offset : {0, chunk / 2, 0}) order.add_chunks(chunk, offset);
  order.add_rest();
  order.write(batches);
  store_in_order(batches);
}

}  // namespace sprung
