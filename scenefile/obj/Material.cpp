#include "scenefile/obj/Material.h"

#include "scenefile/gltf/Material.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

namespace rtsl::scene::obj {

using namespace gltf;
using Kind = JsonValue::Kind;

namespace {

/// Heights of bump maps and the steps of their slopes, as parts of the model's size.
constexpr double bumpHeight = 0.01, bumpStep = 0.001;

/// An image of a statement, and what its options say.
struct Map {
  std::string path;
  std::array<double, 2> scale{1, 1}, offset{0, 0};
  bool isClamped = false;
  double bump = 1;
  int channel = 0;              // red, green, blue, alpha
  std::optional<bool> isLinear; // unless the use decides
};

class MaterialMaker {
public:
  MaterialMaker(const Material &material, double size, VertexColors colors, const Mention &mention,
                Modules &modules, std::vector<Warning> &warnings)
      : material(material), size(size), colors(colors), mention(mention), modules(modules),
        warnings(warnings) {}

  JsonValue make() {
    illumination = int(number("illum", 0, 10).value_or(2));
    metallic = number("Pm", 0, 1);
    for (const Statement &statement : material.statements)
      if (!isKnown(statement.keyword) && !isOfHighlights(statement.keyword))
        warn(statement, nameOf(statement));
    JsonValue made = isRefracting() ? dielectric() : isThinGlass() ? pane() : surface();
    return covered(withRelief(std::move(made)));
  }

private:
  static bool isKnown(const std::string &keyword) {
    static constexpr std::array known = {
        "Ka",   "Kd",    "Ks",     "Ke",     "Tf",    "Ns",       "Ni",       "d",
        "Tr",   "illum", "map_Kd", "map_Ke", "map_d", "map_Bump", "map_bump", "bump",
        "norm", "Pr",    "Pm",     "Pc",     "Pcr",   "Ps",       "map_Pr",   "map_Pm"};
    return std::find(known.begin(), known.end(), keyword) != known.end();
  }

  /// Is it a map of the strength or of the size of highlights, which this material has?
  bool isOfHighlights(const std::string &keyword) const {
    if (isRefracting() || isThinGlass())
      return false;
    return keyword == "map_Ks" || (keyword == "map_Ns" && hasExponent());
  }

  //===--------------------------------------------------------------------===//
  // Statements
  //===--------------------------------------------------------------------===//

  std::string nameOf(const Statement &statement) const {
    return fmt::format("`{}` of the material `{}`", statement.keyword, material.name);
  }

  double numberIn(const Statement &statement, const std::string &word) const {
    double value = 0;
    const char *end = word.data() + word.size();
    const auto [after, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || after != end || !std::isfinite(value))
      throw Error(message::notNumberInMaterial(word, nameOf(statement)), statement.source.place());
    return value;
  }

  std::optional<double> number(const char *keyword, double least, double most) const {
    const Statement *statement = material.find(keyword);
    if (!statement)
      return std::nullopt;
    // `d -halo 0.5` depends on the angle of sight, which no material here does.
    std::size_t at = 0;
    if (!statement->arguments.empty() && statement->arguments[0] == "-halo")
      at = 1;
    if (statement->arguments.size() <= at)
      throw Error(message::numberMissingInMaterial(nameOf(*statement)), statement->source.place());
    return std::clamp(numberIn(*statement, statement->arguments[at]), least, most);
  }

  /// Three numbers, or one for all of them; at least 0.
  std::optional<std::vector<double>> color(const char *keyword, double most = 1) const {
    const Statement *statement = material.find(keyword);
    if (!statement)
      return std::nullopt;
    const std::vector<std::string> &words = statement->arguments;
    if (!words.empty() && (words[0] == "spectral" || words[0] == "xyz")) {
      warn(*statement, fmt::format("`{}` in {}", words[0], nameOf(*statement)));
      return std::nullopt;
    }
    if (words.size() != 1 && words.size() != 3)
      throw Error(message::colorInMaterial(nameOf(*statement), words.size()),
                  statement->source.place());
    std::vector<double> values;
    for (std::size_t i = 0; i < 3; ++i)
      values.push_back(
          std::clamp(numberIn(*statement, words[words.size() == 1 ? 0 : i]), 0.0, most));
    return values;
  }

  static double mean(const std::vector<double> &color) {
    return (color[0] + color[1] + color[2]) / 3;
  }

  std::optional<Map> map(const char *keyword) const {
    const Statement *statement = material.find(keyword);
    if (!statement)
      return std::nullopt;
    Map map;
    const std::vector<std::string> &words = statement->arguments;
    std::size_t at = 0;
    const auto isNumber = [&](std::size_t i) {
      double ignored;
      const std::string &word = words[i];
      const char *end = word.data() + word.size();
      const auto [after, error] = std::from_chars(word.data(), end, ignored);
      return error == std::errc() && after == end;
    };
    /// The numbers that follow an option, at most three; the last word is the file.
    const auto numbers = [&](std::array<double, 2> &to) {
      for (std::size_t i = 0; i < 3 && at + 1 < words.size() && isNumber(at); ++i, ++at)
        if (i < 2)
          to[i] = numberIn(*statement, words[at]);
    };
    std::string unknown;
    while (at + 1 < words.size() && words[at].size() > 1 && words[at][0] == '-') {
      const std::string &option = words[at++];
      if (option == "-s") {
        numbers(map.scale);
      } else if (option == "-o") {
        numbers(map.offset);
      } else if (option == "-clamp") {
        map.isClamped = words[at++] == "on";
      } else if (option == "-bm") {
        map.bump = numberIn(*statement, words[at++]);
      } else if (option == "-imfchan") {
        const std::string channels = "rgbm"; // m: the matte channel, alpha
        const std::size_t found = channels.find(words[at++]);
        map.channel = found == std::string::npos ? 0 : int(found);
      } else if (option == "-colorspace") { // not in the format's description, but in use
        map.isLinear = words[at++] == "linear";
      } else {
        unknown += fmt::format("{}`{}`", unknown.empty() ? "" : ", ", option);
        std::array<double, 2> ignored;
        if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-type")
          ++at;
        else
          numbers(ignored);
      }
    }
    if (!unknown.empty())
      warn(*statement, fmt::format("{} in {}", unknown, nameOf(*statement)));
    for (std::size_t i = at; i < words.size(); ++i) // the path may contain blanks
      map.path += (i == at ? "" : " ") + words[i];
    std::replace(map.path.begin(), map.path.end(), '\\', '/');
    if (map.path.empty())
      throw Error(message::imageMissingInMaterial(nameOf(*statement)), statement->source.place());
    return map;
  }

  //===--------------------------------------------------------------------===//
  // Objects of the library
  //===--------------------------------------------------------------------===//

  JsonValue at(const char *keyword) const {
    const Statement *statement = material.find(keyword);
    return statement ? statement->source : material.source;
  }

  void setNumber(JsonValue &object, const char *member, const char *keyword, double value) const {
    gltf::set(object, member, gltf::number(at(keyword), value));
  }
  void setColor(JsonValue &object, const char *member, const char *keyword,
                const std::vector<double> &value) const {
    gltf::set(object, member, gltf::numbers(at(keyword), value));
  }

  JsonValue image(const JsonValue &source, const Map &map, bool isColor) const {
    const std::string beside = (std::filesystem::path(material.folder) / map.path).string();
    JsonValue path = text(source, mention.beside(beside));
    path.fromOverride = mention.isFromOverride;
    JsonValue made = gltf::object(source, {{"file", std::move(path)}});
    set(made, "colorSpace", text(source, map.isLinear.value_or(!isColor) ? "linear" : "srgb"));
    if (map.isClamped)
      set(made, "wrap", list(source, {text(source, "clamp"), text(source, "clamp")}));
    return made;
  }

  JsonValue placed(JsonValue pattern, const JsonValue &source, const Map &map) const {
    if (map.scale == std::array<double, 2>{1, 1} && map.offset == std::array<double, 2>{0, 0})
      return pattern;
    JsonValue turned = libraryObject(source, "textures.TransformedPattern", modules);
    set(turned, "scale", numbers(source, {map.scale[0], map.scale[1]}));
    set(turned, "offset", numbers(source, {map.offset[0], map.offset[1]}));
    set(turned, "pattern", std::move(pattern));
    return turned;
  }

  /// Sets a member to the colors of an image.
  void setColors(JsonValue &object, const char *member, const char *keyword,
                 const std::vector<double> *tint = nullptr) const {
    const std::optional<Map> found = map(keyword);
    if (!found)
      return;
    const JsonValue source = at(keyword);
    JsonValue pattern = libraryObject(source, "textures.ImageTexture", modules);
    set(pattern, "image", image(source, *found, true));
    if (tint)
      set(pattern, "tint", numbers(source, *tint));
    set(object, member, placed(std::move(pattern), source, *found));
  }

  JsonValue channel(const char *keyword, const Map &map, int number, bool isOfColor) const {
    const JsonValue source = at(keyword);
    JsonValue pattern = libraryObject(source, "textures.ImageChannel", modules);
    set(pattern, "channel", gltf::number(source, number));
    set(pattern, "image", image(source, map, isOfColor));
    return placed(std::move(pattern), source, map);
  }

  void setChannel(JsonValue &object, const char *member, const char *keyword) const {
    if (const std::optional<Map> found = map(keyword))
      set(object, member, channel(keyword, *found, found->channel, false));
  }

  //===--------------------------------------------------------------------===//
  // Materials
  //===--------------------------------------------------------------------===//

  bool isRefracting() const {
    return (illumination == 6 || illumination == 7) && metallic.value_or(0) == 0;
  }
  bool isThinGlass() const {
    return (illumination == 4 || illumination == 9) && opacity() == 1 && !material.find("map_d");
  }
  bool isMirror() const {
    return !metallic && (illumination == 3 || illumination == 5 || illumination == 8);
  }

  double opacity() const {
    if (const auto dissolve = number("d", 0, 1))
      return *dissolve;
    return 1 - number("Tr", 0, 1).value_or(0);
  }

  /// The alpha of Blinn's exponent (Walter et al., "Microfacet Models for Refraction", 2007).
  std::optional<double> alpha() const {
    if (const auto roughness = number("Pr", 0, 1))
      return *roughness * *roughness;
    if (const auto exponent = number("Ns", 0, 1e9))
      return std::sqrt(2 / (*exponent + 2));
    return std::nullopt;
  }

  /// Is the roughness that of an exponent?
  bool hasExponent() const { return !material.find("Pr") && !material.find("map_Pr"); }

  /// Those of an image of exponents.
  JsonValue roughnessOf(const Map &map) const {
    const JsonValue source = at("map_Ns");
    JsonValue pattern = libraryObject(source, "textures.ExponentRoughness", modules);
    set(pattern, "pattern", channel("map_Ns", map, map.channel, false));
    if (const auto exponent = number("Ns", 0, 1e9))
      setNumber(pattern, "exponent", "Ns", *exponent);
    return pattern;
  }

  /// What is left of white light, above 0.
  std::vector<double> filter() const {
    std::vector<double> values = color("Tf").value_or(std::vector<double>(3, 1));
    for (double &one : values)
      one = std::max(one, 1e-6);
    return values;
  }

  JsonValue dielectric() {
    JsonValue made = libraryObject(at("illum"), "materials.Dielectric", modules);
    setNumber(made, "index", "Ni", number("Ni", 1.01, 4).value_or(1.5));
    if (material.find("Tf"))
      setColor(made, "transmission", "Tf", filter());
    if (const double rough = alpha().value_or(0); rough >= 0.05) // what an exponent of 800 has
      setNumber(made, "alpha", "Ns", rough);
    return made;
  }

  JsonValue pane() {
    JsonValue made = libraryObject(at("illum"), "materials.ThinGlass", modules);
    setNumber(made, "index", "Ni", number("Ni", 1, 4).value_or(1.5));
    if (material.find("Tf"))
      setColor(made, "transmission", "Tf", filter());
    return made;
  }

  std::vector<double> emission() const {
    return color("Ke", 1e30).value_or(std::vector<double>(3, 0));
  }

  bool isDiffuse() const {
    for (const char *keyword : {"Pr", "Pm", "Pc", "Ps", "map_Pr", "map_Pm", "map_Ke"})
      if (material.find(keyword))
        return false;
    return !isMirror() && mean(emission()) == 0 && mean(specular()) == 0;
  }

  std::vector<double> specular() const {
    return color("Ks").value_or(std::vector<double>(3, material.find("map_Ks") ? 1 : 0));
  }

  std::vector<double> diffuse() const {
    const bool hasColors = material.find("map_Kd") || colors != VertexColors::None;
    return color("Kd").value_or(std::vector<double>(3, hasColors ? 1 : 0.8));
  }

  JsonValue surface() {
    if (isDiffuse()) {
      JsonValue made = materialObject(at("Kd"), "Lambert", colors, modules);
      const std::vector<double> tint = diffuse();
      if (material.find("map_Kd"))
        setColors(made, "albedo", "map_Kd", &tint);
      else
        setColor(made, "reflectance", "Kd", tint);
      return made;
    }
    JsonValue made = materialObject(material.source, "Principled",
                                    isMirror() ? VertexColors::None : colors, modules);
    if (isMirror()) {
      setColor(made, "baseColor", "Ks", color("Ks").value_or(std::vector<double>(3, 1)));
      setColors(made, "baseColorMap", "map_Ks");
    } else {
      setColor(made, "baseColor", "Kd", diffuse());
      setColors(made, "baseColorMap", "map_Kd");
      setColors(made, "specularMap", "map_Ks");
    }
    setNumber(made, "metallic", "Pm", isMirror() ? 1 : metallic.value_or(0));
    if (const std::optional<Map> exponents = hasExponent() ? map("map_Ns") : std::nullopt) {
      setNumber(made, "roughness", "map_Ns", 1);
      set(made, "roughnessMap", roughnessOf(*exponents));
    } else {
      setNumber(made, "roughness", material.find("Pr") ? "Pr" : "Ns",
                std::sqrt(alpha().value_or(isMirror() ? 0 : 1)));
      setChannel(made, "roughnessMap", "map_Pr");
    }
    setNumber(made, "index", "Ni", index());
    setChannel(made, "metallicMap", "map_Pm");
    if (const auto coat = number("Pc", 0, 1)) {
      setNumber(made, "clearcoat", "Pc", *coat);
      setNumber(made, "clearcoatRoughness", "Pcr", number("Pcr", 0, 1).value_or(0.03));
    }
    if (const auto sheen = number("Ps", 0, 1))
      setColor(made, "sheenColor", "Ps", std::vector<double>(3, *sheen));
    if (mean(emission()) > 0) {
      setColor(made, "emissive", "Ke", emission());
      setColors(made, "emissiveMap", "map_Ke");
    }
    return made;
  }

  /// `Ni`; or such that the reflectance at normal incidence is 0.08 Ks, which is 0.04 for the usual
  /// 0.5.
  double index() const {
    if (const auto found = number("Ni", 0, 2); found && *found > 1)
      return std::max(*found, 1.01);
    const bool isGiven = !isMirror() && (material.find("Ks") || material.find("map_Ks"));
    const double root = std::sqrt(0.08 * (isGiven ? mean(specular()) : 0.5));
    return std::max((1 + root) / (1 - root), 1.01);
  }

  JsonValue withRelief(JsonValue made) {
    if (const std::optional<Map> found = map("norm")) {
      const JsonValue source = at("norm");
      JsonValue wrapper = libraryObject(source, "materials.NormalMap", modules);
      for (int axis = 0; axis < 2; ++axis) {
        JsonValue slope = libraryObject(source, "textures.ImageSlope", modules);
        set(slope, "axis", gltf::number(source, axis));
        set(slope, "image", image(source, *found, false));
        set(wrapper, axis == 0 ? "slopeU" : "slopeV", placed(std::move(slope), source, *found));
      }
      set(wrapper, "material", std::move(made));
      return wrapper;
    }
    for (const char *keyword : {"map_Bump", "map_bump", "bump"})
      if (const std::optional<Map> found = map(keyword)) {
        const JsonValue source = at(keyword);
        JsonValue wrapper = libraryObject(source, "materials.BumpMap", modules);
        set(wrapper, "height", channel(keyword, *found, found->channel, false));
        set(wrapper, "scale", gltf::number(source, found->bump * bumpHeight * size));
        set(wrapper, "step", gltf::number(source, bumpStep * size));
        set(wrapper, "material", std::move(made));
        return wrapper;
      }
    return made;
  }

  /// With the holes of `d` and `map_d`.
  JsonValue covered(JsonValue made) {
    const std::optional<Map> holes = map("map_d");
    if (isRefracting() || (opacity() == 1 && !holes))
      return made;
    const char *keyword = material.find("d") ? "d" : "Tr";
    JsonValue wrapper = libraryObject(at(keyword), "materials.Cutout", modules);
    setNumber(wrapper, "opacity", keyword, opacity());
    if (holes) {
      const std::optional<Map> colors = map("map_Kd");
      const bool isAlpha = colors && colors->path == holes->path; // alpha of the image of colors
      set(wrapper, "opacityMap", channel("map_d", *holes, isAlpha ? 3 : holes->channel, isAlpha));
    }
    set(wrapper, "material", std::move(made));
    return wrapper;
  }

  void warn(const Statement &statement, const std::string &what) const {
    warnings.push_back({message::modelFeatureIgnored(what), statement.source.place()});
  }

  const Material &material;
  const double size;
  const VertexColors colors;
  const Mention &mention;
  Modules &modules;
  std::vector<Warning> &warnings;
  int illumination = 2;
  std::optional<double> metallic;
};

} // namespace

JsonValue materialOf(const Material &material, double size, VertexColors colors,
                     const Mention &mention, Modules &modules, std::vector<Warning> &warnings) {
  return MaterialMaker(material, size, colors, mention, modules, warnings).make();
}

JsonValue defaultMaterial(const JsonValue &source, VertexColors colors, Modules &modules) {
  JsonValue made = materialObject(source, "Lambert", colors, modules);
  if (colors != VertexColors::None)
    set(made, "reflectance", numbers(source, {1, 1, 1}));
  return made;
}

} // namespace rtsl::scene::obj
