#include "codegen/passes/calls/Parts.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/IR/Matchers.h"

namespace rtsl::codegen {

using mlir::Value;

namespace {

class PartsOfAggregate {
public:
  explicit PartsOfAggregate(llvm::function_ref<bool(mlir::Operation *)> other) : other(other) {}

  /// Adds what is read at an address, whose path is `path`; false: something else is done with it.
  bool add(Value address, llvm::SmallVector<mlir::Attribute, 2> &path) {
    return llvm::all_of(address.getUsers(), [&](mlir::Operation *user) {
      if (auto load = llvm::dyn_cast<ir::LoadOp>(user)) {
        addLoad(load, path);
        return true;
      }
      mlir::Attribute step;
      if (auto field = llvm::dyn_cast<ir::FieldOp>(user)) {
        step = field.getFieldAttr();
      } else if (auto element = llvm::dyn_cast<ir::ElementOp>(user)) {
        if (!mlir::matchPattern(element.getIndex(), mlir::m_Constant(&step)))
          return false;
      } else {
        return other(user);
      }
      path.push_back(step);
      const bool isRead = add(user->getResult(0), path);
      path.pop_back();
      return isRead;
    });
  }

  std::vector<Part> parts;

private:
  void addLoad(ir::LoadOp load, llvm::ArrayRef<mlir::Attribute> path) {
    auto known =
        llvm::find_if(parts, [&](const Part &part) { return llvm::ArrayRef(part.path) == path; });
    if (known != parts.end())
      known->loads.push_back(load);
    else
      parts.push_back({llvm::SmallVector<mlir::Attribute, 2>(path), load.getType(), {load}});
  }

  llvm::function_ref<bool(mlir::Operation *)> other;
};

std::optional<std::vector<Part>> collectParts(Value aggregate,
                                              llvm::function_ref<bool(mlir::Operation *)> other) {
  PartsOfAggregate collector(other);
  llvm::SmallVector<mlir::Attribute, 2> path;
  if (!collector.add(aggregate, path))
    return std::nullopt;
  return std::move(collector.parts);
}

} // namespace

std::optional<std::vector<Part>> partsRead(Value aggregate) {
  return collectParts(aggregate, [](mlir::Operation *) { return false; });
}

std::optional<std::vector<Part>> partsOfResult(Value variable, mlir::func::CallOp call) {
  return collectParts(variable, [&](mlir::Operation *user) {
    return user == call || llvm::isa<ir::ClearOp>(user);
  });
}

Value loadPart(mlir::OpBuilder &builder, mlir::Location location, Value aggregate,
               const Part &part) {
  Value address = aggregate;
  for (const mlir::Attribute step : part.path) {
    if (auto field = llvm::dyn_cast<mlir::StringAttr>(step)) {
      address = ir::FieldOp::create(builder, location, address, field.getValue());
    } else {
      const Value index =
          mlir::arith::ConstantOp::create(builder, location, llvm::cast<mlir::IntegerAttr>(step));
      address = ir::ElementOp::create(builder, location, address, index);
    }
  }
  return ir::LoadOp::create(builder, location, address);
}

void replaceLoads(const Part &part, Value value) {
  for (ir::LoadOp load : part.loads) {
    load.replaceAllUsesWith(value);
    load.erase();
  }
}

void eraseParts(Value aggregate) {
  for (mlir::Operation *user : llvm::make_early_inc_range(aggregate.getUsers())) {
    if (user->getNumResults() == 1)
      eraseParts(user->getResult(0));
    user->erase();
  }
}

Value addArgument(mlir::func::FuncOp function, mlir::Type type) {
  const unsigned number = function.getNumArguments();
  if (mlir::failed(function.insertArgument(number, type, {}, function.getLoc())))
    llvm_unreachable("a function takes any argument");
  return function.getArgument(number);
}

} // namespace rtsl::codegen
