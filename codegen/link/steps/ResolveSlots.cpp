//===- ResolveSlots.cpp - dispatch of methods by class --------------------===//
//
//   %c = rtsl.call_method "weight" on %t(%x) : !rtsl.ref<"rt_Texture">, (f32) -> f32
// becomes a call of
//   func.func private @dispatch.rt_Texture.weight(%object, %x) -> f32
// which switches over the classes derived from rt_Texture that the scene uses; with one class it is
// a direct call. Where it is known that a member refers only to some of them
// (ReferredClasses.cpp), the function is @dispatch.Painted.pattern.weight.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Separate.h"
#include "codegen/link/steps/Steps.h"
#include "sema/typed/Analysis.h"

namespace rtsl::linking {

namespace {

/// Calls the method of one class and returns its results.
void buildCall(mlir::OpBuilder &builder, const LinkedClass &linked, mlir::func::FuncOp target,
               mlir::func::FuncOp function) {
  const mlir::Location location = function.getLoc();
  mlir::Block &entry = function.getBody().front();
  llvm::SmallVector<mlir::Value> arguments(entry.getArguments().begin(),
                                           entry.getArguments().end());
  const auto exact = ir::RefType::get(builder.getContext(), linked.info->name);
  if (arguments.front().getType() != exact)
    arguments.front() = ir::CastRefOp::create(builder, location, exact, arguments.front());
  auto call = mlir::func::CallOp::create(builder, location, target, arguments);
  ir::ReturnOp::create(builder, location, call.getResults());
}

void buildZeroReturn(mlir::OpBuilder &builder, mlir::func::FuncOp function) {
  llvm::SmallVector<mlir::Value> zeros;
  for (mlir::Type type : function.getResultTypes())
    zeros.push_back(ir::createZero(builder, function.getLoc(), type));
  ir::ReturnOp::create(builder, function.getLoc(), zeros);
}

} // namespace

bool derivesFrom(const typed::Class &info, llvm::StringRef base) {
  if (info.root == base)
    return true;
  for (const typed::Class *at = &info; at; at = at->base)
    if (at->name == base)
      return true;
  return false;
}

Finding describeDispatch(const std::string &subject,
                         const std::vector<const LinkedClass *> &classes,
                         const ir::SourcePlace &place, bool mayBeNone) {
  std::string names;
  for (const LinkedClass *linked : classes)
    names += (names.empty() ? "`" : ", `") + linked->info->name + "`";
  const bool isNeeded = classes.size() > 1 || mayBeNone;
  return {Item::Dispatch, subject, isNeeded,
          classes.size() > 1 ? "one of " + names
          : mayBeNone        ? names + ", or no object"
                             : "always " + names + ", called directly",
          place};
}

mlir::func::FuncOp findMethod(const LinkContext &context, const LinkedClass &linked,
                              const std::string &method) {
  return context.function(linked.info->name + "." + method);
}

void makeEmpty(mlir::func::FuncOp function) {
  function.getBody().dropAllReferences();
  function.getBody().getBlocks().clear();
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(function.addEntryBlock());
  buildZeroReturn(builder, function);
}

void buildDispatch(const LinkContext &context, mlir::func::FuncOp function,
                   const std::string &subject, const std::vector<const LinkedClass *> &classes,
                   const std::string &method, bool mayBeNone) {
  if ((classes.size() > 1 || mayBeNone) && context.isWithout(Item::Dispatch, subject))
    return buildDispatch(context, function, subject, {classes.front()}, method, false);
  std::vector<std::pair<const LinkedClass *, mlir::func::FuncOp>> targets;
  for (const LinkedClass *linked : classes)
    if (mlir::func::FuncOp target = findMethod(context, *linked, method))
      targets.push_back({linked, target});
  if (llvm::any_of(targets,
                   [](const auto &target) { return ir::attr::inLookup.isOn(target.second); }))
    ir::attr::inLookup.set(function);

  mlir::Block *entry = function.addEntryBlock();
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(entry);
  const bool oneForAll = targets.size() == 1 && classes.size() == 1;
  if (oneForAll && !mayBeNone && !context.request.keep.has(Item::Dispatch)) {
    buildCall(builder, *targets.front().first, targets.front().second, function);
    return;
  }
  ir::keepSeparateIfMany(llvm::to_vector(llvm::make_second_range(targets)));
  if (!targets.empty()) {
    const mlir::Value id = ir::ClassIdOp::create(builder, function.getLoc(), entry->getArgument(0));
    llvm::SmallVector<llvm::SmallVector<std::int32_t>> values;
    for (const auto &target : targets)
      values.push_back({static_cast<std::int32_t>(target.first->id)});
    auto choice = ir::SwitchOp::create(builder, function.getLoc(), id, values, std::nullopt);
    for (auto [target, arm] : llvm::zip(targets, choice.getArms())) {
      mlir::OpBuilder inArm = mlir::OpBuilder::atBlockEnd(&arm.front());
      buildCall(inArm, *target.first, target.second, function);
    }
  }
  buildZeroReturn(builder, function);
}

SlotCall slotOf(ir::CallMethodOp call) {
  return {llvm::cast<ir::RefType>(call.getObject().getType()).getClassName().str(),
          call.getMethod().str()};
}

void replaceSlots(mlir::ModuleOp ir, mlir::SymbolTable &symbols,
                  llvm::function_ref<std::string(ir::CallMethodOp)> nameOf,
                  llvm::function_ref<void(ir::CallMethodOp, mlir::func::FuncOp)> define) {
  llvm::SmallVector<ir::CallMethodOp> calls;
  ir.walk([&](ir::CallMethodOp call) { calls.push_back(call); });

  std::map<std::pair<SlotCall, std::string>, mlir::func::FuncOp> functions;
  for (ir::CallMethodOp call : calls) {
    llvm::SmallVector<mlir::Value> arguments = {call.getObject()};
    llvm::append_range(arguments, call.getArguments());
    const std::string name = nameOf(call);
    mlir::func::FuncOp &function = functions[{slotOf(call), name}];
    if (!function) {
      mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(ir.getBody());
      function = mlir::func::FuncOp::create(
          builder, call.getLoc(), "dispatch." + name,
          builder.getFunctionType(mlir::ValueRange(arguments).getTypes(), call.getResultTypes()));
      ir::attr::dispatch.set(function);
      symbols.insert(function);
      define(call, function);
    }
    mlir::OpBuilder builder(call);
    auto direct = mlir::func::CallOp::create(builder, call.getLoc(), function, arguments);
    call.replaceAllUsesWith(direct.getResults());
    call.erase();
  }
}

namespace {

/// The calls of a slot that may reach objects of the same classes.
struct Choice {
  std::vector<const LinkedClass *> classes;
  bool mayBeNone = false; // then the function does nothing and returns zero
  /// The slot's name, or if calls of the slot differ in what they may reach, and it is known for
  /// these: the name of the first member that they go through, and the method's.
  std::string name;
};

class Choices {
public:
  explicit Choices(LinkContext &context)
      : context(context), anyMayBeNone(typed::mayReferToNothing(context.module)) {
    const auto referred = referredClasses(context);
    mlir::ModuleOp(context.ir).walk([&](ir::CallMethodOp call) { add(call, referred.at(call)); });
    for (auto &[slot, ofSlot] : bySlot)
      if (ofSlot.size() == 1)
        ofSlot.begin()->second.name = slot.name();
  }

  const Choice &of(ir::CallMethodOp call) const {
    return bySlot.at(slotOf(call)).at(keys.at(call));
  }

private:
  using Key = std::pair<std::vector<std::uint32_t>, bool>; // class ids, mayBeNone

  void add(ir::CallMethodOp call, const Referred &objects) {
    const SlotCall slot = slotOf(call);
    auto [ofSlot, isFirst] = bySlot.try_emplace(slot);
    if (isFirst)
      reportUnfilled(slot);
    Choice choice{{}, anyMayBeNone && objects.mayBeNone, slot.name()};
    if (objects.isKnown())
      choice.name = objects.member + "." + slot.method;
    Key key{{}, choice.mayBeNone};
    for (const LinkedClass &linked : context.classes)
      if (linked.isUsed && derivesFrom(*linked.info, slot.base) &&
          (!objects.isKnown() || objects.classes.count(linked.info->name))) {
        choice.classes.push_back(&linked);
        key.first.push_back(linked.id);
      }
    Choice &known = ofSlot->second.try_emplace(key, choice).first->second;
    if (!objects.isKnown())
      known.name = slot.name();
    keys[call] = std::move(key);
  }

  /// Reports objects that have no such method.
  void reportUnfilled(const SlotCall &slot) {
    for (const LinkedClass &linked : context.classes)
      if (context.hasScene && linked.hasObjects && derivesFrom(*linked.info, slot.base) &&
          !findMethod(context, linked, slot.method))
        context.diagnostics.report(Code::slotNotFilled, linked.info->range, slot.method,
                                   linked.info->name);
  }

  LinkContext &context;
  const bool anyMayBeNone;
  std::map<SlotCall, std::map<Key, Choice>> bySlot;
  llvm::DenseMap<mlir::Operation *, Key> keys;
};

} // namespace

void resolveSlots(LinkContext &context) {
  const Choices choices(context);
  replaceSlots(
      context.ir, context.symbols, [&](ir::CallMethodOp call) { return choices.of(call).name; },
      [&](ir::CallMethodOp call, mlir::func::FuncOp function) {
        const Choice &choice = choices.of(call);
        if (!choice.classes.empty())
          context.dispatches[function.getSymName().str()] = describeDispatch(
              choice.name, choice.classes, ir::placeOf(function.getLoc()), choice.mayBeNone);
        buildDispatch(context, function, choice.name, choice.classes, slotOf(call).method,
                      choice.mayBeNone);
      });
}

} // namespace rtsl::linking
