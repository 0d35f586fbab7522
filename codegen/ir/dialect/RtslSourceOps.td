//===- RtslSourceOps.td - expressions that stay as they were written ------===//
//
// They replace the operations of an expression if C++ is to be printed from the IR: the passes use
// its operands and its cost, and the printer finds its tree in codegen/lower/SourceTable.h. They
// cannot be compiled to machine code.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_SOURCE_OPS_TD
#define RTSL_SOURCE_OPS_TD

def Rtsl_ExpressionOp : Rtsl_Op<"expression", [Pure]> {
  let summary = "an expression of the source without side effects";
  let description = [{
    `source` is its number in the table. The operands are the parts of it whose values may change:
    local variables, state variables, and parts that have effects. `cost` estimates the number of
    instructions.

    Example: `%w = rtsl.expression 3 cost 2 (%cosine, %ratio) : (f32, f32) -> f32`
  }];
  let arguments = (ins I32Attr:$source, I32Attr:$cost, Variadic<Rtsl_Value>:$operands);
  let results = (outs Rtsl_Value:$result);
  let assemblyFormat = [{
    $source `cost` $cost `(` $operands `)` attr-dict `:` functional-type($operands, $result)
  }];
}

def Rtsl_ValueOrPtr : AnyTypeOf<[Rtsl_Value, Rtsl_Ptr]>;

def Rtsl_EvaluateOp : Rtsl_Op<"evaluate"> {
  let summary = "a call in the source that may have side effects";
  let description = [{
    The operands are the parts of it whose values may change: values, and addresses of variables
    that stay whole. `writes` names the state variables that it may change; without it, all.
    RtslDiscardableAttributes.td explains `rtsl.into`, `rtsl.changes`, `rtsl.plain` and
    `rtsl.nested`, which describe its other effects.

    Example: `%f = rtsl.evaluate 4 (%x) writes ["LightColor"] : (f32) -> f32`
  }];
  let arguments = (ins I32Attr:$source, Variadic<Rtsl_ValueOrPtr>:$operands,
                       OptionalAttr<StrArrayAttr>:$writes);
  let results = (outs Variadic<Rtsl_Value>:$results);
  let assemblyFormat = [{
    $source `(` $operands `)` (`writes` $writes^)?
    attr-dict `:` functional-type($operands, $results)
  }];
}

#endif
