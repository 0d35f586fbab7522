#include "scenefile/gltf/Material.h"

#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;

namespace {

/// The range of `index` of Principled.
constexpr double lowestIndex = 1.01, highestIndex = 2;

class MaterialReader {
public:
  MaterialReader(const File &file, std::size_t index, VertexColors colors, const Mention &mention,
                 Modules &modules, std::vector<Warning> &warnings)
      : json(file.list("materials")[index]), what(fmt::format("`materials.{}`", index)),
        colors(colors), textures(file, mention, modules, warnings), modules(modules),
        warnings(warnings) {}

  JsonValue read() {
    readBase();
    if (extension(json, "KHR_materials_unlit"))
      return covered(unlit());
    JsonValue material = materialObject(json, "Principled", colors, modules);
    set(material, "baseColor", baseColor);
    setMap(material, "baseColorMap", baseMap, Use::Color);
    set(material, "metallic", metallic());
    set(material, "roughness", roughness());
    const JsonValue *map = metallicRoughness->find("metallicRoughnessTexture");
    setMap(material, "metallicMap", map, Use::Blue);
    setMap(material, "roughnessMap", map, Use::Green);
    readIndex();
    setExtensions(material);
    setEmission(material);
    if (const JsonValue *volume = solidVolume())
      material = withSolid(std::move(material), *volume);
    return covered(withNormals(std::move(material)));
  }

private:
  JsonValue made(const JsonValue &source, const char *name) {
    return libraryObject(source, name, modules);
  }

  std::string of(const char *key) const { return fmt::format("`{}` of {}", key, what); }

  /// A number in [0, most], or its default.
  JsonValue factor(const JsonValue &object, const char *key, double otherwise, double most) const {
    const JsonValue *found = object.find(key);
    if (!found)
      return number(object, otherwise);
    const double value = readNumber(*found, of(key));
    if (value < 0 || value > most)
      throw Error(message::notBetweenZeroAnd(of(key), most, value), found->place());
    return number(*found, value);
  }

  /// Three numbers in [0, 1], or their default.
  std::vector<double> color(const JsonValue &object, const char *key, double otherwise) const {
    const JsonValue *found = object.find(key);
    if (!found)
      return std::vector<double>(3, otherwise);
    std::vector<double> values = readNumbers(*found, 3, of(key));
    refuseOutside(values, key, *found);
    return values;
  }

  void refuseOutside(const std::vector<double> &values, const char *key,
                     const JsonValue &place) const {
    if (std::any_of(values.begin(), values.end(), [](double x) { return x < 0 || x > 1; }))
      throw Error(message::numbersNotUpToOne(of(key)), place.place());
  }

  void setMap(JsonValue &object, const char *member, const JsonValue *info, Use use) {
    if (info)
      set(object, member, pattern(*info, use));
  }
  JsonValue pattern(const JsonValue &info, Use use) {
    return textures.texture(info, fmt::format("a texture of {}", what), use);
  }
  JsonValue product(JsonValue first, JsonValue second) {
    JsonValue both = made(first, "textures.Product");
    set(both, "first", std::move(first));
    set(both, "second", std::move(second));
    return both;
  }

  void readBase() {
    metallicRoughness = json.find("pbrMetallicRoughness");
    if (metallicRoughness)
      expect(*metallicRoughness, Kind::Object, of("pbrMetallicRoughness"));
    else
      metallicRoughness = &nothing;
    nothing = valueAt(json, Kind::Object);
    std::vector<double> values{1, 1, 1, 1};
    const JsonValue *found = metallicRoughness->find("baseColorFactor");
    if (found) {
      values = readNumbers(*found, 4, of("baseColorFactor"));
      refuseOutside(values, "baseColorFactor", *found);
    }
    alpha = values[3];
    values.resize(3);
    baseColor = numbers(found ? *found : json, values);
    baseMap = metallicRoughness->find("baseColorTexture");
  }

  /// The color itself, whatever the light.
  JsonValue unlit() {
    JsonValue material = materialObject(json, "Emitter", colors, modules);
    set(material, "radiance", baseColor);
    setMap(material, "radianceMap", baseMap, Use::Color);
    set(material, "isTwoSided", truth(json, true));
    return material;
  }

  void setExtensions(JsonValue &material) {
    if (index)
      set(material, "index", *index);
    if (const JsonValue *specular = extension(json, "KHR_materials_specular")) {
      set(material, "specular", factor(*specular, "specularFactor", 1, 1));
      setMap(material, "specularMap", specular->find("specularTexture"), Use::Alpha);
      setSpecularColor(material, *specular);
      setMap(material, "specularColorMap", specular->find("specularColorTexture"), Use::Color);
    }
    const JsonValue *glass = extension(json, "KHR_materials_transmission");
    if (glass && !solidVolume()) {
      set(material, "transmission", factor(*glass, "transmissionFactor", 0, 1));
      setMap(material, "transmissionMap", glass->find("transmissionTexture"), Use::Red);
    }
    if (const JsonValue *coat = extension(json, "KHR_materials_clearcoat")) {
      set(material, "clearcoat", factor(*coat, "clearcoatFactor", 0, 1));
      setMap(material, "clearcoatMap", coat->find("clearcoatTexture"), Use::Red);
      set(material, "clearcoatRoughness", factor(*coat, "clearcoatRoughnessFactor", 0, 1));
      setMap(material, "clearcoatRoughnessMap", coat->find("clearcoatRoughnessTexture"),
             Use::Green);
      warnOfMap(*coat, "clearcoatNormalTexture");
    }
    if (const JsonValue *sheen = extension(json, "KHR_materials_sheen")) {
      set(material, "sheenColor", numbers(*sheen, color(*sheen, "sheenColorFactor", 0)));
      set(material, "sheenRoughness", factor(*sheen, "sheenRoughnessFactor", 0, 1));
      warnOfMap(*sheen, "sheenColorTexture");
      warnOfMap(*sheen, "sheenRoughnessTexture");
    }
  }

  void readIndex() {
    const JsonValue *ior = extension(json, "KHR_materials_ior");
    if (!ior)
      return;
    const JsonValue *found = ior->find("ior");
    const double wanted = found ? readNumber(*found, of("ior")) : 1.5;
    const double used = std::clamp(wanted, lowestIndex, highestIndex);
    if (used != wanted)
      warnings.push_back(
          {message::refractiveIndexClamped(of("ior"), wanted, used), found->place()});
    index = number(*ior, used);
  }

  JsonValue metallic() const { return factor(*metallicRoughness, "metallicFactor", 1, 1); }
  JsonValue roughness() const { return factor(*metallicRoughness, "roughnessFactor", 1, 1); }

  /// The volume of an object that light passes through as through solid glass; null: it is opaque,
  /// or a thin pane.
  const JsonValue *solidVolume() const {
    const JsonValue *volume = extension(json, "KHR_materials_volume");
    const JsonValue *glass = extension(json, "KHR_materials_transmission");
    const bool isSolid =
        volume && glass && factor(*glass, "transmissionFactor", 0, 1).number > 0 &&
        factor(*volume, "thicknessFactor", 0, std::numeric_limits<double>::max()).number > 0;
    return isSolid ? volume : nullptr;
  }

  /// White light's share after one unit of length inside.
  JsonValue absorption(const JsonValue &volume) const {
    std::vector<double> left = color(volume, "attenuationColor", 1);
    const JsonValue *found = volume.find("attenuationDistance");
    if (!found)
      return numbers(volume, {1, 1, 1});
    const double distance = readNumber(*found, of("attenuationDistance"));
    if (distance <= 0)
      throw Error(message::notAboveZero("attenuationDistance", what, distance), found->place());
    constexpr double least = 1e-30; // Dielectric's must be above 0
    for (double &one : left)
      one = std::max(std::pow(one, 1 / distance), least);
    return numbers(volume, left);
  }

  /// `surface`, which is not transmissive, as much as light does not pass, and otherwise glass.
  JsonValue withSolid(JsonValue surface, const JsonValue &volume) {
    JsonValue solid = made(volume, "materials.Dielectric");
    if (index)
      set(solid, "index", *index);
    set(solid, "transmission", absorption(volume));
    set(solid, "tint", baseColor);
    setMap(solid, "tintMap", baseMap, Use::Color);
    const JsonValue rough = roughness();
    set(solid, "alpha", number(rough, rough.number * rough.number));
    const JsonValue *map = metallicRoughness->find("metallicRoughnessTexture");
    if (map)
      set(solid, "alphaMap", product(pattern(*map, Use::Green), pattern(*map, Use::Green)));
    const JsonValue &glass = *extension(json, "KHR_materials_transmission");
    const JsonValue passing = factor(glass, "transmissionFactor", 0, 1);
    const JsonValue metal = metallic();
    double share = passing.number;
    std::optional<JsonValue> shareMap;
    if (const JsonValue *ofGlass = glass.find("transmissionTexture"))
      shareMap = pattern(*ofGlass, Use::Red);
    if (map && metal.number > 0) { // the share is that of what is no metal
      JsonValue noMetal = made(*map, "textures.Scaled");
      set(noMetal, "pattern", pattern(*map, Use::Blue));
      set(noMetal, "scale", number(metal, -metal.number));
      set(noMetal, "offset", number(metal, 1));
      shareMap = shareMap ? product(std::move(*shareMap), std::move(noMetal)) : noMetal;
    } else {
      share *= 1 - metal.number;
    }
    if (share == 1 && !shareMap) {
      warnOfMember(surface, "emissive", json, "emissiveFactor");
      warnOfMember(surface, "clearcoat", volume, "KHR_materials_clearcoat");
      return solid;
    }
    JsonValue mix = made(glass, "materials.MixMaterial");
    set(mix, "first", std::move(surface));
    set(mix, "second", std::move(solid));
    set(mix, "amount", number(passing, share));
    if (shareMap)
      set(mix, "amountMap", std::move(*shareMap));
    return mix;
  }

  /// The color may be above 1.
  void setSpecularColor(JsonValue &material, const JsonValue &specular) {
    const JsonValue *found = specular.find("specularColorFactor");
    if (!found)
      return;
    const std::vector<double> values = readNumbers(*found, 3, of("specularColorFactor"));
    for (double value : values)
      if (value < 0)
        throw Error(message::belowZero(of("specularColorFactor"), value), found->place());
    set(material, "specularColor", numbers(*found, values));
  }

  void setEmission(JsonValue &material) {
    std::vector<double> emissive = color(json, "emissiveFactor", 0);
    if (const JsonValue *bright = extension(json, "KHR_materials_emissive_strength"))
      if (const JsonValue *found = bright->find("emissiveStrength")) {
        const double strength = readNumber(*found, of("emissiveStrength"));
        if (strength < 0)
          throw Error(message::belowZero(of("emissiveStrength"), strength), found->place());
        for (double &one : emissive)
          one *= strength;
      }
    if (std::all_of(emissive.begin(), emissive.end(), [](double x) { return x == 0; }))
      return;
    const JsonValue *factor = json.find("emissiveFactor");
    set(material, "emissive", numbers(factor ? *factor : json, emissive));
    setMap(material, "emissiveMap", json.find("emissiveTexture"), Use::Color);
  }

  JsonValue withNormals(JsonValue material) {
    const JsonValue *info = json.find("normalTexture");
    if (!info)
      return material;
    expect(*info, Kind::Object, of("normalTexture"));
    JsonValue wrapper = made(*info, "materials.NormalMap");
    setMap(wrapper, "slopeU", info, Use::SlopeU);
    setMap(wrapper, "slopeV", info, Use::SlopeV);
    if (const JsonValue *scale = info->find("scale"))
      set(wrapper, "strength", number(*scale, readNumber(*scale, of("scale"))));
    set(wrapper, "material", std::move(material));
    return wrapper;
  }

  /// With the holes of alpha.
  JsonValue covered(JsonValue material) {
    const JsonValue *mode = json.find("alphaMode");
    if (!mode)
      return material;
    expect(*mode, Kind::String, of("alphaMode"));
    if (mode->string == "OPAQUE")
      return material;
    if (mode->string != "BLEND" && mode->string != "MASK")
      throw Error(message::badAlphaMode(of("alphaMode"), mode->string), mode->place());
    const bool isMask = mode->string == "MASK";
    const JsonValue *cutoff = isMask ? json.find("alphaCutoff") : nullptr;
    const double edge = cutoff ? readNumber(*cutoff, of("alphaCutoff")) : isMask ? 0.5 : 0;
    const bool haveColorsAlpha = colors == VertexColors::Rgba && (!isMask || edge > 0);
    JsonValue wrapper =
        made(*mode, haveColorsAlpha ? "materials.VertexColorCutout" : "materials.Cutout");
    if (!isMask || haveColorsAlpha) {
      set(wrapper, "opacity", number(baseColor, alpha));
      setMap(wrapper, "opacityMap", baseMap, Use::Alpha);
      if (isMask)
        set(wrapper, "edge", number(*mode, edge));
    } else if (baseMap && alpha > 0) {
      JsonValue threshold = made(*mode, "textures.Threshold");
      set(threshold, "edge", number(*mode, edge / alpha));
      setMap(threshold, "pattern", baseMap, Use::Alpha);
      set(wrapper, "opacityMap", std::move(threshold));
    } else {
      set(wrapper, "opacity", number(*mode, alpha >= edge ? 1 : 0));
    }
    set(wrapper, "material", std::move(material));
    return wrapper;
  }

  /// What a surface has and glass alone has not.
  void warnOfMember(const JsonValue &surface, const char *member, const JsonValue &place,
                    const char *key) {
    if (surface.find(member))
      warnings.push_back({message::modelFeatureIgnored(of(key)), place.place()});
  }

  void warnOfMap(const JsonValue &object, const char *key) {
    if (const JsonValue *map = object.find(key))
      warnings.push_back({message::modelFeatureIgnored(of(key)), map->place()});
  }

  const JsonValue &json;
  const std::string what;
  const VertexColors colors;
  Textures textures;
  Modules &modules;
  std::vector<Warning> &warnings;
  JsonValue nothing; // a `pbrMetallicRoughness` that is left out
  const JsonValue *metallicRoughness = nullptr;
  std::optional<JsonValue> index; // of refraction; empty: the default
  JsonValue baseColor;
  double alpha = 1;
  const JsonValue *baseMap = nullptr;
};

} // namespace

JsonValue materialOf(const File &file, std::size_t index, VertexColors colors,
                     const Mention &mention, Modules &modules, std::vector<Warning> &warnings) {
  if (const Prepared *prepared = file.prepared())
    return prepared->material(index, colors, mention, modules, warnings);
  return MaterialReader(file, index, colors, mention, modules, warnings).read();
}

JsonValue materialObject(const JsonValue &source, const std::string &name, VertexColors colors,
                         Modules &modules) {
  const char *prefix = colors == VertexColors::None ? "" : "VertexColor";
  return libraryObject(source, fmt::format("materials.{}{}", prefix, name), modules);
}

JsonValue defaultMaterial(const JsonValue &source, VertexColors colors, Modules &modules) {
  JsonValue material = materialObject(source, "Principled", colors, modules);
  set(material, "baseColor", numbers(source, {1, 1, 1}));
  set(material, "metallic", number(source, 1));
  set(material, "roughness", number(source, 1));
  return material;
}

} // namespace rtsl::scene::gltf
