#include "app/progress.h"

#include "app/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace sprung {
namespace {

constexpr std::chrono::milliseconds kBarPause{100};
constexpr std::chrono::seconds kLeastLinePause{1};
constexpr std::chrono::seconds kLinePause{5};
constexpr double kLongFrame = 0.9995;  // [s]; three digits of it are 1000 ms
constexpr int kLines = 10;
constexpr int kBarWidth = 30;
constexpr const char* kClearToEnd = "\x1b[K";

std::string bar(int frame, int frames) {
  const int filled = static_cast<int>(static_cast<double>(kBarWidth) * frame / frames);
  return fmt::format("[{:.<{}}] ", std::string(static_cast<std::size_t>(filled), '#'), kBarWidth);
}

int tenth_of(int frame, int frames) { return static_cast<int>(static_cast<double>(kLines) * frame / frames); }

}  // namespace

Progress::Progress(int frames, int done, bool quiet)
    : frames_(frames), done_(done), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_ && shown_frame_ > 0) std::fputc('\n', stderr);
}

void Progress::frame_done(int frame) {
  const Clock::time_point now = Clock::now();
  if (quiet_ || !is_due(frame, now)) return;
  const std::string text = line(frame, std::chrono::duration<double>(now - start_).count());
  if (terminal_) {
    std::fputs(fmt::format("\r{}{}{}", bar(frame, frames_), text, kClearToEnd).c_str(), stderr);
  } else {
    print_message(text);
  }
  shown_frame_ = frame;
  shown_ = now;
}

bool Progress::is_due(int frame, Clock::time_point now) const {
  if (frame == frames_) return true;
  if (terminal_) return shown_frame_ == 0 || now - shown_ >= kBarPause;
  const bool next_tenth = tenth_of(frame, frames_) > tenth_of(shown_frame_, frames_);
  return now - shown_ >= (next_tenth ? kLeastLinePause : kLinePause);
}

std::string Progress::line(int frame, double seconds) const {
  const double per_frame = seconds / (frame - done_);
  const std::string pace = per_frame < kLongFrame ? fmt::format("{:.3g} ms", 1e3 * per_frame) : describe_duration(per_frame);
  std::string text = fmt::format("frame {}/{}, {} per frame", frame, frames_, pace);
  if (frame < frames_) text += ", " + describe_duration(per_frame * (frames_ - frame)) + " left";
  return text;
}

std::string describe_duration(double seconds) {
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace sprung
