"""What a sampler should return, in double precision."""

import math


def decode_srgb(value):
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def encode_srgb(value):
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


class Oracle:
    """An image as a list of levels; a level maps (x, y, z) from the lower left front to four
    numbers."""

    def __init__(self, size, texel, wrap, filter, anisotropy=16, round_level=lambda value: value):
        self.wrap, self.filter, self.anisotropy = wrap, filter, anisotropy
        self.sizes, self.levels = [tuple(size)], [{at: texel(*at) for at in self.all(size)}]
        if filter in ("trilinear", "anisotropic"):
            while max(self.sizes[-1]) > 1:
                before = self.sizes[-1]
                after = tuple(max(n // 2, 1) for n in before)
                self.levels.append(
                    {
                        at: round_level(self.mean(self.levels[-1], before, after, at))
                        for at in self.all(after)
                    }
                )
                self.sizes.append(after)

    @staticmethod
    def all(size):
        return [(x, y, z) for x in range(size[0]) for y in range(size[1]) for z in range(size[2])]

    @staticmethod
    def mean(level, before, after, at):
        axes = []
        for n, m, i in zip(before, after, at):
            begin, end = i * n / m, (i + 1) * n / m
            axes.append(
                [
                    (j, min(end, j + 1) - max(begin, j))
                    for j in range(n)
                    if min(end, j + 1) > max(begin, j)
                ]
            )
        total = [0.0] * 4
        weights = 0.0
        for x, a in axes[0]:
            for y, b in axes[1]:
                for z, c in axes[2]:
                    weights += a * b * c
                    total = [t + a * b * c * v for t, v in zip(total, level[x, y, z])]
        return tuple(t / weights for t in total)

    def texel(self, level, at):
        place = []
        for i, n, wrap in zip(at, self.sizes[level], self.wrap):
            if wrap == "repeat":
                i %= n
            elif wrap == "mirror":
                i %= 2 * n
                i = min(i, 2 * n - 1 - i)
            elif wrap == "clamp":
                i = min(max(i, 0), n - 1)
            elif not 0 <= i < n:
                return (0.0,) * 4
            place.append(i)
        return self.levels[level][tuple(place)]

    def linear(self, p, level):
        position = [c * n - 0.5 for c, n in zip(p, self.sizes[level])]
        corner = [math.floor(c) for c in position]
        total = [0.0] * 4
        for step in self.all((2, 2, 2 if len(p) == 3 else 1)):
            weight = 1.0
            for c, low, s in zip(position, corner, step):
                weight *= c - low if s else 1 - (c - low)
            if weight:
                at = [low + s for low, s in zip(corner, step)] + [0] * (3 - len(p))
                total = [t + weight * v for t, v in zip(total, self.texel(level, at))]
        return total

    def sample(self, p, lod=0.0):
        if self.filter == "nearest":
            return self.texel(
                0, [math.floor(c * n) for c, n in zip(p, self.sizes[0])] + [0] * (3 - len(p))
            )
        lod = min(max(lod, 0.0), len(self.levels) - 1)
        finer = int(lod)
        value = self.linear(p, finer)
        if lod == finer:
            return value
        return [a + (b - a) * (lod - finer) for a, b in zip(value, self.linear(p, finer + 1))]

    def sample_grad(self, p, dx, dy):
        if self.filter in ("nearest", "bilinear"):
            return self.sample(p)
        sides = [math.sqrt(sum((c * n) ** 2 for c, n in zip(d, self.sizes[0]))) for d in (dx, dy)]
        longer, shorter = max(sides), min(sides)
        if self.filter == "trilinear":
            return self.sample(p, math.log2(longer) if longer else 0.0)
        count = (
            min(math.ceil(longer / shorter), self.anisotropy)
            if longer > shorter > 0
            else self.anisotropy
            if longer > 0
            else 1
        )
        along = dx if sides[0] >= sides[1] else dy
        total = [0.0] * 4
        for i in range(count):
            at = [c + ((i + 0.5) / count - 0.5) * d for c, d in zip(p, along)]
            total = [t + v for t, v in zip(total, self.sample(at, math.log2(longer / count)))]
        return [t / count for t in total]

    def load(self, at, level=0):
        level = min(level, len(self.levels) - 1)
        inside = [
            min(max(i, 0), n - 1) for i, n in zip(list(at) + [0] * (3 - len(at)), self.sizes[level])
        ]
        return self.levels[level][tuple(inside)]
