//===- StateStores.cpp - what a state writes -------------------------------===//
#include "codegen/cpp/StateWriter.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

bool writesTo(mlir::Operation *op, mlir::Value address) {
  if (auto store = llvm::dyn_cast<ir::StoreOp>(op))
    return store.getAddress() == address;
  if (auto clear = llvm::dyn_cast<ir::ClearOp>(op))
    return clear.getAddress() == address;
  if (auto copy = llvm::dyn_cast<ir::CopyOp>(op))
    return copy.getTarget() == address;
  if (auto spawn = llvm::dyn_cast<ir::SpawnPayloadOp>(op))
    return spawn.getPayload() == address;
  if (auto call = llvm::dyn_cast<ir::EnterOp>(op))
    return llvm::is_contained(call.getOperands(), address);
  if (auto evaluation = llvm::dyn_cast<ir::EvaluateOp>(op))
    for (auto [index, operand] : llvm::enumerate(evaluation.getOperands()))
      if (operand == address && changes(evaluation, index))
        return true;
  return llvm::isa<ir::FieldOp, ir::ElementOp>(op) &&
         llvm::any_of(op->getUsers(), [&](mlir::Operation *user) { return writesTo(user, op->getResult(0)); });
}

/// Variables that stay whole are read and written where they lie, by the author's expression.
void StateWriter::evaluate(ir::EvaluateOp op, Statements &out) {
  const SourceTable::Entry &entry = source.entries[op.getSource()];
  usesScratch |= module.effects.expression(*entry.expr).usesScratch;
  bool isCompound;
  const bool isWrite = op.getNumResults() == 0 && entry.kind == SourceTable::Kind::Value &&
                       (entry.expr->kind == ExprKind::Assign || entry.expr->kind == ExprKind::IncDec);
  printer.isNested = op->hasAttr("rtsl.nested");
  if (printer.isNested) // its first part may change what waits for its last
    flush(touchesOf(op), out);
  std::vector<std::string> before;
  printer.before = &before;
  Code code;
  if (isWrite) {
    printer.replaced.clear();
    for (auto [leaf, operand] : llvm::zip(entry.leaves, op.getOperands()))
      printer.replaced[leaf] = llvm::isa<ir::PtrType>(operand.getType()) ? place(operand) : use(operand, module.type(leaf->type));
    nameConstants(*entry.expr);
    code = {printer.expressionStatement(*entry.expr)};
    while (!code.text.empty() && (code.text.back() == '\n' || code.text.back() == ';'))
      code.text.pop_back();
  } else {
    code = expression(entry, op.getOperands(), isCompound);
  }
  printer.before = nullptr;
  printer.isNested = false;
  Touches touches = touchesOf(op);
  if (entry.kind == SourceTable::Kind::Into) {
    auto variable = op.getOperand(0).getDefiningOp<ir::VarOp>();
    const std::string target = place(op.getOperand(0)).text;
    flush(touches, out);
    // Nothing has looked at what it held before.
    auto isItsClear = [&](const Statement &statement) { return statement.text == target + " = {};"; };
    if (!out.empty() && isItsClear(out.back()) && !mentions(code.text, target))
      out.pop_back();
    std::set<mlir::Operation *> used = mentioned;
    for (std::string &statement : before) {
      emit(out, std::move(statement));
      out.back().isDeclaration = true; // mostly
    }
    mentioned = std::move(used);
    for (mlir::Value operand : op.getOperands())
      for (mlir::Value at = operand; at;) {
        mlir::Operation *defining = at.getDefiningOp();
        if (llvm::isa_and_nonnull<ir::VarOp>(defining))
          mentioned.insert(defining);
        at = llvm::isa_and_nonnull<ir::FieldOp, ir::ElementOp>(defining) ? defining->getOperand(0) : mlir::Value();
      }
    emit(out, target + " = " + code.text + ";");
    if (variable && !mentions(code.text, target)) {
      out.back().assigns = variable;
      out.back().value = code.text;
    }
    return;
  }
  flush(touches, out);
  const std::set<mlir::Operation *> mentionedHere = mentioned;
  for (std::string &statement : before) {
    mentioned = mentionedHere;
    emit(out, std::move(statement));
    out.back().isDeclaration = true; // mostly
  }
  mentioned = mentionedHere;
  touches.add(consumed);
  if (op.getNumResults() == 0) {
    if (!code.text.empty())
      emit(out, code.text + ";");
    return;
  }
  define(*op, code, touches, /*isPure=*/op->hasAttr("rtsl.plain") && !op->hasAttr("rtsl.changes"), out);
}

void StateWriter::clear(ir::ClearOp op, Statements &out) {
  auto variable = op.getAddress().getDefiningOp<ir::VarOp>();
  const std::string target = place(op.getAddress()).text;
  flush(touchesOf(op), out);
  const Type *type = declaredType(op.getAddress());
  const std::string zero = type ? module.zero(type) : "{}";
  emit(out, target + " = " + zero + ";");
  if (variable) {
    out.back().assigns = variable;
    out.back().value = zero;
  }
}

/// `target += y` for `target + y`, where `value` is the whole expression of the source that made it.
std::string StateWriter::assignment(const std::string &target, const std::string &value, mlir::Value made) {
  auto whole = made.getDefiningOp<ir::ExpressionOp>();
  if (whole && source.entries[whole.getSource()].kind == SourceTable::Kind::Compound) {
    const auto &assign = static_cast<const typed::AssignExpr &>(*source.entries[whole.getSource()].expr);
    const char *sign = printer.plainOperator(assign.op, *assign.target, *assign.value);
    const std::string begin = sign ? target + " " + sign + " " : std::string();
    if (sign && value.compare(0, begin.size(), begin) == 0)
      return target + " " + sign + "= " + value.substr(begin.size()) + ";";
  }
  return target + " = " + value + ";";
}

void StateWriter::store(ir::StoreOp op, Statements &out) {
  auto variable = op.getAddress().getDefiningOp<ir::VarOp>();
  const Type *declared = variable ? nullptr : declaredType(op.getAddress());
  const std::string type = variable ? varType(variable) : declared ? module.type(declared) : typeOf(op.getValue());
  const std::string target = place(op.getAddress()).text;
  // A component of what lies there.
  auto insertion = insertions.find(op.getValue());
  const bool isPart = insertion != insertions.end() && pending.count(op.getValue()) && insertion->second.vector == target &&
                      insertion->second.parts.size() == 1;
  const std::string value = bind(use(op.getValue(), type), Binding::Assignment);
  flush(touchesOf(op), out);
  if (value == target)
    return;
  if (value == target + " + 1" &&
      op.getValue().getDefiningOp<mlir::arith::AddIOp>()) // the next light
    return emit(out, "++" + target + ";");
  if (isPart) {
    const Insertion::Part &part = insertion->second.parts.front();
    mlir::Value scalar = op.getValue().getDefiningOp<mlir::vector::InsertOp>().getValueToStore();
    return emit(out, assignment(Insertion::place(target, part), part.value, scalar));
  }
  // What it held before nobody has looked at.
  if (!out.empty() && !mentions(value, target))
    for (const char *zero : {"{}", "0.0f", "0", "0u", "false", "glm::vec2(0.0f)", "glm::vec3(0.0f)", "glm::vec4(0.0f)", "Color(0.0f)"})
      if (out.back().comment.empty() && out.back().text == target + " = " + zero + ";") {
        out.pop_back();
        break;
      }
  emit(out, assignment(target, value, op.getValue()));
  if (variable) {
    out.back().assigns = variable;
    out.back().value = value;
  }
  auto load = op.getValue().getDefiningOp<ir::LoadOp>();
  auto from = load ? load.getAddress().getDefiningOp<ir::FieldOp>() : ir::FieldOp();
  joinFields(op.getAddress(), from, target, value, out);
}

/// Field by field is how passes copy and clear a struct: `a.x = b.x; a.y = b.y;` is `a = b;`.
void StateWriter::joinFields(mlir::Value address, ir::FieldOp from, const std::string &target, const std::string &value, Statements &out) {
  auto field = address.getDefiningOp<ir::FieldOp>();
  const Type *type = field ? declaredType(field.getBase()) : nullptr;
  if (!type || !type->is(TypeKind::Struct))
    return;
  const std::vector<typed::Field> &fields = type->structure->fields;
  const std::string whole = place(field.getBase()).text;
  mentioned.clear();
  const std::string part = target.substr(whole.size()); // ".x"
  const bool isCopy = from && declaredType(from.getBase()) == type && value.size() > part.size() && value.compare(value.size() - part.size(), part.size(), part) == 0;
  const bool isZero = value == "0.0f" || value == "0" || value == "false" || value == module.type(declaredType(address)) + "(0.0f)";
  if (!isCopy && !isZero)
    return;
  Statement &last = out.back();
  last.whole = whole;
  last.from = isZero ? "{}" : value.substr(0, value.size() - part.size());
  if (out.size() < fields.size())
    return;
  std::set<mlir::Operation *> all;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Statement &one = out[out.size() - fields.size() + i];
    const std::string begin = whole + "." + module.names.of(&fields[i]) + " = ";
    if (one.whole != whole || one.from != last.from || one.text.compare(0, begin.size(), begin) != 0)
      return;
    all.insert(one.mentions.begin(), one.mentions.end());
  }
  Statement joined;
  joined.comment = out[out.size() - fields.size()].comment;
  joined.text = whole + " = " + last.from + ";";
  joined.mentions = std::move(all);
  if (auto variable = field.getBase().getDefiningOp<ir::VarOp>()) {
    joined.assigns = variable;
    joined.value = last.from;
  }
  out.resize(out.size() - fields.size());
  if (!out.empty() && out.back().text == whole + " = {};")
    out.pop_back();
  out.push_back(std::move(joined));
}

} // namespace rtsl::cpp
