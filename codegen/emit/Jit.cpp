//===- Jit.cpp - LLVM IR that runs in this process ------------------------===//
#include "codegen/emit/Jit.h"

#include "llvm/ExecutionEngine/Orc/CompileUtils.h"
#include "llvm/ExecutionEngine/Orc/LLJIT.h"
#include "llvm/ExecutionEngine/Orc/ObjectLinkingLayer.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"
#include "llvm/Target/TargetMachine.h"

#include <cmath>
#include <cstring>
#include <map>

namespace rtsl::codegen {

namespace orc = llvm::orc;

struct Jit::Implementation {
  std::unique_ptr<orc::LLJIT> jit;
  std::map<std::string, void *> addresses;
  std::string messages; // what went wrong on the way, beside what is returned
  std::shared_ptr<StackUse> stackUse;
};

Jit::Jit() : implementation(std::make_unique<Implementation>()) {}
Jit::~Jit() = default;

/// What code generation calls of its own accord.
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
  std::vector<std::string> exports;
  for (const llvm::Function &function : *module)
    if (!function.isDeclaration() && !function.hasLocalLinkage())
      exports.push_back(function.getName().str());

  std::unique_ptr<Jit> result(new Jit);
  Implementation &self = *result->implementation;

  // No threads, no platform with its own run-time modules, no search in the process: a small module
  // is up in milliseconds, and calls only what it is given.
  orc::JITTargetMachineBuilder machineBuilder(machine->getTargetTriple());
  std::shared_ptr<llvm::TargetMachine> shared = std::move(machine);
  auto jit = orc::LLJITBuilder()
                 .setJITTargetMachineBuilder(std::move(machineBuilder))
                 .setDataLayout(module->getDataLayout())
                 .setNumCompileThreads(0)
                 .setLinkProcessSymbolsByDefault(false)
                 .setPlatformSetUp(orc::setUpInactivePlatform)
                 .setObjectLinkingLayerCreator([](orc::ExecutionSession &session) {
                   return std::make_unique<orc::ObjectLinkingLayer>(session);
                 })
                 .setCompileFunctionCreator(
                     [shared](orc::JITTargetMachineBuilder)
                         -> llvm::Expected<std::unique_ptr<orc::IRCompileLayer::IRCompiler>> {
                       return std::make_unique<orc::SimpleCompiler>(*shared);
                     })
                 .create();
  if (!jit)
    return jit.takeError();
  self.jit = std::move(*jit);
  orc::ExecutionSession &session = self.jit->getExecutionSession();
  session.setErrorReporter(
      [&self](llvm::Error error) { self.messages += llvm::toString(std::move(error)) + "\n"; });

  orc::SymbolMap defined;
  auto define = [&](const HostSymbol &symbol) {
    defined[self.jit->mangleAndIntern(symbol.name)] = {orc::ExecutorAddr::fromPtr(symbol.address),
                                                       llvm::JITSymbolFlags::Exported |
                                                           llvm::JITSymbolFlags::Callable};
  };
  for (const HostSymbol &symbol : compilerSymbols)
    define(symbol);
  for (const HostSymbol &symbol : symbols)
    define(symbol);
  orc::JITDylib &library = self.jit->getMainJITDylib();
  // What the module defines itself is its own.
  for (const std::string &name : exports)
    defined.erase(self.jit->mangleAndIntern(name));
  if (llvm::Error error = library.define(orc::absoluteSymbols(std::move(defined))))
    return error;
  self.stackUse = std::make_shared<StackUse>(*module);
  if (llvm::Error error = self.jit->addIRModule(
          orc::ThreadSafeModule(std::move(module), orc::ThreadSafeContext(std::move(context)))))
    return error;

  for (const std::string &name : exports) {
    auto address = self.jit->lookup(name);
    if (!address) {
      std::string message = llvm::toString(address.takeError());
      if (!self.messages.empty())
        message = self.messages + message;
      return llvm::createStringError("%s", message.c_str());
    }
    self.addresses[name] = address->toPtr<void *>();
  }
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
