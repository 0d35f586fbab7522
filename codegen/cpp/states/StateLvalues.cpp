#include "codegen/cpp/states/StateLvalues.h"

#include "codegen/cpp/states/statements/StatePrinter.h"

namespace rtsl::cpp {

Code StateLvalues::of(mlir::Value address) {
  if (auto state = address.getDefiningOp<ir::StateOp>())
    return member(name("rt"), state.getName().str());
  if (auto variable = address.getDefiningOp<ir::VarOp>()) {
    const auto light = lightNumbers.find(variable);
    return light != lightNumbers.end() ? light->second : name(state.names.of(variable));
  }
  if (auto object = address.getDefiningOp<ir::FrameObjectOp>())
    for (const FrameField &field : state.machine.frame)
      if (field.isObject && field.key == object.getName())
        return frameField(field.name);
  if (auto argument = address.getDefiningOp<ir::CallArgumentOp>())
    return name(state.machine.addressName(context, state.machine.argumentNumber(argument)));
  if (address.getDefiningOp<ir::PayloadOp>())
    return name(context.names.of(state.machine.method->parameters.front().get()));
  if (auto field = address.getDefiningOp<ir::FieldOp>())
    if (const Type *base = state.types.ofMemory(field.getBase());
        base && base->is(TypeKind::Struct))
      for (const typed::Field &part : base->structure->fields)
        if (part.name == field.getField())
          return member(of(field.getBase()), context.names.of(&part));
  if (auto element = address.getDefiningOp<ir::ElementOp>())
    return subscript(of(element.getBase()), indices[element]);
  state.unsupported(*address.getDefiningOp());
  return integer(0);
}

Code StateLvalues::frameField(const std::string &field) const {
  return member(name(state.machine.frameName), field);
}

void StateLvalues::setIndex(ir::ElementOp element, Code index) {
  indices[element] = std::move(index);
}

bool StateLvalues::indicesMention(const std::string &name) const {
  return llvm::any_of(indices, [&](const auto &index) { return mentions(index.second, name); });
}

void StateLvalues::countLights(mlir::Operation *variable, Code number) {
  lightNumbers[variable] = std::move(number);
}

} // namespace rtsl::cpp
