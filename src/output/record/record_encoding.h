// Writes the bytes of record.bin; RECORD.md describes them.
#pragma once

#include "output/record/recorded_model.h"

#include <string>
#include <string_view>

namespace sprung {

/// The frame as bytes. All frames of a run have the same number of them: `broken` is empty in all frames, or in none.
[[nodiscard]] std::string encode_frame(const RecordedFrame& frame);

/// 16 digits that tell a head from those of other runs (FNV-1a).
[[nodiscard]] std::string fingerprint(std::string_view head);

/// The begin of a record: all that precedes the frames. `like` is a frame of the run. Reads the `mtllib` files of bodies; throws
/// FileError if one cannot be read.
[[nodiscard]] std::string encode_head(const RecordedModel& model, const RecordedFrame& like);

}  // namespace sprung
