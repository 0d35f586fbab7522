"""Programs and scenes of any size, each large in one direction alone."""

import json
from pathlib import Path

EXAMPLE = Path(__file__).resolve().parent.parent.parent / "examples" / "glass"


def scene(folder, imports=(), **parts):
    """A small scene with the example's camera, to which `parts` add or replace. The path of its
    file."""
    document = {
        "rtsl": 1,
        "import": [
            str(EXAMPLE / f"{name}.rtsl")
            for name in ("PinholeCamera", "Sphere", "Lambert", "Solid", "BallLight")
        ]
        + [str(path) for path in imports],
        "camera": {
            "class": "PinholeCamera",
            "constructor": {
                "eye": [0, 2, 8],
                "up": [0, 1, 0],
                "gaze": [0, -0.2, -1],
                "uv0": [-1.6, -0.9],
                "uv1": [1.6, 0.9],
                "d": 2.7,
            },
        },
        "textures": {"white": {"class": "Solid", "value": [0.8, 0.8, 0.8]}},
        "materials": {"plain": {"class": "Lambert", "albedo": "white"}},
        "objects": [ball(0, "plain")],
        "lights": [{"class": "BallLight", "position": [4, 6, 4], "intensity": [30, 30, 30]}],
        "ambient": [0.1, 0.1, 0.1],
        "background": [0.2, 0.3, 0.4],
        "render": {"engine": "classic", "size": [16, 9], "spp": 1, "depth": 3, "seed": 1},
    }
    document.update(parts)
    path = folder / "scene.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    return path


def ball(number, material):
    return {
        "primitive": {
            "class": "Sphere",
            "center": [number % 32 * 0.1, number // 32 % 32 * 0.1, -(number // 1024) * 0.1],
            "radius": 0.05,
        },
        "material": material,
    }


def write(folder, name, text):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def material(folder, body, before="", members=""):
    """A material `Large` in a file of its own, and a scene in which an object has it."""
    text = f"{before}class Large : rt_Material {{\n{members}  void shade() {{\n{body}  }}\n}};\n"
    path = write(folder, "Large.rtsl", text)
    return path, scene(
        folder, [path], materials={"large": {"class": "Large"}}, objects=[ball(0, "large")]
    )


def classes(folder, n):
    """Classes of materials, each with an object."""
    text = "".join(
        f"class M{i} : rt_Material {{\n"
        f"  public color tint = color({0.2 + i % 7 * 0.1:.1f});\n"
        f"  public float gloss = {i % 11 + 1}.0;\n"
        f"  void shade() {{\n"
        f"    vec3 n = normalize(rt_ShadingNormal);\n"
        f"    float c = abs(dot(n, normalize(rt_RayDirection)));\n"
        f"    rt_SampleColor = tint * pow(c, gloss) + ambient() * {i % 5}.25;\n"
        f"    if (c > 0.{i % 8 + 1})\n"
        f"      rt_SampleColor += 0.5 * trace(rt_HitPoint, reflect(rt_RayDirection, n));\n"
        f"  }}\n}};\n"
        for i in range(n)
    )
    path = write(folder, "Many.rtsl", text)
    return path, scene(
        folder,
        [path],
        materials={f"m{i}": {"class": f"M{i}"} for i in range(n)},
        objects=[ball(i, f"m{i}") for i in range(n)],
    )


def traces(folder, n):
    """Traces, each in an `if`."""
    body = (
        "    vec3 d = rt_RayDirection;\n    float w = 1.0;\n    color sum = color(0.0);\n"
        + "".join(
            f"    if (d.x * {i + 1}.5 > w) {{\n      sum += w * trace(rt_HitPoint, d);\n"
            "      w *= 0.75;\n"
            f"      d = normalize(d + vec3(0.1, {i}.0, 0.2));\n    }}\n"
            for i in range(n)
        )
    )
    return material(folder, body + "    rt_SampleColor = sum;\n")


def cases(folder, n):
    """A switch with so many cases."""
    body = "    float x = 0.0;\n    switch (int(rt_HitPoint.x * 100.0)) {\n" + "".join(
        f"    case {i}:\n      x = rt_HitPoint.y * {i}.5;\n      break;\n" for i in range(n)
    )
    return material(folder, body + "    }\n    rt_SampleColor = color(x);\n")


def chain(folder, n):
    """Functions of which each calls the one before."""
    before = "float f0(float x) { return x * 0.5; }\n" + "".join(
        f"float f{i}(float x) {{ return f{i - 1}(x * {1 + i % 3}.25) + 0.{i % 9 + 1}; }}\n"
        for i in range(1, n)
    )
    return material(folder, f"    rt_SampleColor = color(f{n - 1}(rt_HitPoint.x));\n", before)


def statements(folder, n):
    """Statements in a row."""
    body = "    float a = rt_HitPoint.x;\n    vec3 v = rt_HitPoint;\n" + "".join(
        f"    v = v * {i % 9 + 1}.25 + vec3(a, {i}.0, v.x);\n"
        if i % 2
        else f"    a = a * {i % 7 + 1}.5 + v.y;\n"
        for i in range(n)
    )
    return material(folder, body + "    rt_SampleColor = color(a) + color(v.x);\n")


def branches(folder, n):
    """`if` and `else`, one after the other."""
    body = "    float a = rt_HitPoint.x;\n    float b = rt_HitPoint.y;\n" + "".join(
        f"    if (a > {i}.0)\n      b = b * 0.5 + a;\n    else\n      a = a + {i}.5 * b;\n"
        for i in range(n)
    )
    return material(folder, body + "    rt_SampleColor = color(a + b);\n")


def loops(folder, n):
    """Loops, one after the other."""
    body = "    float a = rt_HitPoint.x;\n" + "".join(
        f"    for (int i = 0; i < int(a) + {k}; ++i)\n      a = a * 0.5 + float(i);\n"
        for k in range(n)
    )
    return material(folder, body + "    rt_SampleColor = color(a);\n")


def nesting(folder, n):
    """`if` in `if`."""
    body = "    float a = rt_HitPoint.x;\n" + "".join(
        f"    if (a > {i}.0) {{ a = a * 0.5;\n" for i in range(n)
    )
    return material(folder, body + "    " + "}" * n + "\n    rt_SampleColor = color(a);\n")


def overloads(folder, n):
    """Functions of one name, each for a struct of its own."""
    before = "".join(
        f"struct S{i} {{ float x; }};\nfloat pick(S{i} s) {{ return s.x * {i}.5; }}\n"
        for i in range(n)
    )
    body = "    float a = 0.0;\n" + "".join(
        f"    S{i} s{i} = S{i}(rt_HitPoint.x);\n    a += pick(s{i});\n" for i in range(n)
    )
    return material(folder, body + "    rt_SampleColor = color(a);\n", before)


def array(folder, n):
    """A constant array."""
    numbers = ", ".join(f"{i % 97}.25" for i in range(n))
    before = f"const float table[{n}] = float[{n}]({numbers});\n"
    return material(
        folder, f"    rt_SampleColor = color(table[int(rt_HitPoint.x * 9.0) % {n}]);\n", before
    )


def members(folder, n):
    """Members of one class."""
    declared = "".join(f"  public float m{i} = {i}.5;\n" for i in range(n))
    body = "    float a = 0.0;\n" + "".join(f"    a += m{i} * rt_HitPoint.x;\n" for i in range(n))
    return material(folder, body + "    rt_SampleColor = color(a);\n", "", declared)


def imports(folder, n):
    """Imported files."""
    for i in range(n):
        write(folder, f"F{i}.rtsl", f"float g{i}(float x) {{ return x * {i}.5; }}\n")
    before = "".join(f'import "F{i}.rtsl";\n' for i in range(n))
    body = "    float a = rt_HitPoint.x;\n" + "".join(f"    a += g{i}(a);\n" for i in range(n))
    return material(folder, body + "    rt_SampleColor = color(a);\n", before)


def textures(folder, n):
    """Classes of textures, behind one reference."""
    text = "".join(
        f"class T{i} : rt_Texture {{\n  public float scale = {i + 1}.0;\n"
        f"  void lookup() {{ rt_TextureColor = color(fract(rt_TextureUV.x * scale + {i}.25)); }}\n"
        f"}};\n"
        for i in range(n)
    )
    path = write(folder, "Textures.rtsl", text)
    return path, scene(
        folder,
        [path],
        textures={f"t{i}": {"class": f"T{i}"} for i in range(n)},
        materials={f"m{i}": {"class": "Lambert", "albedo": f"t{i}"} for i in range(n)},
        objects=[ball(i, f"m{i}") for i in range(n)],
    )


def lights(folder, n):
    """Classes of lights."""
    text = "".join(
        f"class L{i} : rt_Light {{\n  public vec3 place = vec3({i % 10}.0, 4.0, 2.0);\n"
        f"  void illumination() {{\n    vec3 path = place - rt_HitPoint;\n"
        "    rt_LightDistance = length(path);\n"
        f"    rt_LightDirection = path / rt_LightDistance;\n    rt_LightColor = color({i % 7}.5) / "
        "dot(path, path);\n"
        f"  }}\n}};\n"
        for i in range(n)
    )
    path = write(folder, "Lights.rtsl", text)
    return path, scene(folder, [path], lights=[{"class": f"L{i}"} for i in range(n)])


def objects(folder, n):
    """Objects of one class."""
    return None, scene(folder, objects=[ball(i, "plain") for i in range(n)])


def references(folder, n):
    """Objects of one class each with a material of its own, of one class too."""
    return None, scene(
        folder,
        textures={f"t{i}": {"class": "Solid", "value": [0.1, i % 9 * 0.1, 0.5]} for i in range(n)},
        materials={f"m{i}": {"class": "Lambert", "albedo": f"t{i}"} for i in range(n)},
        objects=[ball(i, f"m{i}") for i in range(n)],
    )


def bulbs(folder, n):
    """Lights of one class."""
    return None, scene(
        folder,
        lights=[
            {"class": "BallLight", "position": [i % 10, 6, 4], "intensity": [1, 1, 1]}
            for i in range(n)
        ],
    )


def derived(folder, n):
    """A hierarchy: each class derives from one of eight, and overrides a method."""
    text = (
        "class Base : rt_Material {\n  public color tint = color(0.5);\n"
        "  color surface() { return tint; }\n"
        "  void shade() { rt_SampleColor = surface() * ambient(); }\n};\n"
    )
    text += "".join(
        f"class D{i} : {'Base' if i < 8 else f'D{i % 8}'} {{\n"
        f"  color surface() {{ return tint * {i}.25; }}\n}};\n"
        for i in range(n)
    )
    path = write(folder, "Derived.rtsl", text)
    return path, scene(
        folder,
        [path],
        materials={f"m{i}": {"class": f"D{i}"} for i in range(n)},
        objects=[ball(i, f"m{i}") for i in range(n)],
    )
