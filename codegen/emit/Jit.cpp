//===- Jit.cpp - LLVM IR that runs in this process ------------------------===//
#include "codegen/emit/Jit.h"

#include "llvm/ExecutionEngine/Orc/AbsoluteSymbols.h"
#include "llvm/ExecutionEngine/Orc/ObjectLinkingLayer.h"
#include "llvm/ExecutionEngine/Orc/SelfExecutorProcessControl.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/SmallVectorMemoryBuffer.h"
#include "llvm/Target/TargetMachine.h"

#include <cmath>
#include <cstring>
#include <map>

namespace rtsl::codegen {

namespace orc = llvm::orc;

struct Jit::Implementation {
  std::unique_ptr<orc::ExecutionSession> session;
  std::unique_ptr<orc::ObjectLinkingLayer> linker;
  std::map<std::string, void *> addresses;
  std::string messages; // errors that are reported beside the returned one
  std::shared_ptr<StackUse> stackUse;

  llvm::Error findAddresses(orc::JITDylib &library, const orc::SymbolNameSet &exports);
  ~Implementation() {
    if (session)
      llvm::consumeError(session->endSession()); // no session is left to report it to
  }
};

Jit::Jit() : implementation(std::make_unique<Implementation>()) {}
Jit::~Jit() = default;

/// Functions that generated code calls implicitly.
static const HostSymbol compilerSymbols[] = {
    {"memcpy", reinterpret_cast<void *>(&std::memcpy)},
    {"memmove", reinterpret_cast<void *>(&std::memmove)},
    {"memset", reinterpret_cast<void *>(&std::memset)},
    {"memcmp", reinterpret_cast<void *>(&std::memcmp)},
    {"bcmp", reinterpret_cast<void *>(&std::memcmp)},
    {"fmodf", reinterpret_cast<void *>(static_cast<float (*)(float, float)>(&std::fmod))},
    {"fmod", reinterpret_cast<void *>(static_cast<double (*)(double, double)>(&std::fmod))},
};

llvm::Expected<std::unique_ptr<Jit>> Jit::create(std::unique_ptr<llvm::LLVMContext> context,
                                                 std::unique_ptr<llvm::Module> module,
                                                 std::unique_ptr<llvm::TargetMachine> machine,
                                                 const std::vector<HostSymbol> &symbols) {
  llvm::Expected<ObjectCode> code = makeObjectCode(*module, *machine);
  if (!code)
    return code.takeError();
  module.reset();
  context.reset();
  std::vector<ObjectCode> parts;
  parts.push_back(std::move(*code));
  return create(std::move(parts), symbols);
}

/// All symbols at once: a separate lookup of each takes longer than compiling its function.
llvm::Error Jit::Implementation::findAddresses(orc::JITDylib &library,
                                               const orc::SymbolNameSet &exports) {
  auto found =
      session->lookup(orc::makeJITDylibSearchOrder(&library), orc::SymbolLookupSet(exports));
  if (!found) {
    std::string message = llvm::toString(found.takeError());
    if (!messages.empty())
      message = messages + message;
    return llvm::createStringError("%s", message.c_str());
  }
  for (const auto &[name, symbol] : *found)
    addresses[(*name).str()] = symbol.getAddress().toPtr<void *>();
  return llvm::Error::success();
}

llvm::Expected<std::unique_ptr<Jit>> Jit::create(std::vector<ObjectCode> parts,
                                                 const std::vector<HostSymbol> &symbols) {
  std::unique_ptr<Jit> result(new Jit);
  Implementation &self = *result->implementation;

  // No threads, no platform with its own run-time modules, no search in the process: a small
  // program is loaded in milliseconds, and calls only the given functions.
  auto process = orc::SelfExecutorProcessControl::Create(
      nullptr, std::make_unique<orc::InPlaceTaskDispatcher>());
  if (!process)
    return process.takeError();
  self.session = std::make_unique<orc::ExecutionSession>(std::move(*process));
  self.session->setErrorReporter(
      [&self](llvm::Error error) { self.messages += llvm::toString(std::move(error)) + "\n"; });
  self.linker = std::make_unique<orc::ObjectLinkingLayer>(*self.session);
  orc::JITDylib &library = self.session->createBareJITDylib("program");

  orc::SymbolNameSet exports;
  for (const ObjectCode &part : parts)
    for (const std::string &name : part.exports)
      exports.insert(self.session->intern(name));
  orc::SymbolMap defined;
  const auto define = [&](const HostSymbol &symbol) {
    const orc::SymbolStringPtr name = self.session->intern(symbol.name);
    if (!exports.contains(name)) // symbols that the program does not define itself
      defined[name] = {orc::ExecutorAddr::fromPtr(symbol.address),
                       llvm::JITSymbolFlags::Exported | llvm::JITSymbolFlags::Callable};
  };
  for (const HostSymbol &symbol : compilerSymbols)
    define(symbol);
  for (const HostSymbol &symbol : symbols)
    define(symbol);
  if (llvm::Error error = library.define(orc::absoluteSymbols(std::move(defined))))
    return error;

  for (ObjectCode &part : parts) {
    if (self.stackUse)
      self.stackUse->add(part.stackUse);
    else
      self.stackUse = std::make_shared<StackUse>(std::move(part.stackUse));
    if (llvm::Error error =
            self.linker->add(library, std::make_unique<llvm::SmallVectorMemoryBuffer>(
                                          std::move(part.bytes), /*RequiresNullTerminator=*/false)))
      return error;
  }
  if (llvm::Error error = self.findAddresses(library, exports))
    return error;
  return result;
}

void *Jit::lookup(const std::string &name) const {
  auto found = implementation->addresses.find(name);
  return found == implementation->addresses.end() ? nullptr : found->second;
}

std::shared_ptr<const StackUse> Jit::stackUse() const {
  return implementation->stackUse;
}

} // namespace rtsl::codegen
