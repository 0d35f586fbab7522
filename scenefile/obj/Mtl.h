//===- Mtl.h - files of materials for OBJ files ---------------------------===//
//
// The statements of a .mtl file, as text with positions; Material.h says what they mean.
//
//   newmtl gold
//   Kd 0.9 0.6 0.2
//   map_Bump -bm 0.5 scratches.png
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/json/JsonValue.h"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl::scene::obj {

/// A word of a line, and where it is.
struct Word {
  std::string_view text; // of the file's text
  std::uint32_t line, column;
};

/// A line: its words. Lines that end with a backslash are continued.
using Line = std::vector<Word>;

/// The lines of a text that are not empty, without comments.
std::vector<Line> linesOf(std::string_view text);

/// A statement of a material, such as `Kd 0.9 0.6 0.2`.
struct Statement {
  std::string keyword;
  std::vector<std::string> arguments;
  JsonValue source; // a null at its position
};

struct Material {
  std::string name;
  JsonValue source;   // at `newmtl`
  std::string folder; // of the file, relative to that of the OBJ file
  std::vector<Statement> statements;

  /// The last one; null: there is none.
  const Statement *find(std::string_view keyword) const;
};

/// The materials of a file; of several with one name the first counts. Throws the errors of
/// readFile, and BadMesh for statements before the first `newmtl`.
std::vector<Material> readMaterials(const std::string &path);

/// Where a word is, for what is made of it.
JsonValue sourceAt(const std::shared_ptr<const std::string> &file, const Word &word);

} // namespace rtsl::scene::obj
