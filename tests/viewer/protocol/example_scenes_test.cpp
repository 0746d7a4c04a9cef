// What a page offers beside the scene that it shows.
#include "viewer/protocol/example_scenes.h"
#include "scene/scene_text.h"
#include "viewer/protocol/base64.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace sprung {
namespace {

TEST(ExampleScenes, AreTheScenesBesideOneWithTheirSentencesAndPictures) {
  const SceneFolder folder;
  const auto scene = folder.write("rope.json", R"({"bodies": {}})");
  folder.write("cloth.json", R"({"bodies": {}})");
  folder.write("package.json", R"({"name": "no scene"})");
  folder.write("README.md", "| ![](pictures/rope.png) | **rope**: a rope with `pins`. It *swings*. |\n**other**: none\n");
  folder.write("pictures/rope.png", "png");
  const auto lesson = folder.write("lessons/1_damping.json", R"({"bodies": {}})");
  folder.write("lessons/1_damping.txt", "1. Damping\n\nMore.\n");
  for (const auto& shown : {scene, lesson}) {
    const std::vector<ExampleScene> scenes = scenes_beside(shown);
    ASSERT_EQ(scenes.size(), 3u);
    EXPECT_EQ(scenes[0].name, "cloth");
    EXPECT_EQ(scenes[0].sentence, "");
    EXPECT_TRUE(scenes[0].picture.empty());
    EXPECT_EQ(scenes[1].name, "lessons/1_damping");
    EXPECT_EQ(scenes[1].sentence, "1. Damping");
    EXPECT_EQ(scenes[2].name, "rope");
    EXPECT_EQ(scenes[2].sentence, "a rope with pins. It swings.");
    EXPECT_EQ(scenes[2].picture.filename(), "rope.png");
  }
}

// The vectors of RFC 4648.
TEST(Base64, IsThatOfTheStandard) {
  const std::vector<std::pair<std::string, std::string>> vectors{{"", ""},
                                                                 {"f", "Zg=="},
                                                                 {"fo", "Zm8="},
                                                                 {"foo", "Zm9v"},
                                                                 {"foob", "Zm9vYg=="},
                                                                 {"fooba", "Zm9vYmE="},
                                                                 {"foobar", "Zm9vYmFy"}};
  for (const auto& [text, encoded] : vectors) EXPECT_EQ(base64(Bytes(text.begin(), text.end())), encoded);
}

}  // namespace
}  // namespace sprung
