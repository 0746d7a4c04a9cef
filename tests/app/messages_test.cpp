// Each message of the sources has a row in remedies.json.
//
// By convention a warning is made of sentences, so that each text of src/ with a full stop is one. Refused starts, refused steps
// and divergences of `simulation` and `scene/step_choice` have a `remedy`. Other errors of the input are many and of few forms,
// which have rows each; the help, the docstrings of Python and the table of materials are no messages.
#include "base/scratch_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using testing::read_text;

/// A statement's texts, of which neighbours that the compiler joins are one, and the rest of it without spaces.
struct Statement {
  std::vector<std::string> texts;
  std::string code;
};

/// Requires source text without raw strings.
std::vector<Statement> statements_of(const std::string& source) {
  std::vector<Statement> statements(1);
  bool joins = false;  // whether a text would continue the last one
  for (std::size_t i = 0; i < source.size(); ++i) {
    const char letter = source[i];
    Statement& statement = statements.back();
    if (source.compare(i, 2, "//") == 0) {
      i = std::min(source.find('\n', i), source.size());
    } else if (source.compare(i, 2, "'\\") == 0) {
      i += 3;  // '\n'
    } else if (source.compare(i, 3, "'\"'") == 0) {
      i += 2;
    } else if (letter == '"') {
      if (!joins) statement.texts.emplace_back();
      joins = true;
      for (++i; source[i] != '"'; ++i) {
        if (source[i] == '\\') ++i;
        statement.texts.back() += source[i];
      }
    } else if (std::isspace(static_cast<unsigned char>(letter)) == 0) {
      joins = false;
      statement.code += letter;
      if (letter == ';' || letter == '{' || letter == '}') statements.emplace_back();
    }
  }
  return statements;
}

bool is_message(const std::string& path, const Statement& statement) {
  constexpr std::size_t kShortest = 20;
  static const std::regex kSentence(R"([.] [A-Z]|[^.][.]$)");
  const auto is_sentence = [](const std::string& text) { return text.size() >= kShortest && std::regex_search(text, kSentence); };
  if (std::ranges::any_of(statement.texts, is_sentence)) return true;
  return (path.starts_with("simulation/") || path.starts_with("scene/step_choice/")) &&
         statement.code.find("remedy") != std::string::npos;
}

bool has_messages(const std::string& path) {
  if (path.starts_with("app/")) return path == "app/run_watch.cpp";
  const std::array<std::string, 4> others{"python/", "scene/materials/", "scene/reading/", "scene/json/"};
  return path.ends_with(".cpp") &&
         std::ranges::none_of(others, [&](const std::string& folder) { return path.starts_with(folder); });
}

/// The parts of a text between values or operators, without punctuation at their ends, that are long enough to be of one message.
std::vector<std::string> parts_of(const std::string& text, const std::regex& between) {
  constexpr std::size_t kShortest = 15;
  const std::string punctuation = " .,;:";
  std::vector<std::string> parts;
  for (std::sregex_token_iterator part(text.begin(), text.end(), between, -1); part != std::sregex_token_iterator(); ++part) {
    const std::string found = *part;
    const std::size_t begin = found.find_first_not_of(punctuation);
    if (begin == std::string::npos) continue;
    const std::size_t end = found.find_last_not_of(punctuation) + 1;
    if (end - begin >= kShortest) parts.push_back(found.substr(begin, end - begin));
  }
  return parts;
}

std::vector<std::string> parts_of_rows() {
  const std::regex operators(R"(\\.[*+]?|\.[*+]?|[()|?^$*+\[\]{}])");
  const auto table = nlohmann::json::parse(read_text(SPRUNG_SOURCE_DIR "/tests/app/remedies.json"));
  std::vector<std::string> parts;
  for (const char* key : {"rows", "elsewhere"}) {
    for (const auto& row : table[key]) {
      for (std::string& part : parts_of(row["says"], operators)) parts.push_back(std::move(part));
    }
  }
  return parts;
}

TEST(Messages, HaveARowEach) {
  const std::regex values(R"(\{\}|\. )");
  const std::vector<std::string> known = parts_of_rows();
  const std::filesystem::path root = SPRUNG_SOURCE_DIR "/src";
  std::vector<std::string> without_row;
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string path = entry.path().lexically_relative(root).generic_string();
    if (!has_messages(path)) continue;
    for (const Statement& statement : statements_of(read_text(entry.path()))) {
      if (!is_message(path, statement)) continue;
      std::vector<std::string> parts;
      for (const std::string& text : statement.texts) {
        for (std::string& part : parts_of(text, values)) parts.push_back(std::move(part));
      }
      const auto has_row = [&](const std::string& part) {
        return std::ranges::any_of(known, [&](const std::string& row) {
          return part.find(row) != std::string::npos || row.find(part) != std::string::npos;
        });
      };
      if (parts.empty()) continue;
      ++count;
      if (std::ranges::none_of(parts, has_row)) without_row.push_back(path + ": " + parts.front());
    }
  }
  EXPECT_GT(count, 50) << "is every message without a full stop?";
  EXPECT_THAT(without_row, ::testing::IsEmpty()) << "add a row to tests/app/remedies.json";
}

TEST(Messages, AreReadFromSources) {
  const auto statements = statements_of("call(\"a \\\"b\\\" \"  // \"no text\"\n \"c.\", '\"', '\\'', \"d\"); x = 10'000;");
  ASSERT_GE(statements.size(), 2U);
  EXPECT_THAT(statements[0].texts, ::testing::ElementsAre("a \"b\" c.", "d"));
  EXPECT_EQ(statements[1].code, "x=10'000;");
}

}  // namespace
}  // namespace sprung
