//===- RtslTypes.td - types of the `rtsl` dialect -------------------------===//
#ifndef RTSL_TYPES_TD
#define RTSL_TYPES_TD

include "mlir/IR/AttrTypeBase.td"
include "mlir/IR/BuiltinTypeInterfaces.td"
include "mlir/Interfaces/MemorySlotInterfaces.td"
include "codegen/ir/dialect/RtslDialect.td"

class Rtsl_Type<string name, string typeMnemonic, list<Trait> traits = []> : TypeDef<Rtsl_Dialect,
                                                                                     name, traits> {
  let mnemonic = typeMnemonic;
}

def Rtsl_RefType : Rtsl_Type<"Ref", "ref"> {
  let summary = "reference to an object of the scene";
  let description = [{
    Refers to an object of the named class or of one derived from it, or is null. In memory it is
    the byte offset of the object's record, 32 bits; 0 is null.

    Example: `!rtsl.ref<"rt_Texture">`
  }];
  let parameters = (ins StringRefParameter<"name of the class">:$className);
  let assemblyFormat = "`<` $className `>`";
  let genVerifyDecl = 1;
}

def Rtsl_PtrType : Rtsl_Type<"Ptr", "ptr"> {
  let summary = "address in memory";
  let description = [{
    Example: `!rtsl.ptr<vector<3xf32>>`
  }];
  let parameters = (ins "::mlir::Type":$pointee);
  let assemblyFormat = "`<` $pointee `>`";
  let builders = [TypeBuilderWithInferredContext<(ins "::mlir::Type":$pointee), [{
    return $_get(pointee.getContext(), pointee);
  }]>];
  let genVerifyDecl = 1;
}

def Rtsl_StructType : Rtsl_Type<"Struct", "struct", [
    DeclareTypeInterfaceMethods<DestructurableTypeInterface>]> {
  let summary = "struct of the source";
  let description = [{
    Two structs are the same type if their names and fields are the same. Fields are in order, each
    aligned to 4 bytes.

    Example: `!rtsl.struct<"Ray", {origin: vector<3xf32>, mask: i32}>`
  }];
  let parameters = (ins
    StringRefParameter<"name of the struct">:$name,
    ArrayRefParameter<"::mlir::StringAttr", "names of the fields">:$fieldNames,
    ArrayRefParameter<"::mlir::Type", "types of the fields">:$fieldTypes);
  let hasCustomAssemblyFormat = 1;
  let genVerifyDecl = 1;
  let extraClassDeclaration = [{
    /// Index of the field called `name`, or nothing.
    std::optional<unsigned> fieldIndex(::llvm::StringRef name) const;
  }];
}

def Rtsl_ArrayType : Rtsl_Type<"Array", "array", [
    DeclareTypeInterfaceMethods<DestructurableTypeInterface>]> {
  let summary = "array of fixed length, or a matrix";
  let description = [{
    A matrix of C columns and R rows is an array of C columns, `!rtsl.array<C x vector<Rxf32>>`.

    Example: `!rtsl.array<4 x f32>`
  }];
  let parameters = (ins "unsigned":$length, "::mlir::Type":$element);
  let assemblyFormat = "`<` $length `x` $element `>`";
  let builders = [TypeBuilderWithInferredContext<(ins "unsigned":$length, "::mlir::Type":$element),
                                                 [{
    return $_get(element.getContext(), length, element);
  }]>];
  let genVerifyDecl = 1;
}

def Rtsl_BufferType : Rtsl_Type<"Buffer", "buffer"> {
  let summary = "unsized array member";
  let description = [{
    Address and sizes of elements that the scene supplies (`RtslBuffer` of
    runtime/device/ray/Launch.h), with 1 to 3 dimensions. The first index is the slowest. `output`:
    the launch writes it; the elements of others are constant.

    Example: `!rtsl.buffer<vector<3xf32>, 1>`, `!rtsl.buffer<f32, 2, output>`
  }];
  let parameters = (ins "::mlir::Type":$element, "unsigned":$rank,
                        DefaultValuedParameter<"bool", "false">:$output);
  let assemblyFormat = "`<` $element `,` $rank `` custom<Output>($output) `>`";
  let builders = [TypeBuilderWithInferredContext<(ins "::mlir::Type":$element, "unsigned":$rank,
                                                      CArg<"bool", "false">:$output), [{
    return $_get(element.getContext(), element, rank, output);
  }]>];
  let genVerifyDecl = 1;
}

//===----------------------------------------------------------------------===//
// Constraints
//===----------------------------------------------------------------------===//

class Rtsl_Constraint<string predicate, string what> :
    Type<CPred<"::rtsl::ir::" # predicate # "($_self)">, what>;

// Stated as predicates, not as the types themselves, so that types print in full.
def Rtsl_Ref : Rtsl_Constraint<"isRef", "a reference">;
def Rtsl_Ptr : Rtsl_Constraint<"isPtr", "an address">;
def Rtsl_Value : Rtsl_Constraint<"isValueType", "a scalar, a vector or a reference">;
def Rtsl_FloatLike : Rtsl_Constraint<"isFloatOrVector", "f32 or a vector of f32">;
def Rtsl_IntLike : Rtsl_Constraint<"isIntOrVector", "i32 or a vector of i32">;
def Rtsl_Color : Rtsl_Constraint<"isColor", "a color (vector of 1 to 16 x f32)">;
def Rtsl_Vec3 : Rtsl_Constraint<"isVec3", "vector<3xf32>">,
                BuildableType<"::mlir::VectorType::get({3}, $_builder.getF32Type())">;
def Rtsl_PtrToValue :
    Rtsl_Constraint<"isPtrToValue", "the address of a scalar, a vector or a reference">;
def Rtsl_PtrToStruct :
    Rtsl_Constraint<"isPtrTo<::rtsl::ir::StructType>", "the address of a struct">;
def Rtsl_PtrToArray : Rtsl_Constraint<"isPtrTo<::rtsl::ir::ArrayType>", "the address of an array">;
def Rtsl_PtrToBuffer :
    Rtsl_Constraint<"isPtrTo<::rtsl::ir::BufferType>", "the address of a buffer">;

#endif
