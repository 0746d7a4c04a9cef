#include "scene/format/file_wildcard.h"

#include "scene/scene_text.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace sprung {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(NaturalOrder, ComparesNumbersByValue) {
  std::vector<std::string> names{"b2", "b10", "b", "a12c1", "a12b9", "a9", "a", "b02", "b2.5", "9", "10", "b18446744073709551616"};
  std::sort(names.begin(), names.end(), natural_less);
  EXPECT_THAT(names, ElementsAre("9", "10", "a", "a9", "a12b9", "a12c1", "b", "b02", "b2", "b2.5", "b10", "b18446744073709551616"));
}

TEST(NaturalOrder, IsStrictAndTotal) {
  const std::vector<std::string> names{"", "0", "00", "1", "01", "001", "a", "a0", "a00b", "a0b", "a1", "a01", ".", "a.", "A"};
  for (const std::string& a : names) {
    for (const std::string& b : names) {
      EXPECT_EQ(natural_less(a, b) || natural_less(b, a), a != b) << a << " " << b;
      EXPECT_FALSE(natural_less(a, b) && natural_less(b, a));
      for (const std::string& c : names) {
        EXPECT_TRUE(natural_less(a, c) || !natural_less(a, b) || !natural_less(b, c)) << a << " " << b << " " << c;
      }
    }
  }
}

TEST(FileWildcard, HasOneStarInItsLastComponent) {
  for (const char* good : {"*", "*.obj", "a/b/c*", "a/b.*.obj"}) EXPECT_TRUE(is_wildcard(good)) << good;
  for (const char* bad : {"", "a.obj", "*/a.obj", "a*b*", "a/*/b"}) EXPECT_FALSE(is_wildcard(bad)) << bad;
}

TEST(FileWildcard, MatchesFilesAroundTheStar) {
  const SceneFolder folder;
  for (const char* name : {"aa.obj", "a.1.obj", "a.obj", "b.obj", ".a.obj", "a.obj.bak", "sub.obj/x.obj"}) folder.write(name, "");
  const auto names = [&](const char* pattern) {
    std::vector<std::string> found;
    for (const auto& file : matching_files(folder.path() / pattern)) found.push_back(file.filename().string());
    return found;
  };
  EXPECT_THAT(names("*.obj"), ElementsAre("a.1.obj", "a.obj", "aa.obj", "b.obj")) << "neither hidden files nor folders";
  EXPECT_THAT(names("a*.obj"), ElementsAre("a.1.obj", "a.obj", "aa.obj"));
  EXPECT_THAT(names("a.*.obj"), ElementsAre("a.1.obj"));
  EXPECT_THAT(names("a.*a.obj"), IsEmpty()) << "both sides must fit";
  EXPECT_THAT(names(".*.obj"), ElementsAre(".a.obj"));
  EXPECT_THAT(names("none/*.obj"), IsEmpty());
}

TEST(FileWildcard, FindsAGapInTheNumbers) {
  const auto before_gap = [](const std::vector<std::filesystem::path>& files) {
    const auto file = file_before_gap(files, "sub/a.*.obj");
    return file ? file->string() : "";
  };
  EXPECT_EQ(before_gap({"sub/a.1.obj", "sub/a.2.obj", "sub/a.03.obj"}), "");
  EXPECT_EQ(before_gap({"sub/a.4.obj", "sub/a.6.obj", "sub/a.10.obj"}), "sub/a.6.obj");
  EXPECT_EQ(before_gap({"sub/a.0.obj", "sub/a.5.obj", "sub/a.10.obj"}), "") << "every fifth";
  EXPECT_EQ(before_gap({"sub/a.0.obj", "sub/a.9.obj", "sub/a.10.obj"}), "sub/a.0.obj");
  EXPECT_EQ(before_gap({"sub/a.1.obj", "sub/a.x.obj", "sub/a.9.obj"}), "") << "no numbers";
  EXPECT_EQ(before_gap({"sub/a.01.obj", "sub/a.1.obj", "sub/a.2.obj"}), "") << "not numbered one after the other";
  EXPECT_EQ(before_gap({"sub/a.1.obj"}), "");
}

}  // namespace
}  // namespace sprung
