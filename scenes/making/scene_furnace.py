"""A closed box whose walls reflect half and emit half: the radiance is 1 everywhere inside."""

from .mesh import Mesh, Obj
from .shapes import box


def make(folder):
    walls = box((2, 2, 2)).flip()
    obj = Obj('a closed box, 2 x 2 x 2, seen from inside', 'box.mtl')
    obj.add(Mesh(walls.points, walls.faces), 'wall')
    obj.write(folder / 'box.obj')
    (folder / 'box.mtl').write_text('# Ke + Kd * 1 = 1\nnewmtl wall\nKd 0.5 0.5 0.5\nKe 0.5 0.5 0.5\n')
