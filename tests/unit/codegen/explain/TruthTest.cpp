// Is the output of `rtslc explain` true? For each thing that it calls needed the examples are
// compiled without it, and the PTX must be another; what it calls left out can be taken away again,
// and the PTX must stay.
#include "codegen/driver/MachineCode.h"
#include "codegen/driver/Stages.h"
#include "scenefile/SceneFile.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace rtsl;

namespace {

/// A scene whose program can be compiled with changes.
class Explained {
public:
  explicit Explained(const std::string &file, const std::vector<std::string> &overrides = {})
      : description(scene::readSceneFile(file, overrides)),
        module(tool::loadShaders(description, options, messages)) {
    EXPECT_TRUE(module);
    request = tool::linkRequest(description);
    options.compile.optimization = 1; // takes half of the time of 2
  }

  MakeObjects makeObjects() {
    return [this](const auto &constructors) {
      objects.emplace(scene::buildScene(description, constructors));
      return objects->facts();
    };
  }

  Findings findings() {
    const auto explanation =
        explainScene(*module, request, options.compile, messages.diagnostics, makeObjects(),
                     /*withSavings=*/false);
    EXPECT_TRUE(explanation);
    return explanation ? explanation->findings : Findings();
  }

  /// The PTX without these things, if the program can do without them.
  std::optional<std::string> ptx(const std::vector<Finding> &without = {}) {
    LinkRequest changed = request;
    CompileOptions compile = options.compile;
    for (const Finding &finding : without) {
      changed.without.insert({finding.item, finding.subject});
      if (finding.item == Item::Events && finding.subject == "index checks")
        compile.checkIndices = false;
      else if (finding.item == Item::Events)
        changed.features = 0;
    }
    Diagnostics unheard(messages.sources);
    CompileInput input;
    input.module = module.get();
    input.scene = &changed;
    input.machineCode = &driver::machineCode();
    // The host runs methods to weigh what shines: with another class's in their place they would
    // read what is not there.
    const bool isDispatch = std::any_of(without.begin(), without.end(), [](const Finding &finding) {
      return finding.isNeeded && finding.item == Item::Dispatch;
    });
    if (isDispatch && objects)
      input.makeObjects = [this](const auto &) { return objects->facts(); };
    else
      input.makeObjects = makeObjects();
    try {
      return emit(stage("ptx"), input, compile, unheard);
    } catch (const Error &) { // without the item, the objects of the scene cannot be made
      return std::nullopt;
    }
  }

  LinkRequest request;

private:
  tool::CommonOptions options;
  tool::Messages messages{options};
  scene::SceneDescription description;
  std::unique_ptr<typed::Module> module;
  std::optional<runtime::Scene> objects;
};

/// What cannot be taken away so that PTX would show it.
bool isExempt(const Finding &finding) {
  if (finding.item == Item::Meshes) // memory, not code
    return true;
  if (finding.item ==
      Item::Objects) // of two objects of one class the code is the same; their records are not
    return true;
  if (finding.item == Item::Tree && finding.isNeeded) // there is nothing that could replace it
    return true;
  // A reference or a buffer is read where it is followed: there is nothing that could stand in its
  // place.
  return ItemSet::ofMembers().has(finding.item) && finding.isNeeded &&
         (finding.reason.find("a reference") != std::string::npos ||
          finding.reason.find("a buffer") != std::string::npos);
}

std::string describe(const Finding &finding) {
  return std::string(nameOf(finding.item)) + ": " + finding.subject + ": " + finding.reason;
}

/// `scene.json`, or the file of the folder's name, of each. Not of the model and of bindless, in
/// which something is called needed though the program is the same without it: the choice between
/// an image and no image in `sampler2D.sample(vec2, float)`, and footprints (here derivatives of a
/// Parallelogram) though no image has levels. Nor of some that have nothing which others do not
/// have, for the time that they take: each takes seconds, so only `make deep` tries more than every
/// twelfth one.
std::vector<std::string> examples() {
  std::vector<std::string> files;
  for (const auto &entry : std::filesystem::directory_iterator(RTSL_ROOT "/examples")) {
    const std::filesystem::path folder = entry.path().filename();
    static const std::set<std::filesystem::path> leftOut = {
        "gltf", "bindless", "cook", "environment", "mandelbulb", "occlusion"};
    if (leftOut.count(folder))
      continue;
    for (const std::string &name : {std::string("scene.json"), folder.string() + ".json"})
      if (const auto scene = entry.path() / name; std::filesystem::exists(scene)) {
        files.push_back(scene.string());
        break;
      }
  }
  std::sort(files.begin(), files.end());
  if (std::getenv("RTSL_EXPLAIN_ALL"))
    return files;
  std::vector<std::string> some;
  for (std::size_t i = 3; i < files.size(); i += 12)
    some.push_back(files[i]);
  return some;
}

/// A method that others call, which the engine of a library may do for nothing: a lamp's BSDF is
/// called, and is zero.
bool isCalledByLibrary(const Finding &finding) {
  return finding.item == Item::Methods &&
         finding.place.file.find("/library/std/") != std::string::npos &&
         finding.reason.find("called by") == 0;
}

class Truth : public testing::TestWithParam<std::string> {};

} // namespace

TEST_P(Truth, WhatIsNeededChangesTheProgramAndWhatIsLeftOutDoesNot) {
  Explained scene(GetParam());
  const std::optional<std::string> whole = scene.ptx();
  ASSERT_TRUE(whole);
  std::vector<Finding> needed, leftOut;
  for (const Finding &finding : scene.findings())
    if (!isExempt(finding) && !(finding.isNeeded && isCalledByLibrary(finding)))
      (finding.isNeeded ? needed : leftOut).push_back(finding);
  EXPECT_GE(needed.size(), 5u);
  EXPECT_GE(leftOut.size(), 5u);

  // Each takes a compilation, of seconds for a large program: of many, some that are spread over
  // the list, from another one on in each scene. `make deep` tries all.
  const bool isLarge = whole->size() > 1000000;
  const std::size_t most = std::getenv("RTSL_EXPLAIN_ALL") ? needed.size() : isLarge ? 1 : 3;
  const std::size_t step = (needed.size() + most - 1) / most;
  for (std::size_t i = whole->size() % step; i < needed.size(); i += step) {
    const Finding &finding = needed[i];
    const std::optional<std::string> without = scene.ptx({finding});
    EXPECT_TRUE(!without || *without != *whole)
        << describe(finding) << " -- but the program is the same without it";
  }
  // All at once, and only where that shows something one by one: a compilation takes a second.
  if (scene.ptx(leftOut) == whole)
    return;
  for (const Finding &finding : leftOut)
    EXPECT_TRUE(scene.ptx({finding}) == whole)
        << describe(finding) << " -- but the program is another without it";
  ADD_FAILURE() << "the program is another without all that is left out";
}

INSTANTIATE_TEST_SUITE_P(Examples, Truth, testing::ValuesIn(examples()), [](const auto &info) {
  std::string name = std::filesystem::path(info.param).parent_path().filename().string();
  std::replace_if(name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

/// PTX without the records and instances of the scene: an object that nothing uses has a record.
std::string withoutTables(const std::string &ptx) {
  std::istringstream lines(ptx);
  std::string line, rest;
  unsigned tables = 0;
  while (std::getline(lines, line)) {
    const bool isTable = line.find(".global .align 16 .b8 rtsl_$_") == 0;
    tables += isTable;
    if (!isTable)
      rest += line + "\n";
  }
  EXPECT_EQ(tables, 2u);
  return rest;
}

// The numbers of the glass example with a material that nothing has: the code is the one without.
TEST(Unused, AMaterialOnNoObjectLeavesTheProgramAsItIs) {
  const std::string glass = std::string(RTSL_ROOT) + "/examples/glass/scene.json";
  const std::string unused =
      R"(materials.unused={"class":"Glass","constructor":{"index":1.7,"surroundings":1.0,"tint":[0.5,0.5,0.5]}})";
  Explained plain(glass), with(glass, {unused});
  EXPECT_EQ(withoutTables(*plain.ptx()), withoutTables(*with.ptx()));
}
