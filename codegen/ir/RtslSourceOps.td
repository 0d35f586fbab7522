//===- RtslSourceOps.td - expressions that stay as the author wrote them --===//
//
// In place of the operations that an expression is made of, where C++ is to be printed from the IR:
// the passes see what it reads and what it costs, the printer has the author's tree
// (codegen/lower/SourceTable.h). There is no machine code for these.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_SOURCE_OPS_TD
#define RTSL_SOURCE_OPS_TD

def Rtsl_ExpressionOp : Rtsl_Op<"expression", [Pure]> {
  let summary = "an expression of the author's that changes nothing";
  let description = [{
    `source` is its number in the table. The operands stand for what in it may change: local variables, state variables,
    and parts that have effects. `cost` is about how many instructions it takes.

    Example: `%w = rtsl.expression 3 cost 2 (%cosine, %ratio) : (f32, f32) -> f32`
  }];
  let arguments = (ins I32Attr:$source, I32Attr:$cost, Variadic<Rtsl_Value>:$operands);
  let results = (outs Rtsl_Value:$result);
  let assemblyFormat = "$source `cost` $cost `(` $operands `)` attr-dict `:` functional-type($operands, $result)";
}

def Rtsl_ValueOrPtr : AnyTypeOf<[Rtsl_Value, Rtsl_Ptr]>;

def Rtsl_EvaluateOp : Rtsl_Op<"evaluate"> {
  let summary = "a call of the author's that may have effects";
  let description = [{
    The operands are what in it may change: values, and addresses of variables that stay whole. `writes` names the state
    variables that may change; without it all may. Attributes.def explains `rtsl.into`, `rtsl.changes`, `rtsl.plain` and
    `rtsl.nested`, which say what else happens.

    Example: `%f = rtsl.evaluate 4 (%x) writes ["LightColor"] : (f32) -> f32`
  }];
  let arguments = (ins I32Attr:$source, Variadic<Rtsl_ValueOrPtr>:$operands, OptionalAttr<StrArrayAttr>:$writes);
  let results = (outs Variadic<Rtsl_Value>:$results);
  let assemblyFormat = [{
    $source `(` $operands `)` (`writes` $writes^)? attr-dict `:` functional-type($operands, $results)
  }];
}

#endif
