//===- CallFrames.cpp - functions that have a frame of their own ----------===//
//
//   func @f(%self, %d) -> f32 {               func @f(%self) {
//     trace %d                                  %d = rtsl.call_argument "d"[16]
//     return %x                    ==>          trace %d
//   }                                           rtsl.call_result %x, [28]
//                                               return
//                                             }
//
// What cannot become part of its caller, for it would become part of itself, runs on a frame above
// that of its caller, within the same level: it is the same ray. Its object comes with it as that
// of any method. InsertSuspends.cpp makes a suspend of the call, SplitStates.cpp ends the state
// there, and Dispatch.cpp says what is written where.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Layout.h"
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
    if (isAddress) // of eight bytes, which have to lie as such
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
// How much that can be at once
//===----------------------------------------------------------------------===//

namespace {

/// Chains of references up to this length are counted exactly; behind, each object takes as much as
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
    bool comesRound = false; // may be called while it runs
  };
  unsigned numberOf(llvm::StringRef name);
  void read(FuncOp state);
  void findCircles();
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

/// Does a member of the function's own object refer to it?
bool isOfMember(mlir::Value object, FuncOp state) {
  auto load = object.getDefiningOp<ir::LoadOp>();
  while (auto cast = object.getDefiningOp<ir::CastRefOp>()) {
    object = cast.getObject();
    load = object.getDefiningOp<ir::LoadOp>();
  }
  if (!load)
    return false;
  mlir::Value address = load.getAddress();
  while (mlir::Operation *op = address.getDefiningOp()) {
    if (auto member = llvm::dyn_cast<ir::MemberOp>(op)) {
      mlir::Value owner = member.getObject();
      while (auto cast = owner.getDefiningOp<ir::CastRefOp>())
        owner = cast.getObject();
      return owner == objectOf(state);
    }
    if (!llvm::isa<ir::FieldOp, ir::ElementOp, ir::BufferElementOp>(op))
      return false;
    address = op->getOperand(0);
  }
  return false;
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

void FrameCounter::findCircles() {
  for (unsigned start = 0; start < functions.size(); ++start) {
    llvm::SmallSetVector<unsigned, 8> reached;
    for (const Call &call : functions[start].calls)
      reached.insert(call.callee);
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const Call &call : functions[reached[i]].calls)
        reached.insert(call.callee);
    functions[start].comesRound = reached.contains(start);
  }
}

/// Of the function and all that it may call, if chains of references reach `chain` further. Round a
/// circle calls go down such a chain, so each takes one object of it.
std::uint32_t FrameCounter::bytes(unsigned function, unsigned chain) {
  auto [at, isNew] = known.insert({{function, chain}, 0});
  if (!isNew)
    return at->second;
  std::uint32_t most = 0;
  for (const Call &call : functions[function].calls) {
    const bool goesDown =
        functions[call.callee].comesRound && (functions[function].comesRound || call.onMember);
    if (!goesDown)
      most = std::max(most, bytes(call.callee, chain));
    else if (chain > 0)
      most = std::max(most, bytes(call.callee, chain - 1));
  }
  const std::uint32_t own = functions[function].bytes;
  return known[{function, chain}] =
             most == 0 ? own : (own + 7) / 8 * 8 + most; // as Dispatch.cpp has it
}

std::vector<std::uint32_t> FrameCounter::run() {
  for (FuncOp state : module.getOps<FuncOp>())
    if (ir::attr::state.isOn(state))
      read(state);
  findCircles();
  const bool anyCircle = llvm::any_of(functions, [](const Function &f) { return f.comesRound; });
  std::vector<std::uint32_t> areas;
  for (unsigned chain = 0; chain <= (anyCircle ? longestChain : 0); ++chain) {
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
