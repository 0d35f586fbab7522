//===- FrameLayout.cpp - offsets in the frame -----------------------------===//
//
//     rtsl.suspend %o, %d, ^r(%i) names ["i"]        rtsl.frame_store %i, "i"[0]
//   ^r(%i'):                                ==>      rtsl.suspend %o, %d, ^r
//                                                  ^r:
//                                                    %i' = rtsl.frame_load "i"[0]
//
// A value has the same slot at all traces, so that nothing is ever copied from slot to slot. Values
// that are never saved at the same trace may share words; objects share them with others that are
// not live at the same time (ObjectLifetimes.h). Bools take a bit each. Words are assigned first
// fit: largest values first, most often saved first, or in program order, whichever frame is
// smallest.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Layout.h"
#include "codegen/passes/continuation/frame/ObjectLifetimes.h"
#include "codegen/passes/continuation/frame/Steps.h"

#include "llvm/ADT/BitVector.h"
#include "llvm/ADT/StringMap.h"

#include <algorithm>
#include <numeric>

namespace rtsl::continuation {

namespace {

/// An item that needs words of its own at some traces.
struct Item {
  std::string name;
  std::uint32_t size = 4; // bytes
  llvm::BitVector traces; // at which it is saved; for an object: live
  bool isObject = false;
  llvm::BitVector objects = {}; // for an object: others that are live at the same time
  unsigned number = 0;          // for an object: its index among them
  std::uint32_t offset = 0;
  std::vector<unsigned> bools = {}; // for a word of bools: their indices, one for each bit
};

struct SavedBool {
  std::string name;
  llvm::BitVector traces;
  unsigned bit = 0; // counted over all words of bools
};

bool interfere(const Item &a, const Item &b) {
  if (a.isObject && b.isObject)
    return a.objects.test(b.number) || b.objects.test(a.number);
  return a.traces.anyCommon(b.traces);
}

class Layouter {
public:
  explicit Layouter(FuncOp function) : function(function), suspends(suspendsOf(function)) {
    if (auto bytes = ir::attr::frameBase.of(function))
      base = static_cast<std::uint32_t>(bytes.getInt());
  }
  FrameLayout run();

private:
  void collect();
  void placeBools();
  std::uint32_t place(const std::vector<unsigned> &order,
                      std::vector<std::uint32_t> &offsets) const;
  void placeWords();
  bool isShared(std::uint32_t offset, std::uint32_t size) const;
  FrameLayout describe() const;
  void rewrite();

  FuncOp function;
  std::uint32_t base = 0; // bytes: after arguments and results of a call
  llvm::SmallVector<ir::SuspendOp> suspends;
  std::vector<Item> items;
  std::vector<unsigned> objects; // indices of objects in `items`
  std::vector<SavedBool> bools;
  llvm::StringMap<unsigned> itemOf, boolOf;
  std::uint32_t size = 0;
};

void Layouter::collect() {
  for (auto [index, suspend] : llvm::enumerate(suspends))
    for (auto [value, nameAttr] : llvm::zip(suspend.getSaved(), suspend.getNames())) {
      llvm::StringRef name = llvm::cast<mlir::StringAttr>(nameAttr).getValue();
      if (value.getType().isInteger(1)) {
        auto [at, isNew] = boolOf.try_emplace(name, bools.size());
        if (isNew)
          bools.push_back({name.str(), llvm::BitVector(suspends.size())});
        bools[at->second].traces.set(index);
        continue;
      }
      auto [at, isNew] = itemOf.try_emplace(name, items.size());
      if (isNew)
        items.push_back(
            {name.str(), ir::sizeInBytes(value.getType()), llvm::BitVector(suspends.size())});
      items[at->second].traces.set(index);
    }
  // An object may occur in several blocks if it has been recomputed; its name is unique.
  for (auto [number, lifetime] : llvm::enumerate(lifetimesOfObjects(function, suspends))) {
    itemOf[("object " + lifetime.object.getName()).str()] = items.size();
    objects.push_back(items.size());
    mlir::Type type = llvm::cast<ir::PtrType>(lifetime.object.getType()).getPointee();
    items.push_back({lifetime.object.getName().str(), ir::sizeInBytes(type), lifetime.traces, true,
                     lifetime.objects, static_cast<unsigned>(number)});
  }
}

/// Assigns each bool the lowest bit that is free at all its traces; 32 make a word.
void Layouter::placeBools() {
  for (unsigned i = 0; i < bools.size(); ++i) {
    llvm::BitVector taken(bools.size());
    for (unsigned j = 0; j < i; ++j)
      if (bools[i].traces.anyCommon(bools[j].traces))
        taken.set(bools[j].bit);
    unsigned bit = 0;
    while (taken.test(bit))
      ++bit;
    bools[i].bit = bit;
    unsigned word = bit / 32;
    auto [at, isNew] = itemOf.try_emplace("bools " + std::to_string(word), items.size());
    if (isNew)
      items.push_back({"", 4, llvm::BitVector(suspends.size())});
    items[at->second].traces |= bools[i].traces;
    items[at->second].bools.push_back(i);
  }
}

/// First fit in this order; returns the size of the frame.
std::uint32_t Layouter::place(const std::vector<unsigned> &order,
                              std::vector<std::uint32_t> &offsets) const {
  std::uint32_t end = base;
  std::vector<std::vector<unsigned>> placedAt(suspends.size()); // by trace
  std::vector<unsigned> placedObjects;
  std::vector<unsigned> seenFor(items.size(),
                                ~0u); // an item that shares several traces with this one
  for (unsigned index : order) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> taken; // from, to
    const auto look = [&](const std::vector<unsigned> &placed) {
      for (unsigned other : placed)
        if (seenFor[other] != index && interfere(items[index], items[other])) {
          seenFor[other] = index;
          taken.push_back({offsets[other], offsets[other] + items[other].size});
        }
    };
    if (items[index].isObject)
      look(placedObjects);
    for (unsigned trace : items[index].traces.set_bits())
      look(placedAt[trace]);
    std::sort(taken.begin(), taken.end());
    std::uint32_t offset = base;
    for (auto [from, to] : taken) {
      if (offset + items[index].size <= from)
        break;
      offset = std::max(offset, to);
    }
    offsets[index] = offset;
    end = std::max(end, offset + items[index].size);
    for (unsigned trace : items[index].traces.set_bits())
      placedAt[trace].push_back(index);
    if (items[index].isObject)
      placedObjects.push_back(index);
  }
  return end;
}

void Layouter::placeWords() {
  std::vector<unsigned> asTheyCome(items.size());
  std::iota(asTheyCome.begin(), asTheyCome.end(), 0u);
  std::vector<unsigned> bySize = asTheyCome, byTraces = asTheyCome;
  std::stable_sort(bySize.begin(), bySize.end(),
                   [&](unsigned a, unsigned b) { return items[a].size > items[b].size; });
  std::stable_sort(byTraces.begin(), byTraces.end(), [&](unsigned a, unsigned b) {
    return items[a].traces.count() > items[b].traces.count();
  });
  size = ~0u;
  for (const std::vector<unsigned> &order : {asTheyCome, bySize, byTraces}) {
    std::vector<std::uint32_t> offsets(items.size());
    std::uint32_t needed = std::max(place(order, offsets), base);
    if (needed >= size)
      continue;
    size = needed;
    for (unsigned i = 0; i < items.size(); ++i)
      items[i].offset = offsets[i];
  }
}

FrameLayout Layouter::describe() const {
  FrameLayout layout;
  layout.size = size;
  std::vector<std::uint32_t> atTrace(suspends.size());
  for (const Item &item : items) {
    for (unsigned trace : item.traces.set_bits())
      atTrace[trace] += item.size;
    if (item.bools.empty())
      layout.slots.push_back({item.name, item.offset, item.size, -1, item.isObject});
    layout.unshared +=
        item.bools.empty() ? item.size : 4 * static_cast<std::uint32_t>(item.bools.size());
    for (unsigned index : item.bools)
      layout.slots.push_back(
          {bools[index].name, item.offset, 4, static_cast<int>(bools[index].bit % 32), false});
  }
  for (std::uint32_t bytes : atTrace)
    layout.lowerBound = std::max(layout.lowerBound, bytes);
  layout.lowerBound += base;
  layout.unshared += base;
  std::stable_sort(layout.slots.begin(), layout.slots.end(),
                   [](const FrameSlot &a, const FrameSlot &b) {
                     return std::make_pair(a.offset, a.bit) < std::make_pair(b.offset, b.bit);
                   });
  return layout;
}

/// Does an object use some of these words at other times?
bool Layouter::isShared(std::uint32_t offset, std::uint32_t size) const {
  return llvm::any_of(objects, [&](unsigned index) {
    const Item &item = items[index];
    return item.offset < offset + size && offset < item.offset + item.size;
  });
}

void Layouter::rewrite() {
  mlir::OpBuilder builder(function.getContext());
  for (ir::SuspendOp suspend : suspends) {
    mlir::Block *resume = suspend.getResume();
    mlir::Operation *last = &resume->front(); // the trace's result; loads follow in order
    for (auto [value, argument, nameAttr] :
         llvm::zip(suspend.getSaved(), resume->getArguments(), suspend.getNames())) {
      auto name = llvm::cast<mlir::StringAttr>(nameAttr);
      std::uint32_t offset;
      mlir::IntegerAttr bit;
      if (value.getType().isInteger(1)) {
        unsigned number = bools[boolOf.lookup(name.getValue())].bit;
        offset = items[itemOf.lookup("bools " + std::to_string(number / 32))].offset;
        bit = builder.getI32IntegerAttr(number % 32);
      } else {
        offset = items[itemOf.lookup(name.getValue())].offset;
      }
      mlir::IntegerAttr offsetAttr = builder.getI32IntegerAttr(offset);
      builder.setInsertionPoint(suspend);
      auto store = ir::FrameStoreOp::create(builder, value.getLoc(), value, name, offsetAttr, bit);
      builder.setInsertionPointAfter(last);
      auto load = ir::FrameLoadOp::create(builder, argument.getLoc(), value.getType(), name,
                                          offsetAttr, bit);
      argument.replaceAllUsesWith(load.getResult());
      last = load;
      if (isShared(offset, bit ? 4 : ir::sizeInBytes(value.getType()))) {
        ir::attr::shared.set(store);
        ir::attr::shared.set(load);
      }
    }
    suspend.getSavedMutable().clear();
    suspend.setNamesAttr(builder.getArrayAttr({}));
    resume->eraseArguments(0, resume->getNumArguments());
  }
  function.walk([&](ir::FrameObjectOp object) {
    object.setOffset(items[itemOf.lookup(("object " + object.getName()).str())].offset);
  });
  ir::attr::frameSize.set(function, builder.getI32IntegerAttr(size));
}

FrameLayout Layouter::run() {
  collect();
  placeBools();
  placeWords();
  rewrite();
  return describe();
}

} // namespace

FrameLayout layoutFrame(FuncOp function) {
  if (function.isExternal() || (suspendsOf(function).empty() && !isFramed(function)))
    return {};
  return Layouter(function).run();
}

} // namespace rtsl::continuation
