"""Paper lanterns on a lake at night: one lantern of light placed many hundred times, some of them in the air."""

import math
import random

from .mesh import Mesh, Obj
from .shapes import box, revolve, sheet
from . import png

HEAD = """# A feast of lanterns: one small emitter placed many times, over water. Made by making/scene_lanterns.py.

[film]
size = [1280, 720]
exposure = 0

[camera.shore]
from = [0, 2.6, 11]
to = [1.2, 2.3, -10]
perspective = { vertical_fov = 36 }

[[object]]
file = "../shapes/square.obj"
material = "water"
scale = 300

[[object]]
file = "mountains.obj"
material = "mountains"

[material.water.principled]
base_color = [0.004, 0.008, 0.012]
roughness = 0.05
specular = 0.02

[material.water.bump_map]
file = "ripples.png"
scale = [220, 220]
strength = 0.006

[material.mountains.lambert]
albedo = [0.05, 0.06, 0.08]

[material.wood.lambert]
albedo = [0.12, 0.07, 0.04]

[material.yellow]
emission = [3.6, 1.7, 0.42]

[material.orange]
emission = [3.4, 1.0, 0.18]

[material.rose]
emission = [3.0, 0.62, 0.4]

[environment.constant]
radiance = [0.03, 0.045, 0.085]
"""


def make(folder):
    paper = revolve([(0.1, 0.03), (0.125, 0.1), (0.13, 0.18), (0.12, 0.26), (0.1, 0.31)], 10)
    obj = Obj('the paper of a lantern: open above and below')
    obj.add(Mesh(paper.points, paper.faces, paper.normals))
    obj.write(folder / 'paper.obj')
    obj = Obj('the float of a lantern, and its rim')
    for part in (box((0.3, 0.03, 0.3), (0, 0.01, 0)), box((0.03, 0.02, 0.22), (0, 0.315, 0)), box((0.22, 0.02, 0.03), (0, 0.315, 0))):
        obj.add(Mesh(part.points, part.faces))
    obj.write(folder / 'float.obj')

    def ridge(u, v):
        x = 400 * (u - 0.5)
        height = 26 * png.fractal(u * 9, 0.5, 16, 5, 4) ** 1.3 * (0.55 + 0.9 * abs(u - 0.5))
        return (x, -0.2 + 1.7 * height * v, -130 - 40 * v)

    obj = Obj('mountains on the other shore', digits=2)
    ridges = sheet(ridge, 160, 3)
    obj.add(Mesh(ridges.points, ridges.faces))
    obj.write(folder / 'mountains.obj')

    def ripples(u, v):
        h = 0.6 * png.fractal(u * 4, v * 10, 40, 2, 2) + 0.25 * math.sin(2 * math.pi * (u + 4 * v) + 4 * png.noise(u * 3, v * 3, 3, 8))
        return (min(1, max(0, h + 0.2)),)

    png.write(folder / 'ripples.png', 128, 128, ripples)

    rng = random.Random(77)
    places = {'yellow': [], 'orange': [], 'rose': []}
    kept = []
    while len(kept) < 900:
        # The drift widens with the distance and follows a bend.
        s = rng.random() ** 0.75
        z = 5.5 - 95 * s
        x = 7 * math.sin(0.05 * z + 0.6) + rng.gauss(0, 2.2 + 0.2 * abs(z))
        if any((x - a) ** 2 + (z - b) ** 2 < 0.36**2 for a, b in kept[-300:]) or (abs(x) < 0.8 and z > 4):
            continue
        kept.append((x, z))
        scale = rng.uniform(0.8, 1.25)
        tint = rng.choices(list(places), (5, 4, 1))[0]
        places[tint].append((x, 0, z, rng.uniform(0, 90), scale))
    for _ in range(160):
        z = -8 - 75 * rng.random()
        rise = rng.random() ** 1.5
        x = 7 * math.sin(0.05 * z + 0.6) + 14 * rise + rng.gauss(0, 5)
        places[rng.choice(['yellow', 'orange'])].append((x, 3 + 26 * rise, z, rng.uniform(0, 90), 1.4))

    text = HEAD
    for tint in places:
        text += f'\n[[model.{tint}.object]]\nfile = "paper.obj"\nmaterial = "{tint}"\n'
        text += f'\n[[model.{tint}.object]]\nfile = "float.obj"\nmaterial = "wood"\n'
    for tint, list_ in places.items():
        text += f'\n[[object]]\nmodel = "{tint}"\ntransforms = [\n'
        for x, y, z, turn, scale in list_:
            text += f'    {{ translate = [{x:.2f}, {y:.3g}, {z:.2f}], rotate = [0, {turn:.0f}, 0], scale = {scale:.2f} }},\n'
        text += ']\n'
    (folder / 'lanterns.toml').write_text(text)
