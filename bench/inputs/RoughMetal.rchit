#version 460
#extension GL_EXT_ray_tracing : require
// RoughMetal.rtsl by hand for one light that the caller has found, to compare compilers with.
struct Surface {
  vec3 direction, normal, toLight, lightColor, ambient;
};
layout(location = 0) rayPayloadInEXT Surface s;
layout(location = 1) rayPayloadEXT vec3 color;
const vec3 tint = vec3(1.0, 0.78, 0.34);
const float roughness = 0.35;

float square(float x) { return x * x; }

float density(vec3 normal, vec3 halfway, float alpha) {
  vec3 across = cross(normal, halfway);
  float spread = dot(across, across) + square(alpha * dot(normal, halfway));
  return square(alpha / spread) * 0.31830989;
}

float visibility(float eyeCosine, float lightCosine, float alpha) {
  float eye = lightCosine * sqrt(square(eyeCosine) + square(alpha) * (1.0 - square(eyeCosine)));
  float light = eyeCosine * sqrt(square(lightCosine) + square(alpha) * (1.0 - square(lightCosine)));
  return 0.5 / (eye + light);
}

void main() {
  vec3 toEye = -normalize(s.direction);
  float eyeCosine = max(dot(s.normal, toEye), 1e-4);
  float alpha = max(square(roughness), 1e-3);
  vec3 halfway = normalize(toEye + s.toLight);
  float lightCosine = max(dot(s.normal, s.toLight), 1e-4);
  vec3 fresnel = mix(tint, vec3(1.0), pow(1.0 - max(dot(toEye, halfway), 0.0), 5.0));
  float facets = density(s.normal, halfway, alpha) * visibility(eyeCosine, lightCosine, alpha);
  color = s.ambient * tint + lightCosine * facets * fresnel * s.lightColor;
}
