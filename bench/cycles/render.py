"""Renders parallelograms by Cycles, in Blender: blender -b -P render.py -- SETTINGS.json

The settings, which bench/measure/cycles.py writes, have the camera, the parallelograms with their
reflectance and radiance, and how to render. Cycles renders what rtslc does: diffuse surfaces, as
many scatterings, a pixel's mean over its square, no lower bound of light that counts, no upper one
of a sample, and no denoising. Processor seconds and samples are written as JSON.
"""

import json
import math
import sys
import time

import bpy
import mathutils


def add_material(one):
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    if any(one["radiance"]):
        shader = nodes.new("ShaderNodeEmission")
        shader.inputs["Color"].default_value = [*one["radiance"], 1]
        shader.inputs["Strength"].default_value = 1
    else:
        shader = nodes.new("ShaderNodeBsdfDiffuse")
        shader.inputs["Color"].default_value = [*one["reflectance"], 1]
        shader.inputs["Roughness"].default_value = 0
    links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def add_parallelogram(one):
    anchor, side1, side2 = map(mathutils.Vector, one["corners"])
    mesh = bpy.data.meshes.new("parallelogram")
    corners = [anchor, anchor + side1, anchor + side1 + side2, anchor + side2]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    mesh.materials.append(add_material(one))
    bpy.context.collection.objects.link(bpy.data.objects.new("parallelogram", mesh))


def add_camera(settings):
    eye, target, up = (mathutils.Vector(settings[name]) for name in ("eye", "target", "up"))
    forward = (target - eye).normalized()
    right = forward.cross(up).normalized()
    upward = right.cross(forward)
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(settings["fieldOfView"])
    data.clip_start, data.clip_end = 1e-3, 1e6
    camera = bpy.data.objects.new("camera", data)
    # Blender's cameras look against their z axis.
    axes = mathutils.Matrix((right, upward, -forward)).transposed()
    camera.matrix_world = mathutils.Matrix.Translation(eye) @ axes.to_4x4()
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def choose_cycles(scene, settings):
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples, cycles.seed = settings["samples"], settings["seed"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    # The first scattering is no bounce in the words of Cycles.
    for name in ("max_bounces", "diffuse_bounces"):
        setattr(cycles, name, settings["scatterings"] - 1)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0


def choose_picture(render, settings):
    render.resolution_x, render.resolution_y = settings["size"]
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", settings["threads"]
    render.filepath = settings["picture"]
    render.use_file_extension = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.color_mode = "RGB"


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        settings = json.load(file)
    for one in list(bpy.data.objects):
        bpy.data.objects.remove(one)
    scene = bpy.context.scene
    scene.world.use_nodes = False
    scene.world.color = (0, 0, 0)
    for one in settings["parallelograms"]:
        add_parallelogram(one)
    add_camera(settings["camera"])
    choose_cycles(scene, settings)
    choose_picture(scene.render, settings)
    start = time.process_time()
    bpy.ops.render.render(write_still=True)
    width, height = settings["size"]
    report = {
        "processorSeconds": time.process_time() - start,
        "samples": width * height * settings["samples"],
        "version": bpy.app.version_string,
    }
    with open(settings["report"], "w", encoding="utf-8") as file:
        json.dump(report, file)


main()
