// Messages of pages, well-formed and hostile.
#include "viewer/protocol/page_command.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

TEST(PageCommand, GivesTheValuesOfItsKeys) {
  const PageCommand command(
      R"({"do": "drag", "target": [1, 2.5, -3], "pin": true, "frame": 7, "factor": 0.5, "body": "rope", "value": {"a": [null]}})");
  EXPECT_EQ(command.name(), "drag");
  EXPECT_EQ(command.vector("target"), Vector3(1.0, 2.5, -3.0));
  EXPECT_TRUE(command.flag("pin"));
  EXPECT_FALSE(command.flag("other"));
  EXPECT_EQ(command.integer("frame", 1, 7), 7);
  EXPECT_EQ(command.number("factor"), 0.5);
  EXPECT_EQ(command.number("frame"), 7.0);
  EXPECT_EQ(command.text("body"), "rope");
  EXPECT_EQ(command.json("value"), R"({"a":[null]})");
  EXPECT_TRUE(command.has("body"));
  EXPECT_FALSE(command.has("run"));
}

TEST(PageCommand, RefusesTextsThatAreNoCommand) {
  for (const std::string text :
       {"", " ", "play", "{", "[]", "null", "3", "{}", R"({"do": 3})", R"({"do": null})", R"({"done": "x"})",
        R"({"do": "play"} {"do": "play"})", "{\"do\": \"\xff\"}", R"({"do": "x", "a": 1e999})", R"({"do": "x", "a": NaN})"}) {
    EXPECT_THROW(PageCommand{text}, PageCommandError) << text;
  }
  EXPECT_THROW(PageCommand(std::string("\0", 1)), PageCommandError);
}

TEST(PageCommand, RefusesDeepNesting) {
  const auto nested = [](std::size_t levels) {
    return R"({"do": "set", "value": )" + std::string(levels, '[') + std::string(levels, ']') + "}";
  };
  EXPECT_EQ(PageCommand(nested(20)).name(), "set");
  for (const std::size_t levels : {100u, 1000u, 30000u}) EXPECT_THROW(PageCommand{nested(levels)}, PageCommandError) << levels;
  EXPECT_THROW(PageCommand(std::string(60000, '[')), PageCommandError);
}

TEST(PageCommand, RefusesNumbersOutOfBounds) {
  for (const char* number : {"-1", "3", "1.5", "1.0", "1e300", "4294967296", "18446744073709551615", "-9223372036854775808",
                             "99999999999999999999999", "true", "\"1\"", "[1]", "null"}) {
    const PageCommand command(R"({"do": "x", "run": )" + std::string(number) + "}");
    EXPECT_THROW((void)command.integer("run", 0, 2), PageCommandError) << number;
  }
}

TEST(PageCommand, RefusesVectorsWithoutThreeNumbers) {
  for (const char* vector : {"[]", "[1, 2]", "[1, 2, 3, 4]", "[1, 2, null]", "[1, 2, \"3\"]", "{\"x\": 1}", "1", "null"}) {
    const PageCommand command(R"({"do": "drag", "target": )" + std::string(vector) + "}");
    EXPECT_THROW((void)command.vector("target"), PageCommandError) << vector;
  }
}

}  // namespace
}  // namespace sprung
