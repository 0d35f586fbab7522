//===- Generator.cpp - makes one random program ---------------------------===//
#include "Generator.h"

#include <fstream>

namespace rtsl::random {

Generator::Generator(std::uint32_t seed)
    : random(seed), vocabulary(Vocabulary::get()), types(vocabulary.types) {
  program.seed = seed;
  program.prefix = "p" + std::to_string(seed) + "_";
  program.tree = makeList();
  program.raises = raises(seed);
  program.inRange = isInRange(seed);
  program.traces = hasTraces(seed);
  program.colorComponents = colorComponents(seed);
}

Program Generator::run() {
  large = chance(5);
  lit = usesPathTracer(program.seed) || program.seed % 4 == 2;
  workLimit = 150;
  for (unsigned n = some(below(3)); n-- > 0;)
    makeStruct();
  for (unsigned n = some(below(4)); n-- > 0;)
    makeConstant();
  for (unsigned n = some(1 + below(4)); n-- > 0;)
    makeFreeFunction();
  makeClasses();
  return std::move(program);
}

bool raises(std::uint32_t seed) {
  return seed / 50 % 3 == 1;
}
bool isInRange(std::uint32_t seed) {
  return raises(seed) ? seed % 4 == 0 : seed % 5 != 4;
}
bool hasTraces(std::uint32_t seed) {
  return usesPathTracer(seed) ? true
         : raises(seed)       ? seed % 5 != 3 || generates(seed)
                              : seed % 5 < 3 || seed % 10 == 4;
}
bool generates(std::uint32_t seed) {
  return raises(seed) && seed % 4 > 1 && !usesPathTracer(seed);
}
bool usesPathTracer(std::uint32_t seed) {
  return seed % 7 == 5;
}
bool hasImages(std::uint32_t seed) {
  return seed % 3 == 1;
}
unsigned colorComponents(std::uint32_t seed) {
  static const unsigned counts[] = {3, 1, 4, 16};
  return counts[seed / 50 % 4];
}

Program generate(std::uint32_t seed) {
  return Generator(seed).run();
}

//===----------------------------------------------------------------------===//
// What programs share
//===----------------------------------------------------------------------===//

namespace {
struct Shared {
  std::string name, text;
};
} // namespace

/// Users stand before what they use.
static std::vector<Shared> sharedFunctions() {
  std::vector<Shared> all;
  auto hash = [&](const std::string &type, const std::string &body) {
    all.push_back(
        {"hash_" + type, "uint hash_" + type + "(uint h, " + type + " v) { " + body + " }"});
  };
  hash("color", "h = hash_float(h, luminance(v)); h = hash_float(h, luminance(v * color(1.0, 0.0, "
                "0.0))); return hash_float(h, luminance(v * color(0.0, 1.0, 0.0)));");
  for (unsigned columns = 2; columns <= 4; ++columns)
    for (unsigned rows = 2; rows <= 4; ++rows) {
      std::string type = "mat" + std::to_string(columns);
      if (rows != columns)
        type += "x" + std::to_string(rows);
      std::string body;
      for (unsigned i = 0; i != columns; ++i)
        body += "h = hash_vec" + std::to_string(rows) + "(h, v[" + std::to_string(i) + "]); ";
      hash(type, body + "return h;");
    }
  const std::pair<const char *, const char *> scalars[] = {
      {"vec", "float"}, {"ivec", "int"}, {"uvec", "uint"}, {"bvec", "bool"}};
  for (auto [vector, scalar] : scalars)
    for (unsigned count = 2; count <= 4; ++count) {
      std::string body;
      for (unsigned i = 0; i != count; ++i)
        body += std::string("h = hash_") + scalar + "(h, v." + "xyzw"[i] + "); ";
      hash(vector + std::to_string(count), body + "return h;");
    }
  hash("float", "return hash_uint(h, floatBitsToUint(v));");
  hash("int", "return hash_uint(h, uint(v));");
  hash("bool", "return hash_uint(h, v ? 1u : 2u);");
  hash("uint", "return ((h ^ v) * 16777619u) ^ (h >> 15u);");
  all.push_back({"toColor",
                 "color toColor(uint h) { return color(toUnit(h), toUnit(h * 2654435761u), "
                 "toUnit((h ^ (h >> 7u)) * 16777619u)); }"});
  all.push_back({"toVector", "vec3 toVector(uint h) { return vec3(toUnit(h) - 0.5, toUnit(h * "
                             "2654435761u) - 0.5, toUnit((h ^ (h >> 9u)) * 16777619u) - 0.5); }"});
  all.push_back({"toUnit", "float toUnit(uint h) { return float(h >> 8u) * 5.9604645e-8; }"});
  return all;
}

/// A file of the library, without what it imports.
static std::string libraryFile(const char *name) {
  std::ifstream file(std::string(RTSL_SOURCE_FOLDER "/library/std/") + name + ".rtsl");
  std::string text, line;
  while (std::getline(file, line))
    if (line.rfind("import ", 0) != 0)
      text += line + "\n";
  return text;
}

std::string prelude(const std::string &text) {
  static const std::vector<Shared> all = sharedFunctions();
  std::string chosen;
  for (const Shared &shared : all)
    if (text.find(shared.name + "(") != std::string::npos ||
        chosen.find(shared.name + "(") != std::string::npos)
      chosen += shared.text + "\n";
  if (text.find("sampler2D ") != std::string::npos)
    chosen += libraryFile("images/ImageTexels") + libraryFile("images/sampler2D");
  if (text.find(" : PathTracer ") != std::string::npos)
    for (const char *name : {"sampling", "phase", "media/Medium", "engines/PathTracer"})
      chosen += libraryFile(name);
  return chosen;
}

} // namespace rtsl::random
