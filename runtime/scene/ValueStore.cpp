#include "runtime/scene/ValueStore.h"

#include "language/ColorBasis.h"
#include "runtime/scene/References.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace rtsl::runtime {

namespace {

const char *describe(const Value &value) {
  switch (value.kind) {
  case Value::Kind::Number:
    return "a number";
  case Value::Kind::Boolean:
    return "a truth value";
  case Value::Kind::Reference:
    return "a reference to an object";
  case Value::Kind::List:
    return "a list";
  case Value::Kind::Block:
    return "a block of memory";
  case Value::Kind::Refused:
    break;
  }
  return "something else";
}

class Store {
public:
  Store(const StoreContext &context, const std::string &what, const std::optional<Place> &fallback)
      : context(context), what(what), fallback(fallback) {}

  void whole(const ValueType &type, const Value &value, std::uint8_t *to) {
    if (type.bufferRank > 0)
      buffer(type, value, to);
    else
      array(type, 0, value, to, type.size);
  }

private:
  [[noreturn]] void fail(const Value &value, const Message &why) const {
    throw Error(why, value.place ? value.place : fallback);
  }
  [[noreturn]] void wrongType(const ValueType &type, const Value &value) const {
    fail(value, message::typeMismatch(what, type.name, describe(value)));
  }

  /// Dimension `level` of a fixed-length array that takes `size` bytes.
  void array(const ValueType &type, std::size_t level, const Value &value, std::uint8_t *to,
             std::uint32_t size) {
    if (level == type.arraySizes.size())
      return element(type, value, to, size);
    std::uint32_t count = type.arraySizes[level];
    if (value.kind != Value::Kind::List)
      wrongType(type, value);
    if (value.list.size() != count)
      fail(value, message::elementCount(what, count, value.list.size()));
    for (std::uint32_t i = 0; i < count; ++i)
      array(type, level + 1, value.list[i], to + std::size_t(i) * (size / count), size / count);
  }

  void element(const ValueType &type, const Value &value, std::uint8_t *to, std::uint32_t size) {
    switch (type.kind) {
    case ValueType::Kind::Float:
    case ValueType::Kind::Int:
    case ValueType::Kind::UInt:
    case ValueType::Kind::Bool:
      return numbers(type, value, to);
    case ValueType::Kind::Color:
      return color(type, value, to, size);
    case ValueType::Kind::Reference:
      return reference(type, value, to);
    case ValueType::Kind::Struct:
      return structure(type, value, to);
    }
  }

  void scalar(const ValueType &type, const Value &value, std::uint8_t *to) {
    if (type.kind == ValueType::Kind::Bool) {
      if (value.kind != Value::Kind::Boolean)
        wrongType(type, value);
      std::uint32_t bits = value.boolean;
      std::memcpy(to, &bits, 4);
      return;
    }
    if (value.kind != Value::Kind::Number)
      wrongType(type, value);
    if (type.kind == ValueType::Kind::Float) {
      float number = float(value.number);
      if (std::isinf(number) && !std::isinf(value.number))
        fail(value, message::floatTooLarge(what, value.number));
      std::memcpy(to, &number, 4);
      return;
    }
    if (value.number != std::floor(value.number))
      fail(value, message::notWhole(what, value.number));
    bool isSigned = type.kind == ValueType::Kind::Int;
    double lowest = isSigned ? -2147483648.0 : 0.0,
           highest = isSigned ? 2147483647.0 : 4294967295.0;
    if (!(value.number >= lowest && value.number <= highest))
      fail(value, message::integerOutOfRange(what, value.number, lowest, highest));
    std::uint32_t bits =
        isSigned ? std::uint32_t(std::int32_t(value.number)) : std::uint32_t(value.number);
    std::memcpy(to, &bits, 4);
  }

  /// A scalar, a vector, or a matrix by its columns: nested or in a row.
  void numbers(const ValueType &type, const Value &value, std::uint8_t *to) {
    std::uint32_t rows = type.rows, columns = type.columns;
    if (rows * columns == 1)
      return scalar(type, value, to);
    if (value.kind != Value::Kind::List)
      wrongType(type, value);
    if (columns > 1 && value.list.size() == columns && value.list[0].kind == Value::Kind::List) {
      for (std::uint32_t i = 0; i < columns; ++i)
        row(type, value.list[i], to + 4 * std::size_t(i) * rows, rows);
      return;
    }
    row(type, value, to, rows * columns);
  }

  void row(const ValueType &type, const Value &value, std::uint8_t *to, std::uint32_t count) {
    if (value.kind != Value::Kind::List)
      wrongType(type, value);
    if (value.list.size() != count)
      fail(value, message::componentCount(what, type.name, count, value.list.size()));
    for (std::uint32_t i = 0; i < count; ++i)
      scalar(type, value.list[i], to + 4 * std::size_t(i));
  }

  /// One number for all components, red, green and blue, or as many numbers as a color has here.
  void color(const ValueType &type, const Value &value, std::uint8_t *to, std::uint32_t size) {
    std::uint32_t count = context.colorComponents;
    ValueType number;
    number.name = type.name;
    std::vector<float> numbers;
    auto read = [&](const Value &one) {
      numbers.push_back(0);
      scalar(number, one, reinterpret_cast<std::uint8_t *>(&numbers.back()));
    };
    if (value.kind == Value::Kind::List)
      for (const Value &one : value.list)
        read(one);
    else if (value.kind == Value::Kind::Number)
      read(value);
    else
      wrongType(type, value);
    std::vector<float> components = colorFromNumbers(numbers, count);
    if (components.empty())
      fail(value, message::colorComponentCount(what, numbersOfColor(count), numbers.size()));
    std::memset(to, 0, size);
    std::memcpy(to, components.data(), 4 * components.size());
  }

  void reference(const ValueType &type, const Value &value, std::uint8_t *to) {
    if (value.kind != Value::Kind::Reference)
      wrongType(type, value);
    if (value.object != 0)
      if (const std::string *actual = context.classMismatch(value.object, type.className))
        fail(value, message::classMismatch(what, type.className, *actual));
    std::memcpy(to, &value.object, 4);
  }

  /// The fields in the order of the declaration.
  void structure(const ValueType &type, const Value &value, std::uint8_t *to) {
    if (type.fields.empty())
      fail(value, message::typeNotSettable(what, type.name));
    if (value.kind != Value::Kind::List || value.list.size() != type.fields.size())
      fail(value, message::structNeedsList(what, type.name, type.fields.size()));
    for (std::size_t i = 0; i < type.fields.size(); ++i) {
      std::string inner = fmt::format("`{}` in {}", type.fields[i].name, what);
      Store(context, inner, value.list[i].place ? value.list[i].place : fallback)
          .whole(type.fields[i].type, value.list[i], to + type.fields[i].offset);
    }
  }

  /// Lists nested once a dimension, all of one length in each.
  void buffer(const ValueType &type, const Value &value, std::uint8_t *to) {
    ValueType one = type;
    one.bufferRank = 0;
    std::uint32_t stride = type.elementSize;
    if (stride == 0) {
      stride = type.kind == ValueType::Kind::Color ? 4 * context.colorComponents
                                                   : 4u * type.rows * type.columns;
      for (std::uint32_t count : type.arraySizes)
        stride *= count;
    }
    one.size = stride;

    if (value.kind == Value::Kind::Block)
      return block(type, value, stride, to);
    RtslBuffer header{};
    std::vector<const Value *> elements{&value};
    for (std::uint32_t level = 0; level < type.bufferRank; ++level) {
      std::vector<const Value *> next;
      std::size_t length = 0;
      for (std::size_t i = 0; i < elements.size(); ++i) {
        if (elements[i]->kind != Value::Kind::List)
          wrongType(type, *elements[i]);
        if (i == 0)
          length = elements[i]->list.size();
        else if (elements[i]->list.size() != length)
          fail(*elements[i], message::rowsDiffer(what, length, elements[i]->list.size()));
        for (const Value &inner : elements[i]->list)
          next.push_back(&inner);
      }
      if (length > 0xffffffffu)
        fail(value, message::tooManyElements(what));
      header.size[level] = std::uint32_t(length);
      elements = std::move(next);
    }
    std::uint8_t *memory = context.allocate(std::size_t(stride) * elements.size());
    for (std::size_t i = 0; i < elements.size(); ++i)
      array(one, 0, *elements[i], memory + i * stride, stride);
    writeHeader(header, memory, to);
  }

  /// A buffer whose elements lie in memory already.
  void block(const ValueType &type, const Value &value, std::uint32_t stride, std::uint8_t *to) {
    const std::size_t bytes = 4 * value.words->size();
    std::vector<std::uint32_t> sizes = value.sizes;
    if (sizes.empty() && bytes / stride <= 0xffffffffu)
      sizes.push_back(std::uint32_t(bytes / stride));
    double count = 1;
    for (const std::uint32_t size : sizes)
      count *= size;
    if (holdsReferences(type) || sizes.size() != type.bufferRank || count * stride != double(bytes))
      wrongType(type, value);
    if (!context.keep(value.words, type.isOutput))
      fail(value, message::sharedOutputElements(what));
    RtslBuffer header{};
    std::copy(sizes.begin(), sizes.end(), header.size);
    writeHeader(header, value.words->data(), to);
  }

  static void writeHeader(RtslBuffer &header, const void *elements, std::uint8_t *to) {
    const auto address = reinterpret_cast<std::uint64_t>(elements);
    header.addressLow = std::uint32_t(address);
    header.addressHigh = std::uint32_t(address >> 32);
    std::memcpy(to, &header, sizeof header);
  }

  const StoreContext &context;
  const std::string &what;
  const std::optional<Place> &fallback;
};

} // namespace

std::vector<float> colorFromNumbers(const std::vector<float> &numbers, std::uint32_t components) {
  if (numbers.size() == 1)
    return std::vector<float>(components, numbers[0]);
  if (numbers.size() == components)
    return numbers;
  if (numbers.size() != 3)
    return {};
  std::vector<float> color(components);
  const ColorBasis basis = makeColorBasis(components);
  for (std::uint32_t i = 0; i < components; ++i)
    color[i] =
        float(basis.toColor[i][0] * double(numbers[0]) + basis.toColor[i][1] * double(numbers[1]) +
              basis.toColor[i][2] * double(numbers[2]));
  return color;
}

std::string numbersOfColor(std::uint32_t components) {
  if (components == 1)
    return "one number, or 3 for red, green and blue";
  if (components == 3)
    return "3 numbers or one for all";
  return fmt::format("{} numbers, 3 for red, green and blue, or one for all", components);
}

void storeValue(const ValueType &type, const Value &value, std::uint8_t *to,
                const StoreContext &context, const std::string &what,
                const std::optional<Place> &fallback) {
  Store(context, what, fallback).whole(type, value, to);
}

Value blockOf(const ValueType &type, const Value &value, std::uint32_t colorComponents,
              const std::string &what, const std::optional<Place> &fallback) {
  std::shared_ptr<Value::Words> words;
  StoreContext context;
  context.colorComponents = colorComponents;
  context.allocate = [&](std::size_t bytes) {
    words = std::make_shared<Value::Words>(bytes / 4);
    return reinterpret_cast<std::uint8_t *>(words->data());
  };
  context.keep = [&](const std::shared_ptr<Value::Words> &block, bool) {
    words = block;
    return true;
  };
  context.classMismatch = [](RtslRef, const std::string &) { return nullptr; };
  RtslBuffer header{};
  storeValue(type, value, reinterpret_cast<std::uint8_t *>(&header), context, what, fallback);
  return Value::block(std::move(words), {header.size, header.size + type.bufferRank});
}

} // namespace rtsl::runtime
