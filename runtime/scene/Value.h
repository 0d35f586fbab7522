//===- Value.h - what a scene gives to a member or a parameter ------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/scene/Words.h"
#include "support/Error.h"

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::runtime {

/// A number, a truth value, a reference to an object, or a list of values: a vector, a color, a
/// matrix (its columns one after the other, flat or nested), an array, a buffer (nested once a
/// dimension). A buffer of numbers may also be a block of memory in its own layout.
class Value {
public:
  enum class Kind : std::uint8_t { Number, Boolean, Reference, List, Block, Refused };
  using Words = runtime::Words;

  Value(double number) : kind(Kind::Number), number(number) {}
  Value(float number) : Value(double(number)) {}
  Value(int number) : Value(double(number)) {}
  Value(unsigned number) : Value(double(number)) {}
  Value(bool boolean) : kind(Kind::Boolean), boolean(boolean) {}
  Value(std::initializer_list<Value> list) : kind(Kind::List), list(list) {}
  explicit Value(std::vector<Value> list) : kind(Kind::List), list(std::move(list)) {}
  static Value reference(RtslRef object) {
    Value value(0.0);
    value.kind = Kind::Reference;
    value.object = object;
    return value;
  }

  /// In place of a value with an error that is known: the object's other values are still checked.
  static Value refused() {
    Value value(0.0);
    value.kind = Kind::Refused;
    return value;
  }

  /// Elements as they lie in memory, which the scene shares, and writes if the member is an output
  /// buffer. `sizes` of each dimension; empty: one dimension.
  static Value block(std::shared_ptr<Words> words, std::vector<std::uint32_t> sizes = {}) {
    Value value(0.0);
    value.sizes = std::move(sizes);
    value.kind = Kind::Block;
    value.words = std::move(words);
    return value;
  }

  Value &at(Place where) {
    place = std::move(where);
    return *this;
  }

  Kind kind;
  double number = 0;
  bool boolean = false;
  RtslRef object = 0;
  std::vector<Value> list;
  std::shared_ptr<Words> words;     // of a block
  std::vector<std::uint32_t> sizes; // of a block
  std::optional<Place> place;       // for messages
  /// Of a number that has key frames: what it is in each of them, for checks.
  std::shared_ptr<const std::vector<Value>> keys;
};

/// A value with the name of the member or parameter that it is for.
struct NamedValue {
  std::string name;
  Value value;
  std::optional<Place> place = std::nullopt; // of the name
};

} // namespace rtsl::runtime
