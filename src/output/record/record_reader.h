// Reads record.bin.
#pragma once

#include "output/record/recorded_model.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

/// Reads a record. Whole frames count; a part of one at the end is ignored.
class RecordReader {
 public:
  /// Throws FileError if the file cannot be read, InputError that says what is wrong with it.
  explicit RecordReader(std::filesystem::path file);
  ~RecordReader();
  RecordReader(RecordReader&&) noexcept;
  RecordReader& operator=(RecordReader&&) noexcept;

  [[nodiscard]] const RecordedModel& model() const;

  /// fingerprint() of the head.
  [[nodiscard]] const std::string& fingerprint() const;

  /// The number of whole frames.
  [[nodiscard]] int frames() const;

  /// A frame, counted from 1, at most frames(). Throws FileError if it cannot be read, InputError if it does not fit the
  /// model. Thread-safe.
  [[nodiscard]] RecordedFrame frame(int number) const;

  /// Reads only the broken springs of a frame: 1 for each that has broken. Empty if none can break. Throws as frame().
  [[nodiscard]] std::vector<char> broken(int number) const;

 private:
  struct Contents;
  std::unique_ptr<const Contents> contents_;
};

}  // namespace sprung
