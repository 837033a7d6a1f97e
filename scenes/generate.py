#!/usr/bin/env python3
"""Writes the scenes of this directory: `python3 scenes/generate.py`. Standard library only.

With `--check` it writes nothing here and fails where a file is not what it would write. (Pictures are left out of the
check: their bytes depend on the version of zlib.)

The same bytes every time: no time stamps, no random state; coordinates are rounded to float32.
Conventions are glTF's: metres, +Y up, a front is counter-clockwise; `Mesh.check` asserts the last.
"""

import base64
import json
import math
import struct
import sys
import tempfile
import zlib
from pathlib import Path

HERE = Path(__file__).resolve().parent

FLOAT, UINT = 5126, 5125
VERTICES, INDICES = 34962, 34963


# Vectors

def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scale(a, 1 / math.sqrt(dot(a, a)))


def look(eye, target):
    """The quaternion (x, y, z, w) that turns −Z towards `target`, with +Y up."""
    back = unit(sub(eye, target))
    right = unit(cross((0, 1, 0), back))
    up = cross(back, right)
    # Of the rotation matrix with columns right, up, back; its trace is above −1 for all cameras here.
    w = math.sqrt(1 + right[0] + up[1] + back[2]) / 2
    return [(up[2] - back[1]) / (4 * w), (back[0] - right[2]) / (4 * w), (right[1] - up[0]) / (4 * w), w]


def turn(degrees):
    """The quaternion of a rotation about +Y."""
    half = math.radians(degrees) / 2
    return [0, math.sin(half), 0, math.cos(half)]


def smoothstep(lo, hi, x):
    t = min(max((x - lo) / (hi - lo), 0), 1)
    return t * t * (3 - 2 * t)


# Meshes

class Mesh:
    """Triangles with normals, texture coordinates and, if any vertex is given one, colours."""

    def __init__(self):
        self.positions, self.normals, self.uvs, self.colors, self.indices = [], [], [], [], []

    def vertex(self, position, normal, uv=(0, 0), color=None):
        self.positions.append(position)
        self.normals.append(normal)
        self.uvs.append(uv)
        if color is not None:
            self.colors.append(color)
        return len(self.positions) - 1

    def quad(self, a, b, c, d, uvs=((0, 1), (1, 1), (1, 0), (0, 0))):
        """A flat quadrilateral, counter-clockwise."""
        normal = unit(cross(sub(b, a), sub(d, a)))
        corners = [self.vertex(p, normal, uv) for p, uv in zip((a, b, c, d), uvs)]
        self.indices += [corners[0], corners[1], corners[2], corners[0], corners[2], corners[3]]

    def box(self, lo, hi, texels=1):
        """An axis-aligned box; `texels` repetitions of a texture per metre."""
        corner = lambda x, y, z: (hi[0] if x else lo[0], hi[1] if y else lo[1], hi[2] if z else lo[2])
        faces = [
            ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)),
            ((1, 0, 0), (0, 0, 0), (0, 1, 0), (1, 1, 0)),
            ((1, 0, 1), (1, 0, 0), (1, 1, 0), (1, 1, 1)),
            ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)),
            ((0, 1, 1), (1, 1, 1), (1, 1, 0), (0, 1, 0)),
            ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)),
        ]
        for face in faces:
            a, b, c, d = (corner(*place) for place in face)
            width = math.dist(a, b) * texels
            height = math.dist(b, c) * texels
            self.quad(a, b, c, d, ((0, height), (width, height), (width, 0), (0, 0)))

    def grid(self, rows, columns, vertex):
        """Quadrilaterals over `vertex(row, column)`, counter-clockwise if rows grow downwards seen from the front."""
        ids = [[vertex(i, j) for j in range(columns + 1)] for i in range(rows + 1)]
        for i in range(rows):
            for j in range(columns):
                a, b, c, d = ids[i + 1][j], ids[i + 1][j + 1], ids[i][j + 1], ids[i][j]
                for triangle in ((a, b, c), (a, c, d)):
                    if len({self.positions[k] for k in triangle}) == 3:
                        self.indices += triangle

    def sphere(self, radius, rows=32, columns=64):
        def vertex(i, j):
            theta, phi = math.pi * i / rows, 2 * math.pi * (j % columns) / columns
            # The poles and the seam are met exactly, so that the mesh is closed.
            ring = 0.0 if i in (0, rows) else math.sin(theta)
            normal = (ring * math.sin(phi), math.cos(theta), ring * math.cos(phi))
            return self.vertex(scale(normal, radius), normal, (j / columns, i / rows))

        self.grid(rows, columns, vertex)

    def lathe(self, profile, color, columns=48):
        """Turns a smooth profile of (radius, height), given downwards along the outside, about the Y axis."""
        def slope(i):
            before, after = profile[max(i - 1, 0)], profile[min(i + 1, len(profile) - 1)]
            return unit((before[1] - after[1], after[0] - before[0]))

        def vertex(i, j):
            radius, height = profile[i]
            outward, upward = slope(i)
            phi = 2 * math.pi * (j % columns) / columns
            sin, cos = math.sin(phi), math.cos(phi)
            uv = (j / columns, i / (len(profile) - 1))
            normal = (0.0, math.copysign(1, upward), 0.0) if radius == 0 else (outward * sin, upward, outward * cos)
            return self.vertex((radius * sin, height, radius * cos), normal, uv, color(height))

        self.grid(len(profile) - 1, columns, vertex)

    def tube(self, path, radii, columns=6):
        """A round stem along a path of points, which nowhere runs along Z."""
        def frame(i):
            along = unit(sub(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)]))
            side = unit(cross(along, (0, 0, 1)))
            return side, cross(side, along)

        def vertex(i, j):
            side, other = frame(i)
            phi = 2 * math.pi * (j % columns) / columns
            normal = add(scale(side, math.cos(phi)), scale(other, math.sin(phi)))
            return self.vertex(add(path[i], scale(normal, radii[i])), normal)

        self.grid(len(path) - 1, columns, vertex)

    def check(self):
        """Asserts that every triangle's front is where its normals point."""
        for k in range(0, len(self.indices), 3):
            corners = self.indices[k:k + 3]
            a, b, c = (self.positions[i] for i in corners)
            front = cross(sub(b, a), sub(c, a))
            assert all(dot(front, self.normals[i]) > 0 for i in corners), (k, a, b, c)


# glTF

class Gltf:
    """A glTF file under construction."""

    def __init__(self):
        self.data = bytearray()
        self.root = {
            "asset": {"version": "2.0", "generator": "Residual scenes/generate.py", "copyright": "CC0 1.0"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [], "cameras": [], "materials": [], "meshes": [], "accessors": [], "bufferViews": [],
        }

    def put(self, array, item):
        self.root.setdefault(array, []).append(item)
        return len(self.root[array]) - 1

    def node(self, **properties):
        self.root["scenes"][0]["nodes"].append(self.put("nodes", properties))

    def camera(self, eye, target, yfov):
        lens = {"yfov": round(math.radians(yfov), 6), "znear": 0.01}
        camera = self.put("cameras", {"name": "camera", "type": "perspective", "perspective": lens})
        self.node(name="camera", camera=camera, translation=rounded(eye), rotation=rounded(look(eye, target)))

    def material(self, name, color=(1, 1, 1), roughness=1, metallic=0, **more):
        pbr = {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
        pbr.update(more.pop("pbr", {}))
        return self.put("materials", {"name": name, "pbrMetallicRoughness": pbr, **more})

    def accessor(self, rows, kind, component, target):
        flat = [x for row in rows for x in row] if kind != "SCALAR" else rows
        packed = struct.pack(f"<{len(flat)}{'f' if component == FLOAT else 'I'}", *flat)
        view = self.put("bufferViews", {
            "buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed), "target": target,
        })
        self.data += packed
        accessor = {"bufferView": view, "componentType": component, "count": len(rows), "type": kind}
        if kind == "VEC3" and component == FLOAT:
            columns = list(zip(*(struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows)))
            accessor |= {"min": [min(c) for c in columns], "max": [max(c) for c in columns]}
        return self.put("accessors", accessor)

    def primitive(self, mesh, material, textured):
        mesh.check()
        attributes = {
            "POSITION": self.accessor(mesh.positions, "VEC3", FLOAT, VERTICES),
            "NORMAL": self.accessor(mesh.normals, "VEC3", FLOAT, VERTICES),
        }
        if textured:
            attributes["TEXCOORD_0"] = self.accessor(mesh.uvs, "VEC2", FLOAT, VERTICES)
        if mesh.colors:
            attributes["COLOR_0"] = self.accessor(mesh.colors, "VEC3", FLOAT, VERTICES)
        indices = self.accessor(mesh.indices, "SCALAR", UINT, INDICES)
        return {"attributes": attributes, "indices": indices, "material": material}

    def shape(self, name, mesh, material, textured=False, **place):
        primitive = self.primitive(mesh, material, textured)
        index = self.put("meshes", {"name": name, "primitives": [primitive]})
        self.node(name=name, mesh=index, **{k: rounded(v) for k, v in place.items()})

    def write(self, path, buffer=None, extensions=()):
        """Writes the file, with its buffer inside or in a file of that name beside it."""
        entry = {"byteLength": len(self.data)}
        if buffer is None:
            entry["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        else:
            (path.parent / buffer).write_bytes(self.data)
            entry["uri"] = buffer
        self.root["buffers"] = [entry]
        if extensions:
            self.root["extensionsUsed"] = sorted(extensions)
        path.write_text(json.dumps(self.root, indent=1) + "\n", newline="\n")


def rounded(values):
    return [round(x, 6) for x in values]


# Images

def png(path, size, texel, channels=3):
    """Writes a square PNG of 8-bit `texel(u, v)`, components in [0, 1], v growing downwards."""
    rows = bytearray()
    for y in range(size):
        rows.append(0)
        for x in range(size):
            color = texel((x + 0.5) / size, (y + 0.5) / size)
            rows += bytes(round(255 * min(max(c, 0), 1)) for c in color[:channels])

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", size, size, 8, 2 if channels == 3 else 6, 0, 0, 0)
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def lattice(x, y, seed):
    """A number in [0, 1) for a point of the integer lattice."""
    h = (x * 0x8DA6B343 ^ y * 0xD8163841 ^ seed * 0xCB1AB31F) & 0xFFFFFFFF
    h = ((h ^ h >> 15) * 0x2C1B3C6D) & 0xFFFFFFFF
    h = ((h ^ h >> 12) * 0x297A2D39) & 0xFFFFFFFF
    return (h ^ h >> 15) / 2**32


def noise(u, v, columns, rows, seed):
    """Smooth noise in [0, 1) that tiles over the unit square, of that many cells."""
    x, y = u * columns, v * rows
    i, j = math.floor(x), math.floor(y)
    s, t = smoothstep(0, 1, x - i), smoothstep(0, 1, y - j)
    at = lambda a, b: lattice(a % columns, b % rows, seed)
    top = at(i, j) * (1 - s) + at(i + 1, j) * s
    bottom = at(i, j + 1) * (1 - s) + at(i + 1, j + 1) * s
    return top * (1 - t) + bottom * t


PLANKS = 4


def wood_height(u, v):
    """Height of planks that run along u: fine grain, and grooves between the planks."""
    across = v * PLANKS % 1
    plank = math.floor(v * PLANKS) % PLANKS
    grain = noise(u + plank * 0.37, v, 6, 96, 3) * 0.6 + noise(u + plank * 0.37, v, 12, 200, 4) * 0.4
    groove = smoothstep(0, 0.03, min(across, 1 - across))
    return groove * (0.8 + 0.2 * grain)


def wood_color(u, v):
    plank = math.floor(v * PLANKS) % PLANKS
    shifted = u + plank * 0.37
    rings = 0.5 + 0.5 * math.sin(2 * math.pi * (v * 20 + 1.8 * noise(shifted, v, 3, 8, 1 + plank)))
    fine = noise(shifted, v, 8, 128, 7)
    tone = 0.55 * rings + 0.45 * fine + 0.35 * (lattice(plank, 0, 11) - 0.5)
    dark, light = (0.45, 0.29, 0.18), (0.76, 0.57, 0.38)
    groove = smoothstep(0, 0.03, min(v * PLANKS % 1, 1 - v * PLANKS % 1))
    return tuple((d + (l - d) * tone) * (0.35 + 0.65 * groove) for d, l in zip(dark, light))


def normals_of(height, size, strength):
    """A tangent-space normal map of a tiling height field; +Y is up in the image, as glTF says."""
    step = 1 / size

    def texel(u, v):
        slope_u = (height(u + step, v) - height(u - step, v)) * strength
        slope_v = (height(u, v + step) - height(u, v - step)) * strength
        return tuple(0.5 + 0.5 * c for c in unit((-slope_u, slope_v, 1)))

    return texel


def inlay(u, v):
    """Where the tile is brass: rings of a diamond pattern, 0 … 1."""
    x, y = abs(u * 4 % 1 - 0.5), abs(v * 4 % 1 - 0.5)
    diamond = 1 - smoothstep(0.02, 0.04, abs(x + y - 0.38))
    square = 1 - smoothstep(0.02, 0.04, abs(max(abs(u - 0.5), abs(v - 0.5)) - 0.47) * 2)
    return max(diamond, square)


def tile_color(u, v):
    brass, metal = (0.91, 0.73, 0.42), inlay(u, v)
    stone = 0.16 + 0.14 * noise(u, v, 8, 8, 21) + 0.06 * noise(u, v, 32, 32, 22)
    return tuple(s * (1 - metal) + b * metal for s, b in zip((stone * 0.85, stone, stone * 1.15), brass))


def tile_surface(u, v):
    """Roughness in green, metalness in blue."""
    metal = inlay(u, v)
    return (1, 0.28 - 0.04 * metal + 0.14 * noise(u, v, 16, 16, 23), metal)


def leaf(u, v):
    """A leaf with its tip at the top; alpha is its outline."""
    along = 1 - v
    width = 0.46 * math.sin(math.pi * min(max((along - 0.03) / 0.95, 0), 1) ** 0.75) ** 0.9
    across = abs(u - 0.5)
    alpha = 1 - smoothstep(-0.012, 0.012, across - width)
    vein = max(1 - smoothstep(0, 0.02, across), 0.6 * (1 - smoothstep(0.03, 0.1, abs((along * 9 - across * 8) % 1 - 0.5))))
    shade = 0.75 + 0.25 * noise(u, v, 8, 8, 31)
    green = tuple(shade * (g + (l - g) * 0.5 * vein) for g, l in zip((0.28, 0.50, 0.20), (0.66, 0.78, 0.42)))
    return (*green, alpha)


# The Cornell box

# Measured by the Cornell University Program of Computer Graphics, in millimetres, x to the left, z into the box.
BOX_HEIGHT, BOX_DEPTH, BOX_WIDTH = 548.8, 559.2, 552.8
LIGHT = (213.0, 343.0, 227.0, 332.0)
SHORT_BLOCK = (165.0, ((130, 65), (82, 225), (240, 272), (290, 114)))
TALL_BLOCK = (330.0, ((423, 247), (265, 296), (314, 456), (472, 406)))
# Linear Rec. 709, chosen to resemble the measured spectra.
CORNELL_COLORS = {"white": (0.73, 0.71, 0.68), "red": (0.61, 0.06, 0.05), "green": (0.12, 0.43, 0.10), "light": (0.78, 0.78, 0.78)}
LIGHT_COLOR, LIGHT_STRENGTH = (1.0, 0.78, 0.5), 30.0


def cornell_meshes():
    """Meshes by material, in metres, the opening towards +Z."""
    def point(x, y, z):
        return ((BOX_WIDTH / 2 - x) / 1000, y / 1000, -z / 1000)

    def quad(name, *corners):
        meshes[name].quad(*(point(*corner) for corner in corners))

    meshes = {name: Mesh() for name in CORNELL_COLORS}
    w, h, d = BOX_WIDTH, BOX_HEIGHT, BOX_DEPTH
    quad("white", (w, 0, 0), (0, 0, 0), (0, 0, d), (w, 0, d))
    quad("white", (w, 0, d), (0, 0, d), (0, h, d), (w, h, d))
    quad("green", (0, 0, d), (0, 0, 0), (0, h, 0), (0, h, d))
    quad("red", (w, 0, 0), (w, 0, d), (w, h, d), (w, h, 0))
    # The ceiling has a hole where the light is.
    x0, x1, z0, z1 = LIGHT
    for a, b, c, e in ((0, w, 0, z0), (0, w, z1, d), (0, x0, z0, z1), (x1, w, z0, z1)):
        quad("white", (a, h, c), (b, h, c), (b, h, e), (a, h, e))
    quad("light", (x0, h, z0), (x1, h, z0), (x1, h, z1), (x0, h, z1))
    for height, base in (SHORT_BLOCK, TALL_BLOCK):
        quad("white", *((x, height, z) for x, z in base))
        for k in range(4):
            (ax, az), (bx, bz) = base[k], base[(k + 1) % 4]
            quad("white", (bx, 0, bz), (bx, height, bz), (ax, height, az), (ax, 0, az))
    return meshes


def cornell_gltf(meshes):
    file = Gltf()
    # Straight into the box; a square picture is filled by its opening.
    file.camera((0, 0.2744, 0.76), (0, 0.2744, 0), 39.3)
    for name, mesh in meshes.items():
        diffuse = {"KHR_materials_specular": {"specularFactor": 0}}
        if name == "light":
            emission = {"KHR_materials_emissive_strength": {"emissiveStrength": LIGHT_STRENGTH}}
            material = file.material(name, CORNELL_COLORS[name], emissiveFactor=LIGHT_COLOR, extensions=diffuse | emission)
        else:
            material = file.material(name, CORNELL_COLORS[name], doubleSided=True, extensions=diffuse)
        file.shape(name, mesh, material)
    file.write(HERE / "cornell-box.gltf",
               extensions=["KHR_materials_emissive_strength", "KHR_materials_specular"])


def cornell_obj(meshes):
    write = lambda numbers: " ".join(f"{round(x, 6) + 0.0:g}" for x in numbers)
    obj = ["# Cornell box. Written by generate.py.", "mtllib cornell-box.mtl"]
    mtl = ["# Cornell box. Written by generate.py."]
    first = 1
    for name, mesh in meshes.items():
        obj += [f"o {name}", f"usemtl {name}"]
        obj += ["v " + write(position) for position in mesh.positions]
        count = len(mesh.positions)
        obj += [f"f {k} {k + 1} {k + 2} {k + 3}" for k in range(first, first + count, 4)]
        first += count
        mtl += ["", f"newmtl {name}", "illum 1", "Kd " + write(CORNELL_COLORS[name])]
        if name == "light":
            mtl.append("Ke " + write(scale(LIGHT_COLOR, LIGHT_STRENGTH)))
    for suffix, lines in (("obj", obj), ("mtl", mtl)):
        (HERE / f"cornell-box.{suffix}").write_text("\n".join(lines) + "\n", newline="\n")


# The still life

def vase_profile():
    """Down the outside, under the foot and up the inside: a closed body."""
    outside = [(0.050, 0.330), (0.042, 0.318), (0.036, 0.300), (0.034, 0.280), (0.038, 0.258), (0.050, 0.232),
               (0.067, 0.200), (0.080, 0.166), (0.086, 0.132), (0.084, 0.098), (0.075, 0.064), (0.062, 0.034),
               (0.052, 0.014), (0.050, 0.002), (0.046, 0.0), (0.0, 0.0)]
    inside = [(max(r - 0.006, 0.0), max(y, 0.012)) for r, y in outside[1:13]]
    rim = [(0.0475, 0.3325), (0.0450, 0.331)]
    return [(0.0, 0.012)] + inside[::-1] + rim[::-1] + outside


def vase_color(height):
    """Glaze above, terracotta below."""
    t = smoothstep(0.085, 0.125, height)
    return tuple(a + (b - a) * t for a, b in zip((0.46, 0.15, 0.07), (0.80, 0.77, 0.69)))


def foliage():
    """Stems that bend outwards from the vase's mouth, and leaves in pairs along them."""
    stems, leaves = Mesh(), Mesh()
    for number in range(5):
        heading = 2 * math.pi * (number * 0.2 + 0.03)
        reach, height = 0.10 + 0.055 * lattice(number, 1, 41), 0.205 + 0.07 * lattice(number, 2, 41)
        outward = (math.cos(heading), 0.0, math.sin(heading))
        steps = 10
        # Upright within the neck.
        bend = lambda t: 0.012 * t + reach * max((t - 0.4) / 0.6, 0) ** 1.5
        path = [add(scale(outward, 0.004 + bend(k / steps)), (0, 0.20 + height * k / steps, 0)) for k in range(steps + 1)]
        stems.tube(path[::-1], [0.0012 + 0.0022 * (1 - k / steps) for k in range(steps + 1)][::-1])
        for k in range(5, steps + 1):
            along = unit(sub(path[k], path[k - 1]))
            sides = (0,) if k == steps else (-1, 1)
            for side in sides:
                sideways = unit(cross(along, (math.sin(heading + 2.4 * k), 0.2, math.cos(heading + 2.4 * k))))
                direction = unit(add(scale(along, 0.55 if side else 1), scale(sideways, 0.85 * side)))
                leaf_card(leaves, path[k], direction, 0.052 + 0.022 * lattice(number, k * 2 + side, 42))
    return stems, leaves


def leaf_card(mesh, foot, direction, length):
    """Two quadrilaterals, folded along the middle and drooping towards the tip."""
    side = unit(cross(direction, (0.15, 1, 0.1)))
    up = cross(side, direction)
    half = length * 0.36
    middle = [foot, add(foot, add(scale(direction, length * 0.55), scale(up, length * 0.05))),
              add(foot, add(scale(direction, length), scale(up, -length * 0.12)))]
    for k in range(2):
        for s in (-1, 1):
            edge = [add(p, add(scale(side, s * half), scale(up, half * 0.35))) for p in middle]
            v0, v1 = 1 - (0.55, 1)[k - 1] * (k > 0), 1 - (0.55, 1)[k]
            corners = [(middle[k], (0.5, v0)), (edge[k], (0.5 + 0.5 * s, v0)),
                       (edge[k + 1], (0.5 + 0.5 * s, v1)), (middle[k + 1], (0.5, v1))]
            if s < 0:
                corners.reverse()
            mesh.quad(*(p for p, _ in corners), uvs=[uv for _, uv in corners])


def textured():
    images = HERE / "textures"
    png(images / "wood.png", 256, wood_color)
    png(images / "wood-normal.png", 256, normals_of(wood_height, 256, 3.5))
    png(images / "tile.png", 128, tile_color)
    png(images / "tile-surface.png", 128, tile_surface)
    png(images / "leaf.png", 64, leaf, channels=4)

    file = Gltf()
    for name in ("wood", "wood-normal", "tile", "tile-surface", "leaf"):
        source = file.put("images", {"name": name, "uri": f"textures/{name}.png"})
        # Leaves must not tile: their edges would show at the other side.
        file.put("textures", {"source": source, "sampler": 1 if name == "leaf" else 0})
    file.put("samplers", {"magFilter": 9729, "minFilter": 9987})
    file.put("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071})

    grain = {"extensions": {"KHR_texture_transform": {"scale": [1.25, 2.5], "offset": [0.1, 0.07]}}}
    matt = {"KHR_materials_specular": {"specularFactor": 0}}
    glow = lambda strength: {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
    wood = file.material("wood", roughness=0.42, pbr={"baseColorTexture": {"index": 0, **grain}},
                         normalTexture={"index": 1, **grain})
    tile = file.material("inlaid tile", metallic=1, pbr={
        "baseColorTexture": {"index": 2}, "metallicRoughnessTexture": {"index": 3}})
    leaves = file.material("leaf", roughness=0.55, doubleSided=True, alphaMode="MASK",
                           pbr={"baseColorTexture": {"index": 4}})
    stem = file.material("stem", (0.16, 0.20, 0.07), roughness=0.7)
    copper = file.material("copper", (0.95, 0.60, 0.47), roughness=0.2, metallic=1)
    glass = file.material("glass", (0.97, 1.0, 0.985), roughness=0, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_ior": {"ior": 1.5},
        "KHR_materials_volume": {"thicknessFactor": 0.17}})
    glaze = file.material("glaze", roughness=0.28)
    cover = file.material("book cover", (0.05, 0.13, 0.24), roughness=0.5)
    paper = file.material("paper", (0.80, 0.74, 0.60), extensions=matt)
    wall = file.material("wall", (0.70, 0.69, 0.66), extensions=matt)
    floor = file.material("floor", (0.26, 0.23, 0.21), extensions=matt)
    lamp = file.material("lamp", (0, 0, 0), emissiveFactor=(1.0, 0.86, 0.68),
                         extensions=matt | glow(24.0))
    window = file.material("window", (0, 0, 0), emissiveFactor=(0.62, 0.80, 1.0),
                           extensions=matt | glow(5.5))

    table = Mesh()
    table.box((-0.85, -0.05, -0.5), (0.85, 0.0, 0.5))
    for x in (-0.78, 0.71):
        for z in (-0.43, 0.36):
            table.box((x, -0.75, z), (x + 0.07, -0.05, z + 0.07))
    file.shape("table", table, wood, textured=True)

    # Coordinates of the room's inside; the window is a hole's worth of light in front of the left wall.
    left, right, down, up, back, front = -2.0, 2.0, -0.75, 1.9, -1.3, 2.4
    walls, ground = Mesh(), Mesh()
    walls.quad((left, down, back), (right, down, back), (right, up, back), (left, up, back))
    walls.quad((right, down, front), (left, down, front), (left, up, front), (right, up, front))
    walls.quad((left, down, front), (left, down, back), (left, up, back), (left, up, front))
    walls.quad((right, down, back), (right, down, front), (right, up, front), (right, up, back))
    walls.quad((left, up, back), (right, up, back), (right, up, front), (left, up, front))
    ground.quad((left, down, front), (right, down, front), (right, down, back), (left, down, back))
    file.shape("walls", walls, wall)
    file.shape("floor", ground, floor)

    pane, panel = Mesh(), Mesh()
    for lo, hi in ((0.0, 0.55), (0.6, 1.15)):
        for bottom, top in ((0.1, 0.72), (0.77, 1.4)):
            x = left + 0.01
            pane.quad((x, bottom, hi), (x, bottom, lo), (x, top, lo), (x, top, hi))
    file.shape("window", pane, window)
    panel.quad((-0.24, 0, -0.24), (0.24, 0, -0.24), (0.24, 0, 0.24), (-0.24, 0, 0.24))
    file.shape("lamp", panel, lamp, translation=(-0.35, 1.3, 0.25))

    ball, marble = Mesh(), Mesh()
    ball.sphere(0.115)
    marble.sphere(0.085)
    file.shape("copper ball", ball, copper, translation=(-0.235, 0.1155, -0.02))
    file.shape("glass ball", marble, glass, translation=(0.015, 0.0855, 0.24))

    vase = Mesh()
    vase.lathe(vase_profile(), vase_color)
    at = (0.19, 0.0125, -0.06)
    file.shape("vase", vase, glaze, translation=at)
    stems, cards = foliage()
    file.shape("stems", stems, stem, translation=at)
    file.shape("leaves", cards, leaves, textured=True, translation=at)

    slab = Mesh()
    slab.box((-0.13, 0.0005, -0.13), (0.13, 0.012, 0.13))
    # Each face shows the whole tile.
    slab.uvs = [(0, 1), (1, 1), (1, 0), (0, 0)] * 6
    file.shape("tile", slab, tile, textured=True, translation=at, rotation=turn(24))
    file.root["nodes"][-1]["translation"][1] = 0

    boards, pages = Mesh(), Mesh()
    boards.box((-0.09, 0.0005, -0.13), (0.09, 0.0045, 0.13))
    boards.box((-0.09, 0.0335, -0.13), (0.09, 0.0375, 0.13))
    boards.box((-0.09, 0.0045, -0.13), (-0.086, 0.0335, 0.13))
    pages.box((-0.086, 0.0046, -0.125), (0.085, 0.0334, 0.125))
    place = {"translation": (0.385, 0, 0.17), "rotation": turn(-62)}
    file.shape("book", boards, cover, **place)
    file.shape("pages", pages, paper, **place)

    spot = {"type": "spot", "name": "spot", "color": [1.0, 0.82, 0.6], "intensity": 3.2,
            "spot": {"innerConeAngle": 0.12, "outerConeAngle": 0.32}}
    file.root["extensions"] = {"KHR_lights_punctual": {"lights": [spot]}}
    eye = (1.5, 1.35, 0.75)
    file.node(name="spot", translation=rounded(eye), rotation=rounded(look(eye, (0.15, 0.2, -0.05))),
              extensions={"KHR_lights_punctual": {"light": 0}})
    file.camera((0.12, 0.50, 1.15), (0.045, 0.215, 0.0), 36)
    file.write(HERE / "textured.gltf", buffer="textured.bin", extensions=[
        "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_specular",
        "KHR_materials_transmission", "KHR_materials_volume", "KHR_texture_transform"])


# Caustics

def caustics():
    """A ball of glass and a ring of copper on a floor, under a small lamp."""
    file = Gltf()
    matte = {"KHR_materials_specular": {"specularFactor": 0}}
    floor = file.material("floor", (0.75, 0.72, 0.68), extensions=matte)
    glass = file.material("glass", (1, 1, 1), roughness=0, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_ior": {"ior": 1.5},
        "KHR_materials_volume": {"thicknessFactor": 1.2, "attenuationColor": [0.95, 0.8, 0.6], "attenuationDistance": 1.0},
    })
    copper = file.material("copper", (0.95, 0.64, 0.54), roughness=0.05, metallic=1, doubleSided=True)
    lamp = file.material("lamp", (0, 0, 0), emissiveFactor=(1.0, 0.9, 0.8), extensions=matte | {
        "KHR_materials_emissive_strength": {"emissiveStrength": 2000}})

    ground = Mesh()
    ground.quad((-6, 0, 6), (6, 0, 6), (6, 0, -6), (-6, 0, -6))
    ground.quad((-6, 0, -3), (6, 0, -3), (6, 6, -3), (-6, 6, -3))
    file.shape("ground", ground, floor)
    ball = Mesh()
    ball.sphere(0.6)
    file.shape("ball", ball, glass, translation=(-0.7, 0.62, 0.1))
    ring = Mesh()
    ring.lathe([(0.8, 0.35), (0.8, 0.0)], lambda _: None, columns=96)
    file.shape("ring", ring, copper, translation=(1.0, 0.002, 0.5))
    bulb = Mesh()
    bulb.quad((-0.06, -0.06, 0), (0.06, -0.06, 0), (0.06, 0.06, 0), (-0.06, 0.06, 0))
    at, target = (-2.2, 3.2, 1.8), (0, 0.3, 0.2)
    # What looks along -Z shines along +Z.
    file.shape("lamp", bulb, lamp, translation=at, rotation=look(at, sub(scale(at, 2), target)))
    file.camera((1.2, 2.6, 5.2), (0.1, 0.35, 0.1), 35)
    file.write(HERE / "caustics.gltf", extensions=[
        "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_transmission",
        "KHR_materials_volume"])


def write_all():
    cornell = cornell_meshes()
    cornell_gltf(cornell)
    cornell_obj(cornell)
    textured()
    caustics()


def check():
    """Writes everything elsewhere and names the files here that differ."""
    global HERE
    committed = HERE
    with tempfile.TemporaryDirectory() as directory:
        HERE = Path(directory)
        (HERE / "textures").mkdir()
        write_all()
        written = [path for path in HERE.rglob("*") if path.is_file() and path.suffix != ".png"]
        stale = [path.name for path in written
                 if (committed / path.relative_to(HERE)).read_bytes() != path.read_bytes()]
    if stale:
        sys.exit(f"not what scenes/generate.py writes: {', '.join(sorted(stale))}; run python3 scenes/generate.py")


if __name__ == "__main__":
    check() if "--check" in sys.argv[1:] else write_all()
