// What a page is sent, whenever it comes and however slow it reads.
#include "viewer/server/board.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

/// All that is new to a reader, as text.
std::vector<std::string> read_all(const Board& board, Reader& reader) {
  std::vector<std::string> messages;
  while (const auto next = board.next(reader)) messages.emplace_back(next->bytes->begin(), next->bytes->end());
  return messages;
}

using Messages = std::vector<std::string>;

TEST(Board, AReaderThatComesLateGetsTheWholePictureOnce) {
  Board board("hello");
  board.show_state("paused");
  board.show_scene(0, "scene", Board::text("topology"));
  board.show_frame(0, Board::text("frame 1"));
  board.show_frame(0, Board::text("frame 2"));
  Reader reader;
  EXPECT_EQ(read_all(board, reader), (Messages{"hello", "paused", "scene", "topology", "frame 2"}));
  EXPECT_EQ(read_all(board, reader), Messages{});
}

TEST(Board, ASlowReaderGetsTheNewestFrameOnly) {
  Board board("hello");
  board.show_scene(0, "scene", Board::text("topology"));
  Reader reader;
  read_all(board, reader);
  for (int k = 1; k <= 100; ++k) board.show_frame(0, Board::text("frame " + std::to_string(k)));
  EXPECT_EQ(read_all(board, reader), Messages{"frame 100"});
}

TEST(Board, AFrameOfAnEarlierSceneIsNotSent) {
  Board board("hello");
  board.show_scene(0, "scene 1", Board::text("topology 1"));
  board.show_frame(0, Board::text("frame of 1"));
  Reader reader;
  board.show_scene(0, "scene 2", Board::text("topology 2"));
  EXPECT_EQ(read_all(board, reader), (Messages{"hello", "scene 2", "topology 2"}));
}

TEST(Board, ADivergenceIsShownToLatePagesUntilTheRunBeginsAnew) {
  Board board("hello");
  board.show_scene(0, "scene", Board::text("topology"));
  board.show_divergence(0, "diverged");
  Reader late;
  EXPECT_EQ(read_all(board, late), (Messages{"hello", "scene", "topology", "diverged"}));
  board.show_scene(0, "scene again", Board::text("topology again"));
  Reader later;
  EXPECT_EQ(read_all(board, later), (Messages{"hello", "scene again", "topology again"}));
}

TEST(Board, RunsComeAndGo) {
  Board board("hello");
  Reader reader;
  board.show_scene(0, "left", Board::text("left topology"));
  board.show_scene(1, "right", Board::text("right topology"));
  EXPECT_EQ(read_all(board, reader), (Messages{"hello", "left", "left topology", "right", "right topology"}));
  board.remove_run(1, "right is gone");
  EXPECT_EQ(read_all(board, reader), Messages{"right is gone"});
  Reader late;
  EXPECT_EQ(read_all(board, late), (Messages{"hello", "left", "left topology"})) << "it never knew of the run";
  board.show_scene(1, "again", Board::text("topology again"));
  EXPECT_EQ(read_all(board, reader), (Messages{"again", "topology again"}));
}

TEST(Board, ARunThatBeginsAnewReplacesItsRemoval) {
  Board board("hello");
  board.show_scene(1, "right", Board::text("topology"));
  Reader reader;
  read_all(board, reader);
  board.remove_run(1, "right is gone");
  board.show_scene(1, "again", Board::text("topology again"));
  EXPECT_EQ(read_all(board, reader), (Messages{"again", "topology again"}));
}

TEST(Board, AFailureIsShownUntilThereIsSomethingToShow) {
  Board board("hello");
  board.show_failure("no scene");
  Reader early;
  EXPECT_EQ(read_all(board, early), (Messages{"hello", "no scene"}));
  board.show_failure("");
  board.show_scene(0, "scene", Board::text("topology"));
  EXPECT_EQ(read_all(board, early), (Messages{"scene", "topology"}));
  Reader late;
  EXPECT_EQ(read_all(board, late), (Messages{"hello", "scene", "topology"}));
}

TEST(Board, AnswersComeInTheirOrderBeforeFrames) {
  Board board("hello");
  Reader reader;
  read_all(board, reader);
  board.show_frame(0, Board::text("frame"));
  reader.waiting.push_back({Board::text("first"), false});
  reader.waiting.push_back({Board::text("second"), false});
  EXPECT_EQ(read_all(board, reader), (Messages{"first", "second", "frame"}));
}

}  // namespace
}  // namespace sprung
