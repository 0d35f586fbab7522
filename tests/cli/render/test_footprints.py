"""Footprints of rays, derivatives across them, and images that are filtered by them."""

import json
import math
import pathlib
import re
import unittest

from harness import Case, example_scenes
from image_files import png

TABLE = pathlib.Path(__file__).resolve().parents[3] / "language" / "Derivatives.def"

EYE = """
class Eye : rt_Camera {
  public vec3 eye = vec3(0.3, 0.2, 2.0);
  public vec3 forward = vec3(0.1, 0.05, -1.0);
  public vec3 right = vec3(0.2, 0.0, 0.0);
  public vec3 up = vec3(0.0, 0.1, 0.0);
  void generateRay() {
    rt_RayOrigin = eye;
    rt_RayDirection = forward + (2.0 * rt_ScreenCoord.x - 1.0) * right + (2.0 * rt_ScreenCoord.y - 1.0) * up;
  }
};
"""

STATE = """
class Tells : rt_Material {
  void shade() {
    print(rt_ConeWidth, rt_ConeSpread, rt_dPdx, rt_dPdy, rt_dUVdx, rt_dUVdy, rt_dUVWdx, rt_dUVWdy,
          rt_RayDirection, rt_HitDistance, normalize(rt_GeometricNormal), rt_dPdu, rt_dPdv);
    rt_SampleColor = color(rt_ConeWidth, rt_dUVdx.x + rt_dUVdy.y, rt_dUVWdx.z);
  }
};
class Mirror : rt_Material {
  void shade() {
    rt_SampleColor = trace(rt_HitPoint, reflect(rt_RayDirection, normalize(rt_GeometricNormal)));
  }
};
"""
PARTS = (1, 1, 3, 3, 2, 2, 3, 3, 3, 1, 3, 3, 3)  # components of what Tells prints

# By row of the table: a function of p, which is between 0.2 and 0.8 in both coordinates. Vectors
# are weighed into one number. Clamp and its like are on the side that changes.
FUNCTIONS = {
    "Radians": "radians(p.x * p.y)",
    "Degrees": "degrees(p.x * p.y)",
    "Sin": "sin(3.0 * p.x + p.y)",
    "Cos": "cos(3.0 * p.x + p.y)",
    "Tan": "tan(p.x - p.y)",
    "SinPi": "sinpi(p.x * p.y)",
    "CosPi": "cospi(p.x * p.y)",
    "Asin": "asin(p.x * p.y)",
    "Acos": "acos(p.x * p.y)",
    "Atan": "atan(2.0 * p.x * p.y)",
    "Atan2": "atan(p.x * p.x, p.y)",
    "Sinh": "sinh(p.x - 2.0 * p.y)",
    "Cosh": "cosh(p.x - 2.0 * p.y)",
    "Tanh": "tanh(p.x - 2.0 * p.y)",
    "Asinh": "asinh(p.x - 2.0 * p.y)",
    "Acosh": "acosh(1.5 + p.x * p.y)",
    "Atanh": "atanh(p.x * p.y)",
    "Pow": "pow(p.x, 1.0 + p.y)",
    "PowInt": "weigh(pow(p.xyx, 3))",
    "Exp": "exp(p.x * p.y)",
    "Log": "weigh(log(p.xyy))",
    "Exp2": "exp2(p.x * p.y)",
    "Log2": "log2(p.x * p.y)",
    "Expm1": "expm1(p.x * p.y)",
    "Log1p": "log1p(p.x * p.y)",
    "Sqrt": "sqrt(p.x * p.y)",
    "InverseSqrt": "inversesqrt(p.x * p.y)",
    "Abs": "abs(p.x - 2.0) * abs(p.y)",
    "Fract": "fract(7.0 + 0.9 * p.x * p.y)",
    "Mod": "mod(5.0 * p.x, 40.0 + p.y)",
    "Modf": "whole(0.9 * p.x * p.y)",
    "Min": "weigh(min(vec3(p, p.x * p.y), 0.75 * p.yxx))",
    "Max": "weigh(max(vec3(p, p.x * p.y), 0.1))",
    "Clamp": (
        "clamp(p.x, 0.5 * p.x * p.y, 2.0 + p.y) * clamp(p.x + 5.0, p.y, p.x * p.y) + "
        "clamp(p.x, 2.0 + p.y, 3.0) + weigh(clamp(p.xyx, 0.1, 1.0))"
    ),
    "Mix": "mix(p.x, p.y * p.y, p.x * p.y) + weigh(mix(p.xyx, p.yxx, p.x))",
    "MixSelect": "weigh(mix(p.xyx, p.yyx * p.x, bvec3(true, false, true)))",
    "SmoothStep": "smoothstep(-0.1 * p.y, 1.0, p.x) + smoothstep(2.0, 3.0, p.x)",
    "Fma": "fma(p.x, p.y, p.x)",
    "Ldexp": "ldexp(p.x * p.y, 2)",
    "Length": "length(vec3(p, 2.0)) + length(p.x)",
    "Distance": "distance(vec3(p, 2.0), vec3(p.y, 1.0, 0.0))",
    "Dot": "dot(vec3(p, 2.0), p.yyx)",
    "Cross": "weigh(cross(vec3(p, 2.0), p.yyx))",
    "Normalize": "weigh(normalize(vec3(p, 2.0)))",
    "FaceForward": "weigh(faceforward(vec3(p, 2.0), vec3(0.0, 1.0, 0.0), p.xyy))",
    "Reflect": "weigh(reflect(vec3(p, -2.0), vec3(p.y, 0.5, p.x)))",
    "Refract": (
        "weigh(refract(normalize(vec3(p, -2.0)), normalize(vec3(p.y, 0.0, 2.0)), 0.7 + 0.1 * "
        "p.x))"
    ),
    "MatrixCompMult": (
        "weigh(matrixCompMult(mat3(p.x), mat3(vec3(p, 1.0), p.xyx, p.yxy)) * vec3(1.0, 2.0, "
        "3.0))"
    ),
    "OuterProduct": "weigh(outerProduct(vec3(p, 1.0), p.yxy) * vec3(1.0, 2.0, 3.0))",
    "Transpose": "weigh(transpose(mat3(vec3(p, 1.0), p.xyx, p.yxy)) * p.xyx)",
    "Inverse": (
        "weigh(inverse(mat3(vec3(p.x, 2.0, 1.0), vec3(0.0, p.y, 3.0), vec3(1.0, 0.0, p.y))) *"
        " p.xyx)"
    ),
    "MinComponent": "min(vec3(p.x * p.x, p.y + 1.0, 3.0)) * p.y",
    "MaxComponent": "max(vec3(p.x * p.x, p.y + 1.0, 0.5))",
    "PointToWorld": "weigh(pointToWorld(vec3(p, p.x * p.y)))",
    "PointToObject": "weigh(pointToObject(vec3(p, p.x * p.y)))",
    "VectorToWorld": "weigh(vectorToWorld(vec3(p, p.x * p.y)))",
    "VectorToObject": "weigh(vectorToObject(vec3(p, p.x * p.y)))",
}

# Bodies of functions of p, by what they show.
PROGRAMS = {
    "operators": "vec2 q = -p * 2.0 + 1.0 / (p.yx + 3.0) - p.x; return q.x / q.y + 3.0 * q.y;",
    "components": (
        "vec3 v = vec3(1.0); v.zx = p * p; v.y *= p.x; v[1] += p.y; return v.x * v.y + v[2];"
    ),
    "loops": (
        "float sum = 0.0; vec2 q = p; for (int i = 0; i < 5; ++i) { if (i == 2) continue; q ="
        " q.yx * 1.1 + q; sum += q.x; } return sum;"
    ),
    "loops over numbers": (
        "float sum = p.y; for (float x = p.x; x < 3.0; x *= 2.0) sum += x * p.y; int i = 0; "
        "while (i < 3) { sum *= sum; ++i; } do { sum += p.x; } while (sum < 0.0); return sum;"
    ),
    "branches": (
        "float x = p.x; if (p.x > 2.0) x = 0.0; else x *= p.y; switch (int(p.x)) { case 0: x "
        "+= p.y; default: x *= 2.0; } return p.y > 0.0 ? x * x : 1.0;"
    ),
    "structs and arrays": (
        "Pair pairs[2]; pairs[0].v = p.yxy; pairs[1] = Pair(p.x, vec3(p, 1.0), 3); pairs[0].f"
        " = p.y; int k = 1; return pairs[k].f * pairs[0].v.y + pairs[k].v[0] + pairs[0].f;"
    ),
    "matrices": (
        "mat2 m = mat2(p.x, 1.0, p.y, 2.0); mat2 n = m * m + m * p.x; vec2 q = n * p; q = q *"
        " m; return q.x + q.y + n[1][0] + (n / p.y)[0].y;"
    ),
    "functions": "return outer(p.x * 2.0, p) + twice(twice(p.y));",
    "methods": "return ownMethod(p) + shape.at(p) + general.at(p);",
    "scopes": (
        "float x = p.x; { float x = p.y; x *= 3.0; } for (int i = 0; i < 2; ++i) { float x = "
        "p.y * p.x; if (i == 1) return x * x; } return x;"
    ),
    "assignments in expressions": (
        "float a, b; a = b = p.x * p.y; float c = (a *= 2.0) + 1.0; return (b += c, b * a) + p.x;"
    ),
    "things that happen once": (
        "int n = 0; float x = p.x * float(++n) + p.y * float(n++); x += p.x * float(++n); "
        "return x * float(n);"
    ),
    "places that are found once": (
        "float v[3]; int i = 0; v[i++] = p.x * p.y; v[i++] = p.y; v[i] = v[0] * v[1]; "
        "v[--i] += p.x; return v[2] + v[1] * v[0] + float(i);"
    ),
    "parameters that change": "vec2 q = p; q.x = moved(q, 2.0); return q.x * q.y;",
    "parts of functions": "return (p.x > 0.0 && p.y > 0.0 ? outer(p.y, p.yx) : 0.0) * (1.0 - p.x);",
    "output parameters": (
        "float a, b = p.x; vec3 v = vec3(1.0); split(p, a, b); split(p.yx, v.x, v.z); "
        "float once = b; if (general.parts(p, once) > 0.0) once *= 2.0; seeded(a, v[1]); "
        "return a * b + v.x * v.z + once + v.y;"
    ),
    "output parameters that stay": ("float a = p.x * p.y; keep(p, a); return a + p.y;"),
    "points": "vec3 q = point(p); return dot(q, q.zxy) + q.x;",
}

DERIVED = """
struct Pair { float f; vec3 v; int i; };
class Shape { float at(vec2 p) { return p.x; } };
class Round : Shape { public float scale = 1.5; float at(vec2 p) { return scale * length(p); }
  float parts(vec2 p, inout float x) { x += scale * p.x * p.y; return 1.0; } };
void split(vec2 p, out float a, inout float b) {
  a = p.x * p.x + 2.0 * p.y;
  if (p.y > 100.0)
    return;
  b *= a;
}
void keep(vec2 p, inout float a) { if (p.x > 100.0) a = 1.0; }
void seeded(float x, out float y) { float z = x; y = x; split(vec2(y * x, x), y, z); }
float weigh(vec3 v) { return v.x + 2.0 * v.y - 0.5 * v.z; }
float whole(float x) { float n; return modf(x, n) + n; }
float twice(float x) { return x * x + x; }
float inner(float x, float unused) { return sin(x) * x; }
float outer(float x, vec2 p) {
  if (x > 100.0) return 0.0;
  float y = inner(x, p.y);
  return y * p.y;
}
float moved(vec2 q, float by) { q *= by; q.y += q.x; return q.y; }
vec3 point(vec2 p) { return vec3(p.x * p.y, p); }
class Derived : rt_Material {
  public Shape shape;
  public Round general;
  float ownMethod(vec2 p) { return 2.0 * p.x * p.y; }
FUNCTIONS
  void shade() {
    vec2 p = 0.2 + 0.6 * rt_TextureUV;
    vec2 x = 0.6 * rt_dUVdx;
    vec2 y = 0.6 * rt_dUVdy;
    float h = 0.0625;
CALLS
  }
};
"""

PLANE = {"class": "Parallelogram", "constructor": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}
WAYS = (
    [],
    ["--trace=recurse", "--traversal=device"],
    ["--trace=split", "--undefined=nan"],
    ["--target=host-megakernel"],
    ["--target=host-megakernel", "--organisation=wavefront"],
    ["--keep=all", "--threads=1"],
)


def add(a, b, scale=1.0):
    return [x + scale * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def numbers_of(line):
    values = re.sub(r"vec\d", "", line.split(": ", 1)[1])
    return [float(n) for n in re.findall(r"[-+]?(?:\d[\d.e+-]*|inf|nan)", values)]


class Footprints(Case):
    def scene(self, shaders, objects, size=(3, 2), camera=None, **more):
        self.write("shaders.rtsl", EYE + shaders)
        scene = {
            "rtsl": 1,
            "import": [
                "std.cameras",
                "std.primitives",
                "std.materials",
                "std.textures",
                "shaders.rtsl",
            ],
            "camera": camera or {"class": "Eye"},
            "objects": objects,
            "render": {"engine": "classic", "size": list(size), "spp": 1, "depth": 4},
            **more,
        }
        self.write("scene.json", json.dumps(scene))

    def printed(self, *options):
        output, _ = self.run_rtslc("render", "scene.json", "--print", "-q", "-o", "x.exr", *options)
        return [numbers_of(line) for line in output.splitlines()]

    def told(self, *options):
        """What Tells prints, in its parts."""
        for line in self.printed(*options):
            parts = []
            for count in PARTS:
                parts.append(line[0] if count == 1 else line[:count])
                line = line[count:]
            yield parts

    def assert_close(self, got, expected, relative=2e-4, message=""):
        if isinstance(expected, list):
            most = max(abs(x) for x in expected)
            for x, y in zip(got, expected):
                self.assertAlmostEqual(x, y, delta=relative * most + 1e-12, msg=message)
        else:
            self.assertAlmostEqual(
                got, expected, delta=relative * abs(expected) + 1e-12, msg=message
            )

    # The cone and its footprint

    def expect_footprint(self, told, spread, width, to_object=lambda v: v):
        (cone, gain, px, py, ux, uy, wx, wy, direction, t, normal, pu, pv) = told
        self.assert_close(gain, spread)
        self.assert_close(cone, width + spread * t * math.sqrt(dot(direction, direction)))
        d = unit(direction)
        across = unit(cross(normal, d))
        along = cross(across, normal)
        stretch = min(1 / abs(dot(normal, d)), 1024)
        self.assert_close(px, [cone * stretch * x for x in along])
        self.assert_close(py, [cone * x for x in across])
        for p, uv in ((px, ux), (py, uy)):
            self.assert_close(add([uv[0] * x for x in pu], pv, uv[1]), p, 1e-3)
        self.assert_close(wx, to_object(px))
        self.assert_close(wy, to_object(py))

    def test_footprints_on_a_plane(self):
        width, height = 3, 2
        for corner, a, b in (
            ([-3, -3, 0], [6, 0, 0], [0, 6, 0]),
            ([-30, -30, -0.5], [60, 0, 0], [3, 60, 0.9]),  # not a right angle
            ([-9e5, -1e4, -1e6], [2e6, 0, 0], [0, 2e6, 0]),
            ([-50, 1.2, -60], [100, 0, 0], [0, 0, 60]),  # grazing
        ):
            plane = {"class": "Parallelogram", "constructor": [corner, a, b]}
            self.scene(STATE, [{"primitive": plane, "material": {"class": "Tells"}}])
            count = 0
            for told in self.told():
                d = told[8]
                sines = [
                    math.sqrt(dot(normal, normal) / dot(d, d) / dot(e, e))
                    for e in (add(d, [0.4 / width, 0, 0]), add(d, [0, 0.2 / height, 0]))
                    for normal in [cross(d, e)]
                ]
                self.expect_footprint(told, math.sqrt(sines[0] * sines[1]), 0)
                count += 1
            self.assertGreater(count, 1)

    def test_footprints_follow_transforms(self):
        transform = [{"scale": [2, 0.5, 1]}, {"rotate": [0, 20, 0]}]
        square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 4 0\nvt 4 2\nvt 0 2\n"
        square += "f 1/1 2/2 3/3 4/4\n"
        self.write("square.obj", square)
        cosine, sine = math.cos(math.radians(20)), math.sin(math.radians(20))

        def to_object(v):
            return [
                (cosine * v[0] - sine * v[2]) / 2,
                v[1] / 0.5,
                sine * v[0] + cosine * v[2],
            ]

        # A mesh with one instance is moved, so that its object space is world space.
        for primitive, back in (({"primitive": PLANE}, to_object), ({"mesh": "square.obj"}, list)):
            material = {"class": "Tells"}
            self.scene(STATE, [{**primitive, "material": material, "transform": transform}])
            told = list(self.told())
            self.assertGreater(len(told), 3)
            for one in told:
                self.expect_footprint(one, one[1], 0, back)

    def test_cones_of_cameras(self):
        wall = {"class": "Parallelogram", "constructor": [[-50, -50, -3], [100, 0, 0], [0, 100, 0]]}
        objects = [{"primitive": wall, "material": {"class": "Tells"}}]
        view = {"eye": [0, 0, 2], "target": [0, 0, 0], "up": [0, 1, 0]}
        size = (40, 40)
        half = math.tan(math.radians(20))
        # The width on the wall, 5 away, in the middle of the picture.
        for camera, expected in (
            (
                {"class": "PerspectiveCamera", "constructor": view, "fieldOfView": 40},
                10 * half / 40,
            ),
            ({"class": "OrthographicCamera", "constructor": view, "height": 3}, 3 / 40),
            ({"class": "FisheyeCamera", "constructor": view, "fieldOfView": 180}, 5 * math.pi / 40),
        ):
            self.scene(STATE, objects, size, camera)
            middle = min(self.told(), key=lambda told: abs(told[8][0]) + abs(told[8][1]) + told[9])
            self.assert_close(middle[0], expected, 0.02, camera["class"])
        self.assertEqual(list(self.told())[0][1] > 0, True)

    def test_cameras_print_once(self):
        shaders = (
            STATE
            + """
class Talks : Eye {
  void generateRay() { Eye::generateRay(); print(7, rand()); }
};
"""
        )
        plane = {"class": "Parallelogram", "constructor": [[-9, -9, 0], [20, 0, 0], [0, 20, 0]]}
        objects = [{"primitive": plane, "material": {"class": "Tells"}}]
        self.scene(shaders, objects, (2, 1), {"class": "Talks"})
        for way in ([], ["--target=host-megakernel"]):
            self.assertEqual(len([line for line in self.printed(*way) if line[0] == 7]), 2)

    def test_cones_of_rays_that_shaders_send(self):
        """A mirror at 45 degrees, and what it shows."""
        objects = [
            {
                "primitive": {
                    "class": "Parallelogram",
                    "constructor": [[-5, -5, -5], [10, 0, 0], [0, 10, 10]],
                },
                "material": {"class": "Mirror"},
            },
            {
                "primitive": {
                    "class": "Parallelogram",
                    "constructor": [[-50, -7, -50], [100, 0, 0], [0, 0, 100]],
                },
                "material": {"class": "Tells"},
            },
        ]
        self.scene(STATE, objects)
        told = list(self.told())
        self.assertEqual(len(told), 6)
        for one in told:
            self.assertGreater(one[0], one[1] * one[9] * 1.1)  # wider than from the mirror alone
            to_mirror = one[0] - one[1] * one[9] * math.sqrt(dot(one[8], one[8]))
            self.expect_footprint(one, one[1], to_mirror)
        self.same_bits()

    SENDS = """
struct Told { vec2 cone; };
class Tells : rt_Material {
  void closestHit(inout Told told) { told.cone = vec2(rt_ConeWidth, rt_ConeSpread); }
};
class Sends : rt_RayGeneration {
  void generate() {
    Told told = Told(vec2(7.0));
    vec3 origin = vec3(0.0, 0.0, float(1u + rt_LaunchIndex.x));
    trace(origin, vec3(0.0, 0.0, -2.0), 0.0, 1e30, told);
    vec2 before = told.cone;
    rt_ConeWidth = 0.25;
    rt_ConeSpread = 0.125;
    trace(origin, vec3(0.0, 0.0, -2.0), 0.0, 1e30, told);
    vec2 first = told.cone;
    rt_ConeSpread *= 2.0;
    trace(origin, vec3(0.0, 0.0, -2.0), 0.0, 1e30, told);
    print(before, first, told.cone, rt_ConeWidth);
    rt_SampleColor = color(first.x, told.cone.x, told.cone.y);
  }
};
"""

    def test_generate_says_which_cones_its_rays_have(self):
        floor = {"class": "Parallelogram", "constructor": [[-5, -5, 0], [10, 0, 0], [0, 10, 0]]}
        self.scene(
            self.SENDS,
            [{"primitive": floor, "material": {"class": "Tells"}}],
            rayGeneration={"class": "Sends"},
            render={"engine": "programs", "size": [3, 1], "spp": 1, "depth": 2},
        )
        lines = self.printed()
        self.assertEqual(len(lines), 3)
        for i, line in enumerate(lines):
            far = 1 + i
            expected = [0, 0, 0.25 + 0.125 * far, 0.125, 0.25 + 0.25 * far, 0.25, 0.25]
            self.assertEqual(line, expected)
        self.same_bits([*WAYS, ["--keep=outputs"]])

    def test_generate_may_write_cones_that_nobody_reads(self):
        self.scene(
            "class Sends : rt_RayGeneration { void generate() { rt_ConeWidth = 1.0; "
            "rt_SampleColor = trace(vec3(0.0, 0.0, 2.0), vec3(0.0, 0.0, -1.0)); } };"
            "class Plain : rt_Material { void shade() { rt_SampleColor = color(0.5); } };",
            [{"primitive": PLANE, "material": {"class": "Plain"}}],
            rayGeneration={"class": "Sends"},
            render={"engine": "programs", "size": [3, 1], "spp": 1},
        )
        said, _ = self.run_rtslc("explain", "scene.json", "--json", "--no-savings")
        self.assertIn(("footprints of rays", False), list(self.items(json.loads(said))))
        self.same_bits([[], ["--keep=outputs"], ["--keep=outputs", "--target=host-megakernel"]])

    NORMALS = """
class Bent : rt_Material {
  void shade() {
    vec3 weighted = rt_ShadingNormal * rt_HitPoint.x;
    print(rt_HitPoint, rt_dPdx, rt_dPdy, rt_ShadingNormal, rt_dNdx, rt_dNdy, dFdx(weighted),
          dFdy(rt_GeometricNormal.x));
    rt_SampleColor = color(dFdx(rt_ShadingNormal.x), dFdy(rt_ShadingNormal.y), rt_dNdx.z);
  }
};
"""
    CORNERS = ([-2, -2, 0], [3, -1.5, 0.5], [0, 2.5, -0.5])
    BENT = ([-0.5, 0, 1], [0.6, -0.2, 0.9], [0.1, 0.7, 0.8])

    def bent_normal(self, point, scale):
        """The shading normal at a point in world space, of the triangle that is scaled."""
        at = [x / s for x, s in zip(point, scale)]
        a, b = (add(corner, self.CORNERS[0], -1) for corner in self.CORNERS[1:])
        across = cross(a, b)
        from_first = add(at, self.CORNERS[0], -1)
        u = dot(cross(from_first, b), across) / dot(across, across)
        v = dot(cross(a, from_first), across) / dot(across, across)
        normals = [unit(n) for n in self.BENT]
        mixed = add(add([(1 - u - v) * x for x in normals[0]], normals[1], u), normals[2], v)
        return unit([x / s for x, s in zip(unit(mixed), scale)])

    def test_changes_of_normals_of_meshes(self):
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in self.CORNERS)
        text += "".join("vn %.9f %.9f %.9f\n" % tuple(unit(n)) for n in self.BENT)
        self.write("bent.obj", text + "f 1//1 2//2 3//3\n")
        for scale in ([1, 1, 1], [2, 0.5, 0.75]):
            nodes = {"bent": {"mesh": "bent.obj", "material": {"class": "Bent"}}}
            self.scene(
                self.NORMALS,
                [],
                (4, 4),
                nodes=nodes,
                root={"child": "bent", "transform": {"scale": scale}},
            )
            lines = self.printed()
            self.assertGreater(len(lines), 4)
            for line in lines:
                point, px, py, normal, nx, ny, weighted = (line[i : i + 3] for i in range(0, 21, 3))
                self.assertEqual(line[21:], [0])
                self.assert_close(normal, self.bent_normal(point, scale), 1e-5)
                for p, n in ((px, nx), (py, ny)):
                    step = 1e-3 / math.sqrt(dot(p, p))
                    ahead = self.bent_normal(add(point, p, step), scale)
                    behind = self.bent_normal(add(point, p, -step), scale)
                    self.assert_close(n, [x / (2 * step) for x in add(ahead, behind, -1)], 2e-3)
                self.assert_close(weighted, add([x * point[0] for x in nx], normal, px[0]), 1e-4)
            self.same_bits()

    ATTRIBUTES = """
class Attributed : rt_Material {
  scratch vec3 place;
  scratch vec3 flow;
  scratch vec3 side;
  scratch vec4 tangent;
  scratch vec2 uv1;
  scratch float part;
  void shade() {
    print(rt_dPdx, rt_dPdy, rt_dNdx, dFdx(place), dFdy(place), dFdx(flow), dFdx(normalize(side)), dFdx(tangent.xyz));
    print(rt_dUVdx, rt_dUVdy, dFdx(uv1), dFdy(uv1), rt_dUVWdx.x, dFdx(tangent.w), dFdy(part));
    rt_SampleColor = color(dFdx(uv1.x), dFdy(side.y), dFdx(tangent).w);
  }
};
class Disc : rt_Primitive {
  scratch vec2 uv1;
  void computeBounds() { rt_BoundMin = vec3(-9.0, -9.0, -1.5); rt_BoundMax = vec3(9.0, 9.0, -0.5); }
  void intersect() {
    if (hit((-1.0 - rt_RayOrigin.z) / rt_RayDirection.z))
      uv1 = rt_RayOrigin.xy;
  }
  void computeNormal() { rt_GeometricNormal = vec3(0.0, 0.0, 1.0); }
};
class Second : rt_Material {
  public sampler2D image;
  scratch vec2 uv1;
  vec2 scaled(vec2 uv) { return 9.0 * uv; }
  void shade() {
    vec4 a = image.sample(scaled(uv1));
    vec4 b = image.sample(scaled(rt_TextureUV));
    vec4 c = image.sample(scaled(uv1), 0.0);
    vec2 change = dFdx(uv1);
    print(a.rgb, b.rgb, c.rgb, change);
    rt_SampleColor = color(a.r, a.g, a.b);
  }
};
class Plain : Second {
  void shade() {
    vec4 a = image.sample(scaled(uv1));
    rt_SampleColor = color(a.r, a.g, a.b);
  }
};
"""

    def bent_mesh(self, **attributes):
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in self.CORNERS)
        text += "".join("vn %.9f %.9f %.9f\n" % tuple(unit(n)) for n in self.BENT)
        text += "".join(f"vt {u} {v}\n" for u, v in self.PLACED)
        self.write("bent.obj", text + "f 1/1/1 2/2/2 3/3/3\n")
        return {"mesh": "bent.obj", "attributes": attributes}

    PLACED = ([0.1, 0.2], [0.9, 0.1], [0.4, 0.8])

    def test_changes_of_attributes_of_meshes(self):
        """Positions, normals and texture coordinates as attributes change as those do."""
        mesh = self.bent_mesh(
            place={"values": self.CORNERS, "space": "point"},
            flow={"values": self.CORNERS, "space": "vector"},
            side={"values": [unit(n) for n in self.BENT], "space": "normal"},
            tangent={"values": [[*c, c[0]] for c in self.CORNERS], "space": "tangent"},
            uv1=self.PLACED,
            part={"values": [2.5], "per": "face"},
        )
        turned = {"rotate": [10, 20, 30]}
        moving = {"keys": [{"rotate": [0, 0, 0]}, {"rotate": [0, 0, 90]}]}
        for mirror, transform in (
            (1, None),
            (1, [{"scale": [2, 0.5, 0.75]}, turned]),
            (1, [{"scale": 1.5}, turned, moving]),
            (-1, [{"scale": [-1, 1, 1.2]}, turned]),
        ):
            nodes = {"bent": {**mesh, "material": {"class": "Attributed"}}}
            root = {"child": "bent", **({"transform": transform} if transform else {})}
            self.scene(self.ATTRIBUTES, [], (4, 4), nodes=nodes, root=root)
            lines = self.printed()
            self.assertGreater(len(lines), 8)
            for vectors, others in zip(lines[::2], lines[1::2]):
                px, py, nx, *got = (vectors[i : i + 3] for i in range(0, 24, 3))
                for change, expected in zip(got, (px, py, px, nx, px), strict=True):
                    self.assert_close(change, expected, 2e-3, (transform, expected))
                self.assert_close(others[4:8], others[:4], 2e-3)
                self.assert_close(others[9], mirror * others[8], 2e-3)
                self.assertEqual(others[10], 0)
            self.same_bits()

    def test_images_are_filtered_by_other_coordinates_of_meshes(self):
        mesh = self.bent_mesh(uv1=self.PLACED)
        disc = {"primitive": {"class": "Disc"}}

        def show(material, *objects, filter="trilinear"):
            material = {"class": material, "image": self.checkerboard(64, 3, filter=filter)}
            self.scene(self.ATTRIBUTES, [{**one, "material": material} for one in objects], (4, 4))

        def needed():
            text, _ = self.run_rtslc("explain", "scene.json", "--json", "--no-savings")
            found = dict(self.items(json.loads(text)))
            return found["footprints of rays"], found.get("change of uv1 along dPdx")

        show("Second", mesh, disc)
        kinds = {True: 0, False: 0}
        for line in self.printed():
            a, b, c, change = line[:3], line[3:6], line[6:9], line[9:]
            isMesh = change != [0, 0]
            self.assert_close(a, b if isMesh else c, 1e-3)
            kinds[isMesh] += max(abs(x - y) for x, y in zip(a, c)) > 0.05
        self.assertGreater(kinds[True], 2)
        self.assertEqual(kinds[False], 0)
        self.same_bits()
        for objects, filter, expected in (
            ([mesh], "trilinear", (True, True)),
            ([mesh], "bilinear", (False, False)),
            ([disc], "trilinear", (False, False)),
        ):
            show("Plain", *objects, filter=filter)
            self.assertEqual(needed(), expected)

    def test_strange_surfaces_have_no_footprint(self):
        self.write(
            "flat.obj",
            "v -3 -3 0\nv 3 -3 0\nv 0 3 0\nvt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\nf 1/1 2/2 3/3\n",
        )
        self.write(
            "line.obj",
            "v -3 -3 0\nv 3 -3 0\nv 0 3 0\nvt 0 0\nvt 1 1\nvt 2 2\nf 1/1 2/2 3/3\n",
        )
        for mesh in ("flat.obj", "line.obj"):
            self.scene(STATE, [{"mesh": mesh, "material": {"class": "Tells"}}])
            for told in self.told():
                self.assertGreater(told[0], 0)
                self.assertEqual(told[4:6], [[0, 0], [0, 0]])
        # A plane that is seen from within, and numbers at the ends of the range.
        for scale, distance in ((1e-18, 1e-18), (1e18, 1e18), (1.0, 1e-30)):
            plane = {
                "class": "Parallelogram",
                "constructor": [
                    [-scale, -scale, -distance],
                    [2 * scale, 0, 0],
                    [0, 2 * scale, 0],
                ],
            }
            camera = {"class": "Eye", "eye": [0, 0, 0], "forward": [0, 0, -1]}
            self.scene(STATE, [{"primitive": plane, "material": {"class": "Tells"}}], camera=camera)
            for told in self.told():
                for number in [told[0]] + [x for part in told[2:8] for x in part]:
                    self.assertTrue(math.isfinite(number), (scale, distance, told))

    # Derivatives

    def check_derivatives(self, functions):
        texts, calls = [], []
        for number, body in enumerate(functions.values()):
            texts.append(f"  float f{number}(vec2 p) {{ {body} }}")
            for axis, v in (("dFdx", "x"), ("dFdy", "y")):
                near, far = (
                    f"(f{number}(p + {h} * {v}) - f{number}(p - {h} * {v})) / (2.0 * {h})"
                    for h in ("h", "(2.0 * h)")
                )
                calls.append(f"    print({number}, {axis}(f{number}(p)), {near}, {far});")
        shaders = DERIVED.replace("FUNCTIONS", "\n".join(texts)).replace("CALLS", "\n".join(calls))
        material = {"class": "Derived", "shape": {"class": "Round"}, "general": {"class": "Round"}}
        camera = {"class": "Eye", "eye": [0.4, 0.4, 2], "right": [0.1, 0, 0], "up": [0, 0.1, 0]}
        objects = [{"primitive": PLANE, "material": material, "transform": {"scale": [1.2, 1, 1]}}]
        self.scene(shaders, objects, (1, 1), camera)
        names = list(functions)
        found = set()
        for number, got, near, far in self.printed("--fp=double"):
            # Differences of second order, extrapolated to fourth order (Richardson).
            expected = (4 * near - far) / 3
            self.assertAlmostEqual(
                got, expected, delta=2e-3 * abs(expected) + 2e-5, msg=names[int(number)]
            )
            found.add((names[int(number)], got != 0))
        self.assertLessEqual({(name, True) for name in names}, found)

    def test_derivatives_of_built_in_functions(self):
        rows = re.findall(r"^RTSL_DERIVATIVE\((\w+),", TABLE.read_text(), re.MULTILINE)
        self.assertEqual(sorted(rows), sorted(FUNCTIONS))
        self.check_derivatives({row: f"return {FUNCTIONS[row]};" for row in rows})

    def test_derivatives_of_programs(self):
        self.check_derivatives(PROGRAMS)

    def test_what_is_not_followed_has_derivative_0(self):
        shaders = """
float drawn(float x, float y) { return x * y; }
float write(float x, out float y) { y = x; return x; }
class Zero : rt_Material {
  public float member = 2.0;
  float random(float x) { return x * rand(); }
  void shade() {
    vec2 p = rt_TextureUV;
    float written, unknown = write(p.x, written);
    print(dFdx(member), dFdx(floor(p.x)), dFdx(step(0.3, p.x)), dFdx(float(int(9.0 * p.x))), dFdx(rand()),
          dFdx(unknown), dFdx(dFdx(p.x * p.x)), dFdx(random(p.x)), dFdx(rt_GeometricNormal.x),
          dFdx(luminance(color(p.x))), dFdx(rt_dUVdx.x));
    float draw = rand();
    print(dFdx(p.x * draw) / rt_dUVdx.x - draw);
    float once;
    float product = p.x * (once = rand());
    print(dFdx(product) / rt_dUVdx.x - once, dFdx(rand() * p.x) > 0.0 ? 0 : 1);
    rt_SampleColor = color(rand());
  }
};
"""
        plane = {"class": "Parallelogram", "constructor": [[-3, -3, 0], [6, 0, 0], [0, 6, 0]]}
        self.scene(shaders, [{"primitive": plane, "material": {"class": "Zero"}}], (1, 1))
        zeros, *kept = self.printed()
        self.assertEqual(zeros, [0] * 11)
        for line in kept:
            for number in line:
                self.assertAlmostEqual(number, 0, delta=1e-6)

    # Images

    def checkerboard(self, size=256, squares=2, **image):
        self.write(
            "board.png",
            png(size, size, lambda x, y: [255 * ((x // squares + y // squares) & 1)] * 3),
        )
        return {"file": "board.png", "colorSpace": "linear", **image}

    def same_bits(self, ways=WAYS):
        pictures = {}
        for way in ways:
            self.run_rtslc("render", "scene.json", "-q", "-o", "x.exr", *way)
            pictures.setdefault((self.folder / "x.exr").read_bytes(), []).append(way)
        self.assertEqual(len(pictures), 1, list(pictures.values()))

    LEVELS = """
class Level : rt_Material {
  public sampler2D image;
  public float scale = 1.0;
  vec2 placed(vec2 uv) { return scale * uv; }
  void shade() {
    vec2 uv = placed(rt_TextureUV);
    float across = length(scale * rt_dUVdx * vec2(image.size()));
    float up = length(scale * rt_dUVdy * vec2(image.size()));
    vec4 a = image.sample(uv);
    vec4 b = image.sample(uv, log2(max(across, up)));
    vec4 c = image.sampleGrad(uv, scale * rt_dUVdx, scale * rt_dUVdy);
    print(a.rgb, b.rgb, c.rgb, log2(max(across, up)));
    rt_SampleColor = color(a.r, a.g, a.b);
  }
};
"""

    def test_levels_of_an_image_follow_the_footprint(self):
        levels = set()
        for distance, scale, filter in (
            (1, 1, "trilinear"),
            (1, 20, "trilinear"),
            (40, 1, "trilinear"),
            (1e6, 1e5, "trilinear"),
            (40, 2, "anisotropic"),
        ):
            plane = {
                "class": "Parallelogram",
                "constructor": [
                    [-3 * distance, -2 * distance, 2 - distance],
                    [6 * distance, 0, 0],
                    [0, 5 * distance, 0],
                ],
            }
            material = {
                "class": "Level",
                "scale": scale,
                "image": self.checkerboard(64, 3, filter=filter),
            }
            self.scene(self.LEVELS, [{"primitive": plane, "material": material}])
            for line in self.printed():
                a, b, c, level = line[:3], line[3:6], line[6:9], line[9]
                self.assert_close(a, c, 1e-5)
                if filter == "trilinear":
                    self.assert_close(a, b, 1e-5)
                levels.add(int(level))
        self.assertGreater(len(levels), 3)

    FAR = """
class Board : rt_Material {
  public sampler2D image;
  public rt_Texture texture;
  public int way = 0;
  void shade() {
    vec2 uv = 8.0 * rt_TextureUV;
    vec4 value = way == 0 ? image.sample(uv, 0.0) : image.sample(uv);
    rt_SampleColor = way == 2 ? texture.lookup() : color(value.r, value.g, value.b);
  }
};
"""

    def far_scene(self, way, spp=1, filter="trilinear", size=(64, 48)):
        image = self.checkerboard(filter=filter)
        floor = {"class": "Parallelogram", "constructor": [[-40, -1, 10], [80, 0, 0], [0, 0, -80]]}
        material = {
            "class": "Board",
            "image": image,
            "way": way,
            "texture": {"class": "ImageTexture", "image": image, "repeats": [8, 8]},
        }
        camera = {"class": "Eye", "forward": [0, -0.5, -1], "right": [0.5, 0, 0], "up": [0, 0.4, 0]}
        self.scene(
            self.FAR,
            [{"primitive": floor, "material": material}],
            size,
            camera,
            render={"engine": "classic", "size": list(size), "spp": spp, "depth": 2},
        )

    def error(self, a, b):
        text, _ = self.run_rtslc("compare", a, b, "--json", status=None)
        return json.loads(text)["rmse"]

    def test_a_far_pattern_comes_nearer_to_its_mean(self):
        self.far_scene(0, spp=256)
        self.run_rtslc("render", "scene.json", "-q", "-o", "reference.exr", "-O2")
        errors = {}
        for way, filter in (
            (0, "trilinear"),
            (1, "trilinear"),
            (1, "anisotropic"),
            (2, "anisotropic"),
        ):
            self.far_scene(way, filter=filter)
            name = f"{way}-{filter}.exr"
            self.run_rtslc("render", "scene.json", "-q", "-o", name)
            errors[way, filter] = self.error(name, "reference.exr")
        self.assertLess(2 * errors[1, "trilinear"], errors[0, "trilinear"])
        self.assertLess(2 * errors[1, "anisotropic"], errors[0, "trilinear"])
        # A texture of the library sees the same.
        self.assert_same_bits("1-anisotropic.exr", "2-anisotropic.exr")

    def test_every_path_gives_the_same_bits(self):
        for way, filter in ((1, "anisotropic"), (2, "trilinear")):
            self.far_scene(way, filter=filter, size=(16, 12))
            self.same_bits()
        self.run_rtslc("pack", "scene.json", "-q", "-o", "x.rtslpkg")
        self.run_rtslc("render", "scene.json", "-q", "-o", "x.exr")
        self.run_package("x.rtslpkg", "--target=host", "-q", "-o", "y.exr")
        self.assert_same_bits("x.exr", "y.exr")

    ELSEWHERE = """
vec4 widened(sampler2D image, vec2 uv) { return image.sample(uv * (1.0 + 0.0 * length(dFdx(uv)))); }
class Sky : rt_Miss {
  public sampler2D image;
  public rt_Texture texture;
  void miss() {
    vec2 uv = 40.0 * normalize(rt_RayDirection).xy;
    rt_TextureUV = uv;
    vec4 a = image.sample(uv);
    vec4 b = image.sample(uv, 0.0);
    vec4 c = widened(image, uv);
    print(a.r - b.r, a.r - c.r, luminance(texture.lookup()) - b.r, dFdxOf(uv));
    rt_SampleColor = color(a.r, a.g, a.b);
  }
  vec2 dFdxOf(vec2 uv) { return zero(uv); }
};
vec2 zero(vec2 uv) { return dFdx(uv); }
"""

    def test_elsewhere_images_have_level_0(self):
        image = self.checkerboard()
        self.scene(
            self.ELSEWHERE,
            [],
            background={
                "class": "Sky",
                "image": image,
                "texture": {"class": "ImageTexture", "image": image},
            },
        )
        for line in self.printed():
            for number in line:
                self.assertAlmostEqual(number, 0, delta=1e-6)

    def test_programs_without_filtered_images_have_no_cones(self):
        def footprints():
            text, _ = self.run_rtslc("explain", "scene.json", "--json", "--no-savings")
            return [
                item for item in self.items(json.loads(text)) if item[0] == "footprints of rays"
            ]

        self.far_scene(1, filter="bilinear")
        self.assertEqual(footprints(), [("footprints of rays", False)])
        self.same_bits([[], ["--keep=all"], ["--target=host-megakernel"]])
        self.far_scene(1, filter="trilinear")
        self.assertEqual(footprints(), [("footprints of rays", True)])

    def items(self, report):
        """Subjects, and whether they are needed, wherever they are in the report."""
        if isinstance(report, dict):
            if "subject" in report:
                yield report["subject"], report.get("needed", report.get("isNeeded"))
            report = list(report.values())
        if isinstance(report, list):
            for one in report:
                yield from self.items(one)


if __name__ == "__main__":
    unittest.main()
