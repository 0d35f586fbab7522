//===- PassingLight.cpp - surfaces that the light of lights passes --------===//
//
//   class Wrapper { color straight(vec3 toEye) { return material.straight(toEye); } ... }
//
// Rays to lights end at the first surface that they find, unless a material of the program lets
// light pass: then what is behind such a hit must be found, too. Most materials that define
// `transmittance` are made of others, and write what those return, or multiply it by a member that
// is 0 unless the scene says otherwise. So a method counts only if it may write anything but black,
// given the classes that the scene's members refer to, and the members that it sets.
//
// The product of black and another value counts as black, though that value may be no number.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/link/CallGraph.h"
#include "codegen/link/steps/Steps.h"
#include "runtime/device/ray/Abi.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/Matchers.h"
#include "llvm/ADT/TypeSwitch.h"

namespace rtsl::linking {

namespace {

using mlir::Value;
using mlir::func::FuncOp;

class Black {
public:
  /// With `assumed`, members that the scene sets count as black, too, and are added to it.
  explicit Black(const LinkContext &context, std::set<MemberKey> *assumed = nullptr)
      : context(context), assumed(assumed) {
    if (assumed)
      return; // all members may be 0
    mlir::ModuleOp(context.ir).walk([&](ir::MemberOp member) {
      if (!isStoredTo(member)) // by a constructor, or as the default
        written.insert(keyOf(member));
    });
  }

  /// Whether a function and what it calls write nothing but black to SampleColor.
  bool isWrittenBy(FuncOp function) {
    return llvm::all_of(reachedFrom({function}, context.symbols), [&](FuncOp reached) {
      return !reached.isExternal() && !ir::anyOperation(reached, [&](mlir::Operation *op) {
        auto state = llvm::dyn_cast<ir::StateOp>(op);
        return llvm::isa<ir::CallMethodOp>(op) ||
               (state && state.getName() == "SampleColor" && !isStoredTo(state));
      });
    });
  }

private:
  /// Whether nothing but black is stored to an address, and nothing else may write there.
  bool isStoredTo(Value address) {
    return llvm::all_of(address.getUsers(), [&](mlir::Operation *user) {
      auto store = llvm::dyn_cast<ir::StoreOp>(user);
      return llvm::isa<ir::LoadOp>(user) || (store && is(store.getValue()));
    });
  }

  bool isReturnedBy(FuncOp function) {
    return functions.of(function, [&] {
      return !function.isExternal() && !ir::anyOperation(function, [&](mlir::Operation *op) {
        return llvm::isa<ir::ReturnOp>(op) && !(op->getNumOperands() == 1 && is(op->getOperand(0)));
      });
    });
  }

  bool is(Value value) {
    if (mlir::matchPattern(value, mlir::m_AnyZeroFloat()))
      return true;
    mlir::Operation *op = value.getDefiningOp();
    if (!op)
      return false;
    const auto isBlack = [&](Value operand) { return is(operand); };
    return llvm::TypeSwitch<mlir::Operation *, bool>(op)
        .Case([&](mlir::func::CallOp call) {
          return call.getNumResults() == 1 &&
                 isReturnedBy(context.symbols.lookup<FuncOp>(call.getCallee()));
        })
        .Case([&](ir::LoadOp load) {
          if (auto member = load.getAddress().getDefiningOp<ir::MemberOp>())
            return assumed ? assumed->insert(keyOf(member)), true : isBlackInAllObjects(member);
          return load.getAddress().getDefiningOp<ir::VarOp>() && isStoredTo(load.getAddress());
        })
        .Case([&](mlir::arith::MulFOp) { return llvm::any_of(op->getOperands(), isBlack); })
        .Case<mlir::arith::AddFOp, mlir::arith::SubFOp, mlir::vector::BroadcastOp,
              mlir::vector::FromElementsOp>(
            [&](auto) { return llvm::all_of(op->getOperands(), isBlack); })
        .Case([&](mlir::arith::SelectOp choice) {
          return is(choice.getTrueValue()) && is(choice.getFalseValue());
        })
        .Default(false);
  }

  bool isBlackInAllObjects(ir::MemberOp member) const {
    const LinkRequest &request = context.request;
    const MemberKey key = keyOf(member);
    const auto given = request.givenMembers.find(key.first);
    return given != request.givenMembers.end() && !given->second.count(key.second) &&
           !written.count(key) && request.editable.empty() && !request.keep.has(Item::Parameters);
  }

  const LinkContext &context;
  std::set<MemberKey> *assumed;
  std::set<MemberKey> written; // with anything but black
  FunctionProperty functions;
};

} // namespace

// `illuminate(light, P, false)` sends none.
bool sendsRaysToLights(mlir::Operation *op) {
  if (isLitBySurface(op))
    return true;
  auto light = llvm::dyn_cast<ir::IlluminateOp>(op);
  llvm::APFloat cosine(0.0f);
  const bool isWithoutShadows =
      light && light.getCosAngle() &&
      mlir::matchPattern(light.getCosAngle(), mlir::m_ConstantFloat(&cosine)) &&
      cosine.convertToFloat() == RTSL_NO_SHADOWS;
  return isLitByLights(op) && !isWithoutShadows;
}

static bool isOfOtherEngines(const LinkContext &context, const Slot &slot) {
  const bool isOfClassicAlone = std::string_view(slot.method) == "diffuseTransmittance";
  return isOfClassicAlone && context.request.engine == runtime::Engine::Programs;
}

void findMethodsThatPassLight(LinkContext &context) {
  Black black(context);
  for (const Slot &slot : passingSlots)
    for (const LinkedClass &linked : context.classes)
      if (!isOfOtherEngines(context, slot) && linked.isMet && linked.info->root == slot.base)
        if (FuncOp method = findMethod(context, linked, slot.method))
          if (!black.isWrittenBy(method))
            context.methodsThatPassLight[slot.method].push_back(method);
}

std::optional<std::vector<runtime::MemberName>> opaqueIfZero(const LinkContext &context,
                                                             const LinkedClass &material) {
  std::set<MemberKey> members;
  Black black(context, &members);
  for (const Slot &slot : passingSlots) {
    FuncOp method =
        isOfOtherEngines(context, slot) ? FuncOp() : findMethod(context, material, slot.method);
    if (method && !black.isWrittenBy(method))
      return std::nullopt;
  }
  if (!members.empty() && !context.request.editable.empty()) // the values may change
    return std::nullopt;
  std::vector<runtime::MemberName> names;
  for (const auto &[className, member] : members)
    names.push_back({className, member});
  return names;
}

void replaceLightMayPass(LinkContext &context) {
  if (!ir::anyOperation(context.ir, [](auto *op) { return llvm::isa<ir::LightMayPassOp>(op); }))
    return;
  const bool mayPass =
      ir::anyOperation(context.ir, isLitBySurface) && !context.methodsThatPassLight.empty();
  for (auto function : context.ir.getOps<FuncOp>()) {
    bool found = false;
    function.walk([&](ir::LightMayPassOp op) {
      mlir::OpBuilder builder(op);
      op.replaceAllUsesWith(
          mlir::arith::ConstantIntOp::create(builder, op.getLoc(), mayPass, 1).getResult());
      op.erase();
      found = true;
    });
    if (found)
      dropBranches(function);
  }
}

bool lightPasses(const LinkContext &context) {
  return ir::anyOperation(context.ir, sendsRaysToLights) && !context.methodsThatPassLight.empty();
}

} // namespace rtsl::linking
