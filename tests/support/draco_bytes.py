"""draco_bytes.py NAME: writes a Draco stream byte by byte, as no encoder would. Without a name: lists them.

The layout is that of Draco's decoder, bitstream 2.2: header, connectivity, attributes' declarations, values.
"""
import struct
import sys

MESH, SEQUENTIAL, EDGEBREAKER = 1, 0, 1
POSITION, GENERIC = 0, 4
INT32, FLOAT32 = 5, 9
SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0.5), (0, 1, 0)]
TWO_FACES = [(0, 1, 2), (0, 2, 3)]


def varint(number):
    out = bytearray()
    while number > 127:
        out.append(number & 127 | 128)
        number >>= 7
    return bytes(out + bytearray([number]))


def header(method=SEQUENTIAL, version=(2, 2), flags=0):
    return b"DRACO" + bytes([*version, MESH, method]) + struct.pack("<H", flags)


def attribute(values, kind=POSITION, data_type=FLOAT32, components=3):
    """One attributes' decoder with one attribute, its values raw."""
    code = {INT32: "i", FLOAT32: "f"}[data_type]
    declared = varint(1) + bytes([kind, data_type, components, 0]) + varint(0) + bytes([0])
    return declared + b"".join(struct.pack(f"<{len(value)}{code}", *value) for value in values)


def sequential(points=SQUARE, faces=TWO_FACES, values=None, before=b"", flags=0, **how):
    """Indices as bytes, positions raw."""
    uncompressed = 1
    connectivity = varint(len(faces)) + varint(len(points)) + bytes([uncompressed])
    connectivity += b"".join(bytes(face) for face in faces)
    return header(flags=flags) + before + connectivity + bytes([1]) + attribute(values or points, **how)


def edgebreaker_counts(vertices, faces, version=(2, 2)):
    """Declares these, as old bitstreams (32 bits each) or new ones do, and brings nothing."""
    number = varint if version >= (2, 0) else lambda count: struct.pack("<I", count)
    new_vertices = number(0) if version < (2, 2) else b""
    symbols = number(faces) + number(0)
    counts = new_vertices + number(vertices) + number(faces) + bytes([0]) + symbols
    return header(EDGEBREAKER, version) + bytes([0]) + counts + bytes(48)


def sequential_counts(points, faces):
    compressed = 0
    return header() + varint(faces) + varint(points) + bytes([compressed]) + bytes(48)


def metadata(entries=b"", entry_count=0, depth=0, blocks=None):
    """No attribute's metadata, then the mesh's: entries, and blocks within blocks."""
    nested = b"".join([varint(0) + varint(1) + bytes([1]) + b"x"] * depth)
    last = varint(entry_count) + entries + varint(0 if blocks is None else blocks)
    return varint(0) + nested + last


METADATA_FLAG = 0x8000
NAN, INFINITY = float("nan"), float("inf")
STREAMS = {
    "good": lambda: sequential(),
    "index_out_of_range": lambda: sequential(faces=[(0, 1, 2), (0, 2, 200)]),
    "no_position": lambda: sequential(kind=GENERIC),
    "four_components": lambda: sequential(values=[(*p, 1) for p in SQUARE], components=4),
    "two_components": lambda: sequential(values=[p[:2] for p in SQUARE], components=2),
    "integers": lambda: sequential(values=[(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0)], data_type=INT32),
    "nan": lambda: sequential(points=[*SQUARE[:3], (0, NAN, 0)]),
    "infinity": lambda: sequential(points=[*SQUARE[:3], (0, -INFINITY, 0)]),
    "isolated_points": lambda: sequential(points=[*SQUARE, (5, 5, 5), (6, 6, 6)]),
    "values_missing": lambda: sequential()[:-1],
    "metadata_good": lambda: sequential(flags=METADATA_FLAG, before=metadata(b"\1k\1v", 1)),
    "metadata_deep": lambda: sequential(flags=METADATA_FLAG, before=metadata(depth=100_000)),
    "metadata_entries": lambda: sequential(flags=METADATA_FLAG, before=metadata(b"\1k", 0xFFFFFFFF)),
    "metadata_blocks": lambda: sequential(flags=METADATA_FLAG, before=metadata(blocks=0xFFFFFFFF)),
    "metadata_long_value": lambda: sequential(
        flags=METADATA_FLAG, before=metadata(b"\1k" + varint(0xFFFFFFFF), 1)),
    "bomb_edgebreaker": lambda: edgebreaker_counts(50_000_000, 100_000_000),
    "bomb_sequential": lambda: sequential_counts(100_000_000, 100_000_000),
    # The largest size within the default limits.
    "limit_edgebreaker": lambda: edgebreaker_counts(1_000_000, 2_000_000),
    "limit_sequential": lambda: sequential_counts(2_000_000, 2_000_000),
} | {
    f"bomb_{major}.{minor}": lambda version=(major, minor): edgebreaker_counts(50_000_000, 100_000_000, version)
    for major, minor in [(1, 0), (1, 1), (1, 2), (1, 3), (1, 4), (1, 5), (2, 0), (2, 1)]
}

if len(sys.argv) > 1:
    sys.stdout.buffer.write(STREAMS[sys.argv[1]]())
else:
    print("\n".join(STREAMS))
