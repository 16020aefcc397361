"""Scenes of any number of triangles and lights for tools/bench.py: a closed room with bumps on its floor, lamps below its ceiling."""
import json
import math
import struct

WIDTH, HEIGHT, DEPTH = 4.0, 3.0, 4.0  # m
POWER = 30.0                          # W/sr of all lamps together
WALL_TRIANGLES = 10                   # ceiling and four walls


def quad(positions, normals, indices, corner, a, b, normal):
    first = len(positions)
    for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
        positions.append([corner[i] + u * a[i] + v * b[i] for i in range(3)])
        normals.append(normal)
    indices += [first, first + 1, first + 2, first, first + 2, first + 3]


def mesh(triangles):
    """Positions, normals, indices: about `triangles` of them, the nearest count of a square grid, walls included."""
    cells = max(1, round(math.sqrt(max(triangles - WALL_TRIANGLES, 2) / 2)))
    positions, normals, indices = [], [], []
    waves = 6 * 2 * math.pi / WIDTH
    for row in range(cells + 1):
        for column in range(cells + 1):
            x, z = WIDTH * column / cells, DEPTH * row / cells
            slope_x = 0.1 * waves * math.cos(waves * x) * math.sin(waves * z)
            slope_z = 0.1 * waves * math.sin(waves * x) * math.cos(waves * z)
            length = math.sqrt(slope_x**2 + 1 + slope_z**2)
            positions.append([x, 0.1 + 0.1 * math.sin(waves * x) * math.sin(waves * z), z])
            normals.append([-slope_x / length, 1 / length, -slope_z / length])
    for row in range(cells):
        for column in range(cells):
            a = row * (cells + 1) + column
            indices += [a, a + cells + 1, a + cells + 2, a, a + cells + 2, a + 1]
    quad(positions, normals, indices, (0, HEIGHT, 0), (WIDTH, 0, 0), (0, 0, DEPTH), [0, -1, 0])
    quad(positions, normals, indices, (0, 0, 0), (0, 0, DEPTH), (0, HEIGHT, 0), [1, 0, 0])
    quad(positions, normals, indices, (WIDTH, 0, 0), (0, HEIGHT, 0), (0, 0, DEPTH), [-1, 0, 0])
    quad(positions, normals, indices, (0, 0, 0), (0, HEIGHT, 0), (WIDTH, 0, 0), [0, 0, 1])
    quad(positions, normals, indices, (0, 0, DEPTH), (WIDTH, 0, 0), (0, HEIGHT, 0), [0, 0, -1])
    # Counter-clockwise from inside, whatever the order above was.
    for i in range(0, len(indices), 3):
        p, q, r = (positions[k] for k in indices[i:i + 3])
        a, b = [q[k] - p[k] for k in range(3)], [r[k] - p[k] for k in range(3)]
        cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
        if sum(c * n for c, n in zip(cross, normals[indices[i]])) < 0:
            indices[i + 1], indices[i + 2] = indices[i + 2], indices[i + 1]
    return positions, normals, indices


def write(file, triangles, lights):
    """Returns the number of triangles."""
    positions, normals, indices = mesh(triangles)
    parts = [struct.pack(f"<{3 * len(positions)}f", *(x for p in positions for x in p)),
             struct.pack(f"<{3 * len(normals)}f", *(x for n in normals for x in n)),
             struct.pack(f"<{len(indices)}I", *indices)]
    along = math.ceil(math.sqrt(lights))
    places = [(WIDTH * (i % along + 0.5) / along, 0.8 * HEIGHT, DEPTH * (i // along + 0.5) / along) for i in range(lights)]
    nodes = [{"mesh": 0}, {"camera": 0, "translation": [WIDTH / 2, HEIGHT / 2, DEPTH - 0.1]}]
    nodes += [{"translation": list(p), "extensions": {"KHR_lights_punctual": {"light": i}}} for i, p in enumerate(places)]
    views, offset = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(part)})
        offset += len(part)
    document = {
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_specular"], "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.2, "znear": 0.01, "zfar": 100.0}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.5, 0.4, 1], "metallicFactor": 0},
                       "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
                       "min": [min(p[k] for p in positions) for k in range(3)], "max": [max(p[k] for p in positions) for k in range(3)]},
                      {"bufferView": 1, "componentType": 5126, "count": len(normals), "type": "VEC3"},
                      {"bufferView": 2, "componentType": 5125, "count": len(indices), "type": "SCALAR"}],
        "bufferViews": views, "buffers": [{"byteLength": offset}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": POWER / lights}] * lights}}}
    # POSITION bounds are compared with single precision data.
    for bound in ("min", "max"):
        document["accessors"][0][bound] = [struct.unpack("<f", struct.pack("<f", x))[0] for x in document["accessors"][0][bound]]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(parts)
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)) +
                     struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
    return len(indices) // 3
