//===- Explanation.h - what a scene's program contains, as text -----------===//
#pragma once

#include "MeasureItems.h"
#include "codegen/driver/Compiler.h"
#include "runtime/scene/Scene.h"

#include <string>
#include <vector>

namespace rtsl::tool {

/// The item of --keep that data of a mesh belongs to.
Item itemOf(const runtime::Scene::MeshAttribute &attribute);

/// `rtslc explain SCENE` (docs/explain.md).
class Explanation {
public:
  Explanation(std::string scene, const SceneExplanation &program,
              const std::vector<runtime::Scene::MeshAttribute> &meshes);

  /// Adds what `--measure` found.
  void add(std::vector<ItemMeasurement> measured) { measurements = std::move(measured); }

  /// For people: a table of what each item saves, and then what is needed and what is left out,
  /// line by line.
  std::string text() const;
  /// For programs: {"version": 1, "program": {...}, "items": [...]}.
  std::string json() const;

private:
  /// What leaving an item out saves; negative if it costs.
  struct Saved {
    std::int64_t instructions = 0, constantBytes = 0, frameBytes = 0, states = 0, memoryBytes = 0;
  };
  struct Entries {
    Item item;
    std::vector<const Finding *> leftOut, needed;
    bool isKept = false; // with --keep
    Saved saved;
  };
  std::string table() const;
  std::string measurementsText() const;
  std::string entriesText(const Entries &entries) const;

  std::string scene;
  ProgramSize size;
  bool hasSavings;
  Findings findings;
  std::vector<Entries> items;
  std::vector<ItemMeasurement> measurements;
};

} // namespace rtsl::tool
