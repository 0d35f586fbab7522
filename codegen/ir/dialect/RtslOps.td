//===- RtslOps.td - operations of the `rtsl` dialect ----------------------===//
//
// In the order of reading: the module, memory, references, numbers, control flow. Operations about
// rays are in RtslRayOps.td.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_OPS_TD
#define RTSL_OPS_TD

include "mlir/IR/EnumAttr.td"
include "mlir/IR/OpAsmInterface.td"
include "mlir/IR/RegionKindInterface.td"
include "mlir/IR/SymbolInterfaces.td"
include "mlir/Interfaces/MemorySlotInterfaces.td"
include "mlir/Interfaces/InferTypeOpInterface.td"
include "mlir/Interfaces/SideEffectInterfaces.td"
include "codegen/ir/dialect/RtslDialect.td"
include "codegen/ir/dialect/RtslTypes.td"

class Rtsl_Op<string opMnemonic, list<Trait> traits = []> : Op<Rtsl_Dialect, opMnemonic, traits>;

// The printer names the result after the variable in the source.
defvar Rtsl_Named = DeclareOpInterfaceMethods<OpAsmOpInterface, ["getAsmResultNames"]>;
defvar Rtsl_Safe = DeclareOpInterfaceMethods<SafeMemorySlotAccessOpInterface>;
defvar Rtsl_Accessor = DeclareOpInterfaceMethods<DestructurableAccessorOpInterface>;
defvar Rtsl_MemOp = DeclareOpInterfaceMethods<PromotableMemOpInterface>;
defvar Rtsl_SymbolUser = DeclareOpInterfaceMethods<SymbolUserOpInterface>;

//===----------------------------------------------------------------------===//
// Module level
//===----------------------------------------------------------------------===//

def Rtsl_ClassOp : Rtsl_Op<"class",
                           [Symbol, SymbolTable, SingleBlock, NoTerminator, NoRegionArguments,
                                     IsolatedFromAbove, HasParent<"::mlir::ModuleOp">]> {
  let summary = "a class: the members of its objects' records";
  let description = [{
    Holds a `rtsl.member_decl` for every member, inherited ones first, in the order of a record.
    `root` is the `rt_` class at the end of the chain of bases; `base` another class of the source.

    ```mlir
    rtsl.class @Glass root "rt_Material" {
      rtsl.member_decl @eta : f32 access "public"
    }
    rtsl.class @Frosted root "rt_Material" base @Glass {
      rtsl.member_decl @eta : f32 access "public"
      rtsl.member_decl @roughness : f32 access "public"
    }
    ```
  }];
  let arguments = (ins SymbolNameAttr:$sym_name, StrAttr:$root,
                       OptionalAttr<FlatSymbolRefAttr>:$base);
  let regions = (region SizedRegion<1>:$body);
  let assemblyFormat = "$sym_name `root` $root (`base` $base^)? attr-dict-with-keyword $body";
  let hasVerifier = 1;
  let hasRegionVerifier = 1;
  let skipDefaultBuilders = 1;
  let builders = [OpBuilder<(ins "::llvm::StringRef":$name, "::llvm::StringRef":$root,
                                 CArg<"::llvm::StringRef", "{}">:$base)>];
  let extraClassDeclaration = [{
    /// The declaration of the member called `name`; null if there is none.
    MemberDeclOp findMember(::llvm::StringRef name);
  }];
}

def Rtsl_MemberDeclOp : Rtsl_Op<"member_decl", [Symbol, HasParent<"ClassOp">]> {
  let summary = "a member of a class";
  let description = [{
    `access` is "public" (the scene sets it), "private" (the constructor sets it) or "scratch" (a
    value of the ray, which takes no space in the record).
  }];
  let arguments = (ins SymbolNameAttr:$sym_name, TypeAttr:$type, StrAttr:$access);
  let assemblyFormat = "$sym_name `:` $type `access` $access attr-dict";
  let hasVerifier = 1;
  let extraClassDeclaration = [{
    bool isScratch() { return getAccess() == "scratch"; }
  }];
}

//===----------------------------------------------------------------------===//
// Memory
//===----------------------------------------------------------------------===//

def Rtsl_VarOp : Rtsl_Op<"var",
                         [Rtsl_Named, DeclareOpInterfaceMethods<PromotableAllocationOpInterface>,
                                 DeclareOpInterfaceMethods<DestructurableAllocationOpInterface>]> {
  let summary = "a local variable";
  let description = [{
    Gives the address of a variable that is all zeros at this point, each time that control reaches
    it.

    Example: `%sum = rtsl.var "sum" : !rtsl.ptr<f32>`
  }];
  let arguments = (ins StrAttr:$name);
  let results = (outs Res<Rtsl_Ptr, "", [MemAlloc<AutomaticAllocationScopeResource>]>:$result);
  let assemblyFormat = "$name attr-dict `:` type($result)";
  let builders = [OpBuilder<(ins "::llvm::StringRef":$name, "::mlir::Type":$type)>];
}

def Rtsl_ClearOp : Rtsl_Op<"clear", [Rtsl_MemOp, Rtsl_Accessor, Rtsl_Safe]> {
  let summary = "sets all memory of the pointee to zero";
  let description = [{
    Example: `rtsl.clear %matrix : !rtsl.ptr<!rtsl.array<3 x vector<3xf32>>>`
  }];
  let arguments = (ins Arg<Rtsl_Ptr, "", [MemWrite]>:$address);
  let assemblyFormat = "$address attr-dict `:` type($address)";
}

def Rtsl_LoadOp : Rtsl_Op<"load", [
    TypesMatchWith<"the result is what the address points to", "address", "result",
                   "::llvm::cast<::rtsl::ir::PtrType>($_self).getPointee()">,
    Rtsl_MemOp, Rtsl_Safe]> {
  let summary = "reads a scalar, a vector or a reference";
  let description = [{
    Example: `%t = rtsl.load %address : !rtsl.ptr<f32>`
  }];
  let arguments = (ins Arg<Rtsl_PtrToValue, "", [MemRead]>:$address);
  let results = (outs Rtsl_Value:$result);
  let assemblyFormat = "$address attr-dict `:` type($address)";
  let builders = [OpBuilder<(ins "::mlir::Value":$address)>];
  let hasFolder = 1;
}

def Rtsl_StoreOp : Rtsl_Op<"store", [
    TypesMatchWith<"the value is what the address points to", "address", "value",
                   "::llvm::cast<::rtsl::ir::PtrType>($_self).getPointee()">,
    Rtsl_MemOp, Rtsl_Safe]> {
  let summary = "writes a scalar, a vector or a reference";
  let description = [{
    Example: `rtsl.store %value, %address : !rtsl.ptr<f32>`
  }];
  let arguments = (ins Rtsl_Value:$value, Arg<Rtsl_PtrToValue, "", [MemWrite]>:$address);
  let assemblyFormat = "$value `,` $address attr-dict `:` type($address)";
}

def Rtsl_CopyOp : Rtsl_Op<"copy", [AllTypesMatch<["source", "target"]>, Rtsl_Accessor, Rtsl_Safe]> {
  let summary = "copies a whole value in memory";
  let description = [{
    Source and target are the same or do not overlap.

    Example: `rtsl.copy %from to %to : !rtsl.ptr<!rtsl.struct<"Ray", {origin: vector<3xf32>}>>`
  }];
  let arguments = (ins Arg<Rtsl_Ptr, "", [MemRead]>:$source, Arg<Rtsl_Ptr, "", [MemWrite]>:$target);
  let assemblyFormat = "$source `to` $target attr-dict `:` type($source)";
  let hasCanonicalizeMethod = 1;
}

def Rtsl_FieldOp : Rtsl_Op<"field", [Pure, Rtsl_Accessor, Rtsl_Safe]> {
  let summary = "address of a field of a struct";
  let description = [{
    Example: `%o = rtsl.field %ray["origin"]
             : !rtsl.ptr<!rtsl.struct<"Ray", {origin: f32}>> -> !rtsl.ptr<f32>`
  }];
  let arguments = (ins Rtsl_PtrToStruct:$base, StrAttr:$field);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$base `[` $field `]` attr-dict `:` type($base) `->` type($result)";
  let hasVerifier = 1;
  let builders = [OpBuilder<(ins "::mlir::Value":$base, "::llvm::StringRef":$field)>];
}

def Rtsl_ElementOp : Rtsl_Op<"element", [Pure, Rtsl_Accessor, Rtsl_Safe]> {
  let summary = "address of an element of an array or of a column of a matrix";
  let description = [{
    The index is in range: lowering clamps an index that is not constant.

    Example: `%e = rtsl.element %array[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> !rtsl.ptr<f32>`
  }];
  let arguments = (ins Rtsl_PtrToArray:$base, I32:$index);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$base `[` $index `]` attr-dict `:` type($base) `->` type($result)";
  let hasVerifier = 1;
  let builders = [OpBuilder<(ins "::mlir::Value":$base, "::mlir::Value":$index)>];
  let extraClassDeclaration = [{
    /// The index, if it is a constant.
    std::optional<int32_t> constantIndex();
  }];
}

def Rtsl_MemberOp : Rtsl_Op<"member", [Pure, Rtsl_Named, Rtsl_SymbolUser]> {
  let summary = "address of a member of an object";
  let description = [{
    The object must not be null. Members are constant for a launch, except in the constructor of
    their object.

    Example: `%eta = rtsl.member %self["eta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>`
  }];
  let arguments = (ins Rtsl_Ref:$object, StrAttr:$member);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$object `[` $member `]` attr-dict `:` type($object) `->` type($result)";
}

def Rtsl_StateOp : Rtsl_Op<"state", [Pure, Rtsl_Named]> {
  let summary = "address of a state variable of the ray";
  let description = [{
    The names are those of language/StateVariables.def: `RayOrigin` is `rt_RayOrigin` in the source.
    `hitError` is that of RtslState, which has no name in the source.

    Example: `%o = rtsl.state "RayOrigin" : !rtsl.ptr<vector<3xf32>>`
  }];
  let arguments = (ins StrAttr:$name);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$name attr-dict `:` type($result)";
  let hasVerifier = 1;
  let builders = [OpBuilder<(ins "::llvm::StringRef":$name, "::mlir::Type":$type)>];
}

def Rtsl_AttributeOp : Rtsl_Op<"attribute", [Pure, Rtsl_Named]> {
  let summary = "address of a scratch member of the hit";
  let description = [{
    The value that `intersect` wrote for the nearest hit. The linker matches names between
    primitives and materials and sets `offset`, in 32-bit words from the start of
    `RtslState::attributes`; without it the op cannot be compiled.

    With `axis` it is how an attribute of a mesh changes along an axis of the footprint of the ray,
    0 for dPdx and 1 for dPdy. On primitives that is 0.

    Example: `%n = rtsl.attribute "n" {offset = 0 : i32} : !rtsl.ptr<vector<3xf32>>`
  }];
  let arguments = (ins StrAttr:$name, OptionalAttr<I32Attr>:$offset, OptionalAttr<I32Attr>:$axis);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$name attr-dict `:` type($result)";
  let hasVerifier = 1;
  let builders = [OpBuilder<(ins "::llvm::StringRef":$name, "::mlir::Type":$type,
                              CArg<"std::optional<int32_t>", "std::nullopt">:$axis)>];
}

def Rtsl_TableOp : Rtsl_Op<"table", [Pure, Rtsl_Named]> {
  let summary = "address of a constant struct, array or matrix";
  let description = [{
    `words` are its contents, 32 bits each, in the layout of Layout.h. It is never written.

    Example: `%w = rtsl.table "weights" [1056964608, 1048576000] : !rtsl.ptr<!rtsl.array<2 x f32>>`
  }];
  let arguments = (ins StrAttr:$name, DenseI32ArrayAttr:$words);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$name $words attr-dict `:` type($result)";
  let hasVerifier = 1;
}

def Rtsl_BufferElementOp : Rtsl_Op<"buffer_element", []> {
  let summary = "address of an element of a buffer";
  let description = [{
    One index for each dimension, all in range: lowering clamps them.

    Example: `%v = rtsl.buffer_element %b[%i] : !rtsl.ptr<!rtsl.buffer<f32, 1>> -> !rtsl.ptr<f32>`
  }];
  let arguments = (ins Arg<Rtsl_PtrToBuffer, "", [MemRead]>:$buffer, Variadic<I32>:$indices);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$buffer `[` $indices `]` attr-dict `:` type($buffer) `->` type($result)";
  let hasVerifier = 1;
  let builders = [OpBuilder<(ins "::mlir::Value":$buffer, "::mlir::ValueRange":$indices)>];
}

def Rtsl_AtomicKind : I32Enum<"AtomicKind", "what an atomic operation makes of a word", [
  I32EnumCase<"Add", 0, "add">, I32EnumCase<"MinSigned", 1, "smin">,
  I32EnumCase<"MaxSigned", 2, "smax">,
  I32EnumCase<"MinUnsigned", 3, "umin">, I32EnumCase<"MaxUnsigned", 4, "umax">,
  I32EnumCase<"And", 5, "and">,
  I32EnumCase<"Or", 6, "or">, I32EnumCase<"Xor", 7, "xor">, I32EnumCase<"Exchange", 8, "exchange">,
  I32EnumCase<"CompareExchange", 9, "compare_exchange">
]> {
  let cppNamespace = "::rtsl::ir";
}

def Rtsl_AtomicOp : Rtsl_Op<"atomic"> {
  let summary = "changes a word of an output buffer in one step";
  let description = [{
    The result is the word as it was. `compare_exchange` writes `value` if the word equals
    `expected`, which the others do not have.

    Example: `%old = rtsl.atomic add %address, %value : !rtsl.ptr<i32>`
  }];
  let arguments = (ins EnumAttr<Rtsl_Dialect, Rtsl_AtomicKind, "atomic_kind">:$kind,
                       Arg<Rtsl_PtrToValue, "", [MemRead, MemWrite]>:$address, I32:$value,
                       Optional<I32>:$expected);
  let results = (outs I32:$result);
  let assemblyFormat = "$kind $address `,` $value (`if` $expected^)? attr-dict `:` type($address)";
  let hasVerifier = 1;
}

def Rtsl_BufferLengthOp : Rtsl_Op<"buffer_length", []> {
  let summary = "number of elements of a buffer along a dimension";
  let description = [{
    Example: `%n = rtsl.buffer_length %b, 0 : !rtsl.ptr<!rtsl.buffer<f32, 1>>`
  }];
  let arguments = (ins Arg<Rtsl_PtrToBuffer, "", [MemRead]>:$buffer, I32Attr:$dim);
  let results = (outs I32:$result);
  let assemblyFormat = "$buffer `,` $dim attr-dict `:` type($buffer)";
  let hasVerifier = 1;
}

//===----------------------------------------------------------------------===//
// References
//===----------------------------------------------------------------------===//

def Rtsl_NullRefOp : Rtsl_Op<"null_ref", [Pure]> {
  let summary = "the null reference";
  let description = [{
    Example: `%none = rtsl.null_ref : !rtsl.ref<"rt_Texture">`
  }];
  let results = (outs Rtsl_Ref:$result);
  let assemblyFormat = "attr-dict `:` type($result)";
}

def Rtsl_CastRefOp : Rtsl_Op<"cast_ref", [Pure]> {
  let summary = "the same object seen as one of another class";
  let description = [{
    Costs nothing and checks nothing: to a base class, or to a derived class where the class is
    known.

    Example: `%t = rtsl.cast_ref %checker : !rtsl.ref<"Checker"> -> !rtsl.ref<"rt_Texture">`
  }];
  let arguments = (ins Rtsl_Ref:$object);
  let results = (outs Rtsl_Ref:$result);
  let assemblyFormat = "$object attr-dict `:` type($object) `->` type($result)";
  let hasFolder = 1;
}

def Rtsl_ClassIdOp : Rtsl_Op<"class_id", [Pure]> {
  let summary = "class of an object as a number from 1; 0 for the null reference";
  let description = [{
    Example: `%id = rtsl.class_id %texture : !rtsl.ref<"rt_Texture">`
  }];
  let arguments = (ins Rtsl_Ref:$object);
  let results = (outs I32:$result);
  let assemblyFormat = "$object attr-dict `:` type($object)";
  let hasFolder = 1;
}

def Rtsl_EqualRefOp : Rtsl_Op<"equal_ref", [Pure]> {
  let summary = "whether two references are to the same object, or both null";
  let description = [{
    Example: `%same = rtsl.equal_ref %a, %b : !rtsl.ref<"A">, !rtsl.ref<"B">`
  }];
  let arguments = (ins Rtsl_Ref:$lhs, Rtsl_Ref:$rhs);
  let results = (outs I1:$result);
  let assemblyFormat = "$lhs `,` $rhs attr-dict `:` type($lhs) `,` type($rhs)";
  let hasFolder = 1;
}

def Rtsl_CallMethodOp : Rtsl_Op<"call_method"> {
  let summary = "calls the method that the object's class defines";
  let description = [{
    A dispatch slot: linking, when all classes are known, replaces it by a call of a function that
    switches over them.

    Example: `%c = rtsl.call_method "weight" on %t(%x) : !rtsl.ref<"rt_Texture">, (f32) -> f32`
  }];
  let arguments = (ins StrAttr:$method, Rtsl_Ref:$object, Variadic<AnyType>:$arguments);
  let results = (outs Variadic<Rtsl_Value>:$results);
  let assemblyFormat = [{
    $method `on` $object `(` $arguments `)`
    attr-dict `:` type($object) `,` functional-type($arguments, $results)
  }];
}

//===----------------------------------------------------------------------===//
// Numbers
//===----------------------------------------------------------------------===//

// Those of math/ElementaryFunctions.def (CMakeLists.txt).
include "codegen/ir/dialect/ElementaryFunctions.td"

def Rtsl_Elementary : I32Enum<"Elementary", "elementary function", Rtsl_ElementaryCases> {
  let cppNamespace = "::rtsl::ir";
}

def Rtsl_ElementaryAttr : EnumAttr<Rtsl_Dialect, Rtsl_Elementary, "elementary"> {
  let assemblyFormat = "`<` $value `>`";
}

def Rtsl_ElementaryOp : Rtsl_Op<"elementary", [Pure, SameOperandsAndResultType]> {
  let summary = "an elementary function, component by component";
  let description = [{
    `pow` (base, exponent) and `atan2` (y, x) have two operands, the others one. Correctly rounded:
    the value does not depend on the host that compiles or the device that runs it. That is why the
    ops of `math` are not used.

    Example: `%s = rtsl.elementary <sin> %x : vector<3xf32>`
  }];
  let arguments = (ins Rtsl_ElementaryAttr:$function, Variadic<Rtsl_FloatLike>:$operands);
  let results = (outs Rtsl_FloatLike:$result);
  let assemblyFormat = "$function $operands attr-dict `:` type($result)";
  let hasVerifier = 1;
  let hasFolder = 1;
}

def Rtsl_RefractOp : Rtsl_Op<"refract", [Pure, AllTypesMatch<["incident", "normal", "result"]>]> {
  let summary = "refract(i, n, eta), with total reflection decided exactly (math/Refraction.h)";
  let description = "Example: `%r = rtsl.refract %i, %n, %eta : vector<3xf32>`";
  let arguments = (ins Rtsl_FloatLike:$incident, Rtsl_FloatLike:$normal, F32:$eta);
  let results = (outs Rtsl_FloatLike:$result);
  let assemblyFormat = "$incident `,` $normal `,` $eta attr-dict `:` type($result)";
  let hasFolder = 1;
}

def Rtsl_HideOp : Rtsl_Op<"hide", [Pure, SameOperandsAndResultType]> {
  let summary = "its operand, opaque to all passes";
  let description = [{
    If arithmetic is done in double, nothing may be folded in single precision: constants, and
    integers that become floats, are hidden until LLVM IR has been widened
    (codegen/lower/HideConstants.h).

    Example: `%h = rtsl.hide %c : f32`
  }];
  let arguments = (ins AnyType:$value);
  let results = (outs AnyType:$result);
  let assemblyFormat = "$value attr-dict `:` type($value)";
}

class Rtsl_ToIntOp<string opMnemonic, string range> : Rtsl_Op<opMnemonic, [Pure,
    TypesMatchWith<"the result has the operand's shape", "input", "result",
                   "::rtsl::ir::intLike($_self)">]> {
  let summary = "float to integer in " # range # ": truncates, saturates, NaN gives 0";
  let description = "Example: `%i = rtsl." # opMnemonic # " %x : f32`";
  let arguments = (ins Rtsl_FloatLike:$input);
  let results = (outs Rtsl_IntLike:$result);
  let assemblyFormat = "$input attr-dict `:` type($input)";
  let hasFolder = 1;
}
def Rtsl_ToSintOp : Rtsl_ToIntOp<"to_sint", "[-2^31, 2^31)">;
def Rtsl_ToUintOp : Rtsl_ToIntOp<"to_uint", "[0, 2^32)">;

class Rtsl_DivisionOp<string opMnemonic, string what> : Rtsl_Op<opMnemonic,
                                                                [Pure, SameOperandsAndResultType]> {
  let summary = what # "; by zero gives 0";
  let description = [{
    Defined for all operands: by zero the result is 0, and the smallest signed number divided by -1
    is itself, with remainder 0. Rounds towards zero.

  }] # "Example: `%q = rtsl." # opMnemonic # " %a, %b : i32`";
  let arguments = (ins Rtsl_IntLike:$lhs, Rtsl_IntLike:$rhs);
  let results = (outs Rtsl_IntLike:$result);
  let assemblyFormat = "$lhs `,` $rhs attr-dict `:` type($result)";
  let hasFolder = 1;
}
def Rtsl_SDivOp : Rtsl_DivisionOp<"sdiv", "signed quotient">;
def Rtsl_UDivOp : Rtsl_DivisionOp<"udiv", "unsigned quotient">;
def Rtsl_SRemOp : Rtsl_DivisionOp<"srem", "signed remainder, with the sign of the dividend">;
def Rtsl_URemOp : Rtsl_DivisionOp<"urem", "unsigned remainder">;

//===----------------------------------------------------------------------===//
// Structured control flow (level 1)
//===----------------------------------------------------------------------===//

def Rtsl_IfOp : Rtsl_Op<"if", [NoRegionArguments]> {
  let summary = "a choice";
  let description = [{
    Each region ends in `rtsl.yield` (continue after the `rtsl.if`), `rtsl.break`, `rtsl.continue`
    or `rtsl.return`.

    ```mlir
    rtsl.if %c {
      rtsl.return
    } else {
      rtsl.yield
    }
    ```
  }];
  let arguments = (ins I1:$condition);
  let regions = (region SizedRegion<1>:$thenRegion, MaxSizedRegion<1>:$elseRegion);
  let assemblyFormat = "$condition $thenRegion (`else` $elseRegion^)? attr-dict-with-keyword";
}

def Rtsl_LoopOp : Rtsl_Op<"loop", [NoRegionArguments]> {
  let summary = "a loop";
  let description = [{
    Runs `cond`, which ends in `rtsl.condition`, then, while that is true, `do` and `step`. With
    `post_test` the test comes after `step`: `do`, `step`, `cond`, and again. A missing `cond` is
    always true, a missing `step` does nothing. `rtsl.continue` and `rtsl.yield` in the body go to
    `step`, `rtsl.break` leaves the loop. `cond` and `step` contain no break or continue of their
    own; they may return, as where `ignoreIntersection` in a called function ends `anyHit`.

    ```mlir
    rtsl.loop cond {
      %v = rtsl.load %i : !rtsl.ptr<i32>
      %c = arith.cmpi slt, %v, %n : i32
      rtsl.condition %c
    } do {
      rtsl.yield
    } step {
      rtsl.yield
    }
    ```
  }];
  let arguments = (ins UnitAttr:$postTest);
  let regions = (region MaxSizedRegion<1>:$condition, SizedRegion<1>:$body,
                        MaxSizedRegion<1>:$step);
  let assemblyFormat = [{
    (`post_test` $postTest^)? (`cond` $condition^)? `do` $body (`step` $step^)?
    attr-dict-with-keyword
  }];
  let hasRegionVerifier = 1;
}

def Rtsl_SwitchOp : Rtsl_Op<"switch", [NoRegionArguments]> {
  let summary = "a choice among several by a number";
  let description = [{
    Control enters at the arm that lists the value, or at `default`, or skips the switch. An arm
    that ends in `rtsl.yield` falls into the next (the last one: leaves); `rtsl.break` leaves.

    ```mlir
    rtsl.switch %v : i32 {
      arm [1, 2] {
        rtsl.break
      }
      arm [3] default {
        rtsl.yield
      }
    }
    ```
  }];
  let arguments = (ins I32:$value, ArrayAttr:$values, OptionalAttr<I32Attr>:$defaultArm);
  let regions = (region VariadicRegion<SizedRegion<1>>:$arms);
  let assemblyFormat = [{
    $value `:` type($value) custom<SwitchArms>($values, $defaultArm, $arms) attr-dict-with-keyword
  }];
  let hasVerifier = 1;
  let skipDefaultBuilders = 1;
  let builders = [
    // `values` has one entry for each arm; each arm gets an empty block. `defaultArm` is the index
    // of an arm.
    OpBuilder<(ins "::mlir::Value":$value, "::llvm::ArrayRef<::llvm::SmallVector<int32_t>>":$values,
                   "std::optional<unsigned>":$defaultArm)>];
  let extraClassDeclaration = [{
    /// The numbers that choose arm `index`.
    ::llvm::ArrayRef<int32_t> armValues(unsigned index);
  }];
}

def Rtsl_IlluminanceOp : Rtsl_Op<"illuminance", [AttrSizedOperandSegments, NoRegionArguments]> {
  let summary = "a loop over the lights that reach a point";
  let description = [{
    The body runs for each light for which `rtsl.illuminate` would give true, with LightDirection,
    LightDistance and LightColor set. `rtsl.break` and `rtsl.continue` work as in a loop.

    ```mlir
    rtsl.illuminance %point normal %n cos %c {
      rtsl.yield
    }
    ```
  }];
  let arguments = (ins Rtsl_Vec3:$point, Optional<Rtsl_Vec3>:$normal, Optional<F32>:$cosAngle);
  let regions = (region SizedRegion<1>:$body);
  let assemblyFormat = "$point (`normal` $normal^ `cos` $cosAngle)? $body attr-dict-with-keyword";
  let hasVerifier = 1;
}

def Rtsl_YieldOp : Rtsl_Op<"yield", [Pure, Terminator,
                                     ParentOneOf<["IfOp", "LoopOp", "SwitchOp",
                                                  "IlluminanceOp"]>]> {
  let summary = "end of a region; the structured op determines where control goes";
  let assemblyFormat = "attr-dict";
}

def Rtsl_ConditionOp : Rtsl_Op<"condition", [Pure, Terminator, HasParent<"LoopOp">]> {
  let summary = "end of a loop's `cond`: continues if true";
  let arguments = (ins I1:$condition);
  let assemblyFormat = "$condition attr-dict";
}

def Rtsl_BreakOp : Rtsl_Op<"break", [Terminator]> {
  let summary = "leaves the innermost loop, illuminance or switch";
  let assemblyFormat = "attr-dict";
  let hasVerifier = 1;
}

def Rtsl_ContinueOp : Rtsl_Op<"continue", [Terminator]> {
  let summary = "goes to the next iteration of the innermost loop or illuminance";
  let assemblyFormat = "attr-dict";
  let hasVerifier = 1;
}

def Rtsl_ReturnOp : Rtsl_Op<"return", [Terminator]> {
  let summary = "leaves the function, with a value if it has one";
  let description = [{
    May stand at any depth of structured ops. Becomes `func.return` on level 2.

    Example: `rtsl.return %t : f32`
  }];
  let arguments = (ins Variadic<Rtsl_Value>:$values);
  let assemblyFormat = "attr-dict ($values^ `:` type($values))?";
  let hasVerifier = 1;
  let builders = [OpBuilder<(ins), [{}]>];
}

include "codegen/ir/dialect/RtslRayOps.td"
include "codegen/ir/dialect/RtslContinuationOps.td"
include "codegen/ir/dialect/RtslSourceOps.td"

#endif
