// What a sweep varies: grids of values and seeded samples of the keys of a scene.
#pragma once

#include "base/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// What the user asked for.
struct SweepRequest {
  std::vector<std::string> vary{};    ///< `KEY=V1,V2,...`; a value is as after `--set KEY=`
  std::vector<std::string> sample{};  ///< `KEY=uniform(a,b)`, log_uniform, normal or integer
  int count = 0;                      ///< of samples; 0 without `sample`
  std::uint64_t seed = 0;             ///< of the samples
};

inline constexpr int kMostRuns = 1'000'000;

/// The runs of a sweep, numbered from 1. Each combination of the grids is run with each sample; the sample changes fastest, then
/// the last grid. Sample k of a key depends on the seed, the key and k alone, so that all grid points share their samples.
class SweepPlan {
 public:
  /// Throws InputError with every problem.
  explicit SweepPlan(const SweepRequest& request);

  [[nodiscard]] int run_count() const { return runs_; }
  /// The keys of the grids, then those of the samples.
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  /// The text of the value of each key. Requires 1 <= run <= run_count().
  [[nodiscard]] std::vector<std::string> values_of(int run) const;
  /// All values of a key.
  [[nodiscard]] const std::vector<std::string>& values_of_key(std::size_t key) const { return values_[key]; }

 private:
  void read_grid(const std::string& text, std::vector<Problem>& problems);
  void read_samples(const std::string& text, const SweepRequest& request, std::vector<Problem>& problems);
  void add_key(const char* option, const std::string& key, std::vector<Problem>& problems);

  std::vector<std::string> keys_{};
  std::vector<std::vector<std::string>> values_{};  ///< by key
  std::size_t grids_ = 0;                           ///< the first keys
  int samples_ = 1;
  int runs_ = 0;
};

/// Splits at commas outside of brackets, braces and strings: `[1,2],"a,b"` has two values. An empty text has one, which is empty.
[[nodiscard]] std::vector<std::string> split_values(std::string_view text);

/// `KEY=VALUE` of each key, as for --set.
[[nodiscard]] std::vector<std::string> overrides_of(const SweepPlan& plan, int run);

/// The name of the folder of a run: at least four digits.
[[nodiscard]] std::string run_name(int run);

}  // namespace sprung
