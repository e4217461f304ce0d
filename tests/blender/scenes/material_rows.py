# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials."""

import os

from rows import *


class Nodes:
    """A material with an output node, to build its tree."""

    def __init__(self, name="Nodes"):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.output = self.add('OutputMaterial')

    def add(self, kind, **inputs):
        node = self.tree.nodes.new('ShaderNode' + kind)
        for name, value in inputs.items():
            node.inputs[name.replace('_', ' ')].default_value = value
        return node

    def link(self, output, socket):
        self.tree.links.new(output, socket)

    def surface(self, output):
        self.link(output, self.output.inputs['Surface'])
        return self.material


def emission_input(node):
    return node.inputs['Emission Color' if 'Emission Color' in node.inputs else 'Emission']


def principled(nodes, **inputs):
    """Without its highlight, of which we draw none."""
    specular = 'Specular' if bpy.app.version < (4, 0) else 'Specular_IOR_Level'
    return nodes.add('BsdfPrincipled', **{specular: 0.0, 'Roughness': 1.0}, **inputs)


def picture(name="Picture", side=6, float_buffer=False, alpha=None, color_space=None, color=None):
    """A chequered picture with a red and a green corner; `alpha` and `color` are functions of a texel's place."""
    image = bpy.data.images.new(name, side, side, alpha=alpha is not None, float_buffer=float_buffer)
    if color_space:
        image.colorspace_settings.name = color_space
    values = []
    for y in range(side):
        for x in range(side):
            grey = 0.8 if (x + y) % 2 else 0.3
            rgb = color(x, y) if color else [grey + 0.2 * (x == 0), grey + 0.2 * (y == 0), grey]
            values.extend([*rgb, alpha(x, y) if alpha else 1.0])
    image.pixels.foreach_set(values)
    image.update()
    return image


def picture_files(stage, name, colors):
    """A sequence of pictures in files; `colors`: functions of a texel's place."""
    paths = []
    for number, color in enumerate(colors, start=1):
        image = picture(color=color)
        image.filepath_raw, image.file_format = os.path.join(stage.folder, f'{name}.{number:04d}.png'), 'PNG'
        image.save()
        paths.append(image.filepath_raw)
        bpy.data.images.remove(image)
    image = bpy.data.images.load(paths[0])
    image.source = 'SEQUENCE'
    return image


def unwrap(ob, name="Map", scale=1.0, turn=False):
    """Each quad of the mesh gets the unit square."""
    layer = ob.data.uv_layers.new(name=name)
    corners = ((0, 0), (1, 0), (1, 1), (0, 1))
    for polygon in ob.data.polygons:
        for number, corner in enumerate(polygon.loop_indices):
            u, v = corners[(number + turn) % 4]
            layer.data[corner].uv = scale * u, scale * v
    return layer


def textured(stage, image, output='Color', change=None, interpolation='Closest', extension='REPEAT'):
    """Floor and cube with the image as diffuse colour; `change(nodes, texture)` completes the tree."""
    nodes = Nodes()
    texture = nodes.add('TexImage')
    texture.image = image
    texture.interpolation, texture.extension = interpolation, extension
    diffuse = nodes.add('BsdfDiffuse')
    nodes.link(texture.outputs[output], diffuse.inputs['Color'])
    nodes.surface(diffuse.outputs[0])
    if change:
        change(nodes, texture)
    paint(stage, nodes.material)
    for ob in (stage.floor, bpy.data.objects["Cube"]):
        unwrap(ob)
    return nodes, texture, diffuse


def paint(stage, material):
    """Floor and a cube of one material."""
    stage.cube(material=material)
    stage.floor.data.materials.clear()
    stage.floor.data.materials.append(material)


@row('materials')
def principled_value(stage):
    """Principled: base colour."""
    nodes = Nodes()
    paint(stage, nodes.surface(principled(nodes, Base_Color=(0.8, 0.4, 0.1, 1)).outputs[0]))


@row('materials')
def principled_alpha(stage):
    """Principled: alpha of one half."""
    nodes = Nodes()
    material = nodes.surface(principled(nodes, Base_Color=(0.2, 0.5, 0.8, 1), Alpha=0.5).outputs[0])
    stage.cube(material=material).visible_shadow = False


@row('materials')
def principled_emission(stage):
    """Principled: emission, seen but lighting nothing."""
    nodes = Nodes()
    node = principled(nodes, Base_Color=(0.2, 0.2, 0.2, 1), Emission_Strength=0.7)
    emission_input(node).default_value = 0.1, 0.9, 0.4, 1
    stage.cube(material=nodes.surface(node.outputs[0]))
    stage.for_cycles = lambda: _lights_nothing(nodes.material)


def _lights_nothing(material):
    """As in our renders."""
    for ob in bpy.data.objects:
        if any(slot.material == material for slot in ob.material_slots):
            ob.visible_diffuse = False


@row('materials')
def diffuse_colour(stage):
    """Diffuse: colour."""
    paint(stage, white_material("Green", (0.1, 0.7, 0.2)))


@row('materials')
def emission(stage):
    """Emission shader."""
    nodes = Nodes()
    stage.cube(material=nodes.surface(nodes.add('Emission', Color=(1, 0.5, 0.2, 1), Strength=0.8).outputs[0]))
    stage.for_cycles = lambda: _lights_nothing(nodes.material)


@row('materials')
def transparent(stage):
    """Transparent shader: nothing is seen and no shadow cast."""
    nodes = Nodes()
    stage.cube(material=nodes.surface(nodes.add('BsdfTransparent').outputs[0]))
    stage.cube(half=0.2, location=(0.7, 0.5, 0.4))


@row('materials')
def mix_diffuse(stage):
    """Mix Shader of two Diffuse."""
    nodes = Nodes()
    mix = nodes.add('MixShader')
    mix.inputs[0].default_value = 0.3
    for socket, color in zip(mix.inputs[1:], ((1, 0, 0, 1), (0, 0.5, 1, 1))):
        nodes.link(nodes.add('BsdfDiffuse', Color=color).outputs[0], socket)
    paint(stage, nodes.surface(mix.outputs[0]))


@row('materials')
def mix_transparent(stage):
    """Mix of Transparent and Diffuse by value, casting no shadow."""
    nodes = Nodes()
    mix = nodes.add('MixShader')
    mix.inputs[0].default_value = 0.6
    nodes.link(nodes.add('BsdfTransparent').outputs[0], mix.inputs[1])
    nodes.link(nodes.add('BsdfDiffuse', Color=(0.9, 0.6, 0.1, 1)).outputs[0], mix.inputs[2])
    stage.cube(material=nodes.surface(mix.outputs[0])).visible_shadow = False


@row('materials')
def mix_transparent_by_image(stage):
    """Mix of Transparent and Diffuse by an image of black and white: holes that let light through."""
    nodes = Nodes()
    mix, texture = nodes.add('MixShader'), nodes.add('TexImage')
    texture.image = picture(color=lambda x, y: [float((x // 2 + y // 2) % 2)] * 3, color_space='Non-Color', side=16)
    texture.interpolation = 'Closest'
    nodes.link(texture.outputs['Color'], mix.inputs[0])
    nodes.link(nodes.add('BsdfTransparent').outputs[0], mix.inputs[1])
    nodes.link(nodes.add('BsdfDiffuse', Color=(0.9, 0.6, 0.1, 1)).outputs[0], mix.inputs[2])
    unwrap(stage.cube(material=nodes.surface(mix.outputs[0])))


@row('materials')
def add_shaders(stage):
    """Add Shader of Diffuse and Emission."""
    nodes = Nodes()
    add = nodes.add('AddShader')
    nodes.link(nodes.add('BsdfDiffuse', Color=(0.5, 0.1, 0.1, 1)).outputs[0], add.inputs[0])
    nodes.link(nodes.add('Emission', Color=(0, 0.2, 0.6, 1)).outputs[0], add.inputs[1])
    stage.cube(material=nodes.surface(add.outputs[0]))
    stage.for_cycles = lambda: _lights_nothing(nodes.material)


@row('materials')
def image_srgb(stage):
    """A byte image in sRGB."""
    textured(stage, picture())


@row('materials')
def image_linear(stage):
    """Smooth interpolation between the texels. Of linear ones: Cycles interpolates bytes as they are stored."""
    textured(stage, picture(float_buffer=True), interpolation='Linear')


@row('materials')
def image_clipped(stage):
    """Beyond its edges the image is black."""
    refine(stage)
    _beyond(stage, 'CLIP')


@row('materials')
def image_extended(stage):
    """Beyond its edges the image goes on with its last texels."""
    _beyond(stage, 'EXTEND')


def _beyond(stage, extension):
    def change(nodes, texture):
        coordinates, mapping = nodes.add('TexCoord'), nodes.add('Mapping')
        mapping.inputs['Location'].default_value = -0.15, -0.15, 0
        mapping.inputs['Scale'].default_value = 1.3, 1.3, 1
        nodes.link(coordinates.outputs['UV'], mapping.inputs['Vector'])
        nodes.link(mapping.outputs[0], texture.inputs['Vector'])
    textured(stage, picture(), change=change, extension=extension)


@row('materials')
def image_non_color(stage):
    """A byte image that is data."""
    textured(stage, picture(color_space='Non-Color'))


@row('materials')
def image_float(stage):
    """A float image in linear space."""
    textured(stage, picture(float_buffer=True))


@row('materials')
def image_other_space(stage):
    """A byte image in another colour space than sRGB, with other primaries."""
    spaces = bpy.types.ColorManagedInputColorspaceSettings.bl_rna.properties['name'].enum_items.keys()
    textured(stage, picture(color_space=next(name for name in ('Display P3', 'Linear ACEScg') if name in spaces)))


@row('materials')
def image_packed(stage):
    """An image packed into the .blend, whose file is gone."""
    image = picture()
    image.filepath_raw, image.file_format = os.path.join(stage.folder, 'packed.png'), 'PNG'
    image.save()
    loaded = bpy.data.images.load(image.filepath_raw)
    loaded.pack()
    os.remove(image.filepath_raw)
    textured(stage, loaded)


@row('materials')
def image_missing(stage):
    """An image whose file is missing: Cycles' pink."""
    image = bpy.data.images.new("Missing", 4, 4)
    image.source, image.filepath = 'FILE', os.path.join(stage.folder, 'nosuch.png')
    textured(stage, image)


@row('materials')
def image_udim(stage):
    """A tiled image: the first tile."""
    tile = picture()
    tile.filepath_raw, tile.file_format = os.path.join(stage.folder, 'tile.1001.png'), 'PNG'
    tile.save()
    image = bpy.data.images.load(os.path.join(stage.folder, 'tile.1001.png'))
    image.source = 'TILED'
    image.filepath = os.path.join(stage.folder, 'tile.<UDIM>.png')
    image.reload()
    textured(stage, image)


@row('materials')
def image_alpha(stage):
    """Principled alpha from an image's alpha channel: holes that let light through."""
    nodes = Nodes()
    texture, shader = nodes.add('TexImage'), principled(nodes)
    texture.image = picture(side=16, alpha=lambda x, y: float((x // 4 + y // 4) % 2))
    texture.interpolation = 'Closest'
    nodes.link(texture.outputs['Color'], shader.inputs['Base Color'])
    nodes.link(texture.outputs['Alpha'], shader.inputs['Alpha'])
    unwrap(stage.cube(material=nodes.surface(shader.outputs[0])))


@row('materials')
def image_emission(stage):
    """An image as emission."""
    refine(stage)
    nodes = Nodes()
    texture, shader = nodes.add('TexImage'), nodes.add('Emission', Strength=0.5)
    texture.image = picture(color=lambda x, y: [x / 5, y / 5, 0.2])
    nodes.link(texture.outputs['Color'], shader.inputs['Color'])
    unwrap(stage.cube(material=nodes.surface(shader.outputs[0])))
    stage.for_cycles = lambda: _lights_nothing(nodes.material)


@row('materials')
def uv_map_node(stage):
    """A UV Map node names another map than the active one."""
    def change(nodes, texture):
        node = nodes.add('UVMap')
        node.uv_map = "Other"
        nodes.link(node.outputs[0], texture.inputs['Vector'])
    textured(stage, picture(), change=change)
    for ob in (stage.floor, bpy.data.objects["Cube"]):
        unwrap(ob, "Other", scale=0.5, turn=True)


@row('materials')
def two_uv_maps(stage):
    """Two materials of one mesh with a map each."""
    def change(nodes, texture):
        node = nodes.add('UVMap')
        node.uv_map = "Other"
        nodes.link(node.outputs[0], texture.inputs['Vector'])
    nodes, _texture, _diffuse = textured(stage, picture(), change=change)
    plain = Nodes("Plain")
    texture, diffuse = plain.add('TexImage'), plain.add('BsdfDiffuse')
    texture.image, texture.interpolation = picture("Second"), 'Closest'
    plain.link(texture.outputs['Color'], diffuse.inputs['Color'])
    cube = bpy.data.objects["Cube"]
    cube.data.materials.append(plain.surface(diffuse.outputs[0]))
    for number, polygon in enumerate(cube.data.polygons):
        polygon.material_index = number % 2
    for ob in (stage.floor, cube):
        unwrap(ob, "Other", scale=0.5, turn=True)


@row('materials')
def mapping_node(stage):
    """A Mapping node moves, turns and scales the picture."""
    def change(nodes, texture):
        coordinates, mapping = nodes.add('TexCoord'), nodes.add('Mapping')
        mapping.inputs['Location'].default_value = 0.1, 0.3, 0
        mapping.inputs['Rotation'].default_value = 0, 0, 0.4
        mapping.inputs['Scale'].default_value = 0.6, 0.4, 1
        nodes.link(coordinates.outputs['UV'], mapping.inputs['Vector'])
        nodes.link(mapping.outputs[0], texture.inputs['Vector'])
    textured(stage, picture(), change=change)


@row('materials')
def mapping_as_texture(stage):
    """A Mapping node of the kind Texture: inverse."""
    def change(nodes, texture):
        coordinates, mapping = nodes.add('TexCoord'), nodes.add('Mapping')
        mapping.vector_type = 'TEXTURE'
        mapping.inputs['Location'].default_value = 0.1, 0.3, 0
        mapping.inputs['Rotation'].default_value = 0, 0, 0.4
        mapping.inputs['Scale'].default_value = 1.6, 2.4, 1
        nodes.link(coordinates.outputs['UV'], mapping.inputs['Vector'])
        nodes.link(mapping.outputs[0], texture.inputs['Vector'])
    textured(stage, picture(), change=change)


@row('materials')
def vertex_colours_bytes(stage):
    """A Color Attribute node: bytes of corners."""
    _vertex_colors(stage, 'CORNER', 'BYTE_COLOR', 'VertexColor')


@row('materials')
def vertex_colours_floats(stage):
    """An Attribute node: floats of vertices."""
    _vertex_colors(stage, 'POINT', 'FLOAT_COLOR', 'Attribute')


def _vertex_colors(stage, domain, kind, node):
    nodes = Nodes()
    source, diffuse = nodes.add(node), nodes.add('BsdfDiffuse')
    setattr(source, 'layer_name' if node == 'VertexColor' else 'attribute_name', "Paint")
    nodes.link(source.outputs['Color'], diffuse.inputs['Color'])
    paint(stage, nodes.surface(diffuse.outputs[0]))
    for ob in (stage.floor, bpy.data.objects["Cube"]):
        layer = ob.data.color_attributes.new("Paint", kind, domain)
        for index, element in enumerate(layer.data):
            element.color = (0.9, 0.2, 0.1, 1) if index % 2 else (0.1, 0.5, 0.8, 1)


@row('materials', until=(5, 0))
def display_colour(stage):
    """`use_nodes` off: the colour of the viewport. From Blender 5 on nodes are always used."""
    material = bpy.data.materials.new("Plain")
    material.use_nodes = False
    material.diffuse_color = 0.2, 0.7, 0.5, 1
    paint(stage, material)


@row('materials')
def no_material(stage):
    """No material at all: grey 0.8. From Blender 5 on Cycles' has the highlight of a Principled surface, too."""
    ob = stage.cube()
    ob.data.materials.clear()


@row('materials')
def node_group_and_reroute(stage):
    """Through a group, a reroute and a muted node."""
    nodes = Nodes()
    group = bpy.data.node_groups.new("Group", 'ShaderNodeTree')
    diffuse, output = group.nodes.new('ShaderNodeBsdfDiffuse'), group.nodes.new('NodeGroupOutput')
    diffuse.inputs['Color'].default_value = 0.7, 0.2, 0.6, 1
    if hasattr(group, 'interface'):
        group.interface.new_socket("BSDF", in_out='OUTPUT', socket_type='NodeSocketShader')
    else:
        group.outputs.new('NodeSocketShader', "BSDF")
    group.links.new(diffuse.outputs[0], output.inputs[0])
    node, reroute = nodes.add('Group'), nodes.tree.nodes.new('NodeReroute')
    node.node_tree = group
    nodes.link(node.outputs[0], reroute.inputs[0])
    paint(stage, nodes.surface(reroute.outputs[0]))


@row('materials')
def backface_culling_camera(stage):
    """Back faces are not seen: an inside-out cube, in Cycles by Transparent where a face is seen from behind."""
    nodes = Nodes()
    material = nodes.surface(nodes.add('BsdfDiffuse').outputs[0])
    material.use_backface_culling = True
    cube = stage.cube(half=0.5, location=(0, 0, 0.6), material=material)
    cube.data.flip_normals()
    cube.visible_shadow = False
    stage.for_cycles = lambda: _cull(nodes)


def _cull(nodes, seen_from_light=False):
    """Cycles' shadow rays come from what is lit: its front faces are those whose backs the light sees."""
    mix, geometry = nodes.add('MixShader'), nodes.add('NewGeometry')
    shader = nodes.output.inputs['Surface'].links[0].from_socket
    clear = nodes.add('BsdfTransparent').outputs[0]
    nodes.link(geometry.outputs['Backfacing'], mix.inputs[0])
    nodes.link(clear if seen_from_light else shader, mix.inputs[1])
    nodes.link(shader if seen_from_light else clear, mix.inputs[2])
    nodes.surface(mix.outputs[0])


@row('materials', since=(4, 2))
def backface_culling_shadow(stage):
    """Back faces, seen from the light, cast no shadow: a plane turned away, beside one turned to the light."""
    nodes = Nodes()
    material = nodes.surface(nodes.add('BsdfDiffuse').outputs[0])
    material.use_backface_culling_shadow = True
    for name, x, turn in (("Away", -0.5, 180), ("Towards", 0.6, 0)):
        plane = stage.show(add_plane(name, half=0.4, location=(x, 0, 1), rotation=(radians(turn), 0, 0)), material)
        plane.visible_camera = False
    stage.for_cycles = lambda: _cull(nodes, seen_from_light=True)


@row('materials')
def unsupported_shader(stage):
    """A Translucent shader inside Mix is reported; what is drawn is not compared closely."""
    nodes = Nodes()
    stage.cube()
    stage.cube(half=0.2, location=(0.8, 0.3, 0.4),
               material=nodes.surface(nodes.add('BsdfSheen' if bpy.app.version >= (4, 0) else 'BsdfVelvet').outputs[0]))
    bpy.data.objects["Cube.001"].visible_camera = False


@row('materials')
def volume_only(stage):
    """Only a volume: no surface is seen and casts a shadow, and the volume is not drawn."""
    nodes = Nodes()
    nodes.link(nodes.add('VolumeAbsorption').outputs[0], nodes.output.inputs['Volume'])
    stage.cube(material=nodes.material)
    stage.cube(half=0.2, location=(0.7, 0.5, 0.4))
    stage.for_cycles = lambda: nodes.surface(nodes.add('BsdfTransparent').outputs[0]) and _unlink(nodes, 'Volume')


def _unlink(nodes, name):
    nodes.tree.links.remove(nodes.output.inputs[name].links[0])


@row('materials')
def colour_as_surface(stage):
    """A colour linked in place of a shader is emitted."""
    nodes = Nodes()
    rgb = nodes.add('RGB')
    rgb.outputs[0].default_value = 0.2, 0.7, 0.4, 1
    stage.cube(material=nodes.surface(rgb.outputs[0]))
    stage.for_cycles = lambda: _lights_nothing(nodes.material)
