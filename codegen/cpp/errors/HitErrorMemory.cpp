#include "codegen/cpp/errors/HitErrorWriter.h"

#include "codegen/ir/Layout.h"

#include "llvm/ADT/TypeSwitch.h"

#include <fmt/format.h>

namespace rtsl::cpp {

using mlir::Value;

/// Bytes from one element to the next.
static std::uint32_t stride(Value element) {
  return ir::sizeInBytes(llvm::cast<ir::PtrType>(element.getType()).getPointee());
}

std::optional<HitErrorWriter::Word> HitErrorWriter::inTable(Value address) {
  if (auto table = address.getDefiningOp<ir::TableOp>())
    return Word{nameOf(table), integer(0)};
  auto element = address.getDefiningOp<ir::ElementOp>();
  std::optional<Word> found = element ? inTable(element.getBase()) : std::nullopt;
  if (found)
    found->index =
        binary(Operator::Add, found->index,
               binary(Operator::Multiply, whole(element.getIndex()), integer(stride(address) / 4)));
  return found;
}

const typed::Member *HitErrorWriter::memberOf(ir::MemberOp op) {
  for (const typed::Class *at = &definition; at; at = at->base)
    for (const auto &member : at->members)
      if (member->name == op.getMember())
        return member.get();
  return nullptr;
}

const typed::Field *HitErrorWriter::fieldOf(ir::FieldOp op) {
  for (const typed::Field &field : declaredType(op.getBase())->structure->fields)
    if (field.name == op.getField())
      return &field;
  return nullptr;
}

const Type *HitErrorWriter::declaredType(Value address) {
  if (auto member = address.getDefiningOp<ir::MemberOp>())
    return memberOf(member)->type;
  if (auto element = address.getDefiningOp<ir::ElementOp>()) {
    const Type *base = declaredType(element.getBase());
    return base && base->is(TypeKind::Array) ? base->element : nullptr;
  }
  if (auto element = address.getDefiningOp<ir::BufferElementOp>())
    return declaredType(element.getBuffer())->element;
  if (auto field = address.getDefiningOp<ir::FieldOp>())
    if (const typed::Field *found = fieldOf(field))
      return found->type;
  return nullptr;
}

Code HitErrorWriter::lvalue(Value address) {
  if (auto state = address.getDefiningOp<ir::StateOp>())
    return state.getName() == "hitError"
               ? memberOfPointer(cpp::call("rtsl::rawState", {name("rt")}), "hitError")
               : member(name("rt"), state.getName().str());
  if (auto variable = address.getDefiningOp<ir::VarOp>())
    return name(nameOf(variable));
  if (auto member = address.getDefiningOp<ir::MemberOp>())
    return cpp::member(name("self"), names.of(memberOf(member)));
  if (auto element = address.getDefiningOp<ir::ElementOp>())
    return subscript(lvalue(element.getBase()), whole(element.getIndex()));
  if (auto element = address.getDefiningOp<ir::BufferElementOp>()) {
    std::vector<Code> indices;
    for (Value index : element.getIndices())
      indices.push_back(whole(index));
    return callMember(lvalue(element.getBuffer()), "at", std::move(indices));
  }
  auto field = address.getDefiningOp<ir::FieldOp>();
  return member(lvalue(field.getBase()), names.of(fieldOf(field)));
}

void HitErrorWriter::load(ir::LoadOp op, Statements &out) {
  const mlir::Type type = op.getType(), scalar = scalarOf(type);
  const std::optional<Word> word = inTable(op.getAddress());
  if (!word) {
    const Code from = lvalue(op.getAddress());
    return define(op, scalar.isF32() ? from : construct(typeText(type), {from}), out);
  }
  defineEach(*op, out, [&](unsigned i) -> Code {
    const Code bits = subscript(name(word->table), binary(Operator::Add, word->index, integer(i)));
    if (scalar.isF32())
      return cpp::call("rtsl::bitsAs<float>", {bits});
    return scalar.isInteger(1) ? binary(Operator::NotEqual, bits, integer(0)) : bits;
  });
}

/// `static constexpr int name[] = {...};`, a table's words.
static Statement tableOf(const std::string &name, llvm::ArrayRef<std::int32_t> bits) {
  std::vector<Code> words;
  for (std::int32_t word : bits)
    words.push_back(
        staticCast("int", literal(fmt::format("{}u", static_cast<std::uint32_t>(word)))));
  Statement made = declaration("static constexpr", "int", name, list("", std::move(words)));
  made.declarators.front().isCArray = true;
  return made;
}

bool HitErrorWriter::writeMemory(mlir::Operation &op, Statements &out) {
  return llvm::TypeSwitch<mlir::Operation *, bool>(&op)
      .Case<ir::StateOp, ir::MemberOp, ir::FieldOp, ir::ElementOp, ir::BufferElementOp>(
          [](auto) { return true; }) // printed where they are used
      .Case([&](ir::TableOp table) {
        out.push_back(tableOf(nameOf(table), table.getWords()));
        return true;
      })
      .Case([&](ir::VarOp variable) {
        const mlir::Type type = llvm::cast<ir::PtrType>(variable.getType()).getPointee();
        out.push_back(declaration(typeText(type), nameOf(variable), list("", {})));
        return true;
      })
      .Case([&](ir::LoadOp from) {
        load(from, out);
        return true;
      })
      .Case([&](ir::StoreOp into) {
        const Code target = lvalue(into.getAddress());
        out.push_back(statement(assign(target, whole(into.getValue()))));
        return true;
      })
      .Case([&](ir::ClearOp cleared) {
        out.push_back(statement(assign(lvalue(cleared.getAddress()), list("", {}))));
        return true;
      })
      .Case([&](ir::BufferLengthOp length) {
        define(length,
               callMember(lvalue(length.getBuffer()), "length",
                          {integer(static_cast<std::int64_t>(length.getDim()))}),
               out);
        return true;
      })
      .Default([](mlir::Operation *) { return false; });
}

} // namespace rtsl::cpp
