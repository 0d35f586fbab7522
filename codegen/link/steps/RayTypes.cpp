//===- RayTypes.cpp - payload types and the methods for them --------------===//
//
// The type of a payload is the type of its ray. The types that a scene traces get numbers, which a
// ray carries, and for each it is determined how to search for hits:
//
// - no material has `closestHit` for the type: any hit will do, and the first one ends the search;
// - some material has `anyHit`: hits may be refused. The order in which the methods run must not be
//   visible. It is not if they do not write the payload, draw no random numbers, raise no
//   exceptions, and do not end the search before the nearest hit where that is needed. Nor is it if
//   each of them either refuses, or writes the same constants and ends the search, and no
//   `closestHit` follows. In all other cases they run in the order of hits.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/MemoryAccesses.h"
#include "codegen/ir/Slots.h"
#include "codegen/link/CallGraph.h"
#include "codegen/link/steps/Steps.h"

#include "runtime/device/ray/Abi.h"
#include "sema/typed/Analysis.h"

#include "mlir/IR/Matchers.h"

#include <algorithm>
#include <set>

namespace rtsl::linking {

namespace {

using mlir::func::FuncOp;

/// The methods of this name that the classes of the program define for a payload.
std::vector<FuncOp> methodsFor(const LinkContext &context, const RayType &type,
                               const std::string &method) {
  std::vector<FuncOp> programs;
  for (const LinkedClass &linked : context.classes)
    if (FuncOp program =
            linked.isMet ? findMethod(context, linked, method + "." + type.name()) : FuncOp())
      programs.push_back(program);
  return programs;
}

//===----------------------------------------------------------------------===//
// Visibility of the order of hits
//===----------------------------------------------------------------------===//

/// The effects of the `anyHit` methods for one type of ray.
struct AnyHitEffects {
  bool writes = false, reads = false; // the payload
  bool draws = false;                 // random numbers, ends samples, or has unknown effects
  bool terminates = false;
};

bool hasKind(const std::set<ir::MemoryLocation> &locations, ir::MemoryLocation::Kind kind) {
  return std::any_of(locations.begin(), locations.end(),
                     [&](const ir::MemoryLocation &location) { return location.kind == kind; });
}

/// A function that gets the address of the payload may read and write it. In that function, whose
/// argument it is, it is not counted again.
AnyHitEffects effectsOf(const std::vector<FuncOp> &functions) {
  using Kind = ir::MemoryLocation::Kind;
  AnyHitEffects effects;
  for (FuncOp function : functions) {
    const ir::MemoryAccesses accesses = ir::accessesOf(function);
    effects.reads |= hasKind(accesses.reads, Kind::Payload);
    effects.writes |= hasKind(accesses.writes, Kind::Payload);
    effects.draws |= function.isExternal() || hasKind(accesses.writes, Kind::Random);
    function.walk([&](mlir::Operation *op) {
      if (auto call = llvm::dyn_cast<mlir::func::CallOp>(op)) {
        const bool getsPayload = llvm::any_of(call.getOperands(), [](mlir::Value operand) {
          return ir::locationOf(operand).kind == Kind::Payload;
        });
        effects.reads |= getsPayload;
        effects.writes |= getsPayload;
      } else if (auto answer = llvm::dyn_cast<ir::AnswerHitOp>(op)) {
        effects.terminates |= answer.getAnswer() == ir::HitAnswer::Terminate;
      } else if (llvm::isa<ir::PrintOp, ir::RaiseOp, ir::CallMethodOp>(op)) {
        effects.draws = true;
      }
    });
  }
  return effects;
}

/// "field.element..." of an address in the payload with constant indices; empty otherwise.
std::string pathInPayload(mlir::Value address) {
  if (auto field = address.getDefiningOp<ir::FieldOp>()) {
    if (field.getBase().getDefiningOp<ir::PayloadOp>())
      return field.getField().str();
    const std::string base = pathInPayload(field.getBase());
    return base.empty() ? base : base + "." + field.getField().str();
  }
  if (auto element = address.getDefiningOp<ir::ElementOp>(); element && element.constantIndex()) {
    const std::string base = pathInPayload(element.getBase());
    return base.empty() ? base : base + "." + std::to_string(*element.constantIndex());
  }
  return {};
}

using ConstantStores = std::map<std::string, mlir::Attribute>;

/// Whether each path through the method ends in a refusal without stores, or ends the search after
/// these stores of constants (all of them before the answer, in its block). The first method fills
/// in `stores`.
bool endsAlike(FuncOp anyHit, std::optional<ConstantStores> &stores) {
  bool isAlike = true;
  anyHit.walk([&](ir::ReturnOp end) {
    auto answer = llvm::dyn_cast_or_null<ir::AnswerHitOp>(end->getPrevNode());
    isAlike &= static_cast<bool>(answer);
  });
  anyHit.walk([&](ir::StoreOp store) {
    if (pathInPayload(store.getAddress()).empty())
      return;
    auto end = llvm::dyn_cast<ir::ReturnOp>(store->getBlock()->back());
    auto answer =
        end ? llvm::dyn_cast_or_null<ir::AnswerHitOp>(end->getPrevNode()) : ir::AnswerHitOp();
    isAlike &= answer && answer.getAnswer() == ir::HitAnswer::Terminate;
  });
  anyHit.walk([&](ir::AnswerHitOp answer) {
    if (answer.getAnswer() != ir::HitAnswer::Terminate)
      return;
    ConstantStores here;
    for (ir::StoreOp store : answer->getBlock()->getOps<ir::StoreOp>()) {
      const std::string path = pathInPayload(store.getAddress());
      mlir::Attribute value;
      if (path.empty())
        continue;
      isAlike &= mlir::matchPattern(store.getValue(), mlir::m_Constant(&value));
      here[path] = value;
    }
    if (!stores)
      stores = here;
    isAlike &= here == *stores;
  });
  return isAlike;
}

/// Whether all writes of the payload are such stores, and every material has an `anyHit`.
bool writesHideOrder(const LinkContext &context, const std::vector<FuncOp> &anyHits) {
  const auto materials =
      std::count_if(context.classes.begin(), context.classes.end(), [](const LinkedClass &linked) {
        return linked.isMet && linked.info->root == "rt_Material";
      });
  if (static_cast<std::size_t>(materials) != anyHits.size())
    return false; // some material accepts without writing
  std::optional<ConstantStores> stores;
  for (FuncOp anyHit : anyHits) {
    bool isSimple = true; // only stores of whole parts write
    anyHit.walk([&](mlir::Operation *op) {
      if (llvm::isa<ir::CopyOp, ir::ClearOp, mlir::func::CallOp>(op))
        for (mlir::Value operand : op->getOperands())
          isSimple &= !operand.getDefiningOp<ir::PayloadOp>() && pathInPayload(operand).empty();
      if (auto element = llvm::dyn_cast<ir::ElementOp>(op))
        isSimple &= element.constantIndex().has_value() || pathInPayload(element.getBase()).empty();
    });
    if (!isSimple || !endsAlike(anyHit, stores))
      return false;
  }
  return true;
}

bool isOrderVisible(const LinkContext &context, const std::vector<FuncOp> &anyHits,
                    bool hasClosestHit) {
  const AnyHitEffects effects = effectsOf(reachedFrom(anyHits, context.symbols));
  if (effects.draws || (effects.terminates && hasClosestHit))
    return true;
  if (!effects.writes)
    return false;
  return hasClosestHit || effects.reads || !writesHideOrder(context, anyHits);
}

//===----------------------------------------------------------------------===//
// Rays that no class handles
//===----------------------------------------------------------------------===//

/// The methods that a default class requires of a class: its own and those of its bases, without
/// those that it defines.
std::set<std::string> requiredBy(const typed::Class *definition) {
  std::set<std::string> names, defined;
  for (; definition; definition = definition->base)
    for (const auto &method : definition->functions)
      if (!method->isRequired)
        defined.insert(method->name);
      else if (!defined.count(method->name))
        names.insert(method->name);
  return names;
}

bool handles(const typed::Class *definition, const RayType &type) {
  const auto isHandler = [&](const auto &method) {
    return typed::takesPayload(*method) &&
           method->parameters.front()->type->structure->name == type.name();
  };
  for (; definition; definition = definition->base)
    if (llvm::any_of(definition->functions, isHandler))
      return true;
  return false;
}

/// Whether a default class that derives from this one defines what this one requires: then this is
/// a base of default classes only.
bool isOnlyBase(const LinkContext &context, const typed::Class &definition) {
  const std::set<std::string> names = requiredBy(&definition);
  return llvm::any_of(context.module.classes, [&](const auto &other) {
    const std::set<std::string> left = requiredBy(other.get()); // none of an author's class
    return !left.empty() && other->derivesFrom(&definition) &&
           !std::includes(left.begin(), left.end(), names.begin(), names.end());
  });
}

/// What a material has to define so that a default class handles rays of this type for it: any of
/// these sets of methods. None of them contains another one.
std::vector<std::set<std::string>> requirementsFor(const LinkContext &context,
                                                   const RayType &type) {
  std::vector<std::set<std::string>> all, smallest;
  for (const auto &definition : context.module.classes)
    if (const std::set<std::string> names = requiredBy(definition.get());
        !names.empty() && definition->root == "rt_Material" && handles(definition.get(), type) &&
        !isOnlyBase(context, *definition) && !llvm::is_contained(all, names))
      all.push_back(names);
  llvm::copy_if(all, std::back_inserter(smallest), [&](const std::set<std::string> &one) {
    return llvm::none_of(all, [&](const std::set<std::string> &other) {
      return other != one && std::includes(one.begin(), one.end(), other.begin(), other.end());
    });
  });
  return smallest;
}

/// "`sampleBSDF`, nor `shade`"
std::string asText(const std::vector<std::set<std::string>> &alternatives) {
  std::string text;
  for (const std::set<std::string> &names : alternatives) {
    text += text.empty() ? "" : ", nor ";
    for (const std::string &name : names)
      text += (name == *names.begin() ? "`" : " and `") + name + "`";
  }
  return text;
}

/// Reports the materials that rays of this type may hit, although neither the author nor a default
/// class handles that, and a type that is handled nowhere.
void reportUnanswered(const LinkContext &context, const RayType &type) {
  const typed::Struct *payload = structOf(context, type);
  if (!context.hasScene || !payload)
    return;
  bool isAnswered = !methodsFor(context, type, "miss").empty();
  const std::vector<std::set<std::string>> requirements = requirementsFor(context, type);
  for (const LinkedClass &linked : context.classes) {
    // No object is of a default class, which is used if all classes are kept.
    if (!linked.isMet || linked.info->root != "rt_Material" || !requiredBy(linked.info).empty())
      continue;
    const bool isHandled = findMethod(context, linked, "closestHit." + type.name()) ||
                           findMethod(context, linked, "anyHit." + type.name());
    isAnswered |= isHandled || !requirements.empty();
    if (!isHandled && !requirements.empty())
      context.diagnostics.report(Code::materialUnanswered, linked.info->range, payload->name,
                                 linked.info->name, asText(requirements));
  }
  if (!isAnswered)
    context.diagnostics.report(Code::rayTypeUnanswered, payload->range, payload->name);
}

//===----------------------------------------------------------------------===//
// Numbers of types
//===----------------------------------------------------------------------===//

/// How rtsl_traverse must search for hits of rays of this type.
std::uint32_t searchFor(LinkContext &context, const RayType &type) {
  const bool hasClosestHit = !methodsFor(context, type, "closestHit").empty();
  const std::vector<FuncOp> anyHits = methodsFor(context, type, "anyHit");
  reportUnanswered(context, type);
  std::uint32_t how = hasClosestHit ? 0 : RTSL_FIRST_HIT;
  if (!anyHits.empty())
    how |=
        RTSL_INVOKE_ANY_HIT | (isOrderVisible(context, anyHits, hasClosestHit) ? RTSL_IN_ORDER : 0);
  return how;
}

/// @rtsl_rt_Material_closestHit_payload(%object): runs the method for the ray's type, of the
/// object's class.
void makePayloadSlot(LinkContext &context, const std::string &base, const std::string &method) {
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(context.ir.getBody());
  const mlir::Location location = builder.getUnknownLoc();
  const mlir::Type object = ir::RefType::get(builder.getContext(), base);
  auto create = [&](const std::string &name) {
    builder.setInsertionPointToEnd(context.ir.getBody());
    auto function = FuncOp::create(builder, location, name, builder.getFunctionType({object}, {}));
    ir::insertForRuntime(context.symbols, function);
    return function;
  };
  std::vector<const LinkedClass *> classes;
  for (const LinkedClass &linked : context.classes)
    if (linked.isMet && linked.info->root == base)
      classes.push_back(&linked);

  std::vector<FuncOp> targets;
  llvm::SmallVector<llvm::SmallVector<std::int32_t>> numbers;
  for (const RayType &type : context.rayTypes) {
    if (methodsFor(context, type, method).empty())
      continue;
    const std::string ofType = method + "." + type.name();
    FuncOp target = create("dispatch." + base + "." + ofType);
    ir::attr::dispatch.set(target);
    target.setPrivate();
    buildDispatch(context, target, base + "." + ofType, classes, ofType);
    targets.push_back(target);
    numbers.push_back({static_cast<std::int32_t>(type.number)});
  }

  const std::string name = ir::slotName(base, method, /*takesPayload=*/true);
  FuncOp slot = create(ir::slotSymbol(name));
  ir::attr::slot.set(slot, builder.getStringAttr(name));
  mlir::Block *entry = slot.addEntryBlock();
  builder.setInsertionPointToEnd(entry);
  auto call = [&](mlir::OpBuilder &at, FuncOp target) {
    mlir::func::CallOp::create(at, location, target, mlir::ValueRange(entry->getArguments()));
    ir::ReturnOp::create(at, location, mlir::ValueRange());
  };
  if (targets.size() == 1 && context.rayTypes.size() == 1) {
    call(builder, targets.front());
  } else {
    if (!targets.empty()) {
      const mlir::Value number = ir::RayTypeOp::create(builder, location, builder.getI32Type());
      auto choice = ir::SwitchOp::create(builder, location, number, numbers, std::nullopt);
      for (auto [target, arm] : llvm::zip(targets, choice.getArms())) {
        mlir::OpBuilder inArm = mlir::OpBuilder::atBlockEnd(&arm.front());
        call(inArm, target);
      }
    }
    ir::ReturnOp::create(builder, location, mlir::ValueRange());
  }
  ir::attr::exported.set(slot);
}

} // namespace

/// The ray type of this payload; assigns the next number if it has none.
static RayType &rayTypeOf(mlir::Type payload, std::vector<RayType> &types) {
  const auto structure = llvm::cast<ir::StructType>(payload);
  const auto known = std::find_if(types.begin(), types.end(),
                                  [&](const RayType &type) { return type.payload == structure; });
  if (known != types.end())
    return *known;
  return types.emplace_back(RayType{structure, static_cast<std::uint32_t>(types.size()) + 1, 0});
}

const typed::Struct *structOf(const LinkContext &context, const RayType &type) {
  for (const auto &candidate : context.module.structs)
    if (candidate->name == type.name())
      return candidate.get();
  return nullptr;
}

std::vector<RayType> numberRayTypes(mlir::ModuleOp ir) {
  std::vector<RayType> types;
  auto number = [&](auto ray) {
    const auto payload = llvm::cast<ir::PtrType>(ray.getPayload().getType()).getPointee();
    ray.setRayType(rayTypeOf(payload, types).number);
    ray.setHow(RTSL_INVOKE_ANY_HIT | RTSL_IN_ORDER); // correct for any scene
  };
  ir.walk([&](mlir::Operation *op) {
    if (auto trace = llvm::dyn_cast<ir::TracePayloadOp>(op))
      number(trace);
    else if (auto spawn = llvm::dyn_cast<ir::SpawnPayloadOp>(op))
      number(spawn);
  });
  return types;
}

/// Adds the types that have methods but are not traced. Only their names are used.
static void addAnsweredTypes(LinkContext &context) {
  for (const auto &definition : context.module.classes)
    for (const auto &method : definition->functions) {
      if (!typed::takesPayload(*method))
        continue;
      const std::string &name = method->parameters.front()->type->structure->name;
      if (std::none_of(context.rayTypes.begin(), context.rayTypes.end(),
                       [&](const RayType &type) { return type.name() == name; }))
        rayTypeOf(ir::StructType::get(context.ir.getContext(), name, {}, {}), context.rayTypes);
    }
}

void resolveRayTypes(LinkContext &context) {
  context.rayTypes = numberRayTypes(context.ir);
  if (!context.hasScene)
    addAnsweredTypes(context);
  for (RayType &type : context.rayTypes)
    type.search = searchFor(context, type);
  context.ir.walk([&](ir::TracePayloadOp trace) {
    trace.setHow(context.rayTypes[*trace.getRayType() - 1].search);
  });
}

void makePayloadSlots(LinkContext &context) {
#define RTSL_PAYLOAD_SLOT(base, method) makePayloadSlot(context, #base, #method);
#include "language/PayloadSlots.def"
}

std::uint32_t anyHitTypes(const LinkContext &context, const LinkedClass &material) {
  std::uint32_t types = 0;
  for (const RayType &type : context.rayTypes)
    if (findMethod(context, material, "anyHit." + type.name()))
      types |= rtslRayTypeBit(type.number);
  return types;
}

} // namespace rtsl::linking
