//===- ValueStore.h - values of a scene as bytes of a record --------------===//
#pragma once

#include "runtime/program/Program.h"
#include "runtime/scene/Value.h"

#include <functional>
#include <string>

namespace rtsl::runtime {

/// What storing a value needs from the scene.
struct StoreContext {
  std::uint32_t colorComponents;
  /// Memory of the scene's own that stays where it is.
  std::function<std::uint8_t *(std::size_t bytes)> allocate;
  /// Keeps a block as long as the scene. `isOutput`: the member that it is for is an output buffer.
  /// False if it shares the block with another member, and one of them is an output buffer.
  std::function<bool(std::shared_ptr<Value::Words>, bool isOutput)> keep;
  /// Null if the object may stand where `className` is expected; otherwise the name of the class
  /// that it has.
  std::function<const std::string *(RtslRef object, const std::string &className)> classMismatch;
};

/// The components of a color from as many numbers, from red, green and blue
/// (language/ColorBasis.h), or from one number for all. Empty if there is another number of
/// numbers.
std::vector<float> colorFromNumbers(const std::vector<float> &numbers, std::uint32_t components);
/// The numbers that it takes, for messages: "3 numbers or one for all".
std::string numbersOfColor(std::uint32_t components);

/// Writes `value` as a `type` to `to`. `what` names the member or parameter in messages ("member
/// `radius` of `ball`"). Throws WrongType, OutOfRange, WrongClass; the error's place is the value's
/// or `fallback`.
void storeValue(const ValueType &type, const Value &value, std::uint8_t *to,
                const StoreContext &context, const std::string &what,
                const std::optional<Place> &fallback);

/// The elements of a buffer that holds no references, of a list or a block, as a block of the sizes
/// of all dimensions. Throws what storeValue() throws.
Value blockOf(const ValueType &type, const Value &value, std::uint32_t colorComponents,
              const std::string &what, const std::optional<Place> &fallback);

} // namespace rtsl::runtime
