// record.bin holds exactly what was put in, and no damage to it does more than an error.
#include "output/record/record_reader.h"

#include "base/error.h"
#include "base/scratch_folder.h"
#include "output/record/record_encoding.h"
#include "output/recorded_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using testing::frame_of;
using ::testing::HasSubstr;
using testing::model_with_one_of_each;
using testing::read_text;
using testing::ScratchFolder;
using testing::write_text;

class Record : public ::testing::Test {
 protected:
  Record() {
    for (int number = 1; number <= 3; ++number) frames_.push_back(frame_of(model_, number));
    bytes_ = encode_head(model_, frames_[0]);
    for (const RecordedFrame& frame : frames_) bytes_ += encode_frame(frame);
  }
  [[nodiscard]] RecordReader read(const std::string& bytes) const {
    write_text(file(), bytes);
    return RecordReader(file());
  }
  [[nodiscard]] std::string refusal(const std::string& bytes) const {
    try {
      const RecordReader reader = read(bytes);
      for (int number = 1; number <= reader.frames(); ++number) (void)reader.frame(number);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::filesystem::path file() const { return scratch_ / "record.bin"; }

  ScratchFolder scratch_;
  RecordedModel model_ = model_with_one_of_each();
  std::vector<RecordedFrame> frames_;
  std::string bytes_;
};

TEST_F(Record, HoldsTheModelBitForBit) {
  const RecordReader reader = read(bytes_);
  const RecordedModel& model = reader.model();
  EXPECT_EQ(encode_head(model, reader.frame(1)), encode_head(model_, frames_[0]));
  ASSERT_EQ(model.bodies.size(), 2U);
  EXPECT_EQ(model.bodies[0].particle_of, model_.bodies[0].particle_of);
  EXPECT_EQ(model.bodies[0].faces.texcoords, model_.bodies[0].faces.texcoords);
  EXPECT_THAT(model.bodies[0].face_materials, ElementsAre("red paint", "blue"));
  EXPECT_EQ(model.bodies[1].lines, model_.bodies[1].lines);
  const Points points = Points::Random(3, 3);
  const Triangles triangles = Eigen::Vector3i(0, 1, 2);
  for (const std::vector<Index>& torn : {std::vector<Index>{}, {0}}) {
    EXPECT_EQ(model.bodies[0].source->text(points, triangles, torn), model_.bodies[0].source->text(points, triangles, torn));
  }
  EXPECT_EQ(model.bodies[0].source->materials.files[0].text, "newmtl blue\n");
  EXPECT_EQ(model.springs.ends, model_.springs.ends);
  EXPECT_EQ(model.springs.rest_lengths, model_.springs.rest_lengths);
  EXPECT_EQ(model.springs.kinds, model_.springs.kinds);
  EXPECT_EQ(model.pins[0].until, std::numeric_limits<double>::infinity());
  EXPECT_EQ(model.pins[1].obstacle, 1);
  EXPECT_EQ(model.attachments[0].stiffness, 12.5);
  EXPECT_TRUE(model.attachments[1].is_rigid());
  EXPECT_EQ(std::get<ObstacleEnd>(model.attachments[1].second).obstacle, 2);
  EXPECT_EQ(model.attachments[2].rest_length, 0.25);
  EXPECT_EQ(model.obstacles[2].motion, ObstacleMotion::deforming);
  EXPECT_EQ(model.obstacles[0].mesh.vertices, model_.obstacles[0].mesh.vertices);
}

TEST_F(Record, HoldsFramesBitForBitInAnyOrder) {
  const RecordReader reader = read(bytes_);
  ASSERT_EQ(reader.frames(), 3);
  for (const int number : {3, 1, 2}) {
    const RecordedFrame frame = reader.frame(number);
    const RecordedFrame& written = frames_[static_cast<std::size_t>(number - 1)];
    EXPECT_EQ(encode_frame(frame), encode_frame(written)) << number;
    EXPECT_EQ(frame.velocities, written.velocities);
    EXPECT_EQ(frame.poses[1].matrix(), written.poses[1].matrix());
    EXPECT_EQ(reader.broken(number), written.broken);
  }
}

TEST_F(Record, APartOfAFrameAtTheEndDoesNotCount) {
  const std::size_t frame_bytes = encode_frame(frames_[0]).size();
  EXPECT_EQ(read(bytes_.substr(0, bytes_.size() - 1)).frames(), 2);
  EXPECT_EQ(read(bytes_.substr(0, bytes_.size() - frame_bytes)).frames(), 2);
  EXPECT_EQ(read(bytes_.substr(0, bytes_.size() - 3 * frame_bytes)).frames(), 0);
}

TEST_F(Record, ThatEndsEarlierIsRefusedAtAnyLength) {
  const std::size_t head = encode_head(model_, frames_[0]).size();
  for (std::size_t size = 0; size < head; size += 13) EXPECT_NE(refusal(bytes_.substr(0, size)), "") << size;
}

TEST_F(Record, OfAnotherVersionOrKindSaysWhatToDo) {
  std::string newer = bytes_;
  newer[8] = 2;
  EXPECT_THAT(refusal(newer), HasSubstr("version 2"));
  EXPECT_THAT(refusal("solid cube with more than 24 letters"), HasSubstr("no record of Sprung"));
}

// An export writes files by these names.
TEST_F(Record, NamesNoFilesOutsideOfItsFolder) {
  const auto with = [&](const std::string& name, const std::string& other) {
    std::string forged = bytes_;
    forged.replace(forged.find(name), name.size(), other);
    return refusal(forged);
  };
  EXPECT_THAT(with("look/a.mtl\"]", "../../.mtl\"]"), HasSubstr("outside of the folder of its body"));
  EXPECT_THAT(with("look/red.png", "/etc/red.png"), HasSubstr("outside of the folder of its body"));
  EXPECT_THAT(with("\"rope\"", "\"../r\""), HasSubstr("name a folder"));
  EXPECT_THAT(with("\"floor\"", "\"../fl\""), HasSubstr("name a folder"));
}

// Any byte of the head and of a frame may be wrong: the reader refuses the file or returns arrays that fit each other.
TEST_F(Record, DamageIsRefusedOrHarmless) {
  std::mt19937 random(5);
  int refused = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::string damaged = bytes_;
    for (int k = 0; k < 1 + trial % 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    write_text(file(), damaged);
    try {
      const RecordReader reader(file());
      const RecordedModel& model = reader.model();
      for (int number = 1; number <= std::min(reader.frames(), 3); ++number) {
        const RecordedFrame frame = reader.frame(number);
        ASSERT_EQ(frame.positions.cols(), model.particle_count);
        for (const RecordedBody& body : model.bodies) {
          ASSERT_EQ(vertices_of(body, frame).cols(), std::ssize(body.particle_of));
          ASSERT_LE(triangulate(body.faces).size() == 0 ? 0 : triangulate(body.faces).maxCoeff() + 1, std::ssize(body.particle_of));
        }
      }
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, kTrials / 4) << "most bytes are those of the head";
}

}  // namespace
}  // namespace sprung
