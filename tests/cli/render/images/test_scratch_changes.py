"""How scratch members of primitives change across the footprint of a ray."""

import json
import unittest

from footprint_case import WAYS, FootprintCase

# The point that was hit, found in different ways, and values that depend on it.
SHAPES = """
class Shape : rt_Primitive {
  scratch vec3 place;
};
class Marched : Shape {
  float bumps(vec3 p) { return 0.1 * sin(3.0 * p.x) * sin(3.0 * p.y) * sin(3.0 * p.z); }
  float field(vec3 p) { return length(p) - 1.0 + bumps(p); }
  vec3 pointAt(float t) { return rt_RayOrigin + t * rt_RayDirection; }
  void intersect() {
    float t = 0.0;
    float scale = 0.7 / length(rt_RayDirection);
    for (int i = 0; i < 400 && t < rt_HitDistance; ++i) {
      float d = field(pointAt(t));
      if (d < 1e-6) {
        if (hit(t, 1e-3)) place = pointAt(t);
        return;
      }
      t += d * scale;
      if (d > 1e3) return;
    }
  }
  void computeBounds() { rt_BoundMin = vec3(-1.2); rt_BoundMax = vec3(1.2); }
  void computeNormal() {
    vec3 p = rt_HitPoint;
    for (int i = 0; i < 3; ++i) {
      vec3 e = vec3(0.0);
      e[i] = 1e-3;
      rt_GeometricNormal[i] = field(p + e) - field(p - e);
    }
    rt_GeometricNormal = normalize(rt_GeometricNormal);
  }
};
class Boxes : Shape {
  public vec3 centers[];
  void intersect() {
    vec3 c = centers[rt_PrimitiveIndex];
    vec3 a = (c - 0.5 - rt_RayOrigin) * rt_InverseRayDirection;
    vec3 b = (c + 0.5 - rt_RayOrigin) * rt_InverseRayDirection;
    float near = max(min(a, b));
    float far = min(max(a, b));
    if (near > far) return;
    place = c;
    if (hit(near)) place = rt_RayOrigin + near * rt_RayDirection;
    else if (hit(far)) { place = rt_RayOrigin; place += far * rt_RayDirection; }
  }
  void computeBounds() {
    rt_BoundMin = centers[rt_PrimitiveIndex] - 0.5;
    rt_BoundMax = centers[rt_PrimitiveIndex] + 0.5;
  }
  void computeNormal() {
    vec3 d = rt_HitPoint - centers[rt_PrimitiveIndex];
    rt_GeometricNormal[dominantAxis(d)] = d[dominantAxis(d)];
  }
};
class Ball : Shape {
  void roots(out float near, out float far) {
    float a = dot(rt_RayDirection, rt_RayDirection);
    float b = dot(rt_RayOrigin, rt_RayDirection);
    float d = b * b - a * (dot(rt_RayOrigin, rt_RayOrigin) - 1.0);
    float root = d > 0.0 ? sqrt(d) : 1e9;
    near = (-b - root) / a;
    far = d > 0.0 ? (-b + root) / a : -1.0;
  }
  void intersect() {
    float near;
    float far;
    roots(near, far);
    if (hit(near) || hit(far)) place = rt_RayOrigin + rt_HitDistance * rt_RayDirection;
  }
  void computeBounds() { rt_BoundMin = vec3(-1.0); rt_BoundMax = vec3(1.0); }
  void computeNormal() { rt_GeometricNormal = rt_HitPoint; }
};
class Drawn : Ball {
  void intersect() {
    float near;
    float far;
    roots(near, far);
    if (rand() < 2.0 && hit(near)) place = rt_RayOrigin + near * rt_RayDirection;
  }
};
class Shows : rt_Material {
  scratch vec3 place;
  void shade() {
    print(rt_dUVWdx, rt_dUVWdy, dFdx(place), dFdy(place));
    print(rt_dUVWdx, rt_dUVWdy, dFdx(2.0 * place + 1.0) * 0.5, dFdy(place.zxy).yzx);
    vec3 next = reflect(rt_RayDirection, normalize(rt_ShadingNormal));
    rt_SampleColor = color(dFdx(place.x), dFdy(place.y), dFdx(place.z));
    if (rt_Depth < 2) rt_SampleColor += 0.5 * trace(rt_HitPoint, next);
  }
};
class Pictured : rt_Material {
  scratch vec3 place;
  public sampler2D image;
  void shade() {
    vec4 value = image.sample(place.xy);
    rt_SampleColor = color(value.r, value.g, value.b);
  }
};
"""
EYE = {
    "class": "Eye",
    "eye": [0.2, 0.3, 9],
    "forward": [0, 0, -1],
    "right": [0.4, 0, 0],
    "up": [0, 0.2, 0],
}


class ScratchChanges(FootprintCase):
    def shapes(self, primitive, material, size=(9, 6), **node):
        """One as it is; one mirrored, sheared and turned; one that moves."""
        sheared = {"matrix": [1, 0.2, 0, 0, 0.5, -0.7, 0, 0, 0, 0.1, 1, 0, 0, 0, 0, 1]}
        moving = {"keys": [{"rotate": [0, 0, 0]}, {"rotate": [0, 90, 0], "translate": [0.3, 0, 0]}]}
        nodes = {
            "shape": {"primitive": primitive, "material": material, **node},
            "turned": {"child": "shape", "transform": [sheared, {"rotate": [20, 30, 10]}]},
            "all": {
                "children": [
                    "shape",
                    {"child": "turned", "transform": {"translate": [2.2, 0, 0]}},
                    {"child": "turned", "transform": [moving, {"translate": [-2.2, 0, 0]}]},
                ]
            },
        }
        self.scene(SHAPES, [], size, EYE, nodes=nodes, root="all")

    def test_a_point_moves_by_the_footprint(self):
        for primitive, node, most in (
            ({"class": "Marched"}, {}, 0.05),
            ({"class": "Boxes", "centers": [[0, 0, 0], [0.2, 0.6, 1]]}, {"count": "centers"}, 1e-5),
            ({"class": "Ball"}, {}, 1e-4),
        ):
            self.shapes(primitive, {"class": "Shows"}, **node)
            lines = self.printed()
            self.assertGreater(len(lines), 20)
            for line in lines:
                x, y, of_x, of_y = (line[i : i + 3] for i in range(0, 12, 3))
                self.assert_close(of_x, x, most, primitive)
                self.assert_close(of_y, y, most, primitive)
            if primitive["class"] != "Ball":
                self.same_bits(WAYS[::2] if node else WAYS[::3])

    def test_packages_have_the_same_bits(self):
        self.shapes({"class": "Ball"}, {"class": "Shows"})
        self.run_rtslc("pack", "scene.json", "-q", "-o", "x.rtslpkg")
        self.run_rtslc("render", "scene.json", "-q", "-o", "x.exr")
        self.run_package("x.rtslpkg", "--target=host", "-q", "-o", "y.exr")
        self.assert_same_bits("x.exr", "y.exr")

    def warnings(self):
        _, error = self.run_rtslc("render", "scene.json", "-o", "x.exr", "--diagnostics=json")
        diagnostics = json.loads(error)["diagnostics"]
        return [one["code"] for one in diagnostics], diagnostics

    def needed(self):
        report, _ = self.run_rtslc("explain", "scene.json", "--no-savings", "--json")
        return dict(self.items(json.loads(report)))

    def test_images_are_filtered_by_scratch_members(self):
        """Those with one level need no changes, and then there is nothing to warn of."""
        changes = ["change of place along dPdx", "footprints of rays", "Ball.rt_computeChanges"]
        for primitive, filter, code in (
            ("Ball", "trilinear", []),
            ("Ball", "bilinear", []),
            ("Drawn", "anisotropic", ["W2761"]),
            ("Drawn", "nearest", []),
        ):
            image = self.checkerboard(filter=filter)
            self.shapes({"class": primitive}, {"class": "Pictured", "image": image}, (4, 3))
            codes, diagnostics = self.warnings()
            self.assertEqual(codes, code, (primitive, filter))
            if codes:
                self.assert_message(diagnostics, "W2761", "`Drawn.intersect`", file="shaders.rtsl")
            if primitive == "Ball":
                items = self.needed()
                for item in changes:
                    self.assertEqual(items[item], filter == "trilinear", item)


if __name__ == "__main__":
    unittest.main()
