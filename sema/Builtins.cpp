//===- Builtins.cpp - the signatures of the built-in functions ------------===//
#include "sema/Builtins.h"

#include <algorithm>

namespace rtsl {

using typed::Builtin;

//===----------------------------------------------------------------------===//
// The table
//
// One row an operation and shape: "result parameter parameter ...". A letter is a type:
//
//   F I U B   float, int, uint, bool or the vectors of them: the same number of components, 1 to 4,
//   all over the row v w x y   the vectors alone, 2 to 4 components f i u b   the scalars 2 3 4
//   vec2 vec3 vec4           c  color           n  void M T       a matrix of C columns and R rows,
//   and its transpose; p a vector of R, q a vector of C components S         a square matrix
//
// `>` before a letter makes an out parameter.
//===----------------------------------------------------------------------===//

namespace {
struct Row {
  Builtin builtin;
  const char *signature;
};
} // namespace

static const Row rows[] = {
    {Builtin::Radians, "F F"},
    {Builtin::Degrees, "F F"},
    {Builtin::Sin, "F F"},
    {Builtin::Cos, "F F"},
    {Builtin::Tan, "F F"},
    {Builtin::SinPi, "F F"},
    {Builtin::CosPi, "F F"},
    {Builtin::Asin, "F F"},
    {Builtin::Acos, "F F"},
    {Builtin::Atan, "F F"},
    {Builtin::Atan2, "F F F"},
    {Builtin::Sinh, "F F"},
    {Builtin::Cosh, "F F"},
    {Builtin::Tanh, "F F"},
    {Builtin::Asinh, "F F"},
    {Builtin::Acosh, "F F"},
    {Builtin::Atanh, "F F"},

    {Builtin::Pow, "F F F"},
    {Builtin::Pow, "c c f"},
    {Builtin::Pow, "c c c"},
    {Builtin::PowInt, "F F i"},
    {Builtin::Exp, "F F"},
    {Builtin::Exp, "c c"},
    {Builtin::Log, "F F"},
    {Builtin::Log, "c c"},
    {Builtin::Exp2, "F F"},
    {Builtin::Log2, "F F"},
    {Builtin::Expm1, "F F"},
    {Builtin::Log1p, "F F"},
    {Builtin::Sqrt, "F F"},
    {Builtin::Sqrt, "c c"},
    {Builtin::InverseSqrt, "F F"},

    {Builtin::Abs, "F F"},
    {Builtin::Abs, "I I"},
    {Builtin::Abs, "c c"},
    {Builtin::Sign, "F F"},
    {Builtin::Sign, "I I"},
    {Builtin::Floor, "F F"},
    {Builtin::Trunc, "F F"},
    {Builtin::Round, "F F"},
    {Builtin::RoundEven, "F F"},
    {Builtin::Ceil, "F F"},
    {Builtin::Fract, "F F"},
    {Builtin::Mod, "F F F"},
    {Builtin::Mod, "F F f"},
    {Builtin::Modf, "F F >F"},
    {Builtin::Min, "F F F"},
    {Builtin::Min, "F F f"},
    {Builtin::Min, "I I I"},
    {Builtin::Min, "I I i"},
    {Builtin::Min, "U U U"},
    {Builtin::Min, "U U u"},
    {Builtin::Min, "c c c"},
    {Builtin::Min, "c c f"},
    {Builtin::MinComponent, "f v"},
    {Builtin::MinComponent, "i w"},
    {Builtin::MinComponent, "u x"},
    {Builtin::MinComponent, "f c"},
    {Builtin::Max, "F F F"},
    {Builtin::Max, "F F f"},
    {Builtin::Max, "I I I"},
    {Builtin::Max, "I I i"},
    {Builtin::Max, "U U U"},
    {Builtin::Max, "U U u"},
    {Builtin::Max, "c c c"},
    {Builtin::Max, "c c f"},
    {Builtin::MaxComponent, "f v"},
    {Builtin::MaxComponent, "i w"},
    {Builtin::MaxComponent, "u x"},
    {Builtin::MaxComponent, "f c"},
    {Builtin::Clamp, "F F F F"},
    {Builtin::Clamp, "F F f f"},
    {Builtin::Clamp, "I I I I"},
    {Builtin::Clamp, "I I i i"},
    {Builtin::Clamp, "U U U U"},
    {Builtin::Clamp, "U U u u"},
    {Builtin::Clamp, "c c c c"},
    {Builtin::Clamp, "c c f f"},
    {Builtin::Mix, "F F F F"},
    {Builtin::Mix, "F F F f"},
    {Builtin::Mix, "c c c f"},
    {Builtin::Mix, "c c c c"},
    {Builtin::MixSelect, "F F F B"},
    {Builtin::MixSelect, "I I I B"},
    {Builtin::MixSelect, "U U U B"},
    {Builtin::MixSelect, "B B B B"},
    {Builtin::Step, "F F F"},
    {Builtin::Step, "F f F"},
    {Builtin::SmoothStep, "F F F F"},
    {Builtin::SmoothStep, "F f f F"},
    {Builtin::IsNan, "B F"},
    {Builtin::IsInf, "B F"},
    {Builtin::FloatBitsToInt, "I F"},
    {Builtin::FloatBitsToUint, "U F"},
    {Builtin::IntBitsToFloat, "F I"},
    {Builtin::UintBitsToFloat, "F U"},
    {Builtin::Fma, "F F F F"},
    {Builtin::Frexp, "F F >I"},
    {Builtin::Ldexp, "F F I"},

    {Builtin::PackUnorm2x16, "u 2"},
    {Builtin::PackSnorm2x16, "u 2"},
    {Builtin::PackUnorm4x8, "u 4"},
    {Builtin::PackSnorm4x8, "u 4"},
    {Builtin::PackHalf2x16, "u 2"},
    {Builtin::UnpackUnorm2x16, "2 u"},
    {Builtin::UnpackSnorm2x16, "2 u"},
    {Builtin::UnpackUnorm4x8, "4 u"},
    {Builtin::UnpackSnorm4x8, "4 u"},
    {Builtin::UnpackHalf2x16, "2 u"},

    {Builtin::Length, "f F"},
    {Builtin::Distance, "f F F"},
    {Builtin::Dot, "f F F"},
    {Builtin::Cross, "3 3 3"},
    {Builtin::Normalize, "F F"},
    {Builtin::FaceForward, "F F F F"},
    {Builtin::Reflect, "F F F"},
    {Builtin::Refract, "F F F f"},

    {Builtin::MatrixCompMult, "M M M"},
    {Builtin::OuterProduct, "M p q"},
    {Builtin::Transpose, "T M"},
    {Builtin::Determinant, "f S"},
    {Builtin::Inverse, "S S"},

    {Builtin::LessThan, "y v v"},
    {Builtin::LessThan, "y w w"},
    {Builtin::LessThan, "y x x"},
    {Builtin::LessThanEqual, "y v v"},
    {Builtin::LessThanEqual, "y w w"},
    {Builtin::LessThanEqual, "y x x"},
    {Builtin::GreaterThan, "y v v"},
    {Builtin::GreaterThan, "y w w"},
    {Builtin::GreaterThan, "y x x"},
    {Builtin::GreaterThanEqual, "y v v"},
    {Builtin::GreaterThanEqual, "y w w"},
    {Builtin::GreaterThanEqual, "y x x"},
    {Builtin::Equal, "y v v"},
    {Builtin::Equal, "y w w"},
    {Builtin::Equal, "y x x"},
    {Builtin::Equal, "y y y"},
    {Builtin::NotEqual, "y v v"},
    {Builtin::NotEqual, "y w w"},
    {Builtin::NotEqual, "y x x"},
    {Builtin::NotEqual, "y y y"},
    {Builtin::Any, "b y"},
    {Builtin::All, "b y"},
    {Builtin::Not, "y y"},

    {Builtin::UaddCarry, "U U U >U"},
    {Builtin::UsubBorrow, "U U U >U"},
    {Builtin::UmulExtended, "n U U >U >U"},
    {Builtin::ImulExtended, "n I I >I >I"},
    {Builtin::BitfieldExtract, "I I i i"},
    {Builtin::BitfieldExtract, "U U i i"},
    {Builtin::BitfieldInsert, "I I I i i"},
    {Builtin::BitfieldInsert, "U U U i i"},
    {Builtin::BitfieldReverse, "I I"},
    {Builtin::BitfieldReverse, "U U"},
    {Builtin::BitCount, "I I"},
    {Builtin::BitCount, "I U"},
    {Builtin::FindLSB, "I I"},
    {Builtin::FindLSB, "I U"},
    {Builtin::FindMSB, "I I"},
    {Builtin::FindMSB, "I U"},

    {Builtin::DominantAxis, "i v"},
    {Builtin::PerpendicularTo, "3 3"},
    {Builtin::Inside, "b F F F"},
    {Builtin::Inside, "b F f f"},
    {Builtin::Inside, "b I I I"},
    {Builtin::Inside, "b I i i"},
    {Builtin::Inside, "b U U U"},
    {Builtin::Inside, "b U u u"},
    {Builtin::Rand, "f"},
    {Builtin::RandOpen, "f"},
    {Builtin::Luminance, "f c"},
    {Builtin::Trace,
     "c 3 3"}, // the form with a payload is checked by hand: its type is the author's
    {Builtin::Hit, "b f"},
    {Builtin::Hit, "b f f"},
    {Builtin::Ambient, "c"},
    {Builtin::LightCount, "i"},
    {Builtin::Illuminate, "b i 3"},
    {Builtin::Illuminate, "b i 3 b"},
    {Builtin::IgnoreIntersection, "n"},
    {Builtin::TerminateRay, "n"},
    {Builtin::VisitChild, "n i"},
    {Builtin::Print, "n"}, // takes anything, checked by hand
};

//===----------------------------------------------------------------------===//
// Expansion
//===----------------------------------------------------------------------===//

/// Components (of generic letters), columns and rows for which a row is written out.
struct Shape {
  std::uint32_t components = 1, columns = 2, rows = 2;
};

static const Type *typeOfLetter(char letter, Shape shape, TypeContext &types) {
  auto sized = [&](const Type *scalar) {
    return shape.components == 1 ? scalar : types.vector(scalar, shape.components);
  };
  switch (letter) {
  case 'F':
  case 'v':
    return sized(types.floatType);
  case 'I':
  case 'w':
    return sized(types.intType);
  case 'U':
  case 'x':
    return sized(types.uintType);
  case 'B':
  case 'y':
    return sized(types.boolType);
  case 'f':
    return types.floatType;
  case 'i':
    return types.intType;
  case 'u':
    return types.uintType;
  case 'b':
    return types.boolType;
  case '2':
  case '3':
  case '4':
    return types.vector(types.floatType, static_cast<std::uint32_t>(letter - '0'));
  case 'c':
    return types.color;
  case 'M':
    return types.matrix(shape.columns, shape.rows);
  case 'T':
    return types.matrix(shape.rows, shape.columns);
  case 'S':
    return types.matrix(shape.columns, shape.columns);
  case 'p':
    return types.vector(types.floatType, shape.rows);
  case 'q':
    return types.vector(types.floatType, shape.columns);
  default:
    return types.voidType;
  }
}

static Signature expand(const std::string &row, Shape shape, TypeContext &types) {
  Signature signature;
  ast::Direction direction = ast::Direction::In;
  for (char letter : row) {
    if (letter == ' ')
      continue;
    if (letter == '>') {
      direction = ast::Direction::Out;
      continue;
    }
    const Type *type = typeOfLetter(letter, shape, types);
    if (!signature.result)
      signature.result = type;
    else
      signature.parameters.push_back({type, direction});
    direction = ast::Direction::In;
  }
  return signature;
}

/// The shapes for which the letters of a row stand.
static std::vector<Shape> shapesOf(const std::string &row) {
  auto hasOneOf = [&](const char *letters) {
    return row.find_first_of(letters) != std::string::npos;
  };
  std::vector<Shape> shapes;
  if (hasOneOf("MTpq")) {
    for (std::uint32_t columns = 2; columns <= 4; ++columns)
      for (std::uint32_t rowCount = 2; rowCount <= 4; ++rowCount)
        shapes.push_back({1, columns, rowCount});
  } else if (hasOneOf("S")) {
    for (std::uint32_t columns = 2; columns <= 4; ++columns)
      shapes.push_back({1, columns, columns});
  } else {
    const std::uint32_t first = hasOneOf("vwxy") ? 2 : 1;
    const std::uint32_t last = hasOneOf("vwxyFIUB") ? 4 : 1;
    for (std::uint32_t components = first; components <= last; ++components)
      shapes.push_back({components, 2, 2});
  }
  return shapes;
}

static bool sameParameters(const Signature &a, const Signature &b) {
  return std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(),
                    b.parameters.end(),
                    [](const Signature::Parameter &x, const Signature::Parameter &y) {
                      return x.type == y.type;
                    });
}

const BuiltinOverloads *BuiltinTable::find(const std::string &name) {
  if (auto found = expanded.find(name); found != expanded.end())
    return found->second.signatures.empty() ? nullptr : &found->second;
  BuiltinOverloads overloads;
  for (const Row &row : rows) {
    if (name != typed::name(row.builtin))
      continue;
    for (Shape shape : shapesOf(row.signature)) {
      Signature signature = expand(row.signature, shape, types);
      // `min(F, f)` is `min(F, F)` again when F is float.
      const bool known =
          std::any_of(overloads.signatures.begin(), overloads.signatures.end(),
                      [&](const Signature &other) { return sameParameters(signature, other); });
      if (known)
        continue;
      overloads.signatures.push_back(std::move(signature));
      overloads.builtins.push_back(row.builtin);
    }
  }
  const BuiltinOverloads &entry = expanded.emplace(name, std::move(overloads)).first->second;
  return entry.signatures.empty() ? nullptr : &entry;
}

const std::vector<std::string> &builtinNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Row &row : rows)
      if (std::find(all.begin(), all.end(), typed::name(row.builtin)) == all.end())
        all.emplace_back(typed::name(row.builtin));
    return all;
  }();
  return names;
}

std::vector<std::string> colorFunctionNames() {
  std::vector<std::string> names;
  for (const Row &row : rows)
    if (const std::string name = typed::name(row.builtin);
        std::string(row.signature).find(" c") != std::string::npos &&
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return names;
}

} // namespace rtsl
