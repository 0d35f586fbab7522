//===- RtslDiscardableAttributes.td - what passes record on operations ----===//
//
// Attributes that every operation of a kind has are arguments of the operation, in RtslOps.td.
// These are for what one pass records on an operation for another: `rtsl.<word>` in IR, and
// `ir::attr::<name of the record>` in C++ (codegen/ir/Attributes.h). The verifier rejects an
// attribute `rtsl.*` that no record declares, or that is of another kind, or on another operation.
//
// MLIR's own declaration, `discardableAttrs` of a dialect, is a list of names and classes, from
// which only accessors are generated. Here each attribute is a record, and WriteAttributeRows.cmake
// writes a row of C++ for each.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_DISCARDABLE_ATTRIBUTES_TD
#define RTSL_DISCARDABLE_ATTRIBUTES_TD

/// What an attribute holds: its class in MLIR, and the rule that a message states.
class ValueKind<string classInMlir, string text> {
  string cppClass = classInMlir;
  string rule = text;
}
def Unit          : ValueKind<"UnitAttr",          "takes no value">;
def String        : ValueKind<"StringAttr",        "must be a string">;
def Integer       : ValueKind<"IntegerAttr",       "must be an integer">;
def Array         : ValueKind<"ArrayAttr",         "must be an array">;
def DenseI32Array : ValueKind<"DenseI32ArrayAttr", "must be an array of i32">;
def DenseF32Array : ValueKind<"DenseF32ArrayAttr", "must be an array of f32">;

/// An attribute of these operations. `setBy` and `readBy` are folders and files of codegen; folders
/// of passes/continuation are given without that prefix.
class DiscardableAttribute<string wordInIr, ValueKind kindOfValue, list<string> mayBeOn> {
  string word = wordInIr;
  ValueKind kind = kindOfValue;
  list<string> operations = mayBeOn;
  string meaning;
  string setBy;
  string readBy;
  assert !and(!initialized(meaning), !initialized(setBy), !initialized(readBy)),
         "`meaning`, `setBy` and `readBy` are required";
}

//===--------------------------------------------------------------------===//
// Functions: their role in the source
//===--------------------------------------------------------------------===//

def className : DiscardableAttribute<"class", String, ["func.func"]> {
  let meaning = "a method of this class: its first argument is the object";
  let setBy = "lower";
  let readBy = "all later stages";
}

def methodName : DiscardableAttribute<"method", String, ["func.func"]> {
  let meaning = "its dispatch slot: its name, with its parameters if it is overloaded";
  let setBy = "lower";
  let readBy = "link, passes/continuation, cpp";
}

def dispatch : DiscardableAttribute<"dispatch", Unit, ["func.func"]> {
  let meaning = "calls a method of the class of its first argument, an object of any class";
  let setBy = "link/ResolveSlots, link/RayTypes, calls/OpenCalls";
  let readBy = "link, passes/continuation";
}

def slot : DiscardableAttribute<"slot", String, ["func.func"]> {
  let meaning =
    "the entry point of this slot of language/*.def, or a state of it: \"rt_Miss.miss\", and for "
    "rays with a payload \"rt_Miss.miss.payload\"";
  let setBy = "link, states/SplitStates";
  let readBy = "Slots.h";
}

def runsStates : DiscardableAttribute<"runs_states", Array, ["func.func"]> {
  let meaning =
    "the switch over all states, whose names these are, from number 1; its pointer is a frame";
  let setBy = "states/Dispatch";
  let readBy = "emit, driver";
}

def constructor : DiscardableAttribute<"constructor", Unit, ["func.func"]> {
  let meaning = "writes the record of its object, so that members are not constants there";
  let setBy = "lower, link/MakeEntries";
  let readBy = "passes/InlineFunctions, link, emit";
}

def hidden : DiscardableAttribute<"hidden", Unit, ["func.func"]> {
  let meaning =
    "the definition of a base class that code of an object calls, which has another one";
  let setBy = "lower";
  let readBy = "link/DropUnreached";
}

def exported : DiscardableAttribute<"export", Unit, ["func.func"]> {
  let meaning = "keeps its name and may be called from outside of the program";
  let setBy = "link, states/Dispatch";
  let readBy = "states/SplitStates, emit";
}

//===--------------------------------------------------------------------===//
// Functions: how passes treat them
//===--------------------------------------------------------------------===//

def noinline : DiscardableAttribute<"noinline", Unit, ["func.func"]> {
  let meaning = "is not inlined before splitting";
  let setBy = "Split, calls/OpenCalls";
  let readBy = "passes/InlineFunctions";
}

def separate : DiscardableAttribute<"separate", Unit, ["func.func"]> {
  let meaning = "is not inlined, neither by us nor by LLVM: one of many that a switch chooses from";
  let setBy = "ir/Separate.h";
  let readBy = "passes/InlineFunctions, emit";
}

def inLookup : DiscardableAttribute<"in_lookup", Unit, ["func.func"]> {
  let meaning = "a texture's `lookup` may run it: its caller reads the results that it stores";
  let setBy = "lower, link/ResolveSlots";
  let readBy = "passes/InlineFunctions, variables/LocalizeLookups, calls/FunctionEffects";
}

def states : DiscardableAttribute<"states", Unit, ["func.func"]> {
  let meaning = "becomes states even if it does not trace";
  let setBy = "lower";
  let readBy = "Split, calls/OpenCalls, passes/InlineFunctions";
}

def kept : DiscardableAttribute<"kept", Unit, ["func.func"]> {
  let meaning = "compiled although it is not reached";
  let setBy = "link/DropUnreached";
  let readBy = "link";
}

def whileBuilding : DiscardableAttribute<"while_building", Unit, ["func.func"]> {
  let meaning = "runs only while a scene is built; not part of the program that renders";
  let setBy = "link/DropUnreached";
  let readBy = "link/DropUnusedClasses";
}

def hitError : DiscardableAttribute<"hit_error", Unit, ["func.func"]> {
  let meaning = "computes t of a primitive with a bound of its error";
  let setBy = "errors/DeriveHitErrors";
  let readBy = "link/DropUnreached, driver";
}

def writesMembers : DiscardableAttribute<"writes_members", Unit, ["func.func"]> {
  let meaning = "members are not constants in it: a constructor, or what one may call";
  let setBy = "emit/ConvertToLlvm";
  let readBy = "emit/MemoryPatterns";
}

//===--------------------------------------------------------------------===//
// Functions: splitting at trace
//===--------------------------------------------------------------------===//

def framed : DiscardableAttribute<"framed", Unit, ["func.func", "func.call"]> {
  let meaning = "a function that traces and is called on its own frame above the caller's";
  let setBy = "calls, Split";
  let readBy = "TracedFunctions.cpp as isFramed()";
}

def frameBase : DiscardableAttribute<"frame_base", Integer, ["func.func"]> {
  let meaning = "i32, bytes: arguments and results of a framed function in its frame";
  let setBy = "calls/CallFrames";
  let readBy = "frame/FrameLayout";
}

def frameSize : DiscardableAttribute<"frame_size", Integer, ["func.func"]> {
  let meaning = "i32, bytes: the frame of a function and of its states";
  let setBy = "frame/FrameLayout";
  let readBy = "calls/CallFrames, states/Dispatch";
}

def writes : DiscardableAttribute<"writes", Array, ["func.func"]> {
  let meaning = "strings: the state variables that a declared method may write; without it, all";
  let setBy = "calls/OpenCalls";
  let readBy = "common/Recompute";
}

def state : DiscardableAttribute<"state", Integer, ["func.func"]> {
  let meaning = "i32: this is a state; its number among those that its function was split into";
  let setBy = "states/SplitStates";
  let readBy = "passes/continuation, emit, cpp/states";
}

def entry : DiscardableAttribute<"entry", String, ["func.func"]> {
  let meaning = "the exported function that begins with this state";
  let setBy = "states/SplitStates";
  let readBy = "states/Dispatch";
}

def factOfScene : DiscardableAttribute<"fact_of_scene", Unit, ["func.func"]> {
  let meaning =
    "gives the machine a fact about the rays of a scene: the first state of an entry point, or "
    "which kinds of rays send which. Not used without a scene";
  let setBy = "states/Dispatch";
  let readBy = "driver";
}

//===--------------------------------------------------------------------===//
// Calls, traces and ends of functions
//===--------------------------------------------------------------------===//

def tail : DiscardableAttribute<"tail", Unit, ["func.call"]> {
  let meaning = "a jump to the first state of the callee; nothing follows it";
  let setBy = "calls/InlineTracing";
  let readBy = "states/SplitStates";
}

def join : DiscardableAttribute<"join", Unit, ["rtsl.suspend"]> {
  let meaning = "no ray is sent: the next state runs at once";
  let setBy = "suspend/CutJoins";
  let readBy = "states/SplitStates, Recorder";
}

def last : DiscardableAttribute<"last", Unit, ["func.return"]> {
  let meaning = "follows a tail trace, whose ray replaces this one";
  let setBy = "suspend/TailTraces";
  let readBy = "states/SplitStates";
}

def shared : DiscardableAttribute<"shared", Unit, ["rtsl.frame_load", "rtsl.frame_store"]> {
  let meaning = "its words of the frame also hold other values or objects";
  let setBy = "frame/FrameLayout";
  let readBy = "states/CleanStores, states/SinkLoads";
}

//===--------------------------------------------------------------------===//
// Variables, members and tables
//===--------------------------------------------------------------------===//

def declared : DiscardableAttribute<"declared", Integer, ["rtsl.var", "rtsl.frame_object"]> {
  let meaning = "i32: the number of its type among those of the SourceTable";
  let setBy = "lower";
  let readBy = "restructure, cpp/states";
}

def value : DiscardableAttribute<"value", Unit, ["rtsl.var"]> {
  let meaning = "holds an SSA value: it is stored before it is loaded";
  let setBy = "restructure/LeaveSsa";
  let readBy = "restructure";
}

def shortCircuit : DiscardableAttribute<"short_circuit", Unit, ["rtsl.var"]> {
  let meaning = "holds the result of `&&` or `||` in a module that is printed as C++";
  let setBy = "lower, restructure/LeaveSsa";
  let readBy = "NamedLocation.h, cpp/states";
}

def bound : DiscardableAttribute<"bound", DenseI32Array, ["rtsl.member_decl"]> {
  let meaning = "the words of the member in the record of every object that has it";
  let setBy = "link/BindScene";
  let readBy = "passes/BindMembers";
}

def editable
    : DiscardableAttribute<"editable", Unit, ["rtsl.member_decl", "rtsl.member"]> {
  let meaning = "its value may change without new code: never from the table of records";
  let setBy = "link/BindScene, emit/ConvertToLlvm";
  let readBy = "link/BindTables, emit/MemoryPatterns";
}

def offset : DiscardableAttribute<"offset", Integer, ["rtsl.member"]> {
  let meaning = "i32, bytes from the start of the record, for use without the class";
  let setBy = "emit/ConvertToLlvm";
  let readBy = "emit/MemoryPatterns";
}

def symbol : DiscardableAttribute<"symbol", String, ["rtsl.table", "func.func"]> {
  let meaning = "its name in machine code, if it has another in the IR";
  let setBy = "Slots.h, emit";
  let readBy = "emit";
}

//===--------------------------------------------------------------------===//
// `rtsl.evaluate`: the effects of an expression beside its result
//===--------------------------------------------------------------------===//

def into : DiscardableAttribute<"into", Unit, ["rtsl.evaluate"]> {
  let meaning = "its value is an aggregate, which it stores to its first operand, as a whole";
  let setBy = "lower";
  let readBy = "restructure, frame/IdleClears";
}

def changes : DiscardableAttribute<"changes", DenseI32Array, ["rtsl.evaluate"]> {
  let meaning = "the operands, by number, whose variables it may change";
  let setBy = "lower";
  let readBy = "restructure, cpp/states";
}

def plain : DiscardableAttribute<"plain", Unit, ["rtsl.evaluate"]> {
  let meaning = "accesses only its operands: without `changes` it is dead if its result is unused";
  let setBy = "lower";
  let readBy = "restructure, cpp/states";
}

def nested : DiscardableAttribute<"nested", Unit, ["rtsl.evaluate"]> {
  let meaning = "contains an expression with side effects, and the order of evaluation matters";
  let setBy = "lower";
  let readBy = "cpp/states";
}

//===--------------------------------------------------------------------===//
// Modules
//===--------------------------------------------------------------------===//

def source : DiscardableAttribute<"source", Unit, ["builtin.module"]> {
  let meaning = "is printed as C++: variables stay whole, and little code is duplicated";
  let setBy = "lower";
  let readBy = "passes, Split";
}

def hidesConstants : DiscardableAttribute<"hides_constants", Unit, ["builtin.module"]> {
  let meaning = "no operation of numbers may be folded before LLVM IR";
  let setBy = "lower";
  let readBy = "formulas";
}

def inDouble : DiscardableAttribute<"double", Unit, ["builtin.module"]> {
  let meaning = "its arithmetic will be done in double";
  let setBy = "lower";
  let readBy = "passes/InlineFunctions, emit";
}

def lightCount : DiscardableAttribute<"light_count", Integer, ["builtin.module"]> {
  let meaning = "i32: the result of the operation of this name in a bound scene";
  let setBy = "link/BindScene";
  let readBy = "passes/BindMembers";
}

def ambient : DiscardableAttribute<"ambient", DenseF32Array, ["builtin.module"]> {
  let meaning = "the result of the operation of this name in a bound scene";
  let setBy = "link/BindScene";
  let readBy = "passes/BindMembers";
}

def singlePrimitives : DiscardableAttribute<"single_primitives", Unit, ["builtin.module"]> {
  let meaning = "no object of the scene holds several primitives";
  let setBy = "link/Link";
  let readBy = "states/KeptState";
}

def noPassedDistances : DiscardableAttribute<"no_passed_distances", Unit, ["builtin.module"]> {
  let meaning = "no light of surfaces that shine passes a surface: rays have no passedDistance";
  let setBy = "link/Link";
  let readBy = "states/KeptState";
}

def records : DiscardableAttribute<"records", DenseI32Array, ["builtin.module"]> {
  let meaning = "the records of all objects of a bound scene, at their references";
  let setBy = "link/BindTables";
  let readBy = "emit/SceneTables";
}

def instances : DiscardableAttribute<"instances", DenseI32Array, ["builtin.module"]> {
  let meaning = "the instances of a bound scene: RtslInstance in runtime/device/ray/Launch.h";
  let setBy = "link/BindTables";
  let readBy = "emit/SceneTables";
}

def emitters : DiscardableAttribute<"emitters", DenseI32Array, ["builtin.module"]> {
  let meaning = "the emitters of a bound scene: RtslEmitter in runtime/device/ray/Launch.h";
  let setBy = "link/BindTables";
  let readBy = "emit/SceneTables";
}

def wholeEmitters : DiscardableAttribute<"whole_emitters", Unit, ["builtin.module"]> {
  let meaning = "each of these emitters is one primitive";
  let setBy = "link/BindTables";
  let readBy = "emit/SceneTables";
}

def meshAttributes : DiscardableAttribute<"mesh_attributes", DenseI32Array, ["builtin.module"]> {
  let meaning =
    "the attributes of meshes that the program of a scene reads: RtslMeshAttribute in "
    "runtime/device/ray/Launch.h";
  let setBy = "link/Link";
  let readBy = "emit/SceneTables";
}

def listedBoxes : DiscardableAttribute<"listed_boxes", DenseI32Array, ["builtin.module"]> {
  let meaning =
    "the boxes of the instances, all of them primitives, that are tested without a tree: "
    "RtslListedBox in runtime/device/ray/Abi.h";
  let setBy = "link/BindTables";
  let readBy = "emit/SceneTables";
}

def listedPairs : DiscardableAttribute<"listed_pairs", DenseI32Array, ["builtin.module"]> {
  let meaning =
    "the same boxes in half precision: RtslListedPairs and its pairs in runtime/device/ray/Abi.h";
  let setBy = "link/BindTables";
  let readBy = "emit/SceneTables";
}

def noted : DiscardableAttribute<"noted", Unit, ["builtin.module"]> {
  let meaning = "`writes_members`, `offset`, `holds_payloads` are set";
  let setBy = "emit/ConvertToLlvm";
  let readBy = "emit/ConvertToLlvm";
}

def holdsPayloads : DiscardableAttribute<"holds_payloads", Unit, ["builtin.module"]> {
  let meaning = "a ray has a pointer to its payload, in the frame of the state that sent it";
  let setBy = "emit/ConvertToLlvm";
  let readBy = "emit/ConvertToLlvm";
}

#endif
