"""A room with a brick wall, a window to the sun, and plants whose leaves are cut out of cards by textures."""

import math
import random

from . import png
from .mesh import Mesh, Obj, normalize
from .shapes import arc, box, revolve, sheet, sphere
from .scene_glass import smooth

WIDTH, HEIGHT, BACK, FRONT = 2.6, 2.8, -2.2, 3.4

MTL = """# A room. Colours come from textures where there is one.
newmtl planks
Kd 1 1 1
Ks 0.04 0.04 0.04
Pr 0.38
map_Kd planks.png
newmtl brick
Kd 1 1 1
map_Kd brick.png
norm brick_normal.png
newmtl plaster
Kd 0.75 0.71 0.64
newmtl paint
Kd 0.78 0.78 0.76
Ks 0.04 0.04 0.04
Pr 0.3
newmtl rug
Kd 1 1 1
map_Kd rug.png
map_Bump -bm 0.04 -s 24 16 1 weave.png
newmtl walnut
Kd 0.19 0.1 0.055
Ks 0.04 0.04 0.04
Pr 0.32
newmtl oak
Kd 0.48 0.33 0.19
Ks 0.04 0.04 0.04
Pr 0.4
newmtl terracotta
Kd 0.5 0.2 0.11
newmtl earth
Kd 0.06 0.042 0.03
newmtl monstera
Kd 1 1 1
Ks 0.04 0.04 0.04
Pr 0.35
map_Kd monstera.png
map_d monstera_mask.png
newmtl ivy
Kd 1 1 1
map_Kd ivy.png
newmtl stalk
Kd 0.1 0.17 0.05
newmtl glass
Kd 0 0 0
Ks 1 1 1
Tf 1 1 1
Ni 1.5
illum 7
newmtl orange
Kd 0.85 0.34 0.03
Ks 0.04 0.04 0.04
Pr 0.4
newmtl porcelain
Kd 0.75 0.77 0.78
Ks 0.04 0.04 0.04
Pr 0.12
newmtl canvas
Kd 1 1 1
map_Kd canvas.png
newmtl brass
Kd 0.75 0.52 0.2
Pm 1
Pr 0.25
newmtl bulb
Kd 0 0 0
Ke 26 16 8
newmtl book1
Kd 0.42 0.09 0.07
newmtl book2
Kd 0.07 0.16 0.22
newmtl book3
Kd 0.62 0.5 0.3
newmtl book4
Kd 0.1 0.2 0.12
newmtl paper
Kd 0.75 0.7 0.6
"""


def wall(corner, u, v, meters):
    """A rectangle with texture coordinates in repetitions of `meters`."""
    add = lambda *vectors: tuple(math.fsum(c) for c in zip(*vectors))
    length = lambda w: math.sqrt(math.fsum(x * x for x in w)) / meters
    points = [corner, add(corner, u), add(corner, u, v), add(corner, v)]
    return Mesh(points, [(0, 1, 2, 3)], None, [(0, 0), (length(u), 0), (length(u), length(v)), (0, length(v))])


def shell(obj):
    w, h, depth = WIDTH, HEIGHT, FRONT - BACK
    obj.add(wall((-w, 0, FRONT), (2 * w, 0, 0), (0, 0, -depth), 1.6), 'planks', 'floor')
    obj.add(wall((-w, 0, BACK), (2 * w, 0, 0), (0, h, 0), 1.2), 'brick', 'back')
    obj.add(wall((w, 0, BACK), (0, 0, depth), (0, h, 0), 1), 'plaster', 'walls')
    obj.add(wall((-w, h, BACK), (2 * w, 0, 0), (0, 0, depth), 1))
    # The left wall is 25 cm thick around the window.
    low, high, near, far, thick = 0.85, 2.35, 0.9, -1.35, 0.25
    for z0, z1, y0, y1 in ((FRONT, near, 0, h), (near, far, 0, low), (near, far, high, h), (far, BACK, 0, h)):
        obj.add(wall((-w, y0, z0), (0, 0, z1 - z0), (0, y1 - y0, 0), 1))
    for corner, u, v in (((-w, low, near), (0, 0, far - near), (-thick, 0, 0)), ((-w, high, far), (0, 0, near - far), (-thick, 0, 0)),
                         ((-w, low, far), (0, high - low, 0), (-thick, 0, 0)), ((-w, high, near), (0, low - high, 0), (-thick, 0, 0))):
        obj.add(wall(corner, u, v, 1))
    # Bars of the window, its sill, and two beams.
    x = -w - 0.18
    for z in (near - 0.04, (near + far) / 2, far + 0.04):
        plain(obj, box((0.06, high - low, 0.06), (x, (low + high) / 2, z)), 'paint')
    for y in (low + 0.03, low + 0.95, high - 0.03):
        plain(obj, box((0.05, 0.05, near - far), (x, y, (near + far) / 2)), 'paint')
    plain(obj, box((0.36, 0.04, near - far + 0.2), (-w - 0.04, low - 0.02, (near + far) / 2)), 'oak')
    for z in (-0.9, 1.1):
        plain(obj, box((2 * w, 0.2, 0.18), (0, h - 0.1, z)), 'oak')
    plain(obj, box((2 * w, 0.1, 0.02), (0, 0.05, BACK + 0.01)), 'paint')


def plain(obj, mesh, material, name=None):
    obj.add(Mesh(mesh.points, mesh.faces, mesh.normals), material, name)


def table(obj):
    x, z = 0.55, -0.55
    top = revolve([(0, 0.7), (0.6, 0.7)] + arc((0.6, 0.72), 0.02, -90, 90, 4) + [(0, 0.74)], 48)
    plain(obj, top.move(x, 0, z), 'walnut', 'table')
    for k in range(3):
        leg = revolve([(0.016, 0), (0.02, 0.2), (0.028, 0.7)], 16).turn('x', 9).move(0, 0, 0.47)
        plain(obj, leg.turn('y', 120 * k + 15).move(x, 0, z), 'walnut')
    # A glass vase with a wall, a bowl of oranges, a cup.
    outside = smooth([(0, 0), (0.07, 0), (0.085, 0.03), (0.09, 0.1), (0.065, 0.19), (0.045, 0.25), (0.06, 0.31)])
    inside = smooth([(0.055, 0.308), (0.04, 0.25), (0.059, 0.19), (0.083, 0.1), (0.075, 0.04), (0, 0.025)])
    plain(obj, revolve(outside + inside, 40).move(x - 0.3, 0.74, z - 0.1), 'glass', 'vase')
    bowl = smooth([(0, 0), (0.07, 0), (0.08, 0.015), (0.15, 0.06), (0.185, 0.11)])
    bowl += smooth([(0.178, 0.112), (0.143, 0.067), (0.07, 0.025), (0, 0.02)])
    plain(obj, revolve(bowl, 40).move(x + 0.2, 0.74, z + 0.05), 'porcelain', 'bowl')
    fruit = sphere(20, 10).scale(0.052, 0.049, 0.052)
    for dx, dy, dz in ((-0.06, 0.09, 0.03), (0.06, 0.09, 0.05), (0.01, 0.09, -0.07), (0.005, 0.165, 0.005)):
        plain(obj, fruit.move(x + 0.2 + dx, 0.74 + dy, z + 0.05 + dz), 'orange')
    cup = smooth([(0, 0), (0.03, 0), (0.038, 0.02), (0.04, 0.07)]) + smooth([(0.036, 0.07), (0.034, 0.02), (0, 0.012)])
    plain(obj, revolve(cup, 28).move(x - 0.02, 0.74, z + 0.38), 'porcelain', 'cup')
    for k, (size, turn) in enumerate((((0.24, 0.03, 0.17), 12), ((0.21, 0.025, 0.15), -8))):
        book(obj, size, turn, (x - 0.22, 0.755 + 0.028 * k, z + 0.24), f'book{2 - k}')


def book(obj, size, turn, place, cover):
    w, h, d = size
    for mesh, material in ((box((w, h, d)), cover), (box((w - 0.006, h - 0.008, d - 0.008), (0.005, 0, 0)), 'paper')):
        plain(obj, mesh.turn('y', turn).move(*place), material)


def shelf(obj, rng):
    plain(obj, box((1.5, 0.035, 0.24), (1.55, 1.75, BACK + 0.12)), 'oak', 'shelf')
    x = 0.95
    while x < 1.78:
        thick, tall = rng.uniform(0.02, 0.05), rng.uniform(0.18, 0.27)
        lean = rng.choice((0, 0, 0, 7))
        x += thick / 2 + 0.16 * math.tan(math.radians(lean)) / 2
        mesh = box((thick, tall, 0.16)).turn('z', lean).move(x, 1.7675 + tall / 2, BACK + 0.11)
        plain(obj, mesh, f'book{rng.randint(1, 4)}')
        x += thick / 2 + 0.003 + 0.16 * math.tan(math.radians(lean)) / 2
    # A pot on the shelf, and ivy that hangs from it.
    pot = smooth([(0, 0), (0.06, 0), (0.09, 0.13)]) + [(0.095, 0.13), (0.095, 0.15), (0.08, 0.15), (0.078, 0.13), (0, 0.13)]
    plain(obj, revolve(pot, 32).move(2.08, 1.7675, BACK + 0.13), 'terracotta')
    for vine in range(11):
        a = rng.uniform(-1.9, 1.9)
        length = rng.uniform(0.25, 1.05)
        for k in range(int(length * 26)):
            t = k / 26
            out = 0.09 + 0.11 * min(1, t * 5) + 0.02 * math.sin(9 * t + vine)
            x, z = 2.08 + out * math.sin(a) + rng.gauss(0, 0.02), BACK + 0.13 + out * abs(math.cos(a)) + rng.gauss(0, 0.015)
            y = 1.93 + 0.05 * math.sin(min(1, t * 5) * math.pi) - max(0, t - 0.12) * 1.05
            size = rng.uniform(0.03, 0.055)
            leaf = sheet(lambda u, v: ((u - 0.5), -(v - 0.1), 0.25 * (0.25 - (u - 0.5) ** 2) + 0.2 * v * v), 2, 2)
            leaf = leaf.scale(size * 2).turn('x', rng.gauss(-12, 16)).turn('z', rng.gauss(0, 30)).turn('y', rng.gauss(0, 35))
            leaf.uvs = [(u, 1 - v) for u, v in leaf.uvs]
            obj.add(leaf.move(x, y, max(z, BACK + 0.03)), 'ivy')


def monstera(obj, rng):
    x, z = -1.75, -1.25
    pot = smooth([(0, 0), (0.16, 0), (0.19, 0.2), (0.22, 0.36)]) + [(0.235, 0.36), (0.235, 0.41), (0.2, 0.41), (0.195, 0.36)]
    plain(obj, revolve(pot + [(0, 0.36)], 40).move(x, 0, z), 'terracotta', 'monstera')
    plain(obj, revolve([(0.2, 0.362), (0, 0.372)], 24).move(x, 0, z), 'earth')
    for k in range(17):
        turn = 137.5 * k + rng.uniform(-15, 15)
        reach, rise = 0.25 + 0.5 * rng.random(), 0.55 + 0.065 * k + rng.uniform(-0.1, 0.1)
        # The stalk, then the blade at its end, hanging outward.
        points = [(0.02, 0.36), (0.25 * reach, 0.36 + 0.6 * rise), (reach, 0.36 + rise)]

        def curve(t):
            (a, b), (c, d), (e, f) = points
            s = 1 - t
            return (s * s * a + 2 * s * t * c + t * t * e, s * s * b + 2 * s * t * d + t * t * f)

        def stalk(u, v):
            r, y = curve(v)
            w = 2 * math.pi * u
            return (0.008 * math.sin(w), y, r + 0.008 * math.cos(w))

        plain(obj, sheet(stalk, 6, 8).turn('y', turn).move(x, 0, z), 'stalk')
        size = rng.uniform(0.34, 0.5)
        tip, droop = curve(1), rng.uniform(25, 65)

        def blade(u, v):
            a, s = u - 0.5, v
            return (a * size, -0.16 * size * (s * s) - 0.22 * size * a * a * 4 * 0.5, s * size)

        mesh = sheet(blade, 6, 6).turn('x', droop).turn('z', rng.gauss(0, 14))
        obj.add(mesh.move(0, tip[1], tip[0] - 0.03).turn('y', turn).move(x, 0, z), 'monstera')


def picture(obj):
    x, y, z, w, h = -0.55, 1.75, BACK + 0.03, 1.05, 0.7
    points = [(x - w / 2, y - h / 2, z), (x + w / 2, y - h / 2, z), (x + w / 2, y + h / 2, z), (x - w / 2, y + h / 2, z)]
    obj.add(Mesh(points, [(0, 1, 2, 3)], None, [(0, 0), (1, 0), (1, 1), (0, 1)]), 'canvas', 'picture')
    for size, center in (((w + 0.1, 0.05, 0.05), (x, y - h / 2 - 0.025, z)), ((w + 0.1, 0.05, 0.05), (x, y + h / 2 + 0.025, z)),
                         ((0.05, h, 0.05), (x - w / 2 - 0.025, y, z)), ((0.05, h, 0.05), (x + w / 2 + 0.025, y, z))):
        plain(obj, box(size, center), 'walnut')


def pendant(obj):
    x, z, y = 0.55, -0.55, 1.62
    shade = smooth([(0.19, 0), (0.185, 0.03), (0.15, 0.11), (0.07, 0.17), (0.03, 0.2)])
    inner = [(r - 0.006, h - 0.002) for r, h in reversed(shade)]
    plain(obj, revolve(shade + inner, 48).move(x, y, z), 'brass', 'lamp')
    plain(obj, revolve([(0.004, 0.2), (0.004, HEIGHT - y)], 8).move(x, y, z), 'walnut')
    plain(obj, sphere(16, 10).scale(0.035).move(x, y + 0.07, z), 'bulb')


def planks(u, v):
    """Boards along v, five of them wide, with a joint each."""
    board = math.floor(u * 6)
    shift = png.hash01(board, 3)
    along = (v + shift) % 1
    piece = board * 7 + (along > 0.5)
    tone = png.hash01(piece, 9)
    grain = png.fractal(u * 60 + 13 * tone, (along * 4) + 7 * tone, 64, 3, piece)
    ring = 0.5 + 0.5 * math.sin(50 * (u * 6 % 1) * 0.3 + 9 * grain + 6 * tone)
    c = png.mix((0.5, 0.33, 0.19), (0.68, 0.5, 0.32), 0.55 * tone + 0.3 * ring)
    edge = min((u * 6) % 1, 1 - (u * 6) % 1) < 0.018 or along % 0.5 < 0.006
    return tuple(x * (0.35 if edge else 0.86 + 0.2 * grain) for x in c)


def brick_at(u, v):
    """(brick number, distance to its edge in bricks' heights) in a bond of 5 by 16."""
    row = math.floor(v * 16)
    s = u * 5 + (0.5 if row % 2 else 0)
    column = math.floor(s) % 5
    du, dv = s - math.floor(s), v * 16 - row
    edge = min(min(du, 1 - du) * 3.2, min(dv, 1 - dv))
    return row * 5 + column, edge + 0.05 * (png.noise(u * 60, v * 60, 60, 2) - 0.5)


def brick(u, v):
    number, edge = brick_at(u, v)
    tone, grain = png.hash01(number, 5), png.fractal(u * 32, v * 32, 32, 3, 1)
    if edge < 0.09:
        return png.mix((0.62, 0.58, 0.52), (0.48, 0.44, 0.39), grain)
    c = png.mix((0.66, 0.37, 0.28), (0.47, 0.25, 0.2), tone)
    return tuple(x * (0.75 + 0.4 * grain) for x in png.mix(c, (0.72, 0.55, 0.45), 0.3 * png.hash01(number, 6)))


def brick_height(u, v):
    number, edge = brick_at(u % 1, v % 1)
    rise = min(1, max(0, (edge - 0.06) / 0.1))
    return 0.011 * rise * rise * (3 - 2 * rise) + 0.004 * png.fractal(u * 32, v * 32, 32, 2, 1) + 0.003 * png.hash01(number, 8) * rise


def rug(u, v):
    """Nested lozenges in a border."""
    red, cream, blue, ink = (0.55, 0.13, 0.1), (0.85, 0.77, 0.62), (0.12, 0.23, 0.33), (0.09, 0.07, 0.08)
    border = min(u * 1.5, (1 - u) * 1.5, v, 1 - v)
    if border < 0.035:
        c = cream
    elif border < 0.12:
        c = blue if (int(u * 36) + int(v * 24)) % 2 else ink
    elif border < 0.145:
        c = cream
    else:
        d = abs((u * 3) % 1 - 0.5) + abs((v * 2) % 1 - 0.5)
        c = (red, cream, red, blue, cream, red)[min(5, int(d * 6.5))]
        if border < 0.16:
            c = ink
    return tuple(x * (0.8 + 0.3 * png.fractal(u * 48, v * 32, 48, 2, 4)) for x in c)


def weave(u, v):
    return (0.25 + 0.25 * math.cos(2 * math.pi * 4 * u) * math.cos(2 * math.pi * 4 * v) + 0.4 * png.noise(u * 16, v * 16, 16, 6),)


def monstera_shape(u, v):
    """Below 1 inside of the leaf: a heart with slits between its veins. v runs from stalk to tip."""
    x, y = 2 * u - 1, 1.06 - 1.1 * v
    # A heart in polar coordinates about its middle.
    a = math.atan2(abs(x), y - 0.42)
    r = math.hypot(x, y - 0.42)
    heart = 0.8 + 0.16 * math.sin(a)
    notch = 0.42 * math.exp(-((a / 0.28) ** 2))
    lobes = 1 - 0.05 * math.cos(18 * a)
    edge = (heart - notch) * lobes
    # Slits run from the rim inward along the veins.
    slit = abs(((a * 2.6) % 1) - 0.5) < 0.09 * min(1, max(0, (r - 0.32) * 2.5))
    return r / edge + (2 if slit and 0.45 < a < 2.75 else 0)


def monstera_mask(u, v):
    return (1.0 if monstera_shape(u, v) < 1 else 0.0,)


def monstera_color(u, v):
    x, y = 2 * u - 1, 1.06 - 1.1 * v
    vein = min(abs(x) * 6, abs(((abs(x) * 1.2 + y * 1.1) * 4.5) % 1 - 0.5) * 5)
    c = png.mix((0.34, 0.52, 0.24), (0.14, 0.36, 0.12), min(1, vein))
    return tuple(t * (0.85 + 0.25 * png.fractal(u * 8, v * 8, 8, 3, 2)) for t in c)


def ivy(u, v):
    x, y = 2 * u - 1, 2 * v - 1
    a, r = math.atan2(x, -y), math.hypot(x, y)
    edge = 0.42 + 0.42 * abs(math.cos(2.5 * a)) ** 1.3
    vein = abs(math.cos(2.5 * a)) > 0.985 and r < 0.8 * edge
    c = png.mix((0.2, 0.42, 0.13), (0.32, 0.5, 0.2), png.fractal(u * 6, v * 6, 6, 2, 5))
    return (*((0.6, 0.7, 0.4) if vein else c), 1.0 if r < edge else 0.0)


def canvas(u, v):
    """Hills at dusk."""
    c = png.mix((0.96, 0.72, 0.42), (0.34, 0.43, 0.6), v**0.8)
    if math.hypot(u * 1.5 - 1.02, v - 0.56) < 0.075:
        c = (1.0, 0.93, 0.75)
    for k, (base, tint) in enumerate(((0.52, (0.58, 0.5, 0.58)), (0.4, (0.4, 0.36, 0.46)), (0.27, (0.23, 0.25, 0.32)), (0.14, (0.11, 0.14, 0.17)))):
        if v < base + 0.2 * (png.fractal(u * (3 + k), 0.5, 16, 4, 30 + k) - 0.5):
            c = tint
    stroke = png.fractal(u * 30 + 4 * v, v * 60, 128, 2, 3)
    return tuple(x * (0.9 + 0.2 * stroke) for x in c)


def make(folder):
    rng = random.Random(8)
    obj = Obj('a room; metres', 'room.mtl', digits=3)
    shell(obj)
    rug_sheet = sheet(lambda u, v: (0.45 + 2.1 * (u - 0.5), 0.008 + 0.004 * math.sin(9 * u) * math.sin(7 * v), -0.05 - 1.4 * (v - 0.5)), 12, 8)
    obj.add(rug_sheet, 'rug', 'rug')
    table(obj)
    shelf(obj, rng)
    monstera(obj, rng)
    picture(obj)
    pendant(obj)
    obj.write(folder / 'room.obj')
    (folder / 'room.mtl').write_text(MTL)
    png.write(folder / 'planks.png', 256, 256, planks)
    png.write(folder / 'brick.png', 224, 224, brick)
    png.write(folder / 'brick_normal.png', 224, 224, lambda u, v: png.normal_map(brick_height, u, v, 1 / 448))
    png.write(folder / 'rug.png', 240, 160, rug)
    png.write(folder / 'weave.png', 32, 32, weave)
    png.write(folder / 'monstera.png', 96, 96, monstera_color)
    png.write(folder / 'monstera_mask.png', 192, 192, monstera_mask)
    png.write(folder / 'ivy.png', 64, 64, ivy)
    png.write(folder / 'canvas.png', 192, 128, canvas)
