"""The scene of Objects.rtsl, for the tests of printed C++ and of the commands."""


def objects_scene(shaders, sphere, layers=3):
    """What tests/cpp/scenes/Objects.rtsl has, with `layers` textures in a row."""
    textures = {"t0": {"class": "Layered", "noise": "fine"}}
    for i in range(1, layers):
        textures[f"t{i}"] = {
            "class": "Layered",
            "below": f"t{i - 1}",
            "side": f"t{i - 1}",
            "noise": "coarse",
            "tint": [0.1 * (i % 8), 0.7, 0.4],
        }

    def ball(center, radius, material):
        return {
            "primitive": {"class": "Sphere", "center": center, "radius": radius},
            "material": material,
        }

    return {
        "rtsl": 1,
        "import": [str(shaders), str(sphere)],
        "camera": {"class": "Eye"},
        "helpers": {
            "fine": {"class": "Noise", "constructor": [0.25], "scale": 3},
            "coarse": {"class": "Ridged", "constructor": [0.5], "finer": "fine"},
        },
        "textures": textures,
        "materials": {
            "plain": {"class": "Painted"},
            "painted": {"class": "Painted", "paint": f"t{layers - 1}", "bump": "coarse"},
            "coated": {"class": "Coated", "paint": "t0"},
            "tilted": {"class": "Tilted", "bump": "fine", "shine": 0.1},
        },
        "objects": [
            ball([-2, 0, 0], 1, "plain"),
            ball([2, 0.2, 0], 1.1, "painted"),
            ball([0, 1.5, -0.5], 1, "coated"),
            ball([0.2, -0.8, 1], 0.8, "tilted"),
        ],
        "lights": [
            {"class": "Sun", "position": [4, 6, 5], "power": 40},
            {"class": "Sun", "position": [-5, 3, 6], "power": [20, 25, 30]},
        ],
        "ambient": 0.2,
        "background": {"class": "Sky"},
        "render": {"engine": "classic", "size": [24, 24], "spp": 2, "depth": 4},
    }
