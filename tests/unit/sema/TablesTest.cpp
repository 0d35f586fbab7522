//===- TablesTest.cpp - types, conversions, overloads ---------------------===//
#include "sema/check/Suggest.h"
#include "sema/fold/ConstantFold.h"
#include "sema/model/Builtins.h"
#include "sema/model/ClassModel.h"
#include "sema/model/Conversion.h"
#include "sema/typed/TypeProperties.h"

#include <gtest/gtest.h>

#include <limits>

using namespace rtsl;

namespace {

TEST(Types, AreUniqueAndPrintAsTheyAreWritten) {
  TypeContext types;
  for (const char *name : {"bool", "int", "uint", "float", "vec2", "ivec3", "uvec4", "bvec2",
                           "mat2", "mat3", "mat4", "mat2x3", "mat4x2", "color", "void"}) {
    ASSERT_NE(types.named(name), nullptr) << name;
    EXPECT_EQ(types.named(name), types.named(name));
    EXPECT_EQ(toString(types.named(name)), name);
  }
  EXPECT_EQ(types.named("mat3x3"), types.named("mat3"));
  for (const char *name :
       {"vec1", "vec5", "vec", "mat", "mat5", "mat2x", "mat2x5", "mat22", "dvec2", "colour", ""})
    EXPECT_EQ(types.named(name), nullptr) << name;
  EXPECT_EQ(toString(types.array(types.array(types.floatType, 3), 2)), "float[2][3]");
  EXPECT_EQ(toString(types.buffer(types.named("vec3"), 2)), "vec3[][]");
  EXPECT_EQ(toString(types.reference("rt_Texture")), "rt_Texture");
}

TEST(Types, HaveColumnsThenRows) {
  TypeContext types;
  const Type *matrix = types.named("mat2x3");
  EXPECT_EQ(matrix->columns(), 2u);
  EXPECT_EQ(matrix->rows(), 3u);
  EXPECT_EQ(matrix->element, types.named("vec3"));
  EXPECT_EQ(matrix->componentCount(), 6u);
  EXPECT_EQ(matrix->scalar(), types.floatType);
}

TEST(Types, SizesSaturate) {
  TypeContext types;
  const Type *huge = types.floatType;
  for (int i = 0; i != 4; ++i)
    huge = types.array(huge, 0x7fffffff);
  EXPECT_EQ(sizeInBytes(huge), 1ull << 62);
  EXPECT_EQ(sizeInBytes(types.array(types.named("vec3"), 5)), 60u);
}

TEST(Conversions, GoFromIntOverUintToFloat) {
  TypeContext types;
  const std::vector<const char *> scalars = {"bool", "int", "uint", "float"};
  const std::vector<const char *> vectors = {"bvec3", "ivec3", "uvec3", "vec3"};
  for (const auto &names : {scalars, vectors})
    for (std::size_t from = 0; from != 4; ++from)
      for (std::size_t to = 0; to != 4; ++to) {
        const Conversion expected = from == to               ? Conversion::Exact
                                    : from != 0 && from < to ? Conversion::Implicit
                                                             : Conversion::None;
        EXPECT_EQ(implicitConversion(types.named(names[from]), types.named(names[to])), expected)
            << names[from] << " to " << names[to];
      }
  EXPECT_EQ(implicitConversion(types.named("ivec2"), types.named("vec3")), Conversion::None);
  EXPECT_EQ(implicitConversion(types.floatType, types.color), Conversion::None);
  EXPECT_EQ(implicitConversion(types.color, types.floatType), Conversion::None);
}

TEST(Conversions, OfNumbersTruncateSaturateAndTakeNoNaN) {
  auto toInt = [](float x) {
    return convertScalar(makeFloat(x), TypeKind::Float, TypeKind::Int).i;
  };
  auto toUInt = [](float x) {
    return convertScalar(makeFloat(x), TypeKind::Float, TypeKind::UInt).u;
  };
  EXPECT_EQ(toInt(2.9f), 2);
  EXPECT_EQ(toInt(-2.9f), -2);
  EXPECT_EQ(toInt(1e20f), std::numeric_limits<int>::max());
  EXPECT_EQ(toInt(-1e20f), std::numeric_limits<int>::min());
  EXPECT_EQ(toInt(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(toUInt(-1.0f), 0u);
  EXPECT_EQ(toUInt(4294967040.0f), 4294967040u);
  EXPECT_EQ(toUInt(5e9f), 0xffffffffu);
  EXPECT_EQ(toUInt(std::numeric_limits<float>::quiet_NaN()), 0u);
}

TEST(Overloads, FollowTheRanksOfGlsl) {
  TypeContext types;
  auto signature = [&](std::initializer_list<const Type *> parameters) {
    Signature result;
    result.result = types.voidType;
    for (const Type *type : parameters)
      result.parameters.push_back({type, ast::Direction::In});
    return result;
  };
  const Type *i = types.intType, *u = types.uintType, *f = types.floatType;
  const std::vector<Signature> candidates = {signature({f, f}), signature({u, u}),
                                             signature({i, f})};
  EXPECT_EQ(resolveOverload(candidates, {f, f}).chosen, 0);
  EXPECT_EQ(resolveOverload(candidates, {i, u}).chosen,
            -1); // (uint, uint) and (int, float) have one exact each
  EXPECT_EQ(resolveOverload(candidates, {i, u}).ties.size(), 2u);
  EXPECT_EQ(resolveOverload(candidates, {i, f}).chosen, 2);
  EXPECT_EQ(resolveOverload(candidates, {types.boolType, f}).ties.size(), 0u);
  EXPECT_EQ(resolveOverload(candidates, {f}).ties.size(), 0u);
}

TEST(Builtins, ExpandToEveryShapeOnce) {
  TypeContext types;
  BuiltinTable table(types);
  EXPECT_EQ(table.find("sin")->signatures.size(), 4u);
  EXPECT_EQ(table.find("outerProduct")->signatures.size(), 9u);
  EXPECT_EQ(table.find("inverse")->signatures.size(), 3u);
  EXPECT_EQ(table.find("nothing"), nullptr);
  for (const std::string &name : builtinNames()) {
    const BuiltinOverloads *overloads = table.find(name);
    ASSERT_NE(overloads, nullptr) << name;
    for (std::size_t a = 0; a != overloads->signatures.size(); ++a) {
      std::vector<const Type *> arguments;
      for (const Signature::Parameter &parameter : overloads->signatures[a].parameters)
        arguments.push_back(parameter.type);
      // Called with exactly its types, each overload is the one that is meant.
      EXPECT_EQ(resolveOverload(overloads->signatures, arguments).chosen, static_cast<int>(a))
          << describe(name, overloads->signatures[a]);
    }
  }
}

TEST(Builtins, AllHaveASignature) {
#define RTSL_BUILTIN(id, name, ...)                                                                \
  EXPECT_NE(std::find(builtinNames().begin(), builtinNames().end(), name), builtinNames().end())   \
      << name;
#include "language/Builtins.def"
}

TEST(ClassModel, EveryStateVariableBelongsToAClass) {
  for (std::size_t i = 0; i != stateVariableNames().size(); ++i)
    EXPECT_NE(classesThatSee(static_cast<typed::StateVariable>(i)), "") << stateVariableNames()[i];
}

TEST(ClassModel, MethodsSeeWhatTheyWrite) {
  for (const RootModel &root : rootModels())
    for (const MethodModel &method : root.methods)
      for (std::size_t i = 0; i != stateVariableNames().size(); ++i) {
        const auto variable = static_cast<typed::StateVariable>(i);
        EXPECT_TRUE(!method.writes.has(variable) ||
                    (method.reads.has(variable) && root.sees.has(variable)))
            << root.name << "::" << method.name << " " << stateVariableNames()[i];
        EXPECT_TRUE(!method.reads.has(variable) || root.sees.has(variable));
      }
}

TEST(ClassModel, StateIsWrittenByTheMethodsOfTheTable) {
  using S = typed::StateVariable;
  EXPECT_EQ(methodsThatWrite(S::LightColor), "`illumination` of an rt_Light");
  EXPECT_EQ(methodsThatWrite(S::LightDirection),
            "`shade`, `sampleBSDF` and `closestHit` of an rt_Material and `illumination` of an "
            "rt_Light");
  EXPECT_EQ(methodsThatWrite(S::RayOrigin), "`generateRay` of an rt_Camera");
  EXPECT_EQ(methodsThatWrite(S::Depth), "");
  EXPECT_EQ(methodsWith(Ability::Trace), "`shade` and `closestHit` of an rt_Material, `generate` "
                                         "of an rt_RayGeneration and `miss` of an rt_Miss");
}

} // namespace
