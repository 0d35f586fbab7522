//===- Motion.h - transforms and meshes at a time -------------------------===//
//
// What moves is computed for the time of a ray when the ray reaches it: a transform as a product of
// its factors, in double, rounded once to the floats of an RtslTransform, so that everything else
// treats it like one that rests (a rigid one keeps its rotation in double, too); a vertex of a mesh
// by interpolation between its keys. Before its first key and after its last one everything rests,
// and rays see nothing outside of the shutter's time.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "math/kernels/SineSeries.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// A ray's time, in the shutter: NaN is when it opens.
inline float timeInShutter(const RtslLaunch &launch, float time) {
  return time > launch.shutterOpen ? minimum(time, launch.shutterClose) : launch.shutterOpen;
}

/// Does some transform of the scene move? Folds to a constant in a compiled program.
inline bool hasMotion(const RtslLaunch &launch) {
  return (rtsl_needs(&launch) & RTSL_HAS_MOTION) != 0;
}
inline bool moves(const RtslLaunch &launch, const RtslTransform &transform) {
  return hasMotion(launch) && transform.motion != 0;
}

/// Is some transform more than a translation? Otherwise the linear parts of all are the identity,
/// and are not read: each function below then gives the same bits with less work.
inline bool hasLinear(const RtslLaunch &launch) {
  return (rtsl_needs(&launch) & RTSL_HAS_LINEAR) != 0;
}
/// Does some transform turn or shear? Otherwise linear parts are scales along the axes, equal or
/// not, and only their diagonals are read: products with the zeros beside them would change no bit.
inline bool hasTurns(const RtslLaunch &launch) {
  return (rtsl_needs(&launch) & RTSL_HAS_TURNS) != 0;
}
/// Does some transform scale? Otherwise all are rigid, rotations and translations.
inline bool hasScale(const RtslLaunch &launch) {
  return (rtsl_needs(&launch) & RTSL_HAS_SCALE) != 0;
}
/// Does some transform stretch one direction more than another, or mirror? Otherwise all are
/// rotations with uniform scales: inverses are transposes, divided by the square of the scale, and
/// none is computed for what moves.
inline bool hasStretch(const RtslLaunch &launch) {
  return (rtsl_needs(&launch) & RTSL_HAS_STRETCH) != 0;
}
/// Is the inverse the transpose of the linear part before that is rounded, divided by squaredScale?
inline bool isTransposed(const RtslLaunch &launch, const RtslTransform &transform) {
  return !hasScale(launch) || transform.squaredScale > 0;
}

/// Has the mesh several keys?
inline bool moves(const RtslLaunch &launch, const RtslMesh &mesh) {
  return (rtsl_needs(&launch) & RTSL_HAS_MESH_KEYS) != 0 && mesh.keyTimes;
}

/// A time between keys: after number `key`, by a share in [0, 1] of the way to the next.
struct KeyTime {
  uint32_t key;
  double share;
};

/// `timeOf(key)` ascends; there are at least two keys.
template <typename TimeOf>
KeyTime findKey(uint32_t count, float time, TimeOf timeOf) {
  uint32_t first = 0, last = count - 2; // the result is between them
  while (first < last) {
    const uint32_t middle = first + (last - first + 1) / 2;
    if (timeOf(middle) <= time)
      first = middle;
    else
      last = middle - 1;
  }
  const double begin = double(timeOf(first)), end = double(timeOf(first + 1));
  const double share = (double(time) - begin) / (end - begin);
  return {first, share > 0 ? share < 1 ? share : 1.0 : 0.0};
}

/// Exactly a at share 0 and b at 1. Rounded to float, a value between two floats is not outside of
/// them: the error is below 2^-51 of the larger one.
inline double interpolate(double a, double b, double share) {
  return __builtin_fma(share, b, __builtin_fma(-share, a, a));
}

/// An affine map: the columns of its linear part, then the translation.
struct AffineMap {
  double numbers[12];
};

/// First `inner`, then `outer`.
inline AffineMap product(const AffineMap &outer, const AffineMap &inner) {
  AffineMap result;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) {
      const double *m = outer.numbers + row, *v = inner.numbers + 3 * column;
      const double offset = column == 3 ? m[9] : 0.0;
      result.numbers[3 * column + row] =
          __builtin_fma(m[0], v[0], __builtin_fma(m[3], v[1], __builtin_fma(m[6], v[2], offset)));
    }
  return result;
}

/// The rotation of a unit quaternion (w, x, y, z).
inline AffineMap rotationOf(const double q[4]) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 2 * (x * y - w * z),
           1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 2 * (x * z + w * y), 2 * (y * z - w * x),
           1 - 2 * (x * x + y * y), 0, 0, 0}};
}

/// A rotation after a share of the time from this key to the next.
inline AffineMap rotationAfter(const RtslMotionKey &key, double share) {
  const double quarters = share * key.numbers[8];
  const detail::NearestInteger whole = detail::nearestInteger(quarters);
  const double rest = (quarters - whole.asDouble) * 0x1.921fb54442d18p0; // pi/2
  const double sine = detail::plainSine(rest), cosine = detail::plainCosine(rest);
  const bool isOdd = whole.asInt & 1;
  const double along = ((whole.asInt + 1) & 2 ? -1.0 : 1.0) * (isOdd ? sine : cosine),
               across = (whole.asInt & 2 ? -1.0 : 1.0) * (isOdd ? cosine : sine);
  double q[4];
  for (int i = 0; i < 4; ++i)
    q[i] = __builtin_fma(across, key.numbers[4 + i], along * key.numbers[i]);
  return rotationOf(q);
}

inline AffineMap factorAt(const RtslLaunch &launch, const RtslMotionFactor &factor, float time) {
  const RtslMotionKey *keys = launch.motionKeys + factor.firstKey;
  AffineMap map;
  if (factor.keyCount == 1) {
    for (int i = 0; i < 12; ++i)
      map.numbers[i] = keys[0].numbers[i];
    return map;
  }
  const KeyTime at =
      findKey(factor.keyCount, time, [keys](uint32_t key) { return keys[key].time; });
  const RtslMotionKey &from = keys[at.key], &to = keys[at.key + 1];
  if (factor.isRotation)
    return rotationAfter(from, at.share);
  for (int i = 0; i < 12; ++i)
    map.numbers[i] = interpolate(from.numbers[i], to.numbers[i], at.share);
  return map;
}

/// Sets `inverse` from `linear`; to 0 if there is none: a direction becomes 0, and no ray enters.
inline void invert(RtslTransform &transform) {
  double m[9];
  for (int i = 0; i < 9; ++i)
    m[i] = double(transform.linear[i]);
  double cofactors[9]; // as columns of the adjugate
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      // Kahan's difference of products: exact to some units, even where the products cancel.
      const double back = m[3 * i2 + j1] * m[3 * i1 + j2];
      cofactors[3 * j + i] = __builtin_fma(m[3 * i1 + j1], m[3 * i2 + j2], -back) +
                             __builtin_fma(-m[3 * i2 + j1], m[3 * i1 + j2], back);
    }
  const double determinant = m[0] * cofactors[0] + m[1] * cofactors[3] + m[2] * cofactors[6];
  for (int i = 0; i < 9; ++i)
    transform.inverse[i] = determinant != 0 ? cofactors[i] / determinant : 0.0;
}

/// Sets the inverse of a transform whose other numbers are set; `map` is what it rounds.
inline void setInverse(const RtslLaunch &launch, const AffineMap &map, RtslTransform &transform) {
  if (!hasLinear(launch)) {
    for (int i = 0; i < 9; ++i)
      transform.inverse[i] = i % 4 == 0 ? 1.0 : 0.0;
  } else if (isTransposed(launch, transform)) {
    const double reciprocal = hasScale(launch) ? 1 / transform.squaredScale : 1.0;
    for (int i = 0; i < 9; ++i)
      transform.inverse[i] = map.numbers[3 * (i % 3) + i / 3] * reciprocal;
  } else if (!hasStretch(launch) || transform.squaredScale < 0) {
    for (int i = 0; i < 9; ++i)
      transform.inverse[i] = i % 4 == 0 ? 1 / double(transform.linear[i]) : 0.0;
  } else {
    invert(transform);
  }
}

/// A transform that moves, which is `rest` at time 0, at a time.
inline RtslTransform transformAt(const RtslLaunch &launch, const RtslTransform &rest, float time) {
  const RtslMotion &motion = launch.motions[rest.motion];
  time = timeInShutter(launch, time);
  const RtslMotionFactor *factors = launch.motionFactors + motion.firstFactor;
  AffineMap map = factorAt(launch, factors[0], time);
  for (uint32_t i = 1; i < motion.factorCount; ++i)
    map = product(factorAt(launch, factors[i], time), map);
  RtslTransform transform;
  for (int i = 0; i < 9; ++i)
    transform.linear[i] = float(map.numbers[i]);
  for (int i = 0; i < 3; ++i)
    transform.translation[i] = float(map.numbers[9 + i]) + 0.0f; // not -0
  transform.squaredScale = rest.squaredScale;
  setInverse(launch, map, transform);
  transform.motion = 0;
  return transform;
}

/// The three numbers of a vertex, of positions or normals of a mesh that has several keys, at a
/// time in the shutter.
inline Vec3 vertexAt(const RtslMesh &mesh, const float *values, uint32_t vertex, float time) {
  const KeyTime at =
      findKey(mesh.keyCount, time, [&mesh](uint32_t key) { return mesh.keyTimes[key]; });
  const float *from = values + 3 * (size_t(at.key) * mesh.vertexCount + vertex);
  const float *to = from + 3 * size_t(mesh.vertexCount);
  return {float(interpolate(double(from[0]), double(to[0]), at.share)),
          float(interpolate(double(from[1]), double(to[1]), at.share)),
          float(interpolate(double(from[2]), double(to[2]), at.share))};
}

/// The same for any mesh of the launch.
inline Vec3 vertexAt(const RtslLaunch &launch, const RtslMesh &mesh, const float *values,
                     uint32_t vertex, float time) {
  return moves(launch, mesh) ? vertexAt(mesh, values, vertex, timeInShutter(launch, time))
                             : load(values + 3 * size_t(vertex));
}

/// A box around a triangle while the shutter is open: around its places when it opens and closes
/// and at the keys in between, enlarged by the rounding of places in between.
inline RtslBox boxOfTriangle(const RtslLaunch &launch, const RtslMesh &mesh, uint32_t triangle) {
  const uint32_t *index = mesh.indices + 3 * size_t(triangle);
  RtslBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = __builtin_inff();
    box.upper[axis] = -__builtin_inff();
  }
  const auto add = [&](Vec3 p) {
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = minimum(box.lower[axis], p[axis]);
      box.upper[axis] = maximum(box.upper[axis], p[axis]);
    }
  };
  if (!mesh.keyTimes) {
    for (int corner = 0; corner < 3; ++corner)
      add(load(mesh.positions + 3 * size_t(index[corner])));
    return box;
  }
  float size = 0; // of coordinates at keys
  for (int corner = 0; corner < 3; ++corner) {
    add(vertexAt(mesh, mesh.positions, index[corner], launch.shutterOpen));
    add(vertexAt(mesh, mesh.positions, index[corner], launch.shutterClose));
    for (uint32_t key = 0; key < mesh.keyCount; ++key) {
      const Vec3 p = load(mesh.positions + 3 * (size_t(key) * mesh.vertexCount + index[corner]));
      size = maximum(size, largest(p));
      if (mesh.keyTimes[key] > launch.shutterOpen && mesh.keyTimes[key] < launch.shutterClose)
        add(p);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] -= size * 0x1p-22f;
    box.upper[axis] += size * 0x1p-22f;
  }
  return box;
}

} // namespace rtsl::device
