//===- BindMembers.cpp - members that are the same in all objects ---------===//
#include "codegen/passes/BindMembers.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/ClassTable.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"
#include "mlir/Pass/Pass.h"

#include <cstring>
#include <memory>
#include <optional>

namespace rtsl::codegen {

using mlir::OpBuilder;
using mlir::Value;

namespace {

using Words = llvm::ArrayRef<int32_t>;

/// Largest member that gets a table of its own, in bytes. Tables should fit into the nearest cache
/// together with other data.
constexpr size_t largestTable = 4096;

/// One scalar of a value from its word; null for a reference, which cannot be a constant.
mlir::TypedAttr scalarOf(mlir::Type type, int32_t word) {
  if (type.isF32()) {
    float value;
    std::memcpy(&value, &word, sizeof value);
    return mlir::FloatAttr::get(type, llvm::APFloat(value));
  }
  if (type.isInteger(1))
    return mlir::IntegerAttr::get(type, word != 0 ? 1 : 0);
  if (type.isInteger(32))
    return mlir::IntegerAttr::get(type, word);
  return nullptr;
}

/// A value from its words. NaNs keep their bits, here as in MLIR.
mlir::TypedAttr valueOf(mlir::Type type, Words words) {
  auto vector = llvm::dyn_cast<mlir::VectorType>(type);
  if (!vector)
    return scalarOf(type, words.front());
  llvm::SmallVector<mlir::Attribute> elements;
  for (int32_t word : words.take_front(static_cast<size_t>(vector.getNumElements()))) {
    mlir::TypedAttr element = scalarOf(vector.getElementType(), word);
    if (!element)
      return nullptr;
    elements.push_back(element);
  }
  return mlir::DenseElementsAttr::get(vector, elements);
}

/// The known words from `address` to the end of the member; nothing if they are not known.
std::optional<Words> wordsAt(const ir::ClassTable &classes, Value address) {
  mlir::Operation *op = address.getDefiningOp();
  if (auto member = llvm::dyn_cast_or_null<ir::MemberOp>(op)) {
    llvm::StringRef className =
        llvm::cast<ir::RefType>(member.getObject().getType()).getClassName();
    ir::MemberDeclOp declaration = classes.find(className, member.getMember())->declaration;
    auto words = ir::attr::bound.of(declaration);
    return words ? std::optional(words.asArrayRef()) : std::nullopt;
  }
  uint32_t bytes = 0;
  if (auto field = llvm::dyn_cast_or_null<ir::FieldOp>(op)) {
    auto type =
        llvm::cast<ir::StructType>(llvm::cast<ir::PtrType>(field.getBase().getType()).getPointee());
    bytes = ir::fieldOffset(type, *type.fieldIndex(field.getField()));
  } else if (auto element = llvm::dyn_cast_or_null<ir::ElementOp>(op)) {
    std::optional<int32_t> index = element.constantIndex();
    mlir::Type type = llvm::cast<ir::PtrType>(element.getType()).getPointee();
    if (!index || *index < 0)
      return std::nullopt;
    bytes = static_cast<uint32_t>(*index) * ir::sizeInBytes(type);
  } else {
    return std::nullopt;
  }
  std::optional<Words> base = wordsAt(classes, op->getOperand(0));
  mlir::Type type = llvm::cast<ir::PtrType>(address.getType()).getPointee();
  // An index out of range occurs only in code that never runs.
  if (!base || bytes / 4 + ir::sizeInBytes(type) / 4 > base->size())
    return std::nullopt;
  return base->drop_front(bytes / 4);
}

struct BindMembers : mlir::PassWrapper<BindMembers, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(BindMembers)
  llvm::StringRef getArgument() const override { return "rtsl-bind-members"; }
  llvm::StringRef getDescription() const override {
    return "members that are the same in all objects become constants";
  }

  void runOnOperation() override {
    auto module = getOperation()->getParentOfType<mlir::ModuleOp>();
    if (module != described) {
      classes = std::make_shared<ir::ClassTable>(module);
      described = module;
    }
    auto lights = ir::attr::lightCount.of(module);
    auto ambient = ir::attr::ambient.of(module);
    getOperation().walk([&](mlir::Operation *op) {
      if (auto load = llvm::dyn_cast<ir::LoadOp>(op)) {
        if (std::optional<Words> words = wordsAt(*classes, load.getAddress()))
          replace(op, valueOf(load.getType(), *words));
      } else if (llvm::isa<ir::LightCountOp>(op)) {
        replace(op, lights);
      } else if (llvm::isa<ir::AmbientOp>(op) && ambient) {
        replace(op, mlir::DenseElementsAttr::get(
                        llvm::cast<mlir::VectorType>(op->getResult(0).getType()),
                        ambient.asArrayRef()));
      }
    });
    getOperation().walk([&](ir::MemberOp member) { placeInTable(member); });
  }

  /// Replaces an access at an index known only at run time by one of a table.
  void placeInTable(ir::MemberOp member) {
    const std::optional<Words> words = wordsAt(*classes, member);
    const mlir::Type type = llvm::cast<ir::PtrType>(member.getType()).getPointee();
    if (!words || !ir::isNumbers(type) || words->size() * sizeof(int32_t) > largestTable)
      return;
    if (llvm::none_of(member->getUsers(), [](mlir::Operation *user) {
          return llvm::isa<ir::ElementOp, ir::FieldOp>(user) && !user->use_empty();
        }))
      return;
    OpBuilder builder(member);
    member->replaceAllUsesWith(ir::TableOp::create(builder, member.getLoc(), member.getType(),
                                                   member.getMember(), *words));
    member->erase();
  }

  static void replace(mlir::Operation *op, mlir::TypedAttr value) {
    if (!value)
      return;
    OpBuilder builder(op);
    op->replaceAllUsesWith(mlir::arith::ConstantOp::create(builder, op->getLoc(), value));
    op->erase();
  }

  mlir::ModuleOp described; // the module of `classes`; the same for all functions of a run
  std::shared_ptr<const ir::ClassTable> classes;
};

} // namespace

std::unique_ptr<mlir::Pass> createBindMembersPass() {
  return std::make_unique<BindMembers>();
}

} // namespace rtsl::codegen
