//===- DoublePrecision.cpp - arithmetic for --fp=double -------------------===//
#include "codegen/emit/rewrites/arithmetic/DoublePrecision.h"

#include "math/Refraction.h"
#include "runtime/program/NumberCheck.h"

#include "llvm/ADT/SetVector.h"
#include "llvm/ADT/SmallVectorExtras.h"
#include "llvm/Analysis/ConstantFolding.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/Module.h"

#include <cmath>

namespace rtsl::codegen {

namespace {

double inverseSquareRoot(double x) {
  return 1.0 / std::sqrt(x);
}

/// Sine and cosine of pi x. All operations up to the product with pi are exact.
double sineOfPi(double x) {
  double turn = std::remainder(x, 2.0);
  if (std::fabs(turn) > 0.5)
    turn = std::copysign(1.0, turn) - turn;
  if (turn == 0.0)
    return std::copysign(0.0, x);
  return std::fabs(turn) > 0.25 ? std::copysign(std::cos(M_PI * (0.5 - std::fabs(turn))), turn)
                                : std::sin(M_PI * turn);
}
double cosineOfPi(double x) {
  return sineOfPi(0.5 - std::fabs(std::remainder(x, 2.0)));
}

using Unary = double (*)(double);
using Binary = double (*)(double, double);
using Refract = void (*)(const double *, const double *, double, double *);

#define UNARY(name) {"rtsl_double_" #name, reinterpret_cast<void *>(static_cast<Unary>(&std::name))}
#define BINARY(name)                                                                               \
  {"rtsl_double_" #name, reinterpret_cast<void *>(static_cast<Binary>(&std::name))}

#define REFRACT(count)                                                                             \
  {"rtsl_double_refract" #count,                                                                   \
   reinterpret_cast<void *>(static_cast<Refract>(&device::refract<count, double>))}

struct DoubleFunction {
  const char *name;
  void *address;
};

const DoubleFunction functions[] = {
    UNARY(sin),
    UNARY(cos),
    UNARY(tan),
    UNARY(asin),
    UNARY(acos),
    UNARY(atan),
    UNARY(sinh),
    UNARY(cosh),
    UNARY(tanh),
    UNARY(asinh),
    UNARY(acosh),
    UNARY(atanh),
    UNARY(exp),
    UNARY(exp2),
    UNARY(expm1),
    UNARY(log),
    UNARY(log2),
    UNARY(log1p),
    BINARY(pow),
    BINARY(atan2),
    {"rtsl_double_inversesqrt", reinterpret_cast<void *>(&inverseSquareRoot)},
    {"rtsl_double_check_number", reinterpret_cast<void *>(&rtsl_double_check_number)},
    {"rtsl_double_check_stored_number", reinterpret_cast<void *>(&rtsl_double_check_stored_number)},
    {"rtsl_double_sinpi", reinterpret_cast<void *>(&sineOfPi)},
    {"rtsl_double_cospi", reinterpret_cast<void *>(&cosineOfPi)},
    REFRACT(1),
    REFRACT(2),
    REFRACT(3),
    REFRACT(4),
};

/// The name of the double function for an elementary one of the device code; empty for others.
std::string doubleNameOf(const llvm::CallInst &call) {
  const llvm::Function *callee = call.getCalledFunction();
  llvm::StringRef name = callee ? callee->getName() : "";
  if (!name.consume_front("rtsl_"))
    return "";
  std::string wide = "rtsl_double_" + name.str();
  for (const DoubleFunction &function : functions)
    if (wide == function.name)
      return wide;
  return "";
}

bool isSingle(const llvm::Type *type) {
  return type->getScalarType()->isFloatTy();
}

llvm::Type *doubled(llvm::Type *type) {
  llvm::Type *scalar = llvm::Type::getDoubleTy(type->getContext());
  auto *vector = llvm::dyn_cast<llvm::VectorType>(type);
  return vector ? llvm::VectorType::get(scalar, vector->getElementCount()) : scalar;
}

/// Intrinsics that exist for double and float, with all operands of the same type.
bool isArithmetic(llvm::Intrinsic::ID intrinsic) {
  switch (intrinsic) {
  case llvm::Intrinsic::ceil:
  case llvm::Intrinsic::copysign:
  case llvm::Intrinsic::fabs:
  case llvm::Intrinsic::floor:
  case llvm::Intrinsic::fma:
  case llvm::Intrinsic::fmuladd:
  case llvm::Intrinsic::maximum:
  case llvm::Intrinsic::maxnum:
  case llvm::Intrinsic::minimum:
  case llvm::Intrinsic::minnum:
  case llvm::Intrinsic::rint:
  case llvm::Intrinsic::roundeven:
  case llvm::Intrinsic::sqrt:
  case llvm::Intrinsic::trunc:
    return true;
  default:
    return false;
  }
}

/// The called function, regardless of the type in the call.
llvm::Function *calleeOf(const llvm::CallInst &call) {
  return llvm::dyn_cast<llvm::Function>(call.getCalledOperand());
}

/// Whether the callee is a function of a shader, whose numbers are passed as double.
bool isWidenedCall(const llvm::CallInst &call) {
  const llvm::Function *callee = calleeOf(call);
  return callee && callee->getFunctionType() != call.getFunctionType();
}

/// The function with double in place of single precision in its signature; the function itself if
/// it has none. No numbers of functions between runtime and shaders are affected.
llvm::Function *withDoubleSignature(llvm::Function &function) {
  llvm::FunctionType *type = function.getFunctionType();
  auto widened = [](llvm::Type *part) { return isSingle(part) ? doubled(part) : part; };
  const auto parameters = llvm::map_to_vector(type->params(), widened);
  llvm::FunctionType *wide =
      llvm::FunctionType::get(widened(type->getReturnType()), parameters, type->isVarArg());
  if (wide == type)
    return &function;
  llvm::Function *result =
      llvm::Function::Create(wide, function.getLinkage(), function.getAddressSpace());
  function.getParent()->getFunctionList().insert(function.getIterator(), result);
  result->copyAttributesFrom(&function);
  result->takeName(&function);
  result->splice(result->begin(), &function);
  for (auto [before, after] : llvm::zip_equal(function.args(), result->args())) {
    after.takeName(&before);
    before.mutateType(after.getType());
    before.replaceAllUsesWith(&after);
  }
  function.replaceAllUsesWith(result);
  function.eraseFromParent();
  return result;
}

/// Widens one function: the values that become double, and the same values rounded to single for
/// other uses.
class Widening {
public:
  explicit Widening(llvm::Function &function) : function(function) {}

  void run() {
    for (llvm::Instruction &instruction : llvm::instructions(function))
      if (computes(instruction))
        computed.insert(&instruction);
    // Types first: a loop uses values before their definition.
    llvm::SmallVector<llvm::Instruction *> users;
    for (llvm::Instruction &instruction : llvm::instructions(function))
      users.push_back(&instruction);
    for (llvm::Instruction *instruction : computed)
      instruction->mutateType(doubled(instruction->getType()));
    for (llvm::Instruction *user : users)
      adapt(*user);
    for (llvm::Instruction *user : users)
      if (isIdentity(*user)) {
        user->replaceAllUsesWith(user->getOperand(0));
        user->eraseFromParent();
      }
  }

private:
  /// Whether the operation is arithmetic, or selects, extracts or combines values.
  static bool computes(const llvm::Instruction &instruction) {
    if (!isSingle(instruction.getType()))
      return false;
    if (const auto *call = llvm::dyn_cast<llvm::CallInst>(&instruction))
      return isArithmetic(call->getIntrinsicID()) || !doubleNameOf(*call).empty() ||
             isWidenedCall(*call);
    return llvm::isa<llvm::BinaryOperator, llvm::UnaryOperator, llvm::SelectInst, llvm::PHINode,
                     llvm::FreezeInst, llvm::ExtractElementInst, llvm::InsertElementInst,
                     llvm::ShuffleVectorInst, llvm::SIToFPInst, llvm::UIToFPInst,
                     llvm::FPTruncInst>(instruction);
  }

  /// A hidden value, or a conversion between types that are both double by now.
  static bool isIdentity(const llvm::Instruction &instruction) {
    return llvm::isa<llvm::FreezeInst>(instruction) ||
           (llvm::isa<llvm::FPExtInst, llvm::FPTruncInst>(instruction) &&
            instruction.getType() == instruction.getOperand(0)->getType());
  }

  /// Whether a user takes double operands though its own result is not widened.
  static bool takesDouble(const llvm::Instruction &user) {
    if (const auto *call = llvm::dyn_cast<llvm::CallInst>(&user))
      return call->getIntrinsicID() == llvm::Intrinsic::fptosi_sat ||
             call->getIntrinsicID() == llvm::Intrinsic::fptoui_sat || isWidenedCall(*call);
    if (llvm::isa<llvm::ReturnInst>(user))
      return user.getFunction()->getReturnType()->isFPOrFPVectorTy();
    return llvm::isa<llvm::FCmpInst, llvm::FPToSIInst, llvm::FPToUIInst, llvm::FPExtInst>(user);
  }

  void adapt(llvm::Instruction &user) {
    const bool isComputed = computed.contains(&user);
    const bool isDouble = isComputed || takesDouble(user);
    for (llvm::Use &use : user.operands())
      if (isDouble && isSingle(use->getType()))
        use.set(wide(use.get()));
      else if (!isDouble && isWide(*use.get()))
        use.set(narrow(*use.get()));
    auto *call = llvm::dyn_cast<llvm::CallInst>(&user);
    if (!call || !isDouble)
      return;
    if (isWidenedCall(*call)) {
      call->mutateFunctionType(calleeOf(*call)->getFunctionType());
      return;
    }
    llvm::Module &module = *function.getParent();
    llvm::Type *type = call->getArgOperand(0)->getType();
    if (const std::string name = doubleNameOf(*call); !name.empty()) {
      llvm::SmallVector<llvm::Type *> operands;
      for (const llvm::Use &argument : call->args()) // widened by now, except integers
        operands.push_back(argument->getType());
      llvm::FunctionCallee callee =
          module.getOrInsertFunction(name, llvm::FunctionType::get(type, operands, false),
                                     call->getCalledFunction()->getAttributes());
      call->setCalledFunction(callee);
    } else if (isComputed) {
      call->setCalledFunction(
          llvm::Intrinsic::getOrInsertDeclaration(&module, call->getIntrinsicID(), {type}));
    } else {
      call->setCalledFunction(llvm::Intrinsic::getOrInsertDeclaration(
          &module, call->getIntrinsicID(), {call->getType(), type}));
    }
  }

  /// Whether a value was single before: an arithmetic result or a parameter.
  bool isWide(llvm::Value &value) const {
    if (auto *instruction = llvm::dyn_cast<llvm::Instruction>(&value))
      return computed.contains(instruction);
    return llvm::isa<llvm::Argument>(value) && value.getType()->getScalarType()->isDoubleTy();
  }

  /// A single value as double.
  llvm::Value *wide(llvm::Value *value) {
    if (auto *constant = llvm::dyn_cast<llvm::Constant>(value))
      return llvm::ConstantFoldCastOperand(llvm::Instruction::FPExt, constant,
                                           doubled(value->getType()),
                                           function.getParent()->getDataLayout());
    llvm::Value *&result = widened[value];
    if (!result) {
      llvm::IRBuilder<> builder(function.getContext());
      moveAfter(builder, *value);
      result = builder.CreateFPExt(value, doubled(value->getType()));
    }
    return result;
  }

  /// A double value rounded to single.
  llvm::Value *narrow(llvm::Value &value) {
    llvm::Value *&result = narrowed[&value];
    if (!result) {
      llvm::Type *type = llvm::Type::getFloatTy(function.getContext());
      if (auto *vector = llvm::dyn_cast<llvm::VectorType>(value.getType()))
        type = llvm::VectorType::get(type, vector->getElementCount());
      llvm::IRBuilder<> builder(function.getContext());
      moveAfter(builder, value);
      result = builder.CreateFPTrunc(&value, type);
    }
    return result;
  }

  void moveAfter(llvm::IRBuilder<> &builder, llvm::Value &value) {
    if (auto *instruction = llvm::dyn_cast<llvm::Instruction>(&value))
      builder.SetInsertPoint(instruction->getParent(), *instruction->getInsertionPointAfterDef());
    else
      builder.SetInsertPoint(&function.getEntryBlock(),
                             function.getEntryBlock().getFirstInsertionPt());
  }

  llvm::Function &function;
  llvm::SetVector<llvm::Instruction *> computed;
  llvm::DenseMap<llvm::Value *, llvm::Value *> widened, narrowed;
};

} // namespace

void widenArithmetic(llvm::Module &module) {
  llvm::SmallVector<llvm::Function *> functions;
  for (llvm::Function &function : llvm::make_early_inc_range(module))
    if (!function.isDeclaration())
      functions.push_back(withDoubleSignature(function));
  for (llvm::Function *function : functions)
    Widening(*function).run();
}

std::vector<HostSymbol> doubleFunctions() {
  std::vector<HostSymbol> symbols;
  for (const DoubleFunction &function : functions)
    symbols.push_back({function.name, function.address});
  return symbols;
}

} // namespace rtsl::codegen
