//===- Flip.cpp -----------------------------------------------------------===//
#include "report/measures/Flip.h"

#include "support/ErrorMessages.h"
#include "support/Parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rtsl::report {

namespace {

using Color = std::array<float, 3>;

constexpr double pi = 3.14159265358979323846;

/// One float or one color a pixel.
template <typename T>
struct Plane {
  std::uint32_t width, height;
  std::vector<T> values;

  Plane(std::uint32_t width, std::uint32_t height)
      : width(width), height(height), values(std::size_t(width) * height) {}
  T &at(std::uint32_t x, std::uint32_t y) { return values[std::size_t(y) * width + x]; }
  const T &at(std::uint32_t x, std::uint32_t y) const { return values[std::size_t(y) * width + x]; }
};

/// The pixel `offset` steps from `i`; the border is repeated outwards.
std::uint32_t clampedStep(std::uint32_t i, int offset, std::uint32_t size) {
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(std::int64_t(i) + offset, 0, std::int64_t(size) - 1));
}

//===-- colour spaces -----------------------------------------------------===//

// Linear sRGB to CIE XYZ, and the white of RGB (1, 1, 1): D65, the sum of each row.
constexpr double rgbToXyz[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};
constexpr double white(int i) {
  return rgbToXyz[i][0] + rgbToXyz[i][1] + rgbToXyz[i][2];
}

using Matrix = std::array<std::array<double, 3>, 3>;

constexpr Matrix inverseOf(const double (&m)[3][3]) {
  const auto minor = [&](int i, int j) {
    const int r0 = (i + 1) % 3, r1 = (i + 2) % 3, c0 = (j + 1) % 3, c1 = (j + 2) % 3;
    return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  Matrix inverse{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      inverse[i][j] = minor(j, i) / determinant;
  return inverse;
}
constexpr Matrix xyzToRgb = inverseOf(rgbToXyz);

/// XYZ divided by white.
std::array<double, 3> relativeXyz(const Color &rgb) {
  std::array<double, 3> xyz;
  for (int i = 0; i < 3; ++i)
    xyz[i] =
        (rgbToXyz[i][0] * rgb[0] + rgbToXyz[i][1] * rgb[1] + rgbToXyz[i][2] * rgb[2]) / white(i);
  return xyz;
}

/// YCxCz, an opponent space that is linear in light (2020, section 4.1.1).
Color toOpponent(const Color &rgb) {
  const auto [x, y, z] = relativeXyz(rgb);
  return {float(116 * y - 16), float(500 * (x - y)), float(200 * (y - z))};
}

Color fromOpponent(const Color &opponent) {
  const double y = (opponent[0] + 16.0) / 116, x = y + opponent[1] / 500.0,
               z = y - opponent[2] / 200.0;
  const double xyz[3] = {x * white(0), y * white(1), z * white(2)};
  Color rgb;
  for (int i = 0; i < 3; ++i)
    rgb[i] = float(xyzToRgb[i][0] * xyz[0] + xyzToRgb[i][1] * xyz[1] + xyzToRgb[i][2] * xyz[2]);
  return rgb;
}

/// CIE 1976 L*a*b*, with colours that fade in the dark as for the eye (Hunt's effect).
Color toHuntLab(const Color &rgb) {
  const auto f = [](double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const auto [x, y, z] = relativeXyz(rgb);
  const double lightness = 116 * f(y) - 16;
  return {float(lightness), float(0.01 * lightness * 500 * (f(x) - f(y))),
          float(0.01 * lightness * 200 * (f(y) - f(z)))};
}

/// The distance for large differences: city block in lightness, Euclidean in colour.
double hyabDistance(const Color &a, const Color &b) {
  return std::abs(double(a[0]) - b[0]) + std::hypot(double(a[1]) - b[1], double(a[2]) - b[2]);
}

//===-- filters -----------------------------------------------------------===//

/// A symmetric window of weights, from -radius to radius.
struct Kernel {
  std::vector<float> weights;
  explicit Kernel(int radius) : weights(2 * radius + 1) {}
  int radius() const { return int(weights.size() / 2); }
  float &operator[](int offset) { return weights[offset + radius()]; }
  float operator[](int offset) const { return weights[offset + radius()]; }
};

template <typename Weight>
Kernel makeKernel(int radius, Weight weight) {
  Kernel kernel(radius);
  for (int i = -radius; i <= radius; ++i)
    kernel[i] = float(weight(double(i)));
  return kernel;
}

double sumOf(const Kernel &kernel) {
  double sum = 0;
  for (float weight : kernel.weights)
    sum += weight;
  return sum;
}

/// Scales positive weights to the sum 1, negative ones to -1.
void normalise(Kernel &kernel) {
  double positive = 0, negative = 0;
  for (float weight : kernel.weights)
    (weight > 0 ? positive : negative) += weight;
  for (float &weight : kernel.weights)
    weight = float(weight / (weight > 0 ? positive : -negative));
}

/// The eye's contrast sensitivity in one channel: a sum of Gaussians of the distance x in degrees,
/// a sqrt(pi / b) exp(-pi^2 x^2 / b) each (2020, table 1). Each is separable, their sum is not.
struct Sensitivity {
  double a[2], b[2];
};
constexpr Sensitivity sensitivities[3] = {
    {{1, 0}, {0.0047, 1e-5}}, {{1, 0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}};

/// The separable parts of a channel's filter with their weights in the sum.
struct ChannelFilter {
  std::vector<std::pair<double, Kernel>> parts;
};

ChannelFilter channelFilter(const Sensitivity &sensitivity, int radius, double pixelsPerDegree) {
  ChannelFilter filter;
  double total = 0;
  for (int i = 0; i < 2; ++i) {
    if (sensitivity.a[i] == 0)
      continue;
    const double b = sensitivity.b[i];
    Kernel kernel = makeKernel(radius, [&](double x) {
      return std::exp(-pi * pi * x * x / (pixelsPerDegree * pixelsPerDegree * b));
    });
    const double weight = sensitivity.a[i] * std::sqrt(pi / b), sum = sumOf(kernel);
    total += weight * sum * sum;
    filter.parts.emplace_back(weight, std::move(kernel));
  }
  for (auto &[weight, kernel] : filter.parts)
    weight /= total;
  return filter;
}

/// `input` convolved with `along` in x or y and added to `output` with a weight.
template <typename Read>
Plane<float> convolveRows(std::uint32_t width, std::uint32_t height, const Kernel &kernel,
                          Read read) {
  Plane<float> output(width, height);
  forEachInParallel(0, height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      float sum = 0;
      for (int i = -kernel.radius(); i <= kernel.radius(); ++i)
        sum += kernel[i] * read(clampedStep(x, i, width), y);
      output.at(x, y) = sum;
    }
  });
  return output;
}

Plane<float> convolveColumns(const Plane<float> &input, const Kernel &kernel) {
  Plane<float> output(input.width, input.height);
  forEachInParallel(0, input.height, [&](std::uint32_t y) {
    float *row = &output.at(0, y);
    for (int i = -kernel.radius(); i <= kernel.radius(); ++i) {
      const float *from = &input.at(0, clampedStep(y, i, input.height));
      for (std::uint32_t x = 0; x < input.width; ++x)
        row[x] += kernel[i] * from[x];
    }
  });
  return output;
}

/// The colours that the eye resolves in a picture in YCxCz, as Hunt-adjusted L*a*b*.
Plane<Color> seenColors(const Plane<Color> &opponent, double pixelsPerDegree) {
  constexpr double widest = 0.04; // of all b above
  const int radius = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixelsPerDegree));
  Plane<Color> seen(opponent.width, opponent.height);
  for (int channel = 0; channel < 3; ++channel)
    for (const auto &[weight, kernel] :
         channelFilter(sensitivities[channel], radius, pixelsPerDegree).parts) {
      const Plane<float> rows = convolveRows(
          opponent.width, opponent.height, kernel,
          [&, channel](std::uint32_t x, std::uint32_t y) { return opponent.at(x, y)[channel]; });
      const Plane<float> both = convolveColumns(rows, kernel);
      for (std::size_t i = 0; i < both.values.size(); ++i)
        seen.values[i][channel] += float(weight * both.values[i]);
    }
  forEachInParallel(0, seen.height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < seen.width; ++x) {
      Color rgb = fromOpponent(seen.at(x, y));
      for (float &component : rgb)
        component = std::clamp(component, 0.0f, 1.0f);
      seen.at(x, y) = toHuntLab(rgb);
    }
  });
  return seen;
}

/// Strength of edges and of points at each pixel.
struct Features {
  Plane<float> edges, points;
};

Features findFeatures(const Plane<Color> &opponent, double pixelsPerDegree) {
  constexpr double featureWidth = 0.082; // degrees (2020, section 4.2)
  const double deviation = 0.5 * featureWidth * pixelsPerDegree;
  const int radius = int(std::ceil(3 * deviation));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  Kernel smooth = makeKernel(radius, gaussian);
  Kernel first = makeKernel(radius, [&](double x) { return -x * gaussian(x); });
  Kernel second = makeKernel(
      radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); });
  for (Kernel *kernel : {&smooth, &first, &second})
    normalise(*kernel);

  const auto luminance = [&](std::uint32_t x, std::uint32_t y) {
    return (opponent.at(x, y)[0] + 16) / 116;
  };
  const auto rows = [&](const Kernel &kernel) {
    return convolveRows(opponent.width, opponent.height, kernel, luminance);
  };
  const auto length = [](Plane<float> x, const Plane<float> &y) {
    for (std::size_t i = 0; i < x.values.size(); ++i)
      x.values[i] = std::hypot(x.values[i], y.values[i]);
    return x;
  };
  const Plane<float> smoothed = rows(smooth);
  return {length(convolveColumns(rows(first), smooth), convolveColumns(smoothed, first)),
          length(convolveColumns(rows(second), smooth), convolveColumns(smoothed, second))};
}

//===-- LDR-FLIP ----------------------------------------------------------===//

/// Distances in colour to [0, 1]: compressed, and the upper part flattened (2020, section 4.1.3).
double colorError(double distance, double largest) {
  constexpr double exponent = 0.7, knee = 0.4, kneeError = 0.95;
  const double power = std::pow(distance, exponent), most = std::pow(largest, exponent);
  return power < knee * most
             ? kneeError / (knee * most) * power
             : kneeError + (power - knee * most) / (most - knee * most) * (1 - kneeError);
}

double featureError(double edge, double point) {
  return std::sqrt(std::max(edge, point) / std::sqrt(2.0));
}

/// The data of one picture for LDR-FLIP; values in [0, 1].
struct Seen {
  Plane<Color> colors;
  Features features;

  Seen(const Plane<Color> &opponent, double pixelsPerDegree)
      : colors(seenColors(opponent, pixelsPerDegree)),
        features(findFeatures(opponent, pixelsPerDegree)) {}
};

FlipMap difference(const Seen &reference, const Seen &test) {
  const double largest =
      hyabDistance(toHuntLab({0, 1, 0}), toHuntLab({0, 0, 1})); // green beside blue
  FlipMap map{reference.colors.width, reference.colors.height, {}};
  map.error.resize(reference.colors.values.size());
  forEachInParallel(0, map.height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < map.width; ++x) {
      const double color =
          colorError(hyabDistance(reference.colors.at(x, y), test.colors.at(x, y)), largest);
      const double edge =
          std::abs(reference.features.edges.at(x, y) - test.features.edges.at(x, y));
      const double point =
          std::abs(reference.features.points.at(x, y) - test.features.points.at(x, y));
      map.error[std::size_t(y) * map.width + x] =
          float(std::pow(color, 1 - featureError(edge, point)));
    }
  });
  return map;
}

template <typename OnScreen>
Plane<Color> opponentPlane(const runtime::Image &image, OnScreen onScreen) {
  Plane<Color> plane(image.width, image.height);
  forEachInParallel(0, image.height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const float *pixel = image.at(x, y);
      plane.at(x, y) = toOpponent({onScreen(pixel[0]), onScreen(pixel[1]), onScreen(pixel[2])});
    }
  });
  return plane;
}

void requireComparable(const runtime::Image &reference, const runtime::Image &test) {
  if (reference.channels != 3 || test.channels != 3)
    throw Error(message::flipNeedsRgb());
  if (reference.width != test.width || reference.height != test.height)
    throw Error(message::flipNeedsOneSize());
  if (reference.pixels.empty())
    throw Error(message::emptyPictureCompared());
}

//===-- tone mapping ------------------------------------------------------===//

// (c0 x^2 + c1 x) / (c3 x^2 + c4 x + c5); the factor 0.6 is the exposure that the fit was made for.
constexpr double c0 = 0.6 * 0.6 * 2.51, c1 = 0.6 * 0.03, c3 = 0.6 * 0.6 * 2.43, c4 = 0.6 * 0.59,
                 c5 = 0.14;

/// Light to the screen's [0, 1].
float aces(double x) {
  if (!(x > 0)) // also for NaN
    return 0;
  if (x > 1e6) // where the curve is flat, and x^2 still finite
    x = 1e6;
  return float(std::clamp((c0 * x * x + c1 * x) / (c3 * x * x + c4 * x + c5), 0.0, 1.0));
}

/// The light that the curve maps to `screen`.
double inverseAces(double screen) {
  const double a = c0 - screen * c3, b = c1 - screen * c4, c = -screen * c5;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

} // namespace

double FlipMap::mean() const {
  double sum = 0;
  for (float value : error)
    sum += value;
  return error.empty() ? 0 : sum / double(error.size());
}

FlipMap flip(const runtime::Image &reference, const runtime::Image &test, double pixelsPerDegree) {
  requireComparable(reference, test);
  const auto onScreen = [](float value) { return value > 0 ? std::min(value, 1.0f) : 0.0f; };
  return difference(Seen(opponentPlane(reference, onScreen), pixelsPerDegree),
                    Seen(opponentPlane(test, onScreen), pixelsPerDegree));
}

FlipMap flipHdr(const runtime::Image &reference, const runtime::Image &test,
                const FlipExposures &exposures, double pixelsPerDegree) {
  requireComparable(reference, test);
  FlipMap worst{reference.width, reference.height,
                std::vector<float>(reference.pixels.size() / 3, 0.0f)};
  for (unsigned i = 0; i < exposures.count; ++i) {
    const auto onScreen = [scale = std::exp2(exposures.at(i))](float value) {
      return aces(value * scale);
    };
    const FlipMap map = difference(Seen(opponentPlane(reference, onScreen), pixelsPerDegree),
                                   Seen(opponentPlane(test, onScreen), pixelsPerDegree));
    std::transform(worst.error.begin(), worst.error.end(), map.error.begin(), worst.error.begin(),
                   [](float a, float b) { return std::max(a, b); });
  }
  return worst;
}

FlipExposures exposuresFor(const runtime::Image &reference) {
  requireComparable(reference, reference);
  std::vector<double> luminances;
  luminances.reserve(reference.pixels.size() / 3);
  for (std::size_t i = 0; i + 2 < reference.pixels.size(); i += 3) {
    double luminance = 0;
    for (int channel = 0; channel < 3; ++channel)
      luminance += rgbToXyz[1][channel] * reference.pixels[i + channel];
    luminances.push_back(std::isfinite(luminance) ? std::max(luminance, 0.0) : 0.0);
  }
  const auto middle = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double median = *middle, brightest = *std::max_element(middle, luminances.end());
  constexpr double screen = 0.85, darkest = 1e-6; // the exposure of a black picture is undefined
  const double light = inverseAces(screen);
  FlipExposures exposures;
  exposures.first = std::log2(light / std::max(brightest, darkest));
  exposures.last = std::log2(light / std::max(median, darkest));
  exposures.count = unsigned(std::max(2.0, std::ceil(exposures.last - exposures.first)));
  return exposures;
}

} // namespace rtsl::report
