//===- CallFrames.cpp - functions with a frame of their own ---------------===//
//
//   func @f(%self, %d) -> f32 {               func @f(%self) {
//     trace %d                                  %d = rtsl.call_argument "d"[16]
//     return %x                    ==>          trace %d
//   }                                           rtsl.call_result %x, [28]
//                                               return
//                                             }
//
// A function that cannot be inlined into its caller because of recursion runs on a frame above that
// of its caller, within the same level: it is the same ray. Its object is passed as for any method.
// InsertSuspends.cpp makes a suspend of the call, SplitStates.cpp ends the state there, and
// Dispatch.cpp defines the layout of the frame.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/WithoutCasts.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/common/Names.h"
#include "runtime/device/ray/Abi.h"

#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/SetVector.h"

#include <algorithm>

namespace rtsl::continuation {

//===----------------------------------------------------------------------===//
// Arguments and results
//===----------------------------------------------------------------------===//

CallLayout layoutCall(mlir::TypeRange arguments, mlir::TypeRange results) {
  CallLayout layout;
  std::uint32_t end = RTSL_CALL_HEADER;
  auto place = [&](mlir::Type type, llvm::SmallVector<std::int32_t> &offsets) {
    const bool isAddress = llvm::isa<ir::PtrType>(type);
    if (isAddress) // of eight bytes, aligned
      end = (end + 7) / 8 * 8;
    offsets.push_back(static_cast<std::int32_t>(end));
    end += isAddress ? 8 : ir::sizeInBytes(type);
  };
  for (mlir::Type type : arguments)
    place(type, layout.arguments);
  for (mlir::Type type : results)
    place(type, layout.results);
  layout.size = (end + 7) / 8 * 8;
  return layout;
}

void takeArgumentsFromFrame(FuncOp function) {
  const unsigned own = objectOf(function) ? 1 : 0;
  const CallLayout layout =
      layoutCall(function.getArgumentTypes().drop_front(own), function.getResultTypes());
  mlir::OpBuilder builder(function.getContext());
  mlir::Block &entry = function.getBody().front();
  builder.setInsertionPointToStart(&entry);
  for (auto [argument, offset] :
       llvm::zip(entry.getArguments().drop_front(own), layout.arguments)) {
    std::string name = authorsName(argument);
    if (name.empty())
      name = "argument" + std::to_string(argument.getArgNumber() - own);
    auto load =
        ir::CallArgumentOp::create(builder, argument.getLoc(), argument.getType(), name, offset);
    argument.replaceAllUsesWith(load.getResult());
  }
  function.walk([&](mlir::func::ReturnOp end) {
    builder.setInsertionPoint(end);
    for (auto [value, offset] : llvm::zip(end.getOperands(), layout.results))
      ir::CallResultOp::create(builder, end.getLoc(), value, offset);
    end->setOperands({});
  });
  entry.eraseArguments(own, entry.getNumArguments() - own);
  function.setFunctionType(builder.getFunctionType(entry.getArgumentTypes(), {}));
  ir::attr::frameBase.set(function,
                          builder.getI32IntegerAttr(static_cast<std::int32_t>(layout.size)));
}

//===----------------------------------------------------------------------===//
// The largest sum of frames in one level
//===----------------------------------------------------------------------===//

namespace {

/// Chains of references up to this length are counted exactly; beyond, each object takes as much as
/// all these functions.
constexpr unsigned longestChain = 32;

class FrameCounter {
public:
  explicit FrameCounter(mlir::ModuleOp module) : module(module) {}
  std::vector<std::uint32_t> run();

private:
  struct Call {
    unsigned callee;
    bool onMember; // the object is further down a chain of references
  };
  struct Function {
    std::uint32_t bytes = 0;
    bool isCalled = false;
    std::vector<Call> calls;
    bool isRecursive = false; // is part of a cycle of calls
  };
  unsigned numberOf(llvm::StringRef name);
  void read(FuncOp state);
  void findCycles();
  std::uint32_t bytes(unsigned function, unsigned chain);

  mlir::ModuleOp module;
  llvm::MapVector<llvm::StringRef, unsigned> numbers;
  std::vector<Function> functions;
  llvm::DenseMap<std::pair<unsigned, unsigned>, std::uint32_t> known;
};

unsigned FrameCounter::numberOf(llvm::StringRef name) {
  auto [at, isNew] = numbers.insert({name, static_cast<unsigned>(functions.size())});
  if (isNew)
    functions.emplace_back();
  return at->second;
}

/// Is the object loaded from a member of the function's own object?
bool isOfMember(mlir::Value object, FuncOp state) {
  auto load = ir::withoutCasts(object).getDefiningOp<ir::LoadOp>();
  if (!load)
    return false;
  auto member = llvm::dyn_cast_or_null<ir::MemberOp>(ir::variableOperation(load.getAddress()));
  return member && ir::withoutCasts(member.getObject()) == objectOf(state);
}

void FrameCounter::read(FuncOp state) {
  const unsigned number = numberOf(state.getSymName().rsplit(".state").first);
  if (auto size = ir::attr::frameSize.of(state))
    functions[number].bytes = static_cast<std::uint32_t>(size.getInt());
  functions[number].isCalled |= isFramed(state);
  state.walk([&](ir::EnterOp call) {
    const unsigned callee = numberOf(call.getCallee());
    const bool onMember =
        !call.getOperands().empty() && isOfMember(call.getOperands().front(), state);
    functions[number].calls.push_back({callee, onMember});
  });
}

void FrameCounter::findCycles() {
  for (unsigned start = 0; start < functions.size(); ++start) {
    llvm::SmallSetVector<unsigned, 8> reached;
    for (const Call &call : functions[start].calls)
      reached.insert(call.callee);
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const Call &call : functions[reached[i]].calls)
        reached.insert(call.callee);
    functions[start].isRecursive = reached.contains(start);
  }
}

/// Bytes of the function and of all that it may call, with `chain` objects left in chains of
/// references. Calls in a cycle follow such a chain, so each takes one object of it.
std::uint32_t FrameCounter::bytes(unsigned function, unsigned chain) {
  auto [at, isNew] = known.insert({{function, chain}, 0});
  if (!isNew)
    return at->second;
  std::uint32_t most = 0;
  for (const Call &call : functions[function].calls) {
    const bool goesDown =
        functions[call.callee].isRecursive && (functions[function].isRecursive || call.onMember);
    if (!goesDown)
      most = std::max(most, bytes(call.callee, chain));
    else if (chain > 0)
      most = std::max(most, bytes(call.callee, chain - 1));
  }
  const std::uint32_t own = functions[function].bytes;
  return known[{function, chain}] =
             most == 0 ? own : (own + 7) / 8 * 8 + most; // as in Dispatch.cpp
}

std::vector<std::uint32_t> FrameCounter::run() {
  for (FuncOp state : module.getOps<FuncOp>())
    if (ir::attr::state.isOn(state))
      read(state);
  findCycles();
  const bool anyCycle = llvm::any_of(functions, [](const Function &f) { return f.isRecursive; });
  std::vector<std::uint32_t> areas;
  for (unsigned chain = 0; chain <= (anyCycle ? longestChain : 0); ++chain) {
    std::uint32_t most = 0;
    for (unsigned function = 0; function < functions.size(); ++function)
      if (!functions[function].isCalled)
        most = std::max(most, bytes(function, chain));
    areas.push_back(most);
  }
  return areas;
}

} // namespace

std::vector<std::uint32_t> frameAreas(mlir::ModuleOp module) {
  return FrameCounter(module).run();
}

} // namespace rtsl::continuation
