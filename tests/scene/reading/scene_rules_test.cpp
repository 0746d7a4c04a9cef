// Each rule of a scene has a scene that breaks it.
#include "scene/broken_scenes.h"
#include "scene/json/nearest_name.h"
#include "scene/json/overrides.h"
#include "scene/scene_schema.h"
#include "scene/scene_text.h"

#include <gmock/gmock.h>

namespace sprung {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ResultOf;
using testing::SizeIs;
using testing::StartsWith;

auto says(const std::string& text) {
  return ResultOf(
      "line", [](const Problem& problem) { return to_string(problem); }, HasSubstr(text));
}

class BrokenSceneTest : public testing::TestWithParam<BrokenScene> {};

TEST_P(BrokenSceneTest, IsRefusedWithItsMessage) {
  const SceneFolder folder;
  const auto problems = problems_of([&] { (void)folder.read(kPlainScene, GetParam().changes); });
  EXPECT_THAT(problems, Contains(AllOf(Field(&Problem::key, GetParam().key), says(GetParam().message))));
  EXPECT_THAT(problems, testing::Each(Field(&Problem::file, HasSubstr("scene.json"))));
}

TEST_P(BrokenSceneTest, IsRefusedByTheSchemaIfASchemaCanExpressTheRule) {
  Json document = parse_json(kPlainScene, "").document;
  std::vector<Problem> problems;
  for (const std::string& change : GetParam().changes) apply_override(change, document, problems);
  ASSERT_THAT(problems, IsEmpty());
  EXPECT_EQ(!schema_violations(document).empty(), GetParam().schema_expresses_rule);
}

INSTANTIATE_TEST_SUITE_P(SceneRules, BrokenSceneTest, testing::ValuesIn(broken_scenes()),
                         [](const auto& test) { return test.param.name; });

TEST(SceneRules, AllProblemsAreReportedTogether) {
  const SceneFolder folder;
  const auto problems = problems_of([&] {
    (void)folder.read(kPlainScene, {"duration=-1", "gravty=[0,0,0]", "bodies.banner.mass=0",
                                    "bodies.banner.springs.structural.stiffness=-1", "obstacles.floor.shape.normal=[0,1]"});
  });
  EXPECT_THAT(problems, ElementsAre(Field(&Problem::key, "duration"), Field(&Problem::key, "bodies.banner.mass"),
                                    Field(&Problem::key, "bodies.banner.springs.structural.stiffness"),
                                    Field(&Problem::key, "obstacles.floor.shape.normal"), Field(&Problem::key, "gravty")));
}

// If the type is invalid, the keys of all types are accepted, and other keys are reported.
TEST(SceneRules, AMistypedTypeHidesNoKeysAndAddsNoProblems) {
  const SceneFolder folder;
  const auto problems = problems_of([&] {
    (void)folder.read(kPlainScene, {R"(integrator={"type":"verlett","damping":0.1,"stp":0.1,"step":0.1})",
                                    "bodies.banner.shape.type=clth", "bodies.banner.shape.sise=[1,1]"});
  });
  EXPECT_THAT(problems,
              UnorderedElementsAre(AllOf(Field(&Problem::key, "integrator.type"), says("did you mean \"verlet\"?")),
                                   AllOf(Field(&Problem::key, "integrator.stp"), says("is not a known key")),
                                   AllOf(Field(&Problem::key, "integrator.step"), says("it belongs to the top level of the scene")),
                                   AllOf(Field(&Problem::key, "bodies.banner.shape.type"), says("did you mean \"cloth\"?")),
                                   AllOf(Field(&Problem::key, "bodies.banner.shape.sise"), says("did you mean \"size\"?"))));
}

TEST(SceneRules, LongValuesAreShortened) {
  const SceneFolder folder;
  const auto problems = problems_of([&] { (void)folder.read(kPlainScene, {"duration=\"" + std::string(1000, 'x') + "\""}); });
  EXPECT_THAT(problems, ElementsAre(Field(&Problem::value, AllOf(SizeIs(40), StartsWith("\"xxx"), EndsWith("...")))));
}

TEST(SceneRules, SceneThatIsNotAnObjectIsRefused) {
  const SceneFolder folder;
  for (const char* text : {"[1, 2]", "3", "\"scene\"", "null"}) {
    EXPECT_THAT(problems_of([&] { (void)folder.read(text); }), Contains(says("must be an object"))) << text;
  }
}

struct BrokenText {
  std::string name;
  std::string text;
  std::string key;
  std::string message;
};

std::ostream& operator<<(std::ostream& stream, const BrokenText& text) { return stream << text.name; }

class BrokenTextTest : public testing::TestWithParam<BrokenText> {};

TEST_P(BrokenTextTest, IsRefusedWithItsLocation) {
  const SceneFolder folder;
  const auto problems = problems_of([&] { (void)folder.read(GetParam().text); });
  EXPECT_THAT(problems, ElementsAre(AllOf(Field(&Problem::key, GetParam().key), says(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(
    SceneRules, BrokenTextTest,
    testing::Values(
        BrokenText{"Empty", "", "line 1, column 1", "is empty; write a scene"},
        BrokenText{"Blank", " \n\n ", "line 3, column 2", "is empty"},
        BrokenText{"Truncated", "{\"duration\": 1,\n \"bodies\": {", "line 2, column 13", "ends too early"},
        BrokenText{"TruncatedInAString", "{\"durat", "line 1, column 8", "ends too early"},
        BrokenText{"Comment", "{\n  // how long\n  \"duration\": 1}", "line 2, column 3", "JSON has no comments; remove it"},
        BrokenText{"TrailingComma", "{\"duration\": 1,\n}", "line 2, column 1", "nothing follows the comma; remove the comma"},
        BrokenText{"MissingComma", "{\"duration\": 1\n \"step\": 1}", "line 2, column 2", "check for a missing comma"},
        BrokenText{"MissingCommaBeforeAKey", "{\"a\": {}\n \"step\": 1}", "line 2, column 2", "= \"step\": is not JSON"},
        BrokenText{"SingleQuotes", "{'duration': 1}", "line 1, column 2", "double quotes"},
        BrokenText{"SingleQuotesOfAValue", "{\"step\": 'auto'}", "line 1, column 10", "put strings and keys in double quotes"},
        BrokenText{"KeyWithoutQuotes", "{duration: 1}", "line 1, column 2", "= duration: is not JSON; put keys in double quotes"},
        BrokenText{"SecondKeyWithoutQuotes", "{\"duration\": 1, frame_rate : 1}", "line 1, column 17", "put keys in double quotes"},
        BrokenText{"WordOfPython", "{\"sleep\": True}", "line 1, column 11", "= True}: is not JSON; write true"},
        BrokenText{"OtherWordOfPython", "{\"sleep\": False,\n\"seed\": 1}", "line 1, column 11", "write false"},
        BrokenText{"NothingOfPython", "{\"sleep\": None}", "line 1, column 11", "write null"},
        BrokenText{"NotANumber", "{\"duration\": NaN}", "line 1, column 14", "= NaN}: is not a JSON number"},
        BrokenText{"Infinite", "{\"duration\": -Infinity}", "line 1, column 14", "write a finite number"},
        BrokenText{"TooLarge", "{\"duration\": 1e400}", "line 1, column 14", "1e400: is too large for a number"},
        BrokenText{"TwoValues", "{} {}", "line 1, column 4", "is not JSON"},
        BrokenText{"NulBytesAfterTheText", std::string("{\"duration\": 1}\n\0\0", 18), "line 2, column 1",
                   "is a NUL byte, which no text has"},
        BrokenText{"NulByteBetween", std::string("{\"duration\":\0 1}", 16), "line 1, column 13", "is a NUL byte"},
        BrokenText{"TextAfterTheScene", "{\"duration\": 1}\nx", "line 2, column 1", "is not JSON"},
        BrokenText{"Utf32", std::string("{\0\0\0\"\0\0\0", 8), "", "scene.json: is text in UTF-32; save it in UTF-8"},
        BrokenText{"Utf32OfBigEndianOrder", std::string("\0\0\xFE\xFF\0\0\0{", 8), "", "is text in UTF-32"},
        BrokenText{"Utf32WithAMark", std::string("\xFF\xFE\0\0{\0\0\0", 8), "", "is text in UTF-32"},
        BrokenText{"NotUtf8", "{\"dura\xff\": 1}", "line 1, column 7", "is not JSON"},
        BrokenText{"DuplicateKey", R"({"bodies": {"a": {"pins": [{}, {"at": 1, "at": 2}]}}})", "bodies.a.pins[1].at",
                   "is written twice in the same object"},
        BrokenText{"TooDeep", std::string(100'000, '['),
                   "" +
                       [] {
                         std::string key;
                         for (int level = 0; level < 64; ++level) key += "[0]";
                         return key;
                       }(),
                   "is nested too deeply"}),
    [](const auto& test) { return test.param.name; });

struct BrokenOverride {
  std::string name;
  std::string text;
  std::string message;
};

std::ostream& operator<<(std::ostream& stream, const BrokenOverride& text) { return stream << text.name; }

class BrokenOverrideTest : public testing::TestWithParam<BrokenOverride> {};

TEST_P(BrokenOverrideTest, IsReportedUnderTheKeySet) {
  const SceneFolder folder;
  const auto problems = problems_of([&] { (void)folder.read(kPlainScene, {GetParam().text}); });
  EXPECT_THAT(problems,
              ElementsAre(AllOf(Field(&Problem::key, "--set"), Field(&Problem::value, GetParam().text), says(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(SceneRules, BrokenOverrideTest,
                         testing::Values(BrokenOverride{"NoEquals", "duration", "is not of the form key.path=value"},
                                         BrokenOverride{"NoKey", "=1", "is not of the form"},
                                         BrokenOverride{"NoSuchBody", "bodies.baner.mass=1", "did you mean \"banner\"?"},
                                         BrokenOverride{"NoSuchObstacle", "obstacles.x.friction=1",
                                                        "choose from floor, or set its shape first, to add it"},
                                         BrokenOverride{"EmptyPart", "bodies..mass=1", "is not of the form"},
                                         BrokenOverride{"OpenBracket", "gravity[0=1", "is not of the form"},
                                         BrokenOverride{"IndexIsAWord", "gravity[x]=1", "is not of the form"},
                                         BrokenOverride{"NoValue", "duration=", "neither JSON nor a single word"},
                                         BrokenOverride{"BrokenValue", "gravity=[0,1", "neither JSON nor a single word"},
                                         BrokenOverride{"ThroughANumber", "duration.x=1", "duration has no keys"},
                                         BrokenOverride{"NoList", "duration[0]=1", "duration has no entries"},
                                         BrokenOverride{"EntryOfADefault", "wind[1]=1", "wind is not written in the scene"},
                                         BrokenOverride{"BeyondTheEnd", "bodies.banner.pins[2].at=corner",
                                                        "bodies.banner.pins has 1 entry, so there is no entry 2"}),
                         [](const auto& test) { return test.param.name; });

TEST(SceneRules, ExclusiveKeysAreReportedTogetherWithTheirOwnProblems) {
  const SceneFolder folder;
  const std::string springs = "bodies.banner.springs.structural=";
  const auto problems = problems_of([&] {
    (void)folder.read(kPlainScene,
                      {springs + R"({"stiffness": -10, "modulus": -1, "damping": -2, "damping_ratio": 0})", "bodies.banner.mass=0",
                       "bodies.banner.density=-3", R"(bodies.banner.pins[0]={"nearest": [0, 0, 0], "box": 3, "indices": [-1]})",
                       R"(bodies.rope={"shape": {"type": "rope", "points": 1, "from": 2, "to": [1, 0, 0], "particles": 3}})"});
  });
  const std::string at = "bodies.banner.springs.structural";
  EXPECT_THAT(problems,
              testing::IsSupersetOf({Field(&Problem::key, at), Field(&Problem::key, at), Field(&Problem::key, at + ".stiffness"),
                                     Field(&Problem::key, at + ".modulus"), Field(&Problem::key, at + ".damping"),
                                     Field(&Problem::key, std::string("bodies.banner.mass")),
                                     Field(&Problem::key, std::string("bodies.banner.density")),
                                     Field(&Problem::key, std::string("bodies.banner.pins[0].box")),
                                     Field(&Problem::key, std::string("bodies.banner.pins[0].indices[0]")),
                                     Field(&Problem::key, std::string("bodies.rope.shape.points")),
                                     Field(&Problem::key, std::string("bodies.rope.shape.from"))}));
}

TEST(Overrides, AreNamedInTheProblemsThatTheyCause) {
  const SceneFolder folder;
  const std::string text = R"({"duration": 1, "frame_rate": "fast", "bodies": {}})";
  EXPECT_THAT(problems_of([&] { (void)folder.read(kPlainScene, {"bodies.banner.density=1"}); }),
              ElementsAre(AllOf(Field(&Problem::key, "bodies.banner"), Field(&Problem::file, EndsWith(", changed by --set")))));
  const auto problems = problems_of([&] { (void)folder.read(text, {"duration=two"}); });
  EXPECT_THAT(problems,
              testing::IsSupersetOf({AllOf(Field(&Problem::key, "duration"), Field(&Problem::file, EndsWith(", changed by --set"))),
                                     AllOf(Field(&Problem::key, "frame_rate"), Field(&Problem::file, EndsWith(".json")))}));
}

TEST(NearestName, DoesNotSuggestADifferentWord) {
  EXPECT_EQ(nearest_name("cube", {"cone", "box"}), std::nullopt);
  EXPECT_EQ(nearest_name("bix", {"cone", "box"}), "box");
}

TEST(NearestName, PrefersAMisspeltNameToItsBeginning) {
  EXPECT_EQ(nearest_name("damping_rte", {"damping", "damping_rate"}), "damping_rate");
  EXPECT_EQ(nearest_name("damp", {"drag", "damping", "damping_rate"}), "damping");
}

TEST(NearestName, WordsOfNamesSuggestThemUnlessThereAreMany) {
  const std::vector<std::string> names{"soft_jelly", "firm_jelly", "foam", "rubber_block", "rubber_sheet"};
  EXPECT_EQ(did_you_mean("jelly", names), "did you mean \"soft_jelly\" or \"firm_jelly\"?");
  EXPECT_EQ(did_you_mean("Rubber", names), "did you mean \"rubber_block\" or \"rubber_sheet\"?");
  EXPECT_EQ(did_you_mean("foma", names), "did you mean \"foam\"?");
  EXPECT_EQ(did_you_mean("rope", names), "");
  EXPECT_EQ(did_you_mean("x", {"x_a", "x_b", "x_c"}), "did you mean \"x_a\", \"x_b\" or \"x_c\"?");
  EXPECT_EQ(did_you_mean("x", {"x_a", "x_b", "x_c", "x_d"}), "");
}

}  // namespace
}  // namespace sprung
