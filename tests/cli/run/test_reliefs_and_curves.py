"""HeightField and Curve of the library, on every path: hits of rays against those of oracles in
double precision, for rays that come from far away, along the axes, through corners of the grid, and
almost along the surface."""

import json
import math
import random
import struct
import unittest

from harness import Case
from numpy_files import npy, read_npy
from output_case import PATHS

RAYS = """
struct Seen { float t; vec3 normal; vec2 uv; vec3 across; vec3 up; bool leaves; };
class Rays : rt_RayGeneration {
  public float rays[][6];
  public out float seen[][13];
  void generate() {
    int i = int(rt_LaunchIndex.x);
    vec3 o = vec3(rays[i][0], rays[i][1], rays[i][2]);
    vec3 d = vec3(rays[i][3], rays[i][4], rays[i][5]);
    Seen one = Seen(-1.0, vec3(0.0), vec2(0.0), vec3(0.0), vec3(0.0), false);
    trace(o, d, 0.0, 3.4e38, one);
    seen[i] = float[](one.t, one.normal.x, one.normal.y, one.normal.z, one.uv.x, one.uv.y,
                      one.across.x, one.across.y, one.across.z, one.up.x, one.up.y, one.up.z,
                      float(one.leaves));
  }
};
struct Away { bool isFree; };
class Recorder : rt_Material {
  void closestHit(inout Seen seen) {
    vec3 side = dot(rt_RayDirection, rt_GeometricNormal) > 0.0 ? -rt_GeometricNormal : rt_GeometricNormal;
    seen.t = rt_HitDistance;
    seen.normal = rt_GeometricNormal;
    seen.uv = rt_TextureUV;
    seen.across = rt_dPdu;
    seen.up = rt_dPdv;
    Away away = Away(true);
    trace(rt_HitPoint, side, 0.0, 0.02, away);
    seen.leaves = away.isFree;
  }
  void closestHit(inout Away away) { away.isFree = false; }
};
"""


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def along(ray, t):
    return [o + t * d for o, d in zip(ray[:3], ray[3:])]


def single(x):
    return struct.unpack("f", struct.pack("f", x))[0]


class ShapeCase(Case):
    def hits(self, primitive, rays, ways=("-O0",), **more):
        """What each ray sees, the same bits on all of these paths."""
        self.write("Rays.rtsl", RAYS)
        self.write("rays.npy", npy("f", [len(rays), 6], [x for ray in rays for x in ray]))
        scene = {
            "rtsl": 1,
            "import": ["std.primitives", "Rays.rtsl"],
            "rayGeneration": {"class": "Rays", "rays": {"buffer": "rays.npy"}},
            "objects": [{"primitive": primitive, "material": {"class": "Recorder"}, **more}],
            "render": {"engine": "programs", "size": [len(rays), 1], "depth": 3},
        }
        self.write("scene.json", json.dumps(scene))
        first = None
        for way in ways:
            options = PATHS[way]
            self.run_rtslc("run", "scene.json", "-q", "--out=seen=seen.npy", *options)
            bits = (self.folder / "seen.npy").read_bytes()
            first = first or bits
            self.assertEqual(bits, first, way)
        _, numbers = read_npy(self.folder / "seen.npy")
        return [numbers[13 * i : 13 * i + 13] for i in range(len(rays))]


LOW, HIGH, COLUMNS, ROWS = [-2, -1, -1.5], [2, 0.5, 1.5], 9, 7


def relief(seed):
    dice = random.Random(seed)
    return [[single(dice.random()) for _ in range(COLUMNS)] for _ in range(ROWS)]


def to_grid(v, is_point):
    """Columns, heights and rows."""
    sizes = [COLUMNS - 1, 1, ROWS - 1]
    v = [(x - low if is_point else x) * n / (high - low)
         for x, low, high, n in zip(v, LOW, HIGH, sizes)]  # fmt: skip
    return [v[0], v[1], sizes[2] - v[2] if is_point else -v[2]]


def oracle_of_relief(heights, ray):
    """All t where the ray meets the surface, in ascending order; every cell is tried."""
    p, d = to_grid(ray[:3], True), to_grid(ray[3:], False)
    found = []
    for row in range(ROWS - 1):
        for column in range(COLUMNS - 1):
            h = [heights[row + j][column + i] for j in (0, 1) for i in (0, 1)]
            a, b, c, e = h[0], h[1] - h[0], h[2] - h[0], h[3] - h[2] - h[1] + h[0]
            x, z = p[0] - column, p[2] - row
            c0 = p[1] - (a + b * x + c * z + e * x * z)
            c1 = d[1] - d[0] * (b + e * z) - d[2] * (c + e * x)
            c2 = -e * d[0] * d[2]
            if abs(c2) < 1e-14 * (abs(c1) + 1e-300):
                roots = [-c0 / c1] if c1 else []
            elif c1 * c1 < 4 * c0 * c2:
                roots = []
            else:
                q = -0.5 * (c1 + math.copysign(math.sqrt(c1 * c1 - 4 * c0 * c2), c1))
                roots = [q / c2] + ([c0 / q] if q else [])
            for t in roots:
                u, w = x + t * d[0], z + t * d[2]
                if t > 0 and -1e-9 <= min(u, w) and max(u, w) <= 1 + 1e-9:
                    found.append(t)
    return sorted(found)


class Reliefs(ShapeCase):
    def setUp(self):
        super().setUp()
        self.heights = relief(3)
        self.primitive = {
            "class": "HeightField",
            "heights": self.heights,
            "low": LOW,
            "high": HIGH,
        }

    def compare(self, rays, distance=1.0):
        """Distances in units of the box. Returns how many rays hit."""
        rays = [[single(x) for x in ray] for ray in rays]
        hit = 0
        for ray, seen in zip(rays, self.hits(self.primitive, rays)):
            expected = oracle_of_relief(self.heights, ray)
            speed = math.sqrt(dot(ray[3:], ray[3:]))
            if len(expected) % 2 == 0 and seen[0] < 0:
                self.assertTrue(not expected or self.is_grazing(ray, expected), ray)
                continue
            self.assertGreater(seen[0], 0, ray)
            hit += 1
            error = min(abs(seen[0] - t) for t in expected) * speed
            slope = abs(dot(seen[1:4], ray[3:])) / speed
            self.assertLess(error * max(slope, 1e-3), 3e-6 * distance, ray)
            if not self.is_grazing(ray, expected):
                self.assertAlmostEqual(seen[0], expected[0], delta=1e-3 * max(1, expected[0]))
            point = along(ray, seen[0])
            self.assertAlmostEqual(seen[4], (point[0] - LOW[0]) / 4, delta=1e-5 * distance)
            self.assertAlmostEqual(seen[5], (HIGH[2] - point[2]) / 3, delta=1e-5 * distance)
            self.assertAlmostEqual(dot(seen[1:4], seen[6:9]), 0, delta=1e-5)
            self.assertAlmostEqual(dot(seen[1:4], seen[9:12]), 0, delta=1e-5)
            self.assertGreater(seen[2], 0)
        return hit

    def is_grazing(self, ray, roots):
        """Whether two hits nearly coincide, or the ray nearly misses the rectangle."""
        ends = to_grid(along(ray, roots[0]), True)
        return any(abs(a - b) * math.sqrt(dot(ray[3:], ray[3:])) < 1e-3
                   for a, b in zip(roots, roots[1:])) or not (
            1e-3 < ends[0] < COLUMNS - 1 - 1e-3 and 1e-3 < ends[2] < ROWS - 1 - 1e-3)  # fmt: skip

    def aimed(self, dice, distance):
        to = [dice.uniform(low, high) for low, high in zip(LOW, HIGH)]
        way = [dice.gauss(0, 1) for _ in range(3)]
        size = math.sqrt(dot(way, way))
        origin = [a + distance * b / size for a, b in zip(to, way)]
        length = 2.0 ** dice.randint(-8, 8)
        return [*origin, *((a - b) * length / distance for a, b in zip(to, origin))]

    def test_rays_from_near_and_far(self):
        dice = random.Random(1)
        for distance in (3, 30, 3000):
            rays = [self.aimed(dice, distance) for _ in range(300)]
            self.assertGreater(self.compare(rays, max(1, distance / 3)), 150)

    def test_along_the_axes_and_through_corners_of_the_grid(self):
        rays = []
        for row in range(ROWS):
            for column in range(COLUMNS):
                x, z = -2 + 0.5 * column, 1.5 - 0.5 * row
                inside = 0 < row < ROWS - 1 and 0 < column < COLUMNS - 1
                if inside:
                    rays += [[x, 3, z, 0, -1, 0], [x, -3, z, 0, 2, 0]]
        self.assertEqual(self.compare(rays), len(rays))
        dice = random.Random(2)
        rays = []
        for row in range(ROWS):  # along lines of the grid, in which c2 is 0
            for _ in range(8):
                rays.append([-5, dice.uniform(-0.8, 0.3), 1.5 - 0.5 * row, 1, 0, 0])
                rays.append([5, dice.uniform(-0.8, 0.3), 1.3 - 0.4 * row, -1, 0, 0])
                rays.append([-1.75 + 0.5 * row, dice.uniform(-0.8, 0.3), 4, 0, 0, -1])
                rays.append([-3 + 0.5 * row, dice.uniform(-0.8, 0.3), 2.5, 1, 0, -1])
        self.assertGreater(self.compare(rays), 150)

    def test_no_ray_slips_through(self):
        """From above through the rectangle to below: through corners and edges, too."""
        dice = random.Random(4)
        rays = []
        for _ in range(3000):
            x = dice.choice([dice.uniform(-1.9, 1.9), -1.5 + 0.5 * dice.randrange(7)])
            z = dice.choice([dice.uniform(-1.4, 1.4), -1 + 0.5 * dice.randrange(5)])
            a, b = dice.choice([(0, 0), (0.03, -0.02), (0, 0.04), (0.04, 0.04)])
            rays.append([single(c) for c in (x - a, 0.75, z - b, 2 * a, -2, 2 * b)])
        for ray, seen in zip(rays, self.hits(self.primitive, rays)):
            self.assertGreater(seen[0], 0, ray)
            self.assertLess(seen[0], 1, ray)

    def test_rays_leave_it(self):
        """Flat, so that a ray along the normal meets nothing else."""
        self.primitive["heights"] = [[0.25] * 5] * 5
        dice = random.Random(5)
        rays = [[single(x) for x in self.aimed(dice, 10.0 ** dice.uniform(0, 3))]
                for _ in range(1000)]  # fmt: skip
        seen = [one for one in self.hits(self.primitive, rays) if one[0] > 0]
        self.assertGreater(len(seen), 300)
        self.assertTrue(all(one[12] for one in seen))

    def test_every_path_has_the_same_bits(self):
        dice = random.Random(8)
        rays = [[single(x) for x in self.aimed(dice, 4)] for _ in range(300)]
        self.hits(self.primitive, rays, ways=PATHS)

    def test_an_image_is_what_a_buffer_of_its_texels_is(self):
        self.write("relief.raw", struct.pack(f"<{COLUMNS * ROWS}f", *sum(self.heights, [])))
        dice = random.Random(6)
        rays = [[single(x) for x in self.aimed(dice, 4)] for _ in range(200)]
        first = self.hits(self.primitive, rays)
        del self.primitive["heights"]
        self.primitive["image"] = {"raw": "relief.raw", "size": [COLUMNS, ROWS]}
        self.assertEqual(self.hits(self.primitive, rays), first)

    def test_heights_outside_of_the_range_are_moved_into_it(self):
        self.primitive.update(heights=[[-9.0, 30.0], [40.0, 20.0]], range=[10, 30])
        down = [0, -1, 0]
        rays = [[-1.999, 3, 1.499, *down], [1.999, 3, 1.499, *down], [1.999, 3, -1.499, *down]]
        first, second, third = (seen[0] for seen in self.hits(self.primitive, rays))
        self.assertAlmostEqual(first, 4, delta=0.01)
        self.assertAlmostEqual(second, 2.5, delta=0.01)
        self.assertAlmostEqual(third, 3.25, delta=0.01)


POINTS = [
    [-1, 0.2, 0, 0.06],
    [-0.5, 1.5, 0.5, 0.2],
    [0.5, -0.8, 0.4, 0.01],
    [1, 0.6, 0, 0.1],
    [1.4, 0.9, -0.6, 0.05],
    [0.7, 1.4, -0.9, 0.02],
    [0, 1.3, -0.3, 0.08],
]


def segments_of(basis):
    """Bezier points of each segment."""
    if basis == 0:
        return [POINTS[0:4], POINTS[3:7]]
    matrix = {
        1: [
            [1 / 6, 4 / 6, 1 / 6, 0],
            [0, 4 / 6, 2 / 6, 0],
            [0, 2 / 6, 4 / 6, 0],
            [0, 1 / 6, 4 / 6, 1 / 6],
        ],
        2: [[0, 1, 0, 0], [-1 / 6, 1, 1 / 6, 0], [0, 1 / 6, 1, -1 / 6], [0, 0, 1, 0]],
    }[basis]  # fmt: skip
    return [
        [[dot(line, column) for column in zip(*POINTS[i : i + 4])] for line in matrix]
        for i in range(4)
    ]


def curve_at(c, s):
    weights = [(1 - s) ** 3, 3 * s * (1 - s) ** 2, 3 * s * s * (1 - s), s**3]
    return [dot(weights, column) for column in zip(*c)]


def oracle_of_curve(curves, ray):
    """How far the ray's line is from the surface, negative where it meets it, and the least t at
    which it meets a ball of the curve, infinity if none."""
    speed = math.sqrt(dot(ray[3:], ray[3:]))
    way = [d / speed for d in ray[3:]]

    def meet(c, s):
        *center, r = curve_at(c, s)
        f = [a - b for a, b in zip(center, ray)]
        z = dot(f, way)
        off = [a - z * b for a, b in zip(f, way)]
        d2 = dot(off, off)
        return math.sqrt(d2) - r, (z - math.sqrt(r * r - d2)) / speed if d2 < r * r else math.inf

    nearest, first = math.inf, math.inf
    for c in curves:
        steps = 200
        samples = [meet(c, i / steps) for i in range(steps + 1)]
        for which in (0, 1):
            best = min(range(steps + 1), key=lambda i: samples[i][which])
            low, high = max(best - 1, 0) / steps, min(best + 1, steps) / steps
            for _ in range(40):  # ternary search
                a, b = low + (high - low) / 3, high - (high - low) / 3
                if meet(c, a)[which] < meet(c, b)[which]:
                    high = b
                else:
                    low = a
            value = min(samples[best][which], meet(c, 0.5 * (low + high))[which])
            if which == 0:
                nearest = min(nearest, value)
            else:
                first = min(first, value)
    return nearest, first


def oracle_of_exit(curves, ray):
    """Where a ray that begins in the curve first is in no ball of it, as a distance."""
    speed = math.sqrt(dot(ray[3:], ray[3:]))
    way = [d / speed for d in ray[3:]]
    parts = []
    for c in curves:
        for i in range(401):
            *center, r = curve_at(c, i / 400)
            f = [a - b for a, b in zip(center, ray)]
            z = dot(f, way)
            square = r * r - (dot(f, f) - z * z)
            if square > 0:
                parts.append((z - math.sqrt(square), z + math.sqrt(square)))
    reached = 0
    for begin, end in sorted(parts):
        if begin <= reached:
            reached = max(reached, end)
    return reached


# How many surfaces each ray meets, and how often it enters more than it leaves.
THROUGH = """
struct Seen { float t; int side; };
class Through : rt_RayGeneration {
  public float rays[][6];
  public out int sides[][2];
  void generate() {
    int i = int(rt_LaunchIndex.x);
    vec3 o = vec3(rays[i][0], rays[i][1], rays[i][2]);
    vec3 d = vec3(rays[i][3], rays[i][4], rays[i][5]);
    float t = 0.0;
    int met = 0;
    int depth = 0;
    for (int n = 0; n < 20; ++n) {
      Seen seen = Seen(-1.0, 0);
      trace(o, d, t, 3.4e38, seen);
      if (seen.t < 0.0) break;
      ++met;
      depth += seen.side;
      if (depth < 0 || depth > 1) break;
      t = seen.t + 1e-5 / length(d);
    }
    sides[i] = int[](met, depth);
  }
};
class Side : rt_Material {
  void closestHit(inout Seen seen) {
    seen.t = rt_HitDistance;
    seen.side = dot(rt_RayDirection, rt_GeometricNormal) < 0.0 ? 1 : -1;
  }
};
"""


class Curves(ShapeCase):
    def rays(self, dice, distance, count):
        rays = []
        for _ in range(count):
            c = segments_of(0)[dice.randrange(2)]
            *to, radius = curve_at(c, dice.random())
            to = [x + dice.uniform(-2, 2) * radius for x in to]
            way = [dice.gauss(0, 1) for _ in range(3)]
            if dice.random() < 0.3:  # along an axis
                way = [0, 0, 0]
                way[dice.randrange(3)] = dice.choice([-1, 1])
            size = math.sqrt(dot(way, way))
            length = 2.0 ** dice.randint(-8, 8)
            direction = [-x / size * length for x in way]
            origin = [a + distance * b / size for a, b in zip(to, way)]
            rays.append([single(x) for x in (*origin, *direction)])
        return rays

    def compare(self, basis, distance, tolerance=0.01, count=150):
        """Returns how many rays hit."""
        curves = segments_of(basis)
        rays = self.rays(random.Random(basis), distance, count)
        primitive = {"class": "Curve", "points": POINTS, "basis": basis, "tolerance": tolerance}
        hit = 0
        for ray, seen in zip(rays, self.hits(primitive, rays, count=len(curves))):
            speed = math.sqrt(dot(ray[3:], ray[3:]))
            nearest, first = oracle_of_curve(curves, ray)
            slack = tolerance * 0.2 + 4e-7 * distance
            if abs(nearest) < slack:
                continue
            self.assertEqual(seen[0] > 0, nearest < 0, ray)
            if seen[0] < 0:
                continue
            hit += 1
            cosine = abs(dot(seen[1:4], ray[3:])) / speed
            if cosine > 0.2:
                self.assertLess(abs(seen[0] - first) * speed * cosine, 4 * slack, ray)
            self.assertLess(dot(seen[1:4], ray[3:]), 0.2 * speed, ray)
            self.assertTrue(all(-1e-6 <= x <= 1 + 1e-6 for x in seen[4:6]))
            self.assertAlmostEqual(dot(seen[1:4], seen[6:9]), 0, delta=1e-3)
            self.assertAlmostEqual(dot(seen[1:4], seen[9:12]), 0, delta=1e-3)
            self.assertTrue(seen[12] or distance > 100, ray)
        return hit

    def test_every_basis(self):
        for basis in (0, 1, 2):
            self.assertGreater(self.compare(basis, 4), 40 if basis == 0 else 10)

    def test_from_far_away(self):
        self.assertGreater(self.compare(0, 1000), 40)

    def test_every_path_has_the_same_bits(self):
        rays = self.rays(random.Random(10), 4, 300)
        self.hits({"class": "Curve", "points": POINTS}, rays, ways=PATHS, count=2)

    def test_a_tighter_tolerance_is_kept(self):
        self.assertGreater(self.compare(0, 4, tolerance=0.001), 40)

    def test_many_curves_in_one_buffer(self):
        """`pointsPerCurve` separates them: each is what it is alone."""
        other = [[x + 1, y, z, r] for x, y, z, r in POINTS[:4]]
        rays = self.rays(random.Random(9), 4, 200)
        alone = [
            self.hits({"class": "Curve", "points": points}, rays) for points in (POINTS[:4], other)
        ]
        both = {"class": "Curve", "points": POINTS[:4] + other, "pointsPerCurve": 4}
        hits = 0
        for a, b, together in zip(*alone, self.hits(both, rays, count=2)):
            nearest = min((one for one in (a, b) if one[0] > 0), key=lambda x: x[0], default=a)
            self.assertEqual(nearest[:12], together[:12])
            hits += together[0] > 0
        self.assertGreater(hits, 60)

    def test_rays_from_inside_meet_where_they_leave(self):
        """The first point that is in no ball of the curve, also beyond the joints of segments."""
        dice = random.Random(12)
        for basis in (0, 1, 2):
            curves = segments_of(basis)
            rays = []
            for i in range(40):
                # In the middle, near a joint, and along the curve.
                s = dice.choice([dice.random(), 0.01, 0.99])
                c = dice.choice(curves)
                *origin, radius = curve_at(c, s)
                origin = [x + dice.uniform(-0.5, 0.5) * radius for x in origin]
                way = [dice.gauss(0, 1) for _ in range(3)]
                if i % 2:
                    way = [b - a for a, b in zip(curve_at(c, s - 0.01), curve_at(c, s + 0.01))][:3]
                rays.append([single(x) for x in (*origin, *way)])
            primitive = {"class": "Curve", "points": POINTS, "basis": basis}
            for ray, seen in zip(rays, self.hits(primitive, rays, count=len(curves))):
                speed = math.sqrt(dot(ray[3:], ray[3:]))
                expected = oracle_of_exit(curves, ray)
                cosine = dot(seen[1:4], ray[3:]) / speed
                self.assertGreater(cosine, -0.1, ray)
                if cosine > 0.2:
                    self.assertAlmostEqual(seen[0] * speed * cosine, expected * cosine, delta=0.004)

    def test_a_ray_through_a_curve_enters_and_leaves_it(self):
        """As often as each other, in turn, whatever segments and pieces it passes."""
        self.write("Through.rtsl", THROUGH)
        rays = self.rays(random.Random(13), 4, 300)
        self.write("rays.npy", npy("f", [len(rays), 6], [x for ray in rays for x in ray]))
        scene = {
            "rtsl": 1,
            "import": ["std.primitives", "Through.rtsl"],
            "rayGeneration": {"class": "Through", "rays": {"buffer": "rays.npy"}},
            "objects": [
                {
                    "primitive": {"class": "Curve", "points": POINTS},
                    "count": 2,
                    "material": {"class": "Side"},
                }
            ],
            "render": {"engine": "programs", "size": [len(rays), 1], "depth": 3},
        }
        self.write("scene.json", json.dumps(scene))
        self.run_rtslc("run", "scene.json", "-q", "--out=sides=sides.npy")
        _, sides = read_npy(self.folder / "sides.npy")
        balanced = [(sides[2 * i], sides[2 * i + 1]) for i in range(len(rays))]
        self.assertGreater(sum(n > 0 for n, _ in balanced), 100)
        self.assertLess(sum(d != 0 for _, d in balanced), 4, balanced)  # those that graze it

    def test_bad_points_are_no_hits(self):
        """None, and four times the same of radius 0."""
        for points in ([], [[0, 0, 0, 0]] * 4):
            for seen in self.hits(
                {"class": "Curve", "points": points}, [[0, 0, 3, 0, 0, -1], [1, 0, 3, 0, 0, -1]]
            ):
                self.assertTrue(seen[0] < 0 or points)


if __name__ == "__main__":
    unittest.main()
