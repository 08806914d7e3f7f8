#!/usr/bin/env python3
"""Holds glint against Mitsuba 3, a path tracer that shares no code with it.

    pip install mitsuba numpy
    python3 tests/mitsuba_reference.py target/release/glint [MODEL.obj ...] [--pictures FOLDER]

Without models: the Cornell box of this repository, and its trefoil knot. Both programs read the same bare triangles
(written to a temporary folder: vertices, faces, `Kd` and `Ke`; no normals, no textures), with the same camera, a box
filter and unbounded depth. A model other than the Cornell box is diffuse, 0.7, in a constant environment.

Each program renders every case with several seeds. The spread over the seeds is the standard error of a mean; z is a
difference over its standard error. Means are compared over the picture, a channel at a time, and over 8x8 blocks,
channels together. The exit code is 1 if any |z| exceeds 5.

It must not know how glint works: it uses the command line and reads EXR files.
"""

import argparse
import itertools
import pathlib
import subprocess
import sys
import tempfile

import mitsuba as mi
import numpy as np

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
BLOCKS = 8
# z beyond this is a disagreement: 1e-6 for a normal variable, about 1e-5 with the few seeds here.
LIMIT = 5
DIFFUSE = '0.7,0.7,0.7'


class Case:
    """A model in bare triangles and how to look at it."""

    def __init__(self, path):
        self.name = path.stem
        self.vertices, faces, self.materials = read_obj(path)
        self.is_box = path.samefile(REPOSITORY / 'scenes/cornell/cornell.obj')
        if self.is_box:
            self.eye, self.target, self.fov = [277.5, 273, 800], [277.5, 273, 0], 39.3
        else:
            faces, self.materials = {'all': list(itertools.chain(*faces.values()))}, {}
            points = np.array(self.vertices)
            low, high = points.min(axis=0), points.max(axis=0)
            self.target = [round(float(x), 4) for x in (low + high) / 2]
            away = np.array([0.5, 0.35, 1]) * np.linalg.norm(high - low)
            self.eye = [round(float(x), 4) for x in self.target + away]
            self.fov = 40
        self.faces = faces

    def write(self, folder):
        """The OBJ file for glint."""
        with open(folder / 'bare.mtl', 'w') as mtl, open(folder / 'bare.obj', 'w') as obj:
            obj.write('mtllib bare.mtl\n')
            obj.writelines('v {} {} {}\n'.format(*map(repr, v)) for v in self.vertices)
            for name, faces in self.faces.items():
                lines = [f'{key} {r} {g} {b}\n' for key, (r, g, b) in self.materials.get(name, {}).items()]
                mtl.write(f'newmtl {name}\n' + ''.join(lines))
                obj.write(f'usemtl {name}\n')
                obj.writelines('f {} {} {}\n'.format(*(i + 1 for i in face)) for face in faces)
        return folder / 'bare.obj'


def read_obj(path):
    """Vertices, faces by material as triangles of vertex numbers from 0, and the materials' `Kd` and `Ke`."""
    vertices, faces, materials, current = [], {}, {}, 'none'
    for line in path.read_text(errors='replace').splitlines():
        key, *words = line.split() or ['']
        if key == 'v':
            vertices.append([float(x) for x in words[:3]])
        elif key == 'mtllib':
            materials |= read_mtl(path.parent / ' '.join(words))
        elif key == 'usemtl':
            current = words[0]
        elif key == 'f':
            corners = [int(word.split('/')[0]) for word in words]
            corners = [i - 1 if i > 0 else len(vertices) + i for i in corners]
            fan = [[corners[0], *pair] for pair in zip(corners[1:], corners[2:])]
            faces.setdefault(current, []).extend(fan)
    return vertices, faces, materials


def read_mtl(path):
    materials, current = {}, {}
    for line in path.read_text(errors='replace').splitlines() if path.exists() else []:
        key, *words = line.split() or ['']
        if key == 'newmtl':
            current = materials.setdefault(words[0], {})
        elif key in ('Kd', 'Ke'):
            current[key] = [float(x) for x in words]
    return materials


def render_glint(case, program, folder, options, seed):
    """Linear radiance, height x width x 3."""
    model, picture = case.write(folder), folder / 'glint.exr'
    command = [program, 'render', model, '-o', picture, '-q', '--size', f'{options.size}x{options.size}', '--filter',
               'box:0.5', '--spp', str(options.spp), '--seed', str(seed), '--fov', str(case.fov),
               *('--camera-from=' + ','.join(map(str, case.eye)), '--camera-to=' + ','.join(map(str, case.target)))]
    light = ['--env', 'constant:0,0,0'] if case.is_box else ['--env', 'constant:1,1,1', '--override-material',
                                                             f'diffuse:{DIFFUSE}']
    subprocess.run([*command, *light], check=True)
    return np.array(mi.Bitmap(str(picture)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))


def mitsuba_scene(case, options):
    """The same for Mitsuba."""
    scene = {
        'type': 'scene',
        # Unbounded, with Russian roulette from the fifth bounce.
        'integrator': {'type': 'path', 'max_depth': -1},
        'sensor': {
            'type': 'perspective', 'fov': case.fov, 'fov_axis': 'y',
            'to_world': mi.ScalarTransform4f().look_at(origin=case.eye, target=case.target, up=[0, 1, 0]),
            'film': {'type': 'hdrfilm', 'width': options.size, 'height': options.size, 'pixel_format': 'rgb',
                     'component_format': 'float32', 'rfilter': {'type': 'box'}},
        },
    }
    if not case.is_box:
        scene['environment'] = {'type': 'constant', 'radiance': {'type': 'rgb', 'value': [1.0, 1.0, 1.0]}}
    vertices = np.array(case.vertices)
    for name, faces in case.faces.items():
        material = case.materials.get(name, {})
        color = material.get('Kd', [float(x) for x in DIFFUSE.split(',')])
        scene[f'{name} front'] = mesh(vertices[np.array(faces)], color, material.get('Ke'))
        if 'Ke' in material and not options.one_sided:
            # Mitsuba's lights shine to one side, glint's to both: put a second one, turned over, just behind.
            corners = vertices[np.array(faces)][:, ::-1]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            corners = corners + 1e-5 * np.ptp(vertices, axis=0).max() * normals[:, None]
            scene[f'{name} back'] = mesh(corners, color, material['Ke'])
    return mi.load_dict(scene)


def mesh(corners, color, emission):
    """A mesh of separate triangles, triangles x 3 x 3, diffuse on both sides."""
    properties = mi.Properties()
    diffuse = {'type': 'diffuse', 'reflectance': {'type': 'rgb', 'value': color}}
    properties['bsdf'] = mi.load_dict({'type': 'twosided', 'inside': diffuse})
    if emission:
        properties['light'] = mi.load_dict({'type': 'area', 'radiance': {'type': 'rgb', 'value': emission}})
    count = len(corners)
    result = mi.Mesh('triangles', 3 * count, count, props=properties)
    fields = mi.traverse(result)
    fields['vertex_positions'] = corners.astype(np.float32).ravel()
    fields['faces'] = np.arange(3 * count, dtype=np.uint32)
    fields.update()
    return result


def compare(ours, theirs):
    """Relative difference, its standard error, and z; the first axis of both is the seed."""
    difference, mean = ours.mean(axis=0) - theirs.mean(axis=0), theirs.mean(axis=0)
    error = np.sqrt(sum(x.var(axis=0, ddof=1) / len(x) for x in (ours, theirs)))
    with np.errstate(divide='ignore', invalid='ignore'):
        return difference / mean, error / mean, difference / error


def blocks(pictures):
    """Means over a grid of blocks, channels together, as seeds x blocks."""
    seeds, height, width, _ = pictures.shape
    means = pictures.reshape(seeds, BLOCKS, height // BLOCKS, BLOCKS, width // BLOCKS, 3).mean(axis=(2, 4, 5))
    return means.reshape(seeds, -1)


def write_picture(path, ours, theirs):
    """glint, Mitsuba, and 20 times the difference around grey."""
    exposure = 0.8 / np.percentile(theirs, 95)
    both = np.clip(np.concatenate([ours, theirs], axis=1) * exposure, 0, 1)
    srgb = np.where(both <= 0.0031308, 12.92 * both, 1.055 * both ** (1 / 2.4) - 0.055)
    difference = np.clip(0.5 + 20 * (ours - theirs) * exposure, 0, 1)
    pixels = np.concatenate([srgb, difference], axis=1)
    mi.Bitmap((255 * pixels + 0.5).astype(np.uint8)).write(str(path))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('glint')
    parser.add_argument('model', nargs='*', type=pathlib.Path)
    parser.add_argument('--size', type=int, default=128, help='pixels a side')
    parser.add_argument('--spp', type=int, default=128, help='samples a pixel and seed')
    parser.add_argument('--seeds', type=int, default=16)
    parser.add_argument('--first-seed', type=int, default=0)
    parser.add_argument('--variant', default='scalar_rgb', help='of Mitsuba; llvm_ad_rgb is faster, but needs LLVM')
    parser.add_argument('--one-sided', action='store_true', help="leave Mitsuba's lights as they are")
    parser.add_argument('--pictures', type=pathlib.Path, help='folder for PNG files')
    options = parser.parse_args()
    mi.set_variant(options.variant)
    models = options.model or [REPOSITORY / 'scenes/cornell/cornell.obj', REPOSITORY / 'scenes/glass/trefoil.obj']
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    worst = 0
    print('| model | mean of the picture, r g b | z | blocks: rms z | max z | largest difference | median standard error |')
    print('|---|---|---|---|---|---|---|')
    for case in map(Case, models):
        scene = mitsuba_scene(case, options)
        with tempfile.TemporaryDirectory() as folder:
            ours = np.array([render_glint(case, options.glint, pathlib.Path(folder), options, seed) for seed in seeds],
                            dtype=np.float64)
        theirs = np.array([mi.render(scene, spp=options.spp, seed=seed) for seed in seeds], dtype=np.float64)
        relative, _, z = compare(ours.mean(axis=(1, 2)), theirs.mean(axis=(1, 2)))
        compared = compare(blocks(ours), blocks(theirs))
        # A block of nothing but sky says nothing.
        noisy = compared[1] > 1e-5
        block_relative, block_error, block_z = (x[noisy] for x in compared)
        print(f'| {case.name} |', ' '.join(f'{100 * x:+.3f} %' for x in relative),
              '|', ' '.join(f'{x:+.1f}' for x in z), f'| {np.sqrt((block_z ** 2).mean()):.2f} | {np.abs(block_z).max():.1f} |',
              f'{100 * np.abs(block_relative).max():.2f} % | {100 * np.median(block_error):.2f} % |', flush=True)
        worst = max(worst, np.abs(z).max(), np.abs(block_z).max())
        if options.pictures:
            write_picture(options.pictures / f'{case.name}.png', ours.mean(axis=0), theirs.mean(axis=0))
    return int(worst > LIMIT)


if __name__ == '__main__':
    sys.exit(main())
