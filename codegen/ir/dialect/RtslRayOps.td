//===- RtslRayOps.td - rays, hits, and what is known of a sample ----------===//
//
// What the runtime does for shaders: sending a ray, reporting and answering hits, random numbers,
// light, and messages about the sample.
//
//===----------------------------------------------------------------------===//
#ifndef RTSL_RAY_OPS_TD
#define RTSL_RAY_OPS_TD

def Rtsl_TraceOp : Rtsl_Op<"trace"> {
  let summary = "traces a ray and shades what it hits";
  let description = [{
    The state variables of this ray are unchanged when the child ray returns: the child ray has its
    own.

    Example: `%c = rtsl.trace %origin, %direction : vector<3xf32>`
  }];
  let arguments = (ins Rtsl_Vec3:$origin, Rtsl_Vec3:$direction);
  let results = (outs Rtsl_Color:$color);
  let assemblyFormat = "$origin `,` $direction attr-dict `:` type($color)";
}

def Rtsl_TracePayloadOp : Rtsl_Op<"trace_payload", [AttrSizedOperandSegments]> {
  let summary = "traces a ray that carries a payload";
  let description = [{
    Hits count from `tmin` to `tmax`. The methods that run for the ray read and write the payload at
    `payload`, whose type selects these methods. `root`, `mask` and `time` default to those of this
    ray. Linking numbers the ray types of a scene and determines how their hits are searched for
    (RTSL_FIRST_HIT ... of runtime/device/ray/Abi.h): `ray_type` and `how`; without them the op
    cannot be compiled.

    Example: `rtsl.trace_payload %o, %d from %a to %b carries %p
             : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>`
  }];
  let arguments = (ins Rtsl_Vec3:$origin, Rtsl_Vec3:$direction, F32:$tmin, F32:$tmax,
                       Rtsl_PtrToStruct:$payload, Optional<I32>:$root,
                       Optional<I32>:$mask, Optional<F32>:$time, OptionalAttr<I32Attr>:$ray_type,
                       OptionalAttr<I32Attr>:$how);
  let assemblyFormat = [{
    $origin `,` $direction `from` $tmin `to` $tmax `carries` $payload (`root` $root^)?
    (`mask` $mask^)? (`time` $time^)?
    attr-dict `:` type($payload)
  }];
}

def Rtsl_PayloadOp : Rtsl_Op<"payload", [Pure, Rtsl_Named]> {
  let summary = "address of the payload of this ray";
  let description = [{
    In methods that run for rays of that type. No other pointer refers to it while the method runs.

    Example: `%p = rtsl.payload : !rtsl.ptr<!rtsl.struct<"P", {x: f32}>>`
  }];
  let results = (outs Rtsl_PtrToStruct:$result);
  let assemblyFormat = "attr-dict `:` type($result)";
}

def Rtsl_RayTypeOp : Rtsl_Op<"ray_type", [Pure]> {
  let summary = "number of the type of this ray's payload, from 1";
  let description = [{
    Example: `%n = rtsl.ray_type`
  }];
  let results = (outs I32:$result);
  let assemblyFormat = "attr-dict";
}

def Rtsl_HitAnswer : I32Enum<"HitAnswer", "what `anyHit` makes of a hit", [
    I32EnumCase<"Accept", 0, "accept">, I32EnumCase<"Ignore", 1, "ignore">,
    I32EnumCase<"Terminate", 2, "terminate">]> {
  let cppNamespace = "::rtsl::ir";
}

def Rtsl_AnswerHitOp : Rtsl_Op<"answer_hit"> {
  let summary = "refuses a hit, or accepts it and ends the search";
  let description = [{
    In `anyHit`, which ends there: lowering adds a return after it.

    Example: `rtsl.answer_hit ignore`
  }];
  let arguments = (ins EnumAttr<Rtsl_Dialect, Rtsl_HitAnswer, "hit_answer">:$answer);
  let assemblyFormat = "`` $answer attr-dict"; // the attribute prints a space before itself
}

def Rtsl_HitAnsweredOp : Rtsl_Op<"hit_answered"> {
  let summary = "whether `rtsl.answer_hit` has run for this hit";
  let description = [{
    Used after calls of functions that may run `rtsl.answer_hit`.

    Example: `%ended = rtsl.hit_answered`
  }];
  let results = (outs I1:$result);
  let assemblyFormat = "attr-dict";
}

def Rtsl_VisitChildOp : Rtsl_Op<"visit_child"> {
  let summary = "in `visit` of a selector: the ray may enter this child";
  let description = [{
    Example: `rtsl.visit_child %number`
  }];
  let arguments = (ins I32:$child);
  let assemblyFormat = "$child attr-dict";
}

def Rtsl_RaiseOp : Rtsl_Op<"raise"> {
  let summary = "records that the sample has raised an exception";
  let description = [{
    The number is one of RTSL_EXCEPTION_* (runtime/device/ray/Status.h). The shader continues; its
    results are discarded.

    Example: `rtsl.raise 3`
  }];
  let arguments = (ins I32Attr:$exception);
  let assemblyFormat = "$exception attr-dict";
}

def Rtsl_PrintOp : Rtsl_Op<"print"> {
  let summary = "prints text and values";
  let description = [{
    Prints one item after the other: a text, which takes no words, or the name of a type and as many
    of `values`, all of its scalars in order, as it has words. Linking numbers the prints of a
    program in `format`.

    Example: `rtsl.print ["at", "vec2"] words [0, 2](%x, %y) : f32, f32`
  }];
  let arguments = (ins StrArrayAttr:$items, DenseI32ArrayAttr:$words, Variadic<AnyType>:$values,
                       OptionalAttr<I32Attr>:$format);
  let assemblyFormat = "$items `words` $words `(` $values `)` attr-dict (`:` type($values)^)?";
  let hasVerifier = 1;
}

def Rtsl_HitOp : Rtsl_Op<"hit"> {
  let summary = "reports an intersection at parameter t; true if it is the nearest so far";
  let description = [{
    With `error` the author states a bound of the error of t.

    Example: `%nearest = rtsl.hit %t within %error`
  }];
  let arguments = (ins F32:$t, Optional<F32>:$error);
  let results = (outs I1:$nearest);
  let assemblyFormat = "$t (`within` $error^)? attr-dict";
}

def Rtsl_AmbientOp : Rtsl_Op<"ambient", [Pure]> {
  let summary = "ambient light, constant for a launch";
  let description = [{
    Example: `%a = rtsl.ambient : vector<3xf32>`
  }];
  let results = (outs Rtsl_Color:$color);
  let assemblyFormat = "attr-dict `:` type($color)";
}

def Rtsl_RandOp : Rtsl_Op<"rand"> {
  let summary = "the next random number of the ray, uniform in [0, 1)";
  let description = [{
    With `open` it is never 0.

    Example: `%r = rtsl.rand` or `%r = rtsl.rand open`
  }];
  let arguments = (ins UnitAttr:$open);
  let results = (outs F32:$result);
  let assemblyFormat = "(`open` $open^)? attr-dict";
}

def Rtsl_LightCountOp : Rtsl_Op<"light_count", [Pure]> {
  let summary = "number of lights, constant for a launch";
  let description = [{
    Example: `%n = rtsl.light_count`
  }];
  let results = (outs I32:$result);
  let assemblyFormat = "attr-dict";
}

def Rtsl_LightMayPassOp : Rtsl_Op<"light_may_pass", [Pure]> {
  let summary = "false: no light of surfaces that shine passes a surface";
  let description = [{
    Constant for a launch. Linking for a scene replaces it.

    Example: `%b = rtsl.light_may_pass`
  }];
  let results = (outs I1:$result);
  let assemblyFormat = "attr-dict";
}

def Rtsl_IlluminateOp : Rtsl_Op<"illuminate", [AttrSizedOperandSegments]> {
  let summary = "lights a point with one light; true if any arrives";
  let description = [{
    Sets the state variables LightDirection, LightDistance and LightColor (shadows applied). With
    `normal` and `cos`, only for a light within that angle of the normal. Level 2 has it in place of
    `rtsl.illuminance`. Without an index the light is one of the surfaces that shine, and PDF the
    density with which its direction was chosen; with `normal` alone, none is behind the plane of
    this normal.

    Example: `%lit = rtsl.illuminate %point light %index normal %n cos %c`
  }];
  let arguments = (ins Optional<I32>:$index, Rtsl_Vec3:$point, Optional<Rtsl_Vec3>:$normal,
                       Optional<F32>:$cosAngle);
  let results = (outs I1:$lit);
  let assemblyFormat = [{
    $point (`light` $index^)? (`normal` $normal^)? (`cos` $cosAngle^)? attr-dict
  }];
  let hasVerifier = 1;
}

#endif
