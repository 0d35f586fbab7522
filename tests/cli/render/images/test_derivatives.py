"""dFdx and dFdy: of functions and programs, and of what a mesh has at its vertices."""

import math
import pathlib
import re
import unittest

from footprint_case import PLANE, FootprintCase, MeshCase, add, cross, dot, unit

TABLE = pathlib.Path(__file__).resolve().parents[4] / "language" / "Derivatives.def"

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


class Functions(FootprintCase):
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


class Meshes(MeshCase):
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
"""

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


if __name__ == "__main__":
    unittest.main()
