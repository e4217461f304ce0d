# SPDX-License-Identifier: GPL-3.0-or-later
"""ctypes mirror of penumbra.h. Knows nothing of Blender; the declarations follow the header's order."""

import ctypes
import os
from ctypes import (POINTER, byref, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_uint32, c_uint64,
                    c_void_p, sizeof)

API_VERSION = 6

OK, TIMEOUT = 0, 1
INVALID_ARGUMENT, NO_BACKEND, UNSUPPORTED, OUT_OF_MEMORY, CANCELLED, CONTEXT_LOST = -1, -2, -3, -4, -5, -6

FLOAT, INT, BOOL, ENUM = range(4)
AREA, POINT, SPOT, SUN = range(4)
RECTANGLE, ELLIPSE = range(2)
PERSPECTIVE, ORTHOGRAPHIC = range(2)
INSTANCE_HIDDEN_FROM_CAMERA, INSTANCE_NO_SHADOW, INSTANCE_NO_RECEIVE, INSTANCE_HOLDOUT = 1, 2, 4, 8
INSTANCE_SHADOW_CATCHER = 16
MATERIAL_CULL_CAMERA, MATERIAL_CULL_SHADOW, MATERIAL_HOLDOUT = 1, 2, 4
MATERIAL_TINTED, MATERIAL_NO_SHADOW, MATERIAL_OPAQUE_SHADOW, MATERIAL_VERTEX_COLOR = 8, 16, 32, 64
TEXTURE_NEAREST, TEXTURE_EXTEND, TEXTURE_CLIP, TEXTURE_MIRROR = 1, 2, 4, 8
LIGHT_NO_SHADOW, LIGHT_COSINE_SPOT = 1, 2
MAX_LIGHTS = 64
PASS_COMBINED, PASS_DEPTH, PASS_NORMAL, PASS_SHADOW, PASS_LIGHT_SHADOWS = 1, 2, 4, 8, 16
PASS_BLOCKERS, PASS_PENUMBRAE, PASS_SHADOW_MAPS = 32, 64, 128
SETTINGS_FILM_TRANSPARENT, SETTINGS_PROGRESSIVE, SETTINGS_QUICK = 1, 2, 4


# What users can do, where the library's message only says what failed.
_CURES = {OUT_OF_MEMORY: "Smaller shadow maps or fewer pixels need less"}


class Error(Exception):
    """A failed library call; `result` is the pnb_result."""

    def __init__(self, result, message):
        super().__init__(f"{message}. {_CURES[result]}" if result in _CURES else message)
        self.result = result


class _Struct(ctypes.Structure):
    """Every structure of the library starts with its own size."""

    def __init__(self, **members):
        super().__init__(struct_size=sizeof(self), **members)


class ContextDesc(_Struct):
    _fields_ = [("struct_size", c_uint32), ("log_level", c_int), ("backend", c_char_p), ("log", c_void_p),
                ("log_user", c_void_p)]


class ContextInfo(_Struct):
    _fields_ = [("struct_size", c_uint32), ("is_software", c_uint32), ("gl_major", c_uint32), ("gl_minor", c_uint32),
                ("max_texture_size", c_uint32), ("reserved", c_uint32), ("backend", c_char * 32),
                ("vendor", c_char * 128), ("renderer", c_char * 128), ("version", c_char * 128),
                ("shading_language", c_char * 128)]


class Array(ctypes.Structure):
    _fields_ = [("data", c_void_p), ("stride", c_uint64)]


class MeshDesc(_Struct):
    _fields_ = [("struct_size", c_uint32), ("vertex_count", c_uint32), ("corner_count", c_uint32),
                ("triangle_count", c_uint32), ("polygon_count", c_uint32), ("reserved", c_uint32), ("name", c_char_p),
                ("positions", Array), ("corner_vertices", Array), ("corner_normals", Array), ("corner_uvs", Array),
                ("triangles", Array), ("triangle_polygons", Array), ("polygon_materials", Array),
                ("corner_colors", Array), ("vertex_colors", Array)]


class StrandsDesc(_Struct):
    _fields_ = [("struct_size", c_uint32), ("point_count", c_uint32), ("strand_count", c_uint32),
                ("reserved", c_uint32), ("name", c_char_p), ("positions", Array), ("radii", Array),
                ("first_points", Array), ("uvs", Array)]


class PointsDesc(_Struct):
    _fields_ = [("struct_size", c_uint32), ("point_count", c_uint32), ("name", c_char_p), ("positions", Array),
                ("radii", Array)]


class TextureDesc(_Struct):
    _fields_ = [("struct_size", c_uint32), ("width", c_uint32), ("height", c_uint32), ("channels", c_uint32),
                ("is_srgb", c_uint32), ("flags", c_uint32), ("name", c_char_p), ("pixels", Array)]


class Material(_Struct):
    _fields_ = [("struct_size", c_uint32), ("base_color", c_float * 3), ("transparency", c_float),
                ("flags", c_uint32), ("base_color_texture", c_void_p), ("alpha_texture", c_void_p),
                ("emission", c_float * 3), ("absorption", c_float * 3), ("emission_texture", c_void_p),
                ("uv_matrix", c_float * 6), ("shadow_threshold", c_float)]


class Instance(_Struct):
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("mesh", c_void_p), ("name", c_char_p),
                ("first_slot", c_uint32), ("slot_count", c_uint32), ("matrix", c_float * 16), ("unlit_by", c_uint64),
                ("unshadowed_by", c_uint64)]


class Light(_Struct):
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("type", c_int), ("shape", c_int), ("name", c_char_p),
                ("matrix", c_float * 16), ("emission", c_float * 3), ("size", c_float * 2), ("radius", c_float),
                ("angle", c_float), ("spot_angle", c_float), ("spot_blend", c_float), ("spread", c_float),
                ("technique", c_char_p), ("shadow_map_size", c_uint32), ("shadow_color", c_float * 3)]


class Camera(_Struct):
    _fields_ = [("struct_size", c_uint32), ("projection", c_int), ("matrix", c_float * 16), ("window", c_float * 4),
                ("clip_start", c_float), ("clip_end", c_float)]


class Scene(_Struct):
    _fields_ = [("struct_size", c_uint32), ("instance_count", c_uint32), ("material_count", c_uint32),
                ("slot_count", c_uint32), ("light_count", c_uint32), ("reserved", c_uint32),
                ("instances", POINTER(Instance)), ("materials", POINTER(Material)), ("slots", POINTER(c_uint32)),
                ("lights", POINTER(Light)), ("camera", Camera), ("world_color", c_float * 3)]


class ParameterInfo(_Struct):
    _fields_ = [("struct_size", c_uint32), ("type", c_int), ("name", c_char_p), ("label", c_char_p),
                ("description", c_char_p), ("unit", c_char_p), ("minimum", c_double), ("maximum", c_double),
                ("default_value", c_double), ("items", POINTER(c_char_p)), ("item_count", c_uint32),
                ("reserved", c_uint32)]


class TechniqueInfo(_Struct):
    _fields_ = [("struct_size", c_uint32), ("parameter_count", c_uint32), ("id", c_char_p), ("label", c_char_p),
                ("description", c_char_p), ("paper", c_char_p)]


class Value(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("value", c_double)]


class Settings(_Struct):
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("technique", c_char_p), ("values", POINTER(Value)),
                ("value_count", c_uint32), ("width", c_uint32), ("height", c_uint32), ("crop", c_uint32 * 4),
                ("samples", c_uint32), ("filter_width", c_float), ("shadow_map_size", c_uint32),
                ("light_samples", c_uint32), ("passes", c_uint32)]


class Progress(_Struct):
    _fields_ = [("struct_size", c_uint32), ("fraction", c_float), ("sample", c_uint32), ("samples", c_uint32),
                ("text", c_char * 104)]


class Image(_Struct):
    _fields_ = [("struct_size", c_uint32), ("width", c_uint32), ("height", c_uint32), ("channels", c_uint32),
                ("name", c_char_p), ("pixels", c_void_p)]


class Timing(_Struct):
    _fields_ = [("struct_size", c_uint32), ("count", c_uint32), ("name", c_char_p), ("gpu_ms", c_double),
                ("cpu_ms", c_double), ("bytes", c_uint64)]


# Name: (result, arguments). A result of None is void; CHECKED is a pnb_result that raises Error when negative.
CHECKED = object()
_HANDLE, _HANDLE_OUT = c_void_p, POINTER(c_void_p)
_FUNCTIONS = {
    "pnb_version": (c_char_p, []),
    "pnb_result_name": (c_char_p, [c_int]),
    "pnb_last_error": (c_char_p, []),
    "pnb_context_create": (CHECKED, [POINTER(ContextDesc), _HANDLE_OUT]),
    "pnb_context_destroy": (None, [_HANDLE_OUT]),
    "pnb_context_get_info": (CHECKED, [_HANDLE, POINTER(ContextInfo)]),
    "pnb_mesh_create": (CHECKED, [POINTER(MeshDesc), _HANDLE_OUT]),
    "pnb_mesh_create_strands": (CHECKED, [POINTER(StrandsDesc), _HANDLE_OUT]),
    "pnb_mesh_create_points": (CHECKED, [POINTER(PointsDesc), _HANDLE_OUT]),
    "pnb_mesh_destroy": (None, [_HANDLE_OUT]),
    "pnb_mesh_warning": (c_char_p, [_HANDLE]),
    "pnb_texture_create": (CHECKED, [POINTER(TextureDesc), _HANDLE_OUT]),
    "pnb_texture_destroy": (None, [_HANDLE_OUT]),
    "pnb_technique_count": (c_uint32, []),
    "pnb_technique_get_info": (CHECKED, [c_uint32, POINTER(TechniqueInfo)]),
    "pnb_technique_get_parameter": (CHECKED, [c_uint32, c_uint32, POINTER(ParameterInfo)]),
    "pnb_render_start": (CHECKED, [_HANDLE, POINTER(Scene), POINTER(Settings), _HANDLE_OUT]),
    "pnb_job_wait": (CHECKED, [_HANDLE, c_uint32, POINTER(Progress)]),
    "pnb_job_cancel": (None, [_HANDLE]),
    "pnb_job_destroy": (None, [_HANDLE_OUT]),
    "pnb_job_image_count": (c_uint32, [_HANDLE]),
    "pnb_job_get_image": (CHECKED, [_HANDLE, c_uint32, POINTER(Image)]),
    "pnb_job_copy_image": (CHECKED, [_HANDLE, c_uint32, c_void_p, c_uint64, POINTER(c_uint32)]),
    "pnb_job_timing_count": (c_uint32, [_HANDLE]),
    "pnb_job_get_timing": (CHECKED, [_HANDLE, c_uint32, POINTER(Timing)]),
    "pnb_job_message_count": (c_uint32, [_HANDLE]),
    "pnb_job_message": (c_char_p, [_HANDLE, c_uint32]),
    "pnb_capture_write": (CHECKED, [c_char_p, POINTER(Scene), POINTER(Settings)]),
    "pnb_capture_read": (CHECKED, [c_char_p, _HANDLE_OUT]),
    "pnb_capture_scene": (POINTER(Scene), [_HANDLE]),
    "pnb_capture_settings": (POINTER(Settings), [_HANDLE]),
    "pnb_capture_destroy": (None, [_HANDLE_OUT]),
}


def library_path():
    """The library lies beside this file; PENUMBRA_LIBRARY names another one, for development."""
    beside = os.path.join(os.path.dirname(os.path.abspath(__file__)), "libpenumbra.so")
    return os.environ.get("PENUMBRA_LIBRARY") or beside


def _declare(lib, name, result, arguments):
    function = getattr(lib, name)
    function.argtypes = arguments
    function.restype = c_int32 if result is CHECKED else result
    if result is not CHECKED:
        return function

    def checked(*values):
        code = function(*values)
        if code < 0:
            raise Error(code, lib.pnb_last_error().decode(errors="replace") or lib.pnb_result_name(code).decode())
        return code
    return checked


class Library:
    """The loaded library: its functions without the `pnb_` prefix. Failing calls raise Error."""

    def __init__(self, path):
        try:
            lib = ctypes.CDLL(path)
            api_version = lib.pnb_api_version
        except (OSError, AttributeError) as error:
            raise Error(INVALID_ARGUMENT, f"The Penumbra library cannot be loaded: {error}") from error
        api_version.restype = c_uint32
        if api_version() != API_VERSION:
            raise Error(INVALID_ARGUMENT, f"The Penumbra library {path} has interface {api_version()}, this add-on "
                                          f"needs {API_VERSION}: reinstall the add-on and restart Blender")
        for name, (result, arguments) in _FUNCTIONS.items():
            setattr(self, name[len("pnb_"):], _declare(lib, name, result, arguments))
        self._check_structures()

    def _check_structures(self):
        """Calls that check a structure's size and need no OpenGL: a mismatch shows here, not in a render."""
        try:
            if self.technique_count():
                self.technique_get_info(0, byref(TechniqueInfo()))
            mesh = self.create("mesh", MeshDesc(name=b"check"))
            self.destroy("mesh", mesh)
        except Error as error:
            raise Error(error.result, f"The Penumbra library does not fit this add-on ({error}): reinstall the add-on "
                                      "and restart Blender") from error

    def create(self, kind, desc):
        """Handle of pnb_<kind>_create."""
        handle = c_void_p()
        getattr(self, kind + "_create")(byref(desc), byref(handle))
        return handle

    def create_mesh_of(self, kind, desc):
        """Handle of pnb_mesh_create_<kind>: "strands" or "points"."""
        handle = c_void_p()
        getattr(self, "mesh_create_" + kind)(byref(desc), byref(handle))
        return handle

    def destroy(self, kind, handle):
        getattr(self, kind + "_destroy")(byref(handle))

    def techniques(self):
        """(TechniqueInfo, [ParameterInfo]) of every technique."""
        table = []
        for index in range(self.technique_count()):
            info = TechniqueInfo()
            self.technique_get_info(index, byref(info))
            parameters = [ParameterInfo() for _ in range(info.parameter_count)]
            for number, parameter in enumerate(parameters):
                self.technique_get_parameter(index, number, byref(parameter))
            table.append((info, parameters))
        return table


_library = None


def library():
    """The library, loaded once per process."""
    global _library
    if _library is None:
        _library = Library(library_path())
    return _library
