"""The Cornell box: 555 units wide, open towards +z, with its two blocks and its lamp."""

from .mesh import Mesh, Obj
from .shapes import box

MTL = """# The Cornell box. Ke of the lamp is radiance.
newmtl white
Kd 0.725 0.71 0.68
newmtl red
Kd 0.63 0.065 0.05
newmtl green
Kd 0.14 0.45 0.091
newmtl lamp
Kd 0.78 0.78 0.78
Ke 17 12 4
"""


def quad(*points):
    return Mesh(list(points), [(0, 1, 2, 3)])


def make(folder):
    s, d = 555, 559
    obj = Obj('Cornell box: 555 x 555 x 559, open towards +z', 'cornell.mtl')
    obj.add(quad((0, 0, 0), (s, 0, 0), (s, 0, -d), (0, 0, -d)), 'white', 'floor')
    obj.add(quad((0, s, 0), (0, s, -d), (s, s, -d), (s, s, 0)), name='ceiling')
    obj.add(quad((0, 0, -d), (s, 0, -d), (s, s, -d), (0, s, -d)), name='back')
    obj.add(quad((0, 0, 0), (0, 0, -d), (0, s, -d), (0, s, 0)), 'red', 'left')
    obj.add(quad((s, 0, 0), (s, s, 0), (s, s, -d), (s, 0, -d)), 'green', 'right')
    obj.add(quad((213, s - 1, -227), (213, s - 1, -332), (343, s - 1, -332), (343, s - 1, -227)), 'lamp', 'lamp')
    tall = box((165, 330, 165)).turn('y', 15).move(188, 165, -368)
    short = box((165, 165, 165)).turn('y', -18).move(368, 82.5, -168)
    for block, name in ((tall, 'tall'), (short, 'short')):
        obj.add(Mesh(block.points, block.faces), 'white', name)
    obj.write(folder / 'cornell.obj')
    (folder / 'cornell.mtl').write_text(MTL)
