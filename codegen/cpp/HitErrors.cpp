#include "codegen/cpp/HitErrors.h"

#include "codegen/cpp/Printer.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/errors/DeriveHitErrors.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/Matchers.h"
#include "llvm/ADT/TypeSwitch.h"

#include <fmt/format.h>

#include <cmath>

namespace rtsl::cpp {

namespace arith = mlir::arith;
namespace math = mlir::math;
namespace vector = mlir::vector;
using mlir::Value;

static unsigned widthOf(mlir::Type type) {
  auto shape = llvm::dyn_cast<mlir::VectorType>(type);
  return shape ? static_cast<unsigned>(shape.getNumElements()) : 0;
}

/// The type of a value; empty: it has none here.
static std::string typeText(mlir::Type type) {
  const unsigned width = widthOf(type);
  mlir::Type scalar = width ? llvm::cast<mlir::VectorType>(type).getElementType() : type;
  if (width > 4)
    return {};
  if (scalar.isF32())
    return width ? fmt::format("glm::vec{}", width) : "float";
  if (scalar.isF64())
    return width ? fmt::format("glm::dvec{}", width) : "double";
  if (scalar.isInteger(1))
    return width ? fmt::format("glm::bvec{}", width) : "bool";
  if (scalar.isInteger(32))
    return width ? fmt::format("glm::ivec{}", width) : "int";
  return !width && scalar.isIndex() ? "unsigned" : "";
}

namespace {

class HitErrorWriter {
public:
  HitErrorWriter(ModulePrinter &module, const typed::Class &definition)
      : module(module), definition(definition) {}

  std::string body(mlir::func::FuncOp function) {
    write(function.getBody());
    return text;
  }

private:
  void line(const std::string &code) { text += code + "\n"; }

  const std::string &nameOf(Value value) {
    std::string &name = known[value];
    if (name.empty()) {
      name = names.of(value);
      std::replace(name.begin(), name.end(), '.', '_');
      if (isReserved(name) || name == "rt" || name == "self")
        name += "_";
      name = unique(name, taken);
    }
    return name;
  }

  static std::string number(mlir::Attribute attribute) {
    if (auto real = llvm::dyn_cast<mlir::FloatAttr>(attribute); real && real.getType().isF64())
      return print(doubleLiteral(real.getValue().convertToDouble()));
    else if (real)
      return print(floatLiteral(real.getValue().convertToFloat()));
    const llvm::APInt value = llvm::cast<mlir::IntegerAttr>(attribute).getValue();
    if (value.getBitWidth() == 1)
      return value.isZero() ? "false" : "true";
    return value.isMinSignedValue() ? "std::numeric_limits<int>::min()"
                                    : std::to_string(value.getSExtValue());
  }

  /// One component of a vector, or the scalar.
  std::string part(Value value, unsigned index) {
    mlir::Attribute attribute;
    if (!mlir::matchPattern(value, mlir::m_Constant(&attribute)))
      return widthOf(value.getType()) ? fmt::format("{}.{}", nameOf(value), "xyzw"[index])
                                      : nameOf(value);
    if (auto dense = llvm::dyn_cast<mlir::DenseElementsAttr>(attribute))
      return number(dense.getValues<mlir::Attribute>()[index]);
    return number(attribute);
  }

  std::string whole(Value value) {
    mlir::Attribute attribute;
    const unsigned width = widthOf(value.getType());
    if (!mlir::matchPattern(value, mlir::m_Constant(&attribute)))
      return nameOf(value);
    if (!width)
      return part(value, 0);
    std::vector<std::string> parts;
    for (unsigned i = 0; i < width; ++i)
      parts.push_back(part(value, i));
    return typeText(value.getType()) + "(" + join(parts, ", ") + ")";
  }

  void define(Value result, const std::string &value) {
    line("const " + typeText(result.getType()) + " " + nameOf(result) + " = " + value + ";");
  }

  /// A value made component by component.
  template <typename Component>
  void each(mlir::Operation &op, Component component) {
    const Value result = op.getResult(0);
    const unsigned width = widthOf(result.getType());
    if (!width)
      return define(result, component(0));
    std::vector<std::string> parts;
    for (unsigned i = 0; i < width; ++i)
      parts.push_back(component(i));
    define(result, typeText(result.getType()) + "(" + join(parts, ", ") + ")");
  }
  void infix(mlir::Operation &op, const char *sign) {
    define(op.getResult(0), whole(op.getOperand(0)) + " " + sign + " " + whole(op.getOperand(1)));
  }
  void wrapping(mlir::Operation &op, const char *sign) {
    each(op, [&](unsigned i) {
      return fmt::format("static_cast<int>(static_cast<unsigned>({}) {} static_cast<unsigned>({}))",
                         part(op.getOperand(0), i), sign, part(op.getOperand(1), i));
    });
  }
  void call(mlir::Operation &op, const std::string &function) {
    each(op, [&](unsigned i) {
      std::vector<std::string> arguments;
      for (Value operand : op.getOperands())
        arguments.push_back(part(operand, i));
      return function + "(" + join(arguments, ", ") + ")";
    });
  }

  static std::string compare(arith::CmpFPredicate predicate, const std::string &a,
                             const std::string &b) {
    using P = arith::CmpFPredicate;
    switch (predicate) {
    case P::OEQ:
      return a + " == " + b;
    case P::OGT:
      return a + " > " + b;
    case P::OGE:
      return a + " >= " + b;
    case P::OLT:
      return a + " < " + b;
    case P::OLE:
      return a + " <= " + b;
    case P::UNE:
      return a + " != " + b;
    case P::ONE:
      return fmt::format("({0} < {1} || {0} > {1})", a, b);
    case P::UEQ:
      return fmt::format("!({0} < {1} || {0} > {1})", a, b);
    case P::UGT:
      return fmt::format("!({} <= {})", a, b);
    case P::UGE:
      return fmt::format("!({} < {})", a, b);
    case P::ULT:
      return fmt::format("!({} >= {})", a, b);
    case P::ULE:
      return fmt::format("!({} > {})", a, b);
    case P::ORD:
      return fmt::format("({0} == {0} && {1} == {1})", a, b);
    case P::UNO:
      return fmt::format("({0} != {0} || {1} != {1})", a, b);
    case P::AlwaysFalse:
      return "false";
    case P::AlwaysTrue:
      return "true";
    }
    return "false";
  }
  static std::string compare(arith::CmpIPredicate predicate, const std::string &a,
                             const std::string &b) {
    using P = arith::CmpIPredicate;
    const auto sign = [&] {
      switch (predicate) {
      case P::eq:
        return "==";
      case P::ne:
        return "!=";
      case P::slt:
      case P::ult:
        return "<";
      case P::sle:
      case P::ule:
        return "<=";
      case P::sgt:
      case P::ugt:
        return ">";
      case P::sge:
      case P::uge:
        return ">=";
      }
      return "==";
    }();
    if (predicate < P::ult)
      return a + " " + sign + " " + b;
    return fmt::format("static_cast<unsigned>({}) {} static_cast<unsigned>({})", a, sign, b);
  }

  //===--------------------------------------------------------------------===//
  // Memory
  //===--------------------------------------------------------------------===//

  static bool isWide(mlir::Operation &op) {
    mlir::Type type = op.getResult(0).getType();
    return (widthOf(type) ? llvm::cast<mlir::VectorType>(type).getElementType() : type).isF64();
  }

  /// Bytes from one element to the next.
  static std::uint32_t stride(Value element) {
    return ir::sizeInBytes(llvm::cast<ir::PtrType>(element.getType()).getPointee());
  }

  /// An element of a table: its name, and an index of its words.
  std::optional<std::pair<std::string, std::string>> inTable(Value address) {
    if (auto table = address.getDefiningOp<ir::TableOp>())
      return std::pair(nameOf(table), std::string("0"));
    auto element = address.getDefiningOp<ir::ElementOp>();
    auto found = element ? inTable(element.getBase()) : std::nullopt;
    if (found)
      found->second += fmt::format(" + {} * {}", whole(element.getIndex()), stride(address) / 4);
    return found;
  }

  const typed::Member *memberOf(ir::MemberOp op) {
    for (const typed::Class *at = &definition; at; at = at->base)
      for (const auto &member : at->members)
        if (member->name == op.getMember())
          return member.get();
    return nullptr;
  }
  const Type *declaredType(Value address) {
    if (auto member = address.getDefiningOp<ir::MemberOp>())
      return memberOf(member)->type;
    if (auto element = address.getDefiningOp<ir::ElementOp>()) {
      const Type *base = declaredType(element.getBase());
      return base && base->is(TypeKind::Array) ? base->element : nullptr;
    }
    if (auto element = address.getDefiningOp<ir::BufferElementOp>())
      return declaredType(element.getBuffer())->element;
    if (auto field = address.getDefiningOp<ir::FieldOp>())
      for (const typed::Field &part : declaredType(field.getBase())->structure->fields)
        if (part.name == field.getField())
          return part.type;
    return nullptr;
  }

  std::string place(Value address) {
    if (auto state = address.getDefiningOp<ir::StateOp>())
      return state.getName() == "hitError" ? "rtsl::rawState(rt)->hitError"
                                           : "rt." + state.getName().str();
    if (auto variable = address.getDefiningOp<ir::VarOp>())
      return nameOf(variable);
    if (auto member = address.getDefiningOp<ir::MemberOp>())
      return "self." + module.names.of(memberOf(member));
    if (auto element = address.getDefiningOp<ir::ElementOp>())
      return place(element.getBase()) + "[" + whole(element.getIndex()) + "]";
    if (auto element = address.getDefiningOp<ir::BufferElementOp>()) {
      std::vector<std::string> indices;
      for (Value index : element.getIndices())
        indices.push_back(whole(index));
      return place(element.getBuffer()) + ".at(" + join(indices, ", ") + ")";
    }
    auto field = address.getDefiningOp<ir::FieldOp>();
    for (const typed::Field &part : declaredType(field.getBase())->structure->fields)
      if (part.name == field.getField())
        return place(field.getBase()) + "." + module.names.of(&part);
    return {};
  }

  void load(ir::LoadOp op) {
    const auto table = inTable(op.getAddress());
    if (!table) {
      mlir::Type type = op.getType();
      const bool isFloat =
          type.isF32() ||
          (widthOf(type) && llvm::cast<mlir::VectorType>(type).getElementType().isF32());
      const std::string from = place(op.getAddress());
      return define(op, isFloat ? from : typeText(type) + "(" + from + ")");
    }
    mlir::Type type = op.getType();
    mlir::Type scalar = widthOf(type) ? llvm::cast<mlir::VectorType>(type).getElementType() : type;
    each(*op, [&](unsigned i) {
      const std::string word = fmt::format("{}[{} + {}]", table->first, table->second, i);
      return scalar.isF32()        ? "rtsl::bitsAs<float>(" + word + ")"
             : scalar.isInteger(1) ? word + " != 0"
                                   : word;
    });
  }

  //===--------------------------------------------------------------------===//
  // Operations
  //===--------------------------------------------------------------------===//

  void write(mlir::Region &region) {
    if (!region.empty())
      for (mlir::Operation &op : region.front())
        write(op);
  }

  void write(mlir::Operation &op) {
    if (op.hasTrait<mlir::OpTrait::ConstantLike>())
      return;
    llvm::TypeSwitch<mlir::Operation *>(&op)
        .Case<ir::StateOp, ir::MemberOp, ir::FieldOp, ir::ElementOp, ir::BufferElementOp,
              ir::YieldOp>([](auto) {})
        .Case([&](ir::TableOp table) {
          std::vector<std::string> words;
          for (std::int32_t word : table.getWords())
            words.push_back(fmt::format("static_cast<int>({}u)", static_cast<std::uint32_t>(word)));
          line("static constexpr int " + nameOf(table) + "[] = {" + join(words, ", ") + "};");
        })
        .Case([&](ir::VarOp variable) {
          line(typeText(llvm::cast<ir::PtrType>(variable.getType()).getPointee()) + " " +
               nameOf(variable) + "{};");
        })
        .Case([&](ir::LoadOp from) { load(from); })
        .Case([&](ir::StoreOp into) {
          line(place(into.getAddress()) + " = " + whole(into.getValue()) + ";");
        })
        .Case([&](ir::ClearOp cleared) { line(place(cleared.getAddress()) + " = {};"); })
        .Case([&](ir::BufferLengthOp length) {
          define(length, fmt::format("{}.length({})", place(length.getBuffer()), length.getDim()));
        })
        .Case([&](arith::AddFOp) { infix(op, "+"); })
        .Case([&](arith::SubFOp) { infix(op, "-"); })
        .Case([&](arith::MulFOp) { infix(op, "*"); })
        .Case([&](arith::DivFOp) { infix(op, "/"); })
        .Case([&](arith::NegFOp) {
          each(op, [&](unsigned i) { return "-(" + part(op.getOperand(0), i) + ")"; });
        })
        .Case([&](arith::AddIOp) { wrapping(op, "+"); })
        .Case([&](arith::SubIOp) { wrapping(op, "-"); })
        .Case([&](arith::MulIOp) { wrapping(op, "*"); })
        .Case<arith::AndIOp, arith::OrIOp, arith::XOrIOp>([&](auto) {
          mlir::Type type = op.getResult(0).getType();
          const bool isBool =
              type.isInteger(1) ||
              (widthOf(type) && llvm::cast<mlir::VectorType>(type).getElementType().isInteger(1));
          const char *sign = llvm::isa<arith::AndIOp>(op)  ? (isBool ? "&&" : "&")
                             : llvm::isa<arith::OrIOp>(op) ? (isBool ? "||" : "|")
                                                           : (isBool ? "!=" : "^");
          each(op, [&](unsigned i) {
            return part(op.getOperand(0), i) + " " + sign + " " + part(op.getOperand(1), i);
          });
        })
        .Case([&](arith::CmpFOp comparison) {
          each(op, [&](unsigned i) {
            return compare(comparison.getPredicate(), part(op.getOperand(0), i),
                           part(op.getOperand(1), i));
          });
        })
        .Case([&](arith::CmpIOp comparison) {
          each(op, [&](unsigned i) {
            return compare(comparison.getPredicate(), part(op.getOperand(0), i),
                           part(op.getOperand(1), i));
          });
        })
        .Case([&](arith::SelectOp choice) {
          each(op, [&](unsigned i) {
            return part(choice.getCondition(), i) + " ? " + part(choice.getTrueValue(), i) + " : " +
                   part(choice.getFalseValue(), i);
          });
        })
        .Case([&](arith::SIToFPOp) {
          call(op, isWide(op) ? "static_cast<double>" : "static_cast<float>");
        })
        .Case([&](arith::UIToFPOp) {
          each(op, [&](unsigned i) {
            return fmt::format("static_cast<{}>(static_cast<unsigned>({}))",
                               isWide(op) ? "double" : "float", part(op.getOperand(0), i));
          });
        })
        .Case([&](arith::BitcastOp cast) {
          mlir::Type type = cast.getType();
          const bool isFloat =
              (widthOf(type) ? llvm::cast<mlir::VectorType>(type).getElementType() : type).isF32();
          call(op, isFloat ? "rtsl::bitsAs<float>" : "rtsl::bitsAs<int>");
        })
        .Case<arith::IndexCastUIOp>([&](auto) { call(op, "static_cast<unsigned>"); })
        .Case<arith::ExtUIOp>([&](auto) { call(op, "static_cast<int>"); })
        .Case([&](arith::ExtFOp) { call(op, "static_cast<double>"); })
        .Case([&](arith::TruncFOp) { call(op, "static_cast<float>"); })
        .Case([&](math::SqrtOp) { call(op, isWide(op) ? "std::sqrt" : "rtsl::squareRoot"); })
        .Case([&](math::FmaOp) { call(op, isWide(op) ? "std::fma" : "rtsl::fma"); })
        .Case([&](math::AbsFOp) { call(op, isWide(op) ? "std::abs" : "rtsl::abs"); })
        .Case([&](math::FloorOp) { call(op, "rtsl::floor"); })
        .Case([&](math::CeilOp) { call(op, "rtsl::ceil"); })
        .Case([&](math::TruncOp) { call(op, "rtsl::trunc"); })
        .Case([&](math::RoundEvenOp) { call(op, "rtsl::roundEven"); })
        .Case([&](ir::ToSintOp) { call(op, "rtsl::toInt"); })
        .Case([&](ir::ToUintOp) {
          each(op, [&](unsigned i) {
            return "static_cast<int>(rtsl::toUint(" + part(op.getOperand(0), i) + "))";
          });
        })
        .Case([&](ir::ElementaryOp function) {
          const bool isAtan2 = function.getFunction() == ir::Elementary::Atan2;
          call(op, "rtsl::" +
                       (isAtan2 ? "atan" : ir::stringifyElementary(function.getFunction()).str()));
        })
        .Case([&](vector::ExtractOp chosen) {
          if (chosen.hasDynamicPosition())
            return define(chosen, fmt::format("{}[static_cast<int>({})]", whole(chosen.getSource()),
                                              whole(chosen.getDynamicPosition()[0])));
          define(chosen,
                 part(chosen.getSource(), static_cast<unsigned>(chosen.getStaticPosition()[0])));
        })
        .Case([&](vector::InsertOp insert) {
          const auto at = static_cast<unsigned>(insert.getStaticPosition()[0]);
          each(op, [&](unsigned i) {
            return i == at ? whole(insert.getValueToStore()) : part(insert.getDest(), i);
          });
        })
        .Case([&](vector::FromElementsOp made) {
          each(op, [&](unsigned i) { return whole(made.getElements()[i]); });
        })
        .Case([&](vector::BroadcastOp same) {
          each(op, [&](unsigned) { return whole(same.getSource()); });
        })
        .Case([&](vector::ShuffleOp chosen) {
          const auto width = static_cast<unsigned>(chosen.getV1VectorType().getNumElements());
          each(op, [&](unsigned i) {
            const auto from = static_cast<unsigned>(chosen.getMask()[i]);
            return from < width ? part(chosen.getV1(), from) : part(chosen.getV2(), from - width);
          });
        })
        .Case([&](ir::IfOp choice) {
          line("if (" + whole(choice.getCondition()) + ") {");
          write(choice.getThenRegion());
          if (!choice.getElseRegion().empty()) {
            line("} else {");
            write(choice.getElseRegion());
          }
          line("}");
        })
        .Case([&](ir::LoopOp loop) { write(loop); })
        .Case([&](ir::SwitchOp choice) { write(choice); })
        .Case([&](ir::ConditionOp condition) {
          line("if (!" + whole(condition.getCondition()) + ")\nbreak;");
        })
        .Case([&](ir::BreakOp) { line("break;"); })
        .Case([&](ir::ContinueOp) { line("continue;"); })
        .Case<ir::ReturnOp, mlir::func::ReturnOp>([&](auto) {
          if (!llvm::isa<mlir::func::FuncOp>(op.getParentOp()))
            line("return;");
        })
        .Default([&](mlir::Operation *) { module.failed = true; });
  }

  /// `continue` goes to the step, so that stands at the beginning of the next turn.
  void write(ir::LoopOp loop) {
    const bool hasStep =
        !loop.getStep().empty() && loop.getStep().front().getOperations().size() > 1;
    if (!hasStep && !loop.getPostTest()) {
      line("for (;;) {");
    } else {
      const std::string first = unique("isFirst", taken);
      line("for (bool " + first + " = true;; " + first + " = false) {");
      line("if (!" + first + ") {");
      write(loop.getStep());
      line("}");
      if (loop.getPostTest() && !loop.getCondition().empty()) {
        // The condition's values are used in its own region alone; its `break` leaves the loop.
        mlir::Block &block = loop.getCondition().front();
        auto end = llvm::cast<ir::ConditionOp>(block.getTerminator());
        for (mlir::Operation &op : block.without_terminator())
          write(op);
        line("if (!" + first + " && !" + whole(end.getCondition()) + ")\nbreak;");
      }
    }
    if (!loop.getPostTest())
      write(loop.getCondition());
    write(loop.getBody());
    line("}");
  }

  void write(ir::SwitchOp choice) {
    line("switch (" + whole(choice.getValue()) + ") {");
    for (unsigned i = 0; i < choice.getArms().size(); ++i) {
      for (std::int32_t value : choice.armValues(i))
        line(fmt::format("case {}:", value));
      if (choice.getDefaultArm() && *choice.getDefaultArm() == i)
        line("default:");
      line("{");
      write(choice.getArms()[i]);
      line("}");
      if (llvm::isa<ir::YieldOp>(choice.getArms()[i].front().getTerminator()))
        line(i + 1 < choice.getArms().size() ? "[[fallthrough]];" : "break;");
    }
    line("}");
  }

  ModulePrinter &module;
  const typed::Class &definition;
  continuation::UniqueNames names;
  std::set<std::string> taken;
  llvm::DenseMap<Value, std::string> known;
  std::string text;
};

} // namespace

/// `boundHitError(rt, self)` for each primitive that has one.
std::string ModulePrinter::hitErrors() {
  std::string text;
  if (!options.hitErrors)
    return text;
  mlir::ModuleOp ir = options.hitErrors->ir;
  for (const auto &definition : module.classes) {
    auto function =
        ir.lookupSymbol<mlir::func::FuncOp>(definition->name + "." + hitErrorMethod.str());
    if (!function)
      continue;
    withHitErrors.insert(definition.get());
    text += "\n/// Bounds the error of HitDistance where `intersect` of `" + definition->name +
            "` has found it: running error analysis.\ninline void boundHitError(State &rt, "
            "[[maybe_unused]] const " +
            names.of(definition.get()) + " &self) {\n" +
            HitErrorWriter(*this, *definition).body(function) + "}\n";
  }
  return text;
}

} // namespace rtsl::cpp
