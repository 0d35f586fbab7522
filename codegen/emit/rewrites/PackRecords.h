//===- PackRecords.h - where the words of a sample in flight are ----------===//
//
// The steps of a wavefront load and store the words of records by number, a thousand of them, with
// rtsl_record_load and rtsl_record_store (runtime/device/organisations/LaneRecord.h). No step needs
// most of them. This pass, over all steps together, until nothing changes:
//
//   - removes stores of words that no step loads, and stores of what was loaded from there,
//   - replaces loads of words that always have the same constant,
//   - simplifies the functions, so that further loads and stores become useless.
//
// Then the words that are left get places, in the order of their numbers: groups of four in a row,
// groups of neighbouring slots next to each other. A load or store of a group is one instruction.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

/// Describes the two functions to LLVM: they access nothing else that the program accesses.
void declareRecords(llvm::Module &module);

class PackRecordsPass : public llvm::PassInfoMixin<PackRecordsPass> {
public:
  llvm::PreservedAnalyses run(llvm::Module &module, llvm::ModuleAnalysisManager &analyses);
  static bool isRequired() { return true; }
};

} // namespace rtsl::codegen
