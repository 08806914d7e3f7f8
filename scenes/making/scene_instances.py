"""A field of tulips: one flower, nested into patches, rows and bands, before a windmill."""

import math
import random

from .mesh import Mesh, Obj
from .shapes import arc, box, revolve, sheet
from . import png

HEAD = """# Tens of thousands of placements from nested models: flower, patch, band. Made by making/scene_instances.py.

[film]
size = [1280, 720]
exposure = 2.8

[camera.field]
from = [0.9, 1.75, 4.2]
to = [-1.9, 1.6, -16]
perspective = { vertical_fov = 40 }

[environment.sky]
elevation = 34
azimuth = 130
turbidity = 3
ground_albedo = [0.15, 0.14, 0.08]

[[object]]
file = "ground.obj"
material = "soil"

[[object]]
file = "trees.obj"
material = "trees"

[[object]]
file = "mill.obj"
translate = [-13, 0, -52]
rotate = [0, 28, 0]

[[object]]
file = "sails.obj"
translate = [-13, 0, -52]
rotate = [0, 28, 0]

[material.soil.oren_nayar]
albedo = [0.14, 0.1, 0.065]
sigma = 30

[material.trees.oren_nayar]
albedo = [0.045, 0.08, 0.03]
sigma = 30

[material.green.principled]
base_color = [0.1, 0.24, 0.06]
roughness = 0.45
"""

COLORS = {
    'red': (0.62, 0.02, 0.025), 'yellow': (0.85, 0.55, 0.02), 'pink': (0.82, 0.3, 0.42), 'violet': (0.26, 0.05, 0.3),
    'white': (0.85, 0.83, 0.76), 'orange': (0.84, 0.24, 0.02),
}


def bloom():
    """A cup of six petals: the rim is scalloped, and leans in and out by turns."""

    def f(u, v):
        a = 2 * math.pi * u
        petal = abs(math.cos(3 * a))
        r = 0.036 * math.sin(math.pi * (0.12 + 0.62 * v) ** 0.8) ** 0.8 + 0.004 * v * (1 if math.cos(6 * a) > 0 else -1) * petal
        height = 0.075 * v * (0.72 + 0.28 * petal**0.7)
        return (r * math.sin(a), 0.42 + height, r * math.cos(a))

    return sheet(f, 24, 5)


def stem():
    def stalk(u, v):
        a = 2 * math.pi * u
        lean = 0.012 * math.sin(2.5 * v)
        return (0.0045 * math.sin(a) + lean * (1 - v), 0.425 * v, 0.0045 * math.cos(a))

    def leaf(turn, length, side):
        def f(u, v):
            width = 0.024 * math.sin(math.pi * v**0.7) + 0.002
            x, fold = (2 * u - 1) * width, abs(2 * u - 1) * width * 0.6
            out, up = 0.17 * v**1.8 * length, 0.34 * length * (v - 0.28 * v**3)
            return (x, 0.02 + up, side * 0.006 + out - fold)

        return sheet(f, 2, 5).turn('y', turn)

    return [sheet(stalk, 5, 3), leaf(20, 1, 1), leaf(165, 0.8, 1), leaf(270, 0.65, 1)]


def mill():
    """A tower of brick under a cap of thatch, on a gallery."""
    tower = revolve([(3.0, 0), (2.75, 2.2), (2.5, 4.6), (2.2, 7.4), (1.95, 9.4)], 32)
    gallery = revolve([(2.6, 3.3), (4.1, 3.5), (4.1, 3.62), (2.5, 3.62)], 32)
    cap = revolve([(2.15, 9.3), (2.2, 9.5), (2.05, 10.2), (1.6, 11.0), (0.9, 11.6), (0, 11.85)], 32)
    doors = [box((1.1, 2.1, 0.3), (0, 1.05, 2.75)), box((0.7, 1.0, 0.3), (0, 5.6, 2.35)), box((0.6, 0.8, 0.3), (0, 8.0, 2.1))]
    rails = [box((0.08, 1.0, 0.08), (4.0 * math.sin(a), 4.1, 4.0 * math.cos(a))) for a in (2 * math.pi * k / 24 for k in range(24))]
    rim = revolve([(3.95, 4.55), (4.05, 4.55), (4.05, 4.65), (3.95, 4.65), (3.95, 4.55)], 32)
    return [('brick', [tower]), ('wood', [gallery, rim] + rails), ('thatch', [cap]), ('paint', doors)]


def sails():
    """Four sails of laths, the wheel tilted a little upward."""
    parts = []
    for k in range(4):
        blade = [box((0.22, 9.4, 0.18), (0, 4.8, 0))]
        blade += [box((1.5, 0.07, 0.05), (0.68, 2.0 + 0.55 * i, 0.06)) for i in range(14)]
        blade += [box((0.07, 7.4, 0.05), (1.4, 5.6, 0.08)), box((0.07, 7.4, 0.05), (0.7, 5.6, 0.08))]
        parts += [part.turn('z', 90 * k + 22).turn('x', -6).move(0, 10.2, 3.0) for part in blade]
    parts.append(box((0.6, 0.6, 2.2)).turn('x', -6).move(0, 10.2, 2.2))
    return parts


def make(folder):
    def write(name, groups, library=None):
        obj = Obj(f'{name}, for the field of tulips', library)
        for material, meshes in groups:
            for mesh in meshes:
                obj.add(Mesh(mesh.points, mesh.faces, mesh.normals), material)
        obj.write(folder / f'{name}.obj')

    write('bloom', [(None, [bloom()])])
    write('stem', [(None, stem())])
    write('mill', mill(), 'mill.mtl')
    write('sails', [('wood', sails())], 'mill.mtl')
    (folder / 'mill.mtl').write_text("""newmtl brick
Kd 0.3 0.14 0.09
newmtl wood
Kd 0.5 0.46 0.4
newmtl thatch
Kd 0.2 0.15 0.08
newmtl paint
Kd 0.05 0.16 0.11
""")

    plain = Mesh([(-400, 0, 60), (400, 0, 60), (400, 0, -500), (-400, 0, -500)], [(0, 1, 2, 3)])
    write('ground', [(None, [plain])])

    def trees(u, v):
        x = 500 * (u - 0.5)
        crown = 5 + 9 * png.fractal(u * 50, 0.3, 64, 4, 3)
        return (x, crown * v ** 0.8, -130 - 6 * math.sin(math.pi * v) * png.fractal(u * 90, v * 3, 128, 3, 6))

    write('trees', [(None, [sheet(trees, 150, 4)])])

    # A patch is three rows of 2 m; a band is a row of patches away from the camera.
    rng = random.Random(1637)
    text = HEAD
    for name, color in COLORS.items():
        text += f'\n[material.{name}.principled]\nbase_color = {list(color)}\nroughness = 0.4\nsheen = 0.3\n'
        text += f'\n[model."{name} tulip"]\nobject = [{{ file = "bloom.obj", material = "{name}" }}, {{ file = "stem.obj", material = "green" }}]\n'
    for name in COLORS:
        text += f'\n[[model."{name} patch".object]]\nmodel = "{name} tulip"\ntransforms = [\n'
        for row in range(3):
            for k in range(16):
                x, z = 0.36 * (row - 1) + rng.gauss(0, 0.035), -2 * (k + rng.uniform(0.1, 0.9)) / 16
                lean, turn = rng.gauss(0, 4), rng.uniform(0, 360)
                text += (f'    {{ translate = [{x:.3f}, 0, {z:.3f}], rotate = [{lean:.1f}, {turn:.0f}, {rng.gauss(0, 4):.1f}], '
                         f'scale = {rng.uniform(0.85, 1.2):.2f} }},\n')
        text += ']\n'
    # Every second patch is turned, so that the eye does not find the repetition.
    patches = 22
    for name in COLORS:
        text += f'\n[[model."{name} band".object]]\nmodel = "{name} patch"\ntransforms = [\n'
        for k in range(patches):
            if k % 2:
                text += f'    {{ translate = [0, 0, {-2 * k - 2}], rotate = [0, 180, 0] }},\n'
            else:
                text += f'    {{ translate = [0, 0, {-2 * k}] }},\n'
        text += ']\n'
    order = ['red', 'yellow', 'pink', 'violet', 'white', 'orange']
    for i in range(18):
        name = order[i % len(order)]
        text += f'\n[[object]]\nmodel = "{name} band"\ntranslate = [{1.3 * (i - 9) + 0.35:g}, 0, 2.5]\n'
    (folder / 'instances.toml').write_text(text)
