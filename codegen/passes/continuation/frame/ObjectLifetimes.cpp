//===- ObjectLifetimes.cpp - liveness of objects in the frame -------------===//
#include "codegen/passes/continuation/frame/ObjectLifetimes.h"

#include "mlir/IR/RegionGraphTraits.h"
#include "llvm/ADT/PostOrderIterator.h"
#include "llvm/ADT/StringMap.h"

namespace rtsl::continuation {

namespace {

using llvm::BitVector;

class Finder {
public:
  Finder(FuncOp function, llvm::ArrayRef<ir::SuspendOp> suspends)
      : function(function), suspends(suspends) {}
  std::vector<ObjectLifetime> run();

private:
  void number();
  void findUses(unsigned number, mlir::Value address, bool isWhole);
  void findLive();
  void walkBack(mlir::Block &block);
  BitVector none() const { return BitVector(lifetimes.size()); }
  BitVector atEnd(mlir::Block &block);

  FuncOp function;
  llvm::ArrayRef<ir::SuspendOp> suspends;
  std::vector<ObjectLifetime> lifetimes;
  llvm::StringMap<unsigned> numbers;
  llvm::DenseMap<mlir::Operation *, llvm::SmallVector<unsigned, 2>>
      uses;                                           // reads, or partial writes
  llvm::DenseMap<mlir::Operation *, unsigned> clears; // of whole objects
  BitVector escaped;                                  // with unknown uses: always live
  llvm::DenseMap<mlir::Block *, BitVector> atBeginning;
};

void Finder::number() {
  llvm::SmallVector<std::pair<unsigned, ir::FrameObjectOp>> all;
  function.walk([&](ir::FrameObjectOp object) {
    auto [at, isNew] = numbers.try_emplace(object.getName(), lifetimes.size());
    if (isNew)
      lifetimes.push_back({object, BitVector(suspends.size()), {}});
    all.push_back({at->second, object});
  });
  escaped = none();
  for (ObjectLifetime &lifetime : lifetimes)
    lifetime.objects = none();
  for (auto [number, object] : all)
    findUses(number, object.getResult(), true);
}

void Finder::findUses(unsigned number, mlir::Value address, bool isWhole) {
  for (mlir::Operation *user : address.getUsers()) {
    if (llvm::isa<ir::FieldOp, ir::ElementOp>(user))
      findUses(number, user->getResult(0), false);
    else if (isWhole && llvm::isa<ir::ClearOp>(user))
      clears[user] = number;
    else
      uses[user].push_back(number);
    if (user->hasTrait<mlir::OpTrait::IsTerminator>())
      escaped.set(number);
  }
}

BitVector Finder::atEnd(mlir::Block &block) {
  BitVector live = escaped;
  for (mlir::Block *next : block.getSuccessors())
    if (auto found = atBeginning.find(next); found != atBeginning.end())
      live |= found->second;
  return live;
}

/// Finds which objects are live at the beginning of each block; iterates until nothing changes.
void Finder::findLive() {
  llvm::SmallVector<mlir::Block *> order(llvm::post_order(&function.getBody().front()));
  bool changed = true;
  while (changed) {
    changed = false;
    for (mlir::Block *block : order) {
      BitVector live = atEnd(*block);
      for (mlir::Operation &op : llvm::reverse(*block)) {
        if (auto clear = clears.find(&op); clear != clears.end() && !escaped.test(clear->second))
          live.reset(clear->second);
        if (auto use = uses.find(&op); use != uses.end())
          for (unsigned number : use->second)
            live.set(number);
      }
      BitVector &known = atBeginning.try_emplace(block, none()).first->second;
      changed |= known != live;
      known = live;
    }
  }
}

/// Finds which objects are live while another is accessed; a lifetime begins at the first access,
/// or with the function.
void Finder::walkBack(mlir::Block &block) {
  BitVector live = atEnd(block);
  const auto *suspend = llvm::find(suspends, llvm::dyn_cast<ir::SuspendOp>(block.back()));
  const auto meet = [&](const BitVector &touched) {
    for (unsigned number : touched.set_bits()) {
      lifetimes[number].objects |= live;
      lifetimes[number].objects |= touched;
    }
  };
  if (suspend != suspends.end())
    for (unsigned number : live.set_bits())
      lifetimes[number].traces.set(suspend - suspends.begin());
  for (mlir::Operation &op : llvm::reverse(block)) {
    BitVector touched = none();
    if (auto clear = clears.find(&op); clear != clears.end())
      touched.set(clear->second);
    if (auto use = uses.find(&op); use != uses.end())
      for (unsigned number : use->second) {
        touched.set(number);
        if (suspend != suspends.end() && llvm::isa<ir::SpawnPayloadOp, ir::EnterOp>(op))
          lifetimes[number].traces.set(suspend - suspends.begin());
      }
    if (touched.none())
      continue;
    meet(touched);
    if (auto clear = clears.find(&op); clear != clears.end() && !escaped.test(clear->second))
      live.reset(clear->second);
    else
      live |= touched;
  }
  if (block.isEntryBlock())
    meet(live);
}

std::vector<ObjectLifetime> Finder::run() {
  number();
  if (lifetimes.empty())
    return {};
  findLive();
  for (mlir::Block &block : function.getBody())
    walkBack(block);
  return std::move(lifetimes);
}

} // namespace

std::vector<ObjectLifetime> lifetimesOfObjects(FuncOp function,
                                               llvm::ArrayRef<ir::SuspendOp> suspends) {
  return Finder(function, suspends).run();
}

} // namespace rtsl::continuation
