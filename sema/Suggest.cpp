//===- Suggest.cpp - what the author may have meant -----------------------===//
#include "sema/Suggest.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>

namespace rtsl {

/// Distance of optimal string alignment (Damerau 1964): insertions, deletions, substitutions and
/// swaps of neighbours.
static std::size_t editDistance(const std::string &a, const std::string &b) {
  std::vector<std::size_t> twoAbove(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], twoAbove[j - 2] + 1);
    }
    std::swap(twoAbove, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

static std::string lowered(const std::string &text) {
  std::string result = text;
  for (char &c : result)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string closestName(const std::string &name, const std::vector<std::string> &candidates) {
  // Nobody mistypes a name of hundreds of letters, and the distance takes the product of the
  // lengths.
  if (name.empty() || name.size() > 80)
    return "";
  std::string best;
  std::size_t bestDistance = std::max<std::size_t>(1, name.size() / 3) + 1;
  const std::string lowerName = lowered(name);
  for (const std::string &candidate : candidates) {
    const std::size_t longer = std::max(candidate.size(), name.size());
    const std::size_t shorter = std::min(candidate.size(), name.size());
    if (candidate == name || longer - shorter >= bestDistance || longer == 1)
      continue;
    std::size_t distance = editDistance(name, candidate);
    const std::string lowerCandidate = lowered(candidate);
    distance = std::min(distance, 1 + editDistance(lowerName, lowerCandidate));
    if (distance < bestDistance) {
      bestDistance = distance;
      best = candidate;
    }
  }
  return best;
}

const ForeignSpelling *foreignSpelling(const std::string &name) {
  static const std::unordered_map<std::string, ForeignSpelling> table = {
      // Types of HLSL, CUDA and the double precision of GLSL
      {"float2", {"vec2", ""}},
      {"float3", {"vec3", ""}},
      {"float4", {"vec4", ""}},
      {"int2", {"ivec2", ""}},
      {"int3", {"ivec3", ""}},
      {"int4", {"ivec4", ""}},
      {"uint2", {"uvec2", ""}},
      {"uint3", {"uvec3", ""}},
      {"uint4", {"uvec4", ""}},
      {"bool2", {"bvec2", ""}},
      {"bool3", {"bvec3", ""}},
      {"bool4", {"bvec4", ""}},
      {"half", {"float", ""}},
      {"half2", {"vec2", ""}},
      {"half3", {"vec3", ""}},
      {"half4", {"vec4", ""}},
      {"double", {"float", "precision is chosen for the whole program, with `--fp=double`"}},
      {"dvec2", {"vec2", "precision is chosen for the whole program, with `--fp=double`"}},
      {"dvec3", {"vec3", "precision is chosen for the whole program, with `--fp=double`"}},
      {"dvec4", {"vec4", "precision is chosen for the whole program, with `--fp=double`"}},
      {"float2x2", {"mat2", ""}},
      {"float3x3", {"mat3", ""}},
      {"float4x4", {"mat4", ""}},
      {"matrix", {"mat4", ""}},
      {"unsigned", {"uint", ""}},
      {"uchar", {"uint", ""}},
      {"short", {"int", ""}},
      {"long", {"int", ""}},
      {"char", {"int", ""}},
      {"vector", {"vec3", ""}},
      {"point", {"vec3", ""}},
      {"normal", {"vec3", ""}},
      {"sampler2D",
       {"rt_Texture", "a texture is a reference to an object: `public rt_Texture name;`"}},
      {"Texture2D",
       {"rt_Texture", "a texture is a reference to an object: `public rt_Texture name;`"}},
      {"rtTextureSampler",
       {"rt_Texture", "a texture is a reference to an object: `public rt_Texture name;`"}},
      {"rtBuffer", {"", "a buffer is an unsized array member: `public vec3 vertices[];`"}},
      // Constructors of CUDA
      {"make_float2", {"vec2", ""}},
      {"make_float3", {"vec3", ""}},
      {"make_float4", {"vec4", ""}},
      {"make_int2", {"ivec2", ""}},
      {"make_int3", {"ivec3", ""}},
      {"make_int4", {"ivec4", ""}},
      {"make_uint2", {"uvec2", ""}},
      {"make_uint3", {"uvec3", ""}},
      {"make_uint4", {"uvec4", ""}},
      {"make_color", {"color", ""}},
      // Functions
      {"lerp", {"mix", ""}},
      {"frac", {"fract", ""}},
      {"saturate", {"", "write `clamp(x, 0.0, 1.0)`"}},
      {"rsqrt", {"inversesqrt", ""}},
      {"rsqrtf", {"inversesqrt", ""}},
      {"atan2", {"atan", "`atan` with two arguments is atan(y, x)"}},
      {"atan2f", {"atan", "`atan` with two arguments is atan(y, x)"}},
      {"mul", {"", "write `a * b`: it is the product of linear algebra"}},
      {"fmod", {"mod", "`mod` takes the sign of the divisor"}},
      {"fmodf", {"mod", "`mod` takes the sign of the divisor"}},
      {"ddx", {"", "there are no neighbouring pixels here; see `rt_du` and `rt_dv`"}},
      {"ddy", {"", "there are no neighbouring pixels here; see `rt_du` and `rt_dv`"}},
      {"dFdx", {"", "there are no neighbouring pixels here; see `rt_du` and `rt_dv`"}},
      {"dFdy", {"", "there are no neighbouring pixels here; see `rt_du` and `rt_dv`"}},
      {"fwidth", {"", "there are no neighbouring pixels here; see `rt_du` and `rt_dv`"}},
      {"mad", {"fma", ""}},
      {"rcp", {"", "write `1.0 / x`"}},
      {"sqr", {"", "write `x * x` or `pow(x, 2)`"}},
      {"log10", {"", "write `log(x) / log(10.0)`"}},
      {"sincos", {"", "call `sin` and `cos`"}},
      {"discard", {"ignoreIntersection", ""}},
      {"clip", {"ignoreIntersection", ""}},
      {"asuint", {"floatBitsToUint", ""}},
      {"asint", {"floatBitsToInt", ""}},
      {"asfloat", {"uintBitsToFloat", ""}},
      {"__float_as_int", {"floatBitsToInt", ""}},
      {"__float_as_uint", {"floatBitsToUint", ""}},
      {"__int_as_float", {"intBitsToFloat", ""}},
      {"__uint_as_float", {"uintBitsToFloat", ""}},
      {"countbits", {"bitCount", ""}},
      {"popc", {"bitCount", ""}},
      {"reversebits", {"bitfieldReverse", ""}},
      {"firstbitlow", {"findLSB", ""}},
      {"firstbithigh", {"findMSB", ""}},
      {"sinf", {"sin", ""}},
      {"cosf", {"cos", ""}},
      {"tanf", {"tan", ""}},
      {"asinf", {"asin", ""}},
      {"acosf", {"acos", ""}},
      {"atanf", {"atan", ""}},
      {"sqrtf", {"sqrt", ""}},
      {"powf", {"pow", ""}},
      {"expf", {"exp", ""}},
      {"logf", {"log", ""}},
      {"fabs", {"abs", ""}},
      {"fabsf", {"abs", ""}},
      {"floorf", {"floor", ""}},
      {"ceilf", {"ceil", ""}},
      {"fminf", {"min", ""}},
      {"fmaxf", {"max", ""}},
      {"fmin", {"min", ""}},
      {"fmax", {"max", ""}},
      {"random", {"rand", ""}},
      {"drand48", {"rand", ""}},
      {"rnd", {"rand", ""}},
      {"printf", {"print", "`print` takes text and values in any order, without a format"}},
      {"rtPrintf", {"print", "`print` takes text and values in any order, without a format"}},
      {"texture", {"", "a texture is a reference to an object: `albedo.lookup()`"}},
      {"tex2D", {"", "a texture is a reference to an object: `albedo.lookup()`"}},
      {"texture2D", {"", "a texture is a reference to an object: `albedo.lookup()`"}},
      // OptiX, Vulkan and DirectX ray tracing
      {"rtTrace", {"trace", ""}},
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
      {"rtIgnoreIntersection", {"ignoreIntersection", ""}},
      {"optixIgnoreIntersection", {"ignoreIntersection", ""}},
      {"ignoreIntersectionEXT", {"ignoreIntersection", ""}},
      {"IgnoreHit", {"ignoreIntersection", ""}},
      {"rtTerminateRay", {"terminateRay", ""}},
      {"optixTerminateRay", {"terminateRay", ""}},
      {"terminateRayEXT", {"terminateRay", ""}},
      {"AcceptHitAndEndSearch", {"terminateRay", ""}},
      {"rtIntersectChild", {"visitChild", ""}},
      {"rtTransformNormal", {"", "write `normalize(transpose(mat3(rt_WorldToObject)) * n)`"}},
      {"rtTransformPoint", {"", "write `(rt_ObjectToWorld * vec4(p, 1.0)).xyz`"}},
      {"rtTransformVector", {"", "write `mat3(rt_ObjectToWorld) * v`"}},
      {"launch_index", {"rt_LaunchIndex", ""}},
      {"launchIndex", {"rt_LaunchIndex", ""}},
      {"gl_LaunchIDEXT", {"rt_LaunchIndex", ""}},
      {"gl_LaunchSizeEXT", {"rt_LaunchSize", ""}},
      {"gl_WorldRayOriginEXT", {"rt_RayOrigin", ""}},
      {"gl_WorldRayDirectionEXT", {"rt_RayDirection", ""}},
      {"gl_RayTmaxEXT", {"rt_HitDistance", ""}},
      {"gl_HitTEXT", {"rt_HitDistance", ""}},
      {"gl_RayTminEXT", {"rt_Epsilon", ""}},
      {"gl_PrimitiveID", {"rt_PrimitiveIndex", ""}},
      {"gl_InstanceID", {"rt_InstanceIndex", ""}},
      {"t_hit", {"rt_HitDistance", ""}},
      // Constants
      {"M_PI", {"", "RTSL has no predefined constants: `const float PI = 3.14159265;`"}},
      {"M_PIf", {"", "RTSL has no predefined constants: `const float PI = 3.14159265;`"}},
      {"PI", {"", "RTSL has no predefined constants: `const float PI = 3.14159265;`"}},
      {"NULL", {"", "a reference has no null in RTSL"}},
      {"null", {"", "a reference has no null in RTSL"}},
      {"nullptr", {"", "a reference has no null in RTSL"}},
      {"this", {"", "members are named directly, without `this`"}},
      {"self", {"", "members are named directly, without `self`"}},
  };
  auto found = table.find(name);
  return found == table.end() ? nullptr : &found->second;
}

} // namespace rtsl
