"""Clear and coloured glass on a pale sweep: a ball, a trefoil, a carafe and a cut stone."""

import math

from .mesh import Mesh, Obj
from .shapes import arc, revolve, sheet, torus_knot


def backdrop(u, v):
    """A floor that turns into a wall: v runs from the front edge to the top of the wall."""
    front, turn, top = 4.5, 1.5, 3.0
    floor, bend = front + 2.0, turn * math.pi / 2
    s = v * (floor + bend + top)
    x = 14 * (u - 0.5)
    if s < floor:
        return (x, 0, front - s)
    if s < floor + bend:
        a = (s - floor) / turn
        return (x, turn * (1 - math.cos(a)), front - floor - turn * math.sin(a))
    return (x, turn + s - floor - bend, front - floor - turn)


def carafe():
    """A vessel with a wall of even thickness: down the inside again after the lip."""
    outside = [(0, 0), (0.3, 0)] + arc((0.3, 0.05), 0.05, -90, 0, 6)[1:]
    outside += [(0.37, 0.1), (0.4, 0.2), (0.41, 0.3), (0.4, 0.4), (0.36, 0.5), (0.29, 0.6), (0.21, 0.7)]
    outside += [(0.155, 0.8), (0.13, 0.9), (0.125, 1.0), (0.135, 1.1), (0.165, 1.19)]
    lip = arc((0.147, 1.2), 0.02, -20, 200, 8)
    inside = [(0.1, 1.1), (0.09, 1.0), (0.095, 0.9), (0.12, 0.8), (0.175, 0.7), (0.255, 0.6), (0.325, 0.5)]
    inside += [(0.365, 0.4), (0.375, 0.3), (0.365, 0.2), (0.335, 0.13), (0.26, 0.09), (0.14, 0.08), (0, 0.08)]
    return revolve(smooth(outside[:2]) + smooth(outside[1:])[1:] + lip + smooth(inside), 48)


def smooth(profile, steps=2):
    """Catmull-Rom points between those of a profile."""
    if len(profile) < 3:
        return profile
    ends = [profile[0]] + profile + [profile[-1]]
    result = []
    for p0, p1, p2, p3 in zip(ends, ends[1:], ends[2:], ends[3:]):
        for i in range(steps):
            t = i / steps
            weights = (-0.5 * t + t * t - 0.5 * t**3, 1 - 2.5 * t * t + 1.5 * t**3,
                       0.5 * t + 2 * t * t - 1.5 * t**3, -0.5 * t * t + 0.5 * t**3)
            result.append(tuple(math.fsum(w * p[k] for w, p in zip(weights, (p0, p1, p2, p3))) for k in (0, 1)))
    return result + [profile[-1]]


def brilliant():
    """A brilliant cut after Tolkowsky's proportions: table, crown, girdle, pavilion; radius 1, point at y = 0."""
    pavilion, girdle, crown, table = 0.862, 0.03, 0.324, 0.53
    low, high, top = pavilion, pavilion + girdle, pavilion + girdle + crown

    def ring(count, radius, y, offset=0.0):
        turns = [2 * math.pi * (k + offset) / count for k in range(count)]
        return [(radius * math.sin(a), y, radius * math.cos(a)) for a in turns]

    cosine = math.cos(math.pi / 8)
    upper = ring(8, table / cosine, top)
    star = ring(8, 0.79, high + 0.5 * crown, 0.5)
    edge, under = ring(16, 1, high), ring(16, 1, low)
    lower = ring(8, 0.25, 0.2155, 0.5)
    tip = (0, 0, 0)
    facets = [list(upper)]
    for k in range(8):
        n, left, right = (k + 1) % 8, edge[2 * k], edge[(2 * k + 2) % 16]
        middle = edge[2 * k + 1]
        facets += [[upper[k], star[k], upper[n]]]
        facets += [[star[k], left, middle], [star[k], middle, right]]
        facets += [[star[k], upper[k], left], [star[k], right, upper[n]]]
        facets += [[left, under[2 * k], under[2 * k + 1], middle]]
        facets += [[middle, under[2 * k + 1], under[(2 * k + 2) % 16], right]]
        facets += [[under[2 * k], lower[k], under[2 * k + 1]]]
        facets += [[under[2 * k + 1], lower[k], under[(2 * k + 2) % 16]]]
        facets += [[under[2 * k], tip, lower[k]], [lower[k], tip, under[(2 * k + 2) % 16]]]
    points, faces = [], []
    for facet in facets:
        faces.append(tuple(range(len(points), len(points) + len(facet))))
        points += facet
    return Mesh(points, faces)


def make(folder):
    parts = {
        'backdrop': sheet(backdrop, 1, 48),
        'trefoil': torus_knot(2, 3, 0.36, 0.16, 0.085, 168, 14).turn('x', 90),
        'carafe': carafe(),
        'stone': brilliant(),
    }
    for name, mesh in parts.items():
        obj = Obj(f'{name}, for the scene of glass')
        obj.add(Mesh(mesh.points, mesh.faces, mesh.normals))
        obj.write(folder / f'{name}.obj')
