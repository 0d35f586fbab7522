#include "codegen/passes/errors/Planes.h"

#include "codegen/ir/Rtsl.h"
#include "codegen/passes/errors/HitBranches.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/ADT/StringMap.h"

#include <map>
#include <optional>
#include <tuple>

namespace rtsl {

namespace arith = mlir::arith;
namespace vector = mlir::vector;
using mlir::Value;

namespace {

/// A component of a number or a vector.
struct Component {
  Value of;
  unsigned index = 0;
};

/// A sum of few components of the ray's origin and direction, each times one that does not depend
/// on the ray, and of a number that does not.
struct LinearForm {
  /// What multiplies the ray's component (none: 1), which vector of the ray, and which component.
  using Term = std::tuple<const void *, unsigned, bool, unsigned>;
  static constexpr int mostTimes = 16;
  std::map<Term, int> terms; // how often each is added
  bool hasRest = false;

  static Term term(Component factor, bool isDirection, unsigned index) {
    return {factor.of.getAsOpaquePointer(), factor.index, isDirection, index};
  }
  /// Whether it still is one of few.
  bool add(const LinearForm &other, int sign) {
    hasRest |= other.hasRest;
    for (const auto &[term, times] : other.terms) {
      const int sum = terms[term] += sign * times;
      if (sum == 0)
        terms.erase(term);
      if (sum > mostTimes || sum < -mostTimes)
        return false;
    }
    return true;
  }
};

class Analysis {
public:
  std::optional<LinearForm> formOf(Component component) {
    const auto key = std::make_pair(component.of, component.index);
    if (const auto known = forms.find(key); known != forms.end())
      return known->second;
    const std::optional<LinearForm> form = compute(component);
    forms[key] = form;
    return form;
  }

private:
  std::optional<LinearForm> compute(Component component) {
    if (isIndependent(component.of))
      return LinearForm{{}, /*hasRest=*/true};
    mlir::Operation *op = component.of.getDefiningOp();
    if (!op)
      return std::nullopt;
    if (auto load = llvm::dyn_cast<ir::LoadOp>(op))
      return ofRay(load, component.index);
    if (auto extract = llvm::dyn_cast<vector::ExtractOp>(op))
      return extract.getDynamicPosition().empty() && extract.getStaticPosition().size() == 1
                 ? formOf({extract.getSource(), unsigned(extract.getStaticPosition()[0])})
                 : std::nullopt;
    const auto operand = [&](unsigned number) {
      return Component{op->getOperand(number), component.index};
    };
    if (llvm::isa<arith::NegFOp>(op))
      return sum(LinearForm(), formOf(operand(0)), -1);
    if (llvm::isa<arith::AddFOp, arith::SubFOp>(op))
      return sum(formOf(operand(0)), formOf(operand(1)), llvm::isa<arith::AddFOp>(op) ? 1 : -1);
    if (llvm::isa<arith::MulFOp>(op))
      return isIndependent(op->getOperand(0)) ? product(operand(0), formOf(operand(1)))
                                              : product(operand(1), formOf(operand(0)));
    return std::nullopt;
  }

  static std::optional<LinearForm> ofRay(ir::LoadOp load, unsigned index) {
    auto state = load.getAddress().getDefiningOp<ir::StateOp>();
    if (!state || (state.getName() != "RayOrigin" && state.getName() != "RayDirection"))
      return std::nullopt;
    LinearForm form;
    form.terms[LinearForm::term({}, state.getName() == "RayDirection", index)] = 1;
    return form;
  }

  static std::optional<LinearForm> sum(std::optional<LinearForm> a,
                                       const std::optional<LinearForm> &b, int sign) {
    return a && b && a->add(*b, sign) ? a : std::nullopt;
  }

  std::optional<LinearForm> product(Component factor, const std::optional<LinearForm> &form) {
    if (!form || !isIndependent(factor.of))
      return std::nullopt;
    LinearForm result;
    result.hasRest = form->hasRest;
    factor.of = first(factor.of);
    for (const auto &[term, times] : form->terms) {
      const auto &[before, unused, isDirection, index] = term;
      if (before)
        return std::nullopt;
      result.terms[LinearForm::term(factor, isDirection, index)] = times;
    }
    return result;
  }

  /// Is it the same for all rays?
  bool isIndependent(Value value) {
    mlir::Operation *op = value.getDefiningOp();
    if (!op)
      return false;
    if (const auto known = independent.find(op); known != independent.end())
      return known->second;
    auto load = llvm::dyn_cast<ir::LoadOp>(op);
    const bool result = load ? isMember(load.getAddress())
                             : mlir::isPure(op) && !llvm::isa<ir::StateOp>(op) &&
                                   llvm::all_of(op->getOperands(), [&](Value operand) {
                                     return isIndependent(operand);
                                   });
    return independent[op] = result;
  }

  /// Is it the address of a member, or of a part of one that is the same for all rays?
  bool isMember(Value address) {
    mlir::Operation *op = address.getDefiningOp();
    if (llvm::isa_and_nonnull<ir::FieldOp, ir::ElementOp>(op))
      return isMember(op->getOperand(0)) &&
             llvm::all_of(op->getOperands().drop_front(),
                          [&](Value index) { return isIndependent(index); });
    auto member = llvm::dyn_cast_or_null<ir::MemberOp>(op);
    return member && (isSelf(member.getObject()) || isIndependent(member.getObject()));
  }

  static bool isSelf(Value object) {
    auto argument = llvm::dyn_cast<mlir::BlockArgument>(object);
    return argument && argument.getOwner()->isEntryBlock();
  }

  /// The first value that is loaded from the same member of the primitive, or the value itself.
  Value first(Value value) {
    auto load = value.getDefiningOp<ir::LoadOp>();
    auto member = load ? load.getAddress().getDefiningOp<ir::MemberOp>() : ir::MemberOp();
    return member && isSelf(member.getObject())
               ? loaded.try_emplace(member.getMember(), value).first->second
               : value;
  }

  llvm::DenseMap<std::pair<Value, unsigned>, std::optional<LinearForm>> forms;
  llvm::DenseMap<mlir::Operation *, bool> independent;
  llvm::StringMap<Value> loaded; // by member
};

} // namespace

bool isOfPlane(mlir::func::FuncOp intersect) {
  llvm::SmallVector<ir::HitOp> hits;
  intersect.walk([&](ir::HitOp hit) { hits.push_back(hit); });
  if (hits.size() != 1)
    return false;
  mlir::Block *block = hits.front()->getBlock();
  if (blocksAfter(block).contains(block)) // in a loop
    return false;
  auto quotient = hits.front().getT().getDefiningOp<arith::DivFOp>();
  if (!quotient)
    return false;
  Analysis analysis;
  const std::optional<LinearForm> dividend = analysis.formOf({quotient.getLhs()}),
                                  divisor = analysis.formOf({quotient.getRhs()});
  if (!dividend || !divisor || divisor->hasRest || divisor->terms.empty() ||
      dividend->terms.size() != divisor->terms.size())
    return false;
  return llvm::all_of(divisor->terms, [&](const auto &one) {
    auto [factor, component, isDirection, index] = one.first;
    const auto other = dividend->terms.find({factor, component, /*isDirection=*/false, index});
    return isDirection && other != dividend->terms.end() && other->second == -one.second;
  });
}

} // namespace rtsl
