"""Procedural shapes: boxes, surfaces of revolution, tubes, sheets."""

import math

from .mesh import Mesh, cross, normalize


def box(size, center=(0, 0, 0), uv_scale=1):
    """A box with flat sides; texture coordinates in units of length."""
    x, y, z = (s / 2 for s in size)
    points, faces, uvs = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            half = (x, y, z)
            u, v = (axis + 1) % 3, (axis + 2) % 3
            corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
            if sign < 0:
                corners.reverse()
            base = len(points)
            for a, b in corners:
                p = [0, 0, 0]
                p[axis], p[u], p[v] = sign * half[axis], a * half[u], b * half[v]
                points.append(tuple(p[i] + center[i] for i in range(3)))
                # v of the texture is upward on the sides.
                s, t = (p[v], p[u]) if axis == 2 else (p[u], p[v])
                s, t = (t, s) if axis == 0 else (s, t)
                uvs.append((s * uv_scale, t * uv_scale))
            faces.append(tuple(range(base, base + 4)))
    return Mesh(points, faces, None, uvs)


def sheet(f, columns, rows, smooth=True):
    """The surface f(u, v) over the unit square, as a grid; normals by differences, within it in v. uv are (u, v)."""
    points, uvs, normals = [], [], []
    h = 1e-4
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            points.append(f(u, v))
            uvs.append((u, v))
            if smooth:
                du = [a - b for a, b in zip(f(u + h, v), f(u - h, v))]
                dv = [a - b for a, b in zip(f(u, min(v + h, 1)), f(u, max(v - h, 0)))]
                normals.append(normalize(cross(du, dv)))
    w = columns + 1
    faces = []
    for j in range(rows):
        for i in range(columns):
            a = j * w + i
            faces += [(a, a + 1, a + w + 1), (a, a + w + 1, a + w)]
    return Mesh(points, faces, normals or None, uvs)


def revolve(profile, segments, crease=35):
    """Turns a profile [(radius, height), ...] about the y axis.

    The profile runs from bottom to top of the outside (and down the inside of a vessel): its left is inside. Corners
    sharper than `crease` degrees stay sharp; radius 0 closes a pole. uv: angle, length along the profile.
    """
    profile = [p for i, p in enumerate(profile) if i == 0 or math.dist(p, profile[i - 1]) > 1e-6]
    # Normals of the pieces, in the (radius, height) plane.
    pieces = []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        n = normalize((y1 - y0, r0 - r1, 0))
        pieces.append(n[:2])
    # One ring a profile point, two at creases.
    rings, length = [], 0
    for i, (r, y) in enumerate(profile):
        if i:
            length += math.dist(profile[i], profile[i - 1])
        before, after = pieces[max(i - 1, 0)], pieces[min(i, len(pieces) - 1)]
        dot = before[0] * after[0] + before[1] * after[1]
        if dot < math.cos(math.radians(crease)):
            rings += [(r, y, before, length, False), (r, y, after, length, True)]
        else:
            n = normalize((before[0] + after[0], before[1] + after[1], 0))
            n = (0, math.copysign(1, n[1])) if r == 0 else n[:2]
            rings.append((r, y, n, length, i > 0))
    points, normals, uvs = [], [], []
    for r, y, n, s, _ in rings:
        for k in range(segments + 1):
            c, d = math.cos(2 * math.pi * k / segments), math.sin(2 * math.pi * k / segments)
            points.append((r * d, y, r * c))
            normals.append((n[0] * d, n[1], n[0] * c))
            uvs.append((k / segments, s))
    faces, w = [], segments + 1
    for j in range(len(rings) - 1):
        low, high = rings[j], rings[j + 1]
        if low[:2] == high[:2]:
            continue
        for k in range(segments):
            a, b = j * w + k, (j + 1) * w + k
            if low[0] == 0:
                faces.append((a, b + 1, b))
            elif high[0] == 0:
                faces.append((a, a + 1, b))
            else:
                faces.append((a, a + 1, b + 1, b))
    return Mesh(points, faces, normals, uvs)


def sphere(segments=64, rings=32):
    """The unit sphere; at its points its normals are exact."""
    angles = [math.pi * (i / rings - 0.5) for i in range(rings + 1)]
    profile = [(math.cos(a) if 0 < i < rings else 0, math.sin(a)) for i, a in enumerate(angles)]
    mesh = revolve(profile, segments, crease=180)
    mesh.normals = [normalize(p) for p in mesh.points]
    return mesh


def arc(center, radius, start, end, steps):
    """Points of a profile on a circle, from angle `start` to `end` in degrees."""
    angles = [math.radians(start + (end - start) * i / steps) for i in range(steps + 1)]
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in angles]


def tube(curve, count, sides, radius):
    """A closed tube about the curve(t), t in [0, 1); radius may be a function of t."""
    radius = radius if callable(radius) else (lambda t, r=radius: r)
    points, normals, uvs = [], [], []
    h = 1e-3
    # A frame that is carried along the curve, and untwisted evenly at the end.
    frames = []
    side = None
    for i in range(count + 1):
        t = i / count
        tangent = normalize([a - b for a, b in zip(curve(t + h), curve(t - h))])
        if side is None:
            side = normalize(cross(tangent, (0.3, 1, 0.2)))
        side = normalize([s - d * math.fsum(a * b for a, b in zip(side, tangent)) for s, d in zip(side, tangent)])
        frames.append((curve(t), tangent, side))
    first, last = frames[0], frames[-1]
    other = cross(first[1], first[2])
    twist = math.atan2(math.fsum(a * b for a, b in zip(last[2], other)), math.fsum(a * b for a, b in zip(last[2], first[2])))
    for i, (center, tangent, side) in enumerate(frames):
        other = cross(tangent, side)
        for k in range(sides + 1):
            a = 2 * math.pi * k / sides - twist * i / count
            n = [math.cos(a) * s + math.sin(a) * o for s, o in zip(side, other)]
            r = radius(i / count)
            points.append(tuple(c + r * x for c, x in zip(center, n)))
            normals.append(tuple(n))
            uvs.append((i / count, k / sides))
    faces, w = [], sides + 1
    for i in range(count):
        for k in range(sides):
            a, b = i * w + k, (i + 1) * w + k
            faces += [(a, b, b + 1), (a, b + 1, a + 1)]
    return Mesh(points, [tuple(reversed(f)) for f in faces], normals, uvs)


def torus_knot(p, q, radius, wave, thickness, count=320, sides=24):
    """A (p, q) torus knot about the y axis."""

    def curve(t):
        a = 2 * math.pi * t
        r = radius + wave * math.cos(q * a)
        return (r * math.cos(p * a), wave * math.sin(q * a), r * math.sin(p * a))

    return tube(curve, count, sides, thickness)


def extrude(outline, height, bottom=0):
    """A prism over a convex polygon [(x, z), ...], counter-clockwise from above, with flat sides."""
    points, faces, n = [], [], len(outline)
    top = [(x, bottom + height, z) for x, z in outline]
    low = [(x, bottom, z) for x, z in outline]
    for i in range(n):
        j = (i + 1) % n
        base = len(points)
        points += [low[i], low[j], top[j], top[i]]
        faces.append(tuple(range(base, base + 4)))
    faces.append(tuple(range(len(points), len(points) + n)))
    points += top
    faces.append(tuple(reversed(range(len(points), len(points) + n))))
    points += low
    return Mesh(points, faces)
