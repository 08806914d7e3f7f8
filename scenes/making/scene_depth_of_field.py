"""A chess board and its turned pieces; a square is 1 unit."""

from .mesh import Mesh, Obj
from .shapes import arc, box, revolve

FOOT = [(0, 0), (0.36, 0)] + arc((0.36, 0.035), 0.035, -90, 60, 4)[1:] + [(0.345, 0.1)]
FOOT += arc((0.3, 0.14), 0.045, -60, 70, 4) + [(0.27, 0.2)]


def stem(height, waist, neck):
    """From the foot up to a collar at `height`."""
    rise = height - 0.2
    curve = [(0.27 + (waist - 0.27) * (1 - (1 - t) ** 2.2) + (neck - waist) * t**4, 0.2 + rise * t)
             for t in (i / 7 for i in range(1, 8))]
    collar = arc((neck + 0.03, height + 0.035), 0.035, -90, 90, 6) + [(neck, height + 0.08)]
    return FOOT + curve + collar


def pawn():
    return stem(0.62, 0.12, 0.11) + arc((0, 0.86), 0.19, -55, 90, 10)[:-1] + [(0, 1.05)]


def bishop():
    head = [(0.1, 1.02), (0.15, 1.08), (0.185, 1.17), (0.18, 1.26), (0.14, 1.37), (0.075, 1.47), (0.05, 1.495)]
    return stem(0.9, 0.13, 0.11) + head + arc((0, 1.54), 0.06, -50, 90, 8)[:-1] + [(0, 1.6)]


def rook():
    return stem(0.72, 0.17, 0.17) + [(0.2, 0.86), (0.25, 0.9), (0.26, 1.1), (0.19, 1.1), (0.19, 1.02), (0, 1.02)]


def queen():
    crown = [(0.12, 1.22), (0.17, 1.34), (0.24, 1.5), (0.2, 1.52), (0.15, 1.46), (0.08, 1.52)]
    return stem(1.08, 0.14, 0.12) + crown + arc((0, 1.57), 0.065, -50, 90, 8)[:-1] + [(0, 1.635)]


def king():
    crown = [(0.12, 1.26), (0.165, 1.38), (0.22, 1.54), (0.21, 1.57), (0.1, 1.63), (0, 1.64)]
    return stem(1.14, 0.15, 0.125) + crown


def make(folder):
    for piece in (pawn, bishop, rook, queen, king):
        mesh = revolve(piece(), 36)
        obj = Obj(f'{piece.__name__}, turned')
        obj.add(Mesh(mesh.points, mesh.faces, mesh.normals))
        if piece is king:
            for bar in (box((0.06, 0.22, 0.06), (0, 1.74, 0)), box((0.16, 0.06, 0.055), (0, 1.765, 0))):
                obj.add(Mesh(bar.points, bar.faces))
        obj.write(folder / f'{piece.__name__}.obj')

    # The board: squares 0..8 in x and 0..-8 in z, a1 at the origin's corner; its top is y = 0.
    board = Obj('chess board, 8 x 8', 'board.mtl')
    for material, parity in (('dark', 0), ('light', 1)):
        points, faces = [], []
        for row in range(8):
            for column in range(8):
                if (row + column) % 2 == parity:
                    base = len(points)
                    points += [(column, 0, -row), (column + 1, 0, -row), (column + 1, 0, -row - 1), (column, 0, -row - 1)]
                    faces.append((base, base + 1, base + 2, base + 3))
        board.add(Mesh(points, faces), material)
    for size, center in (((9, 0.3, 0.5), (4, -0.14, 0.25)), ((9, 0.3, 0.5), (4, -0.14, -8.25)),
                         ((0.5, 0.3, 8), (-0.25, -0.14, -4)), ((0.5, 0.3, 8), (8.25, -0.14, -4))):
        side = box(size, center)
        board.add(Mesh(side.points, side.faces), 'frame')
    board.write(folder / 'board.obj')
    (folder / 'board.mtl').write_text("""# Lacquered wood
newmtl dark
Kd 0.05 0.02 0.012
Ks 0.04 0.04 0.04
Pr 0.15
newmtl light
Kd 0.55 0.4 0.24
Ks 0.04 0.04 0.04
Pr 0.15
newmtl frame
Kd 0.1 0.035 0.018
Ks 0.04 0.04 0.04
Pr 0.25
""")
