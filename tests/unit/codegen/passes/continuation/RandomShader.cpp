#include "RandomShader.h"

#include <random>
#include <vector>

namespace rtsl::test {

namespace {

class Generator {
public:
  explicit Generator(std::uint32_t seed) : random(seed) {}
  std::string module();

private:
  unsigned below(unsigned bound) { return unsigned(random() % bound); }
  std::string fresh() { return "%t" + std::to_string(counter++); }
  void line(const std::string &code) { text += std::string(2 * depth, ' ') + code + "\n"; }
  std::string emit(const std::string &code) {
    std::string name = fresh();
    line(name + " = " + code);
    return name;
  }

  std::string load(const std::string &variable, const std::string &type) {
    return emit("rtsl.load " + variable + " : !rtsl.ptr<" + type + ">");
  }
  void store(const std::string &value, const std::string &variable, const std::string &type) {
    line("rtsl.store " + value + ", " + variable + " : !rtsl.ptr<" + type + ">");
  }
  std::string state(const std::string &name, const std::string &type) {
    return emit("rtsl.state \"" + name + "\" : !rtsl.ptr<" + type + ">");
  }

  bool isMiss() const { return className == "Sky"; }
  std::string floatValue(unsigned size);
  std::string intValue(unsigned size);
  std::string boolValue(unsigned size);
  std::string vectorValue(unsigned size);
  std::string element();
  void statement(unsigned size);
  void block(unsigned size);
  void loop(unsigned size);
  void choice(unsigned size);
  void method(const std::string &className, const std::string &name, bool hasPayload = false);
  std::string payloadField(const std::string &base, unsigned field);
  void tracePayload();
  void lastTrace();

  std::mt19937 random;
  std::string text, className;
  bool hasPayload = false; // the method answers rays that carry one
  unsigned counter = 0, depth = 0, loops = 0, breakable = 0, traces = 0;
};

const std::string vec3 = "vector<3xf32>";
const std::string array = "!rtsl.array<4 x f32>";

const std::string payload =
    "!rtsl.struct<\"P\", {x: f32, v: vector<3xf32>, b: i1, a: " + array + "}>";

/// The address of x, v, b or an element of a.
std::string Generator::payloadField(const std::string &base, unsigned field) {
  static const std::string names[] = {"x", "v", "b", "a"}, types[] = {"f32", vec3, "i1", array};
  std::string address = emit("rtsl.field " + base + "[\"" + names[field] + "\"] : !rtsl.ptr<" +
                             payload + "> -> !rtsl.ptr<" + types[field] + ">");
  if (field < 3)
    return address;
  std::string three = emit("arith.constant 3 : i32");
  std::string inRange = emit("arith.andi " + intValue(1) + ", " + three + " : i32");
  return emit("rtsl.element " + address + "[" + inRange + "] : !rtsl.ptr<" + array +
              "> -> !rtsl.ptr<f32>");
}

/// A ray with a payload of its own, as lowering makes it: filled before, read after.
void Generator::tracePayload() {
  std::string origin = vectorValue(1), direction = vectorValue(2), from = floatValue(1),
              to = floatValue(1);
  std::string mask = below(2) ? " mask " + intValue(1) : "",
              time = below(2) ? " time " + floatValue(1) : "";
  std::string variable = "%p" + std::to_string(counter++);
  line(variable + " = rtsl.var \"payload\" : !rtsl.ptr<" + payload + ">");
  store(floatValue(1), payloadField(variable, 0), "f32");
  store(vectorValue(1), payloadField(variable, 1), vec3);
  store(boolValue(1), payloadField(variable, 2), "i1");
  if (below(2))
    store(floatValue(1), payloadField(variable, 3), "f32");
  line("rtsl.trace_payload " + origin + ", " + direction + " from " + from + " to " + to +
       " carries " + variable + mask + time + " {ray_type = 1 : i32, how = 0 : i32} : !rtsl.ptr<" +
       payload + ">");
  store(load(payloadField(variable, 0), "f32"), "%f" + std::to_string(below(3)), "f32");
  if (below(4)) // sometimes a field is never read
    store(load(payloadField(variable, 1), vec3), "%v" + std::to_string(below(3)), vec3);
  if (below(2))
    store(load(payloadField(variable, 2), "i1"), "%b" + std::to_string(below(3)), "i1");
  if (below(2))
    store(load(payloadField(variable, 3), "f32"), "%f" + std::to_string(below(3)), "f32");
}

/// A trace with whose result the method ends: of a color, or of the payload that came in.
void Generator::lastTrace() {
  std::string origin = vectorValue(1), direction = vectorValue(2);
  if (!hasPayload) {
    std::string color = emit("rtsl.trace " + origin + ", " + direction + " : " + vec3);
    return store(color, state("SampleColor", vec3), vec3);
  }
  std::string from = floatValue(0), to = floatValue(1);
  std::string variable = "%p" + std::to_string(counter++);
  const std::string type = "!rtsl.ptr<" + payload + ">";
  line(variable + " = rtsl.var \"payload\" : " + type);
  line("rtsl.copy %own to " + variable + " : " + type);
  if (below(2))
    store(vectorValue(1), payloadField(variable, 1), vec3);
  line("rtsl.trace_payload " + origin + ", " + direction + " from " + from + " to " + to +
       " carries " + variable + " {ray_type = 1 : i32, how = 0 : i32} : " + type);
  line("rtsl.copy " + variable + " to %own : " + type);
}

std::string Generator::element() {
  std::string index = intValue(1);
  std::string three = emit("arith.constant 3 : i32");
  std::string inRange = emit("arith.andi " + index + ", " + three + " : i32");
  return emit("rtsl.element %a[" + inRange + "] : !rtsl.ptr<" + array + "> -> !rtsl.ptr<f32>");
}

std::string Generator::floatValue(unsigned size) {
  switch (size == 0 ? below(4) : below(12)) {
  case 0:
    return emit("arith.constant " + std::to_string(int(below(17)) - 8) + ".25 : f32");
  case 1:
  case 2:
    return load("%f" + std::to_string(below(3)), "f32");
  case 3: {
    std::string member =
        emit("rtsl.member %self[\"m\"] : !rtsl.ref<\"" + className + "\"> -> !rtsl.ptr<f32>");
    return load(member, "f32");
  }
  case 4:
    return emit("rtsl.rand");
  case 5: {
    std::string v = vectorValue(size - 1);
    return emit("vector.extract " + v + "[" + std::to_string(below(3)) + "] : f32 from " + vec3);
  }
  case 6:
    return load(element(), "f32");
  case 7:
    return emit("arith.sitofp " + intValue(size - 1) + " : i32 to f32");
  case 8: {
    std::string c = boolValue(size - 1), a = floatValue(size - 1), b = floatValue(size - 1);
    return emit("arith.select " + c + ", " + a + ", " + b + " : f32");
  }
  case 9:
    if (hasPayload && below(2))
      return load(payloadField("%own", below(2) ? 0 : 3), "f32");
    return load(state(isMiss() ? "Epsilon" : "HitDistance", "f32"), "f32");
  default: {
    static const char *ops[] = {"arith.addf", "arith.mulf", "arith.subf", "arith.divf"};
    std::string a = floatValue(size - 1), b = floatValue(size - 1);
    return emit(std::string(ops[below(4)]) + " " + a + ", " + b + " : f32");
  }
  }
}

std::string Generator::intValue(unsigned size) {
  switch (size == 0 ? below(2) : below(4)) {
  case 0:
    return emit("arith.constant " + std::to_string(below(9)) + " : i32");
  case 1:
    return load("%i" + std::to_string(below(2)), "i32");
  case 2:
    return emit("rtsl.to_sint " + floatValue(size - 1) + " : f32");
  default: {
    static const char *ops[] = {"arith.addi", "arith.muli", "arith.xori", "arith.subi"};
    std::string a = intValue(size - 1), b = intValue(size - 1);
    return emit(std::string(ops[below(4)]) + " " + a + ", " + b + " : i32");
  }
  }
}

std::string Generator::boolValue(unsigned size) {
  switch (size == 0 ? 0 : below(3)) {
  case 0:
    return load("%b" + std::to_string(below(3)), "i1");
  case 1: {
    std::string a = floatValue(size - 1), b = floatValue(size - 1);
    return emit("arith.cmpf olt, " + a + ", " + b + " : f32");
  }
  default: {
    std::string a = intValue(size - 1), b = intValue(size - 1);
    return emit("arith.cmpi slt, " + a + ", " + b + " : i32");
  }
  }
}

std::string Generator::vectorValue(unsigned size) {
  switch (size == 0 ? below(3) : below(7)) {
  case 0:
  case 1:
    return load("%v" + std::to_string(below(3)), vec3);
  case 2: {
    if (hasPayload && below(2))
      return load(payloadField("%own", 1), vec3);
    // A ray that hit nothing has no hit point.
    static const char *names[] = {"RayDirection", "SampleColor", "RayOrigin", "HitPoint",
                                  "GeometricNormal"};
    return load(state(names[below(isMiss() ? 3 : 5)], vec3), vec3);
  }
  case 3: {
    std::string x = floatValue(size - 1), y = floatValue(size - 1), z = floatValue(size - 1);
    return emit("vector.from_elements " + x + ", " + y + ", " + z + " : " + vec3);
  }
  case 4:
    return emit("vector.broadcast " + floatValue(size - 1) + " : f32 to " + vec3);
  case 5: {
    std::string v = vectorValue(size - 1);
    return emit("vector.shuffle " + v + ", " + v + " [2, 0, 1] : " + vec3 + ", " + vec3);
  }
  default: {
    static const char *ops[] = {"arith.addf", "arith.mulf", "arith.subf"};
    std::string a = vectorValue(size - 1), b = vectorValue(size - 1);
    return emit(std::string(ops[below(3)]) + " " + a + ", " + b + " : " + vec3);
  }
  }
}

void Generator::block(unsigned size) {
  ++depth;
  for (unsigned n = 1 + below(3); n-- > 0;)
    statement(size);
}

void Generator::loop(unsigned size) {
  ++loops;
  // A counter of its own bounds it.
  std::string counterName = "%n" + std::to_string(counter++);
  std::string zero = emit("arith.constant 0 : i32");
  line(counterName + " = rtsl.var \"n\" : !rtsl.ptr<i32>");
  store(zero, counterName, "i32");
  bool testAfter = below(3) == 0;
  line(std::string("rtsl.loop ") + (testAfter ? "post_test " : "") + "cond {");
  ++depth;
  std::string value = load(counterName, "i32");
  std::string bound = emit("arith.constant " + std::to_string(1 + below(3)) + " : i32");
  std::string more = emit("arith.cmpi slt, " + value + ", " + bound + " : i32");
  line("rtsl.condition " + more);
  --depth;
  line("} do {");
  unsigned outer = breakable;
  breakable = 2; // break and continue
  block(size);
  line("rtsl.yield");
  breakable = outer;
  --depth;
  line("} step {");
  ++depth;
  value = load(counterName, "i32");
  std::string one = emit("arith.constant 1 : i32");
  store(emit("arith.addi " + value + ", " + one + " : i32"), counterName, "i32");
  line("rtsl.yield");
  --depth;
  line("}");
  --loops;
}

void Generator::choice(unsigned size) {
  std::string value = intValue(1);
  line("rtsl.switch " + value + " : i32 {");
  ++depth;
  line("arm [0, 2] {");
  unsigned outer = breakable;
  breakable = outer == 2 ? 2 : 1; // a break leaves the switch
  block(size);
  line(below(2) ? "rtsl.yield" : "rtsl.break");
  --depth;
  line("}");
  line("arm [1] default {");
  block(size);
  line("rtsl.yield");
  --depth;
  line("}");
  breakable = outer;
  --depth;
  line("}");
}

void Generator::statement(unsigned size) {
  unsigned kind = below(size == 0 ? 8 : 14);
  if (kind < 2) {
    store(floatValue(2), "%f" + std::to_string(below(3)), "f32");
  } else if (kind == 2) {
    store(vectorValue(2), "%v" + std::to_string(below(3)), vec3);
  } else if (kind == 3) {
    if (below(2))
      store(intValue(2), "%i" + std::to_string(below(2)), "i32");
    else
      store(boolValue(2), "%b" + std::to_string(below(3)), "i1");
  } else if (kind == 4) {
    std::string value = floatValue(1);
    store(value, element(), "f32");
  } else if (kind == 5 && hasPayload) {
    if (below(2))
      store(vectorValue(2), payloadField("%own", 1), vec3);
    else
      store(floatValue(2), payloadField("%own", below(2) ? 0 : 3), "f32");
  } else if (kind == 5) {
    store(vectorValue(2), state("SampleColor", vec3), vec3);
  } else if (kind < 10) {
    if (traces == 0)
      return store(floatValue(1), "%f0", "f32");
    --traces;
    if (below(2))
      return tracePayload();
    std::string origin = vectorValue(1), direction = vectorValue(2);
    std::string color = emit("rtsl.trace " + origin + ", " + direction + " : " + vec3);
    std::string weight = vectorValue(1);
    store(emit("arith.mulf " + color + ", " + weight + " : " + vec3),
          "%v" + std::to_string(below(3)), vec3);
  } else if (kind < 12) {
    line("rtsl.if " + boolValue(2) + " {");
    block(size - 1);
    unsigned leave = below(8);
    if (leave == 0 && traces > 0 && below(2)) {
      --traces;
      lastTrace();
    }
    line(leave == 0                     ? "rtsl.return"
         : leave == 1 && breakable > 0  ? "rtsl.break"
         : leave == 2 && breakable == 2 ? "rtsl.continue"
                                        : "rtsl.yield");
    --depth;
    if (below(2)) {
      line("} else {");
      block(size - 1);
      line("rtsl.yield");
      --depth;
    }
    line("}");
  } else if (kind == 12 && loops < 2) {
    loop(size - 1);
  } else {
    choice(size - 1);
  }
}

void Generator::method(const std::string &name, const std::string &methodName, bool withPayload) {
  className = name;
  hasPayload = withPayload;
  traces = 3;
  text += "func.func private @" + name + "." + methodName + "(%self: !rtsl.ref<\"" + name +
          "\">) attributes {rtsl.class = \"" + name + "\", rtsl.method = \"" + methodName +
          "\"} {\n";
  depth = 1;
  for (int i = 0; i < 3; ++i)
    line("%f" + std::to_string(i) + " = rtsl.var \"f" + std::to_string(i) + "\" : !rtsl.ptr<f32>");
  for (int i = 0; i < 2; ++i)
    line("%i" + std::to_string(i) + " = rtsl.var \"i" + std::to_string(i) + "\" : !rtsl.ptr<i32>");
  for (int i = 0; i < 3; ++i)
    line("%b" + std::to_string(i) + " = rtsl.var \"b" + std::to_string(i) + "\" : !rtsl.ptr<i1>");
  for (int i = 0; i < 3; ++i)
    line("%v" + std::to_string(i) + " = rtsl.var \"v" + std::to_string(i) + "\" : !rtsl.ptr<" +
         vec3 + ">");
  if (hasPayload)
    line("%own = rtsl.payload : !rtsl.ptr<" + payload + ">");
  line("%a = rtsl.var \"a\" : !rtsl.ptr<" + array + ">");
  for (int i = 0; i < 3; ++i)
    store(emit("rtsl.rand"), "%f" + std::to_string(i), "f32");
  store(load(state(isMiss() ? "RayOrigin" : "HitPoint", vec3), vec3), "%v0", vec3);
  store(load(state("RayDirection", vec3), vec3), "%v1", vec3);
  for (unsigned n = 3 + below(5); n-- > 0;)
    statement(3);
  // Everything shows in the end.
  std::string sum = load("%v0", vec3);
  for (const char *name : {"%v1", "%v2"})
    sum = emit("arith.addf " + sum + ", " + load(name, vec3) + " : " + vec3);
  std::string scalar = load("%f0", "f32");
  for (const char *name : {"%f1", "%f2"})
    scalar = emit("arith.addf " + scalar + ", " + load(name, "f32") + " : f32");
  scalar = emit("arith.addf " + scalar + ", " + load(element(), "f32") + " : f32");
  for (const char *name : {"%i0", "%i1"})
    scalar =
        emit("arith.addf " + scalar + ", " +
             emit(std::string("arith.sitofp ") + load(name, "i32") + " : i32 to f32") + " : f32");
  for (const char *name : {"%b0", "%b1", "%b2"})
    scalar =
        emit("arith.addf " + scalar + ", " +
             emit(std::string("arith.uitofp ") + load(name, "i1") + " : i1 to f32") + " : f32");
  std::string splat = emit("vector.broadcast " + scalar + " : f32 to " + vec3);
  std::string color = hasPayload ? payloadField("%own", 1) : state("SampleColor", vec3);
  std::string before = load(color, vec3);
  std::string after = emit("arith.addf " + before + ", " +
                           emit("arith.addf " + sum + ", " + splat + " : " + vec3) + " : " + vec3);
  store(after, color, vec3);
  line("rtsl.return");
  text += "}\n";
  depth = 0;
}

/// The functions of slots, which call those of the classes A, B and Sky.
const char entryPoints[] = R"(
func.func @rtsl_rt_Material_shade(%o: !rtsl.ref<"rt_Material">) attributes {rtsl.export, rtsl.slot = "rt_Material.shade"} {
  %id = rtsl.class_id %o : !rtsl.ref<"rt_Material">
  rtsl.switch %id : i32 {
    arm [1] {
      %a = rtsl.cast_ref %o : !rtsl.ref<"rt_Material"> -> !rtsl.ref<"A">
      func.call @A.shade(%a) : (!rtsl.ref<"A">) -> ()
      rtsl.return
    }
    arm [2] {
      %b = rtsl.cast_ref %o : !rtsl.ref<"rt_Material"> -> !rtsl.ref<"B">
      func.call @B.shade(%b) : (!rtsl.ref<"B">) -> ()
      rtsl.return
    }
  }
  rtsl.return
}
func.func @rtsl_rt_Exception_exception(%o: !rtsl.ref<"rt_Exception">) attributes {rtsl.export, rtsl.slot = "rt_Exception.exception"} {
  rtsl.return
}
func.func @rtsl_rt_Miss_miss(%o: !rtsl.ref<"rt_Miss">) attributes {rtsl.export, rtsl.slot = "rt_Miss.miss"} {
  %s = rtsl.cast_ref %o : !rtsl.ref<"rt_Miss"> -> !rtsl.ref<"Sky">
  func.call @Sky.miss(%s) : (!rtsl.ref<"Sky">) -> ()
  rtsl.return
}
func.func @rtsl_rt_Material_closestHit_payload(%o: !rtsl.ref<"rt_Material">) attributes {rtsl.export, rtsl.slot = "rt_Material.closestHit.payload"} {
  %id = rtsl.class_id %o : !rtsl.ref<"rt_Material">
  %type = rtsl.ray_type
  %one = arith.constant 1 : i32
  %known = arith.cmpi eq, %type, %one : i32
  rtsl.if %known {
    rtsl.switch %id : i32 {
      arm [1] {
        %a = rtsl.cast_ref %o : !rtsl.ref<"rt_Material"> -> !rtsl.ref<"A">
        func.call @A.closestHit.P(%a) : (!rtsl.ref<"A">) -> ()
        rtsl.return
      }
      arm [2] {
        %b = rtsl.cast_ref %o : !rtsl.ref<"rt_Material"> -> !rtsl.ref<"B">
        func.call @B.closestHit.P(%b) : (!rtsl.ref<"B">) -> ()
        rtsl.return
      }
    }
    rtsl.yield
  }
  rtsl.return
}
func.func @rtsl_rt_Miss_miss_payload(%o: !rtsl.ref<"rt_Miss">) attributes {rtsl.export, rtsl.slot = "rt_Miss.miss.payload"} {
  %s = rtsl.cast_ref %o : !rtsl.ref<"rt_Miss"> -> !rtsl.ref<"Sky">
  func.call @Sky.miss.P(%s) : (!rtsl.ref<"Sky">) -> ()
  rtsl.return
}
func.func @rtsl_rt_Camera_generateRay(%o: !rtsl.ref<"rt_Camera">) attributes {rtsl.export, rtsl.slot = "rt_Camera.generateRay"} {
  %uv = rtsl.state "ScreenCoord" : !rtsl.ptr<vector<2xf32>>
  %v = rtsl.load %uv : !rtsl.ptr<vector<2xf32>>
  %x = vector.extract %v[0] : f32 from vector<2xf32>
  %y = vector.extract %v[1] : f32 from vector<2xf32>
  %one = arith.constant 1.0 : f32
  %d = vector.from_elements %x, %y, %one : vector<3xf32>
  %o2 = vector.from_elements %y, %one, %x : vector<3xf32>
  %rd = rtsl.state "RayDirection" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %d, %rd : !rtsl.ptr<vector<3xf32>>
  %ro = rtsl.state "RayOrigin" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %o2, %ro : !rtsl.ptr<vector<3xf32>>
  rtsl.return
}
func.func @rtsl_rt_Primitive_computeNormal(%o: !rtsl.ref<"rt_Primitive">) attributes {rtsl.export, rtsl.slot = "rt_Primitive.computeNormal"} {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %n = rtsl.state "GeometricNormal" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %v, %n : !rtsl.ptr<vector<3xf32>>
  rtsl.return
}
)";

std::string Generator::module() {
  for (const char *record : {"A", "B"})
    text += std::string("rtsl.class @") + record +
            " root \"rt_Material\" { rtsl.member_decl @m : f32 access \"public\" }\n";
  text += "rtsl.class @Sky root \"rt_Miss\" { rtsl.member_decl @m : f32 access \"public\" }\n";
  method("A", "shade");
  method("B", "shade");
  method("Sky", "miss");
  method("A", "closestHit.P", true);
  method("B", "closestHit.P", true);
  method("Sky", "miss.P", true);
  text += entryPoints;
  for (const char *slot : {"rt_Primitive_rt_boundHitError", "rt_Primitive_rt_computeChanges",
                           "rt_Primitive_computeTextureCoordinates",
                           "rt_Primitive_computeDerivatives", "rt_Light_illumination"})
    text += std::string("func.func @rtsl_") + slot +
            "(%o: !rtsl.ref<\"object\">) attributes {rtsl.export} {\n  rtsl.return\n}\n";
  return text;
}

} // namespace

std::string randomModule(std::uint32_t seed) {
  return Generator(seed).module();
}

} // namespace rtsl::test
