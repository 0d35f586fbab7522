// What is saved over the traces of small shaders against the optimum. The checker makes a shader
// out of its own description, so it does not depend on liveness, dominance or flows: it tries every
// set of saved values at every trace, over all traces together.
#include "codegen/passes/Pipeline.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/continuation/save/MinimumCut.h"
#include "codegen/passes/continuation/save/Steps.h"
#include "codegen/passes/continuation/suspend/Steps.h"

#include "mlir/IR/MLIRContext.h"
#include "mlir/Parser/Parser.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

using namespace rtsl;
using namespace rtsl::continuation;

namespace {

/// A value of a shader without branches. Costs are those that docs/continuations.md states.
struct Node {
  std::string text;               // what makes it; empty: a trace brought it back
  std::vector<unsigned> operands; // earlier nodes
  std::int64_t save, recompute;
  unsigned segment = 0; // how many traces stand before it
  // after traces with this number or a later one it cannot be rematerialised
  unsigned lostAfter = ~0u;
};

struct Shader {
  std::vector<Node> nodes;
  unsigned traces = 0;
  std::string text;
  /// The nodes that the code between two traces asks for, by that segment: operands of what stands
  /// there.
  std::vector<std::set<unsigned>> asked;
};

class Maker {
public:
  explicit Maker(unsigned seed) : random(seed) {}
  Shader make(unsigned traces);

private:
  unsigned below(unsigned bound) { return unsigned(random() % bound); }
  unsigned add(const std::string &text, std::vector<unsigned> operands, std::int64_t save,
               std::int64_t recompute);
  /// A float that is there already; some are asked for often.
  unsigned anyFloat() {
    return floats[below(2) ? below(unsigned(floats.size())) : unsigned(floats.size()) - 1];
  }
  void addFloat();
  void addTrace();

  std::mt19937 random;
  Shader shader;
  std::vector<unsigned> floats;
  std::vector<unsigned> stateLoads; // of SampleColor, since it was written last
};

unsigned Maker::add(const std::string &text, std::vector<unsigned> operands, std::int64_t save,
                    std::int64_t recompute) {
  const unsigned index = unsigned(shader.nodes.size());
  for (unsigned operand : operands)
    if (shader.nodes[operand].segment < shader.traces)
      shader.asked[shader.traces].insert(operand);
  shader.nodes.push_back({text, std::move(operands), save, recompute, shader.traces});
  if (!text.empty())
    shader.text += fmt::format("  %n{0} = {1} loc(\"n{0}\")\n", index, text);
  return index;
}

void Maker::addFloat() {
  const unsigned a = anyFloat(), b = anyFloat();
  const unsigned next = unsigned(shader.nodes.size());
  switch (below(9)) {
  case 0:
    floats.push_back(add("rtsl.rand", {}, 16, impossible));
    break;
  case 1:
    floats.push_back(add(fmt::format("arith.divf %n{}, %n{} : f32", a, b), {a, b}, 16, 8));
    break;
  case 2:
    floats.push_back(add(fmt::format("rtsl.elementary <sin> %n{} : f32", a), {a}, 16, 40));
    break;
  case 3:
    shader.text += fmt::format(
        "  %p{} = rtsl.member %self[\"m\"] : !rtsl.ref<\"M\"> -> !rtsl.ptr<f32> loc(\"p\")\n",
        next);
    floats.push_back(add(fmt::format("rtsl.load %p{} : !rtsl.ptr<f32>", next), {}, 16, 2));
    break;
  case 4: { // of the ray's state, which a store may change
    shader.text += fmt::format(
        "  %p{} = rtsl.state \"SampleColor\" : !rtsl.ptr<vector<3xf32>> loc(\"p\")\n", next);
    const unsigned whole =
        add(fmt::format("rtsl.load %p{} : !rtsl.ptr<vector<3xf32>>", next), {}, 48, 12);
    stateLoads.push_back(whole);
    floats.push_back(
        add(fmt::format("vector.extract %n{}[1] : f32 from vector<3xf32>", whole), {whole}, 16, 0));
    break;
  }
  case 5: {
    const unsigned whole =
        add(fmt::format("vector.from_elements %n{}, %n{}, %n{} : vector<3xf32>", a, b, a), {a, b},
            48, 0);
    const unsigned root =
        add(fmt::format("math.sqrt %n{} : vector<3xf32>", whole), {whole}, 48, 24);
    floats.push_back(
        add(fmt::format("vector.extract %n{}[0] : f32 from vector<3xf32>", root), {root}, 16, 0));
    break;
  }
  default:
    floats.push_back(add(fmt::format("arith.addf %n{}, %n{} : f32", a, b), {a, b}, 16, 1));
    break;
  }
}

void Maker::addTrace() {
  const unsigned number = shader.traces;
  if (below(4) == 0) {
    const unsigned color = anyFloat();
    const unsigned whole =
        add(fmt::format("vector.broadcast %n{} : f32 to vector<3xf32>", color), {color}, 48, 0);
    shader.text +=
        fmt::format("  %s{0} = rtsl.state \"SampleColor\" : !rtsl.ptr<vector<3xf32>> loc(\"p\")\n"
                    "  rtsl.store %n{1}, %s{0} : !rtsl.ptr<vector<3xf32>>\n",
                    number, whole);
    for (unsigned load : stateLoads)
      shader.nodes[load].lostAfter = number;
    stateLoads.clear();
  }
  shader.text += fmt::format("  %d{0} = arith.constant dense<1.0> : vector<3xf32>\n"
                             "  %n{1} = rtsl.trace %d{0}, %d{0} : vector<3xf32> loc(\"n{1}\")\n",
                             number, shader.nodes.size());
  ++shader.traces;
  shader.asked.emplace_back();
  const unsigned whole = add("", {}, 48, impossible);
  floats.push_back(
      add(fmt::format("vector.extract %n{}[2] : f32 from vector<3xf32>", whole), {whole}, 16, 0));
}

Shader Maker::make(unsigned traces) {
  shader.asked.emplace_back();
  floats.push_back(add("rtsl.rand", {}, 16, impossible));
  for (unsigned trace = 0; trace <= traces; ++trace) {
    for (unsigned count = trace == traces ? 2 : 1 + below(traces == 1 ? 5 : 3); count-- > 0;)
      addFloat();
    if (trace < traces)
      addTrace();
  }
  shader.text =
      "rtsl.class @M root \"rt_Material\" {\n  rtsl.member_decl @m : f32 access \"public\"\n}\n"
      "func.func @f(%self: !rtsl.ref<\"M\">) {\n" +
      shader.text + "  return\n}\n";
  return shader;
}

/// The cost of a trace that saves this set, with what must be there after it; `impossible` if
/// that cannot be.
std::int64_t costAt(const Shader &shader, unsigned trace, unsigned saved, unsigned needed) {
  std::int64_t cost = 0;
  for (unsigned v = unsigned(shader.nodes.size()); v-- > 0;) { // operands have smaller numbers
    const Node &node = shader.nodes[v];
    if (saved >> v & 1) {
      cost += node.save;
    } else if (needed >> v & 1) {
      if (node.recompute >= impossible || trace >= node.lostAfter)
        return impossible;
      cost += node.recompute;
      for (unsigned operand : node.operands)
        needed |= 1u << operand;
    }
  }
  return cost;
}

unsigned madeBefore(const Shader &shader, unsigned trace) {
  unsigned set = 0;
  for (unsigned v = 0; v < shader.nodes.size(); ++v)
    if (shader.nodes[v].segment <= trace)
      set |= 1u << v;
  return set;
}

/// What must be there after a trace if the next one saves this set.
unsigned neededBehind(const Shader &shader, unsigned trace, unsigned savedNext) {
  unsigned needed = savedNext;
  for (unsigned v : shader.asked[trace + 1])
    needed |= 1u << v;
  return needed & madeBefore(shader, trace);
}

/// The least cost of the traces up to this one, by what the next one saves.
std::int64_t cheapest(const Shader &shader, unsigned trace, unsigned savedNext,
                      std::map<std::pair<unsigned, unsigned>, std::int64_t> &known) {
  const unsigned needed = neededBehind(shader, trace, savedNext),
                 candidates = madeBefore(shader, trace);
  auto [at, isNew] = known.try_emplace({trace, needed}, impossible);
  if (!isNew)
    return at->second;
  std::int64_t best = impossible;
  for (unsigned set = candidates;; set = (set - 1) & candidates) { // each subset
    const std::int64_t own = costAt(shader, trace, set, needed);
    if (own < best) {
      const std::int64_t before = trace == 0 ? 0 : cheapest(shader, trace - 1, set, known);
      best = std::min(best, own + before);
    }
    if (set == 0)
      break;
  }
  return known[{trace, needed}] = best;
}

unsigned setOf(llvm::ArrayRef<mlir::Value> values) {
  unsigned set = 0;
  for (mlir::Value value : values) {
    const std::string name = sourceName(value);
    if (name.size() > 1 && name[0] == 'n' && std::isdigit(static_cast<unsigned char>(name[1])))
      set |= 1u << std::stoul(name.substr(1));
  }
  return set;
}

/// What the compiler's choice costs; it has to be one.
std::int64_t costOfPlan(const Shader &shader, mlir::MLIRContext &context) {
  auto ir = mlir::parseSourceString<mlir::ModuleOp>(shader.text, &context);
  EXPECT_TRUE(ir);
  auto function = ir->lookupSymbol<FuncOp>("f");
  insertSuspends(function);
  auto plans = planContinuations(function, {});
  EXPECT_TRUE(mlir::succeeded(plans));
  EXPECT_EQ(plans->size(), shader.traces);
  std::int64_t cost = 0;
  for (unsigned trace = 0; trace < plans->size(); ++trace) {
    const unsigned saved = setOf((*plans)[trace].saved);
    const unsigned savedNext = trace + 1 < plans->size() ? setOf((*plans)[trace + 1].saved) : 0;
    const std::int64_t own = costAt(shader, trace, saved, neededBehind(shader, trace, savedNext));
    EXPECT_LT(own, impossible) << "trace " << trace << " saves " << saved << " of\n" << shader.text;
    cost += own;
  }
  return cost;
}

void compare(unsigned traces, unsigned shaders) {
  mlir::DialectRegistry registry;
  codegen::registerPassDependencies(registry);
  mlir::MLIRContext context(registry, mlir::MLIRContext::Threading::DISABLED);
  context.loadAllAvailableDialects();
  unsigned compared = 0, saving = 0;
  for (unsigned seed = 0; seed < shaders; ++seed) {
    const Shader shader = Maker(100000 * traces + seed).make(traces);
    if (shader.nodes.size() > 18)
      continue; // more than can be tried
    std::map<std::pair<unsigned, unsigned>, std::int64_t> known;
    const std::int64_t best = cheapest(shader, traces - 1, 0, known);
    ASSERT_EQ(costOfPlan(shader, context), best) << "seed " << seed << "\n" << shader.text;
    ++compared;
    saving += best > 0;
  }
  EXPECT_GT(compared, shaders / 4);
  EXPECT_GT(saving, compared / 2);
}

TEST(ShaderOptimum, OfOneTrace) {
  compare(1, 400);
}
TEST(ShaderOptimum, OfTwoTraces) {
  compare(2, 400);
}
TEST(ShaderOptimum, OfThreeTraces) {
  compare(3, 300);
}

} // namespace
