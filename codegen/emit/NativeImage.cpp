//===- NativeImage.cpp - position-independent machine code ----------------===//
//
// JITLink lays out an object file, removes code that no entry point reaches and fills in relative
// addresses; but the memory is our own vector and is never executed here.
//
//===----------------------------------------------------------------------===//
#include "codegen/emit/NativeImage.h"

#include "codegen/emit/ObjectCode.h"

#include "llvm/ADT/BitmaskEnum.h"
#include "llvm/ExecutionEngine/JITLink/ELF_x86_64.h"
#include "llvm/ExecutionEngine/JITLink/JITLinkMemoryManager.h"
#include "llvm/ExecutionEngine/JITLink/x86_64.h"
#include "llvm/Support/MemoryBuffer.h"

namespace rtsl::codegen {

namespace jitlink = llvm::jitlink;
namespace orc = llvm::orc;

namespace {

LLVM_ENABLE_BITMASK_ENUMS_IN_NAMESPACE();

/// The address that the linker assumes for the code: above 4 GiB, so that it does not replace a
/// relative address by an absolute one.
constexpr std::uint64_t linkAddress = 0x100000000000;
constexpr std::uint64_t segmentAlignment = 64;

/// The linked code, or the error.
struct Result {
  NativeImage image;
  llvm::Error error = llvm::Error::success();
  void fail(llvm::Error problem) { error = llvm::joinErrors(std::move(error), std::move(problem)); }
};

class Memory : public jitlink::JITLinkMemoryManager {
public:
  explicit Memory(Result &result) : result(result) {}

  void allocate(const jitlink::JITLinkDylib *, jitlink::LinkGraph &graph,
                OnAllocatedFunction whenDone) override {
    jitlink::BasicLayout layout(graph);
    std::uint64_t end = 0;
    for (auto &[group, segment] : layout.segments()) {
      const std::uint64_t size = segment.ContentSize + segment.ZeroFillSize;
      if (size != 0 && (group.getMemProt() & orc::MemProt::Write) != orc::MemProt::None)
        return whenDone(llvm::createStringError("the program has writable data"));
      const std::uint64_t alignment = std::max(segment.Alignment.value(), segmentAlignment);
      const std::uint64_t start = (end + alignment - 1) / alignment * alignment;
      segment.Addr = orc::ExecutorAddr(linkAddress + start);
      end = start + size;
    }
    result.image.bytes.resize(end);
    for (auto &[group, segment] : layout.segments())
      segment.WorkingMem = reinterpret_cast<char *>(result.image.bytes.data()) +
                           (segment.Addr.getValue() - linkAddress);
    if (llvm::Error error = layout.apply())
      return whenDone(std::move(error));
    whenDone(std::make_unique<Kept>());
  }

  void deallocate(std::vector<FinalizedAlloc> allocations,
                  OnDeallocatedFunction whenDone) override {
    for (FinalizedAlloc &allocation : allocations)
      allocation.release();
    whenDone(llvm::Error::success());
  }

private:
  /// The memory is not moved or protected.
  struct Kept : InFlightAlloc {
    void abandon(OnAbandonedFunction whenDone) override { whenDone(llvm::Error::success()); }
    void finalize(OnFinalizedFunction whenDone) override {
      whenDone(FinalizedAlloc(orc::ExecutorAddr(linkAddress)));
    }
  };
  Result &result;
};

class Context : public jitlink::JITLinkContext {
public:
  Context(Result &result, llvm::ArrayRef<std::string> entries)
      : JITLinkContext(nullptr), result(result), entries(entries), memory(result) {}

  jitlink::JITLinkMemoryManager &getMemoryManager() override { return memory; }
  void notifyFailed(llvm::Error error) override { result.fail(std::move(error)); }
  void notifyFinalized(jitlink::JITLinkMemoryManager::FinalizedAlloc allocation) override {
    allocation.release();
  }

  void lookup(const LookupMap &symbols,
              std::unique_ptr<jitlink::JITLinkAsyncLookupContinuation> then) override {
    std::vector<std::string> names;
    for (const auto &symbol : symbols)
      names.push_back((*symbol.first).str());
    std::sort(names.begin(), names.end());
    std::string list;
    for (const std::string &name : names)
      list += " " + name;
    then->run(llvm::createStringError("undefined symbols:%s", list.c_str()));
  }

  llvm::Error notifyResolved(jitlink::LinkGraph &graph) override {
    for (const std::string &entry : entries) {
      const jitlink::Symbol *symbol = find(graph, entry);
      if (!symbol)
        return llvm::createStringError("the program lacks %s", entry.c_str());
      result.image.entries.push_back(symbol->getAddress().getValue() - linkAddress);
    }
    return llvm::Error::success();
  }

  /// Keeps only code that entry points reach.
  jitlink::LinkGraphPassFunction getMarkLivePass(const llvm::Triple &) const override {
    return [this](jitlink::LinkGraph &graph) {
      for (const std::string &entry : entries)
        if (jitlink::Symbol *symbol = find(graph, entry))
          symbol->setLive(true);
      return llvm::Error::success();
    };
  }

  llvm::Error modifyPassConfig(jitlink::LinkGraph &, jitlink::PassConfiguration &passes) override {
    passes.PreFixupPasses.push_back(refuseAbsoluteAddresses);
    return llvm::Error::success();
  }

private:
  static jitlink::Symbol *find(jitlink::LinkGraph &graph, llvm::StringRef name) {
    for (jitlink::Symbol *symbol : graph.defined_symbols())
      if (symbol->hasName() && *symbol->getName() == name)
        return symbol;
    return nullptr;
  }

  /// Only differences of addresses inside of the code do not depend on where it is loaded.
  static llvm::Error refuseAbsoluteAddresses(jitlink::LinkGraph &graph) {
    namespace x86 = jitlink::x86_64;
    for (jitlink::Block *block : graph.blocks())
      for (const jitlink::Edge &edge : block->edges())
        switch (edge.getKind()) {
        case jitlink::Edge::KeepAlive:
        case x86::Delta64:
        case x86::Delta32:
        case x86::Delta8:
        case x86::NegDelta64:
        case x86::NegDelta32:
        case x86::PCRel32:
        case x86::BranchPCRel32:
          break;
        default:
          return llvm::createStringError("the code depends on its address (%s)",
                                         graph.getEdgeKindName(edge.getKind()));
        }
    return llvm::Error::success();
  }

  Result &result;
  llvm::ArrayRef<std::string> entries;
  Memory memory;
};

} // namespace

llvm::Expected<NativeImage> makeNativeImage(const ObjectCode &object,
                                            llvm::ArrayRef<std::string> entries) {
  auto graph = jitlink::createLinkGraphFromELFObject_x86_64(
      llvm::MemoryBufferRef(llvm::StringRef(object.bytes.data(), object.bytes.size()), "host code"),
      std::make_shared<orc::SymbolStringPool>());
  if (!graph)
    return graph.takeError();
  Result result;
  jitlink::link_ELF_x86_64(std::move(*graph), std::make_unique<Context>(result, entries));
  if (result.error)
    return std::move(result.error);
  result.image.stackBytes =
      object.stackUse.bytes(/*rays=*/1, /*referenceChain=*/0); // it does not recurse
  return std::move(result.image);
}

} // namespace rtsl::codegen
