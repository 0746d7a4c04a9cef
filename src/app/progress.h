// Shows the progress of a run: a bar on a terminal, a line at intervals elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace sprung {

class Progress {
 public:
  /// `done` frames are there before the run.
  Progress(int frames, int done, bool quiet);
  /// Ends the line of the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Call after each frame.
  void frame_done(int frame);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] bool is_due(int frame, Clock::time_point now) const;
  [[nodiscard]] std::string line(int frame, double seconds) const;

  int frames_;
  int done_;
  bool quiet_;
  bool terminal_;
  int shown_frame_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
};

/// `12 s`, `3 min 20 s`, `1 h 5 min`
[[nodiscard]] std::string describe_duration(double seconds);

}  // namespace sprung
