//===- RtslContinuationOps.td - continuations (level 2) -------------------===//
//
// The operations that replace `rtsl.trace` when a function is split there, in the order in which
// the passes of codegen/passes/continuation make them. Included by RtslOps.td.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_CONTINUATION_OPS_TD
#define RTSL_CONTINUATION_OPS_TD

include "mlir/Interfaces/ControlFlowInterfaces.td"

// The frame: memory that belongs to the ray and that no other operation accesses.
def Rtsl_FrameResource : Resource<"::rtsl::ir::FrameResource">;

def Rtsl_SuspendOp : Rtsl_Op<"suspend", [Terminator, AttrSizedOperandSegments,
    DeclareOpInterfaceMethods<BranchOpInterface>]> {
  let summary = "traces a ray and resumes at a block when it returns";
  let description = [{
    Every value that is live in the `resume` block has to survive the trace. The operands passed to
    its arguments are saved and restored; `names` gives the name of each in the source. A value has
    one unique name in the whole function, so that it keeps its slot from trace to trace. The
    `resume` block begins with `rtsl.trace_result`, and this op is its only predecessor. A ray with
    a payload is prepared before, by `rtsl.spawn_payload`: then no ray is named here, and the
    `resume` block begins with `rtsl.trace_returned`. A call is prepared before by `rtsl.enter`; its
    block begins with `rtsl.call_returned`.

    Example: `rtsl.suspend %origin, %direction, ^resume(%i : i32) names ["i"]`
  }];
  let arguments = (ins Optional<Rtsl_Vec3>:$origin, Optional<Rtsl_Vec3>:$direction,
                       Variadic<Rtsl_Value>:$saved,
                       DefaultValuedAttr<StrArrayAttr, "{}">:$names);
  let successors = (successor AnySuccessor:$resume);
  let assemblyFormat = [{
    ($origin^ `,` $direction `,`)? $resume (`(` $saved^ `:` type($saved) `)`)?
    (`names` $names^)? attr-dict
  }];
  let hasVerifier = 1;
}

def Rtsl_TraceResultOp : Rtsl_Op<"trace_result", []> {
  let summary = "the color that the traced ray returned";
  let description = [{
    The first operation of the block, or of the function, that a suspended trace resumes at.

    Example: `%c = rtsl.trace_result : vector<3xf32>`
  }];
  let results = (outs Rtsl_Color:$color);
  let assemblyFormat = "attr-dict `:` type($color)";
}

def Rtsl_TraceReturnedOp : Rtsl_Op<"trace_returned", []> {
  let summary = "a ray with a payload has returned";
  let description = [{
    Used in place of `rtsl.trace_result`; the result is in the payload. It generates no code.

    Example: `rtsl.trace_returned`
  }];
  let assemblyFormat = "attr-dict";
}

def Rtsl_FrameLoadOp : Rtsl_Op<"frame_load", [Rtsl_Named]> {
  let summary = "restores a value from the frame";
  let description = [{
    The name is the slot's, the number its offset in bytes. A bool takes one bit of a word.

    Example: `%i = rtsl.frame_load "i"[0] : i32`
    Example: `%inside = rtsl.frame_load "inside"[4] bit 2 : i1`
  }];
  let arguments = (ins StrAttr:$name, I32Attr:$offset, OptionalAttr<I32Attr>:$bit);
  let results = (outs Res<Rtsl_Value, "", [MemRead<Rtsl_FrameResource>]>:$result);
  let assemblyFormat = "$name `[` $offset `]` (`bit` $bit^)? attr-dict `:` type($result)";
  let hasVerifier = 1;
}

def Rtsl_FrameStoreOp : Rtsl_Op<"frame_store", [MemoryEffects<[MemWrite<Rtsl_FrameResource>]>]> {
  let summary = "saves a value in the frame";
  let description = [{
    Example: `rtsl.frame_store %i, "i"[0] : i32`
  }];
  let arguments = (ins Rtsl_Value:$value, StrAttr:$name, I32Attr:$offset,
                       OptionalAttr<I32Attr>:$bit);
  let assemblyFormat = "$value `,` $name `[` $offset `]` (`bit` $bit^)? attr-dict `:` type($value)";
  let hasVerifier = 1;
}

def Rtsl_FrameObjectOp : Rtsl_Op<"frame_object", [Pure, Rtsl_Named]> {
  let summary = "address of a variable in the frame";
  let description = [{
    For a variable that is indexed at run time and live across a trace. It shares no words with
    saved values while live.

    Example: `%table = rtsl.frame_object "table"[8] : !rtsl.ptr<!rtsl.array<4 x f32>>`
  }];
  let arguments = (ins StrAttr:$name, I32Attr:$offset);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$name `[` $offset `]` attr-dict `:` type($result)";
}

def Rtsl_SpawnOp : Rtsl_Op<"spawn", []> {
  let summary = "prepares the ray that is traced when this state ends";
  let description = [{
    Followed by the end of the state, with `rtsl.next trace`. With `last` the ray is a tail trace
    and replaces the one that sends it: then `rtsl.next last` follows, and control does not return
    here.

    Example: `rtsl.spawn %origin, %direction`
  }];
  let arguments = (ins Rtsl_Vec3:$origin, Rtsl_Vec3:$direction, UnitAttr:$last);
  let assemblyFormat = "$origin `,` $direction (`last` $last^)? attr-dict";
}

def Rtsl_SpawnPayloadOp : Rtsl_Op<"spawn_payload", [AttrSizedOperandSegments]> {
  let summary = "prepares a ray with a payload, which is traced when this state ends";
  let description = [{
    Has the operands of `rtsl.trace_payload`. The payload is in the frame; with `last`, for a tail
    trace (see `rtsl.spawn`), it is the payload of the ray that sends this one.

    Example: `rtsl.spawn_payload %o, %d from %a to %b carries %p
             : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>`
  }];
  let arguments = (ins Rtsl_Vec3:$origin, Rtsl_Vec3:$direction, F32:$tmin, F32:$tmax,
                       Rtsl_PtrToStruct:$payload, Optional<I32>:$root,
                       Optional<I32>:$mask, Optional<F32>:$time, OptionalAttr<I32Attr>:$ray_type,
                       OptionalAttr<I32Attr>:$how, UnitAttr:$last);
  let assemblyFormat = [{
    $origin `,` $direction `from` $tmin `to` $tmax `carries` $payload (`root` $root^)?
    (`mask` $mask^)? (`time` $time^)?
    (`last` $last^)? attr-dict `:` type($payload)
  }];
}

// Calls with a frame of their own. The callee runs for the same ray, on a frame above that of its
// caller:
//
//   bytes 0 to 11   the state in which the caller resumes, the caller's object, and how far below
//                   this frame its own begins
//   from 16 on      arguments, then results, then the values that the callee saves

def Rtsl_EnterOp : Rtsl_Op<"enter", []> {
  let summary = "prepares a call that is made when this state ends";
  let description = [{
    Comes before a suspend that names no ray. If the callee is a method, its object is the first
    argument; `offsets` are those of the other arguments in its frame. `writes` names the state
    variables that the call may change; without it, all. `resume` is the state in which the caller
    resumes, once it is known.

    Example: `rtsl.enter @Tint.follow(%tint, %d) at [16] : !rtsl.ref<"Tint">, vector<3xf32>`
  }];
  let arguments = (ins FlatSymbolRefAttr:$callee, Variadic<AnyType>:$operands,
                       DenseI32ArrayAttr:$offsets,
                       OptionalAttr<StrArrayAttr>:$writes, OptionalAttr<FlatSymbolRefAttr>:$resume);
  let assemblyFormat = [{
    $callee `(` $operands `)` `at` $offsets (`writes` $writes^)? (`then` $resume^)? attr-dict
    (`:` type($operands)^)?
  }];
}

def Rtsl_CallReturnedOp : Rtsl_Op<"call_returned", []> {
  let summary = "a call has returned";
  let description = [{
    Used in place of `rtsl.trace_result`; the results are at `offsets` in the frame of the callee.

    Example: `%c = rtsl.call_returned at [28] : vector<3xf32>`
  }];
  let arguments = (ins DenseI32ArrayAttr:$offsets);
  let results = (outs Variadic<Rtsl_Value>:$results);
  let assemblyFormat = "`at` $offsets attr-dict (`:` type($results)^)?";
}

def Rtsl_CallArgumentOp : Rtsl_Op<"call_argument", [Pure, Rtsl_Named]> {
  let summary = "an argument of a function with a frame of its own";
  let description = [{
    It is not written while the function runs, so it may be read again at any time.

    Example: `%d = rtsl.call_argument "d"[16] : vector<3xf32>`
  }];
  let arguments = (ins StrAttr:$name, I32Attr:$offset);
  let results = (outs AnyType:$result);
  let assemblyFormat = "$name `[` $offset `]` attr-dict `:` type($result)";
}

def Rtsl_CallResultOp : Rtsl_Op<"call_result", [MemoryEffects<[MemWrite<Rtsl_FrameResource>]>]> {
  let summary = "stores a result for the caller";
  let description = [{
    Example: `rtsl.call_result %c, [28] : vector<3xf32>`
  }];
  let arguments = (ins Rtsl_Value:$value, I32Attr:$offset);
  let assemblyFormat = "$value `,` `[` $offset `]` attr-dict `:` type($value)";
}

def Rtsl_LeaveOp : Rtsl_Op<"leave", []> {
  let summary = "returns to the object and the frame of the caller";
  let description = [{
    Followed by the end of the state, with `rtsl.next return`.
  }];
  let assemblyFormat = "attr-dict";
}

def Rtsl_MoveFrameOp : Rtsl_Op<"move_frame", []> {
  let summary = "the ray continues with another object, on a frame this many bytes further up";
  let description = [{
    Replaces `rtsl.enter` and `rtsl.leave`.

    Example: `rtsl.move_frame %bytes to %object : !rtsl.ref<"Tint">`
  }];
  let arguments = (ins I32:$bytes, Rtsl_Ref:$object);
  let assemblyFormat = "$bytes `to` $object attr-dict `:` type($object)";
}

def Rtsl_KeepAddressOp : Rtsl_Op<"keep_address", []> {
  let summary = "writes an address to a frame";
  let description = [{
    Example: `rtsl.keep_address %p, %slot : !rtsl.ptr<!rtsl.array<4 x f32>>, !rtsl.ptr<i32>`
  }];
  let arguments = (ins Rtsl_Ptr:$value, Arg<Rtsl_Ptr, "", [MemWrite]>:$slot);
  let assemblyFormat = "$value `,` $slot attr-dict `:` type($value) `,` type($slot)";
}

def Rtsl_KeptAddressOp : Rtsl_Op<"kept_address", []> {
  let summary = "reads an address from a frame";
  let description = [{
    Example: `%p = rtsl.kept_address %slot : !rtsl.ptr<i32> -> !rtsl.ptr<!rtsl.array<4 x f32>>`
  }];
  let arguments = (ins Arg<Rtsl_Ptr, "", [MemRead]>:$slot);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$slot attr-dict `:` type($slot) `->` type($result)";
}

def Rtsl_Transition : I32Enum<"Transition", "what happens when a state ends", [
    I32EnumCase<"Done", 0, "done">, I32EnumCase<"Trace", 1, "trace">,
    I32EnumCase<"Jump", 2, "jump">,
    I32EnumCase<"Last", 3, "last">, I32EnumCase<"Return", 4, "return">]> {
  let cppNamespace = "::rtsl::ir";
}

def Rtsl_NextOp : Rtsl_Op<"next", [Pure]> {
  let summary = "the transition at the end of this state, as a number";
  let description = [{
    `done`: the method has returned. `trace @s`: the spawned ray is traced, then state `@s` runs.
    `jump @s`: state `@s` runs at once. `last`: the spawned ray is a tail trace that replaces this
    one. `return`: the caller's state runs at once. Numbers are assigned when the program is
    complete: 0 for done, the number of the state for `trace`, its negative for `jump` and `return`,
    RTSL_NEXT_LAST for `last`.

    Example: `%next = rtsl.next trace @Glass.shade.state1`
  }];
  let arguments = (ins EnumAttr<Rtsl_Dialect, Rtsl_Transition, "transition">:$transition,
                       OptionalAttr<FlatSymbolRefAttr>:$state);
  let results = (outs I32:$result);
  // the attribute prints a space before itself
  let assemblyFormat = "`` $transition ($state^)? attr-dict";
  let hasVerifier = 1;
}

def Rtsl_EndOp : Rtsl_Op<"end", [Pure, Terminator, ReturnLike]> {
  let summary = "ends a state";
  let description = [{
    Example: `rtsl.end %next`
  }];
  let arguments = (ins I32:$next);
  let assemblyFormat = "$next attr-dict";
}

def Rtsl_FrameSlotOp : Rtsl_Op<"frame_slot", [Pure]> {
  let summary = "address of a frame slot";
  let description = [{
    Used by accesses of the frame once it is a parameter. The number is the offset in bytes.

    Example: `%p = rtsl.frame_slot %frame[8] : !rtsl.ptr<i32> -> !rtsl.ptr<vector<3xf32>>`
  }];
  let arguments = (ins Rtsl_PtrToValue:$frame, I32Attr:$offset);
  let results = (outs Rtsl_Ptr:$result);
  let assemblyFormat = "$frame `[` $offset `]` attr-dict `:` type($frame) `->` type($result)";
}

#endif
