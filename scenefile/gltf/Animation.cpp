#include "scenefile/gltf/Animation.h"

#include "scenefile/gltf/Accessor.h"
#include "scenefile/gltf/Mesh.h"
#include "scenefile/gltf/Parts.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;

namespace {

enum class Interpolation { Linear, Step, Cubic };

double dotOf(const std::vector<double> &a, const std::vector<double> &b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += a[i] * b[i];
  return sum;
}

/// The quaternion at a share of the shorter arc between two (Shoemake, "Animating Rotation with
/// Quaternion Curves", SIGGRAPH 1985).
std::vector<double> turned(std::vector<double> from, std::vector<double> to, double share) {
  const auto normalize = [](std::vector<double> &q) {
    const double length = std::sqrt(dotOf(q, q));
    for (double &one : q)
      one /= length;
  };
  normalize(from);
  normalize(to);
  double cosine = dotOf(from, to);
  if (cosine < 0)
    for (double &one : to)
      one = -one;
  cosine = std::min(std::fabs(cosine), 1.0);
  const double angle = std::acos(cosine), sine = std::sin(angle);
  const double a = sine > 1e-9 ? std::sin((1 - share) * angle) / sine : 1 - share,
               b = sine > 1e-9 ? std::sin(share * angle) / sine : share;
  std::vector<double> result(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    result[i] = a * from[i] + b * to[i];
  return result;
}

/// The animation of this name, or the first; nothing if the file has none.
const JsonValue *chosen(const File &file, const Play &play, std::size_t &number) {
  const std::vector<JsonValue> &all = file.list("animations");
  for (number = 0; number < all.size(); ++number) {
    const JsonValue *name = all[number].find("name");
    if (play.animation.empty() ||
        (name && name->kind == Kind::String && name->string == play.animation))
      return &all[number];
  }
  if (play.animation.empty())
    return nullptr;
  throw Error(message::noSuchAnimation(file.path(), play.animation), play.place);
}

/// How many morph targets the mesh of a node has: all of its primitives have as many.
std::size_t targetsOf(const File &file, std::size_t node) {
  const JsonValue *mesh = file.list("nodes")[node].find("mesh");
  if (!mesh)
    return 0;
  const std::size_t index = file.index("meshes", *mesh, fmt::format("`mesh` of `nodes.{}`", node));
  const JsonValue *primitives = file.list("meshes")[index].find("primitives");
  if (!primitives || primitives->kind != Kind::Array || primitives->elements.empty())
    return 0;
  return targetCount(primitives->elements.front(), partOfPrimitive(index, 0));
}

} // namespace

/// The values of one property of a node.
struct Animation::Channel {
  std::vector<float> times;  // in seconds, ascending
  std::vector<float> values; // of each key; of a cubic spline with tangents around it
  std::size_t width = 3;
  bool isRotation = false;
  Interpolation interpolation = Interpolation::Linear;

  std::vector<double> key(std::size_t index, std::size_t part, double factor = 1) const {
    const std::size_t at =
        width * (interpolation == Interpolation::Cubic ? 3 * index + part : index);
    std::vector<double> value(width);
    for (std::size_t i = 0; i < width; ++i)
      value[i] = factor * double(values[at + i]);
    return value;
  }

  std::vector<double> at(double time) const {
    constexpr std::size_t inTangent = 0, point = 1, outTangent = 2;
    const auto next = std::upper_bound(times.begin(), times.end(), time,
                                       [](double t, float one) { return t < double(one); });
    if (next == times.begin())
      return key(0, point);
    const std::size_t before = std::size_t(next - times.begin()) - 1;
    if (next == times.end() || interpolation == Interpolation::Step)
      return key(before, point);
    const double length = double(times[before + 1]) - double(times[before]);
    const double share = (time - double(times[before])) / length;
    const std::vector<double> from = key(before, point), to = key(before + 1, point);
    if (interpolation == Interpolation::Linear && isRotation)
      return turned(from, to, share);
    // Without tangents, the line; with them Hermite's spline (glTF 2.0, appendix C).
    std::vector<double> result(width);
    const double s = share, s2 = s * s, s3 = s2 * s;
    for (std::size_t i = 0; i < width; ++i)
      result[i] = from[i] + share * (to[i] - from[i]);
    if (interpolation == Interpolation::Cubic) {
      const std::vector<double> out = key(before, outTangent, length),
                                in = key(before + 1, inTangent, length);
      for (std::size_t i = 0; i < width; ++i)
        result[i] = (2 * s3 - 3 * s2 + 1) * from[i] + (s3 - 2 * s2 + s) * out[i] +
                    (3 * s2 - 2 * s3) * to[i] + (s3 - s2) * in[i];
    }
    return result;
  }
};

struct Animation::NodeChannels {
  std::optional<Channel> translation, rotation, scale, weights;

  /// The channels of the node's transform.
  std::vector<const Channel *> ofMotion() const {
    std::vector<const Channel *> channels;
    for (const std::optional<Channel> *one : {&translation, &rotation, &scale})
      if (*one)
        channels.push_back(&**one);
    return channels;
  }
};

Animation::Animation(const File &file, const Play &play, std::vector<Warning> &warnings)
    : file(file), play(play) {
  std::size_t number = 0;
  const JsonValue *animation = chosen(file, play, number);
  if (!animation)
    return;
  const std::string what = fmt::format("`animations.{}`", number);
  const JsonValue &samplers =
      expect(require(*animation, "samplers", what), Kind::Array, "`samplers` of " + what);
  const JsonValue &channels =
      expect(require(*animation, "channels", what), Kind::Array, "`channels` of " + what);
  for (std::size_t i = 0; i < channels.elements.size(); ++i)
    addChannel(channels.elements[i], samplers,
               fmt::format("`animations.{}.channels.{}`", number, i), warnings);
  const std::vector<JsonValue> &all = file.list("animations");
  for (std::size_t other = 0; play.animation.empty() && other < all.size(); ++other)
    if (other != number)
      warnings.push_back({message::animationNotShown(other), all[other].place()});
}

Animation::~Animation() = default;

void Animation::addChannel(const JsonValue &channel, const JsonValue &samplers,
                           const std::string &what, std::vector<Warning> &warnings) {
  expect(channel, Kind::Object, what);
  const JsonValue &target =
      expect(require(channel, "target", what), Kind::Object, "`target` of " + what);
  const JsonValue *node = target.find("node");
  if (!node)
    return; // of an extension
  const std::size_t index = file.index("nodes", *node, "`node` of " + what);
  const JsonValue &path = expect(require(target, "path", what), Kind::String, "`path` of " + what);
  const bool isRotation = path.string == "rotation";
  const std::size_t targets = path.string == "weights" ? targetsOf(file, index) : 0;
  if (targets == 0 && !isRotation && path.string != "translation" && path.string != "scale") {
    warnings.push_back({message::channelIgnored(what, path.string), path.place()});
    return;
  }
  if (targets == 0 && file.list("nodes")[index].find("matrix")) {
    warnings.push_back({message::channelOfMatrixIgnored(what, index), path.place()});
    return;
  }
  const JsonValue &number = require(channel, "sampler", what);
  const double wanted = readNumber(number, "`sampler` of " + what);
  if (!(wanted >= 0 && wanted < double(samplers.elements.size())) || wanted != std::floor(wanted))
    throw Error(message::noSuchSampler(what, wanted, samplers.elements.size()), number.place());
  const JsonValue &sampler =
      expect(samplers.elements[std::size_t(wanted)], Kind::Object, "a sampler of " + what);

  Channel made;
  if (const JsonValue *kind = sampler.find("interpolation")) {
    expect(*kind, Kind::String, "`interpolation` of " + what);
    if (kind->string == "STEP")
      made.interpolation = Interpolation::Step;
    else if (kind->string == "CUBICSPLINE")
      made.interpolation = Interpolation::Cubic;
    else if (kind->string != "LINEAR")
      throw Error(message::badKeyFrameInterpolation(what, kind->string), kind->place());
  }
  const Accessor input(file, require(sampler, "input", what), "`input` of " + what);
  input.require("SCALAR");
  const Accessor output(file, require(sampler, "output", what), "`output` of " + what);
  output.require(targets != 0 ? "SCALAR" : isRotation ? "VEC4" : "VEC3");
  made.width = targets != 0 ? targets : isRotation ? 4 : 3;
  made.isRotation = isRotation;
  made.times = input.floats();
  made.values = output.floats();
  const std::size_t parts =
      (made.interpolation == Interpolation::Cubic ? 3 : 1) * std::max<std::size_t>(targets, 1);
  if (made.times.empty() || output.count() != parts * made.times.size())
    throw Error(message::badKeyFrameCount(what, output.count(), made.times.size(),
                                          parts * made.times.size()),
                output.json().place());
  for (std::size_t i = 1; i < made.times.size(); ++i)
    if (!(made.times[i - 1] < made.times[i]))
      throw Error(message::keyFramesNotAscending(what), input.json().place());

  std::unique_ptr<NodeChannels> &channels = nodes[index];
  if (!channels)
    channels = std::make_unique<NodeChannels>();
  (isRotation                     ? channels->rotation
   : path.string == "translation" ? channels->translation
   : path.string == "scale"       ? channels->scale
                                  : channels->weights) = std::move(made);
}

Motion Animation::at(std::size_t node, const Motion &rest) const {
  return at(node, rest, play.frame);
}

Motion Animation::at(std::size_t node, const Motion &rest, double frames) const {
  const auto found = nodes.find(node);
  if (found == nodes.end())
    return rest;
  const double time = frames / play.framesPerSecond;
  Motion motion = rest;
  if (const auto &channel = found->second->translation)
    motion.translation = channel->at(time);
  if (const auto &channel = found->second->rotation)
    motion.rotation = channel->at(time);
  if (const auto &channel = found->second->scale)
    motion.scale = channel->at(time);
  if (!(dotOf(motion.rotation, motion.rotation) >= 1e-100)) // between 0 and others, too
    throw Error(message::noRotation(node, frames), file.list("nodes")[node].place());
  return motion;
}

/// Times of the frame between which numbers are nearly linear, and rotations steady.
std::vector<float> Animation::timesOf(const std::vector<const Channel *> &channels) const {
  constexpr int piecesOfSpline = 8;
  std::set<float> times{0, 1};
  const auto add = [&](float time) {
    if (time > 0 && time < 1)
      times.insert(time);
  };
  for (const Channel *channel : channels) {
    for (const float seconds : channel->times) {
      const double exact = double(seconds) * play.framesPerSecond - play.frame;
      if (!(exact > 0 && exact < 1))
        continue;
      const float time = std::nextafter(float(exact), 2.0f); // not before
      add(time);
      if (channel->interpolation == Interpolation::Step)
        add(std::nextafter(float(exact), -1.0f));
    }
    for (int i = 1; channel->interpolation == Interpolation::Cubic && i < piecesOfSpline; ++i)
      add(float(i) / piecesOfSpline);
  }
  return {times.begin(), times.end()};
}

std::optional<JsonValue> Animation::transformOf(const JsonValue &node, std::size_t index,
                                                const Motion &rest) const {
  const auto found = nodes.find(index);
  if (!play.isDuringFrame || found == nodes.end())
    return std::nullopt;
  const std::vector<float> times = timesOf(found->second->ofMotion());
  JsonValue keys = valueAt(node, Kind::Array), timesOfKeys = valueAt(node, Kind::Array);
  const auto columns = at(index, rest).transform().columns;
  bool moves = false;
  for (const float time : times) {
    const Motion motion = at(index, rest, play.frame + double(time));
    moves |= motion.transform().columns != columns;
    timesOfKeys.elements.push_back(number(node, time));
    keys.elements.push_back(
        object(node, {{"scale", numbers(node, motion.scale)},
                      {"rotate", object(node, {{"quaternion", numbers(node, motion.rotation)}})},
                      {"translate", numbers(node, motion.translation)}}));
  }
  if (!moves)
    return std::nullopt;
  return object(node, {{"keys", std::move(keys)}, {"times", std::move(timesOfKeys)}});
}

std::vector<double> Animation::weightsAt(std::size_t node, const std::vector<double> &rest) const {
  const auto found = nodes.find(node);
  return found == nodes.end() || !found->second->weights
             ? rest
             : found->second->weights->at(play.frame / play.framesPerSecond);
}

std::optional<JsonValue> Animation::weightsOf(const JsonValue &node, std::size_t index) const {
  const auto found = nodes.find(index);
  if (!play.isDuringFrame || found == nodes.end() || !found->second->weights)
    return std::nullopt;
  const Channel &channel = *found->second->weights;
  JsonValue keys = valueAt(node, Kind::Array), times = valueAt(node, Kind::Array);
  const std::vector<double> first = weightsAt(index, {});
  bool changes = false;
  for (const float time : timesOf({&channel})) {
    const std::vector<double> weights =
        channel.at((play.frame + double(time)) / play.framesPerSecond);
    changes |= weights != first;
    times.elements.push_back(number(node, time));
    keys.elements.push_back(numbers(node, weights));
  }
  if (!changes)
    return std::nullopt;
  return object(node, {{"keys", std::move(keys)}, {"times", std::move(times)}});
}

} // namespace rtsl::scene::gltf
