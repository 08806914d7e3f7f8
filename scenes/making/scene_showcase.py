"""A round temple of nine columns on a lake: terraces, a golden knot, water lilies, cypresses, hills."""

import math
import random

from . import png
from .mesh import Mesh, Obj, normalize
from .shapes import arc, box, revolve, sheet, torus_knot
from .scene_glass import smooth

FLOOR = 0.95


def steps():
    profile = [(6.3, -0.6)]
    for r, y in ((6.3, 0.2), (5.6, 0.45), (5.0, 0.7), (4.4, FLOOR)):
        profile += ([(r, y - 0.25)] if r < 6.3 else []) + arc((r - 0.04, y - 0.04), 0.04, 0, 90, 4)
    mesh = revolve(profile + [(0, FLOOR)], 80)
    # Metres along the rim as well, so that stone is of the same size everywhere.
    mesh.uvs = [(u * 24, v * 0.7) for u, v in mesh.uvs]
    return mesh


def column(height=3.4, flutes=16, along=6):
    """A shaft with flutes and entasis, between a turned base and a turned capital."""
    low, high = 0.26, height - 0.3

    def shaft(u, v):
        t = u * flutes
        hollow = 0.5 - 0.5 * math.cos(2 * math.pi * t)
        # Flutes run out at both ends.
        fade = min(1, 12 * v, 12 * (1 - v))
        r = (0.235 - 0.045 * v**1.7) * (1 - 0.1 * fade * hollow**0.7)
        a = 2 * math.pi * u
        return (r * math.sin(a), low + (high - low) * v, r * math.cos(a))

    base = [(0.36, 0), (0.36, 0.08)] + arc((0.3, 0.13), 0.05, -90, 90, 6) + arc((0.27, 0.215), 0.03, -90, 90, 4)
    base += [(0.24, 0.26)]
    top = [(0.19, high)] + arc((0.2, high + 0.025), 0.025, -90, 90, 4)
    top += [(0.2, high + 0.07), (0.22, high + 0.12), (0.27, high + 0.16), (0.34, high + 0.18)]
    obj = Obj('a fluted column, its foot at the origin', digits=3)
    plinth, abacus = box((0.74, 0.06, 0.74), (0, 0.03, 0)), box((0.76, 0.12, 0.76), (0, height - 0.06, 0))
    for part in (sheet(shaft, flutes * along, 8), revolve(base, 48), revolve(top, 48)):
        obj.add(Mesh(part.points, part.faces, part.normals))
    for part in (plinth, abacus):
        obj.add(Mesh(part.points, part.faces))
    return obj


def ring(y=FLOOR + 3.4):
    """The entablature: a moulded beam in a circle."""
    outer = [(3.2, y), (3.92, y), (3.92, y + 0.16), (3.96, y + 0.16), (3.96, y + 0.34), (4.0, y + 0.36)]
    outer += [(4.06, y + 0.44), (4.14, y + 0.5), (4.14, y + 0.58), (3.3, y + 0.6), (3.22, y + 0.5)]
    return revolve(outer + [(3.2, y)], 80)


def rib(radius=3.55, height=2.5, thickness=0.035):
    """A quarter of an ellipse from the ring to the top of an open dome, round in section."""

    def f(u, v):
        a = 0.5 * math.pi * v
        center = (0, height * math.sin(a), radius * math.cos(a))
        out = normalize((0, radius * math.sin(a), height * math.cos(a)))
        b = 2 * math.pi * u
        return tuple(c + thickness * (math.cos(b) * o + math.sin(b) * s)
                     for c, o, s in zip(center, out, (1, 0, 0)))

    return sheet(f, 10, 24)


def pedestal():
    profile = [(0.62, 0), (0.62, 0.12)] + arc((0.5, 0.18), 0.06, -90, 90, 6) + [(0.44, 0.3), (0.4, 0.45)]
    profile += [(0.385, 0.7), (0.39, 0.9)] + arc((0.4, 0.97), 0.05, -90, 90, 6) + [(0.5, 1.06), (0.5, 1.16), (0, 1.16)]
    return revolve(profile, 64)


def amphora():
    outside = [(0, 0), (0.12, 0), (0.13, 0.03), (0.09, 0.09), (0.16, 0.25), (0.25, 0.45), (0.29, 0.62), (0.27, 0.8)]
    outside += [(0.18, 0.95), (0.11, 1.05), (0.1, 1.15), (0.15, 1.25)]
    inside = [(0.13, 1.25), (0.08, 1.15), (0.09, 1.05), (0.16, 0.93), (0.25, 0.78), (0, 0.4)]
    return revolve(smooth(outside) + smooth(inside), 40)


def pad():
    """A lily pad: a disc with a notch, its rim turned up."""

    def f(u, v):
        a = math.radians(14) + u * math.radians(332)
        rise = 0.07 * v**6 + 0.006 * math.sin(9 * a) * v
        r = v * (1 + 0.02 * math.sin(5 * a))
        return (r * math.sin(a), 0.012 + rise, r * math.cos(a))

    return sheet(lambda u, v: f(u, 0.04 + v * 0.96), 32, 4)


def lotus():
    """Rings of pointed petals, the outer ones lying, the inner ones upright."""
    points, faces, normals = [], [], []
    for count, tilt, length, turn in ((9, 18, 0.34, 0), (8, 42, 0.32, 0.5), (6, 64, 0.27, 0.2)):

        def petal(u, v, tilt=tilt, length=length):
            width = 0.36 * length * math.sin(math.pi * v**0.8) + 0.004
            x, lift = (2 * u - 1) * width, math.radians(tilt) + 0.5 * v * v
            cup = 1.1 * x * x / length
            s = v * length
            return (x, 0.03 + s * math.sin(lift) + cup, 0.03 + s * math.cos(lift))

        one = sheet(petal, 4, 6)
        for k in range(count):
            mesh = one.turn('y', 360 * (k + turn) / count)
            base = len(points)
            points += mesh.points
            normals += mesh.normals
            faces += [tuple(base + i for i in face) for face in mesh.faces]
    return Mesh(points, faces, normals)


def cypress():
    def f(u, v):
        a = 2 * math.pi * u
        r = 0.62 * math.sin(math.pi * min(1, v * 1.02) ** 0.62) ** 0.9 + 0.02
        bump = png.fractal(u * 9, v * 22, 9, 3, 7)
        r *= 0.68 + 0.62 * bump
        return (r * math.sin(a), 0.1 + 5.2 * v, r * math.cos(a))

    return sheet(f, 30, 40)


def islet():
    def f(u, v):
        a, r = 2 * math.pi * u, 1 - v
        lobe = 1 + 0.18 * math.sin(2 * a + 1) + 0.1 * math.sin(5 * a)
        height = 0.75 * (1 - r * r) ** 1.3 - 0.12 + 0.12 * png.fractal(4 + 3 * r * math.cos(a), 4 + 3 * r * math.sin(a), 16, 3)
        return (5 * lobe * r * math.sin(a), height, 3.4 * lobe * r * math.cos(a))

    return sheet(lambda u, v: f(u, v * 0.96), 48, 12)


def hills(near, far, height, seed):
    def f(u, v):
        a, r = 2 * math.pi * u, near + (far - near) * v
        rise = math.sin(math.pi * min(1, v * 1.1)) * height
        ridge = max(0, png.fractal(u * 14, v * 3, 14, 4, seed) - 0.3)
        return (r * math.sin(a), -0.5 + rise * (0.02 + 2.4 * ridge), r * math.cos(a))

    return sheet(f, 144, 9)


def mosaic(u, v):
    """A wind rose in four stones."""
    x, y = 2 * u - 1, 2 * v - 1
    r, a = math.hypot(x, y), math.atan2(x, y) / (2 * math.pi)
    stones = ((0.93, 0.9, 0.84), (0.5, 0.22, 0.17), (0.2, 0.27, 0.33), (0.82, 0.66, 0.4))

    def star(points, size, turn):
        """Below 0 within a star; its half-planes' sign tells light from shade."""
        t = ((a * points + turn) % 1) - 0.5
        return r - size * (1 - 1.55 * abs(t)) ** 2.2, t > 0

    stone = 0
    if 0.93 < r < 0.985 or 0.6 < r < 0.63:
        stone = 2
    elif 0.66 < r < 0.9:
        stone = 3 if ((a * 48) % 1 < 0.5) != (r > 0.78) else 0
    for points, size, turn, colors in ((8, 0.57, 0.5, (2, 0)), (4, 0.62, 0.5, (1, 3))):
        inside, lit = star(points, size, turn)
        if inside < 0:
            stone = colors[lit]
    grain = png.fractal(u * 24, v * 24, 24, 3, stone * 11)
    joint = 0.86 if (u * 64) % 1 < 0.08 or (v * 64) % 1 < 0.08 else 1
    return tuple(c * (0.86 + 0.2 * grain) * joint for c in stones[stone])


def travertine(u, v):
    band = png.fractal(u * 3, v * 14, 14, 4, 3)
    pore = png.noise(u * 40, v * 90, 90, 5)
    c = png.mix((0.93, 0.86, 0.75), (0.76, 0.66, 0.53), band**1.4 * 1.1)
    return tuple(x * (0.82 if pore > 0.86 else 1) for x in c)


def ripples(u, v):
    h = png.fractal(u * 5, v * 9, 45, 2, 21)
    h += 0.35 * math.sin(2 * math.pi * (2 * u + 3 * v) + 3 * png.noise(u * 4, v * 4, 4, 2))
    return (min(1, max(0, 0.5 * h + 0.2)),)


def lilies():
    """Places of pads and flowers, in two drifts before the steps."""
    rng = random.Random(11)
    pads, flowers = [], []
    while len(pads) < 90:
        drift = rng.choice(((-5.2, 8.6, 2.6, 1.5), (6.2, 6.6, 2.0, 1.8), (-9.5, 4.5, 2.4, 2.2)))
        x, z = rng.gauss(drift[0], drift[2] * 0.55), rng.gauss(drift[1], drift[3] * 0.55)
        size = rng.uniform(0.22, 0.46)
        if math.hypot(x, z) < 6.9 or any(math.hypot(x - p[0], z - p[1]) < 0.85 * (size + p[2]) for p in pads):
            continue
        pads.append((x, z, size, rng.uniform(0, 360)))
        if rng.random() < 0.13:
            flowers.append((x + 0.6 * size, z - 0.5 * size, rng.uniform(0.7, 1.1), rng.uniform(0, 360)))
    return pads, flowers


def make(folder):
    knot = torus_knot(2, 3, 0.68, 0.3, 0.15, 168, 14).turn('x', 90)
    plain = {
        'ring': ring(), 'rib': rib(), 'pedestal': pedestal(), 'amphora': amphora(), 'pad': pad(), 'lotus': lotus(),
        'cypress': cypress(), 'islet': islet(), 'knot': knot, 'hills': hills(60, 150, 15, 5),
        'mountains': hills(170, 420, 60, 9),
    }
    for name, mesh in plain.items():
        obj = Obj(f'{name}, for the temple on the lake', digits=3)
        obj.add(Mesh(mesh.points, mesh.faces, mesh.normals))
        obj.write(folder / f'{name}.obj')
    column().write(folder / 'column.obj')
    textured = {'steps': steps()}
    n = 96
    rim = [(2 * math.pi * k / n) for k in range(n)]
    points = [(2.7 * math.sin(a), FLOOR + 0.006, 2.7 * math.cos(a)) for a in rim]
    textured['mosaic'] = Mesh(points, [tuple(range(n))], None, [(0.5 + 0.5 * math.sin(a), 0.5 + 0.5 * math.cos(a)) for a in rim])
    for name, mesh in textured.items():
        obj = Obj(f'{name}, for the temple on the lake', digits=3)
        obj.add(mesh)
        obj.write(folder / f'{name}.obj')
    png.write(folder / 'mosaic.png', 384, 384, mosaic)
    png.write(folder / 'travertine.png', 192, 192, travertine)
    png.write(folder / 'ripples.png', 192, 192, ripples)
    pads, flowers = lilies()
    place = lambda p: f'    {{ translate = [{p[0]:.2f}, 0, {p[1]:.2f}], rotate = [0, {p[3]:.0f}, 0], scale = {p[2]:.2f} }},\n'
    text = (folder / 'showcase.toml').read_text()
    for name, places in (('pads', pads), ('flowers', flowers)):
        head, rest = text.split(f'# Made: {name}\ntransforms = [\n')
        text = f'{head}# Made: {name}\ntransforms = [\n' + ''.join(map(place, places)) + rest[rest.index(']\n'):]
    (folder / 'showcase.toml').write_text(text)
