//===- Type.h - the types of RTSL -----------------------------------------===//
//
// Types are unique: equal types have the same address, so comparing pointers is sufficient. A
// `TypeContext` owns them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace rtsl {

namespace typed {
struct Struct;
struct Class;
} // namespace typed

/// What shaders may do with the elements of a buffer.
enum class BufferMode : std::uint8_t { Read, Write, ReadWrite };

enum class TypeKind : std::uint8_t {
  Error, // of an expression with a reported error: converts to everything, silently
  Void,
  Bool,
  Int,
  UInt,
  Float,
  Vector, // of Bool, Int, UInt or Float; 2 to 4
  Matrix, // of Float; 2 to 4 columns of 2 to 4 rows
  Color,  // opaque: the number of components depends on the target
  Struct,
  Class,  // a reference to an object, possibly of a class derived from this one
  Array,  // of fixed length
  Buffer, // unsized array member: rank 1 to 3
  String, // only an argument of print
};

class Type {
public:
  const TypeKind kind;
  const Type *element = nullptr; // Vector, Array, Buffer: the element; Matrix: the column vector
  BufferMode mode = BufferMode::Read; // Buffer
  std::uint32_t count = 0; // Vector: components; Matrix: columns; Array: length; Buffer: rank
  const typed::Struct *structure = nullptr; // Struct
  const typed::Class *classType = nullptr;  // Class
  std::string builtinClass;                 // Class: "rt_Texture" when an rt_ base itself is named

  bool is(TypeKind k) const { return kind == k; }
  bool isScalar() const { return kind >= TypeKind::Bool && kind <= TypeKind::Float; }
  bool isNumericScalar() const { return kind >= TypeKind::Int && kind <= TypeKind::Float; }
  bool isVector() const { return kind == TypeKind::Vector; }
  bool isMatrix() const { return kind == TypeKind::Matrix; }
  bool isError() const { return kind == TypeKind::Error; }
  /// Scalar: itself; Vector: its element; Matrix: Float; otherwise null.
  const Type *scalar() const;
  /// Scalar 1, Vector n, Matrix columns * rows; otherwise 0.
  std::uint32_t componentCount() const;
  std::uint32_t columns() const { return count; }
  std::uint32_t rows() const { return element->count; }

private:
  friend class TypeContext;
  explicit Type(TypeKind kind) : kind(kind) {}
};

/// Owns the types of a compilation.
class TypeContext {
public:
  TypeContext();
  ~TypeContext();

  const Type *error, *voidType, *boolType, *intType, *uintType, *floatType, *color, *string;

  const Type *vector(const Type *scalar, std::uint32_t count);
  const Type *matrix(std::uint32_t columns, std::uint32_t rows);
  const Type *array(const Type *element, std::uint32_t length);
  const Type *buffer(const Type *element, std::uint32_t rank, BufferMode mode = BufferMode::Read);
  const Type *structure(const typed::Struct *definition);
  const Type *reference(const typed::Class *definition);
  const Type *reference(const std::string &builtinClass); // "rt_Texture"
  /// A type by its keyword: "float", "vec3", "mat2x3", "color", ...; null if there is none.
  const Type *named(const std::string &keyword);

private:
  const Type *make(TypeKind kind, const Type *element = nullptr, std::uint32_t count = 0,
                   BufferMode mode = BufferMode::Read);
  std::map<std::tuple<TypeKind, const void *, std::uint32_t, std::string>, std::unique_ptr<Type>>
      types;
};

/// As an author would write it: `vec3`, `float[2][3]`, `Sphere`.
std::string toString(const Type *type);

} // namespace rtsl
