"""Polygon meshes and OBJ files.

A mesh has points, optional normals and texture coordinates (one each a point) and polygons, counter-clockwise
seen from outside. Shapes make meshes (shapes.py); an Obj collects them and writes the file.
"""

import math


class Mesh:
    """Points with optional attributes, and polygons of their indices."""

    def __init__(self, points, faces, normals=None, uvs=None):
        self.points, self.faces, self.normals, self.uvs = points, faces, normals, uvs

    def move(self, x, y, z):
        points = [(p[0] + x, p[1] + y, p[2] + z) for p in self.points]
        return Mesh(points, self.faces, self.normals, self.uvs)

    def scale(self, x, y=None, z=None):
        """Scaled about the origin; normals stay right for unequal factors, all positive."""
        y, z = (x if y is None else y), (x if z is None else z)
        points = [(p[0] * x, p[1] * y, p[2] * z) for p in self.points]
        normals = self.normals and [normalize((n[0] / x, n[1] / y, n[2] / z)) for n in self.normals]
        return Mesh(points, self.faces, normals, self.uvs)

    def turn(self, axis, degrees):
        """Turned about the x, y or z axis, counter-clockwise."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        turns = {
            'x': lambda p: (p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]),
            'y': lambda p: (c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]),
            'z': lambda p: (c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]),
        }
        turn = turns[axis]
        normals = self.normals and [turn(n) for n in self.normals]
        return Mesh([turn(p) for p in self.points], self.faces, normals, self.uvs)

    def flip(self):
        """Inside out."""
        faces = [tuple(reversed(face)) for face in self.faces]
        normals = self.normals and [(-n[0], -n[1], -n[2]) for n in self.normals]
        return Mesh(self.points, faces, normals, self.uvs)


class Obj:
    """An OBJ file in the making; coordinates have `digits` decimals."""

    def __init__(self, comment, library=None, digits=4):
        self.lines = ['# ' + comment]
        if library:
            self.lines.append('mtllib ' + library)
        self.counts, self.material, self.digits = [0, 0, 0], None, digits

    def add(self, mesh, material=None, name=None):
        """Appends a mesh, with a material of the library from here on."""
        if name:
            self.lines.append('o ' + name)
        if material and material != self.material:
            self.lines.append('usemtl ' + material)
            self.material = material
        for keyword, values, digits in (('v', mesh.points, self.digits), ('vt', mesh.uvs, 4), ('vn', mesh.normals, 3)):
            for value in values or ():
                self.lines.append(keyword + ''.join(' ' + number(x, digits) for x in value))
        v, vt, vn = self.counts
        for face in mesh.faces:
            corners = []
            for i in face:
                texture = str(vt + i + 1) if mesh.uvs else ''
                normal = '/' + str(vn + i + 1) if mesh.normals else ''
                slash = '/' if texture or normal else ''
                corners.append(str(v + i + 1) + slash + texture + normal)
            self.lines.append('f ' + ' '.join(corners))
        self.counts = [v + len(mesh.points), vt + len(mesh.uvs or ()), vn + len(mesh.normals or ())]

    def write(self, path):
        with open(path, 'w', newline='\n') as file:
            file.write('\n'.join(self.lines) + '\n')


def number(x, digits):
    """A short decimal; the same text on every machine."""
    text = f'{x:.{digits}f}'.rstrip('0').rstrip('.')
    return '0' if text in ('-0', '') else text


def normalize(v):
    length = math.sqrt(math.fsum(x * x for x in v)) or 1
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
