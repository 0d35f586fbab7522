#include "ErrorText.h"

#include "scenefile/SceneFile.h"
#include "scenefile/json/JsonText.h"
#include "scenefile/json/KeyFrames.h"

#include <gtest/gtest.h>

using namespace rtsl::scene;
using rtsl::ErrorCollector;
using rtsl::scene::test::errorOf;

namespace {

std::string at(double frame, const std::string &json) {
  JsonValue value = parseJson(json, "s.json");
  ErrorCollector errors;
  resolveKeyFrames(value, frame, errors);
  errors.throwIfAny();
  return jsonText(value);
}

std::string errorIn(const std::string &json) {
  return errorOf([&] { at(0, json); });
}

} // namespace

TEST(KeyFrames, AreExactAndHeldOutside) {
  const std::string json = R"({"frames": {"24": 0.7, "0": 0.1, "-2.5": 3}})";
  EXPECT_EQ(at(-9, json), "3.0");
  EXPECT_EQ(at(-2.5, json), "3.0");
  EXPECT_EQ(at(0, json), "0.1");
  EXPECT_EQ(at(24, json), "0.7");
  EXPECT_EQ(at(1e9, json), "0.7");
  EXPECT_EQ(at(3, R"({"frames": {"7": true}})"), "true");
}

TEST(KeyFrames, AreInterpolated) {
  EXPECT_EQ(at(1, R"({"frames": {"0": 2, "4": 4}})"), "2.5");
  EXPECT_EQ(at(1, R"({"frames": {"0": 0.1, "3": 0.1}})"), "0.1"); // what does not change is exact
  EXPECT_EQ(at(2, R"([1, {"frames": {"0": [0, [1]], "4": [8, [3]]}}])"), "[1.0,[4.0,[2.0]]]");
  EXPECT_EQ(at(1, R"({"a": {"frames": {"0": {"class": "C", "x": 1, "y": [0, 0]},
                                       "2": {"y": [2, 4], "class": "C", "x": 3}}}})"),
            R"({"a":{"class":"C","x":2.0,"y":[1.0,2.0]}})");
  EXPECT_EQ(at(0.5, R"({"frames": {"0": {"frames": {"0": 0, "1": 8}}, "1": 6}})"), "5.0");
}

TEST(KeyFrames, MayBeSteps) {
  const std::string json =
      R"({"frames": {"0": "a.png", "10": "b.png", "20": [1]}, "interpolate": "step"})";
  EXPECT_EQ(at(-1, json), R"("a.png")");
  EXPECT_EQ(at(9.99, json), R"("a.png")");
  EXPECT_EQ(at(10, json), R"("b.png")");
  EXPECT_EQ(at(21, json), "[1.0]");
}

TEST(KeyFrames, AreNotOtherThingsThatAreCalledFrames) {
  for (const char *json :
       {R"({"frames":{"class":"Frame"}})", R"({"frames":3.0})", R"({"frames":{}})",
        R"({"frames":{"0":1.0},"class":"Film"})", R"({"frames":{"size":[10.0]}})"})
    EXPECT_EQ(at(5, json), json);
}

TEST(KeyFrames, AreCheckedForAllFrames) {
  EXPECT_EQ(errorIn(R"({"frames": {"0": 1, "x": 2}})"),
            "s.json:1:22+1: wrongType: a key of `frames` is the number of a frame, not `x`");
  EXPECT_EQ(errorIn(R"({"frames": {"1": 1, "1.0": 2}})"),
            "s.json:1:22+3: duplicateKey: `1` and `1.0` are the same frame");
  const std::string note =
      " (note `\"interpolate\": \"step\"` beside `frames` makes values change at once)";
  EXPECT_EQ(errorIn(R"({"frames": {"7": [1, 2], "8": [1]}})"),
            "s.json:1:31+1: wrongType: a list of 2 cannot be interpolated with one of 1" + note);
  EXPECT_EQ(errorIn(R"({"frames": {"7": "a", "8": "b"}})"),
            "s.json:1:29+1: wrongType: a string cannot be interpolated" + note);
  EXPECT_EQ(errorIn(R"({"frames": {"7": [1], "8": 2}})"),
            "s.json:1:28+1: wrongType: a list cannot be interpolated with a number" + note);
  EXPECT_EQ(errorIn(R"({"frames": {"7": {"a": 1}, "8": {"b": 1}}})"),
            "s.json:1:33+1: wrongType: this has no `a`, which the key frame before it has: objects "
            "are interpolated only if they have the same keys" +
                note);
  EXPECT_EQ(errorIn(R"({"frames": {"7": {"a": 1}, "8": {}}})"),
            "s.json:1:33+1: wrongType: objects are interpolated only if they have the same keys" +
                note);
  EXPECT_EQ(errorIn(R"({"frames": {"7": 1}, "interpolate": "smooth"})"),
            "s.json:1:38+6: outOfRange: `interpolate` is `linear` or `step`, not `smooth`");
  EXPECT_EQ(errorIn(R"({"frames": {"7": 1}, "interpolate": 1})"),
            "s.json:1:37+1: wrongType: `interpolate` is a string, not a number");
  EXPECT_EQ(errorIn(R"([{"frames": {"0": 1, "x": 2}}, {"frames": {"0": 1, "y": 2}}])"),
            "s.json:1:23+1: wrongType: a key of `frames` is the number of a frame, not `x`\n"
            "s.json:1:53+1: wrongType: a key of `frames` is the number of a frame, not `y`");
}

TEST(KeyFrames, FollowTheFrameOfTheScene) {
  const std::string text =
      R"({"rtsl": 1, "camera": {"class": "C", "eye": {"frames": {"0": [0], "4": [8]}}},
 "objects": [{"mesh": "a.obj", "material": "m", "transform": {"translate": [{"frames": {"0": 1, "4": 2}}, 0, 0]}}]})";
  const auto places = [&](const std::vector<std::string> &overrides) {
    const SceneDescription scene = parseScene(text, "s.json", overrides);
    return std::pair(scene.camera->members.at(0).second->elements.at(0).number,
                     scene.objects.at(0).transform.columns[3][0]);
  };
  EXPECT_EQ(places({}), std::pair(0.0, 1.0));
  EXPECT_EQ(places({"frame=1"}), std::pair(2.0, 1.25));
  EXPECT_EQ(places({"camera.eye={\"frames\": {\"0\": [4], \"2\": [6]}}", "frame=1"}),
            std::pair(5.0, 1.25));
  EXPECT_EQ(errorOf([&] { places({"frame=soon"}); }),
            "--set frame=soon:1:13+4: wrongType: `frame` is a number, not a string");
}

TEST(KeyFrames, AreListed) {
  JsonValue value = parseJson(
      R"([{"frames": {"7": 1, "-2.5": 2}}, {"a": {"frames": {"7": {"frames": {"1": 3}}}}}])",
      "s.json");
  ErrorCollector errors;
  EXPECT_EQ(resolveKeyFrames(value, 0, errors), (std::set<double>{-2.5, 1, 7}));
  const auto isAnimated = [](const std::string &ambient) {
    return parseScene(R"({"rtsl": 1, "camera": {"class": "C"}, "ambient": )" + ambient + "}",
                      "s.json", {})
        .isAnimated;
  };
  EXPECT_TRUE(isAnimated(R"({"frames": {"0": 1, "9": 2}})"));
  EXPECT_FALSE(isAnimated("1"));
}

// What is almost a value with key frames is an error of another kind, whose note says how they are
// written.
TEST(KeyFrames, HaveNotesWhereTheyMatter) {
  const auto errorOfAmbient = [](const std::string &ambient) {
    return errorOf([&] {
      parseScene(R"({"rtsl": 1, "camera": {"class": "C"}, "ambient": )" + ambient + "}", "s.json",
                 {});
    });
  };
  const std::string written =
      " (note key frames are values by the number of a frame, `{\"frames\": {\"0\": ..., \"24\": "
      "...}}`, with nothing beside `frames` but `interpolate`)";
  for (const char *ambient :
       {R"({"frames": {}})", R"({"frames": [1, 2]})", R"({"frames": {"first": 1, "last": 2}})",
        R"({"frames": {"0": 1, "9": 2}, "interpolat": "step"})"})
    EXPECT_EQ(errorOfAmbient(ambient),
              "s.json:1:50+1: wrongType: `ambient` is a color, not an object" + written);
  EXPECT_EQ(errorOfAmbient(R"({"color": 1})"),
            "s.json:1:50+1: wrongType: `ambient` is a color, not an object");

  const auto errorOfSamples = [](const std::string &samples, const std::string &frame) {
    return errorOf([&] {
      parseScene(R"({"rtsl": 1, "camera": {"class": "C"}, "render": {"spp": )" + samples + "}}",
                 "s.json", {"frame=" + frame});
    });
  };
  const std::string keys = R"({"frames": {"0": 16, "9": 64}})";
  EXPECT_EQ(errorOfSamples(keys, "3"), "no error");
  EXPECT_EQ(
      errorOfSamples(keys, "2"),
      "s.json:1:74+2: wrongType: `spp` must be an integer, not 26.6667 (note this is between "
      "two key frames; `\"interpolate\": \"step\"` beside `frames` makes values change at once)");
  EXPECT_EQ(errorOfSamples(R"({"frames": {"0": 1.5, "9": 64}})", "-1"),
            "s.json:1:74+3: wrongType: `spp` must be an integer, not 1.5");
}

TEST(Cameras, AreChosenByName) {
  const auto chosen = [](const std::string &cameras,
                         const std::vector<std::string> &overrides = {}) {
    return parseScene("{\"rtsl\": 1, " + cameras + "}", "s.json", overrides).camera->className.text;
  };
  const std::string both = R"("cameras": {"top": {"class": "T"}, "front": {"class": "F"}})";
  EXPECT_EQ(chosen(both), "T");
  EXPECT_EQ(chosen(both + R"(, "camera": "front")"), "F");
  EXPECT_EQ(chosen(both + R"(, "camera": {"class": "Own"})"), "Own");
  EXPECT_EQ(chosen(both + R"(, "camera": {"class": "Own"})", {"camera=front"}), "F");
  EXPECT_EQ(errorOf([&] { chosen(both + R"(, "camera": "frond")"); }),
            "s.json:1:85+5: unknownName: there is no camera `frond`; there are `top`, `front` (fix "
            "`front`)");
  EXPECT_EQ(errorOf([&] { chosen(R"("camera": "front")"); }),
            "s.json:1:24+5: unknownName: there is no camera `front`: the scene has no `cameras`");
  EXPECT_EQ(errorOf([&] { chosen(R"("cameras": {"top": {"class": ""}, "front": 3})"); }),
            "s.json:1:43+0: unknownClass: a class has no name\n"
            "s.json:1:56+1: wrongType: `front` is an object, not a number");
  EXPECT_EQ(errorOf([&] { chosen(R"("cameras": {})"); }),
            "s.json:1:24+1: missingKey: a scene needs a camera in `cameras`");
}
