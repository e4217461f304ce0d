# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame contract: what of the picture is rendered, and from where."""

from rows import *


@row('frame')
def film_transparent(stage):
    """The stage: a cube over a floor, film transparent."""
    stage.cube()


@row('frame')
def film_opaque(stage):
    """World colour as background. Black to the diffuse surfaces, which Cycles would shadow from it."""
    stage.cube()
    stage.scene.render.film_transparent = False
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    tree = world.node_tree
    path = tree.nodes.new('ShaderNodeLightPath')
    color = next(node for node in tree.nodes if node.type == 'BACKGROUND')
    color.inputs['Color'].default_value = 0.2, 0.4, 0.8, 1
    stage.scene.world = world
    stage.for_cycles = lambda: tree.links.new(path.outputs['Is Camera Ray'], color.inputs['Strength'])
    stage.scene.camera.data.type = 'ORTHO'
    stage.scene.camera.data.ortho_scale = 12
    for ob in (stage.floor, bpy.data.objects["Cube"]):
        ob.is_holdout = True


@row('frame')
def border(stage):
    """A border without cropping: nothing outside."""
    stage.cube()
    render = stage.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.237, 0.741, 0.119, 0.853


@row('frame')
def border_cropped(stage):
    """A border with cropping."""
    border(stage)
    stage.scene.render.use_crop_to_border = True


@row('frame')
def percentage(stage):
    """Resolution percentage 53: sizes are cut, not rounded."""
    stage.cube()
    stage.scene.render.resolution_percentage = 53


@row('frame')
def percentage_and_border(stage):
    """Percentage 67 with a cropped border."""
    border_cropped(stage)
    stage.scene.render.resolution_percentage = 67


@row('frame')
def pixel_aspect_wide(stage):
    """Pixels twice as wide as high."""
    stage.cube()
    stage.scene.render.pixel_aspect_x = 2


@row('frame')
def pixel_aspect_high(stage):
    """Pixels 1.5 times as high as wide."""
    stage.cube()
    stage.scene.render.pixel_aspect_y = 1.5


@row('frame')
def shift(stage):
    """Camera shift in both directions."""
    stage.cube()
    stage.camera.data.shift_x, stage.camera.data.shift_y = 0.2, -0.15


@row('frame')
def orthographic(stage):
    """Orthographic camera with shift."""
    stage.cube()
    camera = stage.camera.data
    camera.type, camera.ortho_scale, camera.shift_x = 'ORTHO', 4.5, 0.1


@row('frame')
def sensor_fit_vertical(stage):
    """The lens counts for the height."""
    stage.cube()
    stage.camera.data.sensor_fit = 'VERTICAL'


@row('frame')
def portrait(stage):
    """A picture higher than wide: AUTO fits the height."""
    stage.cube()
    stage.scene.render.resolution_x, stage.scene.render.resolution_y = 56, 88


@row('frame')
def camera_scaled_and_parented(stage):
    """The camera's own scale does nothing; its parent moves it."""
    stage.cube()
    parent = add_object("Rig", None, location=(0.3, 0, 0.2), rotation=(0, 0, 0.3))
    stage.camera.parent = parent
    stage.camera.scale = 2, 0.5, 3


@row('frame')
def camera_mirrored(stage):
    """A negative scale mirrors the picture, but no face turns its back for it."""
    material = white_material("Front")
    material.use_backface_culling = True
    stage.cube(location=(0.5, 0.1, 0.5), material=material)
    stage.camera.scale = -1, 1, 1


@row('frame')
def clip_planes(stage):
    """Near and far planes cut the cube and the floor."""
    stage.cube(half=0.8)
    stage.camera.data.clip_start, stage.camera.data.clip_end = 4.9, 6.4


@row('frame')
def view_layer_material_override(stage):
    """The second view layer has a material for all."""
    stage.cube()
    layer = stage.scene.view_layers.new("Clay")
    layer.material_override = white_material("Clay", (0.8, 0.3, 0.1))
    stage.layer = "Clay"


@row('frame')
def view_layer_excluded_collection(stage):
    """A collection is excluded from the layer: no picture and no shadow of it."""
    stage.cube()
    collect(stage, stage.cube(location=(0.8, 0.3, 0.4))).exclude = True


@row('frame')
def view_layer_holdout(stage):
    """A collection cuts a hole and casts its shadow."""
    stage.cube()
    collect(stage, stage.cube(location=(0.8, 0.3, 0.4))).holdout = True


@row('frame')
def view_layer_indirect_only(stage):
    """A collection is not seen but casts its shadow."""
    stage.cube()
    collect(stage, stage.cube(location=(0.8, 0.3, 0.4))).indirect_only = True


@row('frame')
def view_layer_holdout_and_indirect(stage):
    """Of a collection with both switches the hole counts."""
    stage.cube()
    part = collect(stage, stage.cube(location=(0.8, 0.3, 0.4)))
    part.holdout = part.indirect_only = True


def collect(stage, ob):
    """Moves the object into a collection; its layer collection."""
    collection = bpy.data.collections.new("Part")
    stage.scene.collection.children.link(collection)
    stage.scene.collection.objects.unlink(ob)
    collection.objects.link(ob)
    return stage.scene.view_layers[0].layer_collection.children["Part"]


@row('frame')
def cameras_by_markers(stage):
    """A marker of the timeline switches to another camera."""
    stage.cube()
    other = add_camera(location=(4, -1, 4), rotation=(radians(45), 0, radians(76)))
    scene = stage.scene
    scene.camera = stage.camera
    for frame, camera in ((1, stage.camera), (5, other)):
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    stage.frame = 7


@row('frame')
def animated_frame(stage):
    """Frame 4 of a moving cube, light and material."""
    cube = stage.cube()
    for frame, x, energy in ((1, -1.0, 50), (6, 1.0, 400)):
        cube.location.x = x
        cube.keyframe_insert('location', frame=frame)
        stage.light.data.energy = energy
        stage.light.data.keyframe_insert('energy', frame=frame)
    stage.frame = 4


def _stereo(stage, view):
    stage.cube()
    stage.scene.render.use_multiview = True
    stage.camera.data.stereo.interocular_distance = 0.4
    stage.camera.data.stereo.convergence_distance = 5
    settings = stage.scene.render.image_settings
    if hasattr(settings, 'media_type'):
        settings.media_type = 'MULTI_LAYER_IMAGE'
    settings.file_format, settings.views_format = 'OPEN_EXR_MULTILAYER', 'MULTIVIEW'
    stage.view = view


@row('frame')
def stereo_left(stage):
    """The left eye of a stereo pair."""
    _stereo(stage, 'left')


@row('frame')
def stereo_right(stage):
    """The right eye of a stereo pair."""
    _stereo(stage, 'right')


@row('frame')
def stereo_parallel(stage):
    """The right eye of a camera with parallel axes."""
    _stereo(stage, 'right')
    stage.camera.data.stereo.convergence_mode = 'PARALLEL'


@row('frame')
def view_with_camera(stage):
    """A view with a camera of its own, found by the suffix of its name."""
    _stereo(stage, 'right')
    stage.scene.render.views_format = 'MULTIVIEW'
    stage.camera.name = "Eye_L"
    add_camera(location=(1.5, -3.8, 4.2), rotation=(radians(45), 0, 0.3)).name = "Eye_R"
    stage.scene.camera = stage.camera


# Cycles takes the depth of the first surface of the first sample, inside the pixel; ours is at its centre.
@row('frame', channel='Depth', light=0.005)
def depth_pass(stage):
    """The depth pass, along the camera's axis."""
    stage.cube()
    stage.scene.view_layers[0].use_pass_z = True
    stage.for_cycles = lambda: setattr(stage.scene.cycles, 'samples', 1)


@row('frame', channel='Normal', light=0.03)
def normal_pass(stage):
    """The normal pass, in world space."""
    stage.cube()
    stage.scene.view_layers[0].use_pass_normal = True
