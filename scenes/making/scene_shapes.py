"""Shapes that several scenes place: spheres, the unit square, a disc."""

from .mesh import Mesh, Obj
from .shapes import revolve, sphere


def make(folder):
    parts = {
        'sphere': ('the unit sphere', sphere(64, 32)),
        'bulb': ('a sphere of few triangles, for lamps', sphere(12, 6)),
        'square': ('the square from (-1, 0, -1) to (1, 0, 1), facing up', square()),
        'disc': ('the unit disc, facing up', revolve([(1, 0), (0, 0)], 48)),
    }
    for name, (comment, mesh) in parts.items():
        if name != 'square':
            mesh.uvs = None
        obj = Obj(comment)
        obj.add(mesh)
        obj.write(folder / f'{name}.obj')


def square():
    points = [(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)]
    return Mesh(points, [(0, 1, 2, 3)], None, [(0, 0), (1, 0), (1, 1), (0, 1)])
