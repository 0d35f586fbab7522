//===- ConvertToLlvm.cpp - level 2 to MLIR's LLVM dialect -----------------===//
#include "codegen/emit/patterns/ConvertToLlvm.h"

#include "codegen/emit/RuntimeFunctions.h"
#include "codegen/emit/SceneTables.h"
#include "codegen/emit/patterns/Patterns.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/ClassTable.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Separate.h"
#include "codegen/ir/Slots.h"
#include "codegen/ir/dialect/RtslDialect.h"
#include "codegen/ir/dialect/RtslOps.h"
#include "codegen/passes/ForwardPayloads.h"
#include "codegen/passes/ShareExpressions.h"
#include "runtime/device/ray/State.h"

#include "mlir/Conversion/ArithToLLVM/ArithToLLVM.h"
#include "mlir/Conversion/ControlFlowToLLVM/ControlFlowToLLVM.h"
#include "mlir/Conversion/FuncToLLVM/ConvertFuncToLLVM.h"
#include "mlir/Conversion/LLVMCommon/ConversionTarget.h"
#include "mlir/Conversion/MathToLLVM/MathToLLVM.h"
#include "mlir/Conversion/UBToLLVM/UBToLLVM.h"
#include "mlir/Conversion/VectorToLLVM/ConvertVectorToLLVM.h"
#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Dialect/UB/IR/UBOps.h"
#include "mlir/Pass/Pass.h"
#include "mlir/Pass/PassManager.h"
#include "mlir/Pass/PassRegistry.h"

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;
using mlir::LogicalResult;
using mlir::func::CallOp;
using mlir::func::FuncOp;

namespace {

//===----------------------------------------------------------------------===//
// 1. Checks for attributes that linking sets
//===----------------------------------------------------------------------===//

LogicalResult checkLinked(mlir::ModuleOp module) {
  bool isComplete = true;
  module.walk([&](mlir::Operation *op) {
    if (auto call = llvm::dyn_cast<ir::CallMethodOp>(op)) {
      call.emitError() << "`" << call.getMethod()
                       << "` is a dispatch slot that linking has not resolved";
      isComplete = false;
    } else if (auto attribute = llvm::dyn_cast<ir::AttributeOp>(op);
               attribute && !attribute.getOffset()) {
      attribute.emitError() << "attribute `" << attribute.getName()
                            << "` has no `offset`: linking has not set it";
      isComplete = false;
    } else if (auto trace = llvm::dyn_cast<ir::TracePayloadOp>(op);
               trace && (!trace.getRayType() || !trace.getHow())) {
      trace.emitError() << "the ray has no `ray_type` or `how`: linking has not numbered it";
      isComplete = false;
    } else if (llvm::isa<ir::IfOp, ir::LoopOp, ir::SwitchOp, ir::IlluminanceOp, ir::ReturnOp>(op)) {
      op->emitError() << "is of level 1; run `rtsl-to-cf` first";
      isComplete = false;
    }
  });
  return mlir::success(isComplete);
}

//===----------------------------------------------------------------------===//
// 2. Facts about the whole program
//===----------------------------------------------------------------------===//

/// Marks constructors and all functions that they call, directly or indirectly.
void markWriters(mlir::ModuleOp module) {
  llvm::SmallVector<FuncOp> worklist;
  auto mark = [&](FuncOp function) {
    if (!function || ir::attr::writesMembers.isOn(function))
      return;
    ir::attr::writesMembers.set(function);
    worklist.push_back(function);
  };
  for (FuncOp function : module.getOps<FuncOp>())
    if (ir::attr::constructor.isOn(function))
      mark(function);
  const mlir::SymbolTable symbols(module);
  while (!worklist.empty())
    worklist.pop_back_val().walk(
        [&](CallOp call) { mark(symbols.lookup<FuncOp>(call.getCallee())); });
}

void notePayloads(mlir::ModuleOp module) {
  if (module.walk([](ir::SpawnPayloadOp) { return mlir::WalkResult::interrupt(); })
          .wasInterrupted())
    ir::attr::holdsPayloads.set(module);
}

/// Records the offsets of members before the class declarations are erased.
void noteMemberOffsets(mlir::ModuleOp module) {
  const ir::ClassTable classes(module);
  mlir::Builder builder(module.getContext());
  module.walk([&](ir::MemberOp op) {
    llvm::StringRef className = llvm::cast<ir::RefType>(op.getObject().getType()).getClassName();
    const auto *member = classes.find(className, op.getMember());
    const uint32_t offset = *member->offset;
    if (ir::attr::editable.isOn(member->declaration))
      ir::attr::editable.set(op);
    ir::attr::offset.set(op, builder.getI32IntegerAttr(static_cast<int32_t>(offset)));
  });
}

//===----------------------------------------------------------------------===//
// 3. Names
//===----------------------------------------------------------------------===//

void renameFunctions(mlir::ModuleOp module) {
  mlir::MLIRContext *context = module.getContext();
  llvm::StringMap<std::string> renamed;
  for (FuncOp function : module.getOps<FuncOp>()) {
    llvm::StringRef name = function.getName();
    if (llvm::StringRef symbol = ir::finalSymbol(function); symbol != name)
      renamed[name] = symbol.str();
    else if (!ir::attr::exported.isOn(function) && !name.contains('.'))
      renamed[name] = "function." + name.str();
  }
  for (FuncOp function : module.getOps<FuncOp>())
    if (auto name = renamed.find(function.getName()); name != renamed.end())
      function.setName(name->second);
  module.walk([&](CallOp call) {
    if (auto name = renamed.find(call.getCallee()); name != renamed.end())
      call.setCalleeAttr(mlir::FlatSymbolRefAttr::get(context, name->second));
  });
}

//===----------------------------------------------------------------------===//
// 4. The state as a parameter
//===----------------------------------------------------------------------===//

/// Which other pointers may point to the same memory as a parameter.
enum class Sharing : uint8_t {
  None,     // none, while the function runs and afterwards
  Captured, // none while the function runs
  Shared,   // any
};

/// Declares that a pointer parameter is valid for `size` bytes.
void describePointer(FuncOp function, unsigned index, uint64_t size, unsigned alignment,
                     Sharing sharing) {
  mlir::Builder builder(function.getContext());
  auto set = [&](llvm::StringRef name, mlir::Attribute value) {
    function.setArgAttr(index, name, value);
  };
  set(LLVM::LLVMDialect::getNonNullAttrName(), builder.getUnitAttr());
  if (sharing != Sharing::Shared)
    set(LLVM::LLVMDialect::getNoAliasAttrName(), builder.getUnitAttr());
  if (sharing == Sharing::None)
    set(LLVM::LLVMDialect::getNoCaptureAttrName(), builder.getUnitAttr());
  set(LLVM::LLVMDialect::getAlignAttrName(), builder.getI64IntegerAttr(alignment));
  set(LLVM::LLVMDialect::getDereferenceableAttrName(), builder.getI64IntegerAttr(size));
}

void addStateParameter(mlir::ModuleOp module) {
  mlir::Type pointer = LLVM::LLVMPointerType::get(module.getContext());
  const bool pointsToFrames = ir::attr::holdsPayloads.isOn(module);
  for (FuncOp function : module.getOps<FuncOp>()) {
    bool isState = ir::attr::state.isOn(function) || ir::attr::runsStates.isOn(function);
    for (auto [index, type] : llvm::enumerate(function.getArgumentTypes()))
      if (auto address = llvm::dyn_cast<ir::PtrType>(type))
        // Arguments in memory are copies by the caller (in), temporaries (out, inout, results), or
        // a frame.
        describePointer(function, index, ir::sizeInBytes(address.getPointee()), ir::memoryAlignment,
                        isState && pointsToFrames ? Sharing::Shared : Sharing::None);
    // The runtime may store the pointer: a child ray could refer to its parent.
    (void)function.insertArgument(0, pointer, {}, function.getLoc());
    describePointer(function, 0, sizeof(RtslState), alignof(RtslState), Sharing::Captured);
  }
  for (FuncOp function : module.getOps<FuncOp>())
    function.walk([&](CallOp call) { call->insertOperands(0, {function.getArgument(0)}); });
}

//===----------------------------------------------------------------------===//
// 5. Vectors of bools as results
//===----------------------------------------------------------------------===//

/// FastISel of LLVM 22 cannot take a `<4 x i1>` from a call where the processor has AVX-512
/// (llvm-project issue 179100).
mlir::Type returnedType(mlir::Type type) {
  auto vector = llvm::dyn_cast<mlir::VectorType>(type);
  return vector && vector.getElementType().isInteger(1)
             ? vector.clone(mlir::IntegerType::get(type.getContext(), 32))
             : type;
}

void returnBoolsAsNumbers(mlir::ModuleOp module) {
  for (FuncOp function : module.getOps<FuncOp>()) {
    const mlir::FunctionType type = function.getFunctionType();
    const auto results = llvm::map_to_vector(type.getResults(), returnedType);
    function.setFunctionType(type.clone(type.getInputs(), results));
    function.walk([](mlir::func::ReturnOp op) {
      mlir::OpBuilder builder(op);
      for (mlir::OpOperand &result : op->getOpOperands())
        if (const mlir::Type returned = returnedType(result.get().getType());
            returned != result.get().getType())
          result.set(mlir::arith::ExtUIOp::create(builder, op.getLoc(), returned, result.get()));
    });
  }
  module.walk([](CallOp call) {
    mlir::OpBuilder builder(call->getContext());
    builder.setInsertionPointAfter(call);
    for (mlir::Value result : call.getResults()) {
      const mlir::Type original = result.getType();
      result.setType(returnedType(original));
      if (result.getType() == original)
        continue;
      auto bools = mlir::arith::TruncIOp::create(builder, call.getLoc(), original, result);
      result.replaceAllUsesExcept(bools, bools);
    }
  });
}

//===----------------------------------------------------------------------===//
// 6. Operations
//===----------------------------------------------------------------------===//

void declareNullRecord(mlir::ModuleOp module) {
  if (!module.walk([](ir::ClassIdOp) { return mlir::WalkResult::interrupt(); }).wasInterrupted())
    return;
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(module.getBody());
  LLVM::GlobalOp::create(builder, module.getLoc(), builder.getI32Type(), /*isConstant=*/true,
                         LLVM::Linkage::Internal, nullRecord, builder.getI32IntegerAttr(0));
}

/// One global for all tables with the same words. Later ones with the same name are numbered, `.1`
/// and so on.
void declareTables(mlir::ModuleOp module) {
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(module.getBody());
  llvm::DenseMap<mlir::Attribute, mlir::StringAttr> symbols; // by words
  mlir::SymbolTable taken(module);
  llvm::StringMap<unsigned> last; // the last number of a name
  module.walk([&](ir::TableOp table) {
    mlir::StringAttr &symbol = symbols[table.getWordsAttr()];
    if (!symbol) {
      const std::string prefix = "constant." + table.getName().str();
      std::string name = prefix;
      while (taken.lookup(name))
        name = prefix + "." + std::to_string(++last[prefix]);
      symbol = builder.getStringAttr(name);
      const auto count = static_cast<int64_t>(table.getWords().size());
      auto words = mlir::DenseIntElementsAttr::get(
          mlir::RankedTensorType::get({count}, builder.getI32Type()), table.getWords());
      auto global = LLVM::GlobalOp::create(
          builder, table.getLoc(),
          LLVM::LLVMArrayType::get(builder.getI32Type(), static_cast<unsigned>(count)),
          /*isConstant=*/true, LLVM::Linkage::Private, name, words, ir::memoryAlignment);
      global.setUnnamedAddr(LLVM::UnnamedAddr::Global);
      taken.insert(global);
    }
    ir::attr::symbol.set(table, symbol);
  });
}

LogicalResult convertOperations(mlir::ModuleOp module) {
  mlir::MLIRContext *context = module.getContext();
  mlir::LLVMTypeConverter converter(context);
  converter.addConversion(
      [](ir::RefType type) -> mlir::Type { return mlir::IntegerType::get(type.getContext(), 32); });
  converter.addConversion(
      [](ir::PtrType type) -> mlir::Type { return LLVM::LLVMPointerType::get(type.getContext()); });

  mlir::RewritePatternSet patterns(context);
  mlir::SymbolTableCollection symbols;
  addMemoryPatterns(converter, patterns);
  addRayPatterns(converter, patterns);
  addNumberPatterns(converter, patterns);
  mlir::arith::populateArithToLLVMConversionPatterns(converter, patterns);
  mlir::cf::populateControlFlowToLLVMConversionPatterns(converter, patterns);
  mlir::populateFuncToLLVMConversionPatterns(converter, patterns, &symbols);
  mlir::populateMathToLLVMConversionPatterns(converter, patterns);
  mlir::populateVectorToLLVMConversionPatterns(converter, patterns);
  mlir::ub::populateUBToLLVMConversionPatterns(converter, patterns);

  mlir::LLVMConversionTarget target(*context);
  target.addLegalOp<mlir::ModuleOp>();
  return mlir::applyFullConversion(module, target, std::move(patterns));
}

//===----------------------------------------------------------------------===//
// The pass
//===----------------------------------------------------------------------===//

struct ConvertToLlvm : mlir::PassWrapper<ConvertToLlvm, mlir::OperationPass<mlir::ModuleOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(ConvertToLlvm)
  llvm::StringRef getArgument() const override { return "rtsl-to-llvm"; }
  llvm::StringRef getDescription() const override { return "converts level 2 to the LLVM dialect"; }
  void getDependentDialects(mlir::DialectRegistry &registry) const override {
    registerLlvmDialects(registry);
  }

  void runOnOperation() override {
    mlir::ModuleOp module = getOperation();
    if (mlir::failed(checkLinked(module)))
      return signalPassFailure();
    if (!ir::attr::noted.isOn(module))
      noteWholeProgram(module);
    for (auto classOp : llvm::make_early_inc_range(module.getOps<ir::ClassOp>()))
      classOp.erase(); // a function of the runtime may have its name
    renameFunctions(module);
    addStateParameter(module);
    returnBoolsAsNumbers(module);
    declareRuntimeFunctions(module);
    declareNullRecord(module);
    declareTables(module);
    defineSceneTables(module);
    if (mlir::failed(convertOperations(module)))
      return signalPassFailure();
    for (auto function : module.getOps<LLVM::LLVMFuncOp>())
      finish(function);
    ir::attr::records.removeFrom(module);
    ir::attr::instances.removeFrom(module);
    ir::attr::emitters.removeFrom(module);
    ir::attr::wholeEmitters.removeFrom(module);
    ir::attr::listedBoxes.removeFrom(module);
    ir::attr::listedPairs.removeFrom(module);
    ir::attr::noted.removeFrom(module);
    ir::attr::holdsPayloads.removeFrom(module);
  }

  /// Attributes of every function: it throws nothing. Our own attributes are removed.
  static void finish(LLVM::LLVMFuncOp function) {
    function.setNoUnwind(true);
    if (ir::attr::separate.isOn(function))
      function.setNoInline(true);
    llvm::SmallVector<mlir::StringAttr> ours;
    for (mlir::NamedAttribute attribute : function->getDiscardableAttrs())
      if (attribute.getName().strref().starts_with("rtsl."))
        ours.push_back(attribute.getName());
    for (mlir::StringAttr name : ours)
      function->removeAttr(name);
  }
};

} // namespace

void noteWholeProgram(mlir::ModuleOp module) {
  markWriters(module);
  notePayloads(module);
  noteMemberOffsets(module);
  ir::attr::noted.set(module);
}

std::unique_ptr<mlir::Pass> createConvertToLlvmPass() {
  return std::make_unique<ConvertToLlvm>();
}

void registerLlvmDialects(mlir::DialectRegistry &registry) {
  registry.insert<LLVM::LLVMDialect, mlir::arith::ArithDialect, mlir::ub::UBDialect>();
}

void buildLlvmPipeline(mlir::OpPassManager &module) {
  module.nest<mlir::func::FuncOp>().addPass(createForwardPayloadsPass());
  module.addPass(createConvertToLlvmPass());
  module.addPass(createShareExpressionsPass());
}

void registerLlvmPasses() {
  mlir::registerPass(createConvertToLlvmPass);
  mlir::PassPipelineRegistration<>("rtsl-llvm", "level 2 to the LLVM dialect", buildLlvmPipeline);
}

} // namespace rtsl::codegen
