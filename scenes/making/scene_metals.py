"""Three steps for three metals, with a rounded nosing on each."""

import math

from .mesh import Mesh, Obj
from .shapes import arc

WIDTH, DEPTH, RISE, NOSE = 11, 1.15, 0.45, 0.06


def make(folder):
    # The outline of the stairs in the (z, y) plane, from the front of the floor to the top of the wall.
    outline = [(9.0, 0.0)]
    z, y = 0.55 * DEPTH + DEPTH, 0.0
    for _ in range(2):
        outline += [(z, y)] + arc((z - NOSE, y + RISE - NOSE), NOSE, 0, 90, 6)
        y += RISE
        z -= DEPTH
    outline += arc((-3.0, y + 1.2), 1.2, -90, -180, 16) + [(-4.2, 7.0)]
    points, faces, normals = [], [], []
    for i, ((z0, y0), (z1, y1)) in enumerate(zip(outline, outline[1:])):
        length = ((z1 - z0) ** 2 + (y1 - y0) ** 2) ** 0.5
        base = len(points)
        points += [(-WIDTH, y0, z0), (WIDTH, y0, z0), (WIDTH, y1, z1), (-WIDTH, y1, z1)]
        normals += [(0, (z0 - z1) / length, (y1 - y0) / length)] * 4
        faces.append((base, base + 1, base + 2, base + 3))
    # Neighbouring pieces share normals where they turn by little.
    for i in range(len(faces) - 1):
        a, b = normals[4 * i + 2], normals[4 * i + 4]
        if math.fsum(x * y for x, y in zip(a, b)) > 0.9:
            middle = [x + y for x, y in zip(a, b)]
            size = math.fsum(x * x for x in middle) ** 0.5
            for k in (4 * i + 2, 4 * i + 3, 4 * i + 4, 4 * i + 5):
                normals[k] = tuple(x / size for x in middle)
    obj = Obj('steps for the metals')
    obj.add(Mesh(points, faces, normals))
    obj.write(folder / 'steps.obj')
