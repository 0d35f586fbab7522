//===- PathsTest.cpp - which rays leave hits, and what they have ----------===//
#include "Linked.h"

namespace rtsl {
namespace {

const std::string view = R"(
struct Seen { color light; };
class View : rt_RayGeneration {
  public int count = 1;
  void generate() {
    Seen seen = Seen(color(0.0));
    for (int i = 0; i < count; ++i)
      trace(vec3(0.0), vec3(rt_ScreenCoord, 1.0), 0.0, 1e30, seen);
    rt_SampleColor = seen.light;
  }
};
)";

std::string meeting(const std::string &statements) {
  return view + R"(
Seen sendFrom(vec3 p, vec3 d, Seen seen) {
  trace(p, d, 0.0, 1e30, seen);
  return seen;
}
class Met : rt_Material {
  void closestHit(inout Seen seen) {)" +
         statements + R"(}
};
)";
}

runtime::Program linked(const std::string &source) {
  LinkRequest request;
  request.engine = runtime::Engine::Programs;
  request.classes = {"View", "Met"};
  request.surfaces.emplace_back("", "Met");
  return std::move(Linked(source, request).program);
}

TEST(Paths, OnlyGenerateSendsRays) {
  const runtime::Program program = linked(meeting("seen.light = color(rt_HitDistance);"));
  EXPECT_FALSE(program.raysLeaveHits);
  EXPECT_EQ(program.paths, runtime::Paths::Single);
}

TEST(Paths, RaysLeaveHits) {
  const runtime::Program direct =
      linked(meeting("trace(rt_HitPoint, rt_ShadingNormal, 0.0, 1e30, seen);"));
  EXPECT_TRUE(direct.raysLeaveHits);
  EXPECT_EQ(direct.paths, runtime::Paths::Alike);
  const runtime::Program throughCall =
      linked(meeting("seen = sendFrom(rt_HitPoint, rt_ShadingNormal, seen);"));
  EXPECT_TRUE(throughCall.raysLeaveHits);
  EXPECT_EQ(throughCall.paths, runtime::Paths::Alike);
}

TEST(Paths, RaysToLampsLeaveHitsToo) {
  const runtime::Program program =
      linked(meeting("illuminance (rt_HitPoint) seen.light += rt_LightColor;"));
  EXPECT_TRUE(program.raysLeaveHits);
  EXPECT_EQ(program.paths, runtime::Paths::Single);
}

TEST(Paths, RaysAtRandom) {
  const runtime::Program program =
      linked(meeting("trace(rt_HitPoint, vec3(rand(), rand(), 1.0), 0.0, 1e30, seen);"));
  EXPECT_TRUE(program.raysLeaveHits);
  EXPECT_EQ(program.paths, runtime::Paths::Random);
}

/// The program with another statement in place of the loop that sends rays.
std::string sending(const std::string &statement, std::string source) {
  const std::string loop = "for (int i = 0; i < count; ++i)\n"
                           "      trace(vec3(0.0), vec3(rt_ScreenCoord, 1.0), 0.0, 1e30, seen);";
  return source.replace(source.find(loop), loop.size(), statement);
}

TEST(Paths, SamplesDifferWhereRaysAreInLoops) {
  const std::string source = meeting("seen.light = color(rt_HitDistance);");
  const std::string ray = "seen = sendFrom(vec3(0.0), vec3(1.0), seen);";
  EXPECT_TRUE(linked(source).samplesDiffer);
  EXPECT_TRUE(linked(sending("while (luminance(seen.light) < 1.0) " + ray, source)).samplesDiffer);
  EXPECT_FALSE(linked(sending(ray, source)).samplesDiffer);
  EXPECT_FALSE(linked(sending("if (count > 1) " + ray, source)).samplesDiffer);
}

TEST(Paths, SamplesDifferWhereRaysEndAtAnyHit) {
  std::string source = sending("seen = sendFrom(vec3(0.0), vec3(1.0), seen);", meeting(""));
  EXPECT_FALSE(linked(source).samplesDiffer);
  source.replace(source.find("closestHit"), 10, "anyHit");
  EXPECT_TRUE(linked(source).samplesDiffer);
}

TEST(Paths, OnlyGenerateReadsTheLaunch) {
  std::string source = meeting("seen.light = color(rt_HitDistance);");
  source.replace(source.find("seen.light;\n"), 12, "seen.light * float(rt_LaunchSize.x);\n");
  EXPECT_FALSE(linked(source).raysReadLaunch);
}

TEST(Paths, ShadersOfHitsReadTheLaunch) {
  EXPECT_TRUE(linked(meeting("seen.light = color(float(rt_LaunchIndex.x));")).raysReadLaunch);
  EXPECT_TRUE(linked(meeting("seen.light = color(width());} float width() {"
                             " return float(rt_LaunchSize.x);"))
                  .raysReadLaunch);
}

} // namespace
} // namespace rtsl
