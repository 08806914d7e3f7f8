"""A town at night: every lit window is a light, and so are lamps and cars. Some ten thousand emissive triangles."""

import math
import random

from .mesh import Mesh, Obj
from .shapes import box

BLOCK, STREET, BLOCKS = 34.0, 11.0, 7

# Colours of light; radiance.
GLOW = {
    'bulb': (2.6, 1.3, 0.45), 'warm': (1.9, 1.25, 0.62), 'neutral': (1.5, 1.35, 1.15), 'office': (0.9, 1.15, 1.35),
    'screen': (0.3, 0.6, 1.4), 'curtain': (1.1, 0.3, 0.16), 'lamp': (30.0, 17.0, 6.0), 'head': (36.0, 33.0, 28.0),
    'tail': (16.0, 0.6, 0.3), 'beacon': (40.0, 1.5, 1.0),
}
MTL = {'asphalt': 'Kd 0.03 0.032 0.036\nKs 0.05 0.05 0.05\nPr 0.22', 'pavement': 'Kd 0.1 0.1 0.1',
       'brick': 'Kd 0.16 0.085 0.06', 'stone': 'Kd 0.2 0.19 0.17', 'slate': 'Kd 0.07 0.08 0.1\nKs 0.04 0.04 0.04\nPr 0.3',
       'roof': 'Kd 0.06 0.06 0.065'}


class Batch:
    """Quads by material, so that the file has one group for each."""

    def __init__(self):
        self.quads = {}

    def quad(self, material, corner, u, v):
        """corner, corner + u, corner + u + v, corner + v: counter-clockwise from where it is seen."""
        add = lambda *vectors: tuple(math.fsum(c) for c in zip(*vectors))
        self.quads.setdefault(material, []).append((corner, add(corner, u), add(corner, u, v), add(corner, v)))

    def mesh(self, material):
        points = [p for quad in self.quads[material] for p in quad]
        return Mesh(points, [tuple(range(i, i + 4)) for i in range(0, len(points), 4)])


def building(batch, rng, x, z, width, depth, floors):
    """Four facades with windows, some of them lit, and a roof with a parapet of darkness."""
    wall = rng.choice(['brick', 'stone', 'slate'])
    storey, sill = 3.2, 1.0
    height = floors * storey + 1.2
    office = floors > 9 and rng.random() < 0.6
    x0, x1, z0, z1 = x - width / 2, x + width / 2, z - depth / 2, z + depth / 2
    sides = [((x0, z1), (1, 0), width, (0, 1)), ((x1, z1), (0, -1), depth, (1, 0)),
             ((x1, z0), (-1, 0), width, (0, -1)), ((x0, z0), (0, 1), depth, (-1, 0))]
    batch.quad('roof', (x0, height, z1), (width, 0, 0), (0, 0, -depth))
    for (a, b), (du, dw), length, (nx, nz) in sides:
        batch.quad(wall, (a, 0, b), (du * length, 0, dw * length), (0, height, 0))
        bays = max(2, int(length / 2.6))
        bay = length / bays
        glass = bay * (0.8 if office else 0.45)
        for floor in range(floors):
            # In offices whole storeys are lit or dark.
            lively = (0.75 if rng.random() < 0.3 else 0.04) if office else 0.27
            for k in range(bays):
                if rng.random() > lively:
                    continue
                if office:
                    kind = rng.choice(['office', 'office', 'neutral'])
                else:
                    kind = rng.choices(['bulb', 'warm', 'neutral', 'screen', 'curtain'], (4, 6, 2, 1, 1))[0]
                s = (k + 0.5) * bay - glass / 2
                start = (a + du * s + 0.03 * nx, floor * storey + sill + 0.4, b + dw * s + 0.03 * nz)
                batch.quad(kind, start, (du * glass, 0, dw * glass), (0, 1.5, 0))
    if floors > 17:
        small_box(batch, 'beacon', x, height + 2.0, z, 0.35)
        small_box(batch, 'roof', x, height + 0.8, z, 0.12, 1.0)


def small_box(batch, material, x, y, z, half, tall=None):
    tall = tall or half
    mesh = box((2 * half, 2 * tall, 2 * half), (x, y, z))
    for face in mesh.faces:
        p = [mesh.points[i] for i in face]
        batch.quads.setdefault(material, []).append(tuple(p))


def make(folder):
    rng = random.Random(1927)
    batch = Batch()
    pitch = BLOCK + STREET
    half = BLOCKS * pitch / 2
    batch.quad('asphalt', (-half * 6, 0, half * 6), (12 * half, 0, 0), (0, 0, -12 * half))
    for i in range(BLOCKS):
        for j in range(BLOCKS):
            cx, cz = (i + 0.5) * pitch - half, (j + 0.5) * pitch - half
            if (i, j) == (3, 4):
                square(batch, rng, cx, cz)
                continue
            batch.quad('pavement', (cx - BLOCK / 2, 0.15, cz + BLOCK / 2), (BLOCK, 0, 0), (0, 0, -BLOCK))
            # Taller towards the middle of the town.
            center = math.exp(-((i - 3) ** 2 + (j - 2) ** 2) / 5)
            lots = 2 if rng.random() < 0.75 else 1
            size = (BLOCK - 4) / lots
            for a in range(lots):
                for b in range(lots):
                    floors = max(3, int(rng.gauss(4 + 15 * center, 2 + 3 * center)))
                    place = (cx + (a + 0.5) * size - (BLOCK - 4) / 2, cz + (b + 0.5) * size - (BLOCK - 4) / 2)
                    building(batch, rng, *place, size - rng.uniform(1, 3), size - rng.uniform(1, 3), floors)
            for sx, sz in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
                lamp(batch, cx + sx * (BLOCK / 2 - 0.6), cz + sz * (BLOCK / 2 - 0.6))
    traffic(batch, rng, pitch, half)
    obj = Obj('a town at night; metres', 'city.mtl', 2)
    for material in batch.quads:
        obj.add(batch.mesh(material), material)
    obj.write(folder / 'city.obj')
    lines = ['# A town at night. Ke is radiance.']
    for name, text in MTL.items():
        lines += [f'newmtl {name}', text]
    for name, glow in GLOW.items():
        lines += [f'newmtl {name}', 'Kd 0.02 0.02 0.02', 'Ke ' + ' '.join(map(str, glow))]
    (folder / 'city.mtl').write_text('\n'.join(lines) + '\n')


def lamp(batch, x, z):
    small_box(batch, 'roof', x, 2.4, z, 0.06, 2.4)
    small_box(batch, 'lamp', x, 4.9, z, 0.17)


def square(batch, rng, cx, cz):
    """An open place with rings of lamps instead of houses."""
    batch.quad('stone', (cx - BLOCK / 2, 0.15, cz + BLOCK / 2), (BLOCK, 0, 0), (0, 0, -BLOCK))
    for radius, count in ((6, 8), (14, 16)):
        for k in range(count):
            a = 2 * math.pi * k / count
            lamp(batch, cx + radius * math.sin(a), cz + radius * math.cos(a))


def traffic(batch, rng, pitch, half):
    """Head and tail lights along the streets; the drivers keep to the right."""
    for street in range(1, BLOCKS):
        for along_x in (False, True):
            for _ in range(16):
                s = rng.uniform(-half, half)
                way = rng.choice((-1, 1))
                lane = street * pitch - half + 2.4 * way * (1 if along_x else -1)
                for ahead, kind in ((2.0, 'head'), (-2.0, 'tail')):
                    facing = way if ahead > 0 else -way
                    for side in (-0.6, 0.6):
                        position = (s + way * ahead, lane + side) if along_x else (lane + side, s + way * ahead)
                        light(batch, kind, position, (facing, 0) if along_x else (0, facing))


def light(batch, material, position, facing):
    """A square of 20 cm, upright, 60 cm above the street."""
    (x, z), (nx, nz) = position, facing
    batch.quad(material, (x - 0.1 * nz, 0.5, z + 0.1 * nx), (0.2 * nz, 0, -0.2 * nx), (0, 0.2, 0))
