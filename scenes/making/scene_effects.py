"""A still life for scenes that call for one effect each, and what some of them show instead of it."""

import math

from . import hdr, png
from .mesh import Mesh, Obj
from .shapes import arc, box, extrude, revolve, sheet, sphere, tube

STILL_MTL = """# The still life; the ball in its middle comes from the scene files.
newmtl cube
Kd 0.1 0.26 0.52
newmtl cone
Kd 0.8 0.5 0.09
newmtl ring
Kd 0.62 0.11 0.08
"""

BALL_MTL = """# The colours come from the texture.
newmtl globe
Kd 1 1 1
map_Kd globe.png
"""

SOLIDS_MTL = """# No face shows any of these but the first: nothing else may be called for.
newmtl clay
Kd 0.6 0.38 0.27
newmtl glass
illum 7
Ni 1.5
newmtl silver
illum 3
Kd 0 0 0
Ks 0.95 0.95 0.95
newmtl lacquer
Kd 0.5 0.05 0.03
Ks 0.5 0.5 0.5
Pr 0.2
newmtl lamp
Kd 0 0 0
Ke 40 40 40
newmtl globe
Kd 1 1 1
map_Kd globe.png
newmtl lattice
Kd 0.5 0.5 0.5
map_d lattice.png
newmtl veil
Kd 0.5 0.5 0.5
d 0.5
newmtl tiles
Kd 0.5 0.5 0.5
norm tiles_normal.png
newmtl sand
Kd 0.5 0.5 0.5
map_Bump -bm 0.02 sand.png
"""

TREE_MTL = """# A fir.
newmtl needles
Kd 0.09 0.24 0.1
newmtl trunk
Kd 0.22 0.12 0.06
"""

HILLS_MTL = """# Hills at dusk: they emit and reflect nothing.
newmtl hills0
Kd 0 0 0
Ke 0.5 0.19 0.2
newmtl hills1
Kd 0 0 0
Ke 0.26 0.085 0.17
newmtl hills2
Kd 0 0 0
Ke 0.095 0.035 0.11
newmtl hills3
Kd 0 0 0
Ke 0.02 0.012 0.04
"""

# From red by way of yellow and blue back to red.
HUES = ((0.72, 0.1, 0.08), (0.8, 0.3, 0.05), (0.82, 0.58, 0.08), (0.25, 0.5, 0.14), (0.06, 0.42, 0.42), (0.1, 0.24, 0.56),
        (0.32, 0.14, 0.48), (0.62, 0.1, 0.3))


def dome():
    """A floor that turns into a dome over everything, seen from inside: light of a single lamp reaches all of it."""
    profile = [(0, 0), (6, 0), (8, 0)] + arc((8, 2), 2, -90, 0, 4)[1:] + arc((0, 2), 10, 0, 90, 8)[1:]
    mesh = revolve([(max(r, 0), y) for r, y in profile[:-1]] + [(0, 12)], 32).flip()
    return Mesh(mesh.points, mesh.faces, mesh.normals)


def ring(radius, thickness, count, sides):
    """A ring that lies on the ground."""

    def curve(t):
        a = 2 * math.pi * t
        return (radius * math.sin(a), thickness, radius * math.cos(a))

    mesh = tube(curve, count, sides, thickness)
    return Mesh(mesh.points, mesh.faces, mesh.normals)


def still():
    """A cube, a cone and a ring around a place for a ball of radius 0.7 at (0, 0.7, 0)."""
    obj = Obj('a still life', 'still.mtl', digits=3)
    cube = box((1.1, 1.1, 1.1), (0, 0.55, 0)).turn('y', 28).move(-1.5, 0, -0.45)
    cone = revolve([(0, 0), (0.64, 0), (0, 1.55)], 40).move(1.5, 0, -0.55)
    for name, mesh in (('cube', Mesh(cube.points, cube.faces)), ('cone', Mesh(cone.points, cone.faces, cone.normals)),
                       ('ring', ring(0.37, 0.13, 32, 12).move(0.98, 0, 0.95))):
        obj.add(mesh, name, name)
    return obj


def platonic():
    """Tetrahedron, cube, octahedron, dodecahedron, icosahedron as (points, faces)."""
    g = (1 + math.sqrt(5)) / 2
    signs = [(a, b) for a in (-1, 1) for b in (-1, 1)]
    cube = [(a, b, c) for a in (-1, 1) for b, c in signs]
    rectangles = lambda p, q: [v for a, b in signs for v in ((0, a * p, b * q), (b * q, 0, a * p), (a * p, b * q, 0))]
    corners = [
        [p for p in cube if p[0] * p[1] * p[2] > 0],
        cube,
        [tuple(s if k == axis else 0 for k in range(3)) for axis in range(3) for s in (-1, 1)],
        cube + rectangles(1 / g, g),
        rectangles(1, g),
    ]
    return [(points, hull(points)) for points in corners]


def hull(points):
    """The faces of a regular solid about the origin: for each direction of one its corners in order."""
    dot = lambda a, b: math.fsum(x * y for x, y in zip(a, b))
    faces = {}
    for i, a in enumerate(points):
        for j, b in enumerate(points[:i]):
            for c in points[:j]:
                u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
                n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
                n = n if dot(n, a) > 0 else tuple(-x for x in n)
                on_it = tuple(k for k, p in enumerate(points) if abs(dot(n, p) - dot(n, a)) < 1e-9)
                if max(dot(n, p) for p in points) < dot(n, a) + 1e-9:
                    faces[on_it] = n
    result = []
    for face, n in sorted(faces.items()):
        center = [math.fsum(points[k][axis] for k in face) / len(face) for axis in range(3)]
        east = [x - y for x, y in zip(points[face[0]], center)]
        north = (n[1] * east[2] - n[2] * east[1], n[2] * east[0] - n[0] * east[2], n[0] * east[1] - n[1] * east[0])
        size = math.sqrt(dot(north, north) / dot(east, east))

        def angle(k):
            p = [x - y for x, y in zip(points[k], center)]
            return math.atan2(dot(p, north) / size, dot(p, east)) % (2 * math.pi - 1e-6)

        result.append(tuple(sorted(face, key=angle)))
    return result


def solids():
    """The five regular solids, each lying on a face, in a half circle."""
    obj = Obj('the five regular solids', 'solids.mtl')
    # That a material is named does not mean that a face shows it.
    obj.lines += ['usemtl lamp', 'usemtl clay']
    obj.material = 'clay'
    for i, (points, faces) in enumerate(platonic()):
        apart = Mesh([points[k] for face in faces for k in face], [])
        start = 0
        for face in faces:
            apart.faces.append(tuple(range(start, start + len(face))))
            start += len(face)
        # The first face goes down: its normal, the mean of its corners, is turned to -y.
        x, y, z = (math.fsum(points[k][axis] for k in faces[0]) for axis in range(3))
        mesh = apart.turn('y', math.degrees(math.atan2(z, x)))
        mesh = mesh.turn('z', -90 - math.degrees(math.atan2(y, math.hypot(x, z))))
        size = (0.78, 0.56, 0.72, 0.66, 0.66)[i] / math.dist(points[0], (0, 0, 0))
        if i == 1:
            size *= math.sqrt(4 / 3)
        mesh = mesh.scale(size).turn('y', (20, 30, 10, 0, 40)[i])
        a = math.radians(33 * (i - 2))
        mesh = mesh.move(2.75 * math.sin(a), -min(p[1] for p in mesh.points), 0.9 - 1.7 * math.cos(a))
        obj.add(mesh, name=('tetrahedron', 'cube', 'octahedron', 'dodecahedron', 'icosahedron')[i])
    return obj


def dominoes():
    """A line of stones that winds away."""
    obj = Obj('a line of dominoes', 'dominoes.mtl', digits=3)
    place = lambda t: (1.25 * math.sin(t / 1.55 + 0.5), 2.4 - 1.02 * t)
    for k in range(26):
        t = 0.4 * k - 0.6
        (x, z), (x1, z1) = place(t), place(t + 0.01)
        stone = box((0.5, 1, 0.13), (0, 0.5, 0)).turn('y', math.degrees(math.atan2(x1 - x, z1 - z)))
        obj.add(Mesh(stone.move(x, 0, z).points, stone.faces), f'hue{k % len(HUES)}')
    colors = (f'newmtl hue{i}\nKd {r} {g} {b}\n' for i, (r, g, b) in enumerate(HUES))
    return obj, '# A circle of hues.\n' + ''.join(colors)


def tree():
    obj = Obj('a fir, 1.6 high', 'tree.mtl', digits=3)
    trunk = revolve([(0.09, 0), (0.08, 0.4)], 8)
    obj.add(Mesh(trunk.points, trunk.faces, trunk.normals), 'trunk')
    for low, high, r in ((0.3, 0.95, 0.5), (0.65, 1.3, 0.4), (1.0, 1.6, 0.28)):
        skirt = revolve([(0, low + 0.06), (r, low), (0, high)], 14)
        obj.add(Mesh(skirt.points, skirt.faces, skirt.normals), 'needles')
    return obj


def hills():
    """Four ridges one behind the other, each an outline filled down to below the ground."""
    obj = Obj('hills, one behind the other', 'hills.mtl', digits=2)
    for k, (z, base, rise) in enumerate(((-9, 1.9, 3.0), (-7, 0.9, 2.5), (-5, 0.2, 1.9), (-3, -0.25, 1.4))):
        xs = [20 * (i / 60 - 0.5) for i in range(61)]
        top = [(x, base + rise * (png.fractal(x * (0.22 + 0.07 * k) + 20, 0.5, 64, 5, 40 + k) - 0.5), z) for x in xs]
        faces = [(i, i + 1, 61 + i + 1, 61 + i) for i in range(60)]
        obj.add(Mesh([(x, -4, z) for x in xs] + top, faces), f'hills{k}')
    return obj


def globe(u, v):
    """A planet: seas, continents, ice and a net of meridians."""
    a, b = 2 * math.pi * u, math.pi * (v - 0.5)
    x, y, z = math.cos(b) * math.sin(a), math.sin(b), math.cos(b) * math.cos(a)
    # Two slices of plane noise make one of space that closes around the globe.
    land = png.fractal(2.2 * x + 8, 2.2 * y + 2.2 * z + 8, 64, 4, 11) + png.fractal(2.2 * z + 8, 2.2 * y - 2.2 * x + 8, 64, 4, 12)
    ice = abs(y) + 0.16 * (land - 1)
    if abs(12 * u - round(12 * u)) < 0.03 or abs(6 * v - round(6 * v)) < 0.03:
        return (0.93, 0.9, 0.8)
    if ice > 0.93:
        return (0.93, 0.95, 0.97)
    if land < 1.03:
        return png.mix((0.1, 0.28, 0.5), (0.2, 0.5, 0.66), max(0, 1 - 6 * (1.03 - land)))
    return png.mix((0.42, 0.56, 0.24), (0.8, 0.66, 0.4), min(1, 5 * (land - 1.03)))


def checks(u, v):
    """Two stones by two, each with a tone of its own."""
    i, j = int(2 * u), int(2 * v)
    c = ((0.86, 0.82, 0.74), (0.5, 0.36, 0.3))[(i + j) % 2]
    edge = min(2 * u % 1, 1 - 2 * u % 1, 2 * v % 1, 1 - 2 * v % 1) < 0.03
    return tuple(x * (0.6 if edge else 0.88 + 0.2 * png.fractal(u * 8, v * 8, 8, 3, i + 2 * j)) for x in c)


def tiles(u, v):
    """Heights of four pillows and a round stud where they meet; repeats."""
    x, y = 2 * u % 1, 2 * v % 1
    edge = min(x, 1 - x, y, 1 - y)
    pillow = 1 - max(0, 1 - edge / 0.16) ** 2
    stud = max(0, 1 - (math.hypot(min(x, 1 - x), min(y, 1 - y)) / 0.24) ** 2)
    inner = math.hypot(x - 0.5, y - 0.5)
    boss = max(0, 1 - ((inner - 0.2) / 0.07) ** 2)
    return 0.045 * pillow + 0.06 * math.sqrt(stud) + 0.022 * boss


def sand(u, v):
    """Heights of raked sand: furrows around the places of three stones, straight ones elsewhere."""
    x, z = 8 * (u - 0.5), 8 * (0.5 - v)
    stones = ((-1.15, -0.6, 0.72), (0.95, -0.15, 0.5), (0.1, 0.95, 0.32))
    near = min(math.hypot(x - a, z - b) - r for a, b, r in stones)
    way = near if near < 0.75 else z
    return (0.5 + 0.5 * math.cos(2 * math.pi * way / 0.25),)


def lattice(u, v):
    """A screen of eight-pointed stars, its holes in the alpha channel."""
    x, y = abs(2 * u - 1), abs(2 * v - 1)
    is_hole = min(max(x, y), (x + y) / math.sqrt(2)) < 0.62 or math.hypot(1 - x, 1 - y) < 0.24
    return (1.0, 1.0, 1.0, 0.0 if is_hole else 1.0)


def smooth(t):
    """From 0 to 1 without a corner."""
    t = max(0, min(1, t))
    return t * t * (3 - 2 * t)


def studio(u, v):
    """Dusk around a studio: a glow above a dark floor, and three soft boxes with blurred edges."""
    floor, glow, top = (0.035, 0.045, 0.06), (0.75, 0.36, 0.18), (0.1, 0.16, 0.3)
    color = png.mix(png.mix(floor, glow, smooth((v - 0.36) / 0.13)), top, smooth((v - 0.5) / 0.22))
    for left, right, low, high, light in ((0.08, 0.24, 0.58, 0.84, (13, 11, 8.5)), (0.74, 0.8, 0.5, 0.84, (3, 4.4, 7)),
                                          (0.34, 0.66, 0.86, 0.95, (2.5, 2.5, 2.5))):
        inside = min(u - left, right - u, (v - low) / 2, (high - v) / 2) / 0.016
        color = [c + b * smooth(inside) for c, b in zip(color, light)]
    return color


def make(folder):
    still().write(folder / 'still.obj')
    (folder / 'still.mtl').write_text(STILL_MTL)
    for name, comment, mesh in (('dome', 'a floor that turns into a dome', dome()),):
        obj = Obj(comment, digits=3)
        obj.add(mesh)
        obj.write(folder / f'{name}.obj')
    obj = Obj('a ball with texture coordinates', 'ball.mtl', digits=3)
    # The profile's length is pi: from pole to pole once.
    whole = sphere(32, 16)
    whole.uvs = [(u, v / math.pi) for u, v in whole.uvs]
    obj.add(whole, 'globe')
    obj.write(folder / 'ball.obj')
    (folder / 'ball.mtl').write_text(BALL_MTL)
    hills().write(folder / 'hills.obj')
    (folder / 'hills.mtl').write_text(HILLS_MTL)
    solids().write(folder / 'solids.obj')
    (folder / 'solids.mtl').write_text(SOLIDS_MTL)
    obj, colors = dominoes()
    obj.write(folder / 'dominoes.obj')
    (folder / 'dominoes.mtl').write_text(colors)
    tree().write(folder / 'tree.obj')
    (folder / 'tree.mtl').write_text(TREE_MTL)
    png.write(folder / 'globe.png', 128, 64, globe)
    png.write(folder / 'checks.png', 64, 64, checks)
    png.write(folder / 'tiles_normal.png', 96, 96, lambda u, v: png.normal_map(tiles, u, v, 1 / 192))
    png.write(folder / 'sand.png', 256, 256, sand)
    png.write(folder / 'lattice.png', 64, 64, lattice)
    hdr.write(folder / 'studio.hdr', 64, 32, studio)
