"""c_library.py LIBRARY: binds the C functions of libpapilio.so, and asks for a refinement, levels and faults."""

import ctypes
import sys
from ctypes import CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_float, c_int, c_int32, c_uint32, c_void_p


class Attribute(Structure):
    _fields_ = [("components", c_uint32), ("kind", c_int32), ("values", POINTER(c_double))]


class Triangles(Structure):
    _fields_ = [
        ("point_count", c_uint32),
        ("face_count", c_uint32),
        ("attribute_count", c_uint32),
        ("positions", POINTER(c_float)),
        ("triangles", POINTER(c_uint32)),
        ("attributes", POINTER(Attribute)),
    ]


class Statistics(Structure):
    _fields_ = [
        ("level", c_int32),
        ("is_last", c_int32),
        ("stop_reason", c_int32),
        ("components", c_uint32),
        ("mechanical", c_uint32),
        ("creases", c_uint32),
        ("error", c_double),
        ("error_pixels", c_double),
    ]


Cancelled = CFUNCTYPE(c_int, c_void_p)
OnLevel = CFUNCTYPE(None, c_void_p, POINTER(Triangles), POINTER(Statistics))


class Hooks(Structure):
    _fields_ = [("user", c_void_p), ("cancelled", Cancelled), ("on_level", OnLevel), ("threads", c_int32)]


library = ctypes.CDLL(sys.argv[1])
for name, result, arguments in [
    ("papilio_mesh_create", c_void_p, [POINTER(Triangles)]),
    ("papilio_mesh_free", None, [c_void_p]),
    ("papilio_refine", c_void_p, [c_void_p, c_char_p, POINTER(Hooks)]),
    ("papilio_result_mesh", POINTER(Triangles), [c_void_p]),
    ("papilio_result_statistics", POINTER(Statistics), [c_void_p]),
    ("papilio_result_free", None, [c_void_p]),
    ("papilio_last_fault", c_int, []),
    ("papilio_last_message", c_char_p, []),
    ("papilio_last_parameter", c_char_p, []),
]:
    function = getattr(library, name)
    function.restype, function.argtypes = result, arguments

positions = (c_float * 12)(1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1)
triangles = (c_uint32 * 12)(0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2)
heights = (c_double * 4)(1, -1, 1, -1)
attribute = Attribute(1, 0, heights)
mesh = library.papilio_mesh_create(Triangles(4, 4, 1, positions, triangles, ctypes.pointer(attribute)))
assert mesh

# The attribute is the y coordinate of the corners. At a midpoint it is the mean, like y.
result = library.papilio_refine(mesh, b"levels=2&shape=plain", None)
fine = library.papilio_result_mesh(result).contents
assert (fine.face_count, fine.point_count, fine.attribute_count) == (64, 34, 1)
assert fine.positions[0:12] == list(positions)
values = fine.attributes[0].values[0 : fine.point_count]
assert min(values) == -1 and max(values) == 1 and 0 in values
assert library.papilio_result_statistics(result).contents.level == 2
library.papilio_result_free(result)

levels = []
hooks = Hooks(
    None,
    Cancelled(lambda user: 0),
    OnLevel(lambda user, level, statistics: levels.append((statistics[0].level, level[0].face_count))),
    2,
)
library.papilio_result_free(library.papilio_refine(mesh, b"levels=3&shape=plain", ctypes.byref(hooks)))
assert levels == [(0, 4), (1, 16), (2, 64), (3, 256)], levels

hooks.cancelled = Cancelled(lambda user: 1)
assert library.papilio_refine(mesh, b"levels=8", ctypes.byref(hooks)) is None
assert library.papilio_last_fault() == 4

assert library.papilio_refine(mesh, b"levels=eleven", None) is None
assert library.papilio_last_fault() == 1
assert library.papilio_last_parameter() == b"levels"
assert b"levels must be an integer" in library.papilio_last_message()
library.papilio_mesh_free(mesh)
library.papilio_mesh_free(None)

assert library.papilio_mesh_create(Triangles(0, 0, 0, None, None, None)) is None
assert library.papilio_last_fault() == 2
