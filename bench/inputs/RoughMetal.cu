// RoughMetal.rtsl by hand for one light that the caller has found, to compare compilers with.
struct Surface {
  float3 direction, normal, toLight, lightColor, ambient;
};

__device__ float square(float x) { return x * x; }
__device__ float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
__device__ float3 scaled(float3 a, float s) { return make_float3(a.x * s, a.y * s, a.z * s); }
__device__ float3 normalized(float3 a) { return scaled(a, 1 / sqrtf(dot(a, a))); }
__device__ float3 cross(float3 a, float3 b) {
  return make_float3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

__device__ float density(float3 normal, float3 halfway, float alpha) {
  float3 across = cross(normal, halfway);
  float spread = dot(across, across) + square(alpha * dot(normal, halfway));
  return square(alpha / spread) * 0.31830989f;
}

__device__ float visibility(float eyeCosine, float lightCosine, float alpha) {
  float eye = lightCosine * sqrtf(square(eyeCosine) + square(alpha) * (1 - square(eyeCosine)));
  float light = eyeCosine * sqrtf(square(lightCosine) + square(alpha) * (1 - square(lightCosine)));
  return 0.5f / (eye + light);
}

extern "C" __global__ void shade(const Surface *surfaces, float3 tint, float roughness, float3 *colors) {
  const Surface s = surfaces[blockIdx.x * blockDim.x + threadIdx.x];
  float3 toEye = scaled(normalized(s.direction), -1);
  float eyeCosine = fmaxf(dot(s.normal, toEye), 1e-4f);
  float alpha = fmaxf(square(roughness), 1e-3f);
  float3 halfway = normalized(make_float3(toEye.x + s.toLight.x, toEye.y + s.toLight.y, toEye.z + s.toLight.z));
  float lightCosine = fmaxf(dot(s.normal, s.toLight), 1e-4f);
  float grazing = powf(1 - fmaxf(dot(toEye, halfway), 0), 5);
  float facets = lightCosine * density(s.normal, halfway, alpha) * visibility(eyeCosine, lightCosine, alpha);
  float3 color = make_float3(s.ambient.x * tint.x, s.ambient.y * tint.y, s.ambient.z * tint.z);
  color.x += facets * (tint.x + (1 - tint.x) * grazing) * s.lightColor.x;
  color.y += facets * (tint.y + (1 - tint.y) * grazing) * s.lightColor.y;
  color.z += facets * (tint.z + (1 - tint.z) * grazing) * s.lightColor.z;
  colors[blockIdx.x * blockDim.x + threadIdx.x] = color;
}
