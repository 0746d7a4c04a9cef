// Each message of remedies.json names a remedy; whoever follows it gets rid of the message and gets no other.
//
// A row has a `scene`, as a JSON merge patch (RFC 7386) of one of the `bases`; what a message `says`, as a regular expression; the
// exit `code` (0 if it is a warning); and `remedies`, merge patches of the scene, of which each must help. "$1" in a remedy is the
// first group of the expression: the value that the message names. Two keys of a scene are no keys of scene files: `files` to write
// beside it, and `arguments` of the command line, in which FOLDER is the folder of files named `folder/...`. `"when": "run"` marks
// what `validate` cannot know.
//
// `elsewhere` names the test of each message that has no row, for example because no scene causes it: divergence at a stable step,
// other than of overstretched springs (StepCheck tests its remedy). messages_test finds messages without a row. A mesh that is
// one-sided or flat has none, as no remedy is named.
#include "app/command_line_fixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>

namespace sprung {
namespace {

using testing::Ending;
using testing::json;
using testing::Program;
using testing::read_text;
using testing::write_text;

const json& table() {
  static const json kTable = json::parse(read_text(SPRUNG_SOURCE_DIR "/tests/app/remedies.json"));
  return kTable;
}

std::vector<std::string> names() {
  std::vector<std::string> found;
  for (const json& row : table()["rows"]) found.push_back(row["name"]);
  return found;
}

const json& row_of(const std::string& name) {
  return *std::ranges::find_if(table()["rows"], [&](const json& row) { return row["name"] == name; });
}

/// A remedy with the values that the message names.
json with_values(const json& remedy, const std::smatch& message) {
  if (remedy.is_string()) {
    const std::string text = remedy;
    if (text.size() != 2 || text[0] != '$') return remedy;
    const std::string value = message[static_cast<std::size_t>(text[1] - '0')];
    return json::accept(value) ? json::parse(value) : json(value);
  }
  if (!remedy.is_structured()) return remedy;
  json filled = remedy;
  for (json& entry : filled) entry = with_values(entry, message);
  return filled;
}

class Remedies : public testing::CommandLine, public ::testing::WithParamInterface<std::string> {
 protected:
  struct Answer {
    int code = -1;
    std::vector<std::string> messages{};  ///< warnings and errors
  };

  Answer run_scene(const json& scene) const { return answer(scene, {"run", "--overwrite", "--out", out()}, "sprung: warning: "); }

  Answer validate(const json& scene) const { return answer(scene, {"validate"}, "warning "); }

  /// The expression's match in the first message that has one. Refers to `answer`.
  static std::smatch find(const Answer& answer, const std::string& says) {
    std::smatch match;
    for (const std::string& message : answer.messages) {
      if (std::regex_search(message, match, std::regex(says))) break;
    }
    return match;
  }

 private:
  Answer answer(json scene, std::vector<std::string> words, const std::string& warning) const {
    const json files = extract(scene, "files");
    const json arguments = extract(scene, "arguments");
    for (const auto& [name, text] : files.items()) write_text(scratch_ / name, text);
    words.insert(words.end(), arguments.begin(), arguments.end());
    words.insert(words.begin() + 1, save(scene));
    for (std::string& word : words) {
      if (word == "FOLDER") word = (scratch_ / "folder").string();
    }
    const Ending ending = run(words);
    Answer found{.code = ending.code};
    std::istringstream lines(ending.out + ending.err);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with(warning) || line.starts_with("sprung: error: ")) found.messages.push_back(line);
    }
    return found;
  }

  static json extract(json& scene, const std::string& key) {
    json value = scene.value(key, json::object());
    scene.erase(key);
    return value;
  }
};

TEST_P(Remedies, FollowedTheMessageIsGoneAndNoOtherComes) {
  const json& row = row_of(GetParam());
  json scene = table()["bases"][row.value("base", "rope")];
  scene.merge_patch(row["scene"]);
  const std::string says = row["says"];
  const Answer first = run_scene(scene);
  EXPECT_EQ(first.code, row.value("code", 0)) << ::testing::PrintToString(first.messages);
  const std::smatch message = find(first, says);
  ASSERT_FALSE(message.empty()) << ::testing::PrintToString(first.messages);
  if (row.value("when", "load") == "load") {
    const Answer checked = validate(scene);
    EXPECT_FALSE(find(checked, says).empty()) << "validate: " << ::testing::PrintToString(checked.messages);
  }
  for (const json& remedy : row["remedies"]) {
    json changed = scene;
    changed.merge_patch(with_values(remedy, message));
    for (const Answer& answer : {run_scene(changed), validate(changed)}) {
      EXPECT_EQ(answer.code, 0) << remedy;
      EXPECT_THAT(answer.messages, ::testing::IsEmpty()) << remedy;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, Remedies, ::testing::ValuesIn(names()), [](const auto& name) { return name.param; });

}  // namespace
}  // namespace sprung
