// ggx.cu - bench/gpu/ggx by hand: a sphere that reflects 16 lamps as GGX says.
#include "Hand.cuh"

__constant__ float roughness = 0.4f;

__global__ void render(Vec *pixels) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
  float sum = 0;
  for (int sample = 0; sample < samplesPerPixel; ++sample) {
    Random random(y * width + x, sample);
    const float atX = 2 * (x + random()) / width - 1, atY = 1 - 2 * (y + random()) / height;
    const Vec origin = {0, 0, 4}, direction = normalize({0.35f * atX, 0.35f * atY, -1});
    const float b = -dot(origin, direction);
    const Vec nearest = origin + b * direction;
    const float discriminant = 1 - dot(nearest, nearest);
    if (discriminant < 0) {
      sum += 0.1f;
      continue;
    }
    const Vec n = origin + (b - sqrtf(discriminant)) * direction;
    const Vec u = normalize(cross(fabsf(n.x) > 0.5f ? Vec{0, 1, 0} : Vec{1, 0, 0}, n));
    const Vec v = cross(n, u);
    const Vec eye = {-dot(direction, u), -dot(direction, v), -dot(direction, n)};
    const float alpha = fmaxf(roughness * roughness, 0.001f);
    const Vec eyeStretched = {alpha * eye.x, alpha * eye.y, eye.z};
    const float eyeHidden = sqrtf(dot(eyeStretched, eyeStretched));
    float reflected = 0;
    for (int i = 0; i < 16; ++i) {
      float sine, cosine;
      sincospif(0.125f * i, &sine, &cosine);
      const Vec lamp = {0.6f * cosine, 0.6f * sine, 0.8f};
      const Vec light = {dot(lamp, u), dot(lamp, v), dot(lamp, n)};
      if (light.z <= 0 || eye.z <= 0)
        continue;
      const float area = alpha * alpha;
      const Vec h = light + eye, stretched = {alpha * h.x, alpha * h.y, area * h.z};
      const float root = area * dot(h, h) / dot(stretched, stretched);
      const float distribution = root * root * (0.31830987f * area);
      const Vec lightStretched = {alpha * light.x, alpha * light.y, light.z};
      const float hidden =
          eyeHidden * light.z + sqrtf(dot(lightStretched, lightStretched)) * eye.z;
      reflected += distribution / (2 * hidden) * light.z;
    }
    sum += 0.25f * reflected;
  }
  sum *= 1.0f / samplesPerPixel;
  pixels[y * width + x] = {sum, sum, sum};
}

int main() {
  return measure("ggx", render);
}
