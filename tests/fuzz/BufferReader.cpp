//===- BufferReader.cpp - any bytes through the readers of buffers --------===//
//
// As .npy, .csv and .ply, and without a format; for buffers of numbers, vectors, colors and structs
// with up to three dimensions.
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include "runtime/buffers/BufferFiles.h"

#include <string>
#include <string_view>
#include <vector>

using namespace rtsl;
using fuzz::attempt;
using fuzz::require;
using runtime::MemberInfo;
using runtime::Value;
using runtime::ValueType;

namespace {

constexpr std::uint32_t colorComponents = 4;

/// A buffer of such numbers, or vectors.
ValueType bufferOf(ValueType::Kind kind, std::uint8_t rows, std::uint8_t rank) {
  ValueType type;
  type.kind = kind;
  type.rows = rows;
  type.bufferRank = rank;
  type.name = "type";
  type.elementSize = 4 * (kind == ValueType::Kind::Color ? colorComponents : rows);
  return type;
}

/// struct { vec3 at; bool is[2]; }
ValueType bufferOfStructs() {
  MemberInfo at, is;
  at.name = "at";
  at.type.rows = 3;
  at.type.size = 12;
  is.name = "is";
  is.type.kind = ValueType::Kind::Bool;
  is.type.arraySizes = {2};
  is.type.size = 8;
  is.offset = 12;
  ValueType type = bufferOf(ValueType::Kind::Struct, 1, 1);
  type.fields = {at, is};
  type.elementSize = 20;
  return type;
}

std::vector<ValueType> types() {
  using Kind = ValueType::Kind;
  return {bufferOf(Kind::Float, 1, 1),
          bufferOf(Kind::Float, 3, 1),
          bufferOf(Kind::Int, 1, 2),
          bufferOf(Kind::UInt, 2, 1),
          bufferOf(Kind::Bool, 1, 3),
          bufferOf(Kind::Color, 1, 1),
          bufferOfStructs()};
}

void check(const Value &value, const ValueType &type) {
  require(value.sizes.size() == type.bufferRank, "a buffer has its dimensions");
  std::size_t bytes = type.elementSize;
  for (const std::uint32_t size : value.sizes)
    bytes *= size;
  require(4 * value.words->size() == bytes, "a buffer has its elements");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char *>(data), size);
  for (const char *name : {"buffer.npy", "buffer.csv", "buffer.ply", "buffer.bin"}) {
    const fuzz::File file(bytes, name);
    runtime::BufferDescription buffer;
    buffer.file = file.path;
    for (const ValueType &type : types())
      attempt([&] { check(readBuffer(buffer, type, colorComponents, "a buffer"), type); });
    attempt([&] { lengthOf(buffer); });
    buffer.columns = {"x", "y", "z"};
    const ValueType vectors = bufferOf(ValueType::Kind::Float, 3, 1);
    attempt([&] { check(readBuffer(buffer, vectors, colorComponents, "a buffer"), vectors); });
  }
  return 0;
}
