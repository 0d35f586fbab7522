//===- Suggest.cpp - what the author may have meant -----------------------===//
#include "sema/check/Suggest.h"

#include <algorithm>
#include <unordered_map>

namespace rtsl {

using SpellingTable = std::unordered_map<std::string, ForeignSpelling>;

/// Functions of std.noise may be meant.
static ForeignSpelling ofNoise(const std::string &functions) {
  ForeignSpelling spelling;
  spelling.advice = functions;
  spelling.module = "std.noise";
  return spelling;
}

static const SpellingTable &spellings() {
  static const SpellingTable table = {
      // Types of HLSL, CUDA and the double precision of GLSL
      {"float2", {"vec2", "", true}},
      {"float3", {"vec3", "", true}},
      {"float4", {"vec4", "", true}},
      {"int2", {"ivec2", "", true}},
      {"int3", {"ivec3", "", true}},
      {"int4", {"ivec4", "", true}},
      {"uint2", {"uvec2", "", true}},
      {"uint3", {"uvec3", "", true}},
      {"uint4", {"uvec4", "", true}},
      {"bool2", {"bvec2", "", true}},
      {"bool3", {"bvec3", "", true}},
      {"bool4", {"bvec4", "", true}},
      {"half", {"float", "", true}},
      {"half2", {"vec2", "", true}},
      {"half3", {"vec3", "", true}},
      {"half4", {"vec4", "", true}},
      {"double", {"float", "precision is chosen for the whole program, with `--fp=double`"}},
      {"dvec2", {"vec2", "precision is chosen for the whole program, with `--fp=double`"}},
      {"dvec3", {"vec3", "precision is chosen for the whole program, with `--fp=double`"}},
      {"dvec4", {"vec4", "precision is chosen for the whole program, with `--fp=double`"}},
      {"float2x2", {"mat2", ""}},
      {"float3x3", {"mat3", ""}},
      {"float4x4", {"mat4", ""}},
      {"matrix", {"mat4", ""}},
      {"Matrix3x3", {"mat3", ""}},
      {"Matrix4x4", {"mat4", ""}},
      {"float1", {"float", "", true}},
      {"float16_t", {"float", "", true}},
      {"float32_t", {"float", "", true}},
      {"float64_t", {"float", "precision is chosen for the whole program, with `--fp=double`"}},
      {"min16float", {"float", "", true}},
      {"int32_t", {"int", "", true}},
      {"uint32_t", {"uint", "", true}},
      {"int64_t", {"int", "integers have 32 bits"}},
      {"uint64_t", {"uint", "integers have 32 bits"}},
      {"int16_t", {"int", "integers have 32 bits"}},
      {"uint16_t", {"uint", "integers have 32 bits"}},
      {"int8_t", {"int", "integers have 32 bits"}},
      {"uint8_t", {"uint", "integers have 32 bits"}},
      {"size_t", {"uint", "integers have 32 bits"}},
      {"uchar4", {"uvec4", "integers have 32 bits"}},
      {"string", {"", "a string can only be an argument of `print`"}},
      {"Ray", {"", "a ray is the arguments of `trace`: an origin, a direction, ..."}},
      {"RayDesc", {"", "a ray is the arguments of `trace`: an origin, a direction, ..."}},
      {"goto", {"", "leave loops with `break`, and functions with `return`"}},
      {"throw",
       {"", "`rt_Exception` handles what the runtime raises; shaders cannot throw exceptions"}},
      {"delete", {"", "values need not be freed"}},
      {"then", {"", "write `if (condition) statement`"}},
      {"unsigned", {"uint", "", true}},
      {"unsigned int", {"uint", "", true}},
      {"signed int", {"int", "", true}},
      {"unsigned char", {"uint", ""}},
      {"unsigned short", {"uint", ""}},
      {"unsigned long", {"uint", "integers have 32 bits"}},
      {"unsigned long long", {"uint", "integers have 32 bits"}},
      {"long int", {"int", "integers have 32 bits"}},
      {"long long", {"int", "integers have 32 bits"}},
      {"short int", {"int", ""}},
      {"long double", {"float", "precision is chosen for the whole program, with `--fp=double`"}},
      {"uchar", {"uint", ""}},
      {"short", {"int", ""}},
      {"long", {"int", ""}},
      {"char", {"int", ""}},
      {"vector", {"vec3", ""}},
      {"point", {"vec3", ""}},
      {"normal", {"vec3", ""}},
      {"Texture2D", {"", "an image is a member, `public sampler2D image;`"}},
      {"Texture3D", {"", "an image is a member, `public sampler3D image;`"}},
      {"image2D", {"", "an image is a member, `public sampler2D image;`"}},
      {"samplerCube", {"", "`EnvironmentMap` of std.backgrounds shows an image of all directions"}},
      {"rtTextureSampler", {"", "an image is a member, `public sampler2D image;`"}},
      {"rtBuffer", {"", "a buffer is an unsized array member: `public vec3 vertices[];`"}},
      // Constructors of CUDA
      {"make_float2", {"vec2", "", true}},
      {"make_float3", {"vec3", "", true}},
      {"make_float4", {"vec4", "", true}},
      {"make_int2", {"ivec2", "", true}},
      {"make_int3", {"ivec3", "", true}},
      {"make_int4", {"ivec4", "", true}},
      {"make_uint2", {"uvec2", "", true}},
      {"make_uint3", {"uvec3", "", true}},
      {"make_uint4", {"uvec4", "", true}},
      {"make_color", {"color", ""}},
      // Functions
      {"lerp", {"mix", "", true}},
      {"frac", {"fract", "", true}},
      {"saturate", {"clamp", "write `clamp(x, 0.0, 1.0)`", true, ", 0.0, 1.0"}},
      {"rsqrt", {"inversesqrt", "", true}},
      {"rsqrtf", {"inversesqrt", "", true}},
      {"atan2", {"atan", "`atan` with two arguments is atan(y, x)", true}},
      {"atan2f", {"atan", "`atan` with two arguments is atan(y, x)", true}},
      {"mul", {"", "write `a * b`: it is the product of linear algebra"}},
      {"fmod", {"mod", "`mod` takes the sign of the divisor"}},
      {"fmodf", {"mod", "`mod` takes the sign of the divisor"}},
      {"ddx", {"dFdx", "", true}},
      {"ddy", {"dFdy", "", true}},
      {"fwidth", {"", "write `abs(dFdx(x)) + abs(dFdy(x))`"}},
      {"mad", {"fma", ""}},
      {"rcp", {"(1.0 / ", "write `1.0 / x`", true, "", ")"}},
      {"sqr", {"pow", "write `x * x` or `pow(x, 2)`", true, ", 2"}},
      {"log10", {"(log", "write `log(x) / log(10.0)`", true, "", " / log(10.0))"}},
      {"sincos", {"", "call `sin` and `cos`"}},
      {"discard", {"ignoreIntersection()", "", false, "", "", true}},
      {"clip", {"", "write `if (x < 0.0) ignoreIntersection();`, in `anyHit` of an rt_Material"}},
      {"asuint", {"floatBitsToUint", "", true}},
      {"asint", {"floatBitsToInt", "", true}},
      {"asfloat", {"uintBitsToFloat", ""}},
      {"__float_as_int", {"floatBitsToInt", "", true}},
      {"__float_as_uint", {"floatBitsToUint", "", true}},
      {"__int_as_float", {"intBitsToFloat", "", true}},
      {"__uint_as_float", {"uintBitsToFloat", "", true}},
      {"countbits", {"bitCount", "", true}},
      {"popc", {"bitCount", "", true}},
      {"reversebits", {"bitfieldReverse", "", true}},
      {"firstbitlow", {"findLSB", ""}},
      {"firstbithigh", {"findMSB", ""}},
      {"sinf", {"sin", "", true}},
      {"cosf", {"cos", "", true}},
      {"tanf", {"tan", "", true}},
      {"asinf", {"asin", "", true}},
      {"acosf", {"acos", "", true}},
      {"atanf", {"atan", "", true}},
      {"sqrtf", {"sqrt", "", true}},
      {"powf", {"pow", "", true}},
      {"expf", {"exp", "", true}},
      {"logf", {"log", "", true}},
      {"fabs", {"abs", "", true}},
      {"fabsf", {"abs", "", true}},
      {"floorf", {"floor", "", true}},
      {"ceilf", {"ceil", "", true}},
      {"fminf", {"min", "", true}},
      {"fmaxf", {"max", "", true}},
      {"exp2f", {"exp2", "", true}},
      {"exp10", {"pow", "write `pow(10.0, x)`"}},
      {"exp10f", {"pow", "write `pow(10.0, x)`"}},
      {"__sinf", {"sin", "", true}},
      {"__cosf", {"cos", "", true}},
      {"__tanf", {"tan", "", true}},
      {"__expf", {"exp", "", true}},
      {"__logf", {"log", "", true}},
      {"__log2f", {"log2", "", true}},
      {"__powf", {"pow", "", true}},
      {"__fsqrt_rn", {"sqrt", "", true}},
      {"__frsqrt_rn", {"inversesqrt", "", true}},
      {"__fmaf_rn", {"fma", "", true}},
      {"__fdividef", {"", "write `x / y`"}},
      {"sizeof", {"", "`array.length()` counts elements; the size in bytes is not available"}},
      {"assert",
       {"", "`print` shows values; an index out of range ends the sample with `--exceptions`"}},
      {"__syncthreads", {"", "a shader runs for one ray: there are no other threads to wait for"}},
      {"GroupMemoryBarrierWithGroupSync",
       {"", "a shader runs for one ray: there are no other threads to wait for"}},
      {"barrier", {"", "a shader runs for one ray: there are no other threads to wait for"}},
      {"noise", ofNoise("`gradientNoise`, `fractalNoise` and `worleyNoise`")},
      {"perlin", ofNoise("`gradientNoise`, which is Perlin's")},
      {"snoise", ofNoise("`gradientNoise` and `fractalNoise`")},
      {"cnoise", ofNoise("`gradientNoise`, which is Perlin's")},
      {"fbm", ofNoise("`fractalNoise`")},
      {"worley", ofNoise("`worleyNoise`")},
      {"voronoi", ofNoise("`worleyNoise`, the distance to the nearest of scattered points")},
      {"log2f", {"log2", "", true}},
      {"sinhf", {"sinh", "", true}},
      {"coshf", {"cosh", "", true}},
      {"tanhf", {"tanh", "", true}},
      {"roundf", {"round", "`round` rounds halves to even"}},
      {"truncf", {"trunc", "", true}},
      {"copysignf", {"", "write `uintBitsToFloat` of the bits, or `x < 0.0 ? -abs(y) : abs(y)`"}},
      {"fmaf", {"fma", "", true}},
      {"ldexpf", {"ldexp", "", true}},
      {"__saturatef", {"clamp", "write `clamp(x, 0.0, 1.0)`", true, ", 0.0, 1.0"}},
      {"__popc", {"bitCount", "", true}},
      {"__brev", {"bitfieldReverse", "", true}},
      {"fmin", {"min", "", true}},
      {"fmax", {"max", "", true}},
      {"random", {"rand", ""}},
      {"drand48", {"rand", ""}},
      {"rnd", {"rand", ""}},
      {"printf", {"print", "`print` takes text and values in any order, without a format"}},
      {"rtPrintf", {"print", "`print` takes text and values in any order, without a format"}},
      {"texture", {"", "an image is a member, `public sampler2D image;`: `image.sample(uv)`"}},
      {"tex2D", {"", "an image is a member, `public sampler2D image;`: `image.sample(uv)`"}},
      {"texture2D", {"", "an image is a member, `public sampler2D image;`: `image.sample(uv)`"}},
      // OptiX, Vulkan and DirectX ray tracing
      {"rtTrace", {"trace", "", true}}, // arguments that do not fit have a message of their own
      {"optixTrace", {"trace", ""}},
      {"TraceRay", {"trace", ""}},
      {"traceRay", {"trace", ""}},
      {"traceRayEXT", {"trace", ""}},
      {"rtPotentialIntersection",
       {"hit", "`hit(t)` tests and reports at once; write attributes to `scratch` members"}},
      {"rtReportIntersection",
       {"hit", "`hit(t)` tests and reports at once; write attributes to `scratch` members"}},
      {"optixReportIntersection", {"hit", ""}},
      {"reportIntersectionEXT", {"hit", ""}},
      {"ReportHit", {"hit", ""}},
      {"rtIgnoreIntersection", {"ignoreIntersection", "", true}},
      {"optixIgnoreIntersection", {"ignoreIntersection", "", true}},
      {"ignoreIntersectionEXT", {"ignoreIntersection", "", true}},
      {"IgnoreHit", {"ignoreIntersection", "", true}},
      {"rtTerminateRay", {"terminateRay", "", true}},
      {"optixTerminateRay", {"terminateRay", "", true}},
      {"terminateRayEXT", {"terminateRay", "", true}},
      {"AcceptHitAndEndSearch", {"terminateRay", "", true}},
      {"rtIntersectChild", {"visitChild", "", true}},
      {"rtTransformNormal", {"", "write `normalize(normalToWorld(n))`"}},
      {"rtTransformPoint", {"", "write `pointToWorld(p)`"}},
      {"rtTransformVector", {"", "write `vectorToWorld(v)`"}},
      {"launch_index", {"rt_LaunchIndex", ""}},
      {"launchIndex", {"rt_LaunchIndex", ""}},
      {"gl_LaunchIDEXT", {"rt_LaunchIndex", ""}},
      {"gl_LaunchSizeEXT", {"rt_LaunchSize", ""}},
      {"gl_WorldRayOriginEXT", {"rt_RayOrigin", "", true}},
      {"gl_WorldRayDirectionEXT", {"rt_RayDirection", "", true}},
      {"gl_RayTmaxEXT", {"rt_HitDistance", "", true}},
      {"gl_HitTEXT", {"rt_HitDistance", "", true}},
      {"gl_RayTminEXT", {"rt_Epsilon", ""}},
      {"WorldRayOrigin", {"rt_RayOrigin", "", true, "", "", true}},
      {"WorldRayDirection", {"rt_RayDirection", "", true, "", "", true}},
      {"RayTCurrent", {"rt_HitDistance", "", true, "", "", true}},
      {"RayTMin", {"rt_Epsilon", "", false, "", "", true}},
      {"PrimitiveIndex", {"rt_PrimitiveIndex", "", true, "", "", true}},
      {"InstanceIndex", {"rt_InstanceIndex", "", true, "", "", true}},
      {"DispatchRaysIndex", {"rt_LaunchIndex", "", false, "", "", true}},
      {"DispatchRaysDimensions", {"rt_LaunchSize", "", false, "", "", true}},
      {"optixGetWorldRayOrigin", {"rt_RayOrigin", "", true, "", "", true}},
      {"optixGetWorldRayDirection", {"rt_RayDirection", "", true, "", "", true}},
      {"optixGetRayTmax", {"rt_HitDistance", "", true, "", "", true}},
      {"optixGetRayTmin", {"rt_Epsilon", "", false, "", "", true}},
      {"optixGetRayTime", {"rt_Time", "", true, "", "", true}},
      {"optixGetPrimitiveIndex", {"rt_PrimitiveIndex", "", true, "", "", true}},
      {"optixGetInstanceIndex", {"rt_InstanceIndex", "", true, "", "", true}},
      {"optixGetLaunchIndex", {"rt_LaunchIndex", "", false, "", "", true}},
      {"optixGetLaunchDimensions", {"rt_LaunchSize", "", false, "", "", true}},
      {"rtThrow",
       {"", "`rt_Exception` handles what the runtime raises; shaders cannot throw exceptions"}},
      {"optixThrowException",
       {"", "`rt_Exception` handles what the runtime raises; shaders cannot throw exceptions"}},
      {"rtDeclareVariable", {"", "what a scene sets is a member: `public float roughness;`"}},
      {"gl_PrimitiveID", {"rt_PrimitiveIndex", "", true}},
      {"gl_InstanceID", {"rt_InstanceIndex", "", true}},
      {"t_hit", {"rt_HitDistance", ""}},
      // Constants
      {"M_PI", {"", "RTSL has no predefined constants: `const float PI = 3.14159265;`"}},
      {"M_PIf", {"", "RTSL has no predefined constants: `const float PI = 3.14159265;`"}},
      {"PI", {"", "RTSL has no predefined constants: `const float PI = 3.14159265;`"}},
      {"M_PI_2", {"1.57079633", ""}},
      {"M_1_PI", {"0.318309886", ""}},
      {"FLT_MAX", {"3.40282347e38", "", true}},
      {"FLT_MIN", {"1.17549435e-38", "", true}},
      {"FLT_EPSILON", {"1.1920929e-7", "", true}},
      {"RT_DEFAULT_MAX", {"1e27", "", true}},
      {"INFINITY", {"(1.0 / 0.0)", "", true}},
      {"NAN", {"(0.0 / 0.0)", "", true}},
      {"INT_MAX", {"2147483647", "", true}},
      {"INT_MIN", {"(-2147483648)", "", true}},
      {"UINT_MAX", {"4294967295u", "", true}},
      // Variables of the RenderMan language and OSL
      {"P", {"rt_HitPoint", ""}},
      {"N", {"rt_ShadingNormal", ""}},
      {"Ng", {"rt_GeometricNormal", ""}},
      {"I", {"rt_RayDirection", ""}},
      {"L", {"rt_LightDirection", ""}},
      {"Cl", {"rt_LightColor", ""}},
      {"Ci", {"rt_SampleColor", ""}},
      {"dPdu", {"rt_dPdu", "", true}},
      {"dPdv", {"rt_dPdv", "", true}},
      {"super", {"", "the definition of a base class is called with its name: `Base::function()`"}},
      {"NULL",
       {"", "a reference is true as a condition if it refers to an object: `if (reference)`"}},
      {"null",
       {"", "a reference is true as a condition if it refers to an object: `if (reference)`"}},
      {"nullptr",
       {"", "a reference is true as a condition if it refers to an object: `if (reference)`"}},
      {"this", {"", "members are named directly, without `this`"}},
      {"self", {"", "members are named directly, without `self`"}},
  };
  return table;
}

const ForeignSpelling *foreignSpelling(const std::string &name) {
  auto found = spellings().find(name);
  return found == spellings().end() ? nullptr : &found->second;
}

std::vector<std::string> foreignNames() {
  std::vector<std::string> names;
  for (const auto &[name, spelling] : spellings())
    names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

void suggestSpelling(Diagnostic &diagnostic, const ForeignSpelling &foreign,
                     const std::string &whyNot, bool hasModule, SourceRange name,
                     SourceRange call) {
  if (!whyNot.empty()) {
    diagnostic.note(whyNot);
    return;
  }
  const bool wrapsCall = !foreign.append.empty() || !foreign.after.empty();
  if (foreign.isVariable && call.isValid()) {
    diagnostic.fix(call, foreign.replacement, foreign.sure);
  } else if (!foreign.replacement.empty() && (!wrapsCall || call.isValid())) {
    diagnostic.fix(name, foreign.replacement, foreign.sure);
    if (!foreign.append.empty())
      diagnostic.fix({call.file, call.end - 1, call.end - 1}, foreign.append, foreign.sure);
    if (!foreign.after.empty())
      diagnostic.fix({call.file, call.end, call.end}, foreign.after, foreign.sure);
  }
  if (foreign.advice.empty())
    return;
  if (foreign.module.empty())
    diagnostic.note(foreign.advice);
  else if (hasModule)
    diagnostic.note("`" + foreign.module + "`, which is imported, has " + foreign.advice);
  else
    diagnostic.note("add `import " + foreign.module + ";`: it has " + foreign.advice);
}

} // namespace rtsl
